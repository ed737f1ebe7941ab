/// Snow and bodies that it moves: momentum, light and heavy bodies, same bits.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numeric>
#include <string>

#include "tests/support/bodies.h"
#include "tests/support/rest.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

struct Way {
  Method method;
  std::string name;
};

std::vector<Way> ways() {
  std::vector<Way> ways;
  for (const double beta : {0.0, 1.0})
    for (const Transfer transfer :
         {Transfer::flip, Transfer::apic, Transfer::mls, Transfer::aflip, Transfer::asflip}) {
      Method method = transfer == Transfer::mls ? mls_quadratic() : flip_cubic();
      method.transfer = transfer;
      method.beta = beta;
      ways.push_back({method, "transfer " + std::to_string(static_cast<int>(transfer)) +
                                  (beta > 0 ? ", semi-implicit" : ", explicit")});
    }
  return ways;
}

Vec3d moment_of(const Simulation& simulation) {
  const ParticleArrays p = simulation.particles();
  Vec3d sum = Vec3d::Zero();
  for (std::size_t q = 0; q < p.x.size(); ++q) sum += p.x[q].cross(p.m[q] * p.v[q]);
  return sum;
}

/// A ball of snow hits a plate that floats, off its middle.
struct Hit {
  Vec3d change = Vec3d::Zero();  ///< of all momentum, kg m/s
  Vec3d turn = Vec3d::Zero();    ///< of all moment of momentum about the origin, kg m2/s
  double size = 0;               ///< of what the plate got
  double speed = 0;              ///< m/s, of the plate's middle away from the snow, in the end
  double snow_speed = 0;         ///< of the snow, likewise
  double fastest = 0;            ///< m/s, of the plate's middle in any step
  bool diverged = false;
};

Hit hit_plate(Method method, double density, double seconds = 0.03) {
  SolverSettings s = rest_settings(method);
  s.gravity = Vec3d::Zero();
  s.solve_tolerance = method.precision == Precision::single ? 1e-5 : 1e-9;
  s.solve_iterations = 500;
  const shapes::Collider plate = box_of(density, {0, 0, 0}, {0.3, 0.06, 0.3});
  Simulation simulation(s, {Material{}}, {plate},
                        ball_of_snow({0.03, 0.115, 0.01}, 0.08, 0.01, {0.5, -4, 0}), 1);
  const Vec3d before = simulation.summary().momentum, turn_before = moment_of(simulation);
  Hit hit;
  while (simulation.time() < seconds && !simulation.divergence()) {
    simulation.step(simulation.choose_dt(1).dt);
    hit.fastest = std::max(hit.fastest, motion_of(simulation, 0).velocity.norm());
  }
  hit.diverged = simulation.divergence().has_value();
  const shapes::Collider body = simulation.colliders()[0];
  const BodyMomentum got = momentum_of(body, simulation.time());
  const Vec3d given = got.linear;
  hit.turn = moment_of(simulation) + got.angular - turn_before;
  const Summary summary = simulation.summary();
  hit.change = summary.momentum + given - before;
  hit.size = given.norm();
  hit.speed = -motion_of(simulation, 0).velocity[1];
  hit.snow_speed = -summary.momentum[1] / summary.mass;
  return hit;
}

