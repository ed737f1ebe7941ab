/// Plots have their places, do not draw the future, and survive odd numbers.

#include <array>
#include <cmath>
#include <stdexcept>

#include "gl_test.h"
#include "render/overlay/svg.h"

namespace neve::render {
namespace {

constexpr std::array<std::uint8_t, 3> pure_red{255, 0, 0}, pure_green{0, 255, 0};

/// Three panels whose curves and bars reach from 0 to `now`, half way up.
Frame frame_with_plots(int width, int height, float now) {
  Frame frame = small_frame(width, height);
  for (const char* title : {"energy", "speed", "time step"}) {
    Plot plot{
        .title = title, .unit = "J", .x_end = 2, .now = now, .min = 0, .max = 10, .series = {}};
    PlotSeries curve{.name = "kinetic", .color = pure_red, .x = {}, .value = {}};
    PlotSeries bars{.name = "cfl", .color = pure_green, .x = {}, .value = {}, .bar_width = 0.1f};
    for (float t = 0; t <= now + 1e-4f; t += 0.1f) {
      curve.x.push_back(t);
      curve.value.push_back(5);
      bars.x.push_back(t);
      bars.value.push_back(3);
    }
    plot.series = {bars, curve};
    frame.plots.push_back(plot);
  }
  return frame;
}

struct Extent {
  int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1, count = 0;
};

/// Bounds of the pixels that `is` selects.
Extent extent(const Image& image, auto is) {
  Extent e;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      if (!is(x, y)) continue;
      e.left = std::min(e.left, x), e.right = std::max(e.right, x);
      e.top = std::min(e.top, y), e.bottom = std::max(e.bottom, y);
      ++e.count;
    }
  return e;
}

Extent changed_extent(const Image& a, const Image& b) {
  return extent(a, [&](int x, int y) {
    const Pixel p = pixel(a, x, y), q = pixel(b, x, y);
    return p.r != q.r || p.g != q.g || p.b != q.b;
  });
}

/// The curve, and below it the name of the series in the same colour, do not count: only what lies
/// in the lower panel's half way line.
Extent red(const Image& image, int from_row) {
  return extent(image, [&](int x, int y) {
    const Pixel p = pixel(image, x, y);
    return y >= from_row && p.r > 200 && p.g < 60 && p.b < 60;
  });
}

TEST(Plots, StandInTheLowerLeftCornerOfAnyPicture) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  for (const auto& [width, height] : {std::pair{320, 180}, {640, 360}, {1280, 720}, {3840, 2160}}) {
    const Image nothing = renderer.draw(small_frame(width, height));
    const Image image = renderer.draw(frame_with_plots(width, height, 1));
    const Extent e = changed_extent(nothing, image);
    ASSERT_GT(e.count, 1000) << width;
    EXPECT_GT(e.left, 0) << width;
    EXPECT_LT(e.right, 0.56 * width) << width;
    EXPECT_GT(e.top, 0.36 * height) << width << ": into the caption";
    EXPECT_LT(e.bottom, height - 1) << width;
  }
}

TEST(Plots, TheFutureIsNotDrawn) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const auto end_of_curve = [&](float now) {
    const Frame frame = frame_with_plots(1280, 720, now);
    // The last panel's curve: its title is above the middle of the panel.
    return red(renderer.draw(frame), 600).right;
  };
  const int at_half = end_of_curve(0.5f), at_one = end_of_curve(1), at_end = end_of_curve(2);
  EXPECT_GT(at_half, 0);
  // The time axis is straight: a quarter and a half of it. The dot at the end is 3 pixels wide.
  EXPECT_NEAR(at_end - at_one, 2 * (at_one - at_half), 3);
}

TEST(Plots, CurvesAreCutAtTheEndsOfTheirAxis) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = frame_with_plots(640, 360, 1);
  frame.plots.resize(1);
  const Extent inside = changed_extent(renderer.draw(small_frame(640, 360)), renderer.draw(frame));
  for (float& value : frame.plots[0].series[1].value) value = 1e30f;
  const Extent beyond = changed_extent(renderer.draw(small_frame(640, 360)), renderer.draw(frame));
  EXPECT_EQ(inside.top, beyond.top);
  EXPECT_EQ(inside.bottom, beyond.bottom);
}

/// A curve below its axis was gone without a word.
TEST(Plots, ACurveSaysAtWhichEndItLeavesItsAxis) {
  const auto says = [](std::vector<float> values, const std::string& words) {
    Plot plot{.title = "height", .unit = "m", .x_end = 2, .min = 1, .max = 2, .series = {}};
    plot.series = {{.name = "ball", .color = pure_red, .x = {0, 1, 2}, .value = std::move(values)}};
    overlay::SvgCanvas canvas(16);
    overlay::draw_plot(plot, {50, 350, 50, 250}, {}, canvas);
    return canvas.drawing(400, 300, true).find(">" + words + "<") != std::string::npos;
  };
  EXPECT_TRUE(says({1.5f, 1, 0.25f}, "to 0.25"));
  EXPECT_TRUE(says({1.5f, 2, 12.25f}, "to 12.2"));
  EXPECT_FALSE(says({1, 1.0005f, 2}, "to 1"));
  EXPECT_FALSE(says({0.9995f, 1.5f, 2}, "to 1"));
}

TEST(Plots, SmallPicturesShowTheFirstOnesAndTinyOnesNone) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = frame_with_plots(320, 180, 1);
  const Image all = renderer.draw(frame);
  frame.plots.resize(2);
  EXPECT_EQ(renderer.draw(frame).pixels, all.pixels);
  const Frame tiny = frame_with_plots(64, 48, 1);
  EXPECT_EQ(renderer.draw(tiny).pixels, renderer.draw(small_frame(64, 48)).pixels);
}

TEST(Plots, OddNumbersAreHarmless) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  for (const float odd : {0.0f, -1.0f, 1e38f, INFINITY, NAN}) {
    Frame frame = frame_with_plots(320, 180, 1);
    frame.plots[0].max = odd;
    frame.plots[0].x_end = odd;
    frame.plots[0].now = odd;
    frame.plots[0].series[0].value[1] = odd;
    frame.plots[0].series[1].value[1] = odd;
    frame.plots[0].series[1].x[1] = odd;
    EXPECT_NO_THROW(renderer.draw(frame)) << odd;
  }
  Frame torn = frame_with_plots(320, 180, 1);
  torn.plots[0].series[0].value.pop_back();
  EXPECT_THROW(renderer.draw(torn), std::invalid_argument);
}

}  // namespace
}  // namespace neve::render
