/// Dust: born where snow breaks fast, carried by the air, never inside solids, and without any
/// effect on the snow.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <tuple>

#include "sim/dust/cloud.h"
#include "sim/dust/dust.h"
#include "sim/dust_grid.h"
#include "sim/shapes/collider.h"
#include "sim/simulation.h"
#include "tests/support/meshes.h"
#include "tests/support/snow.h"

namespace {

using namespace neve;
using namespace neve::sim;
using namespace neve::test;

const Vec3d gravity(0, -9.81, 0);

/// Still air over the ground y = 0.
class Ground final : public dust::Solids {
 public:
  dust::Surface at(const Vec3d& x) const override { return {x.y(), {0, 1, 0}, {0, 0, 0}}; }
  bool are_none() const override { return false; }
  std::uint64_t pose_key() const override { return 1; }
};

DustSettings still_air() {
  DustSettings s;
  s.diffusion = 0;
  s.turbulence = 0;
  s.life = 0;
  return s;
}

dust::Cloud cloud_of(std::size_t count, const Vec3d& x, double life = 0) {
  dust::Cloud cloud;
  for (std::size_t k = 0; k < count; ++k) {
    const double own_life =
        life > 0 ? -life * std::log(1 - (static_cast<double>(k) + 0.5) / double(count)) : 0;
    cloud.motes.push_back({{x.x(), x.y(), x.z()}, {0, 0, 0}, 0.25, 0, own_life, k + 1});
  }
  cloud.totals.born = count;
  cloud.totals.born_mass = 0.25 * static_cast<double>(count);
  return cloud;
}

void expect_accounts(const dust::Cloud& cloud) {
  double airborne = 0;
  for (const dust::Mote& mote : cloud.motes) airborne += mote.m;
  EXPECT_EQ(cloud.totals.airborne(), cloud.motes.size());
  // Quarters of a kilogram: sums are exact.
  EXPECT_EQ(cloud.totals.born_mass, airborne + cloud.totals.settled_mass + cloud.totals.faded_mass);
}

/// Steps of dt in still air. @param after  each step, with the time
void fly(
    dust::Cloud& cloud, const DustSettings& settings, const dust::Solids& solids, double dt,
    double until, const std::function<void(double)>& after = [](double) {}) {
  ThreadPool pool(2);
  dust::Air air;
  air.cover({0.5, {-8, -8, -8}, {16, 24, 16}}, settings.wind);
  air.see({}, solids, pool);
  const dust::Gusts gusts(0.5, 1);
  const int steps = static_cast<int>(std::lround(until / dt));
  for (int k = 1; k <= steps; ++k) {
    cloud.move(air, gusts, {settings, solids, gravity, k * dt, dt, static_cast<std::uint64_t>(k)},
               pool);
    after(k * dt);
  }
}

/// A mote falls from rest, with drag that balances the weight at the settling speed w and time w /
/// g: y = y0 - w (t - T (1 - e^(-t/T))).
TEST(Dust, SettlesInStillAirAsTheClosedFormSays) {
  const DustSettings settings = still_air();
  const double w = settings.settling_speed, T = w / 9.81;
  for (const double dt : {0.01, 0.04}) {
    dust::Cloud cloud = cloud_of(1, {0.1, 1.9, 0.2});
    fly(cloud, settings, dust::NoSolids(), dt, 2, [&](double t) {
      // The fall is exact for any dt, but for rounding.
      ASSERT_NEAR(cloud.motes[0].x[1], 1.9 - w * (t - T * (1 - std::exp(-t / T))), 1e-12);
      ASSERT_EQ(cloud.motes[0].x[0], 0.1);
    });
    EXPECT_NEAR(cloud.motes[0].v[1], -w, 1e-12);
  }
}

TEST(Dust, ReachesTheGroundWhenItHasSunkToItAndIsCounted) {
  const DustSettings settings = still_air();
  const double w = settings.settling_speed;
  dust::Cloud cloud = cloud_of(8, {0.1, 0.6, 0.2});
  double landed = 0;
  fly(cloud, settings, Ground(), 0.01, 4, [&](double t) {
    expect_accounts(cloud);
    if (landed == 0 && cloud.motes.empty()) landed = t;
  });
  // The dust lands later by the time in which it takes on its speed, and by less than a step.
  EXPECT_NEAR(landed, 0.6 / w + w / 9.81, 0.0101);
  EXPECT_EQ(cloud.totals.settled, 8u);
  EXPECT_EQ(cloud.totals.settled_mass, 2.0);
}

TEST(Dust, DiffusesAsAGaussian) {
  DustSettings settings = still_air();
  settings.settling_speed = 0;
  settings.diffusion = 0.05;
  constexpr std::size_t count = 40000;
  for (const double dt : {0.02, 0.1}) {
    dust::Cloud cloud = cloud_of(count, {0, 0, 0});
    fly(cloud, settings, dust::NoSolids(), dt, 1);
    const double variance = 2 * settings.diffusion;
    Vec3d mean = Vec3d::Zero(), square = Vec3d::Zero();
    std::size_t within = 0;
    for (const dust::Mote& mote : cloud.motes) {
      const Vec3d x(mote.x[0], mote.x[1], mote.x[2]);
      mean += x / double(count);
      square += x.cwiseProduct(x) / double(count);
      within += std::abs(x.z()) < std::sqrt(variance);
    }
    for (int a = 0; a < 3; ++a) {
      // Five standard errors of a mean and of a variance of so many.
      EXPECT_NEAR(mean[a], 0, 5 * std::sqrt(variance / count));
      EXPECT_NEAR(square[a], variance, 5 * variance * std::sqrt(2.0 / count));
    }
    EXPECT_NEAR(double(within) / count, 0.6827, 5 * std::sqrt(0.22 / count));
  }
}

TEST(Dust, FadesWithItsMeanLifeAndNoneIsLost) {
  DustSettings settings = still_air();
  settings.settling_speed = 0;
  dust::Cloud cloud = cloud_of(1000, {0, 0, 0}, 0.5);
  fly(cloud, settings, dust::NoSolids(), 0.02, 1, [&](double) { expect_accounts(cloud); });
  EXPECT_NEAR(double(cloud.motes.size()), 1000 * std::exp(-2), 3);
  EXPECT_EQ(cloud.totals.faded, 1000 - cloud.motes.size());
}

TEST(Dust, SnowShedsItOnlyWhereItIsFastStrainedAndOpen) {
  const DustSettings s;
  EXPECT_EQ(dust::shedding(s, 2 * s.speed, 2 * s.strain_rate, 1, 0.2), 1);
  EXPECT_EQ(dust::shedding(s, 1.5 * s.speed, 2 * s.strain_rate, 1, 0.2), 0.5);
  EXPECT_EQ(dust::shedding(s, s.speed, 2 * s.strain_rate, 1, 0.2), 0);
  EXPECT_EQ(dust::shedding(s, 2 * s.speed, s.strain_rate, 1, 0.2), 0);
  EXPECT_EQ(dust::shedding(s, 2 * s.speed, 2 * s.strain_rate, s.min_J_P - 0.01, 0.2), 0);
  EXPECT_EQ(dust::shedding(s, 2 * s.speed, 2 * s.strain_rate, 1, 1), 0);
}

// ---- the air ------------------------------------------------------------------------------------

TEST(Air, WindThatMeetsNothingStaysAsItIs) {
  ThreadPool pool(2);
  const Vec3d wind(3, 0.5, -1);
  dust::Air air;
  air.cover({0.25, {0, 0, 0}, {16, 16, 16}}, wind);
  air.see({}, dust::NoSolids(), pool);
  for (int k = 0; k < 10; ++k) air.step(0.03, wind, {0, 1, 0}, {}, pool);
  for (const Vec3d& x : {Vec3d(1, 1, 1), Vec3d(0.1, 3.9, 2), Vec3d(9, 9, 9)})
    EXPECT_LT((air.velocity(x, wind) - wind).norm(), 1e-5);
}

TEST(Air, KeepsWhatTwoBoxesShareAndForgetsTheRest) {
  ThreadPool pool(1);
  const Vec3d wind(1, 0, 0), x(1.1, 1.1, 1.1);
  dust::Air air;
  air.cover({0.25, {0, 0, 0}, {8, 8, 8}}, wind);
  air.cover({0.25, {-4, 0, 0}, {16, 8, 8}}, Vec3d::Zero());
  EXPECT_LT((air.velocity(x, Vec3d::Zero()) - wind).norm(), 1e-6);
  EXPECT_EQ(air.velocity({-0.9, 1, 1}, Vec3d::Zero()), Vec3d::Zero());
  // Nothing moves any more, and then something does.
  air.cover({0.25, {0, 0, 0}, {0, 0, 0}}, Vec3d::Zero());
  EXPECT_EQ(air.velocity(x, wind), wind);
  EXPECT_EQ(air.fill(x), 0);
  air.step(0.01, wind, {0, 1, 0}, {}, pool);
  air.cover({0.25, {0, 0, 0}, {8, 8, 8}}, Vec3d::Zero());
  EXPECT_EQ(air.velocity(x, wind), Vec3d::Zero());
}

/// Snow comes to rest, its dust settles, and later it moves again.
TEST(Dust, AirGoesWhenNothingMovesAndComesBack) {
  ThreadPool pool(2);
  const Ground ground;
  const DustSettings settings = still_air();
  std::vector<dust::SnowGrain> snow;
  for (int k = 0; k < 500; ++k)
    snow.push_back({Vec3d(0.02 * (k % 10), 0.02 * (k / 10 % 5) + 0.1, 0.02 * (k / 50)),
                    {6.0 + 0.5 * (k / 10 % 5), 0, 0},
                    1e-3,
                    8e-6,
                    1,
                    0.1,
                    static_cast<std::uint32_t>(k)});
  dust::Dust dust;
  const auto advance = [&](double until) {
    while (dust.time() < until - 1e-9)
      dust.advance(dust.time() + 0.02, snow, {settings, 0.02, gravity, ground, pool});
  };
  advance(0.1);
  EXPECT_FALSE(dust.cloud().motes.empty());
  EXPECT_FALSE(dust.air().box().is_empty());
  for (dust::SnowGrain& grain : snow) grain.v.setZero();
  advance(20);
  EXPECT_TRUE(dust.cloud().motes.empty());
  EXPECT_TRUE(dust.air().box().is_empty());
  dust::Dust again;
  again.restore(dust.save());
  EXPECT_EQ(again.save(), dust.save());
  for (dust::SnowGrain& grain : snow) grain.v.x() = 5;
  advance(20.1);
  EXPECT_FALSE(dust.air().box().is_empty());
}

/// A block of snow that flies through still air.
TEST(Air, FollowsSnowAndMakesRoomForIt) {
  ThreadPool pool(2);
  std::vector<dust::SnowGrain> snow;
  for (int k = 0; k < 1000; ++k) {
    const Vec3d place(k % 10, k / 10 % 10, k / 100);
    snow.push_back({Vec3d(1.5, 1.5, 1.5) + 0.05 * place, {4, 0, 0}, 0.05, 1.25e-4, 1, 0, 0});
  }
  dust::Air air;
  air.cover({0.25, {0, 0, 0}, {16, 16, 16}}, Vec3d::Zero());
  air.see(snow, dust::NoSolids(), pool);
  for (int k = 0; k < 5; ++k) air.step(0.02, Vec3d::Zero(), {0, 1, 0}, {}, pool);
  EXPECT_GT(air.velocity({1.75, 1.75, 1.75}, Vec3d::Zero()).x(), 2);
  // It returns around the block, and upwards before its front.
  EXPECT_LT(air.velocity({1.75, 2.6, 1.75}, Vec3d::Zero()).x(), 0);
  EXPECT_GT(air.velocity({2.25, 2.2, 1.75}, Vec3d::Zero()).y(), 0.05);
  // The air that enters a box leaves it: over relaxation ends at a per cent of the speed.
  double sum = 0;
  const double h = 0.125;
  for (double a = 1.0625; a < 2.5; a += h)
    for (double b = 1.0625; b < 2.5; b += h)
      for (const auto& [low, high, n] : {std::tuple{Vec3d(1, a, b), Vec3d(2.5, a, b), 0},
                                         {Vec3d(a, 1, b), Vec3d(a, 2.5, b), 1},
                                         {Vec3d(a, b, 1), Vec3d(a, b, 2.5), 2}})
        sum += h * h * (air.velocity(high, Vec3d::Zero())[n] - air.velocity(low, Vec3d::Zero())[n]);
  EXPECT_LT(std::abs(sum), 0.02 * 4 * 0.25);
}

TEST(Air, DoesNotCrossTheGround) {
  ThreadPool pool(2);
  dust::Air air;
  const Vec3d wind(2, -1, 0);
  air.cover({0.25, {0, -8, 0}, {16, 16, 16}}, wind);
  air.see({}, Ground(), pool);
  for (int k = 0; k < 20; ++k) air.step(0.05, wind, {0, 1, 0}, {}, pool);
  for (double x = 0.3; x < 3.8; x += 0.3) EXPECT_EQ(air.velocity({x, 0, 2}, wind).y(), 0) << x;
  EXPECT_LT(air.velocity({2, 1.5, 2}, wind).y(), -0.05);
}

// ---- a run --------------------------------------------------------------------------------------

Material powder() {
  Material m;
  m.density = 150;
  m.youngs_modulus = 4e4;
  m.hardening = 7;
  m.critical_compression = 0.015;
  m.critical_stretch = 0.002;
  m.dust = 0.1;
  return m;
}

std::vector<shapes::Collider> floor_and_post() {
  shapes::Collider post;
  post.name = "post";
  post.shape.form = shapes::Box{{0.12, 0.15, 0}, {0.08, 0.3, 0.4}};
  shapes::Collider ball;
  ball.name = "ball";
  ball.shape.form = shapes::Sphere{{-0.15, 0.1, 0.05}, 0.06};
  ball.velocity = {0.3, 0, 0};
  return {plane({0, 0, 0}, {0, 1, 0}, 0.5), post, ball};
}

/// Much dust, which stays in the air.
SolverSettings dusty() {
  SolverSettings s;
  s.cell_size = 0.02;
  s.dust.speed = 0.5;
  s.dust.settling_speed = 0.05;
  return s;
}

Simulation dusty_impact(const SolverSettings& settings, const Material& material, int threads) {
  const ParticleArrays p = ball_of_snow({-0.05, 0.16, 0}, 0.1, 0.009, {6, -2, 0});
  return Simulation(settings, {material}, floor_and_post(), p, threads);
}

TEST(DustOfARun, LeavesTheSnowAsItIs) {
  Material without = powder();
  without.dust = 0;
  Simulation with_dust = dusty_impact(dusty(), powder(), 2),
             plain = dusty_impact(dusty(), without, 2);
  for (const double time : {0.02, 0.04, 0.08}) {
    with_dust.advance_to(time);
    plain.advance_to(time);
    EXPECT_EQ(with_dust.steps(), plain.steps());
    EXPECT_EQ(with_dust.state_hash(), plain.state_hash());
  }
  EXPECT_GT(with_dust.dust().x.size(), 500u);
  EXPECT_EQ(plain.dust().x.size(), 0u);
  EXPECT_EQ(with_dust.summary().mass, plain.summary().mass);
}

TEST(DustOfARun, IsAccountedForAndOutsideOfAllSolids) {
  SolverSettings settings = dusty();
  settings.dust.life = 0.5;
  Simulation simulation = dusty_impact(settings, powder(), 2);
  for (int frame = 1; frame <= 8; ++frame) {
    simulation.advance_to(0.03 * frame);
    const DustArrays dust = simulation.dust();
    double airborne = 0;
    for (const double m : dust.m) airborne += m;
    EXPECT_EQ(dust.totals.airborne(), dust.x.size());
    EXPECT_NEAR(dust.totals.born_mass, airborne + dust.totals.settled_mass + dust.totals.faded_mass,
                1e-12 * dust.totals.born_mass);
    for (const Vec3d& x : dust.x)
      for (const shapes::Collider& collider : simulation.colliders())
        ASSERT_GE(shapes::signed_distance(collider, simulation.time(), x), -1e-9)
            << collider.name << " frame " << frame;
  }
  EXPECT_GT(simulation.dust().totals.settled, 0u);
  EXPECT_GT(simulation.dust().totals.faded, 0u);
}

void expect_same_dust(const DustArrays& a, const DustArrays& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.m, b.m);
  ASSERT_EQ(a.x.size(), b.x.size());
  for (std::size_t k = 0; k < a.x.size(); ++k) {
    ASSERT_EQ(a.x[k], b.x[k]) << k;
    ASSERT_EQ(a.v[k], b.v[k]) << k;
  }
  EXPECT_EQ(a.totals.born_mass, b.totals.born_mass);
}

