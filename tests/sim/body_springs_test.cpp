/// Springs and dampers of bodies without snow against the exact motion, in steps of any length.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "tests/support/bodies.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

/// A body on a spring of any stiffness comes to rest where the load is the spring's.
TEST(BodySprings, SpringsHoldTheirLoad) {
  for (const double stiffness : {1e2, 1e4, 1e8}) {
    SCOPED_TRACE(stiffness);
    shapes::Collider ball = ball_of(700, {0, 0, 0}, 0.1);
    const double mass = rigid::mass_properties(ball).mass;
    ball.body.spring_stiffness = stiffness;
    ball.body.spring_damping = 2 * std::sqrt(stiffness * mass);
    BodiesAlone world({ball});
    world.run(2, 1e-3);
    EXPECT_NEAR(world.pose(0).point.y() / (-mass * 9.81 / stiffness), 1, 1e-3);

    shapes::Collider door = box_of(700, {0.25, 0, 0}, {0.5, 0.1, 0.05});
    const double weight = rigid::mass_properties(door).mass * 9.81;
    door.body.joint = shapes::Joint::hinge;
    door.body.joint_axis = {0, 0, 1};
    door.body.joint_stiffness = stiffness;
    const double inertia = rigid::mass_properties(door).mass * (0.25 + 0.01) / 12 +
                           rigid::mass_properties(door).mass * 0.0625;
    door.body.joint_damping = 2 * std::sqrt(stiffness * inertia);
    BodiesAlone hung({door});
    hung.run(2, 1e-3);
    const Vec3d along = hung.pose(0).rotation.col(0);
    const double angle = std::atan2(-along.y(), along.x());
    EXPECT_NEAR(angle * stiffness / (weight * 0.25 * std::cos(angle)), 1, 0.01);
  }
}

/// A door that turns about its middle against a spring, spun so that it swings so far.
shapes::Collider wound_door(double turns, const Vec3d& axis) {
  shapes::Collider door = box_of(700, {0, 0, 0}, {0.5, 0.1, 0.05});
  door.body.joint = shapes::Joint::hinge;
  door.body.joint_axis = axis;
  door.body.joint_stiffness = 300;
  const rigid::MassProperties mass = rigid::mass_properties(door);
  const double rate = std::sqrt(300 / axis.dot(mass.inertia * axis));
  door.angular_velocity = 2 * std::numbers::pi * turns * rate * axis;
  return door;
}

/// A harmonic oscillator turns back after a quarter of its period, is where it started after half
/// of it, and has wound itself up the other way at three quarters. Bullet solves the joint to 1e-9
/// in each step.
TEST(BodySprings, AHingeSpringCountsTurns) {
  for (const Vec3d& axis : {Vec3d(0, 0, 1), Vec3d(0, -1, 0)})
    for (const double turns : {0.4, 0.75, 3.2}) {
      SCOPED_TRACE(turns);
      const shapes::Collider door = wound_door(turns, axis);
      const double spin = door.angular_velocity.norm();
      const double most = 2 * std::numbers::pi * turns;
      const double quarter = 0.5 * std::numbers::pi * most / spin;
      BodiesAlone world({door}, Vec3d::Zero());
      constexpr int parts = 400;
      for (int quarters = 1; quarters <= 40; ++quarters) {
        world.run(quarter, quarter / parts);
        const double phase = 0.5 * std::numbers::pi * quarters;
        EXPECT_NEAR(world.list[0].pose_offset.joint_angle / most, std::sin(phase), 1e-6);
        EXPECT_NEAR(axis.dot(world.pose(0).angular_velocity) / spin, std::cos(phase), 1e-6);
      }
    }
}

/// x(t) of a mass on a spring and a damper that starts at 1 at rest.
double swing_at(double t, double stiffness, double damping) {
  const std::complex<double> root = std::sqrt(
                                 std::complex<double>(0.25 * damping * damping - stiffness)),
                             a = -0.5 * damping + root, b = -0.5 * damping - root;
  return std::real((a * std::exp(b * t) - b * std::exp(a * t)) / (a - b));
}

