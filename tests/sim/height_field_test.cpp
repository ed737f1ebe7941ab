/// Terrain as a collider and the snow on it: exact surface, kernels, volume, mass, coordinates.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "sim/seeding/seeding.h"
#include "sim/shapes/collider.h"
#include "sim/shapes/height_field.h"
#include "sim/shapes/world_place.h"
#include "sim/simulation.h"
#include "sim/state/kernel_pose.h"
#include "tests/support/height_files.h"
#include "tests/support/out_of_reach.h"
#include "tests/support/snow.h"
#include "tests/support/temporary_folder.h"

namespace neve::test {
namespace {

namespace shapes = sim::shapes;
using shapes::Terrain;

double hills(double x, double z) {
  return 2 * std::sin(0.9 * x) + 1.5 * std::cos(0.7 * z + 0.4 * x) - 0.3 * x;
}

class HeightFields : public testing::Test {
 protected:
  Terrain write(const std::string& text) {
    return {.file = folder_.write("grid_" + std::to_string(++count_) + ".asc", text).string()};
  }
  Terrain hilly() { return write(height_grid(17, 13, 0.5, hills)); }

  TemporaryFolder folder_;
  int count_ = 0;
};

shapes::Collider ground_of(const Terrain& terrain, const Vec3d& rotation = {0, 0, 0}) {
  shapes::Collider c;
  c.name = "ground";
  c.shape = {terrain, rotation};
  return c;
}

TEST_F(HeightFields, SurfaceGoesThroughItsPostsAndItsNormalIsExact) {
  const auto field = shapes::height_field(hilly());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < 500; ++k) {
    const int c = static_cast<int>(16 * unit(random)), r = static_cast<int>(12 * unit(random));
    // Nine digits in the file.
    EXPECT_NEAR(field->at(0.5 * c, 0.5 * r)->height, hills(0.5 * c, 0.5 * r), 1e-6);
    // These places are inside a cell, where the surface is smooth.
    const double x = 0.5 * (c + 0.1 + 0.8 * unit(random)), z = 0.5 * (r + 0.1 + 0.8 * unit(random));
    const auto place = field->at(x, z);
    constexpr double e = 1e-3;  // the surface is quadratic: differences are exact but for rounding
    const double along_x = (field->at(x + e, z)->height - field->at(x - e, z)->height) / (2 * e),
                 along_z = (field->at(x, z + e)->height - field->at(x, z - e)->height) / (2 * e);
    EXPECT_LT((place->normal - Vec3d(-along_x, 1, -along_z).normalized()).norm(), 1e-10);
  }
}

TEST_F(HeightFields, GroundContinuesLevelBeyondItsPosts) {
  const auto field = shapes::height_field(hilly());
  EXPECT_DOUBLE_EQ(field->at(-300, 2.2)->height, field->at(0, 2.2)->height);
  EXPECT_EQ(field->at(-300, 2.2)->normal.x(), 0);
  EXPECT_DOUBLE_EQ(field->at(500, 700)->height, field->at(8, 6)->height);
  EXPECT_EQ(field->at(500, 700)->normal, Vec3d(0, 1, 0));
}

TEST_F(HeightFields, CellsAtAPostWithoutDataAreHoles) {
  const auto field = shapes::height_field(write(
      height_grid(5, 5, 1, [](double x, double z) { return x == 2 && z == 2 ? -9999 : 1.0; })));
  EXPECT_FALSE(field->at(1.5, 1.5));
  EXPECT_FALSE(field->at(2.5, 2.5));
  EXPECT_TRUE(field->at(0.5, 0.5));
  EXPECT_EQ(field->distance({1.5, -5, 1.5}), shapes::no_ground);
  EXPECT_LT(field->distance({0.5, -5, 0.5}), 0);
}

struct GroundSeen {
  double distance;
  Vec3d normal;
};

constexpr double kernel_cell = 0.1;

/// Returns the ground that the kernels of a precision see from a place, from a block around it.
template <class Real>
GroundSeen seen_from_block(const sim::kernels::ColliderPose& pose, const Vec3d& x) {
  using V = Quad<Real>;
  const sim::Vec3i first = 4 * (x / (4 * kernel_cell)).array().floor().cast<int>();
  const sim::kernels::LocalCollider<Real> local =
      sim::kernels::localize<Real>(pose, first.data(), kernel_cell);
  const Vec3d from = x - kernel_cell * first.cast<double>();
  Vec3<V> normal;
  const V distance = sim::kernels::surface_distance(
      local,
      Vec3<V>{all<V>(static_cast<Real>(from[0])), all<V>(static_cast<Real>(from[1])),
              all<V>(static_cast<Real>(from[2]))},
      normal);
  return {static_cast<double>(distance[1]),
          Vec3d(static_cast<double>(normal.x[1]), static_cast<double>(normal.y[1]),
                static_cast<double>(normal.z[1]))};
}

TEST_F(HeightFields, KernelsSeeTheSurfaceOfTheHost) {
  for (const Vec3d& rotation : {Vec3d(0, 0, 0), Vec3d(12, -35, 20)}) {
    Terrain terrain = hilly();
    terrain.center = {-3, 0.5, -2};
    const shapes::Collider c = ground_of(terrain, rotation);
    const auto field = shapes::height_field(terrain);
    const auto pose =
        sim::engine::kernel_pose(c, 0, kernel_cell, sim::Vec3i::Zero(), {}, field->samples());
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    int inside = 0;
    for (int k = 0; k < 4000; ++k) {
      const Vec3d x(9 * unit(random), 5 * unit(random), 8 * unit(random));
      const shapes::Surface host = shapes::surface_at(c, 0, x);
      const GroundSeen lane = seen_from_block<double>(*pose, x);
      EXPECT_NEAR(lane.distance, host.distance, 1e-11);
      EXPECT_LT((lane.normal - host.normal).norm(), 1e-10);
      // Numbers are within 20 m of the block.
      EXPECT_NEAR(seen_from_block<float>(*pose, x).distance, host.distance, 2e-5);
      inside += host.distance < 0;
    }
    EXPECT_GT(inside, 500);
  }
}

/// Two kilometres from its first post, single precision alone would be 0.1 mm apart and the slope
/// of the last cell 1 % off.
TEST_F(HeightFields, KernelsAreAsExactFarFromTheFirstPost) {
  const Terrain terrain =
      write(height_grid(2001, 3, 1, [](double x, double z) { return 700 + 0.4 * x + 0.1 * z; }));
  const shapes::Collider c = ground_of(terrain);
  const auto field = shapes::height_field(terrain);
  const auto pose =
      sim::engine::kernel_pose(c, 0, kernel_cell, sim::Vec3i::Zero(), {}, field->samples());
  for (const double x : {0.3, 1000.7, 1999.9}) {
    const Vec3d place(x, 700 + 0.4 * x + 0.05 + 0.02, 0.5);
    // Heights are kept within 400 m of their middle: 3e-5 m apart, and 1e-5 m at random.
    EXPECT_NEAR(seen_from_block<float>(*pose, place).distance, 0.02 / std::sqrt(1 + 0.17), 3e-5);
    EXPECT_LT(
        (seen_from_block<float>(*pose, place).normal - Vec3d(-0.4, 1, -0.1).normalized()).norm(),
        1e-4);
  }
}

TEST_F(HeightFields, NothingWithinReachIsLeftOut) {
  const Terrain terrain = hilly();
  const shapes::Collider c = ground_of(terrain, {5, 20, -10});
  const auto pose = sim::engine::kernel_pose(c, 0, kernel_cell, sim::Vec3i::Zero(), {},
                                             shapes::height_field(terrain)->samples());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  const int block_0[3] = {0, 0, 0};
  const auto local = sim::kernels::localize<float>(*pose, block_0, kernel_cell);
  int left_out = 0;
  for (int k = 0; k < 4000; ++k) {
    const Vec3d centre(4 + 6 * unit(random), 4 * unit(random), 3 + 5 * unit(random));
    const double reach = 0.3 + 0.3 * unit(random);
    left_out += is_left_out(local, centre, reach, 1e-4, random, [&](const Vec3d& way) {
      return shapes::signed_distance(c, 0, centre + way);
    });
  }
  EXPECT_GT(left_out, 200);
}

/// A slope of posts is the same ground as a plane: the snow of two runs stays together.
TEST_F(HeightFields, SnowSlidesOnAnEvenTerrainAsOnAPlane) {
  const Terrain terrain =
      write(height_grid(9, 9, 0.25, [](double x, double) { return 1 - 0.6 * (x - 1); }));
  shapes::Collider ground = ground_of(terrain), plane = ground;
  ground.friction = plane.friction = 0.3;
  plane.shape.form = shapes::Plane{{1, 1, 0}, {0.6, 1, 0}};
  const ParticleArrays snow = box_of_snow({0.5, 1.35, 0.8}, {0.8, 1.5, 1.1}, 0.02);
  sim::SolverSettings s;
  s.cell_size = 0.04;
  sim::Simulation on_ground(s, {sim::Material{}}, {ground}, snow, 1);
  sim::Simulation on_plane(s, {sim::Material{}}, {plane}, snow, 1);
  on_ground.advance_to(0.1);
  on_plane.advance_to(0.1);
  const ParticleArrays a = on_ground.particles(), b = on_plane.particles();
  ASSERT_EQ(a.x.size(), b.x.size());
  Vec3d mean_a(0, 0, 0), mean_b(0, 0, 0);
  for (std::size_t p = 0; p < a.x.size(); ++p) mean_a += a.x[p], mean_b += b.x[p];
  mean_a /= static_cast<double>(a.x.size());
  mean_b /= static_cast<double>(a.x.size());
  // Heights in single precision are 1e-7 m off; impact multiplies rounding.
  EXPECT_LT((mean_a - mean_b).norm(), 1e-4);
  Vec3d start(0, 0, 0);
  for (const Vec3d& x : snow.x) start += x;
  EXPECT_GT((mean_a - start / static_cast<double>(snow.x.size())).norm(), 0.02);
}

shapes::Cover cover_of(const Terrain& terrain) {
  shapes::Cover cover;
  cover.on = "ground";
  cover.ground = terrain;
  cover.center = {4, 0, 3};
  return cover;
}

TEST_F(HeightFields, VolumeOfACoverIsItsAreaTimesItsDepth) {
  shapes::Cover rectangle = cover_of(hilly());
  rectangle.depth = 0.4;
  rectangle.width = 3;
  rectangle.length = 2;
  EXPECT_NEAR(shapes::volume({rectangle, {0, 30, 0}}), 0.4 * 3 * 2, 1e-12);
  shapes::Cover disc = cover_of(hilly());
  disc.depth = 0.4;
  disc.radius = 1.5;
  EXPECT_NEAR(shapes::volume({disc, {0, 0, 0}}), 0.4 * std::numbers::pi * 1.5 * 1.5, 1e-12);
}

/// Jittered snow has a particle in every sub-cell that is wholly inside; those at the surface are
/// left to chance, a few per mille of them.
TEST_F(HeightFields, SeedingFillsACoverFromTheGroundToItsDepth) {
  for (const auto sampling : {sim::seeding::Sampling::jittered, sim::seeding::Sampling::poisson}) {
    sim::seeding::Body body;
    shapes::Cover cover = cover_of(hilly());
    cover.depth = 0.5;
    cover.width = 3;
    cover.length = 2.5;
    cover.center.y() = 0.25;
    body.shape = {cover, {0, 25, 0}};
    body.sampling = sampling;
    const auto seeded = sim::seeding::seed_body(body, 0, 1, 0.1);
    EXPECT_NEAR(seeded.volume, 0.5 * 3 * 2.5, 1e-12);
    const double expected = seeded.volume * 8 / 0.001;
    EXPECT_NEAR(static_cast<double>(seeded.x.size()), expected, 0.01 * expected);
    const auto field = shapes::height_field(std::get<Terrain>(cover.ground));
    double mean = 0;
    for (const Vec3d& x : seeded.x) {
      const double above = x.y() - 0.25 - field->at(x.x(), x.z())->height;
      EXPECT_GE(above, -1e-9);
      EXPECT_LE(above, 0.5 + 1e-9);
      mean += above / static_cast<double>(seeded.x.size());
    }
    // 30000 places at random in 0.5 m: 0.5 / sqrt(12 * 30000) = 0.8 mm, five of them.
    EXPECT_NEAR(mean, 0.25, 0.004);
  }
}

TEST_F(HeightFields, ACoverOverAHoleOrBeyondThePostsIsRefused) {
  const auto refusal = [](const shapes::Cover& cover) {
    try {
      shapes::volume({cover, {0, 0, 0}});
    } catch (const sim::ShapeError& error) {
      return std::string(error.what());
    }
    return std::string("made");
  };
  shapes::Cover cover = cover_of(write(
      height_grid(9, 7, 1, [](double x, double z) { return x == 7 && z == 5 ? -9999 : 1.0; })));
  cover.depth = 1;
  cover.width = cover.length = 4;
  EXPECT_EQ(refusal(cover), "made");
  cover.width = 5;
  cover.length = 5;
  EXPECT_NE(refusal(cover).find("some have no data"), std::string::npos) << refusal(cover);
  cover.width = 9;
  cover.length = 2;
  EXPECT_NE(refusal(cover).find("its posts are at x = 0 to 8"), std::string::npos)
      << refusal(cover);
  cover.width = cover.length = 0;
  cover.radius = 2.2;  // less than the 2.24 m to the cell of the post without data
  EXPECT_EQ(refusal(cover), "made");
}

TEST_F(HeightFields, TheOffsetOfAMapIsTakenOutOfTerrain) {
  std::string text = height_grid(5, 5, 10, [](double x, double) { return 2000 + x; });
  text.replace(text.find("xllcenter 0"), 11, "xllcenter 431250.5");
  Terrain terrain = write(text);
  terrain.coordinates = shapes::Coordinates::world;
  shapes::Shape shape{terrain, {0, 0, 0}};
  EXPECT_TRUE(shapes::needs_place(shape));
  shapes::place_in_world({&shape});
  const shapes::Bounds box = shapes::bounds(shape);
  EXPECT_LT(box.max.cwiseAbs().maxCoeff(), 31);
  const Vec3d offset = *shapes::world_offset({&shape});
  // x is east, z is south, y is up.
  EXPECT_NEAR((offset + box.max - Vec3d(431290.5, 2040, 40)).norm(), 0, 1e-6);
  EXPECT_NEAR(std::get<Terrain>(shape.form).origin.y(), -20, 1e-9);
}

TEST_F(HeightFields, TrianglesLieOnTheSurface) {
  const auto field = shapes::height_field(hilly());
  const auto all = [](std::size_t count) { return shapes::drawn_posts(count, 0, 1, 100); };
  const shapes::HeightTriangles mesh = shapes::triangles_of(*field, all(17), all(13));
  std::size_t on_surface = 0;
  for (std::size_t k = 0; k < mesh.position.size(); ++k) {
    if (mesh.normal[k].y() < 0.1) continue;  // sides and bottom
    const auto place = field->at(mesh.position[k].x(), mesh.position[k].z());
    EXPECT_NEAR(place->height, mesh.position[k].y(), 1e-9);
    ++on_surface;
  }
  EXPECT_EQ(on_surface, 16u * 12 * 5);
}

TEST(DrawnPosts, AreDenseWhereTheSnowIsAndReachTheBorders) {
  const std::vector<std::size_t> posts = shapes::drawn_posts(2000, 700, 780, 257);
  EXPECT_LE(posts.size(), 257u);
  EXPECT_EQ(posts.front(), 0u);
  EXPECT_EQ(posts.back(), 1999u);
  for (std::size_t k = 1; k < posts.size(); ++k) {
    EXPECT_LT(posts[k - 1], posts[k]);
    if (posts[k - 1] >= 700 && posts[k] <= 780) {
      EXPECT_EQ(posts[k] - posts[k - 1], 1u);
    }
  }
  EXPECT_LE(shapes::drawn_posts(100000, 0, 99999, 257).size(), 257u);
}

}  // namespace
}  // namespace neve::test