TEST(DustOfARun, HasTheSameBitsAtAnyNumberOfThreads) {
  SolverSettings settings = dusty();
  settings.dust.buoyancy = -1;
  settings.dust.wind = {1, 0, 0.5};
  Simulation one = dusty_impact(settings, powder(), 1);
  one.advance_to(0.08);
  ASSERT_GT(one.dust().x.size(), 500u);
  for (const int threads : {2, 5}) {
    Simulation other = dusty_impact(settings, powder(), threads);
    other.advance_to(0.08);
    expect_same_dust(other.dust(), one.dust());
    EXPECT_EQ(other.save(), one.save());
  }
}

TEST(DustOfARun, ContinuesWithTheSameBitsFromASavedState) {
  Simulation whole = dusty_impact(dusty(), powder(), 2);
  whole.advance_to(0.04);
  // The state is saved in the middle of a frame, and of a step of the dust.
  whole.advance_to(0.08, {}, whole.steps() + 17);
  const std::vector<std::uint8_t> bytes = whole.save();
  Simulation again = dusty_impact(dusty(), powder(), 1);
  again.restore(bytes);
  EXPECT_EQ(again.save(), bytes);
  expect_same_dust(again.dust(), whole.dust());
  whole.advance_to(0.08);
  again.advance_to(0.08);
  ASSERT_GT(whole.dust().x.size(), 500u);
  expect_same_dust(again.dust(), whole.dust());
  EXPECT_EQ(again.save(), whole.save());
}

