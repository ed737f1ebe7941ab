/// Pictures without background: straight alpha, right at edges and where the ground fades.

#include <algorithm>
#include <set>

#include "gl_test.h"
#include "render/frame/compose.h"

namespace neve::render {
namespace {

struct Rgba {
  int r, g, b, a;
};

Rgba rgba(const Image& image, int x, int y) {
  const std::size_t at = 4 * static_cast<std::size_t>(y * image.width + x);
  return {image.pixels.at(at), image.pixels.at(at + 1), image.pixels.at(at + 2),
          image.pixels.at(at + 3)};
}

Frame transparent_ball(int supersampling) {
  Frame frame = small_frame(160, 120);
  frame.supersampling = supersampling;
  frame.is_transparent = true;
  add_ball(frame, {0, 0, 0}, 0.3f, 0.03f);
  return frame;
}

TEST(Transparent, OnlyDrawnObjectsCover) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const Image image = renderer.draw(transparent_ball(1));
  ASSERT_EQ(image.channels, 4);
  EXPECT_EQ(rgba(image, 80, 60).a, 255);
  const Rgba corner = rgba(image, 2, 2);
  EXPECT_EQ(corner.a, 0);
  EXPECT_EQ(corner.r + corner.g + corner.b, 0) << "nothing has no colour";
}

TEST(Transparent, SnowLooksAsItDoesBeforeTheGradient) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = transparent_ball(1);
  const Image alone = renderer.draw(frame);
  frame.is_transparent = false;
  const Image before = renderer.draw(frame);
  const Rgba a = rgba(alone, 80, 60);
  const Pixel b = pixel(before, 80, 60);
  // The middle has no vignette.
  EXPECT_NEAR(a.r, b.r, 1);
  EXPECT_NEAR(a.b, b.b, 1);
}

TEST(Transparent, SmoothEdgesHaveTheColourOfTheSnow) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const Image image = renderer.draw(transparent_ball(2));
  int darkest_inside = 255, darkest_edge = 255, edges = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgba p = rgba(image, x, y);
      const int brightness = (p.r + p.g + p.b) / 3;
      if (p.a == 255) darkest_inside = std::min(darkest_inside, brightness);
      if (p.a == 0 || p.a == 255) continue;
      darkest_edge = std::min(darkest_edge, brightness);
      ++edges;
    }
  EXPECT_GT(edges, 100);
  // With nothing mixed in, a pixel that is covered by a quarter would have a quarter of it.
  EXPECT_GT(darkest_edge, darkest_inside / 2);
}

TEST(Transparent, TheGroundFadesToNothing) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame(160, 120);
  frame.is_transparent = true;
  frame.camera.eye = {0, 1, 2};
  frame.grounds.push_back({.line_spacing = 10});
  const Image image = renderer.draw(frame);
  std::set<int> alphas;
  for (int y = 0; y < 60; ++y) alphas.insert(rgba(image, 80, y).a);
  EXPECT_GT(alphas.size(), 20u) << "it ends abruptly";
  EXPECT_LT(rgba(image, 80, 0).a, 30);
  EXPECT_GT(rgba(image, 80, 60).a, 200);
}

TEST(Transparent, TextAndGhostsCoverToo) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame(160, 120);
  frame.is_transparent = true;
  frame.caption = {"Snow"};
  frame.ghost_grounds.push_back({.point = {0, -0.3f, 0}});
  frame.camera.eye = {0, 0.5f, 2};
  const Image image = renderer.draw(frame);
  int text = 0;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 60; ++x) text += rgba(image, x, y).a > 128;
  EXPECT_GT(text, 20);
  const int ghost = rgba(image, 80, 90).a;
  EXPECT_GT(ghost, 10);
  EXPECT_LT(ghost, 200);
}

TEST(Transparent, PngKeepsTheAlpha) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const Image image = renderer.draw(transparent_ball(2));
  const Image again = decode_png(encode_png(image));
  EXPECT_EQ(again.channels, 4);
  EXPECT_EQ(again.pixels, image.pixels);
  EXPECT_EQ(compare(image, again).max, 0);
}

TEST(Compose, CompositionPutsTilesWhereTheyBelongAndCutsWhatIsOutside) {
  const Image red{2, 1, 3, {255, 0, 0, 255, 0, 0}};
  const Image half{1, 1, 4, {0, 200, 0, 128}};
  const Image picture = compose(3, 2, {10, 20, 30}, {{2, 0, red}, {0, 1, half}, {-5, -5, red}});
  ASSERT_EQ(picture.channels, 3);
  const auto is = [&](int x, int y, int r, int g, int b) {
    const Pixel p = pixel(picture, x, y);
    return p.r == r && p.g == g && p.b == b;
  };
  EXPECT_TRUE(is(0, 0, 10, 20, 30));
  EXPECT_TRUE(is(2, 0, 255, 0, 0));
  EXPECT_TRUE(is(0, 1, 5, 110, 15)) << "alpha shows the plain colour";
  EXPECT_TRUE(is(2, 1, 10, 20, 30));
}

TEST(DrawOver, DrawingOverChangesOnlyTheCaption) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const Image picture = compose(400, 200, {90, 20, 10}, {});
  Frame frame;
  frame.width = 400, frame.height = 200;
  EXPECT_EQ(renderer.draw_over(picture, frame).pixels, picture.pixels);
  frame.caption = {"Title", "one line that is much too long for the strip " + std::string(80, 'x')};
  frame.caption_height = 40;
  frame.font_size = 10;
  const Image image = renderer.draw_over(picture, frame);
  int above = 0, below = 0, wide = 0;
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 400; ++x) {
      const bool is_other = pixel(image, x, y).brightness() != 40;
      (y < 40 ? above : below) += is_other;
      wide += is_other && x > 300;
    }
  EXPECT_GT(above, 200);
  EXPECT_GT(wide, 20) << "the strip is the caption's alone";
  EXPECT_EQ(below, 0);
  frame.width = 399;
  EXPECT_THROW(renderer.draw_over(picture, frame), std::invalid_argument);
}

}  // namespace
}  // namespace neve::render