/// The body gets the momentum that snow loses.
TEST(RigidSnow, MomentumClosesAtAnyRatioOfMasses) {
  for (const Precision precision : {Precision::real64, Precision::single})
    for (Way way : ways())
      for (const double density : {0.4, 4e3, 4e5}) {
        if (precision == Precision::single && density == 4e5) continue;
        SCOPED_TRACE(way.name + (precision == Precision::single ? ", float, " : ", double, ") +
                     std::to_string(density) + " kg/m3");
        way.method.precision = precision;
        const Hit hit = hit_plate(way.method, density);
        EXPECT_FALSE(hit.diverged);
        EXPECT_GT(hit.size, 1e-3);
        // Nothing throws a light plate away: it does not get faster than the snow that hits it.
        EXPECT_LE(hit.fastest, 1.05 * std::hypot(4, 0.5));
        // The bound is of the impulse: rounding of some hundred sums of particles' momenta.
        EXPECT_LE(hit.change.norm(), (precision == Precision::single ? 1e-4 : 1e-6) * hit.size);
        // Places move with the velocity at the end of a step, and C carries moment, too: those of
        // the snow are off by a twentieth of what the plate got at an arm of 0.1 m.
        EXPECT_LE(hit.turn.norm(), 0.06 * 0.1 * hit.size);
      }
}

/// A ball of snow, and three bodies that it hits and that meet each other.
std::vector<shapes::Collider> things() {
  std::vector<shapes::Collider> list{plane({0, 0, 0}, {0, 1, 0}, 0.5),
                                     box_of(300, {0, 0.06, 0}, {0.3, 0.1, 0.2}, {0, 0, 3}),
                                     ball_of(50, {0.1, 0.19, 0.02}, 0.05)};
  shapes::Collider lever = box_of(200, {-0.2, 0.2, 0}, {0.2, 0.03, 0.2});
  lever.name = "lever";
  lever.body.joint = shapes::Joint::hinge;
  lever.body.joint_point = {-0.3, 0.2, 0};
  lever.body.joint_axis = {0, 0, 1};
  lever.body.joint_stiffness = 5;
  lever.body.joint_damping = 0.1;
  list.push_back(lever);
  return list;
}

SolverSettings settings_with_beta(double beta) {
  SolverSettings s;
  s.cell_size = 0.02;
  s.beta = beta;
  return s;
}

ParticleArrays falling_snow() {
  return ball_of_snow({-0.02, 0.32, 0}, 0.1, 0.01, {0, -4, 0});
}

Simulation thrown(double beta, int threads) {
  return Simulation(settings_with_beta(beta), {Material{}}, things(), falling_snow(), threads);
}

/// Dense snow at 5 m/s, a part of it inside of a ball that is a hundred times lighter than it: the
/// ball comes to go with the snow. Snow that was stopped against the velocity that the ball had
/// before the step threw it away at 9.6 m/s; in a random scene, where a body lay across more of it,
/// at 50 km/s after seven steps.
TEST(RigidSnow, SnowInsideOfALightBodyDoesNotThrowIt) {
  for (const Way& way : ways()) {
    SCOPED_TRACE(way.name);
    SolverSettings s = rest_settings(way.method);
    s.gravity = Vec3d::Zero();
    ParticleArrays snow = box_of_snow({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}, 0.01);
    for (Vec3d& v : snow.v) v = {5, 0, 0};
    const double mass = std::accumulate(snow.m.begin(), snow.m.end(), 0.0);
    shapes::Collider ball = ball_of(0, {0.13, 0, 0.01}, 0.06);
    ball.body.mass = 0.01 * mass;
    Simulation simulation(s, {Material{}}, {ball}, snow, 1);
    double fastest = 0, energy = 0;
    while (simulation.time() < 0.02 && !simulation.divergence()) {
      simulation.step(simulation.choose_dt(1).dt);
      fastest = std::max(fastest, motion_of(simulation, 0).velocity.norm());
      energy = std::max(energy, simulation.summary().kinetic_energy);
    }
    ASSERT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
    EXPECT_LT(fastest, 1.2 * 5) << "snow that begins pressed springs back by a tenth";
    EXPECT_GT(motion_of(simulation, 0).velocity.x(), 4);
    EXPECT_LT(energy, 1.02 * 0.5 * mass * 25);
  }
}

