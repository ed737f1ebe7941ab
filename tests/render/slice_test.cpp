/// Arrows, heat maps, wires and labels. small_frame(): one unit in the plane z = 0 is as high as
/// the picture.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#include "gl_test.h"
#include "render/frame/colormap.h"

namespace neve::render {
namespace {

bool is_close(Pixel p, Rgb8 c, int tolerance) {
  return std::abs(p.r - c.r) <= tolerance && std::abs(p.g - c.g) <= tolerance &&
         std::abs(p.b - c.b) <= tolerance;
}

/// The whole picture as one map of 2x2 values.
HeatMap full_map(const std::vector<float>& values, int columns, int rows) {
  HeatMap map;
  map.corner = {-1, -0.5f, 0};
  map.across = {2, 0, 0};
  map.up = {0, 1, 0};
  map.columns = columns;
  map.rows = rows;
  map.value = values;
  return map;
}

Arrows one_arrow(Vec3f from, Vec3f vector) {
  Arrows arrows;
  arrows.position = {from};
  arrows.vector = {vector};
  arrows.length_per_value = 0.1f;
  arrows.max_length = 0.5f;
  arrows.range_max = 5;
  return arrows;
}

int count_changed(const Image& a, const Image& b, int from_x, int to_x) {
  int count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = from_x; x < to_x; ++x) {
      const Pixel p = pixel(a, x, y), q = pixel(b, x, y);
      count += p.r != q.r || p.g != q.g || p.b != q.b;
    }
  return count;
}

TEST(HeatMapPass, HeatMapPassShowsTheColoursOfTheLegend) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  for (const ColorMap colormap : {ColorMap::viridis, ColorMap::magma, ColorMap::coolwarm})
    for (const float value : {0.0f, 1.0f, 2.5f, 4.0f}) {
      Frame frame = small_frame();
      frame.heat_maps = {full_map({value, value, value, value}, 2, 2)};
      frame.heat_maps[0].colormap = colormap;
      frame.heat_maps[0].range_max = 4;
      const Image image = renderer.draw(frame);
      // The root of 8 bits that the G-buffer keeps, and dither: two or three steps of 255.
      for (const int x : {10, 60, 110})
        EXPECT_TRUE(is_close(pixel(image, x, 45), map_value(colormap, value, 0, 4), 3))
            << value << " at " << x << " of " << static_cast<int>(colormap);
    }
}

/// Rounding of a constant field fills a range of its own frame: the legend has one number, in its
/// middle.
TEST(HeatMapPass, AConstantFieldHasTheColourOfTheOnlyNumberOfItsLegend) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  for (const float rounding : {0.0f, 1.2e-7f, 3.6e-7f}) {
    Frame frame = small_frame();
    const float high = 1 + rounding;
    frame.heat_maps = {full_map({1, high, high, 1}, 2, 2)};
    frame.heat_maps[0].range_min = 1;
    frame.heat_maps[0].range_max = high;
    const Image image = renderer.draw(frame);
    for (const int x : {10, 60, 110})
      EXPECT_TRUE(is_close(pixel(image, x, 45), map_color(ColorMap::viridis, 0.5f), 3)) << rounding;
  }
}

TEST(HeatMapPass, NodesWithoutAValueAreHolesInTheHeatMap) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const float none = std::numeric_limits<float>::quiet_NaN();
  Frame frame = small_frame();
  const Image background = renderer.draw(frame);
  frame.heat_maps = {full_map({none, 1, none, 1}, 2, 2)};
  const Image image = renderer.draw(frame);
  // The map is 2 wide and the picture 4/3: its left half is the picture's, up to the middle.
  EXPECT_EQ(count_changed(background, image, 0, 50), 0);
  EXPECT_EQ(count_changed(background, image, 70, 120), 50 * 90);
  // The last value with a neighbour that is none keeps its own value: no mixing with zero.
  EXPECT_TRUE(is_close(pixel(image, 66, 45), map_color(ColorMap::viridis, 1), 3));
}

TEST(HeatMapPass, IsolinesLieOnTheirValues) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame(480, 360);
  std::vector<float> ramp;
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 64; ++column)
      ramp.push_back((static_cast<float>(column) + 0.5f) / 64);
  frame.heat_maps = {full_map(ramp, 64, 2)};
  const Image plain = renderer.draw(frame);
  frame.heat_maps[0].isoline_step = 0.25f;
  const Image lined = renderer.draw(frame);
  // 360 pixels are one unit; value 0 is at x = -1, 1 at x = 1; the middle is at pixel 240.
  for (const float value : {0.25f, 0.5f, 0.75f}) {
    const int x = static_cast<int>(240 + 360 * (2 * value - 1));
    EXPECT_GT(count_changed(plain, lined, x - 2, x + 2), 360) << value;
    EXPECT_EQ(count_changed(plain, lined, x + 8, x + 60), 0) << value;
  }
}