/// A lift that rises and rests within a step of the dust: at the moments when the dust looks at it,
/// it is still.
TEST(DustOfARun, SeesAMeshThatDeformedBetweenItsSteps) {
  TemporaryFolder folder;
  shapes::Collider lift;
  shapes::MeshSequence sequence = written_sequence(folder, "lift", 2, 50, [&](int k) {
    return plate_obj(Vec3d(0.4, 0.2, 0.3), 1,
                     [&](double) { return Vec3d(0.25, 0.1 * k - 0.1, 0); });
  });
  sequence.start = 0.05;
  lift.name = "lift";
  lift.shape.form = sequence;
  const auto simulate = [&] {
    return Simulation(dusty(), {powder()}, {plane({0, 0, 0}, {0, 1, 0}, 0.5), lift},
                      ball_of_snow({-0.05, 0.16, 0}, 0.1, 0.009, {6, -2, 0}), 1);
  };
  Simulation whole = simulate(), again = simulate();
  whole.advance_to(0.04);
  whole.advance_to(0.08);
  again.restore(whole.save());
  whole.advance_to(0.1);
  again.advance_to(0.1);
  ASSERT_GT(whole.dust().x.size(), 500u);
  expect_same_dust(again.dust(), whole.dust());
  for (const Vec3d& x : whole.dust().x)
    ASSERT_GE(shapes::signed_distance(whole.colliders().back(), whole.time(), x), -1e-9);
}