/// A ball on a spring of 1 rad/s that starts beside its place of rest, at rest.
/// @param damping  1/s
shapes::Collider swinging_ball(double damping) {
  shapes::Collider ball = ball_of(700, {0, 0, 0}, 0.1);
  const double mass = rigid::mass_properties(ball).mass;
  ball.body.spring_stiffness = mass;
  ball.body.spring_damping = damping * mass;
  // Gravity of 2 m/s2 moves the place of rest, by g / w^2.
  ball.body.spring_place = {-1, 2, 0};
  return ball;
}

/// Places and speeds are those of the exact motion after every step, however long it is, as long as
/// a period has 12 of them, and whatever step came before: no spring is damped, or fed, by steps.
TEST(BodySprings, SpringsSwingExactlyInStepsOfAnyLength) {
  for (const double damping : {0.0, 0.3, 1.9, 2.1, 40.0})
    for (const double longest : {1e-3, 0.1, 0.49}) {
      SCOPED_TRACE(testing::Message() << damping << " " << longest);
      BodiesAlone world({swinging_ball(damping)}, {0, -2, 0});
      std::mt19937 random(3);
      for (int k = 1; k <= 400; ++k) {
        const double dt = longest * std::uniform_real_distribution<>(0.01, 1)(random);
        world.step(dt);
        const double t = world.time, e = 1e-5;
        const double speed = (swing_at(t + e, 1, damping) - swing_at(t - e, 1, damping)) / (2 * e);
        ASSERT_NEAR(world.pose(0).point.x(), swing_at(t, 1, damping) - 1, 1e-9) << k;
        ASSERT_NEAR(world.pose(0).velocity.x(), speed, 1e-8) << k;
        ASSERT_NEAR(world.pose(0).point.y(), 0, 1e-9) << k;
        ASSERT_NEAR(world.pose(0).velocity.y(), 0, 1e-9) << k;
      }
    }
}

/// Soft springs and weak dampers: where differences of nearly equal numbers have no digits left.
TEST(BodySprings, TheSoftestSpringsAreExact) {
  for (const double stiffness : {1e-12, 1e-8, 1e-4, 1.0})
    for (const double damping : {0.0, 1e-9, 1e-4, 0.2, 3.0}) {
      SCOPED_TRACE(testing::Message() << stiffness << " " << damping);
      shapes::Collider ball = ball_of(700, {0, 0, 0}, 0.1);
      const double mass = rigid::mass_properties(ball).mass;
      ball.body.spring_stiffness = mass * stiffness;
      ball.body.spring_damping = mass * damping;
      ball.velocity = {1, 0, 0};
      BodiesAlone world({ball}, {0, -1, 0});
      world.run(5, 0.02);
      // Way and speed of a push and of a force, by quadrature of small exact steps.
      double x = 0, v = 1, y = 0, w = 0;
      const double h = 1e-4;
      for (int k = 0; k < 50000; ++k) {
        const auto leap = [&](double& place, double& speed, double force) {
          const auto rate = [&](double p, double s) { return force - stiffness * p - damping * s; };
          const double k1 = rate(place, speed), m = speed + 0.5 * h * k1,
                       k2 = rate(place + 0.5 * h * speed, m), m2 = speed + 0.5 * h * k2,
                       k3 = rate(place + 0.5 * h * m, m2), m3 = speed + h * k3,
                       k4 = rate(place + h * m2, m3);
          place += h * (speed + 2 * m + 2 * m2 + m3) / 6;
          speed += h * (k1 + 2 * k2 + 2 * k3 + k4) / 6;
        };
        leap(x, v, 0);
        leap(y, w, -1);
      }
      EXPECT_NEAR(world.pose(0).point.x(), x, 1e-8);
      EXPECT_NEAR(world.pose(0).velocity.x(), v, 1e-8);
      EXPECT_NEAR(world.pose(0).point.y(), y, 1e-8);
      EXPECT_NEAR(world.pose(0).velocity.y(), w, 1e-8);
    }
}

