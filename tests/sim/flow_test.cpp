/// Snow that comes and goes: how much, where, with what momentum and energy, and the same whatever
/// the steps, the threads and the interruptions.

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>

#include "sim/checks/watch.h"
#include "sim/rasterize.h"
#include "sim/shapes/solid.h"
#include "sim/staged.h"
#include "tests/support/snow.h"

namespace {

using namespace neve;
using namespace neve::sim;
using namespace neve::test;

/// Box of 0.2 x 0.04 x 0.2 m that snow leaves downwards.
seeding::Emitter spout(double rate) {
  seeding::Emitter e;
  e.name = "spout";
  e.material = "snow";
  e.shape.form = shapes::Box{{0.1, 1.0, -0.2}, {0.2, 0.04, 0.2}};
  e.velocity = {0, -2, 0};
  e.rate = rate;
  return e;
}

seeding::Sink pit(double top) {
  seeding::Sink sink;
  sink.name = "pit";
  sink.shape.form = shapes::Box{{0, top - 5, 0}, {10, 10, 10}};
  return sink;
}

SolverSettings without_gravity() {
  SolverSettings s;
  s.gravity = Vec3d::Zero();
  return s;
}

Simulation flowing(const SolverSettings& settings, const ParticleArrays& particles,
                   const seeding::Flow& flow, int threads = 1,
                   const sim::Vec3i& origin = sim::Vec3i::Zero()) {
  return Simulation(settings, {Material{}}, {}, particles, threads, origin, flow);
}

std::vector<seeding::Birth> births_of(seeding::EmitterStream& stream, double time) {
  std::vector<seeding::Birth> births;
  stream.advance_to(time, births);
  return births;
}

TEST(Flow, TheRateIsKeptFromStartToEnd) {
  seeding::Emitter e = spout(3);
  e.start = 0.1;
  e.end = 0.35;
  const Material snow;
  const double m = snow.density * std::pow(0.02, 3) / e.particles_per_cell;
  seeding::EmitterStream stream(e, 0, snow, 1, 0.02);
  EXPECT_TRUE(births_of(stream, 0.1).empty());
  std::size_t count = 0;
  double mass = 0;
  for (double t = 0; t <= 1; t += 0.01) {
    for (const seeding::Birth& b : births_of(stream, t)) {
      ++count;
      mass += b.m;
      EXPECT_DOUBLE_EQ(b.V0 * snow.density, b.m);
    }
    // Half a particle: times of births are rounded to whole ones.
    EXPECT_NEAR(mass, 3 * std::clamp(t - 0.1, 0.0, 0.25), 0.5001 * m) << t;
    EXPECT_EQ(count, seeding::count_emitted(e, snow, 0.02, t)) << t;
  }
}

TEST(Flow, BirthsDoNotDependOnWhenTheyAreAskedFor) {
  seeding::Emitter e = spout(3);
  e.angular_velocity = {0, 1, 0.5};
  const Material snow;
  seeding::EmitterStream whole(e, 2, snow, 7, 0.02), parts(e, 2, snow, 7, 0.02),
      other(e, 3, snow, 7, 0.02);
  const std::vector<seeding::Birth> once = births_of(whole, 0.25);
  std::vector<seeding::Birth> piecewise;
  for (const double t : {0.013, 0.014, 0.1, 0.25})
    for (seeding::Birth b : births_of(parts, t)) {
      b.x += (0.25 - t) * b.v;
      piecewise.push_back(b);
    }
  ASSERT_EQ(piecewise.size(), once.size());
  for (std::size_t k = 0; k < once.size(); ++k) {
    // Rounding of ages and positions of order 1.
    EXPECT_LT((piecewise[k].x - once[k].x).norm(), 1e-13);
    EXPECT_EQ(piecewise[k].v, once[k].v);
  }
  EXPECT_GT((births_of(other, 0.25)[0].x - once[0].x).norm(), 1e-3) << "emitters share a pattern";
}

/// A jet at the rate that its velocity carries away is as dense as packed snow, everywhere.
TEST(Flow, AJetHasTheDensityOfItsMaterial) {
  const Material snow;
  seeding::Emitter e = spout(0.001);
  EXPECT_NEAR(seeding::natural_rate(e, snow, Vec3d::Zero()), 400 * 0.2 * 0.2 * 2, 1e-9);
  seeding::Emitter turned = e;
  turned.shape.rotation = {0, 0, 30};
  turned.velocity = rotation_from_degrees(turned.shape.rotation) * e.velocity;
  EXPECT_NEAR(seeding::natural_rate(turned, snow, Vec3d::Zero()), 400 * 0.2 * 0.2 * 2, 1e-9);
  e.rate = seeding::natural_rate(e, snow, Vec3d::Zero());
  seeding::EmitterStream stream(e, 0, snow, 1, 0.01);
  const std::vector<seeding::Birth> births = births_of(stream, 0.4);
  // The jet reaches from the spout, at 1 m, to 0.8 m below; its ends are as long as the spout.
  const double cell = 0.04;
  double sum_of_squares = 0;
  int cells = 0;
  for (double y = 0.28; y < 0.9; y += cell)
    for (double x = 0; x + 1e-9 < 0.2; x += cell)
      for (double z = -0.3; z + 1e-9 < -0.1; z += cell) {
        double mass = 0;
        for (const seeding::Birth& b : births)
          if (b.x.x() >= x && b.x.x() < x + cell && b.x.y() >= y && b.x.y() < y + cell &&
              b.x.z() >= z && b.x.z() < z + cell)
            mass += b.m;
        sum_of_squares += std::pow(mass / (400 * cell * cell * cell) - 1, 2);
        ++cells;
      }
  // 512 particles a cell: independent random places would deviate by 1 / sqrt(512) = 4.4 %. Even
  // ones do better.
  EXPECT_LT(std::sqrt(sum_of_squares / cells), 0.035);
}

TEST(Flow, AnEmitterWithoutARateFillsItsShapeOnce) {
  seeding::Emitter e = spout(0);
  e.start = 0.2;
  const Material snow;
  seeding::EmitterStream stream(e, 0, snow, 1, 0.02);
  EXPECT_TRUE(births_of(stream, 0.1999).empty());
  const std::vector<seeding::Birth> births = births_of(stream, 0.2);
  double mass = 0;
  for (const seeding::Birth& b : births) mass += b.m;
  EXPECT_NEAR(mass, 400 * 0.2 * 0.04 * 0.2, 1e-9);
  EXPECT_TRUE(births_of(stream, 5).empty());
}

TEST(Flow, ASceneMayBeginEmpty) {
  Simulation simulation = flowing(without_gravity(), {}, {{spout(2)}, {}, 1});
  EXPECT_EQ(simulation.particle_count(), 0u);
  simulation.advance_to(0.1);
  EXPECT_FALSE(simulation.divergence());
  EXPECT_EQ(simulation.particle_count(), seeding::count_emitted(spout(2), Material{}, 0.02, 0.1));
  EXPECT_EQ(simulation.flow_totals().emitted, simulation.particle_count());
  // With snow the steps are those that its sound allows: 0.5 h / c.
  EXPECT_LT(simulation.choose_dt(1).dt, 0.6 * 0.02 / sound_speed(Material{}));
}

/// Transfers keep momentum; gravity pulls a particle from the first whole step of its life on.
TEST(Flow, MomentumIsThatOfTheBirthsAndOfGravity) {
  SolverSettings settings;
  settings.precision = Precision::real64;
  Simulation simulation = flowing(settings, {}, {{spout(5)}, {}, 1});
  double pulled = 0;  // kg s
  while (simulation.time() < 0.12) {
    const double dt = simulation.choose_dt(1).dt;
    pulled += simulation.summary().mass * dt;
    simulation.step(dt);
  }
  const Summary s = simulation.summary();
  const Vec3d expected =
      simulation.flow_totals().emitted_mass * Vec3d(0, -2, 0) + pulled * settings.gravity;
  EXPECT_FALSE(simulation.divergence());
  // Double arithmetic over hundreds of steps.
  EXPECT_LT((s.momentum - expected).norm(), 1e-11 * expected.norm());
  EXPECT_NEAR(s.mass, simulation.flow_totals().emitted_mass, 1e-12);
}

TEST(Flow, SnowThatStaysKeepsItsId) {
  SolverSettings settings;
  ParticleArrays block = box_of_snow({0, 0.3, 0}, {0.1, 0.4, 0.1}, 0.01);
  const std::size_t bodies = block.x.size();
  Simulation simulation = flowing(settings, block, {{spout(5)}, {pit(0.25)}, 1});
  simulation.advance_to(0.06);
  const ParticleArrays before = simulation.particles();
  EXPECT_TRUE(before.id.empty()) << "nothing has gone yet";
  simulation.advance_to(0.35);
  ASSERT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
  const ParticleArrays after = simulation.particles();
  const seeding::FlowTotals totals = simulation.flow_totals();
  EXPECT_GT(totals.removed, bodies / 2);
  EXPECT_EQ(after.x.size(), bodies + totals.emitted - totals.removed);
  EXPECT_NEAR(simulation.summary().mass,
              static_cast<double>(bodies) * block.m[0] + totals.emitted_mass - totals.removed_mass,
              1e-4);
  ASSERT_EQ(after.id.size(), after.x.size());
  EXPECT_TRUE(std::is_sorted(after.id.begin(), after.id.end()));
  // It is removed when it has gone a cell, and a step moves it by less than another.
  for (const Vec3d& x : after.x) EXPECT_GT(x.y(), 0.25 - 2 * 0.02);
  EXPECT_FALSE(after.index_of(after.id.back() + 1));
  EXPECT_EQ(after.index_of(after.id[17]), 17u);
  EXPECT_EQ(after.first_from(after.id[17]), 17u);
  // The newest was born in the spout a moment ago: ids did not move.
  EXPECT_EQ(after.id.back() + 1, bodies + totals.emitted);
  EXPECT_GT(after.x.back().y(), 0.9);
  EXPECT_EQ(simulation.kirchhoff().size(), after.x.size());
  EXPECT_EQ(simulation.cells().size(), after.x.size());
  EXPECT_EQ(staged_step(simulation, 1e-5).grad_v.size(), after.x.size());
}

TEST(Flow, OutsideOfASinkTurnedInsideOut) {
  seeding::Sink room;
  room.shape.form = shapes::Sphere{{0.05, 0.35, 0.05}, 0.2};
  room.outside = true;
  const ParticleArrays block = box_of_snow({0, 0.3, 0}, {0.1, 0.4, 0.1}, 0.01);
  Simulation inside = flowing(without_gravity(), block, {{}, {room}, 1});
  EXPECT_EQ(inside.flow_totals().removed, 0u);
  room.shape.form = shapes::Sphere{{0.05, 0.35, 0.05}, 0.05};
  Simulation cut = flowing(without_gravity(), block, {{}, {room}, 1});
  std::size_t expected = 0;
  for (const Vec3d& x : block.x) expected += (x - Vec3d(0.05, 0.35, 0.05)).norm() <= 0.05;
  EXPECT_EQ(cut.particle_count(), expected) << "the start counts too";
  EXPECT_GT(expected, 300u);
}

TEST(Flow, ThreadsAndTheLatticeChangeNothing) {
  const ParticleArrays block = box_of_snow({0, 0.3, 0}, {0.1, 0.4, 0.1}, 0.006);
  const auto hash = [&](int threads, const sim::Vec3i& origin) {
    Simulation simulation =
        flowing(SolverSettings{}, block, {{spout(5), spout(1)}, {pit(0.25)}, 1}, threads, origin);
    simulation.advance_to(0.2);
    EXPECT_GT(simulation.flow_totals().removed, 500u);
    return simulation.state_hash();
  };
  const std::uint64_t reference = hash(1, sim::Vec3i::Zero());
  EXPECT_EQ(hash(2, sim::Vec3i::Zero()), reference);
  EXPECT_EQ(hash(1, {100, -7, 31}), reference);
}

TEST(Flow, ARestoredRunContinuesBitForBit) {
  const ParticleArrays block = box_of_snow({0, 0.3, 0}, {0.1, 0.4, 0.1}, 0.01);
  const seeding::Flow flow{{spout(5), spout(0)}, {pit(0.25)}, 3};
  for (const double moment : {0.0, 0.1, 0.2, 0.21}) {
    Simulation whole = flowing(SolverSettings{}, block, flow, 2);
    whole.advance_to(moment);
    const std::vector<std::uint8_t> bytes = whole.save();
    Simulation again = flowing(SolverSettings{}, {}, flow, 1);
    again.restore(bytes);
    EXPECT_EQ(again.save(), bytes);
    whole.advance_to(0.3);
    again.advance_to(0.3);
    EXPECT_EQ(again.save(), whole.save()) << moment;
    EXPECT_EQ(again.flow_totals().removed, whole.flow_totals().removed);
    EXPECT_GT(whole.flow_totals().removed, 500u);
    Simulation without = flowing(SolverSettings{}, {}, {});
    EXPECT_THROW(without.restore(bytes), SavedStateError);
  }
}

/// The fastest start in a report is the same after a restore, and knows no later births.
TEST(Flow, ARestoredRunKnowsTheFastestBirth) {
  seeding::Emitter late = spout(5);
  late.start = 0.1;
  late.velocity = {0, -3, 0};
  const seeding::Flow flow{{spout(5), late}, {}, 3};
  const auto fastest_start = [&](double moment, const std::vector<std::uint8_t>* from) {
    Simulation simulation = flowing(SolverSettings{}, {}, flow);
    if (from) simulation.restore(*from);
    if (!from) simulation.advance_to(moment);
    simulation.step(1);  // across many cells: no rule allows it
    return simulation.divergence() ? simulation.divergence()->start.max_speed : -1;
  };
  Simulation whole = flowing(SolverSettings{}, {}, flow);
  whole.advance_to(0.05);
  const std::vector<std::uint8_t> early = whole.save();
  whole.advance_to(0.15);
  const std::vector<std::uint8_t> later = whole.save();
  EXPECT_EQ(fastest_start(0, &later), fastest_start(0.15, nullptr));
  EXPECT_NEAR(fastest_start(0, &later), 3, 1e-6);
  EXPECT_EQ(fastest_start(0, &early), fastest_start(0.05, nullptr));
  EXPECT_LT(fastest_start(0, &early), 2.9);
  whole.restore(early);
  whole.step(1);
  ASSERT_TRUE(whole.divergence());
  EXPECT_EQ(whole.divergence()->start.max_speed, fastest_start(0.05, nullptr));
}

/// Pictures show means over the present particles: the same in a run that began with them.
TEST(Flow, MeansAreOfTheParticlesThatAreLeft) {
  const ParticleArrays block = box_of_snow({0, 0.3, 0}, {0.1, 0.4, 0.1}, 0.01);
  Simulation flowed = flowing(SolverSettings{}, block, {{spout(5)}, {pit(0.25)}, 1});
  flowed.advance_to(0.2);
  ASSERT_GT(flowed.flow_totals().removed, 500u);
  ParticleArrays left = flowed.particles();
  std::vector<double> heights;
  for (const Vec3d& x : left.x) heights.push_back(x.y());
  left.id.clear();
  const Simulation fresh = flowing(SolverSettings{}, left, {});
  const RasterizedNodes found = rasterize(flowed, {heights}), wanted = rasterize(fresh, {heights});
  ASSERT_EQ(found.block, wanted.block);
  for (std::size_t n = 0; n < wanted.mass.size(); ++n)
    // Sums of at most some hundred floats near 1, in another order.
    EXPECT_NEAR(found.mean[0][n], wanted.mean[0][n], 1e-5) << n;
}

/// Emitted particles bring energy, removed ones take it along.
TEST(Flow, EnergyIsAccountedFor) {
  SolverSettings settings = without_gravity();
  settings.precision = Precision::real64;
  const seeding::Flow flow{{spout(5)}, {pit(0.4)}, 1};
  const auto gap = [](const Simulation& simulation) {
    const EnergyAccount account = energy_account(simulation);
    return (account.found - account.explained) / account.scale;
  };
  // All snow moves alike: nothing is lost, and the sums are exact but for rounding.
  Simulation floating = flowing(settings, {}, flow);
  floating.advance_to(0.5);
  EXPECT_GT(floating.flow_totals().removed, 1000u);
  EXPECT_NEAR(gap(floating), 0, 1e-10);

  // A jet that gravity stretches loses energy, more than a tenth of it here; it never gains any.
  settings.gravity = {0, -9.81, 0};
  Simulation falling = flowing(settings, {}, flow);
  falling.advance_to(0.5);
  EXPECT_FALSE(falling.divergence());
  EXPECT_GT(falling.flow_totals().removed, 1000u);
  EXPECT_LT(gap(falling), 1e-3);
  EXPECT_GT(gap(falling), -0.3);
}

TEST(Flow, ImpossibleFlowsAreRefused) {
  seeding::Emitter e = spout(1);
  e.material = "sand";
  EXPECT_THROW(flowing({}, {}, {{e}, {}, 1}), std::invalid_argument);
  e = spout(-1);
  EXPECT_THROW(flowing({}, {}, {{e}, {}, 1}), std::invalid_argument);
  e = spout(1);
  e.shape.form = shapes::Box{{1e9, 0, 0}, {1, 1, 1}};
  Simulation far = flowing({}, {}, {{e}, {}, 1});
  EXPECT_THROW(far.advance_to(0.1), std::invalid_argument);
  e = spout(0);
  e.shape.form = shapes::Box{{0, 0, 0}, {1e3, 1e3, 1e3}};
  e.particles_per_cell = 1000;
  EXPECT_THROW(flowing({}, {}, {{e}, {}, 1}), ShapeError);
}

/// Births at rest: where they are is where they were born.
std::vector<seeding::Birth> births_at_rest(const shapes::Shape& shape, double cell_size,
                                           std::size_t count) {
  seeding::Emitter e;
  e.name = "spring";
  e.material = "snow";
  e.shape = shape;
  const Material snow;
  e.rate =
      snow.density * std::pow(cell_size, 3) / e.particles_per_cell * static_cast<double>(count);
  seeding::EmitterStream stream(e, 0, snow, 1, cell_size);
  return births_of(stream, 1);
}

TEST(Flow, SnowIsAsDenseAtTheFacesOfAnEmitter) {
  const Vec3d size(0.2, 0.04, 0.2), inner = size - Vec3d::Constant(0.005);
  const std::vector<seeding::Birth> births =
      births_at_rest({shapes::Box{{0, 0, 0}, size}}, 0.02, 20000);
  double outer = 0;
  for (const seeding::Birth& b : births) outer += ((b.x.cwiseAbs() - 0.5 * inner).maxCoeff() > 0);
  const double expected = 1 - inner.prod() / size.prod();
  // A quarter of a spacing below the faces. Independent random places would scatter by 1.6 %; with
  // candidates lost at faces it would be 35 % less.
  EXPECT_NEAR(outer / static_cast<double>(births.size()) / expected, 1, 0.05);
}

TEST(Flow, EmittersMuchSmallerThanASpacingEmit) {
  const shapes::Shape shapes[] = {{shapes::Sphere{{0, 0, 0}, 1e-4}},
                                  {shapes::Box{{0, 0, 0}, {1, 1e-5, 1}}},
                                  {shapes::Torus{{0, 0, 0}, 0.5, 0.001}},
                                  {shapes::Torus{{0, 0, 0}, 0.5, 1e-5}}};
  const auto start = std::chrono::steady_clock::now();
  for (const shapes::Shape& shape : shapes) {
    const shapes::Solid solid(shape);
    const shapes::Bounds box = solid.bounds();
    const std::vector<seeding::Birth> births = births_at_rest(shape, 0.05, 4000);
    ASSERT_EQ(births.size(), 4000u);
    double right = 0, out = 0;
    for (const seeding::Birth& b : births) {
      EXPECT_TRUE(solid.contains(b.x));
      right += b.x.x() > 0;
      out += (b.x.cwiseQuotient(box.max)).cwiseAbs().maxCoeff() > 0.5;
    }
    // The thinnest ring has some fifty places: half of them, give or take a third.
    EXPECT_NEAR(right / 4000, 0.5, 0.17);
    // Nothing near the middle only: of a ball less than a third is further in than half its radius.
    EXPECT_GT(out / 4000, 0.6);
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  EXPECT_LT(taken.count(), 20) << "100 000 candidates for each place would take half a minute";
}

TEST(Flow, AnEmitterThatNeverOpensCostsNothingAndBirthsHappenOnce) {
  seeding::Emitter e = spout(0);
  const Material snow;
  seeding::EmitterStream whole(e, 0, snow, 1, 0.02), again(e, 0, snow, 1, 0.02);
  EXPECT_FALSE(births_of(whole, 0.1).empty());
  again.restore(whole.state());
  EXPECT_TRUE(births_of(again, 0.2).empty());
  // 10^9 particles: 24 GB, if they were placed at once.
  e.start = 1e6;
  e.shape.form = shapes::Box{{0, 0, 0}, {10, 10, 10}};
  seeding::EmitterStream never(e, 0, snow, 1, 0.02);
  EXPECT_TRUE(births_of(never, 1).empty());
}

/// A retry of a frame, and a person who goes back in the window: the shape is filled once more.
TEST(Flow, ABodyThatAppearsIsTheSameSnowAfterGoingBackToBeforeIt) {
  seeding::Emitter e = spout(0);
  e.shape.form = shapes::Sphere{{0, 0, 0}, 0.33};
  seeding::EmitterStream stream(e, 0, Material(), 1, 0.05);
  const auto before = stream.state();
  const std::vector<seeding::Birth> first = births_of(stream, 0.1);
  ASSERT_GT(first.size(), 1000u);
  stream.restore(before);
  const std::vector<seeding::Birth> again = births_of(stream, 0.1);
  ASSERT_EQ(again.size(), first.size());
  for (std::size_t k = 0; k < first.size(); ++k) {
    EXPECT_EQ(again[k].x, first[k].x);
    EXPECT_EQ(again[k].V0, first[k].V0);
  }
}

TEST(Flow, FastSnowDoesNotFlyThroughASink) {
  ParticleArrays block = box_of_snow({0, 0.3, 0}, {0.1, 0.1, 0.1}, 0.01);
  for (Vec3d& v : block.v) v = {0, -15, 0};
  // Two cells thick: 8 steps at 0.4 cells would cross it.
  seeding::Sink slab;
  slab.shape.form = shapes::Box{{0.05, 0, 0.05}, {10, 0.04, 10}};
  Simulation simulation = flowing(without_gravity(), block, {{}, {slab}, 1});
  simulation.advance_to(0.05);
  ASSERT_FALSE(simulation.divergence());
  EXPECT_EQ(simulation.particle_count(), 0u);
  EXPECT_EQ(simulation.choose_dt(1).limit, sim::DtLimit::max_dt) << "what has left limits nothing";
}

/// The grid is that of the snow also after steps in which a sink took some, and after a restore.
TEST(Flow, TheGridIsThatOfTheSnowAtAnyTime) {
  ParticleArrays block = box_of_snow({0, 0.1, 0}, {0.1, 0.3, 0.1}, 0.01);
  for (Vec3d& v : block.v) v = {0, -5, 0};
  Simulation simulation = flowing(without_gravity(), block, {{}, {pit(0)}, 1});
  int removals = 0;
  for (std::uint64_t before = 0; simulation.particle_count() > 0;) {
    simulation.step(1e-3);
    const Summary now = simulation.summary();
    if (now.removed > before) ++removals;
    before = now.removed;
    Simulation again = flowing(without_gravity(), {}, {{}, {pit(0)}, 1});
    again.restore(simulation.save());
    EXPECT_EQ(again.summary().grid_blocks, now.grid_blocks);
    EXPECT_EQ(now.grid_blocks > 0, now.particles > 0) << now.time;
  }
  EXPECT_GT(removals, 3);
  EXPECT_EQ(simulation.summary().grid_blocks, 0u);
}

TEST(Flow, AParticleAtTheFarCornerOfItsBlockIsSeen) {
  SolverSettings settings = without_gravity();
  const double h = settings.cell_size;
  // Blocks are of stencils: the last step starts at 4.95 cells and goes up to nine tenths of a
  // cell.
  const Vec3d step = Vec3d::Constant(0.9 / std::sqrt(3.0));
  ParticleArrays one;
  one.x = {h * (Vec3d::Constant(4.95) - step)};
  one.v = {h / 1e-3 * step};
  one.m = {400 * std::pow(0.01, 3)};
  one.V0 = {std::pow(0.01, 3)};
  one.material = {0};
  seeding::Sink dot;
  dot.shape.form = shapes::Sphere{h * (Vec3d::Constant(4.95) + step), 0.2 * h};
  Simulation simulation = flowing(settings, one, {{}, {dot}, 1});
  simulation.step(1e-3);
  EXPECT_EQ(simulation.particle_count(), 1u);
  simulation.step(1e-3);
  EXPECT_EQ(simulation.particle_count(), 0u);
}

// ---- room ---------------------------------------------------------------------------------------

/// A nozzle 0.3 m above a floor, as fast as its velocity carries snow away: the pile reaches it.
seeding::Emitter pouring_nozzle() {
  seeding::Emitter e;
  e.name = "nozzle";
  e.material = "snow";
  e.shape.form = shapes::Box{{0, 0.2, 0}, {0.12, 0.04, 0.12}};
  e.velocity = {0, -1.5, 0};
  e.rate = 1;  // 0 fills the shape once
  e.rate = seeding::natural_rate(e, Material{}, Vec3d::Zero());
  return e;
}

shapes::Collider floor_at(double y) {
  shapes::Collider floor;
  floor.shape.form = shapes::Plane{{0, y, 0}, {0, 1, 0}};
  floor.friction = 0.5;
  return floor;
}

Simulation pouring(const SolverSettings& settings, int threads = 1) {
  return Simulation(settings, {Material{}}, {floor_at(0.003)}, {}, threads, sim::Vec3i::Zero(),
                    {{pouring_nozzle()}, {}, 1});
}

/// kg/m3, of the cell that holds most.
double densest_cell(const Simulation& simulation, double h) {
  std::map<std::array<long, 3>, double> mass;
  const ParticleArrays particles = simulation.particles();
  for (std::size_t p = 0; p < particles.x.size(); ++p) {
    std::array<long, 3> cell;
    for (int a = 0; a < 3; ++a)
      cell[static_cast<std::size_t>(a)] = std::lround(std::floor(particles.x[p][a] / h));
    mass[cell] += particles.m[p];
  }
  double most = 0;
  for (const auto& [cell, m] : mass) most = std::max(most, m / (h * h * h));
  return most;
}

/// Births that did not look reached 9900 kg/m3 here, eleven times as dense as ice.
TEST(FlowRoom, AnEmitterThatItsOwnPileFillsWaits) {
  SolverSettings settings;
  settings.transfer = Transfer::flip;  // whose packed snow stays soft: a tenth of the steps
  Simulation simulation = pouring(settings);
  simulation.advance_to(0.8);
  ASSERT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
  const seeding::FlowTotals totals = simulation.flow_totals();
  EXPECT_GT(totals.withheld, totals.emitted / 10);
  EXPECT_EQ(totals.emitted + totals.withheld,
            seeding::count_emitted(pouring_nozzle(), Material{}, 0.02, 0.8));
  EXPECT_EQ(simulation.withheld(), std::vector<std::uint64_t>{totals.withheld});
  EXPECT_EQ(simulation.summary().withheld, totals.withheld);
  // Eight particles a cell at random places leave some cells with twice the mean, and the pile
  // packs what lies at its foot.
  EXPECT_LT(densest_cell(simulation, 0.02), 1000);
}

TEST(FlowRoom, AFreeStreamIsNotWithheld) {
  for (const Transfer transfer : {Transfer::flip, Transfer::mls}) {
    SolverSettings settings;
    settings.transfer = transfer;
    settings.kernel = transfer == Transfer::mls ? Kernel::quadratic : Kernel::cubic;
    Simulation simulation = flowing(settings, {}, {{pouring_nozzle()}, {}, 1});
    simulation.advance_to(0.5);
    EXPECT_EQ(simulation.flow_totals().withheld, 0u);
    EXPECT_EQ(simulation.flow_totals().emitted,
              seeding::count_emitted(pouring_nozzle(), Material{}, 0.02, 0.5));
  }
}

/// A jet of snow of any J_P has what is asked for up to its natural rate, density / J_P x section x
/// speed, and the density / J_P of its snow there; beyond it both stay as they are, and the rest is
/// withheld. Snow packed to a fourth was withheld at any rate, and rates of twice the natural one
/// made snow of 1.6 times its density without stress.
TEST(FlowRoom, AJetIsAsDenseAsItsSnowAtAnyRateBeyondTheNaturalOne) {
  SolverSettings settings = without_gravity();
  settings.cell_size = 0.04;
  Material soft;
  soft.density = 100;
  soft.youngs_modulus = 500;
  for (const double J_P : {0.25, 0.5, 1.0, 2.0, 6.0})
    for (const double ratio : {0.8, 1.0, 1.25, 2.0, 10.0}) {
      SCOPED_TRACE(testing::Message() << "J_P " << J_P << ", " << ratio << " of the natural rate");
      seeding::Emitter e;
      e.name = "spout";
      e.material = "snow";
      e.shape.form = shapes::Box{{0, 1, 0}, {0.2, 0.1, 0.2}};
      e.velocity = {0, -2, 0};
      e.J_P = J_P;
      const double natural = soft.density / J_P * 0.04 * 2;
      e.rate = ratio * natural;
      EXPECT_NEAR(seeding::natural_rate(e, soft, Vec3d::Zero()), natural, 1e-9 * natural);
      Simulation simulation(settings, {soft}, {}, {}, 1, sim::Vec3i::Zero(), {{e}, {}, 1});
      simulation.advance_to(0.1);
      const double early = simulation.flow_totals().emitted_mass;
      simulation.advance_to(0.3);
      const seeding::FlowTotals totals = simulation.flow_totals();
      const double comes = std::min(ratio, 1.0),
                   one = totals.emitted_mass / static_cast<double>(totals.emitted);
      EXPECT_NEAR((totals.emitted_mass - early) / 0.2 / natural, comes, 0.005);
      EXPECT_NEAR(static_cast<double>(totals.withheld) * one, (ratio - comes) * natural * 0.3,
                  2 * one);
      // Snow counts between the ends of the jet, which are as long as the spout.
      double mass = 0;
      const ParticleArrays particles = simulation.particles();
      for (std::size_t p = 0; p < particles.x.size(); ++p)
        if (particles.x[p].y() > 0.55 && particles.x[p].y() < 0.9) mass += particles.m[p];
      EXPECT_NEAR(mass / (0.04 * 0.35) * J_P / soft.density, comes, 0.02);
    }
}

/// Snow that nothing carries away fills its emitter once.
TEST(FlowRoom, AnEmitterAtRestWithoutGravityIsFilledOnce) {
  Material soft;
  soft.youngs_modulus = 500;
  for (const double J_P : {0.5, 1.0, 3.0}) {
    seeding::Emitter e;
    e.name = "well";
    e.material = "snow";
    e.shape.form = shapes::Box{{0, 1, 0}, {0.1, 0.1, 0.1}};
    e.J_P = J_P;
    e.rate = 100;
    Simulation simulation(without_gravity(), {soft}, {}, {}, 1, sim::Vec3i::Zero(), {{e}, {}, 1});
    simulation.advance_to(0.05);
    const double full = 400 / J_P * 1e-3;
    EXPECT_LT(simulation.flow_totals().emitted_mass, (1 + 1e-2) * full) << J_P;
    EXPECT_GT(simulation.flow_totals().emitted_mass, 0.95 * full) << J_P;
    EXPECT_GT(simulation.flow_totals().withheld, 0u);
  }
}

/// Snow that turns at birth has the affine velocity of it where particles keep their own velocity:
/// nothing is added to it in the first steps.
TEST(Flow, SnowThatTurnsAtBirthKeepsItsSpinAndGainsNoEnergyWithAflip) {
  seeding::Emitter e;
  e.name = "thrower";
  e.material = "snow";
  e.shape.form = shapes::Sphere{{0, 0.5, 0}, 0.06};
  e.angular_velocity = {1, -2, 12};
  e.start = 0.001;
  SolverSettings settings;
  settings.transfer = Transfer::aflip;
  settings.gravity.setZero();
  Simulation simulation = flowing(settings, {}, {{e}, {}, 1});
  while (simulation.particle_count() == 0) simulation.step(1e-4);
  Mat3d C;
  C << 0, -12, -2, 12, 0, -1, 2, 1, 0;
  for (const Mat3d& C_p : simulation.particles().C) EXPECT_EQ(C_p, C);
  const Summary start = simulation.summary();
  for (int k = 0; k < 100; ++k) simulation.step(1e-4);
  const Summary end = simulation.summary();
  EXPECT_LT(end.kinetic_energy + end.elastic_energy, 1.001 * start.kinetic_energy);
  EXPECT_NEAR(end.angular_momentum[2] / start.angular_momentum[2], 1, 1e-3);
  settings.transfer = Transfer::apic;
  Simulation apic = flowing(settings, {}, {{e}, {}, 1});
  while (apic.particle_count() == 0) apic.step(1e-4);
  for (const Mat3d& C_p : apic.particles().C) EXPECT_TRUE(C_p.isZero());
}

TEST(FlowRoom, TheClockOfAnEmitterStopsWhileABirthWaits) {
  seeding::Emitter e = spout(3);
  e.end = 1.0;
  const Material snow;
  const double period = snow.density * std::pow(0.02, 3) / e.particles_per_cell / e.rate;
  seeding::EmitterStream stream(e, 0, snow, 1, 0.02), free(e, 0, snow, 1, 0.02);
  std::vector<seeding::Birth> births;
  const auto none = [](const seeding::Birth&) { return false; };
  stream.advance_to(0.1, births);
  const std::size_t before = births.size();
  for (const double t : {0.15, 0.2, 0.3}) stream.advance_to(t, births, none);
  EXPECT_EQ(births.size(), before);
  EXPECT_EQ(stream.state().withheld, births_of(free, 0.3).size() - before);
  births.clear();
  // No flood of what has waited: as much per second as before.
  stream.advance_to(0.4, births);
  EXPECT_NEAR(static_cast<double>(births.size()), 0.1 / period, 1.01);
  // It closes when it would have closed. One birth more or less: rounding.
  births.clear();
  stream.advance_to(7, births);
  EXPECT_NEAR(static_cast<double>(births.size()), 0.6 / period, 1.01);
  EXPECT_NEAR(static_cast<double>(stream.state().withheld), 0.2 / period, 1.01);
}

/// The place stays taken until long after. The birth that waited has no place by then: its snow
/// would have flown on from the shape for as long, and was born far from it.
TEST(FlowRoom, ABirthThatWaitsWhenItsEmitterClosesIsLeftOut) {
  seeding::Emitter e = spout(3);
  e.end = 0.3;
  const Material snow;
  const auto none = [](const seeding::Birth&) { return false; };
  // The last try before the end, at it, and after it; or none between the first and the end.
  for (const std::vector<double>& tries :
       {std::vector<double>{0.2, 0.299, 0.301, 0.5}, {0.2, 0.3, 0.5}, {0.4, 0.5}}) {
    seeding::EmitterStream stream(e, 0, snow, 1, 0.02);
    std::vector<seeding::Birth> births;
    stream.advance_to(0.1, births);
    for (const double t : tries) stream.advance_to(t, births, none);
    const std::size_t before = births.size();
    seeding::EmitterStream again(e, 0, snow, 1, 0.02);
    again.restore(stream.state());
    for (seeding::EmitterStream* s : {&stream, &again}) {
      for (const double t : {0.6, 7.0}) s->advance_to(t, births);
      EXPECT_EQ(births.size(), before);
      EXPECT_EQ(s->state().born + s->state().withheld, seeding::count_emitted(e, snow, 0.02, 7));
    }
  }
  // Births that nobody looked at before the end were due before it, and are born.
  seeding::EmitterStream late(e, 0, snow, 1, 0.02);
  EXPECT_EQ(births_of(late, 0.301).size(), seeding::count_emitted(e, snow, 0.02, 7));
}

/// A body that appears where half of its shape is full.
TEST(FlowRoom, AnEmitterThatFillsItsShapeOnceLeavesOutPlacesThatAreFull) {
  const ParticleArrays block = box_of_snow({0, 0, 0}, {0.2, 0.2, 0.2}, 0.01);
  seeding::Emitter e;
  e.name = "late";
  e.material = "snow";
  e.shape.form = shapes::Box{{0.2, 0.1, 0.1}, {0.2, 0.2, 0.2}};
  for (const double start : {0.0, 0.01}) {
    e.start = start;
    Simulation simulation = flowing(without_gravity(), block, {{e}, {}, 1});
    simulation.advance_to(0.02);
    const seeding::FlowTotals totals = simulation.flow_totals();
    const auto whole = static_cast<double>(totals.emitted + totals.withheld);
    EXPECT_EQ(whole, 8000);
    // Room begins at the face of the block, to a fraction of a spacing in ten.
    EXPECT_NEAR(static_cast<double>(totals.withheld) / whole, 0.5, 0.05) << start;
    EXPECT_LT(densest_cell(simulation, 0.02), 700) << start;
  }
}

TEST(FlowRoom, ThreadsAndInterruptionsChangeNothing) {
  for (const TimeStep time_step : {TimeStep::adaptive, TimeStep::fixed}) {
    SolverSettings settings;
    settings.time_step = time_step;
    settings.dt = 2e-4;
    Simulation whole = pouring(settings, 2);
    whole.advance_to(0.25);
    ASSERT_GT(whole.flow_totals().withheld, 0u);
    const std::vector<std::uint8_t> bytes = whole.save();
    Simulation again = pouring(settings, 1);
    again.restore(bytes);
    EXPECT_EQ(again.flow_totals().withheld, whole.flow_totals().withheld);
    whole.advance_to(0.3);
    again.advance_to(0.3);
    EXPECT_EQ(again.save(), whole.save());
  }
}

TEST(FlowRoom, StagesAndSweepsSeeTheSameRoom) {
  SolverSettings settings;
  settings.precision = Precision::real64;
  settings.time_step = TimeStep::fixed;
  settings.dt = 2e-4;
  Simulation fused = pouring(settings);
  settings.bypass = {Stage::volumes};  // all are given: it changes nothing
  Simulation staged = pouring(settings);
  fused.advance_to(0.22);
  staged.advance_to(0.22);
  ASSERT_GT(fused.flow_totals().withheld, 0u);
  EXPECT_EQ(staged.flow_totals().withheld, fused.flow_totals().withheld);
}

// ---- loose snow ---------------------------------------------------------------------------------

TEST(FlowRoom, LooseSnowIsLessDense) {
  seeding::Emitter e = spout(3);
  e.J_P = 1.5;
  const Material snow;
  seeding::EmitterStream stream(e, 0, snow, 1, 0.02);
  const double volume = std::pow(0.02, 3) / e.particles_per_cell;
  double mass = 0;
  for (const seeding::Birth& b : births_of(stream, 0.25)) {
    EXPECT_EQ(b.J_P, 1.5);
    EXPECT_DOUBLE_EQ(b.V0, volume / 1.5);
    EXPECT_DOUBLE_EQ(b.m, snow.density * b.V0);
    mass += b.m;
  }
  EXPECT_NEAR(mass, 3 * 0.25, snow.density * volume);
  e.rate = 0;
  seeding::EmitterStream whole(e, 0, snow, 1, 0.02);
  mass = 0;
  for (const seeding::Birth& b : births_of(whole, 0)) mass += b.m;
  EXPECT_NEAR(mass, 400 / 1.5 * 0.2 * 0.04 * 0.2, 1e-9);
  Simulation simulation = flowing(without_gravity(), {}, {{e}, {}, 1});
  EXPECT_DOUBLE_EQ(simulation.summary().max_J_P, 1.5);
}

}  // namespace