TEST(DustOfARun, StateWithoutItIsTakenAndItStartsThere) {
  Material without = powder();
  without.dust = 0;
  Simulation plain = dusty_impact(dusty(), without, 2);
  plain.advance_to(0.02);
  Simulation with_dust = dusty_impact(dusty(), powder(), 2);
  with_dust.restore(plain.save());
  EXPECT_EQ(with_dust.dust().totals.born, 0u);
  with_dust.advance_to(0.06);
  plain.advance_to(0.06);
  EXPECT_GT(with_dust.dust().totals.born, 100u);
  EXPECT_EQ(with_dust.state_hash(), plain.state_hash());
}

/// Totals and numbers of motes outlive the last mote: a run that sheds none for a while, saved
/// there or not, counts on.
TEST(DustOfARun, TotalsStayWhileThereIsNone) {
  Material without = powder();
  without.dust = 0;
  SolverSettings settings = dusty();
  settings.dust.life = 0.002;
  Simulation whole = dusty_impact(settings, powder(), 1);
  whole.advance_to(0.03);
  whole.apply(settings, {without}, floor_and_post());
  whole.advance_to(0.08);
  ASSERT_TRUE(whole.dust().x.empty());
  const std::uint64_t born = whole.summary().dust.born;
  ASSERT_GT(born, 50u);
  Simulation again = dusty_impact(settings, without, 1);
  again.restore(whole.save());
  EXPECT_EQ(again.summary().dust.born, born);
  for (Simulation* run : {&whole, &again}) {
    run->apply(settings, {powder()}, floor_and_post());
    run->advance_to(0.1);
    EXPECT_GT(run->dust().totals.born, born);
    for (const std::uint64_t id : run->dust().id) EXPECT_GT(id, born);
  }
  expect_same_dust(again.dust(), whole.dust());
  EXPECT_EQ(again.save(), whole.save());
}

