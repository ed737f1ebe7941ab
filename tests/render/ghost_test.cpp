/// See-through surfaces: what is behind them shines through, what is before them hides them.

#include <algorithm>

#include "gl_test.h"
#include "render/shapes/mesh_shapes.h"

namespace neve::render {
namespace {

/// A ball of snow in the middle of the picture.
Frame with_ball() {
  Frame frame = small_frame(160, 120);
  add_ball(frame, {0, 0, 0}, 0.2f, 0.03f);
  return frame;
}

const TriangleMesh& before() {
  static const TriangleMesh mesh = render::shapes::sphere_mesh({0, 0, 0.6f}, 0.35f);
  return mesh;
}

int middle_value(const Image& image) {
  return pixel(image, 80, 60).brightness();
}

TEST(Ghosts, SnowShinesThroughGhosts) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = with_ball();
  const int snow = middle_value(renderer.draw(frame));
  frame.ghosts = {before()};
  const Image through = renderer.draw(frame);
  frame.ghosts.clear();
  frame.meshes = {before()};
  const int solid = middle_value(renderer.draw(frame));
  ASSERT_GT(snow - solid, 40) << "the scene cannot tell them apart";
  EXPECT_GT(middle_value(through) - solid, (snow - solid) / 2);
  EXPECT_NE(middle_value(through), snow);
}

TEST(Ghosts, GhostsAreHiddenByTheSnowBeforeThem) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = with_ball();
  const int snow = middle_value(renderer.draw(frame));
  frame.ghosts = {render::shapes::sphere_mesh({0, 0, -1}, 0.3f)};
  EXPECT_EQ(middle_value(renderer.draw(frame)), snow);
}

TEST(Ghosts, GhostsAreBrightestAtTheirRim) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = small_frame(160, 120);
  const Image nothing = renderer.draw(frame);
  frame.ghosts = {render::shapes::sphere_mesh({0, 0, 0}, 0.3f)};
  const Image image = renderer.draw(frame);
  int rim = 0;
  for (int x = 0; x < 80; ++x)
    rim = std::max(rim, pixel(image, x, 60).brightness() - pixel(nothing, x, 60).brightness());
  const int face = middle_value(image) - middle_value(nothing);
  EXPECT_GT(face, 3);
  EXPECT_GT(rim, 2 * face);
}

TEST(Ghosts, GhostsCastNoShadowAndLeaveNoTraceOutside) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = with_ball();
  frame.grounds.push_back({.point = {0, -0.3f, 0}});
  frame.light.direction = {0, 1, 0};
  frame.camera.eye = {0, 0.6f, 2};
  const Image nothing = renderer.draw(frame);
  frame.ghosts = {render::shapes::sphere_mesh({0.7f, 0.2f, 0}, 0.1f)};
  const Image image = renderer.draw(frame);
  // The ghost is in the right upper quarter; its shadow would be below it.
  for (int y = 75; y < 120; ++y)
    for (int x = 0; x < 160; ++x)
      ASSERT_EQ(pixel(image, x, y).brightness(), pixel(nothing, x, y).brightness())
          << x << " " << y;
}

TEST(Ghosts, OrderInTheFrameDoesNotMatter) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame = with_ball();
  frame.ghosts = {before(), render::shapes::sphere_mesh({0.1f, 0, 0.2f}, 0.3f),
                  render::shapes::box_mesh({0, 0.2f, -0.5f}, {1, 1, 1})};
  const Image forward = renderer.draw(frame);
  std::reverse(frame.ghosts.begin(), frame.ghosts.end());
  EXPECT_EQ(renderer.draw(frame).pixels, forward.pixels);
}

TEST(GhostGrounds, GhostGroundsAreSeenFromBothSidesAndWithoutFillOnlyAsLines) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const Image nothing = renderer.draw(small_frame(160, 120));
  for (const float side : {1.0f, -1.0f}) {
    const auto changed = [&](float fill) {
      Frame frame = small_frame(160, 120);
      frame.ghost_grounds.push_back(
          {.point = {0, 0, -0.2f}, .normal = {0, 0, side}, .line_spacing = 0.2f, .fill = fill});
      const Image image = renderer.draw(frame);
      int count = 0;
      for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x)
          count += pixel(image, x, y).brightness() != pixel(nothing, x, y).brightness();
      return count;
    };
    const int filled = changed(0.2f), lines = changed(0);
    EXPECT_GT(filled, 160 * 120 / 2) << side;
    EXPECT_GT(lines, 300) << side;
    EXPECT_LT(lines, filled / 2) << side;
  }
}

TEST(ShapeLines, LinesLieOnTheShape) {
  const Lines sphere = render::shapes::sphere_lines({1, 2, 3}, 0.5f);
  ASSERT_FALSE(sphere.ends.empty());
  ASSERT_EQ(sphere.ends.size() % 2, 0u);
  for (const Vec3f& p : sphere.ends) EXPECT_NEAR(length(p - Vec3f{1, 2, 3}), 0.5f, 1e-5f);
  const Lines box = render::shapes::box_lines({0, 0, 0}, {2, 4, 6});
  ASSERT_EQ(box.ends.size(), 24u);
  for (std::size_t k = 0; k < box.ends.size(); k += 2) {
    const Vec3f edge = box.ends[k + 1] - box.ends[k];
    EXPECT_TRUE(length(edge) == 2 || length(edge) == 4 || length(edge) == 6) << length(edge);
  }
}

}  // namespace
}  // namespace neve::render
