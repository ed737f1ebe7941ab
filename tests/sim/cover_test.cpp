/// Snow that covers a mesh, as a roof: on the highest surface, to its depth, nowhere else.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "sim/seeding/seeding.h"
#include "sim/shapes/shape.h"
#include "sim/types/math.h"
#include "tests/support/temporary_folder.h"

namespace neve::test {
namespace {

namespace shapes = sim::shapes;

constexpr double slope = 0.7, ridge = 1, half_width = 1, chimney_top = 1.3;

/// y over z of a roof whose ridge is along x, with a chimney.
double roof(double x, double z) {
  const bool is_chimney = x > 0.5 && x < 0.7 && z > 0.25 && z < 0.55;
  return is_chimney ? chimney_top : ridge - slope * std::abs(z);
}

class Covers : public testing::Test {
 protected:
  /// The roof from x = -1 to 1, 0.2 m thick, and the chimney through it.
  Covers() {
    mesh_.file =
        folder_
            .write("roof.obj",
                   "v -1 0.3 -1\nv -1 1 0\nv -1 0.3 1\nv -1 0.1 1\nv -1 0.8 0\nv -1 0.1 -1\n"
                   "v 1 0.3 -1\nv 1 1 0\nv 1 0.3 1\nv 1 0.1 1\nv 1 0.8 0\nv 1 0.1 -1\n"
                   "v 0.5 0.3 0.25\nv 0.7 0.3 0.25\nv 0.7 0.3 0.55\nv 0.5 0.3 0.55\n"
                   "v 0.5 1.3 0.25\nv 0.7 1.3 0.25\nv 0.7 1.3 0.55\nv 0.5 1.3 0.55\n"
                   "f 1 2 3 4 5 6\nf 12 11 10 9 8 7\nf 2 1 7 8\nf 3 2 8 9\nf 4 3 9 10\n"
                   "f 5 4 10 11\nf 6 5 11 12\nf 1 6 12 7\n"
                   "f 13 14 15 16\nf 20 19 18 17\nf 13 17 18 14\nf 14 18 19 15\n"
                   "f 15 19 20 16\nf 16 20 17 13\n")
            .string();
  }

  shapes::Cover cover(double width, double length, double depth) const {
    shapes::Cover cover;
    cover.on = "roof";
    cover.ground = mesh_;
    cover.width = width;
    cover.length = length;
    cover.depth = depth;
    return cover;
  }

  TemporaryFolder folder_;
  shapes::Mesh mesh_;
};

/// The mesh stands turned and away from the origin: places are taken back to its axes.
TEST_F(Covers, SnowLiesOnTheHighestSurfaceOfAMeshToItsDepth) {
  mesh_.center = {3, 2, -1};
  const Vec3d turned(0, 25, 0);
  sim::seeding::Body body;
  shapes::Cover on_roof = cover(1.8, 1.7, 0.3);
  on_roof.turned = turned;
  on_roof.center = {3, 0, -1};
  body.shape = {on_roof, {0, 25, 0}};
  const auto seeded = sim::seeding::seed_body(body, 0, 1, 0.05);
  EXPECT_NEAR(seeded.volume, 1.8 * 1.7 * 0.3, 1e-12);
  // 8 particles to a cell; those at the surface are left to chance.
  const double expected = seeded.volume * 8 / std::pow(0.05, 3);
  EXPECT_NEAR(static_cast<double>(seeded.x.size()), expected, 0.01 * expected);
  const Mat3d back = sim::rotation_from_degrees(turned).transpose();
  double mean = 0;
  int on_chimney = 0;
  for (const Vec3d& x : seeded.x) {
    const Vec3d local = back * (x - mesh_.center);
    const double above = local.y() - roof(local.x(), local.z());
    EXPECT_GE(above, -1e-9);
    EXPECT_LE(above, 0.3 + 1e-9);
    mean += above / static_cast<double>(seeded.x.size());
    on_chimney += local.y() > chimney_top && local.x() > 0.5 && local.z() > 0.25;
  }
  // 58000 places at random in 0.3 m: 0.3 / sqrt(12 * 58000) = 0.4 mm, five of them.
  EXPECT_NEAR(mean, 0.15, 0.002);
  // 0.2 x 0.3 x 0.3 m of it, 1150 particles, and their root five times.
  EXPECT_NEAR(on_chimney, 1152, 170);
}

/// A mesh may be tilted: what is above a place is asked of it as it stands.
TEST_F(Covers, ATiltedMeshCarriesSnow) {
  shapes::Cover tilted = cover(0.6, 0.4, 0.2);
  tilted.turned = {0, 0, 20};
  tilted.center = {-0.5, 0, 0.5};
  const shapes::Bounds box = shapes::bounds({tilted, {0, 0, 0}});
  EXPECT_NEAR(shapes::volume({tilted, {0, 0, 0}}), 0.6 * 0.4 * 0.2, 1e-12);
  // The plane y = ridge - slope z, turned by 20 degrees about z: its normal was (0, 1, slope).
  const Vec3d n = sim::rotation_from_degrees(tilted.turned) * Vec3d(0, 1, slope);
  const auto height = [&](double x, double z) { return (ridge - n.x() * x - n.z() * z) / n.y(); };
  EXPECT_NEAR(box.min.y(), height(-0.8, 0.7), 1e-6);
  EXPECT_NEAR(box.max.y(), height(-0.2, 0.3) + 0.2, 1e-6);
}

TEST_F(Covers, ACoverBeyondItsMeshIsRefused) {
  try {
    shapes::volume({cover(1.8, 2.4, 0.3), {0, 0, 0}});
    ADD_FAILURE() << "made";
  } catch (const sim::ShapeError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("is not below it; it reaches from x = -1 to 1 and "
                        "from z = -1 to 1. Move it or make it smaller"),
              std::string::npos)
        << error.what();
  }
}

/// The outline of a roof itself is not beyond it.
TEST_F(Covers, ACoverAsLargeAsItsMeshIsMade) {
  EXPECT_NEAR(shapes::volume({cover(2, 2, 0.3), {0, 0, 0}}), 1.2, 1e-12);
}

}  // namespace
}  // namespace neve::test