TEST(DustOfARun, DamagedBytesAreRefusedAndNothingChanges) {
  Simulation simulation = dusty_impact(dusty(), powder(), 2);
  simulation.advance_to(0.04);
  const std::vector<std::uint8_t> good = simulation.save();
  const auto refused = [&](const std::vector<std::uint8_t>& bytes) {
    EXPECT_THROW(simulation.restore(bytes), SavedStateError);
    EXPECT_EQ(simulation.save(), good);
  };
  std::vector<std::uint8_t> bytes = good;
  bytes[bytes.size() - 2] = 0x7f;  // the length of the dust
  refused(bytes);
  bytes = good;
  // The last number of the air, as not-a-number.
  for (std::size_t k = 9; k <= 12; ++k) bytes[bytes.size() - k] = 0xff;
  refused(bytes);
  bytes = good;
  bytes.erase(bytes.end() - 16, bytes.end() - 8);
  refused(bytes);
}

TEST(DustOfARun, StaysBelowItsLargestNumberAndKeepsItsMass) {
  SolverSettings few = dusty(), many = dusty();
  few.dust.particles = 200;
  Simulation a = dusty_impact(few, powder(), 2), b = dusty_impact(many, powder(), 2);
  a.advance_to(0.08);
  b.advance_to(0.08);
  ASSERT_GT(b.dust().x.size(), 500u);
  EXPECT_LE(a.dust().x.size(), 200u);
  EXPECT_GT(a.dust().x.size(), 120u);
  // Fewer, of more mass each; chance decides which.
  EXPECT_LT(a.dust().totals.born, b.dust().totals.born);
  EXPECT_NEAR(a.dust().totals.born_mass / b.dust().totals.born_mass, 1, 0.25);
}

