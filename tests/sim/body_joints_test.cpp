/// Bodies without snow that joints and `hold` leave some freedom: their motion, and how it starts.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/bodies.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

TEST(RigidBodies, APendulumSwingsInItsTime) {
  // A bar hung by its end: T = 2 pi sqrt(2 L / 3 g), times 1 + a^2/16 for a swing of a.
  shapes::Collider bar = box_of(700, {0, -0.25, 0}, {0.02, 0.5, 0.02});
  bar.body.joint = shapes::Joint::hinge;
  bar.body.joint_axis = {0, 0, 1};
  bar.angular_velocity = {0, 0, 0.5};
  bar.velocity = {0.125, 0, 0};
  BodiesAlone world({bar});
  std::vector<double> crossings;
  for (double before = 1; world.time < 3;) {
    world.step(2e-4);
    const double x = world.pose(0).point.x();
    if (before < 0 && x >= 0) crossings.push_back(world.time);
    before = x;
  }
  ASSERT_GE(crossings.size(), 2u);
  const double period = (crossings.back() - crossings.front()) / double(crossings.size() - 1);
  const double inertia = (0.5 * 0.5 + 0.02 * 0.02) / 12 + 0.25 * 0.25;
  const double exact = 2 * std::numbers::pi * std::sqrt(inertia / (9.81 * 0.25));
  const double angle = 0.5 * std::sqrt(inertia / (9.81 * 0.25));
  EXPECT_NEAR(period / (exact * (1 + angle * angle / 16)), 1, 2e-3);
  EXPECT_LE(std::abs(world.pose(0).point.z()), 1e-6);
  EXPECT_NEAR(world.pose(0).point.norm(), 0.25, 1e-3) << "the hinge came off";
}

/// A body that swings or spins on a joint keeps its energy, and about the vertical its angular
/// momentum, for as long as it does. Gravity pushes at the start of a step, so the energy of one
/// swing comes and goes by some thousandths, of 1 ms, and none is lost. With speeds along the
/// tangent at the start of each step, a top of 20 rad/s lost a third of it in 10 s, and turned
/// round the other way.
TEST(RigidBodies, WhatTurnsOnAJointKeepsItsEnergy) {
  struct Case {
    shapes::Joint joint;
    Vec3d spin;
    std::vector<shapes::HeldAxis> hold;  // in the plane, where it is anyway
  };
  using enum shapes::HeldAxis;
  for (const auto& [joint, spin, hold] : {Case{shapes::Joint::hinge, {0, 0, 0.5}, {}},
                                          {shapes::Joint::hinge, {0, 0, 15}, {}},
                                          {shapes::Joint::hinge, {0, 0, 15}, {turn_x, turn_y}},
                                          {shapes::Joint::ball, {0, 0, 8}, {}},
                                          {shapes::Joint::ball, {0, 0, 15}, {z, turn_x, turn_y}},
                                          {shapes::Joint::ball, {3, 20, 3}, {}}}) {
    SCOPED_TRACE(testing::Message() << spin.transpose() << " rad/s");
    shapes::Collider bar = box_of(700, {0, -0.25, 0}, {0.06, 0.5, 0.02});
    bar.body.joint = joint;
    bar.body.joint_axis = {0, 0, 1};
    bar.body.hold = hold;
    bar.angular_velocity = spin;
    bar.velocity = spin.cross(Vec3d(0, -0.25, 0));
    BodiesAlone world({bar});
    const double weight = rigid::mass_properties(bar).mass * 9.81;
    const auto now = [&] { return momentum_of(world.list[0], world.time); };
    const double first = now().kinetic, about = now().angular.y();
    for (int k = 0; k < 10000; ++k) {
      world.step(1e-3);
      ASSERT_NEAR(now().kinetic + weight * (world.pose(0).point.y() + 0.25), first, 0.004 * first);
      ASSERT_NEAR(now().angular.y(), about, 1e-6 * now().angular.norm() + 1e-12);
      ASSERT_NEAR(world.pose(0).point.norm(), 0.25, 1e-9);
    }
  }
}