/// Snow at rest has one value all over, often that of a line.
TEST(HeatMapPass, AConstantFieldHasNoIsolines) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame();
  frame.heat_maps = {full_map({0.5f, 0.5f, 0.5f, 0.5f}, 2, 2)};
  const Image plain = renderer.draw(frame);
  frame.heat_maps[0].isoline_step = 0.25f;
  EXPECT_EQ(count_changed(plain, renderer.draw(frame), 0, 120), 0);
  // A field that hardly changes over the picture has its line.
  frame.heat_maps[0].value = {0.49f, 0.51f, 0.49f, 0.51f};
  frame.heat_maps[0].isoline_step = 0;
  const Image slope = renderer.draw(frame);
  frame.heat_maps[0].isoline_step = 0.25f;
  EXPECT_GT(count_changed(slope, renderer.draw(frame), 55, 65), 90);
}

TEST(ArrowPass, PointsWhereItsVectorDoesAndIsAsLong) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame(480, 360);
  const Image nothing = renderer.draw(frame);
  frame.arrows = {one_arrow({0, 0, 0}, {4, 0, 0})};
  const Image image = renderer.draw(frame);
  // 0.4 m of arrow are 144 pixels, from the middle to the right; its dark rim is 6 wide at the tail
  // and twice that before the tip.
  EXPECT_EQ(count_changed(nothing, image, 0, 232), 0);
  EXPECT_GT(count_changed(nothing, image, 375, 384), 0);
  EXPECT_EQ(count_changed(nothing, image, 398, 480), 0);
  const Pixel tail = pixel(image, 236, 180);
  EXPECT_LT(tail.g, 40);
  // The head is wider than the shaft.
  EXPECT_GT(2 * count_changed(nothing, image, 335, 345),
            3 * count_changed(nothing, image, 280, 290));
  // Magnitude 4 of 5 on the map, at most 28 % darker where the surface turns away.
  const Rgb8 full = map_value(ColorMap::viridis, 4, 0, 5);
  const Pixel shaft = pixel(image, 290, 180);
  EXPECT_LE(shaft.g, full.g + 3);
  EXPECT_GE(shaft.g, full.g * 6 / 10);
}

TEST(ArrowPass, LongVectorsAreCutAndBrokenOnesLeftOut) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame(480, 360);
  const Image nothing = renderer.draw(frame);
  frame.arrows = {one_arrow({0, 0, 0}, {400, 0, 0})};
  EXPECT_EQ(count_changed(nothing, renderer.draw(frame), 434, 480),
            0);  // 0.5 m are 180 pixels, with the rim 193
  for (const Vec3f bad : {Vec3f{0, 0, 0}, Vec3f{std::nanf(""), 0, 0},
                          Vec3f{std::numeric_limits<float>::infinity(), 0, 0}}) {
    frame.arrows = {one_arrow({0, 0, 0}, bad)};
    EXPECT_EQ(count_changed(nothing, renderer.draw(frame), 0, 480), 0);
  }
}

TEST(HeatMapPass, ACoverIsShownFromAHalfOn) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame();
  const Image background = renderer.draw(frame);
  frame.heat_maps = {full_map({1, 1, 1, 1}, 2, 2)};
  frame.heat_maps[0].cover = {1, 0.2f, 1, 0.2f};
  const Image image = renderer.draw(frame);
  // The cover falls from 1 in the middle of the left half to 0.2 in that of the right one: it is a
  // half at 62.5 % of the way from pixel 15 (x = -0.5 of 90 pixels a unit) to pixel 105.
  EXPECT_EQ(count_changed(background, image, 0, 70), 70 * 90);
  EXPECT_EQ(count_changed(background, image, 73, 120), 0);
  EXPECT_TRUE(is_close(pixel(image, 68, 45), map_color(ColorMap::viridis, 1), 3));
  frame.heat_maps[0].cover = {1};
  EXPECT_THROW(renderer.draw(frame), std::invalid_argument);
}

TEST(ArrowPass, ACentredArrowHasItsPlaceInItsMiddleAndIsBeforeTheMapItLiesOn) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame(480, 360);
  frame.heat_maps = {full_map({0, 0, 0, 0}, 2, 2)};
  const Image map = renderer.draw(frame);
  frame.arrows = {one_arrow({0, 0, 0}, {4, 0, 0})};
  frame.arrows[0].is_centred = true;
  const Image image = renderer.draw(frame);
  // 0.4 m are 144 pixels, half of them to each side; the rim adds 1.5 to 3 %.
  EXPECT_EQ(count_changed(map, image, 0, 160), 0);
  EXPECT_GT(count_changed(map, image, 165, 175), 0);
  EXPECT_GT(count_changed(map, image, 302, 314), 0);
  EXPECT_EQ(count_changed(map, image, 332, 480), 0);
}

