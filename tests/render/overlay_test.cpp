#include <algorithm>
#include <cmath>

#include "gl_test.h"
#include "render/frame/colormap.h"
#include "render/frame/view.h"

namespace neve::render {
namespace {

/// Largest box that contains everything that differs, by more than the noise of the picture: there
/// is none, drawing is deterministic.
struct Changed {
  int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1, count = 0;
};

Changed changed(const Image& a, const Image& b) {
  Changed c;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const Pixel p = pixel(a, x, y), q = pixel(b, x, y);
      if (p.r == q.r && p.g == q.g && p.b == q.b) continue;
      c.left = std::min(c.left, x);
      c.right = std::max(c.right, x);
      c.top = std::min(c.top, y);
      c.bottom = std::max(c.bottom, y);
      ++c.count;
    }
  }
  return c;
}

Image draw_caption(Renderer& renderer, const std::string& text, int width = 480, int height = 270) {
  Frame frame = small_frame(width, height);
  if (!text.empty()) frame.caption = {text};
  return renderer.draw(frame);
}

TEST(Caption, CaptionIsDrawnWithItsAccents) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const Image nothing = draw_caption(renderer, "");
  const Image with = draw_caption(renderer, "Boule de névé");
  const Image without = draw_caption(renderer, "Boule de neve");
  EXPECT_GT(changed(nothing, with).count, 150);
  const Changed accents = changed(with, without);
  EXPECT_GT(accents.count, 2);
  EXPECT_LT(accents.count, changed(nothing, with).count / 2);
}

TEST(Caption, CaptionDrawsScriptsBeyondLatin) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  // Different letters that would all be the same box if the font lacked them.
  const Image greek = draw_caption(renderer, "αβγ"), other = draw_caption(renderer, "δεζ");
  const Image cyrillic = draw_caption(renderer, "снег"), symbols = draw_caption(renderer, "∇≤→");
  EXPECT_GT(changed(greek, other).count, 10);
  EXPECT_GT(changed(cyrillic, draw_caption(renderer, "лёд?")).count, 10);
  EXPECT_GT(changed(symbols, draw_caption(renderer, "∂≥←")).count, 10);
}

TEST(Caption, CaptionStaysInsideThePictureAndOffTheLegend) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const std::string long_word(400, 'W');
  for (const auto& [width, height] : {std::pair{320, 180}, {1280, 720}, {400, 800}}) {
    Frame frame = small_frame(width, height);
    const Image nothing = renderer.draw(frame);
    frame.caption = {long_word, "many words " + long_word + " and more of them, again and again"};
    const Changed caption = changed(nothing, renderer.draw(frame));
    frame.caption.clear();
    frame.legends.push_back({.title = "von Mises stress", .unit = "Pa", .min = 0, .max = 1e6f});
    const Changed legend = changed(nothing, renderer.draw(frame));
    ASSERT_GT(caption.count, 100) << width;
    ASSERT_GT(legend.count, 100) << width;
    EXPECT_LT(caption.right, width - 1) << width;
    EXPECT_LT(legend.right, width - 1) << width;
    EXPECT_LT(legend.bottom, height - 1) << width;
    EXPECT_TRUE(caption.right < legend.left || caption.bottom < legend.top) << width;
  }
}

TEST(Caption, CaptionGrowsWithThePicture) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const auto height_of = [&](int width, int height) {
    const Changed c = changed(draw_caption(renderer, "", width, height),
                              draw_caption(renderer, "Hxh", width, height));
    return static_cast<double>(c.bottom - c.top + 1);
  };
  const double at_720 = height_of(1280, 720);
  EXPECT_NEAR(height_of(2560, 1440) / at_720, 2, 0.2);
  EXPECT_GE(height_of(320, 180), 7);  // still to be read
}

TEST(Caption, OddTextIsHarmless) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  for (const char* text : {"", " ", "%s %n %d", "\xff\xfe broken", "a\tb\nc", "\xf0\x9f\x8f\x94"})
    EXPECT_NO_THROW(draw_caption(renderer, text)) << text;
  EXPECT_NO_THROW(draw_caption(renderer, "tiny", 8, 8));
}

TEST(Legend, LegendShowsTheColoursOfTheMap) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame(640, 360);
  const Image nothing = renderer.draw(frame);
  frame.legends.push_back({.title = "v", .unit = "", .colormap = ColorMap::turbo});
  const Image image = renderer.draw(frame);
  // The top of the bar is the end of the map; text is grey, so pure colours are the bar.
  for (const float t : {0.05f, 0.5f, 0.95f}) {
    const Rgb8 c = map_color(ColorMap::turbo, t);
    bool is_found = false;
    for (int y = 0; y < image.height && !is_found; ++y) {
      for (int x = 320; x < image.width && !is_found; ++x) {
        const Pixel p = pixel(image, x, y);
        is_found = std::abs(p.r - c.r) + std::abs(p.g - c.g) + std::abs(p.b - c.b) < 12;
      }
    }
    EXPECT_TRUE(is_found) << t;
  }
  EXPECT_GT(changed(nothing, image).left, 320);
}