/// Held in the attitude of its free axis, a box that rests on a rail under one half of it does not
/// lean more and more.
TEST(RigidBodies, WhatTurnsAboutOneAxisDoesNotLean) {
  shapes::Collider box = box_of(700, {0, 0.2, 0}, {0.2, 0.2, 0.4});
  box.body.hold = {shapes::HeldAxis::z, shapes::HeldAxis::turn_x, shapes::HeldAxis::turn_y};
  shapes::Collider rail = box_of(0, {0, 0.05, 0.15}, {0.6, 0.1, 0.1});
  rail.body = {};
  BodiesAlone world({rail, box});
  world.run(2, 1e-3);
  const double lean = std::abs(world.pose(1).rotation.col(2).y());
  EXPECT_LT(lean, 2e-3) << "rad";
  world.run(6, 1e-3);
  EXPECT_LT(std::abs(world.pose(1).rotation.col(2).y()), lean + 1e-4);
}

/// A sign goes through its post. A world that is made anew, later, when the post moves otherwise,
/// knows the overlap at the start, too.
TEST(RigidBodies, ASignPassesItsPostAfterTheSceneWasChanged) {
  shapes::Collider sign = box_of(400, {0, 0.5, 0}, {0.4, 0.3, 0.04});
  sign.body.joint = shapes::Joint::hinge;
  sign.body.joint_axis = {1, 0, 0};
  sign.body.joint_point = {0, 0.65, 0};
  shapes::Collider post = box_of(0, {0, 0.5, 0}, {0.05, 1, 0.05});
  post.body = {};
  shapes::Collider moved = post;
  moved.velocity = {0, 0, 0.6};
  moved.pose_offset = shapes::offset_after(post, moved, 0.45);
  BodiesAlone world({moved, sign});
  world.time = 0.45;
  world.run(0.3, 1e-3);
  EXPECT_NEAR((world.pose(1).rotation - Mat3d::Identity()).norm(), 0, 1e-9);
}

TEST(RigidBodies, WhatIsHeldStays) {
  shapes::Collider box = box_of(700, {0, 1, 0}, {0.1, 0.1, 0.1});
  box.velocity = {1, 1, 1};
  box.angular_velocity = {1, 2, 3};
  box.body.hold = {shapes::HeldAxis::y, shapes::HeldAxis::turn_x, shapes::HeldAxis::turn_z};
  BodiesAlone world({box});
  world.run(0.5, 1e-3);
  EXPECT_NEAR(world.pose(0).point.y(), 1, 2e-3);
  EXPECT_NEAR(world.pose(0).point.x(), 0.5, 2e-3);
  EXPECT_NEAR(world.pose(0).rotation(1, 1), 1, 1e-4) << "it turned about another axis than y";

  shapes::Collider slider = box_of(700, {0, 0, 0}, {0.1, 0.1, 0.1});
  slider.body.joint = shapes::Joint::slider;
  slider.body.joint_axis = Vec3d(1, -1, 0);
  BodiesAlone slide({slider});
  slide.run(0.5, 1e-4);
  const Vec3d axis = Vec3d(1, -1, 0).normalized();
  const double exact = 0.5 * 9.81 * std::sqrt(0.5) * 0.25;
  EXPECT_NEAR(slide.pose(0).point.dot(axis) / exact, 1, 1e-3);
  EXPECT_LE((slide.pose(0).point - axis * slide.pose(0).point.dot(axis)).norm(), 1e-6);
}

/// It is let out of the slope along the one way that is free, gently.
TEST(RigidBodies, WhatIsHeldInsideOfASlopeIsNotThrown) {
  shapes::Collider box = box_of(300, {0, -0.02, 0}, {0.2, 0.2, 0.2});
  box.body.hold = {shapes::HeldAxis::y, shapes::HeldAxis::z, shapes::HeldAxis::turn_z};
  BodiesAlone world({plane({0, 0, 0}, {0.2, 1, 0}, 0), box});
  for (int step = 0; step < 200; ++step) {
    world.run(0.01, 1e-3);
    EXPECT_LT(world.pose(1).velocity.norm(), 4) << "twenty times its size in a second";
  }
  EXPECT_NEAR(world.pose(1).point.y(), -0.02, 1e-3);
}

