#include "sim/shapes/collider.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "sim/base/hash.h"

namespace neve::sim {
namespace {

sim::shapes::Collider moving(const sim::shapes::Shape& shape) {
  sim::shapes::Collider collider;
  collider.shape = shape;
  collider.velocity = {0.5, -1, 2};
  collider.angular_velocity = {1, 2, -0.5};
  return collider;
}

std::vector<sim::shapes::Collider> colliders() {
  const Vec3d turn(20, -35, 50);
  return {moving({sim::shapes::Plane{{0.1, 0.2, 0.3}, {1, 4, -2}}, turn}),
          moving({sim::shapes::Sphere{{0.1, 0.2, 0.3}, 0.5}, turn}),
          moving({sim::shapes::Box{{0.1, 0.2, 0.3}, {0.6, 1.0, 0.4}}, turn}),
          moving({sim::shapes::Capsule{{-0.2, -0.3, 0.1}, {0.4, 0.7, 0.5}, 0.3}, turn}),
          moving({sim::shapes::Cylinder{{0.1, 0.2, 0.3}, 0.5, 0.8}, turn}),
          moving({sim::shapes::Cone{{0.1, 0.2, 0.3}, 0.6, 1.1}, turn}),
          moving({sim::shapes::Torus{{0.1, 0.2, 0.3}, 0.6, 0.25}, turn})};
}

Vec3d random_point(std::uint64_t k) {
  return 4 * Vec3d(unit_double(mix64(k, 0)), unit_double(mix64(k, 1)), unit_double(mix64(k, 2))) -
         Vec3d::Constant(2);
}

TEST(Collider, PoseMovesAtConstantVelocityAndTurnsAboutItsCentre) {
  for (const sim::shapes::Collider& c : colliders()) {
    const sim::shapes::Pose pose = sim::shapes::pose_at(c, 0.7);
    EXPECT_LT((pose.point - (Vec3d(0.1, 0.2, 0.3) + 0.7 * c.velocity)).norm(), 1e-15);
    const bool is_plane = std::holds_alternative<sim::shapes::Plane>(c.shape.form);
    const double angle = is_plane ? 0 : 0.7 * c.angular_velocity.norm();
    const Mat3d expected =
        Eigen::AngleAxisd(angle, c.angular_velocity.normalized()).toRotationMatrix() *
        rotation_from_degrees(c.shape.rotation);
    EXPECT_LT((pose.rotation - expected).norm(), 1e-14);
  }
}

TEST(Collider, SurfaceVelocityIsThatOfItsMaterialPoint) {
  for (const sim::shapes::Collider& c : colliders()) {
    if (std::holds_alternative<sim::shapes::Plane>(c.shape.form))
      continue;  // its surface runs, it stays
    const double t = 0.4, e = 1e-5;
    const sim::shapes::Pose now = sim::shapes::pose_at(c, t),
                            before = sim::shapes::pose_at(c, t - e),
                            after = sim::shapes::pose_at(c, t + e);
    const Vec3d mark(0.3, -0.2, 0.6);
    const Vec3d difference =
        (after.point + after.rotation * mark - before.point - before.rotation * mark) / (2 * e);
    const Vec3d velocity = sim::shapes::surface_at(c, t, now.point + now.rotation * mark).velocity;
    EXPECT_LT((difference - velocity).norm(), 1e-8);
  }
}

TEST(Collider, PlaneNeverTurnsButItsSurfaceRuns) {
  const sim::shapes::Collider belt = colliders()[0];
  const Vec3d x(1, 1, 1);
  EXPECT_EQ(sim::shapes::surface_at(belt, 0, x).normal, sim::shapes::surface_at(belt, 5, x).normal);
  EXPECT_NEAR(sim::shapes::signed_distance(belt, 2, x + 2 * belt.velocity),
              sim::shapes::signed_distance(belt, 0, x), 1e-14);
  const Vec3d arm = x - Vec3d(0.1, 0.2, 0.3);
  EXPECT_LT((sim::shapes::surface_at(belt, 0, x).velocity - belt.velocity -
             belt.angular_velocity.cross(arm))
                .norm(),
            1e-15);
}

TEST(Collider, RotationOfAPlaneTurnsItsNormal) {
  sim::shapes::Collider c;
  c.shape = {sim::shapes::Plane{{0, 0, 0}, {0, 3, 0}}, {0, 0, 90}};  // of any length; y turns to -x
  EXPECT_LT((sim::shapes::surface_at(c, 0, {0, 0, 0}).normal - Vec3d(-1, 0, 0)).norm(), 1e-15);
  EXPECT_NEAR(sim::shapes::signed_distance(c, 0, {-2, 5, 1}), 2, 1e-14);
}

TEST(Collider, NormalIsTheGradientOfTheDistance) {
  for (const sim::shapes::Collider& c : colliders())
    for (std::uint64_t k = 0; k < 500; ++k) {
      const Vec3d x = random_point(k);
      const auto distance = [&](const Vec3d& at) {
        return sim::shapes::signed_distance(c, 0.3, at);
      };
      const double e = 1e-6;
      Vec3d gradient;
      for (int a = 0; a < 3; ++a)
        gradient[a] =
            (distance(x + e * Vec3d::Unit(a)) - distance(x - e * Vec3d::Unit(a))) / (2 * e);
      const sim::shapes::Surface s = sim::shapes::surface_at(c, 0.3, x);
      EXPECT_NEAR(s.normal.norm(), 1, 1e-14);
      EXPECT_NEAR(gradient.norm(), 1, 1e-3);
      // Beside an edge the normal stays that of a face, by design: of a box one of three, of a
      // cylinder one of two; the wall of a cone is nowhere steeper to its base than its tip is
      // sharp.
      const bool is_box_outside =
          std::holds_alternative<sim::shapes::Box>(c.shape.form) && s.distance > 0;
      const bool has_edges = std::holds_alternative<sim::shapes::Cylinder>(c.shape.form) ||
                             std::holds_alternative<sim::shapes::Cone>(c.shape.form);
      if (is_box_outside) {
        EXPECT_GT(gradient.dot(s.normal), 1 / std::sqrt(3.0) - 1e-6) << k;
      } else if (has_edges && s.distance > 0) {
        EXPECT_GT(gradient.dot(s.normal), 0.4) << k;
      } else {
        EXPECT_LT((gradient - s.normal).norm(), 1e-6) << k;
      }
    }
}

TEST(Collider, BoxIsEuclideanOutsideAndNearestFaceInside) {
  sim::shapes::Collider c;
  c.shape = {sim::shapes::Box{{1, 0, 0}, {2, 4, 6}}, {0, 0, 0}};
  EXPECT_NEAR(sim::shapes::signed_distance(c, 0, {5, 6, 0}), 5, 1e-15);  // 3 and 4 beyond an edge
  EXPECT_NEAR(sim::shapes::signed_distance(c, 0, {5, 4, 9}), 7, 1e-15);  // 3, 2, 6 beyond a corner
  EXPECT_EQ(sim::shapes::surface_at(c, 0, {5, 6, 0}).normal, Vec3d(0, 1, 0));
  EXPECT_NEAR(sim::shapes::signed_distance(c, 0, {1, -1.75, 0}), -0.25, 1e-15);
  EXPECT_EQ(sim::shapes::surface_at(c, 0, {1, -1.75, 0}).normal, Vec3d(0, -1, 0));
  // Equally near to faces of all axes: the lowest; on the middle plane: the positive side.
  EXPECT_EQ(sim::shapes::surface_at(c, 0, {0.5, -1.5, 2.5}).normal, Vec3d(-1, 0, 0));
  EXPECT_EQ(sim::shapes::surface_at(c, 0, {1, 0, 0}).normal, Vec3d(1, 0, 0));
}

TEST(Collider, MiddleOfASphereLooksUp) {
  sim::shapes::Collider c;
  c.shape = {sim::shapes::Sphere{{1, 2, 3}, 0.5}, {10, 20, 30}};
  EXPECT_EQ(sim::shapes::surface_at(c, 0, {1, 2, 3}).normal, Vec3d(0, 1, 0));
  EXPECT_EQ(sim::shapes::signed_distance(c, 0, {1, 2, 3}), -0.5);
}

}  // namespace
}  // namespace neve::sim
