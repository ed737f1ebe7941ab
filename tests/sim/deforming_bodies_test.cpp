/// Bodies that move by themselves on meshes that deform.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/bodies.h"
#include "tests/support/meshes.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

class DeformingBodies : public testing::Test {
 protected:
  static shapes::Collider collider(const shapes::MeshSequence& sequence) {
    shapes::Collider c;
    c.name = "sheet";
    c.shape.form = sequence;
    return c;
  }
  TemporaryFolder folder_;
};

/// A plate moves up and to the side at once, under a box that friction carries: its files say the
/// same as a mesh with the velocity. Only the times of contacts differ: a thousandth of its size.
TEST_F(DeformingBodies, FilesOfARigidMotionCarryThemAsThatMotion) {
  const Vec3d velocity(0.3, 0.8, 0);
  const shapes::MeshSequence sequence = written_sequence(folder_, "rise", 12, 20, [&](int k) {
    return plate_obj(Vec3d(2, 0.2, 2), 3, [&](double) { return Vec3d(k / 20.0 * velocity); });
  });
  shapes::Collider rigid;
  rigid.shape.form = shapes::Mesh{(folder_ / "rise_0000.obj").string()};
  rigid.velocity = velocity;
  const shapes::Collider box = box_of(300, {0, 0.2, 0}, {0.2, 0.2, 0.2});
  BodiesAlone by_files({collider(sequence), box}), by_motion({rigid, box});
  for (BodiesAlone* world : {&by_files, &by_motion}) world->run(0.5, 1e-3);
  EXPECT_LT((by_files.pose(1).point - by_motion.pose(1).point).norm(), 2e-4);
  for (const BodiesAlone* world : {&by_files, &by_motion})
    EXPECT_LT((world->pose(1).velocity - velocity).norm(), 1e-2) << "a box rocks a little";
}

/// Gravity and friction are zero, and nothing bounces: the ball goes with the speed of the face.
TEST_F(DeformingBodies, APistonThrowsABallWithItsSpeed) {
  const shapes::MeshSequence sequence = written_sequence(folder_, "piston", 11, 100, [&](int k) {
    return plate_obj(Vec3d(1, 1, 1), 1,
                     [&](double x) { return Vec3d(x > 0 ? 0.02 * k : 0, 0, 0); });
  });
  BodiesAlone world({collider(sequence), ball_of(500, {0.65, 0.1, 0}, 0.1)}, Vec3d::Zero());
  world.run(0.2, 5e-4);
  // It began 0.05 m away, and the piston stopped after 0.2 m.
  EXPECT_NEAR(world.pose(1).velocity.x(), 2, 0.02);
  EXPECT_LT(world.pose(1).velocity.tail<2>().norm(), 0.02);
  EXPECT_NEAR(world.pose(1).point.x(), 0.6 + 2 * 0.2, 0.01);
}

/// A bump rises under one of two balls, beside which nothing moves.
TEST_F(DeformingBodies, EachBodyMeetsTheSurfaceWhereItIs) {
  const auto bump = [](double x) { return std::max(0.0, 1 - std::abs(x - 0.5) / 0.25); };
  const shapes::MeshSequence sequence = written_sequence(folder_, "bump", 7, 60, [&](int k) {
    return plate_obj(Vec3d(2, 0.2, 2), 16,
                     [&](double x) { return Vec3d(0, 0.02 * k * bump(x), 0); });
  });
  shapes::Collider left = ball_of(500, {-0.5, 0.2, 0}, 0.1), right = left;
  right.name = "right";
  right.shape.form = shapes::Sphere{{0.5, 0.2, 0}, 0.1};
  BodiesAlone world({collider(sequence), left, right});
  world.run(0.1, 5e-4);
  EXPECT_LT(world.pose(1).velocity.norm(), 0.01);
  EXPECT_LT((world.pose(1).point - Vec3d(-0.5, 0.2, 0)).norm(), 1e-3);
  // Files every 1/60 s: 1.2 m/s at the tip, on which the ball lies.
  EXPECT_NEAR(world.pose(2).velocity.y(), 1.2, 0.05);
  EXPECT_NEAR(world.pose(2).point.y(), 0.2 + 0.12, 0.01);
  world.run(0.15, 5e-4);
  EXPECT_LT(world.pose(1).velocity.norm(), 0.01);
  EXPECT_GT(world.pose(2).point.y(), 0.2 + 0.12) << "it was thrown";
}

/// A seesaw turns at 2 rad/s: a box that lies on it turns as fast, wherever it lies. Files have
/// chords: 1e-3 of the speed at 60 files a second.
TEST_F(DeformingBodies, ABoxTurnsWithTheSurfaceItLiesOn) {
  const shapes::MeshSequence sequence = written_sequence(folder_, "turn", 13, 60, [&](int k) {
    return box_obj(Vec3d(2, 0.2, 2), rotation_from_vector(Vec3d(0, 0, 2 * k / 60.0)));
  });
  shapes::Collider sheet = collider(sequence), box = box_of(500, {0.5, 0.15, 0}, {0.2, 0.1, 0.2});
  sheet.contact = shapes::Contact::sticky;
  BodiesAlone world({sheet, box});
  world.run(0.1, 5e-4);
  EXPECT_NEAR(world.pose(1).angular_velocity.z(), 2, 0.05);
  const Vec3d turned = rotation_from_vector(Vec3d(0, 0, 0.2)) * Vec3d(0.5, 0.15, 0);
  EXPECT_LT((world.pose(1).point - turned).norm(), 5e-3);
}

/// Snow, a sheet that flaps and a box on it: one thread and two, and a state that was restored
/// while files pass, are the same bits.
TEST_F(DeformingBodies, BitsDependOnNeitherThreadsNorMomentsBefore) {
  const shapes::MeshSequence sequence = written_sequence(folder_, "flap", 9, 40, [&](int k) {
    return plate_obj(Vec3d(1.2, 0.2, 1.2), 6, [&](double x) {
      return Vec3d(0, 0.04 * std::sin(0.8 * k) * std::cos(3 * x) - 0.1, 0);
    });
  });
  SolverSettings settings;
  settings.cell_size = 0.04;
  const ParticleArrays snow = box_of_snow({-0.2, 0.06, -0.2}, {0.05, 0.14, 0.2}, 0.02);
  const std::vector<shapes::Collider> colliders{collider(sequence),
                                                box_of(300, {0.3, 0.2, 0}, {0.2, 0.1, 0.2}),
                                                ball_of(300, {-0.3, 0.2, 0.2}, 0.06)};
  Simulation whole(settings, {Material{}}, colliders, snow, 2),
      alone(settings, {Material{}}, colliders, snow, 1);
  whole.advance_to(0.06);
  const std::vector<std::uint8_t> saved = whole.save();
  whole.advance_to(0.15);
  alone.advance_to(0.06);
  alone.advance_to(0.15);
  ASSERT_FALSE(whole.divergence());
  EXPECT_EQ(whole.state_hash(), alone.state_hash());
  Simulation again(settings, {Material{}}, colliders, snow, 1);
  again.restore(saved);
  again.advance_to(0.15);
  EXPECT_EQ(whole.state_hash(), again.state_hash());
}

}  // namespace
