/// Holdouts: things of a background picture that hide snow and take its shadow.

#include <string>

#include "gl_test.h"
#include "render/shapes/mesh_shapes.h"

namespace neve::render {
namespace {

/// The ways to draw particles: by OpenGL and on the CPU.
constexpr ParticlePath both_paths[]{ParticlePath::gl, ParticlePath::cpu};

Frame ball_of_snow() {
  Frame frame = small_frame(160, 120);
  add_ball(frame, {0, 0, 0}, 0.2f, 0.03f);
  return frame;
}

TriangleMesh holdout(TriangleMesh mesh) {
  mesh.is_holdout = true;
  return mesh;
}

TriangleMesh before_the_ball() {
  return holdout(shapes::sphere_mesh({0, 0, 0.6f}, 0.35f));
}

/// A slab below the ball, with the light from above.
Frame above_a_slab() {
  Frame frame = ball_of_snow();
  frame.light.direction = {0, 1, 0};
  frame.camera.eye = {0, 0.9f, 2};
  frame.meshes = {holdout(shapes::box_mesh({0, -0.35f, 0}, {1.6f, 0.1f, 1.2f}))};
  return frame;
}

int pixels_that_differ(const Image& a, const Image& b) {
  int count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      count += pixel(a, x, y).brightness() != pixel(b, x, y).brightness();
  return count;
}

int alpha_at(const Image& image, int x, int y) {
  return image.pixels[4 * static_cast<std::size_t>(y * image.width + x) + 3];
}

TEST(Holdouts, HideSnowAndShowTheBackgroundInstead) {
  OPEN_OR_SKIP(context, "auto");
  for (const ParticlePath path : both_paths) {
    Renderer renderer(*context, {}, nullptr, path);
    const Image nothing = renderer.draw(small_frame(160, 120));
    Frame frame = ball_of_snow();
    ASSERT_GT(pixel(renderer.draw(frame), 80, 60).brightness(),
              pixel(nothing, 80, 60).brightness() + 40);
    frame.meshes = {before_the_ball()};
    const Image image = renderer.draw(frame);
    EXPECT_NEAR(pixel(image, 80, 60).brightness(), pixel(nothing, 80, 60).brightness(), 3);
    // Without snow nothing of the holdout is seen at all.
    Frame alone = small_frame(160, 120);
    alone.meshes = frame.meshes;
    EXPECT_EQ(pixels_that_differ(renderer.draw(alone), nothing), 0);
  }
}

TEST(Holdouts, LeaveATransparentPictureEmptyAndTheirShadowsBlackInIt) {
  OPEN_OR_SKIP(context, "auto");
  for (const ParticlePath path : both_paths) {
    Renderer renderer(*context, {}, nullptr, path);
    Frame frame = ball_of_snow();
    frame.is_transparent = true;
    ASSERT_EQ(alpha_at(renderer.draw(frame), 80, 60), 255);
    frame.meshes = {before_the_ball()};
    EXPECT_LT(alpha_at(renderer.draw(frame), 80, 60), 60);
    Frame slab = above_a_slab();
    slab.is_transparent = true;
    const Image image = renderer.draw(slab);
    int shadow = 0, far = 0;
    for (int x = 60; x < 100; ++x)
      for (int y = 80; y < 120; ++y) shadow = std::max(shadow, alpha_at(image, x, y));
    for (int y = 70; y < 120; ++y) far = std::max(far, alpha_at(image, 25, y));
    EXPECT_GT(shadow, 60) << "the ball's shadow on the slab";
    EXPECT_LT(far, 12) << "away from the ball";
  }
}

TEST(Holdouts, TakeShadowsAndCastNone) {
  OPEN_OR_SKIP(context, "auto");
  for (const ParticlePath path : both_paths) {
    Renderer renderer(*context, {}, nullptr, path);
    const Image slab = renderer.draw(above_a_slab());
    Frame none = above_a_slab();
    none.meshes.clear();
    const Image without = renderer.draw(none);
    int darker = 0;
    for (int y = 80; y < 120; ++y)
      for (int x = 0; x < 160; ++x)
        darker += pixel(slab, x, y).brightness() < pixel(without, x, y).brightness() - 3;
    EXPECT_GT(darker, 60);
    // A lid above the ball would put it into shadow, and a holdout does not.
    Frame lid = none;
    lid.meshes = {holdout(shapes::box_mesh({0, 1.4f, 0}, {1, 0.1f, 1}))};
    EXPECT_EQ(pixels_that_differ(renderer.draw(lid), without), 0);
  }
}

TEST(Holdouts, LetAPlateThroughWithTheShadowOfTheSnow) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  const Image plate{160, 120, 3, std::vector<std::uint8_t>(160 * 120 * 3, 180)};
  Frame frame = above_a_slab();
  frame.meshes.push_back(before_the_ball());
  const Image image = renderer.draw_on_plate(frame, plate);
  EXPECT_NEAR(pixel(image, 20, 20).brightness(), pixel(plate, 0, 0).brightness(), 1);
  Frame seen = frame;
  seen.meshes.pop_back();
  const Image open = renderer.draw_on_plate(seen, plate);
  const auto count = [&](const Image& picture, int sign) {
    int found = 0;
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 160; ++x)
        found += sign * (pixel(picture, x, y).brightness() - pixel(plate, 0, 0).brightness()) > 8;
    return found;
  };
  EXPECT_GT(count(open, -1), 40) << "the shadow";
  EXPECT_LT(count(image, 1), count(open, 1) / 2) << "the ball before the snow hides it";
}

