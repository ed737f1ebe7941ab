/// Parameters changed during a run: they act at once, anything that does not depend on them stays,
/// and no change alone breaks a rule of a healthy run.

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "sim/checks/watch.h"
#include "sim/laws/list.h"
#include "tests/support/snow.h"

namespace {

using namespace neve;
using namespace neve::sim;
using namespace neve::test;

/// Everything that a simulation is built from and that may change.
struct World {
  SolverSettings settings;
  std::vector<Material> materials{Material{}, Material{}};
  std::vector<shapes::Collider> colliders;

  World() {
    materials[1].name = "stiff";
    materials[1].model = laws::model::corotated;
    shapes::Collider ball;
    ball.name = "ball";
    ball.shape.form = shapes::Sphere{{0.05, 0.02, 0.03}, 0.05};
    ball.angular_velocity = {0, 3, 1};
    ball.velocity = {0.1, 0.2, 0};
    colliders = {plane({0, 0.013, 0}, {0, 1, 0}, 0.5), ball};
  }
  Simulation simulate(const ParticleArrays& particles, int threads = 1) const {
    return Simulation(settings, materials, colliders, particles, threads);
  }
  void apply_to(Simulation& simulation) const { simulation.apply(settings, materials, colliders); }
};

/// A ball of two materials about to hit the floor.
ParticleArrays ball_of_two_materials() {
  ParticleArrays p = ball_of_snow({0.01, 0.11, -0.02}, 0.07, 0.01, {0.3, -4, 0.1});
  p.material.resize(p.x.size());
  for (std::size_t q = 0; q < p.x.size(); ++q) p.material[q] = p.x[q].x() > 0.05;
  return p;
}

void advance(Simulation& simulation, int steps) {
  for (int k = 0; k < steps; ++k) simulation.step(simulation.choose_dt(1).dt);
}

/// Returns a simulation in the middle of the impact.
Simulation crushed(const World& world, int threads = 1) {
  Simulation simulation = world.simulate(ball_of_two_materials(), threads);
  advance(simulation, 40);
  EXPECT_GT(simulation.summary().elastic_energy, 0);
  EXPECT_FALSE(simulation.divergence());
  return simulation;
}

TEST(Apply, ApplyingEqualSettingsChangesNoBit) {
  World world;
  for (const Transfer transfer : {Transfer::flip, Transfer::mls}) {
    world.settings.transfer = transfer;
    Simulation left_alone = world.simulate(ball_of_two_materials()),
               applied = world.simulate(ball_of_two_materials());
    for (int k = 0; k < 45; ++k) {
      world.apply_to(applied);
      advance(left_alone, 1);
      advance(applied, 1);
    }
    world.apply_to(applied);
    EXPECT_EQ(applied.save(), left_alone.save());
  }
}

TEST(Apply, ParametersOfOtherLawsChangeNoBit) {
  World world;
  Simulation simulation = crushed(world), untouched = crushed(world);
  world.materials[0].friction_angle += 10;
  world.materials[0].consolidation_pressure += 1000;
  for (double& number : world.materials[0].own) number += 0.5;
  world.materials[1].critical_stretch *= 2;
  world.apply_to(simulation);
  EXPECT_EQ(simulation.save(), untouched.save());
  advance(simulation, 20);
  advance(untouched, 20);
  EXPECT_EQ(simulation.save(), untouched.save());
}

TEST(Apply, ApplyingRefusesChangesThatNeedARestart) {
  const World world;
  Simulation simulation = crushed(world);
  const std::vector<std::uint8_t> before = simulation.save();
  const auto refused = [&](const std::function<void(World&)>& edit) {
    World other = world;
    other.materials[0].youngs_modulus *= 2;
    edit(other);
    EXPECT_THROW(other.apply_to(simulation), std::invalid_argument);
    EXPECT_EQ(simulation.save(), before);
  };
  refused([](World& w) { w.settings.cell_size = 0.01; });
  refused([](World& w) { w.settings.precision = Precision::real64; });
  refused([](World& w) { w.settings.period = {2, 0, 0}; });
  refused([](World& w) { w.materials[1].density = 300; });
  refused([](World& w) { w.materials.pop_back(); });
  refused([](World& w) { w.materials.emplace_back(); });
  refused([](World& w) { w.colliders.resize(65, w.colliders[0]); });
  refused([](World& w) { w.colliders[1].shape.form = shapes::Points{}; });
  // The dt of the next step has not changed either.
  const Simulation again = crushed(world);
  EXPECT_EQ(simulation.choose_dt(1).dt, again.choose_dt(1).dt);
}

TEST(Apply, StressAndLimitsAreThoseOfTheNewMaterialAndTheRestStays) {
  for (const Precision precision : {Precision::single, Precision::real64}) {
    World world;
    world.settings.precision = precision;
    world.settings.shock_viscosity = 0;  // of the step, not of the state
    Simulation simulation = crushed(world);
    const ParticleArrays before = simulation.particles();
    const std::vector<Mat3d> tau = simulation.kirchhoff();
    const double dt = simulation.choose_dt(1).dt;

    world.materials[0].youngs_modulus *= 100;
    world.materials[0].poisson_ratio = 0.3;
    world.materials[0].hardening = 12;
    world.apply_to(simulation);

    // Results of a simulation that starts from this state.
    const Simulation fresh = world.simulate(before);
    const std::vector<Mat3d> after = simulation.kirchhoff(), expected = fresh.kirchhoff();
    std::size_t stressed = 0;
    for (std::size_t q = 0; q < tau.size(); ++q) {
      if (before.material[q] == 1) {
        EXPECT_EQ(after[q], tau[q]) << "of the other material";
      } else {
        EXPECT_EQ(after[q], expected[q]) << q;
        stressed += after[q] != tau[q];
      }
    }
    EXPECT_GT(stressed, tau.size() / 4);
    EXPECT_EQ(simulation.step_limits().max_sound_speed, fresh.step_limits().max_sound_speed);
    // Ten times the speed of sound, and more by hardening.
    EXPECT_LT(simulation.choose_dt(1).dt, 0.11 * dt);

    const ParticleArrays now = simulation.particles();
    EXPECT_EQ(now.x, before.x);
    EXPECT_EQ(now.v, before.v);
    EXPECT_EQ(now.F_E, before.F_E);
    EXPECT_EQ(now.J_P, before.J_P);
    EXPECT_EQ(now.V0, before.V0);
    advance(simulation, 50);
    EXPECT_FALSE(simulation.divergence());
  }
}

TEST(Apply, AModelIsThatOfTheParticlesFromNowOn) {
  World world;
  Simulation simulation = crushed(world);
  world.materials[0].model = laws::model::neo_hookean;
  world.materials[1].model = laws::model::snow;
  world.apply_to(simulation);
  const ParticleArrays now = simulation.particles();
  const Simulation fresh = world.simulate(now);
  EXPECT_EQ(simulation.kirchhoff(), fresh.kirchhoff());
  const double worst = simulation.summary().min_J_P;
  advance(simulation, 60);
  EXPECT_FALSE(simulation.divergence());
  // Only particles that are snow now yield.
  const ParticleArrays later = simulation.particles();
  std::size_t yielded = 0;
  for (std::size_t q = 0; q < later.x.size(); ++q) {
    if (later.material[q] == 0)
      EXPECT_EQ(later.J_P[q], now.J_P[q]);
    else
      yielded += later.J_P[q] != now.J_P[q];
  }
  EXPECT_GT(yielded, 0u);
  EXPECT_LT(worst, 1);
}

struct Change {
  const char* what;
  std::function<void(World&)> edit;
};

std::vector<Change> changes() {
  return {
      {"much stiffer", [](World& w) { w.materials[0].youngs_modulus *= 1e3; }},
      {"much softer", [](World& w) { w.materials[0].youngs_modulus *= 1e-3; }},
      {"harder", [](World& w) { w.materials[0].hardening = 20; }},
      {"brittle", [](World& w) { w.materials[0].critical_stretch = 1e-4; }},
      {"rubber", [](World& w) { w.materials[0].model = laws::model::neo_hookean; }},
      {"weightless", [](World& w) { w.settings.gravity.setZero(); }},
      {"heavy",
       [](World& w) {
         w.settings.gravity = {3, -98.1, 0};
       }},
      {"apic", [](World& w) { w.settings.transfer = Transfer::apic; }},
      {"mls", [](World& w) { w.settings.transfer = Transfer::mls; }},
      {"flip", [](World& w) { w.settings.transfer = Transfer::flip; }},
      {"aflip", [](World& w) { w.settings.transfer = Transfer::aflip; }},
      {"asflip", [](World& w) { w.settings.transfer = Transfer::asflip; }},
      {"quadratic", [](World& w) { w.settings.kernel = Kernel::quadratic; }},
      {"pic", [](World& w) { w.settings.advect = Advect::pic, w.settings.flip_ratio = 0; }},
      {"short steps", [](World& w) { w.settings.max_dt = 1e-8; }},
      {"small strains", [](World& w) { w.settings.strain_limit = 1e-3; }},
      {"fixed", [](World& w) { w.settings.time_step = TimeStep::fixed, w.settings.dt = 5e-5; }},
      {"semi-implicit", [](World& w) { w.settings.beta = 1, w.settings.solve_tolerance = 1e-5; }},
      {"explicit", [](World& w) { w.settings.beta = 0; }},
      {"no floor", [](World& w) { w.colliders.clear(); }},
      {"another ball",
       [](World& w) {
         w.colliders.push_back(w.colliders[1]);
         w.colliders.back().name = "other";
       }},
      {"everything",
       [](World& w) {
         w.materials[0].youngs_modulus *= 10;
         w.materials[1].model = laws::model::snow;
         w.settings.gravity = {1, 0, 0};
         w.settings.transfer = Transfer::apic;
         w.settings.kernel = Kernel::quadratic;
         w.colliders[0].friction = 0;
         w.colliders[1].velocity = {0, 1, 0};
       }},
  };
}

TEST(Apply, AChangeAloneBreaksNoRule) {
  for (const Transfer start : {Transfer::flip, Transfer::mls})
    for (const Change& change : changes()) {
      World world;
      world.settings.transfer = start;
      Simulation simulation = crushed(world);
      const EnergyAccount before = energy_account(simulation);
      change.edit(world);
      world.apply_to(simulation);
      const EnergyAccount after = energy_account(simulation);
      // The unexplained energy stays the same, to rounding of sums.
      EXPECT_NEAR(after.found - after.explained, before.found - before.explained,
                  1e-12 * (before.scale + after.scale))
          << change.what;
      EXPECT_GE(after.scale, before.scale) << change.what;
      // The run reaches the end of an advance, where energy is looked at, in a hundred steps.
      simulation.advance_to(simulation.time() + 100 * simulation.choose_dt(1).dt);
      EXPECT_FALSE(simulation.divergence())
          << change.what << ": " << simulation.divergence()->sentence;
    }
}

/// Falling under one gravity, then another: the budget knows what each did.
TEST(Apply, TheWorkOfEachGravityIsCounted) {
  World world;
  world.colliders.clear();
  Simulation simulation = world.simulate(ball_of_two_materials());
  advance(simulation, 20);
  for (const double g : {-30.0, 0.0, 12.0}) {
    world.settings.gravity = {0, g, 0};
    world.apply_to(simulation);
    advance(simulation, 20);
  }
  const EnergyAccount account = energy_account(simulation);
  // Symplectic Euler is off by g^2 t dt/2 per mass; less than 1 % here.
  EXPECT_NEAR(account.found, account.explained, 0.01 * account.explained);
}

/// Energy that nothing explains is still found after a change: the book was not simply closed.
TEST(Apply, TheRuleOfEnergyStillHolds) {
  World world;
  Simulation simulation = crushed(world);
  world.settings.gravity = {0, -5, 0};
  world.apply_to(simulation);
  // Steps far beyond what the stiffness allows, each on its own told to.
  for (int k = 0; k < 400 && !simulation.divergence(); ++k) simulation.step(2e-3);
  EXPECT_TRUE(simulation.divergence());
}

TEST(Apply, UnwatchedStepsBreakNoRuleLater) {
  World world;
  Simulation simulation = crushed(world);
  world.settings.bypass = {Stage::deformation};
  world.settings.gravity = {0, 30, 0};
  world.apply_to(simulation);
  advance(simulation, 50);
  world.settings.bypass.clear();
  world.apply_to(simulation);
  EXPECT_NEAR(energy_account(simulation).ratio(), 1, 1e-9);
  simulation.advance_to(simulation.time() + 0.01);
  EXPECT_FALSE(simulation.divergence());
}

/// More than 20 000 particles, so that three threads have work.
TEST(Apply, SameBitsAtAnyNumberOfThreads) {
  const ParticleArrays p = ball_of_snow({0.01, 0.17, -0.02}, 0.15, 0.0085, {0.3, -4, 0.1});
  ASSERT_GE(p.x.size(), 20000u);
  const auto hash = [&](int threads) {
    World world;
    Simulation simulation = world.simulate(p, threads);
    for (const Change& change : changes()) {
      // The one before may have taken them away.
      if (world.colliders.empty()) world.colliders = World().colliders;
      change.edit(world);
      world.apply_to(simulation);
      advance(simulation, 2);
    }
    return simulation.state_hash();
  };
  const std::uint64_t one = hash(1);
  EXPECT_EQ(hash(2), one);
  EXPECT_EQ(hash(5), one);
}

TEST(Apply, ManyChangesAtOneStepAreOneChange) {
  World world;
  Simulation at_once = crushed(world), in_pieces = crushed(world);
  for (const double factor : {3.0, 0.01, 40.0}) {
    world.materials[0].youngs_modulus = 1.4e5 * factor;
    world.colliders[1].velocity = {factor, 0, 0};
    world.apply_to(in_pieces);
  }
  world.settings.transfer = Transfer::apic;
  world.apply_to(in_pieces);
  world.apply_to(at_once);
  advance(at_once, 40);
  advance(in_pieces, 40);
  EXPECT_EQ(at_once.state_hash(), in_pieces.state_hash());
}

/// A session may look at an older moment between two changes, and come back by a saved state.
TEST(Apply, ManyChangesAtOneStepAreOneChangeAlsoAcrossASavedState) {
  using Edit = std::function<void(World&)>;
  const Edit stiffer = [](World& w) { w.materials[0].youngs_modulus *= 2; };
  const Edit poisson = [](World& w) { w.materials[0].poisson_ratio = 0.3; };
  const Edit inviscid = [](World& w) { w.settings.shock_viscosity = 0; };
  const Edit quadratic = [](World& w) { w.settings.kernel = Kernel::quadratic; };
  const auto transfer = [](Transfer to) -> Edit {
    return [to](World& w) { w.settings.transfer = to; };
  };
  const std::vector<std::vector<Edit>> all{
      {stiffer, poisson},
      {inviscid, stiffer},
      {transfer(Transfer::asflip), quadratic},
      {transfer(Transfer::apic), transfer(Transfer::asflip), stiffer}};
  for (std::size_t k = 0; k < all.size(); ++k)
    for (const bool is_saved : {false, true}) {
      SCOPED_TRACE(std::to_string(k) + (is_saved ? ", saved between" : ""));
      World world, last;
      Simulation at_once = crushed(last);
      for (const Edit& edit : all[k]) edit(last);
      last.apply_to(at_once);
      auto in_pieces = std::make_unique<Simulation>(crushed(world));
      for (const Edit& edit : all[k]) {
        edit(world);
        world.apply_to(*in_pieces);
        if (!is_saved) continue;
        auto again = std::make_unique<Simulation>(world.simulate({}));
        again->restore(in_pieces->save());
        in_pieces = std::move(again);
      }
      advance(at_once, 10);
      advance(*in_pieces, 10);
      EXPECT_EQ(in_pieces->state_hash(), at_once.state_hash());
    }
}

/// The stress that viscosity adds in a shock is of the step that made it: changes of almost nothing
/// in each step, as a curve makes them, do almost nothing. The bound is rounding in double
/// precision over 60 steps; without that stress the energies differ by percents.
TEST(Apply, AChangeKeepsTheStressOfShocks) {
  World world;
  world.settings.precision = Precision::real64;
  Simulation untouched = world.simulate(ball_of_two_materials());
  Simulation changed = world.simulate(ball_of_two_materials());
  for (int k = 0; k < 60; ++k) {
    const double dt = untouched.choose_dt(1).dt;
    untouched.step(dt);
    changed.step(dt);
    for (Material& material : world.materials) material.youngs_modulus *= 1 + 1e-13;
    world.apply_to(changed);
  }
  const Summary a = untouched.summary(), b = changed.summary();
  EXPECT_GT(a.elastic_energy, 0);
  EXPECT_NEAR(b.kinetic_energy / a.kinetic_energy, 1, 1e-8);
  EXPECT_NEAR(b.elastic_energy / a.elastic_energy, 1, 1e-8);
}

TEST(Apply, ARestoredRunContinuesBitForBit) {
  for (const Change& change : changes()) {
    World world;
    Simulation whole = crushed(world, 2);
    change.edit(world);
    world.apply_to(whole);
    for (const int steps : {0, 3}) {
      advance(whole, steps);
      Simulation again = world.simulate({});
      again.restore(whole.save());
      EXPECT_EQ(again.save(), whole.save()) << change.what;
      advance(again, 40);
      Simulation goes_on = world.simulate({});
      goes_on.restore(whole.save());
      advance(whole, 40);
      EXPECT_EQ(again.state_hash(), whole.state_hash()) << change.what;
      EXPECT_EQ(again.save(), whole.save()) << change.what;
    }
  }
}

TEST(Apply, AStateOfOtherCollidersIsRefused) {
  World world;
  Simulation simulation = crushed(world);
  const std::vector<std::uint8_t> bytes = simulation.save();
  world.colliders.pop_back();
  Simulation fewer = world.simulate({});
  EXPECT_THROW(fewer.restore(bytes), SavedStateError);
}

TEST(Apply, ABrokenRunWantsAnEarlierStateFirst) {
  World world;
  world.settings.time_step = TimeStep::fixed;
  world.settings.dt = 1.0 / 24;
  Simulation simulation = world.simulate(ball_of_two_materials());
  const std::vector<std::uint8_t> good = simulation.save();
  simulation.advance_to(0.5);
  ASSERT_TRUE(simulation.divergence());
  world.settings.dt = 1e-5;
  EXPECT_THROW(world.apply_to(simulation), std::logic_error);
  simulation.restore(good);
  world.apply_to(simulation);
  simulation.advance_to(1e-3);
  EXPECT_FALSE(simulation.divergence());
  EXPECT_EQ(simulation.steps(), 100u);
}

TEST(Apply, FlipHasNoAffineVelocities) {
  World world;
  world.settings.transfer = Transfer::apic;
  Simulation simulation = crushed(world);
  const auto largest_C = [&] {
    double most = 0;
    for (const Mat3d& C : simulation.particles().C) most = std::max(most, C.cwiseAbs().maxCoeff());
    return most;
  };
  const double affine = largest_C();
  EXPECT_GT(affine, 0);
  world.settings.transfer = Transfer::mls;
  world.apply_to(simulation);
  EXPECT_EQ(largest_C(), affine);
  world.settings.transfer = Transfer::asflip;
  world.apply_to(simulation);
  EXPECT_EQ(largest_C(), affine);
  world.settings.transfer = Transfer::flip;
  world.apply_to(simulation);
  EXPECT_EQ(largest_C(), 0);
  // Particles keep their velocities: those of APIC come with the first step, these fit at once.
  world.settings.transfer = Transfer::apic;
  world.apply_to(simulation);
  EXPECT_EQ(largest_C(), 0);
  world.settings.transfer = Transfer::flip;
  world.apply_to(simulation);
  world.settings.transfer = Transfer::asflip;
  world.apply_to(simulation);
  EXPECT_GT(largest_C(), 0.5 * affine);
}

/// Stopped in the middle of a frame, applied to or not, the frame ends with the step it would have
/// ended with.
TEST(Apply, AFrameStoppedAtAStepContinuesUnchanged) {
  const World world;
  Simulation whole = world.simulate(ball_of_two_materials()),
             stopped = world.simulate(ball_of_two_materials());
  AdvanceReport all = whole.advance_to(1.0 / 24), pieces;
  for (const std::size_t step : {std::size_t(0), std::size_t(7), std::size_t(8), std::size_t(33)}) {
    pieces.append(stopped.advance_to(1.0 / 24, nullptr, step));
    EXPECT_EQ(stopped.steps(), step);
    world.apply_to(stopped);
  }
  pieces.append(stopped.advance_to(1.0 / 24));
  EXPECT_EQ(pieces.steps, all.steps);
  EXPECT_EQ(pieces.dt_min, all.dt_min);
  EXPECT_EQ(stopped.save(), whole.save());
}

shapes::Pose pose_of(const Simulation& simulation, std::size_t k) {
  return shapes::pose_at(simulation.colliders().at(k), simulation.time());
}

TEST(AppliedCollider, AppliedColliderContinuesFromItsPlaceWithItsNewMotion) {
  // The same holds without snow to step.
  for (const ParticleArrays& particles : {ParticleArrays{}, ball_of_two_materials()}) {
    World world;
    Simulation simulation = world.simulate(particles);
    for (int k = 0; k < 10; ++k) simulation.step(1e-4);
    const shapes::Pose before = pose_of(simulation, 1);
    EXPECT_LT((before.point - shapes::pose_at(world.colliders[1], 1e-3).point).norm(), 1e-15);
    world.colliders[1].velocity = {-1, 0, 0.5};
    world.colliders[1].angular_velocity = {2, 0, 0};
    world.apply_to(simulation);
    const shapes::Pose at = pose_of(simulation, 1);
    EXPECT_LT((at.point - before.point).norm(), 1e-15);
    EXPECT_LT((at.rotation - before.rotation).norm(), 1e-15);
    simulation.step(1e-4);
    const shapes::Pose after = pose_of(simulation, 1);
    EXPECT_LT((after.point - at.point - 1e-4 * Vec3d(-1, 0, 0.5)).norm(), 1e-15);
    const Mat3d turn = rotation_from_vector(Vec3d(2e-4, 0, 0));
    EXPECT_LT((after.rotation - turn * at.rotation).norm(), 1e-14);
  }
}

TEST(AppliedCollider, AppliedColliderMovesByTheEditOfItsPlace) {
  World world;
  Simulation simulation = world.simulate(ball_of_two_materials());
  advance(simulation, 10);
  world.colliders[1].velocity = {0, 0, 1};
  world.apply_to(simulation);
  advance(simulation, 10);
  const shapes::Pose before = pose_of(simulation, 1);
  std::get<shapes::Sphere>(world.colliders[1].shape.form).center += Vec3d(0.5, 0, 0);
  std::get<shapes::Sphere>(world.colliders[1].shape.form).radius = 0.07;
  world.colliders[1].friction = 0.1;
  world.apply_to(simulation);
  EXPECT_LT((pose_of(simulation, 1).point - before.point - Vec3d(0.5, 0, 0)).norm(), 1e-15);
  EXPECT_EQ(std::get<shapes::Sphere>(simulation.colliders()[1].shape.form).radius, 0.07);
}

TEST(AppliedCollider, AppliedColliderIsKnownByItsNameAndANewOneHasItsOwnPlace) {
  World world;
  Simulation simulation = world.simulate(ball_of_two_materials());
  advance(simulation, 10);
  const shapes::Pose ball = pose_of(simulation, 1);
  shapes::Collider box;
  box.name = "box";
  box.shape.form = shapes::Box{{1, 2, 3}, {1, 1, 1}};
  box.velocity = {1, 0, 0};
  world.colliders = {box, world.colliders[1]};
  world.apply_to(simulation);
  EXPECT_EQ(pose_of(simulation, 0).point, Vec3d(1, 2, 3));
  EXPECT_LT((pose_of(simulation, 1).point - ball.point).norm(), 1e-15);
  simulation.step(1e-4);
  EXPECT_LT((pose_of(simulation, 0).point - Vec3d(1 + 1e-4, 2, 3)).norm(), 1e-15);
}

TEST(AppliedCollider, AppliedColliderWaitsWhileItsStageIsSkipped) {
  World world;
  world.colliders[1].velocity = {0, -5, 0};
  Simulation simulation = world.simulate(ball_of_two_materials());
  advance(simulation, 10);
  const shapes::Pose before = pose_of(simulation, 1);
  world.settings.bypass = {Stage::colliders};
  world.apply_to(simulation);
  advance(simulation, 10);
  EXPECT_LT((pose_of(simulation, 1).point - before.point).norm(), 1e-12);
  // A state saved meanwhile waits as well.
  Simulation again = world.simulate({});
  again.restore(simulation.save());
  EXPECT_EQ(pose_of(again, 1).point, pose_of(simulation, 1).point);
  world.settings.bypass.clear();
  world.apply_to(simulation);
  EXPECT_LT((pose_of(simulation, 1).point - before.point).norm(), 1e-12);
  simulation.step(1e-4);
  EXPECT_LT((pose_of(simulation, 1).point - before.point - Vec3d(0, -5e-4, 0)).norm(), 1e-12);
}

// ---- fast colliders -----------------------------------------------------------------------------

/// A block that lies on a belt of 150 m/s: longer steps than the belt lets it take go 20 times as
/// far.
struct Belt {
  World world;