TEST(RigidSnow, SameBitsAtAnyNumberOfThreads) {
  for (const double beta : {0.0, 1.0}) {
    Simulation one = thrown(beta, 1), three = thrown(beta, 3);
    for (Simulation* s : {&one, &three}) s->advance_to(0.05);
    EXPECT_EQ(one.state_hash(), three.state_hash());
    EXPECT_LT(shapes::pose_at(one.colliders()[3], one.time()).rotation(1, 0), -0.1)
        << "nothing hit the lever";
    EXPECT_EQ(motion_of(one, 3).angular_velocity, motion_of(three, 3).angular_velocity);
  }
}

TEST(RigidSnow, SavedAndRestoredItTakesTheSameSteps) {
  Simulation whole = thrown(0, 1);
  whole.advance_to(0.03);
  const std::vector<std::uint8_t> saved = whole.save();
  whole.advance_to(0.06);
  Simulation resumed = thrown(0, 1);
  const std::uint64_t before = resumed.state_hash();
  resumed.restore_healthy(saved);
  EXPECT_NE(resumed.state_hash(), before);
  resumed.advance_to(0.06);
  EXPECT_EQ(resumed.state_hash(), whole.state_hash());
  for (std::size_t k = 1; k < 4; ++k) {
    EXPECT_EQ(motion_of(resumed, k).velocity, motion_of(whole, k).velocity) << k;
    EXPECT_EQ(resumed.colliders()[k].pose_offset.moved, whole.colliders()[k].pose_offset.moved);
  }
}

/// A lever that its spring has let turn by more than half a turn, far above some snow.
Simulation wound() {
  shapes::Collider lever = box_of(700, {0, 5, 0}, {0.3, 0.05, 0.05});
  lever.body.joint = shapes::Joint::hinge;
  lever.body.joint_point = {0, 5, 0};
  lever.body.joint_axis = {0, 0, 1};
  lever.body.joint_stiffness = 20;
  lever.angular_velocity = {0, 0, 400};
  return Simulation(settings_with_beta(0), {Material{}}, {lever}, falling_snow(), 1);
}

/// The rotation of a body cannot say its turns: they are saved beside it, and stay after changes.
TEST(RigidSnow, TurnsOfAHingeAreSaved) {
  Simulation whole = wound();
  whole.advance_to(0.015);
  const std::vector<std::uint8_t> saved = whole.save();
  const double angle = whole.colliders()[0].pose_offset.joint_angle;
  ASSERT_GT(angle, 4) << "it has not turned by more than half a turn";
  Simulation resumed = wound();
  resumed.restore_healthy(saved);
  EXPECT_EQ(resumed.state_hash(), whole.state_hash());
  // Other parameters leave it wound up, and so does a push.
  Simulation pushed = wound();
  pushed.restore_healthy(saved);
  std::vector<shapes::Collider> list = pushed.colliders();
  list[0].body.joint_stiffness *= 2;
  list[0].angular_velocity = {0, 0, 1};
  pushed.apply(settings_with_beta(0), {Material{}}, list);
  EXPECT_EQ(pushed.colliders()[0].pose_offset.joint_angle, angle);
  whole.advance_to(0.05);
  resumed.advance_to(0.05);
  EXPECT_EQ(resumed.state_hash(), whole.state_hash());
  EXPECT_EQ(motion_of(resumed, 0).angular_velocity, motion_of(whole, 0).angular_velocity);
  pushed.advance_to(0.02);
  EXPECT_LT(motion_of(pushed, 0).angular_velocity.z(), 0) << "the spring pushed it onward";
}

/// A hash that saw snow alone would call two runs equal that part ways at the next contact.
TEST(RigidSnow, TheHashSeesWhereBodiesAre) {
  Simulation a = thrown(0, 1);
  std::vector<shapes::Collider> list = things();
  list[2].velocity = {0, 1e-9, 0};
  const Simulation b(settings_with_beta(0), {Material{}}, list, falling_snow(), 1);
  EXPECT_NE(a.state_hash(), b.state_hash());
}