/// A plane hides the box below it, over a plate as over nothing.
TEST(Holdouts, GroundsOfAPlateHideWhatIsBelowThem) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context, {}, nullptr, ParticlePath::cpu);
  Frame frame = ball_of_snow();
  frame.has_snow_surface = true;
  frame.camera.eye = {0, 0.9f, 2};
  frame.meshes = {shapes::box_mesh({0.4f, -0.1f, 0}, {0.2f, 0.6f, 0.2f})};
  frame.grounds.push_back({.point = {0, -0.1f, 0}, .is_holdout = true});
  const Image plate{160, 120, 3, std::vector<std::uint8_t>(160 * 120 * 3, 180)};
  const Image drawn = renderer.draw_on_plate(frame, plate);
  frame.is_transparent = true;
  const Image front = renderer.draw(frame);
  int open = 0, solid = 0, others = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      const int alpha = alpha_at(front, x, y);
      for (std::size_t c = 0; c < 3; ++c) {
        const auto at = static_cast<std::size_t>(y * 160 + x);
        const int over = alpha == 0 ? 180 : front.pixels[4 * at + c];
        if (alpha > 0 && alpha < 255) continue;
        others += std::abs(drawn.pixels[3 * at + c] - over) > 8;
      }
      open += alpha == 0;
      solid += alpha == 255;
    }
  EXPECT_LE(others, 12) << "where a faint shadow is rounded to none";
  EXPECT_GT(open, 5000);
  EXPECT_GT(solid, 1000);
}

/// A ground that is a holdout takes shadows only, also without a plate.
TEST(Holdouts, MayBeGrounds) {
  OPEN_OR_SKIP(context, "auto");
  for (const ParticlePath path : both_paths) {
    Renderer renderer(*context, {}, nullptr, path);
    Frame frame = above_a_slab();
    frame.meshes.clear();
    frame.grounds.push_back({.point = {0, -0.3f, 0}, .is_holdout = true});
    frame.is_transparent = true;
    const Image image = renderer.draw(frame);
    int shadow = 0;
    for (int x = 60; x < 100; ++x)
      for (int y = 75; y < 120; ++y) shadow = std::max(shadow, alpha_at(image, x, y));
    EXPECT_GT(shadow, 60);
    EXPECT_LT(alpha_at(image, 5, 115), 12);
  }
}

}  // namespace
}  // namespace neve::render
