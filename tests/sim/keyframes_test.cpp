#include "sim/shapes/keyframes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cmath>

#include "sim/shapes/collider.h"

namespace neve::sim {
namespace {

std::vector<sim::shapes::PoseKeyframe> keyframe_path() {
  return {{0.2, Vec3d(0, 1, 0), Vec3d(0, 0, 0)},
          {0.5, Vec3d(1, 0.5, -0.2), Vec3d(40, 0, -30)},
          {0.6, Vec3d(1.4, 0.7, -0.2), Vec3d(90, 20, -60)},
          {1.0, std::nullopt, Vec3d(120, 60, 10)},
          {1.7, Vec3d(0, 0, 2), std::nullopt}};
}
const Vec3d own_place(0.3, 0.2, 0.1), own_rotation(10, 20, 30);

sim::shapes::RigidMotion motion_on_path(double time) {
  return sim::shapes::motion_at(keyframe_path(), own_place, own_rotation, time);
}

/// The rotation vector of what turns one attitude into the next.
Vec3d turn_between(const Mat3d& from, const Mat3d& to) {
  const Eigen::AngleAxisd found(Mat3d(to * from.transpose()));
  return found.angle() * found.axis();
}

TEST(Keyframes, PosePassesThroughThem) {
  for (const sim::shapes::PoseKeyframe& key : keyframe_path()) {
    const sim::shapes::RigidMotion now = motion_on_path(key.time);
    EXPECT_LT((now.point - key.position.value_or(own_place)).norm(), 1e-14);
    const Mat3d expected = rotation_from_degrees(key.rotation.value_or(own_rotation));
    EXPECT_LT((now.rotation - expected).norm(), 1e-12);
    EXPECT_LT((now.rotation * now.rotation.transpose() - Mat3d::Identity()).norm(), 1e-13);
  }
}

TEST(Keyframes, VelocitiesAreTheDerivativesOfThePose) {
  const double e = 1e-5;
  for (double t = 0.003; t < 2; t += 0.011) {
    const sim::shapes::RigidMotion before = motion_on_path(t - e), now = motion_on_path(t),
                                   after = motion_on_path(t + e);
    // Central differences are off by e^2 times third derivatives of some 1000.
    EXPECT_LT(((after.point - before.point) / (2 * e) - now.velocity).norm(), 1e-5) << t;
    EXPECT_LT(
        (turn_between(before.rotation, after.rotation) / (2 * e) - now.angular_velocity).norm(),
        1e-5)
        << t;
  }
}

TEST(Keyframes, VelocitiesAreContinuousAndZeroAtBothEnds) {
  for (const sim::shapes::PoseKeyframe& key : keyframe_path()) {
    const sim::shapes::RigidMotion before = motion_on_path(key.time - 1e-9),
                                   after = motion_on_path(key.time + 1e-9);
    EXPECT_LT((before.velocity - after.velocity).norm(), 1e-5);
    EXPECT_LT((before.angular_velocity - after.angular_velocity).norm(), 1e-5);
  }
  for (const double t : {-1.0, 0.1, 0.2, 1.7, 5.0}) {
    EXPECT_LT(motion_on_path(t).velocity.norm(), 1e-12);
    EXPECT_LT(motion_on_path(t).angular_velocity.norm(), 1e-12);
  }
  EXPECT_GT(motion_on_path(0.5).velocity.norm(), 1);  // in the middle it runs on
}

TEST(Keyframes, TwoEqualOnesHoldStillAndNothingSwingsBeyond) {
  const std::vector<sim::shapes::PoseKeyframe> press{{0, Vec3d(0, 1, 0), Vec3d(0, 0, 0)},
                                                     {1, Vec3d(0, 0.2, 0), Vec3d(0, 0, 170)},
                                                     {2, Vec3d(0, 0.2, 0), Vec3d(0, 0, 170)},
                                                     {3, Vec3d(0, 1, 0), Vec3d(0, 0, 0)}};
  double angle = 0;
  for (double t = 0; t <= 3; t += 0.01) {
    const sim::shapes::RigidMotion now = sim::shapes::motion_at(press, own_place, own_rotation, t);
    EXPECT_GE(now.point.y(), 0.2 - 1e-14);
    EXPECT_LE(now.point.y(), 1 + 1e-14);
    if (t > 1 && t < 2) {
      EXPECT_LT((now.point - Vec3d(0, 0.2, 0)).norm(), 1e-15);
      EXPECT_LT(now.angular_velocity.norm() + now.velocity.norm(), 1e-12);
    }
    const double turned = Eigen::AngleAxisd(now.rotation).angle();
    EXPECT_LE(turned, 170.0001 / 180 * M_PI);
    if (t <= 1) {
      EXPECT_GE(turned, angle - 1e-9);  // the whole way, never back
      angle = turned;
    }
  }
}

TEST(Keyframes, OneKeyframeIsAColliderAtRest) {
  const sim::shapes::RigidMotion now =
      sim::shapes::motion_at({{1, Vec3d(1, 2, 3), Vec3d(0, 90, 0)}}, own_place, {}, 7);
  EXPECT_EQ(now.point, Vec3d(1, 2, 3));
  EXPECT_EQ(now.velocity, Vec3d(0, 0, 0));
  EXPECT_EQ(now.angular_velocity, Vec3d(0, 0, 0));
}

TEST(Keyframes, SurfaceOfACollidersMaterialPointMovesWithIt) {
  sim::shapes::Collider c;
  c.shape = {sim::shapes::Box{own_place, {0.4, 0.2, 0.6}}, own_rotation};
  c.keyframes = keyframe_path();
  const double t = 0.77, e = 1e-5;
  const Vec3d mark(0.1, -0.05, 0.2);
  const auto place = [&](double time) {
    const sim::shapes::Pose pose = sim::shapes::pose_at(c, time);
    return Vec3d(pose.point + pose.rotation * mark);
  };
  const Vec3d difference = (place(t + e) - place(t - e)) / (2 * e);
  EXPECT_LT((difference - sim::shapes::surface_at(c, t, place(t)).velocity).norm(), 1e-5);
  EXPECT_GT(difference.norm(), 0.1);
}

TEST(Keyframes, AColliderWithoutItsKeyframesContinuesFromItsPlace) {
  sim::shapes::Collider before;
  before.shape = {sim::shapes::Box{own_place, {0.4, 0.2, 0.6}}, own_rotation};
  before.keyframes = keyframe_path();
  before.pose_offset = sim::shapes::delayed({}, 0.25);
  sim::shapes::Collider after = before;
  after.keyframes.clear();
  after.velocity = {1, 0, 0};
  after.pose_offset = sim::shapes::offset_after(before, after, 0.9);
  const sim::shapes::Pose was = sim::shapes::pose_at(before, 0.9),
                          is = sim::shapes::pose_at(after, 0.9);
  EXPECT_LT((was.point - is.point).norm(), 1e-14);
  EXPECT_LT((was.rotation - is.rotation).norm(), 1e-13);
  EXPECT_LT((sim::shapes::pose_at(after, 1.4).point - is.point - Vec3d(0.5, 0, 0)).norm(), 1e-14);
  // A collider that waited is where it would have been so much earlier.
  sim::shapes::Collider punctual = before;
  punctual.pose_offset = {};
  EXPECT_LT((sim::shapes::pose_at(punctual, 0.65).point - was.point).norm(), 1e-14);
  // After a change back, keyframes say where the collider is.
  sim::shapes::Collider again = after;
  again.keyframes = keyframe_path();
  again.velocity.setZero();
  again.pose_offset = sim::shapes::offset_after(after, again, 1.2);
  EXPECT_LT(
      (sim::shapes::pose_at(again, 1.25).point - sim::shapes::pose_at(punctual, 1.0).point).norm(),
      1e-14);
}

/// A change of the spin of a body does not take its fall away.
TEST(Keyframes, ABodyKeepsTheSpeedThatWasNotGiven) {
  sim::shapes::Collider before;
  before.shape = {sim::shapes::Sphere{{0, 3, 0}, 0.1}, {0, 0, 0}};
  before.body.density = 500;
  before.velocity = {1, 0, 0};
  before.pose_offset.motion = std::array{Vec3d(1, -2.4, 0), Vec3d(0, 0, 7)};
  sim::shapes::Collider after = before;
  after.angular_velocity = {0, 5, 0};
  after.pose_offset = sim::shapes::body_offset_after(before, after, 0.25);
  EXPECT_EQ(sim::shapes::pose_at(after, 0.25).velocity, Vec3d(1, -2.4, 0));
  EXPECT_EQ(sim::shapes::pose_at(after, 0.25).angular_velocity, Vec3d(0, 5, 0));
  after = before;
  after.velocity = {0, 1, 0};
  after.pose_offset = sim::shapes::body_offset_after(before, after, 0.25);
  EXPECT_EQ(sim::shapes::pose_at(after, 0.25).velocity, Vec3d(0, 1, 0));
  EXPECT_EQ(sim::shapes::pose_at(after, 0.25).angular_velocity, Vec3d(0, 0, 7));
}

TEST(Keyframes, KeyframesTurnThePlaneItself) {
  sim::shapes::Collider c;
  c.shape = {sim::shapes::Plane{{0, 0, 0}, {0, 1, 0}}, {0, 0, 0}};
  c.keyframes = {{0, std::nullopt, Vec3d(0, 0, 0)}, {1, std::nullopt, Vec3d(0, 0, 90)}};
  EXPECT_LT((sim::shapes::surface_at(c, 0, {1, 1, 0}).normal - Vec3d(0, 1, 0)).norm(), 1e-14);
  EXPECT_LT((sim::shapes::surface_at(c, 1, {1, 1, 0}).normal - Vec3d(-1, 0, 0)).norm(), 1e-14);
}

TEST(Keyframes, LargestSpeedIsFound) {
  sim::shapes::Collider c;
  c.keyframes = {{0, Vec3d(0, 0, 0), std::nullopt}, {2, Vec3d(3, 0, 0), std::nullopt}};
  // From rest to rest the middle is 1.5 times as quick as the mean.
  EXPECT_NEAR(sim::shapes::largest_speed(c), 1.5 * 1.5, 1e-12);
  c.keyframes.clear();
  c.velocity = {0, 4, 3};
  EXPECT_EQ(sim::shapes::largest_speed(c), 5);
}

TEST(Keyframes, ThousandsOfKeyframesCostNothing) {
  sim::shapes::Collider c;
  for (int k = 0; k < 8000; ++k)
    c.keyframes.push_back({0.01 * k, Vec3d(0.01 * (k % 7), 0, 0), Vec3d(0, 5.0 * (k % 2), 0)});
  const auto start = std::chrono::steady_clock::now();
  EXPECT_GT(sim::shapes::largest_speed(c), 1);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  // A quarter of a million looks at a microsecond or two each; at all keyframes each they would
  // take a minute.
  EXPECT_LT(taken.count(), 10);
}

TEST(Keyframes, SpinCountsWhereItMovesTheShape) {
  sim::shapes::Collider c;
  c.shape.form = sim::shapes::Box{{1, 1, 1}, {2, 4, 4}};
  c.velocity = {1, 0, 0};
  c.angular_velocity = {0, 0, 10};
  EXPECT_NEAR(sim::shapes::largest_speed(c), 1 + 10 * 3, 1e-12);
  c.shape.form = sim::shapes::Cylinder{{0, 0, 0}, 0.3, 0.8};
  EXPECT_NEAR(sim::shapes::largest_speed(c), 1 + 10 * 0.5, 1e-12);
  c.angular_velocity = {0, 10, 0};
  EXPECT_NEAR(sim::shapes::largest_speed(c), 1, 1e-12) << "about its own axis";
  c.shape.form = sim::shapes::Plane{};
  c.angular_velocity = {0, 0, 10};
  EXPECT_NEAR(sim::shapes::largest_speed(c), 1, 1e-12);
  c = {};
  c.shape.form = sim::shapes::Torus{{0, 0, 0}, 0.4, 0.1};
  c.keyframes = {{0, std::nullopt, Vec3d(0, 0, 0)}, {1, std::nullopt, Vec3d(90, 0, 0)}};
  // From rest to rest, the turn is half as quick again in the middle.
  EXPECT_NEAR(sim::shapes::largest_speed(c), 0.5 * 1.5 * std::acos(0.0), 0.02);
}

}  // namespace
}  // namespace neve::sim
