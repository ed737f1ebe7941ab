#include "render/frame/colormap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "render/frame/ticks.h"
#include "render/shapes/mesh_shapes.h"

namespace neve::render {
namespace {

// Colours of the published tables of 256, at entries 0, 64, 128, 255.
struct Spot {
  ColorMap map;
  Rgb8 at_0, at_64, at_128, at_255;
};

TEST(ColorMap, ColorMapAgreesWithThePublishedTables) {
  const Spot spots[] = {
      {ColorMap::viridis, {68, 1, 84}, {58, 82, 139}, {32, 144, 140}, {253, 231, 36}},
      {ColorMap::magma, {0, 0, 3}, {80, 18, 123}, {182, 54, 121}, {251, 252, 191}},
      {ColorMap::turbo, {48, 18, 59}, {40, 187, 235}, {163, 252, 60}, {122, 4, 2}},
      {ColorMap::coolwarm, {58, 76, 192}, {141, 175, 253}, {221, 220, 219}, {179, 3, 38}}};
  const auto expect_near = [](Rgb8 a, Rgb8 b, const char* name) {
    // Two steps for the coarser table, one for rounding.
    EXPECT_LE(std::abs(a.r - b.r), 3) << name;
    EXPECT_LE(std::abs(a.g - b.g), 3) << name;
    EXPECT_LE(std::abs(a.b - b.b), 3) << name;
  };
  for (const Spot& spot : spots) {
    const std::string number = std::to_string(static_cast<int>(spot.map));
    const char* name = number.c_str();
    expect_near(map_color(spot.map, 0), spot.at_0, name);
    expect_near(map_color(spot.map, 64 / 255.0f), spot.at_64, name);
    expect_near(map_color(spot.map, 128 / 255.0f), spot.at_128, name);
    expect_near(map_color(spot.map, 1), spot.at_255, name);
  }
}

TEST(ColorMap, ColorMapClampsAndMarksNan) {
  EXPECT_EQ(map_color(ColorMap::viridis, -3), map_color(ColorMap::viridis, 0));
  EXPECT_EQ(map_color(ColorMap::viridis, INFINITY), map_color(ColorMap::viridis, 1));
  EXPECT_EQ(map_value(ColorMap::viridis, 7, 7, 7), map_color(ColorMap::viridis, 0.5f));
  EXPECT_EQ(map_value(ColorMap::viridis, 3e38f, -3.4e38f, 3.4e38f).b,
            map_color(ColorMap::viridis, 0.94f).b);
  const Rgb8 marked = map_value(ColorMap::magma, NAN, 0, 1);
  EXPECT_EQ(marked, (Rgb8{255, 0, 200}));
}

std::string labels(double min, double max, int count = 5) {
  std::string out;
  for (const render::Tick& tick : render::nice_ticks(min, max, count)) out += tick.label + " ";
  return out;
}

TEST(Ticks, TicksAreRoundAndReadable) {
  EXPECT_EQ(labels(0, 4.2), "0 1 2 3 4 ");
  EXPECT_EQ(labels(0, 1), "0 0.2 0.4 0.6 0.8 1.0 ");
  EXPECT_EQ(labels(-1, 1), "-1.0 -0.5 0 0.5 1.0 ");
  EXPECT_EQ(labels(0.975, 1.0075), "0.98 0.99 1.00 ");
  EXPECT_EQ(labels(0, 1.4e6), "0 0.5e6 1.0e6 ");
}

TEST(Ticks, ExtremeRangesGiveFewDifferentLabels) {
  for (const auto& [min, max] :
       {std::pair{0.0, 1e-30}, {-3e38, 3e38}, {1e6, 1e6 + 10}, {-1e-5, 2e-5}}) {
    const std::vector<render::Tick> ticks = render::nice_ticks(min, max, 5);
    ASSERT_GE(ticks.size(), 2u) << min << " " << max;
    ASSERT_LE(ticks.size(), 7u) << min << " " << max;
    for (std::size_t i = 1; i < ticks.size(); ++i) {
      EXPECT_NE(ticks[i].label, ticks[i - 1].label);
      EXPECT_LE(ticks[i].label.size(), 10u);
    }
  }
}

TEST(Ticks, RangeWithoutWidthHasOneAndNonsenseNone) {
  EXPECT_EQ(labels(2.5, 2.5), "2.5 ");
  EXPECT_EQ(labels(3, 1), "3 ");
  EXPECT_EQ(labels(NAN, 1), "");
  EXPECT_EQ(labels(0, INFINITY), "");
}

/// Twice the vector area of a closed mesh is zero; its volume is the sum of signed tetrahedra.
float signed_volume(const TriangleMesh& mesh) {
  float six_volumes = 0;
  for (std::size_t t = 0; t < mesh.index.size(); t += 3) {
    const Vec3f a = mesh.position[mesh.index[t]], b = mesh.position[mesh.index[t + 1]],
                c = mesh.position[mesh.index[t + 2]];
    six_volumes += dot(a, cross(b, c));
  }
  return six_volumes / 6;
}

TEST(MeshShapes, ShapesEncloseTheirVolumeWithOutwardFaces) {
  EXPECT_NEAR(signed_volume(render::shapes::sphere_mesh({0, 0, 0}, 0.5f)), 4.18879f * 0.125f,
              0.003f);
  EXPECT_NEAR(signed_volume(render::shapes::box_mesh({1, 2, 3}, {1, 2, 0.5f})), 1, 1e-4f);
  const TriangleMesh turned =
      render::shapes::box_mesh({0, 0, 0}, {2, 1, 1}, {0, -1, 0, 1, 0, 0, 0, 0, 1});
  EXPECT_NEAR(signed_volume(turned), 2, 1e-4f);
  float highest = 0;
  for (const Vec3f& p : turned.position) highest = std::max(highest, p.y);
  EXPECT_NEAR(highest, 1, 1e-6f);  // the long side points up
}

}  // namespace
}  // namespace neve::render