/// A bar that hangs from the origin, and a spring from its middle to a place.
shapes::Collider sprung_bar(shapes::Joint joint, double stiffness, const Vec3d& place,
                            const Vec3d& size = {0.02, 0.5, 0.02}) {
  shapes::Collider bar = box_of(700, {0, -0.25, 0}, size);
  bar.body.joint = joint;
  bar.body.joint_axis = {0, 0, 1};
  bar.body.joint_point = {0, 0, 0};
  bar.body.spring_stiffness = stiffness;
  bar.body.spring_place = place;
  return bar;
}

/// Moment of inertia of that bar about z through the origin, kg m2.
double inertia_of(const shapes::Collider& bar) {
  const rigid::MassProperties mass = rigid::mass_properties(bar);
  return mass.inertia(2, 2) + mass.mass * 0.25 * 0.25;
}

/// A spring across a joint pulls as a weight in the direction of its place. Forces of a step are
/// linear about its middle, so errors are of the second order in it: of a rad of phase, 1.5e-4
/// of the square of the rad in a step; 5e-4 are allowed. With the speeds of a free body, springs of
/// 500 N/m fed this bar in steps of 1 ms, until it went round.
TEST(BodySprings, ASpringAcrossAJointSwingsItAsAPendulum) {
  const Vec3d place(0.1, -0.6, 0);
  for (const auto joint : {shapes::Joint::hinge, shapes::Joint::ball})
    for (const double stiffness : {50.0, 500.0})
      for (const double dt : {1e-3, 2.5e-3, 5e-3}) {
        SCOPED_TRACE(testing::Message() << stiffness << " N/m, " << dt << " s");
        const shapes::Collider bar = sprung_bar(joint, stiffness, place);
        const double pull = 0.25 * stiffness / inertia_of(bar), bottom = std::atan2(0.1, 0.6),
                     rate = std::sqrt(pull * place.norm());
        BodiesAlone world({bar}, Vec3d::Zero());
        double angle = 0, spin = 0, worst = 0;
        for (int k = 0; k < std::lround(5 / dt); ++k) {
          world.step(dt);
          constexpr int parts = 20;  // of velocity Verlet, whose errors are 400 times smaller
          const double h = dt / parts;
          const auto turn = [&] {
            return pull * (place.x() * std::cos(angle) + place.y() * std::sin(angle));
          };
          for (int part = 0; part < parts; ++part) {
            spin += 0.5 * h * turn();
            angle += h * spin;
            spin += 0.5 * h * turn();
          }
          const Vec3d x = world.pose(0).point;
          worst = std::max(worst, std::abs(std::atan2(x.x(), -x.y()) - angle));
        }
        EXPECT_LE(worst, 5e-4 * rate * dt * rate * dt * rate * 5 * bottom);
      }
}

/// A board on a ball joint swings out of the plane: its energy stays, and its momentum about the
/// line from the joint to the spring's place.
TEST(BodySprings, ASpringAcrossABallJointKeepsEnergyAndMomentum) {
  const Vec3d place(0.3, -0.5, 0);
  shapes::Collider board = sprung_bar(shapes::Joint::ball, 50, place, {0.06, 0.5, 0.02});
  board.angular_velocity = {1.5, 0, 0.5};
  board.velocity = board.angular_velocity.cross(Vec3d(0, -0.25, 0));
  BodiesAlone world({board}, Vec3d::Zero());
  const auto energy = [&] {
    return momentum_of(world.list[0], world.time).kinetic - 50 * place.dot(world.pose(0).point);
  };
  const auto momentum = [&] {
    return momentum_of(world.list[0], world.time).angular.dot(place.normalized());
  };
  const double first_energy = energy(), first_momentum = momentum();
  const double above_bottom = first_energy + 50 * 0.25 * place.norm();
  for (int k = 0; k < 5000; ++k) {
    world.step(1e-3);
    ASSERT_NEAR(energy(), first_energy, 1e-4 * above_bottom) << k;
    ASSERT_NEAR(momentum(), first_momentum, 0.005 * first_momentum) << k;
  }
}