TEST(LinePass, LinesWithValuesHaveTheColoursOfTheLegend) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame(480, 360);
  Lines lines;
  lines.ends = {{-0.5f, 0.2f, 0}, {0.5f, 0.2f, 0}, {-0.5f, -0.2f, 0}, {0.5f, -0.2f, 0}};
  lines.value = {1, 4};
  lines.range_max = 4;
  lines.width = 6;
  frame.lines = {lines};
  const Image image = renderer.draw(frame);
  // 0.2 units are 72 pixels from the middle row.
  EXPECT_TRUE(is_close(pixel(image, 240, 108), map_value(ColorMap::viridis, 1, 0, 4), 3));
  EXPECT_TRUE(is_close(pixel(image, 240, 252), map_value(ColorMap::viridis, 4, 0, 4), 3));
  frame.lines[0].value = {1};
  EXPECT_THROW(renderer.draw(frame), std::invalid_argument);
}

TEST(ScaleBarOverlay, IsAsLongAsAskedForAndStandsAboveTheFootnote) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame(480, 360);
  const Image nothing = renderer.draw(frame);
  frame.scale_bar = ScaleBar{120, "20 cm"};
  const Image image = renderer.draw(frame);
  int first = 480, last = 0;
  for (int x = 0; x < 480; ++x)
    if (count_changed(nothing, image, x, x + 1) > 0) first = std::min(first, x), last = x;
  EXPECT_NEAR(last - first, 120, 6);  // with its dark rim
  frame.scale_bar->pixels = 4000;     // wider than the picture: none
  EXPECT_EQ(count_changed(nothing, renderer.draw(frame), 0, 480), 0);
}

TEST(LinePass, LinesAreHiddenByWhatIsBefore) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame();
  add_ball(frame, {0.3f, 0, 0}, 0.25f, 0.05f);
  const Image ball = renderer.draw(frame);
  Lines lines;
  lines.ends = {{-0.6f, 0, -0.4f}, {0.6f, 0, -0.4f}};
  lines.color = {1, 0, 0};
  frame.lines = {lines};
  const Image behind = renderer.draw(frame);
  EXPECT_GT(count_changed(ball, behind, 10, 50), 30);
  EXPECT_EQ(count_changed(ball, behind, 78, 96), 0);
  frame.lines[0].ends = {{-0.5f, 0, 0.4f}, {0.5f, 0, 0.4f}};
  EXPECT_GT(count_changed(ball, renderer.draw(frame), 78, 96), 15);
}

TEST(LinePass, ALineThroughTheEyeIsCutNotWrapped) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame();
  const Image nothing = renderer.draw(frame);
  Lines lines;
  lines.ends = {{0.2f, 0.1f, 0}, {0.2f, 0.1f, 8}};  // runs past the eye to behind it
  frame.lines = {lines};
  const Image image = renderer.draw(frame);
  EXPECT_GT(count_changed(nothing, image, 60, 120), 10);
  EXPECT_EQ(count_changed(nothing, image, 0, 60), 0);
  frame.lines[0].ends = {{0, 0, 3}, {0, 0, 8}};
  EXPECT_EQ(count_changed(nothing, renderer.draw(frame), 0, 120), 0);
}

TEST(Labels, LabelsAreAtTheirPointsUnlessBehindTheEye) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame(480, 360);
  const Image nothing = renderer.draw(frame);
  frame.labels = {{{0.2f, 0.1f, 0}, "ball"}};
  const Image image = renderer.draw(frame);
  EXPECT_GT(count_changed(nothing, image, 310, 345), 20);
  EXPECT_EQ(count_changed(nothing, image, 0, 305), 0);
  frame.labels[0].position = {0, 0, 5};
  EXPECT_EQ(count_changed(nothing, renderer.draw(frame), 0, 480), 0);
}

TEST(SliceFrame, LengthsThatDisagreeAreErrors) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame();
  frame.arrows = {one_arrow({0, 0, 0}, {1, 0, 0})};
  frame.arrows[0].vector.edit().clear();
  EXPECT_THROW(renderer.draw(frame), std::invalid_argument);
  frame = small_frame();
  frame.heat_maps = {full_map({1, 2, 3}, 2, 2)};
  EXPECT_THROW(renderer.draw(frame), std::invalid_argument);
}

}  // namespace
}  // namespace neve::render