TEST(Legend, ATipStandsWhereValuesLieBeyondTheBar) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame(640, 360);
  frame.legends.push_back({.title = "v", .unit = "", .colormap = ColorMap::turbo});
  const Image bar = renderer.draw(frame);
  const auto tip = [&](bool lower, bool higher) {
    frame.legends[0].has_lower_values = lower;
    frame.legends[0].has_higher_values = higher;
    return changed(bar, renderer.draw(frame));
  };
  // Both are as wide as the bar and half a line high, and nothing else moves.
  const auto below = tip(true, false), above = tip(false, true);
  EXPECT_GT(below.top, above.bottom + 60);
  for (const auto& place : {below, above}) {
    EXPECT_NEAR(place.right - place.left, 10, 4);
    EXPECT_NEAR(place.bottom - place.top, 5, 3);
  }
}

/// Digits of its number lay under the bar.
TEST(Legend, LabelsOfPlacesBehindItAreBesideIt) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame(640, 360);
  frame.legends.push_back({.title = "v", .unit = "", .colormap = ColorMap::turbo});
  const Image bar = renderer.draw(frame);
  const auto place = changed(renderer.draw(small_frame(640, 360)), bar);
  frame.camera = {{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 30};
  const View view = make_view(frame.camera, 640, 360);
  // Somewhere behind the bar.
  Vec3f at{0, 0, 0};
  while (view.project(at).x < static_cast<float>(place.left + 4)) at.x += 0.01f;
  while (360 - view.project(at).y < static_cast<float>(place.bottom - 20)) at.y -= 0.01f;
  frame.labels.push_back({at, "largest speed 0.0191 m/s, node 0 1 -17"});
  const auto words = changed(bar, renderer.draw(frame));
  EXPECT_LT(words.right, place.left);
  EXPECT_GT(words.right - words.left, 100);
}

TEST(Legend, InASmallPictureTheBarStandsAtTheEdgeAndTheTitleIsWhole) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  for (const char* title : {"J_P, plastic volume", "largest Kirchhoff stress of all"}) {
    Frame frame = small_frame(240, 135);
    const Image nothing = renderer.draw(frame);
    frame.legends.push_back({.title = title, .unit = "", .colormap = ColorMap::turbo});
    const Image image = renderer.draw(frame);
    const Changed all = changed(nothing, image);
    EXPECT_GT(all.left, 0.6 * 240) << title;
    EXPECT_LT(all.right, 240) << title;
    EXPECT_GT(all.top, 0) << title;
    int bar_left = 240;  // text is grey
    for (int y = 0; y < 135; ++y)
      for (int x = bar_left - 1; x >= 0; --x) {
        const Pixel p = pixel(image, x, y);
        if (std::max({p.r, p.g, p.b}) - std::min({p.r, p.g, p.b}) > 120) bar_left = x;
      }
    EXPECT_GT(bar_left, 0.8 * 240) << title;
  }
}

TEST(Legend, InASmallPictureTheCaptionKeepsOffItsTitle) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  for (const int width : {240, 280, 320, 400}) {
    Frame frame = small_frame(width, width * 9 / 16);
    const Image nothing = renderer.draw(frame);
    frame.legends.push_back({.title = "mass density of the grid", .unit = "kg/m3"});
    const Image legend = renderer.draw(frame);
    frame.caption = {"frame 3   t = 0.125 s",
                     "3 380 particles   993 steps, dt 2.47e-04 s (acoustic)"};
    const Image both = renderer.draw(frame);
    int over = 0, words = 0;
    for (int y = 0; y < both.height; ++y)
      for (int x = 0; x < width; ++x) {
        const auto differ = [&](const Image& a, const Image& b) {
          return pixel(a, x, y).brightness() != pixel(b, x, y).brightness();
        };
        if (!differ(legend, both)) continue;
        ++words;
        over += differ(nothing, legend) ? 1 : 0;
      }
    EXPECT_GT(words, 100) << width;
    EXPECT_EQ(over, 0) << width;
  }
}