/// A damper takes as much of a spin in long steps as in short ones.
TEST(BodySprings, ADamperAcrossAJointTakesTheSpinExactly) {
  for (const auto joint : {shapes::Joint::hinge, shapes::Joint::ball})
    for (const double dt : {1e-3, 0.01}) {
      shapes::Collider bar = sprung_bar(joint, 0, {0, 0, 0});
      bar.body.spring_damping = 0.3;
      bar.angular_velocity = {0, 0, 1};
      bar.velocity = {0.25, 0, 0};
      BodiesAlone world({bar}, Vec3d::Zero());
      world.run(1, dt);
      const double exact = std::exp(-0.3 * 0.25 * 0.25 / inertia_of(bar));
      EXPECT_NEAR(world.pose(0).angular_velocity.z(), exact, 1e-9) << dt;
    }
}

/// Two springs along a slider are one.
TEST(BodySprings, SpringsOfASliderAndAcrossItAreExactTogether) {
  for (const double dt : {1e-3, 5e-3}) {
    shapes::Collider bar = sprung_bar(shapes::Joint::slider, 500, {0.1, -0.6, 0});
    bar.body.joint_axis = {1, 0, 0};
    bar.body.joint_stiffness = 500;
    const double rate = std::sqrt(1000 / rigid::mass_properties(bar).mass);
    BodiesAlone world({bar}, Vec3d::Zero());
    for (int k = 0; k < 1000; ++k) {
      world.step(dt);
      ASSERT_NEAR(world.pose(0).point.x(), 0.05 * (1 - std::cos(rate * world.time)), 1e-8);
    }
  }
}

/// Springs that are too fast for the step are damped, more and more, and none gains, whatever steps
/// follow each other: a frame of 20 and one shorter step fed a spring of 226 rad/s that moved by
/// the speed of the step before.
TEST(BodySprings, SpringsAreStableForAnySteps) {
  std::mt19937 random(5);
  for (double turn = 0.1; turn < 1e4; turn *= 1.3)
    for (const double damping : {0.0, 0.1, 10.0}) {
      shapes::Collider ball = ball_of(700, {1, 0, 0}, 0.1);
      const double mass = rigid::mass_properties(ball).mass, dt = 0.01;
      ball.body.spring_stiffness = mass * turn * turn / (dt * dt);
      ball.body.spring_damping = damping * mass / dt;
      BodiesAlone world({ball}, Vec3d::Zero());
      double most = 0;
      for (int k = 0; k < 300; ++k) {
        world.step(dt * (k % 7 == 6 ? std::uniform_real_distribution<>(0.01, 1)(random) : 1));
        most = std::max(most, std::abs(world.pose(0).point.x()));
      }
      EXPECT_LE(most, 1 + 1e-9) << turn;
      if (turn > 1) {
        EXPECT_LE(world.pose(0).point.norm(), 1e-3) << turn;
      }
    }
  shapes::Collider ball = ball_of(700, {1, 0, 0}, 0.1);
  ball.body.spring_stiffness = rigid::mass_properties(ball).mass * 226 * 226;
  BodiesAlone world({ball}, Vec3d::Zero());
  double most = 0;
  for (int k = 0; k < 21 * 24 * 5; ++k) {
    world.step(k % 21 == 20 ? 1.0 / 24 - 20 * 0.002 : 0.002);
    most = std::max(most, std::abs(world.pose(0).point.x()));
  }
  EXPECT_NEAR(most, 1, 1e-3);
}

/// The same across a joint, from any place: also from where the bar stands on its head. From 12
/// steps a period on, what the square of the step leaves may be gained: 4 % where it is largest.
TEST(BodySprings, SpringsAcrossJointsAreStableForAnySteps) {
  std::mt19937 random(5);
  const double dt = 0.01;
  for (const auto joint : {shapes::Joint::hinge, shapes::Joint::ball})
    for (const double turn : {0.3, 0.7, 1.0, 3.0, 30.0, 1e3, 1e5})
      for (const double damping : {0.0, 0.3})
        for (int start = 0; start < 8; ++start) {
          SCOPED_TRACE(testing::Message() << turn << " rad in a step, from " << start);
          const double at = std::uniform_real_distribution<>(-3.1, 3.1)(random);
          const Vec3d place(0.6 * std::sin(at), -0.6 * std::cos(at),
                            joint == shapes::Joint::ball ? 0.2 : 0);
          shapes::Collider bar = sprung_bar(joint, 0, place, {0.06, 0.5, 0.02});
          const double stiffness = turn * turn / (dt * dt) * inertia_of(bar) / (0.25 * 0.6);
          bar.body.spring_stiffness = stiffness;
          bar.body.spring_damping = damping * rigid::mass_properties(bar).mass / dt;
          BodiesAlone world({bar}, Vec3d::Zero());
          const double most = stiffness * 0.25 * place.norm();
          const auto energy = [&] {
            return (momentum_of(world.list[0], world.time).kinetic -
                    stiffness * place.dot(world.pose(0).point)) /
                   most;
          };
          const double first = energy();
          for (int k = 0; k < 300; ++k) {
            world.step(dt * (k % 7 == 6 ? std::uniform_real_distribution<>(0.01, 1)(random) : 1));
            ASSERT_LE(energy(), first + (turn < 0.5 ? 0.05 : 1e-9)) << k;
          }
          if (turn >= 1) {
            EXPECT_LE(energy(), -1 + 1e-3);
          }
        }
}

