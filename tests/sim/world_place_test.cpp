/// Meshes and points with the coordinates of a map.

#include <gtest/gtest.h>

#include <array>

#include "sim/shapes/placed_points.h"
#include "sim/shapes/solid.h"
#include "sim/shapes/world_place.h"
#include "tests/support/temporary_folder.h"

namespace neve::test {
namespace {

using sim::Vec3d;
namespace shapes = sim::shapes;

/// Returns a cube with an edge of 1 m, whose lower corner is so far east, north and up.
std::string cube_obj(double east, double north, double up) {
  std::string text;
  for (int k = 0; k < 8; ++k) {
    const std::array<double, 3> x{east + (k & 1), north + (k >> 1 & 1), up + (k >> 2)};
    text += "v";
    for (const double c : x) text += " " + std::to_string(c);
    text += "\n";
  }
  return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

/// East stays x, north becomes -z, up becomes y.
shapes::Shape of_map(const std::string& file) {
  shapes::Mesh mesh{file};
  mesh.coordinates = shapes::Coordinates::world;
  return {mesh, {-90, 0, 0}};
}

class WorldPlace : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    return folder_.write(name, text).string();
  }
  TemporaryFolder folder_;
};

TEST_F(WorldPlace, OneOffsetIsTakenOutOfAllFiles) {
  shapes::Shape a = of_map(write("a.obj", cube_obj(431250.25, 5254000, 1800)));
  shapes::Shape b = of_map(write("b.obj", cube_obj(431260.25, 5254003, 1802)));
  shapes::place_in_world({&a, &b});
  const shapes::Bounds box_a = shapes::bounds(a), box_b = shapes::bounds(b);
  // Doubles hold 5e6 m to 1e-9 m.
  EXPECT_NEAR((box_b.min - box_a.min - Vec3d(10, 2, -3)).norm(), 0, 1e-8);
  EXPECT_LT(box_a.max.norm(), 2);
  EXPECT_NEAR(shapes::volume(a), 1, 1e-8);
  const Vec3d offset = *shapes::world_offset({&a});
  EXPECT_NEAR((offset + box_a.min - Vec3d(431250.25, 1800, -5254001)).norm(), 0, 1e-8);
  EXPECT_EQ(*shapes::world_offset({&b}), *shapes::world_offset({&b, &a}));
}

TEST_F(WorldPlace, APlaceThatIsGivenStays) {
  shapes::Shape a = of_map(write("a.obj", cube_obj(431250, 5254000, 1800)));
  std::get<shapes::Mesh>(a.form).origin = {431000, 5254000, 0};
  shapes::place_in_world({&a});
  EXPECT_NEAR((shapes::bounds(a).min - Vec3d(250, 1800, -1)).norm(), 0, 1e-8);
}

TEST_F(WorldPlace, PointsLieBesideMeshes) {
  shapes::Shape a = of_map(write("a.obj", cube_obj(431250, 5254000, 1800)));
  shapes::Points points{.file = write("p.csv", "x,y,z\n431252.5,5254000,1801\n"), .spacing = 0.1};
  points.coordinates = shapes::Coordinates::world;
  shapes::Shape p{points, {-90, 0, 0}};
  shapes::place_in_world({&a, &p});
  const auto placed = shapes::PlacedPoints(std::get<shapes::Points>(p.form));
  const Vec3d x = sim::rotation_from_degrees(p.rotation) * placed.x.front();
  EXPECT_NEAR((x - shapes::bounds(a).min - Vec3d(2.5, 1, 1)).norm(), 0, 1e-8);
}

TEST_F(WorldPlace, PointsFarAwayAreRefusedWithTheRemedy) {
  const shapes::Points points{.file = write("p.csv", "x,y,z\n431252,5254000,1801\n"),
                              .spacing = 0.1};
  try {
    const shapes::PlacedPoints placed(points);
    FAIL() << "not refused";
  } catch (const sim::ShapeError& error) {
    EXPECT_NE(std::string(error.what()).find("coordinates = \"world\""), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace neve::test