/// A box of 4 kg that only spins about its centre, 0.3 m from its hinge.
shapes::Collider spinning_sign() {
  shapes::Collider sign = box_of(500, {0.3, 3, 0}, {0.2, 0.2, 0.2});
  sign.body.joint = shapes::Joint::hinge;
  sign.body.joint_point = {0, 3, 0};
  sign.body.joint_axis = {0, 0, 1};
  sign.angular_velocity = {0, 0, 2};
  return sign;
}

/// A joint takes away what it does not allow as an impact does: a box of 4 kg that only spins about
/// its centre, 0.3 m from its hinge, keeps I / (I + m r^2) of its spin. With the velocity that
/// belongs to the spin nothing is taken away.
TEST(RigidBodies, AHingedBodyStartsAsItsHingeAllows) {
  shapes::Collider sign = spinning_sign();
  const double about_centre = 4 * 0.04 / 6, kept = about_centre / (about_centre + 4 * 0.09);
  rigid::Motion start = rigid::motion_at_start(sign);
  EXPECT_LT((start.spin - Vec3d(0, 0, 2 * kept)).norm(), 1e-12);
  EXPECT_LT((start.velocity - Vec3d(0, 0.6 * kept, 0)).norm(), 1e-12);
  sign.velocity = {0, 0.6, 0};
  start = rigid::motion_at_start(sign);
  EXPECT_LT((start.spin - Vec3d(0, 0, 2)).norm(), 1e-12);
  EXPECT_LT((start.velocity - Vec3d(0, 0.6, 0)).norm(), 1e-12);
}

/// The impulses that hold a turn change the free ones where the body has products of inertia in the
/// axes of the world, and only there. Steps find the same.
TEST(RigidBodies, ABodyThatIsHeldStartsAsItMovesOn) {
  for (const Vec3d& degrees : {Vec3d(10, 20, 30), Vec3d(0, 0, 0)}) {
    shapes::Collider box = box_of(500, {0, 1, 0}, {0.3, 0.2, 0.1}, degrees);
    box.body.hold = {shapes::HeldAxis::z, shapes::HeldAxis::turn_x};
    box.velocity = {1, 2, 3};
    box.angular_velocity = {3, 2, 1};
    const rigid::Motion start = rigid::motion_at_start(box);
    EXPECT_LT((start.velocity - Vec3d(1, 2, 0)).norm(), 1e-12);
    EXPECT_NEAR(start.spin.x(), 0, 1e-12);
    const double changed = (start.spin - Vec3d(0, 2, 1)).norm();
    if (degrees.isZero())
      EXPECT_LT(changed, 1e-12);
    else
      EXPECT_GT(changed, 0.1);
    const rigid::MassProperties mass = rigid::mass_properties(box);
    const Mat3d axes = rotation_from_degrees(degrees);
    const Vec3d taken =
        axes * mass.inertia * axes.transpose() * (box.angular_velocity - start.spin);
    EXPECT_LT(taken.tail<2>().norm(), 1e-12 * taken.norm()) << "an impulse about another axis";
    BodiesAlone world({box}, Vec3d::Zero());
    world.step(1e-7);  // the free motion turns the spin by 3e-7 rad/s in it
    EXPECT_LT((world.pose(0).angular_velocity - start.spin).norm(), 1e-6);
    EXPECT_LT((world.pose(0).velocity - start.velocity).norm(), 1e-6);
  }
}

/// The motions that a run reports for its first frame are those with which its bodies move.
TEST(RigidBodies, ASimulationBeginsWithMotionsThatAreAllowed) {
  SolverSettings settings;
  settings.gravity.setZero();
  Simulation simulation(settings, {Material{}}, {spinning_sign()}, {});
  const Vec3d first = motion_of(simulation, 0).angular_velocity;
  EXPECT_NEAR(first.z(), 2 * 0.16 / (0.16 + 6 * 0.36), 1e-12);
  simulation.step(1e-4);
  EXPECT_LT((motion_of(simulation, 0).angular_velocity - first).norm(), 1e-9);
}

}  // namespace