/// Nothing holds a body that has a spring or a damper alone: it begins as the scene says, and may
/// get either during a run.
TEST(BodySprings, ABodyThatOnlyASpringHoldsBegins) {
  SolverSettings settings;
  settings.gravity.setZero();
  for (const auto& [stiffness, damping] : {std::pair{100.0, 0.0}, {0.0, 5.0}, {100.0, 5.0}}) {
    shapes::Collider ball = ball_of(700, {0, 0.6, 0}, 0.1, {1, 0, 0});
    ball.angular_velocity = {0, 2, 0};
    Simulation plain(settings, {Material{}}, {ball}, {});
    ball.body.spring_place = {0, 0.6, 0};
    ball.body.spring_stiffness = stiffness;
    ball.body.spring_damping = damping;
    Simulation simulation(settings, {Material{}}, {ball}, {});
    EXPECT_EQ(motion_of(simulation, 0).velocity, Vec3d(1, 0, 0));
    EXPECT_EQ(motion_of(simulation, 0).angular_velocity, Vec3d(0, 2, 0));
    plain.apply(settings, {Material{}}, {ball});
    for (Simulation* each : {&simulation, &plain}) {
      for (int k = 0; k < 10; ++k) each->step(1e-3);
      EXPECT_LT(motion_of(*each, 0).velocity.x(), 1 - 1e-4);
    }
    EXPECT_EQ(simulation.state_hash(), plain.state_hash());
  }
}

/// A body that a spring presses on a floor lies still, also where it would bounce.
TEST(BodySprings, ABodyThatASpringPressesOnTheFloorRests) {
  for (const double restitution : {0.0, 0.8}) {
    SCOPED_TRACE(restitution);
    shapes::Collider box = box_of(125, {0, 0.1, 0}, {0.2, 0.2, 0.2});
    box.body.hold = {shapes::HeldAxis::z};
    box.body.spring_place = {0, -0.9, 0};
    box.body.spring_stiffness = 1000;
    box.body.restitution = restitution;
    BodiesAlone world({plane({0, 0, 0}, {0, 1, 0}, 0.5), box});
    for (int k = 0; k < 1000; ++k) {
      world.step(k % 3 == 0 ? 4e-4 : 1e-3);
      ASSERT_NEAR(world.pose(1).point.y(), 0.1, 1e-3) << k;
      ASSERT_LE(world.pose(1).velocity.norm(), 5e-3) << k;
    }
  }
}

/// A spring presses its body on a floor with the force that it has there, and the body stays.
TEST(BodySprings, ASpringPressesOnTheFloor) {
  shapes::Collider box = box_of(700, {0, 0.1, 0}, {0.2, 0.2, 0.2});
  box.body.spring_stiffness = 2000;
  box.body.spring_place = {0, -0.1, 0};
  BodiesAlone world({plane({0, 0, 0}, {0, 1, 0}, 0.5), box});
  for (int k = 0; k < 2000; ++k) {
    world.step(k % 3 == 0 ? 4e-4 : 1e-3);
    ASSERT_NEAR(world.pose(1).point.y(), 0.1, 1e-3);
    ASSERT_LE(world.pose(1).velocity.norm(), 5e-3);
  }
}

}  // namespace
