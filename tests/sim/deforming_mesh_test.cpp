/// Meshes that deform from file to file: how they are read, and where they are between files.

#include "sim/shapes/deforming_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/shapes/collider.h"
#include "sim/shapes/deforming_field.h"
#include "sim/shapes/numbered_files.h"
#include "sim/state/kernel_pose.h"
#include "tests/support/meshes.h"
#include "tests/support/temporary_folder.h"

namespace neve {
namespace {

using sim::Vec3d;
using sim::Vec3i;
using sim::shapes::DeformingField;
using sim::shapes::DeformingMesh;
using sim::shapes::MeshSequence;
using test::TemporaryFolder;

Vec3d still(double) {
  return Vec3d::Zero();
}

std::string complaint(const MeshSequence& sequence) {
  try {
    DeformingMesh mesh(sequence);
  } catch (const sim::ShapeError& error) {
    return error.what();
  }
  return "";
}

TEST(NumberedFiles, PatternsNameOneNumber) {
  using sim::shapes::is_file_pattern, sim::shapes::numbered_file;
  EXPECT_EQ(numbered_file("a/b_%04d.obj", 7), "a/b_0007.obj");
  EXPECT_EQ(numbered_file("b%02d.obj", 123), "b123.obj");
  EXPECT_EQ(numbered_file("b%d.obj", 123), "b123.obj");
  for (const char* four : {"s.%04d.exr", "s.####.exr", "s.$F4.exr"}) {
    EXPECT_EQ(numbered_file(four, 1001), "s.1001.exr");
    EXPECT_EQ(numbered_file(four, -8), "s.-008.exr") << "the sign is a digit, as for printf";
    EXPECT_EQ(numbered_file(four, 12345), "s.12345.exr");
  }
  EXPECT_EQ(numbered_file("$F.obj", 12), "12.obj");
  EXPECT_EQ(numbered_file("100%/b%d.obj", 1), "100%/b1.obj") << "folders may have any name";
  for (const char* wrong : {"", "b.obj", "%d/b.obj", "b%d_%d.obj", "b%s.obj", "b%4d.obj",
                            "b%00d.obj", "b%012d.obj", "b%", "b%0", "b%%d.obj", "b%n.obj"})
    EXPECT_FALSE(is_file_pattern(wrong)) << wrong;
}

TEST(DeformingMesh, VerticesMoveOnStraightLinesAndRestBeforeAndAfter) {
  const TemporaryFolder folder;
  MeshSequence sequence = test::written_sequence(folder, "plate", 3, 10, [](int k) {
    return test::plate_obj({1, 0.2, 1}, 4, [&](double x) { return Vec3d(0, k * x * x, 0); });
  });
  sequence.start = 0.5;
  sequence.scale = 2;
  const DeformingMesh mesh(sequence);
  ASSERT_EQ(mesh.intervals(), 2u);
  // The first vertex is at x = -0.5: up by 0.25 k, in metres twice that.
  const auto lift = [&](double time) { return mesh.mesh_at(time).vertices[0].y() + 0.2; };
  for (const double early : {-3.0, 0.0, 0.5}) EXPECT_NEAR(lift(early), 0, 1e-15);
  EXPECT_NEAR(lift(0.55), 0.25, 1e-12);
  EXPECT_NEAR(lift(0.6), 0.5, 1e-12);
  EXPECT_NEAR(lift(0.675), 0.875, 1e-12);
  for (const double late : {0.7, 0.8, 100.0}) EXPECT_NEAR(lift(late), 1, 1e-12);
  EXPECT_FALSE(mesh.moment(0.49).moves);
  EXPECT_TRUE(mesh.moment(0.5).moves);
  EXPECT_FALSE(mesh.moment(0.71).moves);
  // 0.5 m in each tenth of a second.
  EXPECT_NEAR(mesh.fastest(), 5, 1e-9);
  EXPECT_NEAR(mesh.fastest(0.4, 0.55), 5, 1e-9) << "it starts within the step";
  EXPECT_EQ(mesh.fastest(0.1, 0.4), 0);
  EXPECT_EQ(mesh.fastest(0.71, 9), 0);
  EXPECT_NEAR(mesh.bounds().max.y(), 1 + 0.2, 1e-12);
  EXPECT_NEAR(mesh.mesh_at(0.6).volume, 2 * 0.4 * 2, 1e-12) << "a shear keeps it";
}

TEST(DeformingMesh, AnyFileThatIsWrittenAnewIsReadAnew) {
  const TemporaryFolder folder;
  const auto lifted = [](double way) {
    return test::plate_obj({1, 0.2, 1}, 1, [&](double) { return Vec3d(0, way, 0); });
  };
  const MeshSequence sequence =
      test::written_sequence(folder, "plate", 3, 10, [&](int k) { return lifted(k); });
  EXPECT_NEAR(deforming_mesh(sequence)->mesh_at(0.1).vertices[0].y(), 1 - 0.1, 1e-12);
  // A file may change in its place, as in an editor: neither its neighbours nor the folder change.
  std::ofstream(folder / "plate_0001.obj") << lifted(1.25);
  EXPECT_NEAR(deforming_mesh(sequence)->mesh_at(0.1).vertices[0].y(), 1.25 - 0.1, 1e-12);
}

TEST(DeformingMesh, WhatIsWrongWithNumberedFilesIsNamedWithFileAndLine) {
  const TemporaryFolder folder;
  const std::string box = test::box_obj({1, 1, 1});
  MeshSequence sequence = test::written_sequence(folder, "box", 12, 24, [&](int) { return box; });
  EXPECT_EQ(complaint(sequence), "");
  const auto has = [&](const std::string& text) {
    EXPECT_NE(complaint(sequence).find(text), std::string::npos) << complaint(sequence);
  };
  std::string other = box;
  other.replace(other.find("f 1 2 6 5"), 9, "f 1 2 6 7");
  folder.write("box_0004.obj", other);
  has("box_0004.obj:11: face 3 has other corners than ");
  folder.write("box_0004.obj", box + "v 0 0 0\n");
  has("box_0004.obj: the mesh has 9 vertices");
  folder.write("box_0004.obj", box.substr(0, box.rfind("f ")));
  has("box_0004.obj: the mesh has 5 faces");
  folder.write("box_0004.obj", "v nan 0 0\n" + box.substr(box.find('\n') + 1));
  has("box_0004.obj:1: ");
  folder.write("box_0004.obj", "");
  has("box_0004.obj: ");
  folder.write("box_0004.obj", test::box_obj({-1, 1, 1}));
  has("box_0004.obj: the mesh is flat or inside out");
  folder.write("box_0004.obj", test::box_obj({1e200, 1, 1}));
  has("box_0004.obj: the mesh is too large");
  folder.write("box_0004.obj", box);
  for (const int missing : {2, 3, 5, 6, 7, 9})
    std::filesystem::remove(folder / ("box_000" + std::to_string(missing) + ".obj"));
  has("box_0002.obj: no such file; missing of the numbers 0 to 11: 2, 3, 5, 6, 7 and 1 "
      "more");
  sequence.last = 0;
  has("expected 2 to 10000 files");
  sequence.last = 2000000000;
  has("expected 2 to 10000 files");
  sequence.last = 1;
  sequence.files = (folder / "box.obj").string();
  has("expected one %d, %04d, #### or $F4");
}

/// Two tetrahedra that touch with their tips in one file and are apart in the next.
TEST(DeformingMesh, WhatTouchesInOneFileIsNotGlued) {
  const TemporaryFolder folder;
  const auto tips = [](double way) {
    std::ostringstream text;
    for (const double side : {-1.0, 1.0}) {
      const double shift = side > 0 ? way : 0;
      for (const auto& [y, z] : {std::pair{-0.3, -0.3}, {0.3, -0.3}, {0.0, 0.3}})
        text << "v " << 0.5 * side + shift << ' ' << y << ' ' << z << '\n';
      text << "v " << shift << " 0 0\n";
    }
    return text.str() + "f 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 7 5 8\n";
  };
  for (const int touching : {0, 1}) {
    SCOPED_TRACE(touching);
    const MeshSequence sequence =
        test::written_sequence(folder, "tips" + std::to_string(touching), 2, 1,
                               [&](int k) { return tips(k == touching ? 0 : 1); });
    const DeformingMesh mesh(sequence);
    EXPECT_EQ(mesh.mesh_at(0).vertices.size(), 8u);
    for (const double time : {0.0, 0.5, 1.0})
      EXPECT_NEAR(mesh.mesh_at(time).volume, 2 * 0.5 * 0.6 * 0.6 / 6, 1e-12) << time;
  }
  // Vertices of every face alone, which go together, are one.
  const auto soup = [](double way) {
    std::ostringstream text;
    const double corners[4][3] = {{way, 0, 0}, {1 + way, 0, 0}, {way, 1, 0}, {way, 0, 1}};
    const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    for (const auto& face : faces)
      for (const int c : face)
        text << "v " << corners[c][0] << ' ' << corners[c][1] << ' ' << corners[c][2] << '\n';
    return text.str() + "f 1 2 3\nf 4 5 6\nf 7 8 9\nf 10 11 12\n";
  };
  const DeformingMesh mesh(
      test::written_sequence(folder, "soup", 3, 1, [&](int k) { return soup(0.5 * k); }));
  EXPECT_EQ(mesh.mesh_at(0).vertices.size(), 4u);
  EXPECT_NEAR(mesh.mesh_at(1.5).volume, 1.0 / 6, 1e-12);
}

/// One place as kernels see it.
struct Seen {
  double distance;
  Vec3d velocity;
};
Seen kernel_at(const sim::shapes::Collider& collider, const sim::shapes::DistanceSamples& samples,
               const Vec3d& x) {
  constexpr int block[3] = {0, 0, 0};
  const double h = 0.1;
  const auto c = sim::kernels::localize<double>(
      *sim::engine::kernel_pose(collider, 0.3, h, Vec3i::Zero(), samples), block, h);
  using V = Quad<double>;
  const Vec3<V> r{all<V>(x[0]), all<V>(x[1]), all<V>(x[2])};
  Vec3<V> n;
  const V d = sim::kernels::surface_distance(c, r, n);
  const Vec3<V> v = sim::kernels::surface_velocity(c, r);
  return {d[1], {v.x[1], v.y[1], v.z[1]}};
}

/// A plate 0.1 m thick that swings by five times that from file to file, on a collider that moves
/// and is turned. Distances are those of the mesh at that time, to the errors of a lattice: where
/// they are linear to rounding and the blend of two parts (half a spacing apart), elsewhere less
/// than a spacing.
TEST(DeformingField, KernelsSeeTheMeshBetweenFiles) {
  const TemporaryFolder folder;
  sim::shapes::Collider collider;
  const MeshSequence sequence = test::written_sequence(folder, "plate", 4, 10, [](int k) {
    return test::plate_obj({1, 0.1, 1}, 10, [&](double x) {
      return Vec3d(0.02 * k, 0.5 * (k % 2) + 0.3 * k * x * x, 0);
    });
  });
  collider.shape.form = sequence;
  collider.shape.rotation = {0, 20, 30};
  collider.velocity = {0.3, 0, -0.2};
  collider.angular_velocity = {0, 0.4, 0};
  ThreadPool pool(2);
  DeformingField field(sim::shapes::deforming_mesh(sequence), "plate", 0.1);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-0.7, 0.7);
  const double time = 0.3 / 10 + 0.1;  // in the second interval, and away from the ends of parts
  collider.pose_offset.delay = 0.3 - time;
  field.move_to(time, pool);
  const double spacing = field.samples().spacing;
  EXPECT_LE(spacing, 0.05);
  std::size_t inside = 0, outside = 0;
  double worst_velocity = 0;
  for (int k = 0; k < 8000; ++k) {
    const Vec3d x(unit(random), 0.4 + unit(random), unit(random));
    const sim::shapes::Surface exact = sim::shapes::surface_at(collider, 0.3, x);
    // Further away, beyond the lattice, distances are bounds.
    if (std::abs(exact.distance) > 1.5 * spacing) continue;
    const Seen seen = kernel_at(collider, field.samples(), x);
    EXPECT_NEAR(seen.distance, exact.distance, spacing) << x.transpose();
    // No hole: well inside is inside, outside is outside.
    inside += exact.distance < -0.5 * spacing && seen.distance < 0;
    EXPECT_FALSE(exact.distance < -0.5 * spacing && seen.distance >= 0) << x.transpose();
    outside += exact.distance > 0.5 * spacing && seen.distance > 0;
    EXPECT_FALSE(exact.distance > 0.5 * spacing && seen.distance <= 0) << x.transpose();
    worst_velocity = std::max(worst_velocity, (seen.velocity - exact.velocity).norm());
  }
  EXPECT_GT(inside, 50u);
  EXPECT_GT(outside, 100u);
  // Bending changes the velocity along the plate by 3 m/s per metre at its ends; the nearest places
  // of neighbouring samples are a spacing apart, and at the rim more.
  EXPECT_LT(worst_velocity, 3 * 3 * spacing);
}

TEST(DeformingField, SamplesDependOnTheTimeAloneAndOnNoThreads) {
  const TemporaryFolder folder;
  const MeshSequence sequence = test::written_sequence(folder, "plate", 4, 10, [](int k) {
    return test::plate_obj({1, 0.2, 1}, 6, [&](double x) { return Vec3d(0, 0.1 * k * x, 0); });
  });
  const auto mesh = sim::shapes::deforming_mesh(sequence);
  ThreadPool one(1), three(3);
  const auto values = [](const DeformingField& field) {
    const sim::shapes::DistanceSamples s = field.samples();
    const std::size_t count = static_cast<std::size_t>(s.size[0]) *
                              static_cast<std::size_t>(s.size[1]) *
                              static_cast<std::size_t>(s.size[2]);
    std::vector<float> all(s.distance, s.distance + count);
    if (s.velocity) all.insert(all.end(), s.velocity, s.velocity + 3 * count);
    return all;
  };
  DeformingField wandering(mesh, "plate", 0.1);
  for (const double time : {-1.0, 0.0, 0.01, 0.013, 0.08, 0.1, 0.17, 0.05, 0.299, 0.3, 5.0, 0.21}) {
    wandering.move_to(time, three);
    DeformingField fresh(mesh, "plate", 0.1);
    fresh.move_to(time, one);
    EXPECT_EQ(values(wandering), values(fresh)) << time;
    EXPECT_EQ(wandering.samples().velocity == nullptr, time < 0 || time >= 0.3) << time;
  }
  EXPECT_GT(wandering.bytes(), 1000u);
}

TEST(DeformingField, ThinAndLargeMeshesAreRefused) {
  const TemporaryFolder folder;
  const auto sequence = test::written_sequence(folder, "plate", 3, 10, [](int k) {
    return test::plate_obj({4, k == 1 ? 0.02 : 0.2, 4}, 2, still);
  });
  const auto mesh = sim::shapes::deforming_mesh(sequence);
  const auto refused = [&](double cell_size) -> std::string {
    try {
      DeformingField(mesh, "plate", cell_size);
    } catch (const sim::ShapeError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refused(0.03), "");
  EXPECT_NE(refused(0.2).find("plate_0001.obj: the mesh is about 0.0198"), std::string::npos)
      << refused(0.2);
  EXPECT_NE(refused(0.004).find("at most 128^3"), std::string::npos) << refused(0.004);
}

}  // namespace
}  // namespace neve