TEST(Caption, InASmallTileTheTimeIsWholeAboveALongLegend) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  for (const int width : {240, 280, 320}) {
    Frame frame = small_frame(width, width * 9 / 16);
    const Image nothing = renderer.draw(frame);
    frame.caption = {"Two snowballs, frame 3, 0.125 s"};
    const Image alone = renderer.draw(frame);
    const Changed words = changed(nothing, alone);
    frame.legends.push_back({.title = "mass density of all nodes of the grid", .unit = "kg/m3"});
    const Image beside = renderer.draw(frame);
    int lost = 0;
    for (int y = words.top; y <= words.bottom; ++y)
      for (int x = words.left; x <= words.right; ++x)
        lost += pixel(alone, x, y).brightness() != pixel(beside, x, y).brightness() ? 1 : 0;
    EXPECT_GT(words.count, 100) << width;
    EXPECT_EQ(lost, 0) << width;
  }
}

TEST(Legend, AnyRangeIsDrawn) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const float huge = 3e38f;
  for (const auto& [min, max] : {std::pair{1.0f, 1.0f},
                                 {-huge, huge},
                                 {0.0f, 1e-30f},
                                 {5.0f, 1.0f},
                                 {NAN, 1.0f},
                                 {0.0f, INFINITY}}) {
    Frame frame = small_frame(320, 180);
    frame.legends.push_back({.title = "t", .unit = "", .min = min, .max = max});
    EXPECT_NO_THROW(renderer.draw(frame)) << min << " " << max;
  }
}

/// The line at a number, of a legend that has room for one number only.
TEST(Legend, ASingleNumberStandsAtItsValue) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  // White bars: the line and the number are all that is soft.
  const auto number_at = [&](float min, float max) {
    Frame frame = small_frame(320, 130);
    for (const char* title : {"speed", "density"})
      frame.legends.push_back({.title = title, .unit = "", .min = min, .max = max});
    const Image with = renderer.draw(frame);
    for (Legend& legend : frame.legends) {
      legend.min = 0.4f;  // the number 0.5 in the middle
      legend.max = 0.6f;
    }
    const Image middle = renderer.draw(frame);
    return changed(with, middle);
  };
  // The number 0.5 is at a third of the bar, not in the middle.
  EXPECT_GT(number_at(0.3f, 0.9f).count, 20);
  EXPECT_EQ(number_at(0.4f, 0.6f).count, 0);
}

TEST(Legend, SeveralLegendsAreStacked) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  for (const auto& [width, height] : {std::pair{640, 360}, {480, 270}, {320, 180}}) {
    Frame frame = small_frame(width, height);
    const Image nothing = renderer.draw(frame);
    frame.legends.push_back({.title = "speed", .unit = "m/s"});
    const Changed one = changed(nothing, renderer.draw(frame));
    frame.legends.push_back({.title = "velocity", .unit = "m/s"});
    const Changed two = changed(nothing, renderer.draw(frame));
    // Both are as narrow as the wider title, and above the caption's third only where they must.
    EXPECT_GT(two.left, 0.7 * width) << width;
    EXPECT_LT(two.top, one.top - 20) << width;
    EXPECT_GT(two.top, 5) << width;
    EXPECT_LT(two.right, width - 1) << width;
  }
}

TEST(Footnote, FootnoteIsBetweenPlotsAndLegends) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const auto place_of = [&](Frame frame) {
    const Image without = renderer.draw(frame);
    frame.footnote = "z = 0 m, one arrow per 2 nodes, longest arrow 12.5 m/s, and more of it all";
    return changed(without, renderer.draw(frame));
  };
  Frame frame = small_frame(640, 360);
  const Changed alone = place_of(frame);
  EXPECT_LT(alone.left, 0.05 * 640);
  EXPECT_GT(alone.top, 0.9 * 360);
  frame.legends.push_back({.title = "speed", .unit = "m/s"});
  const Image nothing = renderer.draw(small_frame(640, 360));
  EXPECT_LT(place_of(frame).right, changed(nothing, renderer.draw(frame)).left);
  frame.legends.clear();
  frame.plots = {Plot{.title = "energy", .unit = "J", .series = {}}};
  EXPECT_GT(place_of(frame).left, changed(nothing, renderer.draw(frame)).right);
}

TEST(Marks, RingSurroundsTheMarkedPlace) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame(480, 270);
  const Image nothing = renderer.draw(frame);
  frame.marks = {{0, 0, 0}};
  const Image image = renderer.draw(frame);
  const Changed c = changed(nothing, image);
  EXPECT_LT(c.left, 240);
  EXPECT_GT(c.right, 240);
  EXPECT_GT(c.bottom, 135);
  const Pixel inside = pixel(image, 240, 135), before = pixel(nothing, 240, 135);
  EXPECT_EQ(inside.brightness(), before.brightness());
  frame.marks = {{0, 0, 5}};  // behind the eye
  EXPECT_EQ(renderer.draw(frame).pixels, nothing.pixels);
}

}  // namespace
}  // namespace neve::render