TEST(RigidSnow, AStateWhoseBodyHasNoVelocityIsRefused) {
  Simulation run = thrown(0, 1);
  run.advance_to(0.01);
  std::vector<std::uint8_t> bytes = run.save();
  const double nan = std::nan("");
  // The spin of the last body; only the length of the dust comes after it.
  std::memcpy(bytes.data() + bytes.size() - 2 * sizeof nan, &nan, sizeof nan);
  EXPECT_THROW(run.restore_healthy(bytes), SavedStateError);
  bytes.resize(bytes.size() - sizeof nan);
  EXPECT_THROW(run.restore(bytes), SavedStateError);
}

/// Changes that leave a body alone leave its motion alone; another start velocity throws it.
TEST(RigidSnow, ABodyGoesOnWhenParametersChange) {
  Simulation run = thrown(0, 1), same = thrown(0, 1);
  run.advance_to(0.03);
  same.advance_to(0.03);
  std::vector<shapes::Collider> list = things();
  run.apply(settings_with_beta(0), {Material{}}, list);
  EXPECT_EQ(run.state_hash(), same.state_hash());
  const Vec3d place = shapes::pose_at(run.colliders()[2], run.time()).point;
  list[2].velocity = {0, 3, 0};
  run.apply(settings_with_beta(0), {Material{}}, list);
  EXPECT_EQ(motion_of(run, 2).velocity, Vec3d(0, 3, 0));
  EXPECT_LE((shapes::pose_at(run.colliders()[2], run.time()).point - place).norm(), 1e-12);
  run.advance_to(0.04);
  // A body is thrown once: the same parameters again do not throw it again.
  const Vec3d velocity = motion_of(run, 2).velocity;
  run.apply(settings_with_beta(0), {Material{}}, list);
  EXPECT_EQ(motion_of(run, 2).velocity, velocity);
}

/// The driver that takes one stage after the other.
TEST(RigidSnow, BothDriversMoveBodies) {
  SolverSettings s = settings_with_beta(0);
  Simulation fused(s, {Material{}}, things(), falling_snow(), 1);
  s.bypass = {Stage::volumes};
  Simulation staged(s, {Material{}}, things(), falling_snow(), 1);
  for (Simulation* run : {&fused, &staged}) run->advance_to(0.03);
  EXPECT_LE((motion_of(fused, 3).angular_velocity - motion_of(staged, 3).angular_velocity).norm(),
            0.02 * motion_of(fused, 3).angular_velocity.norm());
}

/// A quick body takes a step in parts if no snow shortens it: neither a thin wall nor another body
/// is passed through.
TEST(RigidSnow, AQuickBodyStopsAtAThinWall) {
  SolverSettings s = settings_with_beta(0);
  s.gravity = Vec3d::Zero();
  s.max_dt = 0.01;
  const shapes::Collider wall = box_of(0, {2, 0, 0}, {0.005, 1, 1});
  for (const double speed : {5.0, 50.0, 500.0}) {
    Simulation run(s, {Material{}}, {wall, ball_of(5000, {0, 0, 0}, 0.05, {speed, 0, 0})},
                   box_of_snow({0, 5, 0}, {0.1, 5.1, 0.1}, 0.02), 1);
    run.advance_to(0.5);
    const shapes::Pose pose = shapes::pose_at(run.colliders()[1], run.time());
    EXPECT_NEAR(pose.point.x(), 2 - 0.0525, 2e-3) << speed;
    EXPECT_LE(pose.velocity.norm(), 0.01) << speed;
  }
}

/// A shape that cannot have a mass is refused when the run is made.
TEST(RigidSnow, APlaneHasNoMass) {
  shapes::Collider floor = plane({0, 0, 0}, {0, 1, 0}, 0.5);
  floor.body.mass = 1;
  EXPECT_THROW(Simulation(settings_with_beta(0), {Material{}}, {floor}, falling_snow(), 1),
               std::invalid_argument);
}

}  // namespace
