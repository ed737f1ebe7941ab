#include "sim/shapes/distance_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "sim/shapes/collider.h"
#include "sim/shapes/solid.h"
#include "sim/state/kernel_pose.h"
#include "tests/support/meshes.h"
#include "tests/support/temporary_folder.h"

namespace neve::sim {
namespace {

using test::ball_obj;
using test::box_obj;
using test::TemporaryFolder;

sim::shapes::Mesh written_mesh(const TemporaryFolder& folder, const std::string& text,
                               double scale = 1) {
  return {folder.write("mesh.obj", text).string(), scale, {0, 0, 0}};
}

double distance_to_box(const Vec3d& size, const Vec3d& x) {
  const Vec3d q = x.cwiseAbs() - 0.5 * size;
  return q.maxCoeff() > 0 ? q.cwiseMax(0).norm() : q.maxCoeff();
}

Vec3d place_within(std::mt19937& random, double reach) {
  std::uniform_real_distribution<double> unit(-reach, reach);
  return {unit(random), unit(random), unit(random)};
}

std::string mesh_complaint(const sim::shapes::Mesh& mesh, double cell_size) {
  ThreadPool pool(1);
  try {
    sim::shapes::distance_field(mesh, cell_size, pool);
  } catch (const ShapeError& error) {
    return error.what();
  }
  return "";
}

TEST(MeshSurface, MeshSurfaceIsAsFarAsTheFormulaSays) {
  const TemporaryFolder folder;
  const Vec3d size(0.4, 0.8, 0.6);
  const auto box = sim::shapes::mesh_surface(written_mesh(folder, box_obj(size / 0.5), 0.5));
  std::mt19937 random(1);
  for (int k = 0; k < 2000; ++k) {
    const Vec3d x = place_within(random, 0.8);
    EXPECT_NEAR(box->signed_distance(x), distance_to_box(size, x), 1e-12);
    const Vec3d away = 1e-6 * box->normal(x);
    EXPECT_GT(box->signed_distance(x + away), box->signed_distance(x - away) + 1e-6);
  }
  // A distance beyond the requested bound is the bound.
  EXPECT_NEAR(box->distance({5, 0, 0}, 0.25), 0.25, 1e-15);
}

/// One place as kernels see it.
template <class Real>
std::pair<double, Vec3d> kernel_in_field(const sim::shapes::DistanceField& field, const Vec3d& x) {
  sim::shapes::Collider collider;
  collider.shape.form = sim::shapes::Mesh{};
  const double h = 0.125;
  const int block[3] = {0, 0, 0};
  const sim::kernels::ColliderPose pose =
      *sim::engine::kernel_pose(collider, 0, h, Vec3i::Zero(), field.samples());
  using V = Quad<Real>;
  Vec3<V> n;
  const V d = sim::kernels::surface_distance(
      sim::kernels::localize<Real>(pose, block, h),
      Vec3<V>{all<V>(static_cast<Real>(x[0])), all<V>(static_cast<Real>(x[1])),
              all<V>(static_cast<Real>(x[2]))},
      n);
  return {static_cast<double>(d[2]), Vec3d(static_cast<double>(n.x[2]), static_cast<double>(n.y[2]),
                                           static_cast<double>(n.z[2]))};
}

TEST(DistanceField, DistanceFieldOfABoxIsExactButAtEdges) {
  const TemporaryFolder folder;
  const Vec3d size(0.4, 0.8, 0.6);
  ThreadPool pool(2);
  const double spacing = 0.02;
  const sim::shapes::DistanceField field(
      *sim::shapes::mesh_surface(written_mesh(folder, box_obj(size))), "box", spacing, pool);
  std::mt19937 random(2);
  for (int k = 0; k < 20000; ++k) {
    const Vec3d x = place_within(random, 0.44);
    const auto [distance, normal] = kernel_in_field<double>(field, x);
    const double exact = distance_to_box(size, x);
    if (exact > 1.9 * spacing) continue;  // beyond the lattice there is a bound
    // Distances are straight but where the nearest face changes: there, samples of both sides are
    // mixed. Off by most is a place halfway between two samples with the ridge between opposite
    // faces through it: half of their spacing (3/8 where three faces meet, 1/4 along an edge).
    EXPECT_NEAR(distance, exact, spacing / 2);
    Vec3d q = x.cwiseAbs() - 0.5 * size;
    std::sort(q.begin(), q.end());
    const bool is_one_face = q[2] < 0 ? q[2] - q[1] > 2.1 * spacing : q[1] < -2.1 * spacing;
    if (!is_one_face) continue;
    EXPECT_NEAR(distance, exact, 1e-7);  // samples are floats of some decimetres
    Eigen::Index axis = 0;
    (x.cwiseAbs() - 0.5 * size).maxCoeff(&axis);
    EXPECT_NEAR(normal[axis], x[axis] > 0 ? 1 : -1, 1e-6);
    EXPECT_NEAR(kernel_in_field<float>(field, x).first, exact, 3e-7);
  }
}

TEST(DistanceField, DistanceFieldOfABallIsWithinItsCurvature) {
  const TemporaryFolder folder;
  const double radius = 0.3, spacing = 0.02;
  const int rings = 96;
  ThreadPool pool(2);
  const sim::shapes::DistanceField field(
      *sim::shapes::mesh_surface(written_mesh(folder, ball_obj(radius, rings))), "ball", spacing,
      pool);
  const double facets = 0.5 * radius * std::pow(M_PI / rings, 2);
  std::mt19937 random(3);
  for (int k = 0; k < 20000; ++k) {
    const Vec3d x = place_within(random, 0.33);
    if (x.norm() < 0.1) continue;  // the middle is a point of no gradient
    const auto [distance, normal] = kernel_in_field<double>(field, x);
    // Linear between samples: s^2/8 times the second derivatives along three axes, 2/r in all.
    const double curved = spacing * spacing / 8 * 2 / (x.norm() - 2 * spacing);
    EXPECT_NEAR(distance, x.norm() - radius, facets + curved + 1e-6);
    if (std::abs(distance) > 1.5 * spacing) continue;
    // Slopes of the same interpolation: s/2 times the second derivatives, and facets.
    EXPECT_LT((normal - x.normalized()).norm(), spacing / (x.norm() - 2 * spacing) + M_PI / rings);
  }
}

TEST(DistanceField, BeyondItsLatticeStaysBelowTheDistanceAndAboveZero) {
  const TemporaryFolder folder;
  const Vec3d size(0.4, 0.8, 0.6);
  ThreadPool pool(1);
  const sim::shapes::DistanceField field(
      *sim::shapes::mesh_surface(written_mesh(folder, box_obj(size))), "box", 0.05, pool);
  std::mt19937 random(4);
  for (int k = 0; k < 4000; ++k) {
    const Vec3d x = place_within(random, 3);
    const double exact = distance_to_box(size, x);
    if (exact < 0.2) continue;
    const double found = kernel_in_field<double>(field, x).first;
    EXPECT_GT(found, 0);
    EXPECT_LT(found, exact + 0.05 / 3);
    EXPECT_GT(found, 0.5 * exact);
  }
  // NaN must not read beyond the samples.
  EXPECT_FALSE(kernel_in_field<double>(field, Vec3d::Constant(NAN)).first <= 0);
}

TEST(DistanceField, DistanceFieldHasTheSameBitsOnAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const auto surface = sim::shapes::mesh_surface(written_mesh(folder, ball_obj(0.3, 24)));
  ThreadPool one(1), three(3);
  const sim::shapes::DistanceField a(*surface, "ball", 0.02, one), b(*surface, "ball", 0.02, three);
  ASSERT_EQ(a.bytes(), b.bytes());
  EXPECT_GT(a.bytes(), 100000u);
  EXPECT_EQ(std::memcmp(a.samples().distance, b.samples().distance, a.bytes()), 0);
}

TEST(DistanceField, DistanceFieldIsComputedOncePerVersionOfAFile) {
  const TemporaryFolder folder;
  ThreadPool pool(2);
  const sim::shapes::Mesh mesh = written_mesh(folder, box_obj({0.4, 0.4, 0.4}));
  const auto first = sim::shapes::distance_field(mesh, 0.05, pool);
  EXPECT_EQ(first, sim::shapes::distance_field(mesh, 0.05, pool));
  EXPECT_NE(first, sim::shapes::distance_field(mesh, 0.01, pool));
  sim::shapes::Mesh larger = mesh;
  larger.scale = 2;
  EXPECT_NE(first, sim::shapes::distance_field(larger, 0.05, pool));
  written_mesh(folder, box_obj({0.4, 0.4, 0.45}));
  EXPECT_NE(first, sim::shapes::distance_field(mesh, 0.05, pool));
}

TEST(DistanceField, SpacingFollowsCellsAndThinParts) {
  const TemporaryFolder folder;
  const auto thick = sim::shapes::mesh_surface(written_mesh(folder, box_obj({0.8, 0.8, 0.8})));
  EXPECT_DOUBLE_EQ(sim::shapes::field_spacing(*thick, 0.02), 0.01);
  const auto thin = sim::shapes::mesh_surface(written_mesh(folder, box_obj({0.4, 0.04, 0.4})));
  EXPECT_DOUBLE_EQ(sim::shapes::field_spacing(*thin, 0.02), 0.005);
  EXPECT_DOUBLE_EQ(sim::shapes::field_spacing(*thick, 0.2), 0.0125);
}

TEST(DistanceField, FacesWithADentAreExact) {
  const TemporaryFolder folder;
  const auto surface = sim::shapes::mesh_surface(written_mesh(
      folder,
      "v 0 0 0\nv 1 0 0\nv 0.2 0.2 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0.2 0.2 1\nv 0 1 1\n"
      "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"));
  EXPECT_NEAR(surface->mesh().volume, 0.2, 1e-15);
  // In the dent the nearest place is one of its walls; some fans would fill it.
  const double to_wall = 0.1 / std::hypot(0.8, 0.2);
  EXPECT_NEAR(surface->signed_distance({0.3, 0.3, 0.5}), to_wall, 1e-15);
  EXPECT_NEAR(surface->signed_distance({0.3, 0.3, -0.2}), std::hypot(to_wall, 0.2), 1e-15);
  EXPECT_NEAR(surface->signed_distance({0.05, 0.05, 0.5}), -0.05, 1e-15);
}

TEST(DistanceField, FacesInsideAreNoSurface) {
  const TemporaryFolder folder;
  const auto surface = sim::shapes::mesh_surface(written_mesh(
      folder,
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
      "v 0.5 0.1 0.1\nv 1.5 0.1 0.1\nv 1.5 0.9 0.1\nv 0.5 0.9 0.1\n"
      "v 0.5 0.1 0.9\nv 1.5 0.1 0.9\nv 1.5 0.9 0.9\nv 0.5 0.9 0.9\n"
      "f 9 12 11 10\nf 13 14 15 16\nf 9 10 14 13\nf 10 11 15 14\nf 11 12 16 15\nf 12 9 13 16\n"));
  // This place is on the wall of the second box that is in the first.
  EXPECT_NEAR(surface->signed_distance({0.5, 0.5, 0.5}), -0.5, 1e-12);
  // This place is in the first box's mouth under the second: pieces end within 1/128 of the mesh.
  EXPECT_NEAR(surface->signed_distance({1, 0.5, 0.5}), -0.4, 1.5 / 128);
  EXPECT_NEAR(surface->signed_distance({2, 0.5, 0.5}), 0.5, 1e-12);
}

TEST(DistanceField, DistanceFieldNamesTheDefectOfAMesh) {
  const TemporaryFolder folder;
  const std::string box = box_obj({0.4, 0.4, 0.4});
  sim::shapes::Mesh open = written_mesh(folder, box.substr(0, box.rfind("f 2")));
  open.fill = sim::shapes::Fill::closed;
  EXPECT_NE(mesh_complaint(open, 0.05).find("is open"), std::string::npos);
  EXPECT_NE(mesh_complaint(written_mesh(folder, box, 100), 0.05).find("at most 256^3"),
            std::string::npos);
  // A prism over a quadrilateral whose sides cross.
  const std::string crossed =
      "v 0 0 0\nv 2 0 0\nv 0.5 2 0\nv 1.5 1 0\nv 0 0 1\nv 2 0 1\nv 0.5 2 1\nv 1.5 1 1\n"
      "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const std::string said = mesh_complaint(written_mesh(folder, crossed), 0.05);
  EXPECT_NE(said.find("mesh.obj:9: face 1 crosses itself"), std::string::npos) << said;
  EXPECT_NE(mesh_complaint({(folder / "none.obj").string(), 1, {0, 0, 0}}, 0.05).find("none.obj"),
            std::string::npos);
  // Paper is so thin that no place of the lattice is inside, and too long for a finer lattice.
  const std::string paper = box_obj({4, 0.001, 4});
  EXPECT_NE(mesh_complaint(written_mesh(folder, paper), 0.05).find("thinner"), std::string::npos);
}

TEST(DistanceField, DistanceFieldRefusesScalesThatLeaveNoMesh) {
  const TemporaryFolder folder;
  const std::string box = box_obj({1, 1, 1});
  // 1e-322 cubed, and then already over 64, is 0.
  for (const double scale : {1e-322, 1e-160, 1e-10, 1e200}) {
    const std::string said = mesh_complaint(written_mesh(folder, box, scale), 0.05);
    EXPECT_NE(said.find("mesh.obj: with scale = "), std::string::npos) << said;
    EXPECT_NE(said.find("metres per unit of the file"), std::string::npos) << said;
    EXPECT_THROW(sim::shapes::Solid({written_mesh(folder, box, scale)}), ShapeError);
  }
  // A mesh much smaller than cells has a lattice of its own size.
  EXPECT_EQ(mesh_complaint(written_mesh(folder, box, 1e-8), 0.05), "");
}

}  // namespace
}  // namespace neve::sim