  Belt() {
    shapes::Collider belt = plane({0, 0, 0}, {0, 1, 0}, 0);
    belt.velocity = {150, 0, 0};
    world.colliders = {belt};
  }
  Simulation simulate() const {
    return world.simulate(box_of_snow({0, 0.003, 0}, {0.1, 0.1, 0.1}, 0.01));
  }
  /// A copy that was saved and restored.
  Simulation again(const Simulation& simulation) const {
    Simulation copy = world.simulate({});
    copy.restore(simulation.save());
    return copy;
  }
};

/// Any curve changes a run at every frame; a run that is resumed is changed just after it.
TEST(AppliedToARestoredRun, TheSpeedOfCollidersIsKept) {
  Belt belt;
  Simulation whole = belt.simulate();
  advance(whole, 20);
  Simulation again = belt.again(whole);
  belt.world.settings.gravity = {0, -5, 0};
  for (Simulation* simulation : {&whole, &again}) {
    belt.world.apply_to(*simulation);
    EXPECT_EQ(simulation->step_limits().max_collider_speed, 150);
    advance(*simulation, 20);
  }
  EXPECT_EQ(again.save(), whole.save());
}

TEST(AppliedToARestoredRun, ANewSpeedIsFoundAsWithoutTheStop) {
  for (const double speed : {60.0, 300.0}) {
    Belt belt;
    Simulation whole = belt.simulate();
    advance(whole, 20);
    Simulation again = belt.again(whole);
    belt.world.colliders[0].velocity = {speed, 0, 0};
    for (Simulation* simulation : {&whole, &again}) {
      belt.world.apply_to(*simulation);
      EXPECT_EQ(simulation->step_limits().max_collider_speed, speed);
      advance(*simulation, 20);
    }
    EXPECT_EQ(again.save(), whole.save());
  }
}

/// The step that says that a run has collapsed grew by each change after a stop, 20 times each: in
/// the fourth the run ended.
TEST(AppliedToARestoredRun, ManyStopsEndNoRun) {
  Belt belt;
  Simulation simulation = belt.simulate();
  for (int stop = 0; stop < 6; ++stop) {
    advance(simulation, 1);
    ASSERT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
    simulation = belt.again(simulation);
    belt.world.settings.gravity[1] += 0.1;
    belt.world.apply_to(simulation);
  }
}

}  // namespace