/// dv/dt = -k v^2 without gravity in still air: v = v0 / (1 + k v0 t).
TEST(DustOfARun, SpraySlowsDownInTheAirAsTheClosedFormSays) {
  SolverSettings s = dusty();
  s.gravity = {0, 0, 0};
  s.dust.spray_drag = 2;
  s.dust.air_cell = 8;
  s.dust.turbulence = 0;
  ParticleArrays p;
  p.x = {{0, 0, 0}};
  p.v = {{5, 0, 0}};
  p.m = {400 * 1e-6};
  p.V0 = {1e-6};
  Simulation simulation(s, {Material{}}, {}, p, 1);
  for (const double t : {0.1, 0.2, 0.4}) {
    simulation.advance_to(t);
    // Implicit steps of up to 1/30 s brake a little less.
    const double expected = 5 / (1 + 2 * 5 * t);
    EXPECT_NEAR(simulation.particles().v[0].x(), expected, 0.06 * expected) << t;
  }
  EXPECT_FALSE(simulation.divergence());
  // The speed that sheds dust is of no matter.
  s.dust.speed = 25;
  Simulation hardly_dusty(s, {Material{}}, {}, p, 1);
  hardly_dusty.advance_to(0.4);
  // Steps of the air are shorter then.
  EXPECT_NEAR(hardly_dusty.particles().v[0].x(), simulation.particles().v[0].x(), 1e-3);
  s.dust.spray_drag = 0;
  Simulation without(s, {Material{}}, {}, p, 1);
  without.advance_to(0.4);
  EXPECT_EQ(without.particles().v[0].x(), 5);
}

TEST(DustNodes, HoldTheMassAndTheMotionOfTheDust) {
  DustArrays dust;
  dust.air_spacing = 0.2;
  for (int k = 0; k < 200; ++k) {
    dust.x.emplace_back(0.013 * k - 1, 0.3 * std::sin(k), 0.01 * (k % 7));
    dust.v.emplace_back(1, 2, -3);
    dust.m.push_back(0.01);
  }
  const RasterizedNodes nodes = dust_nodes(dust);
  EXPECT_EQ(nodes.spacing, 0.1);
  double mass = 0;
  Vec3d moment = Vec3d::Zero(), expected = Vec3d::Zero();
  for (std::size_t n = 0; n < nodes.mass.size(); ++n) {
    if (!(nodes.mass[n] > 0)) continue;
    mass += nodes.mass[n];
    const int at = static_cast<int>(n % 64);
    const sim::Vec3i node = 4 * nodes.block[n / 64] + sim::Vec3i(at / 16, at / 4 % 4, at % 4);
    moment += nodes.mass[n] * 0.1 * node.cast<double>();
    ASSERT_LT((nodes.velocity[n] - Vec3d(1, 2, -3)).norm(), 1e-12);
  }
  for (std::size_t k = 0; k < dust.x.size(); ++k) expected += dust.m[k] * dust.x[k];
  EXPECT_NEAR(mass, 2, 1e-12);
  // The kernel is even: the centre of mass stays.
  EXPECT_LT((moment - expected).norm(), 1e-12);
  EXPECT_TRUE(dust_nodes({}).block.empty());
}

}  // namespace
