#include "render/self_test.h"

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "render/frame/view.h"
#include "render/renderer.h"

namespace neve::render {
namespace {

constexpr float ball_radius = 0.3f;

/// A ball of packed points that hovers over the ground, lit from the left.
Frame ball_over_ground() {
  Frame frame;
  frame.width = 320;
  frame.height = 180;
  frame.points.spacing = 0.04f;
  frame.points.radius = 0.03f;
  const int n = static_cast<int>(ball_radius / frame.points.spacing);
  for (int i = -n; i <= n; ++i) {
    for (int j = -n; j <= n; ++j) {
      for (int k = -n; k <= n; ++k) {
        const Vec3f p = Vec3f{static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)} *
                        frame.points.spacing;
        if (length(p) <= ball_radius) frame.points.position.edit().push_back(p);
      }
    }
  }
  frame.grounds.push_back({.point = {0, -0.5f, 0}});
  frame.light.direction = {-0.7f, 0.7f, 0.1f};
  frame.camera = {.eye = {0, 0.9f, 3.2f}, .target = {0, 0, 0}, .up = {0, 1, 0}, .fov = 30};
  return frame;
}

int brightness(const Image& image, int x, int y) {
  const std::size_t at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                              static_cast<std::size_t>(x));
  return (image.pixels[at] + image.pixels[at + 1] + image.pixels[at + 2]) / 3;
}

int brightness_at(const Image& image, const Frame& frame, Vec3f place) {
  const Vec3f p = make_view(frame.camera, frame.width, frame.height).project(place);
  return brightness(image, static_cast<int>(p.x), frame.height - 1 - static_cast<int>(p.y));
}

std::string check_ball(const Image& image, const Frame& frame) {
  int area = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) area += brightness(image, x, y) > 135;
  }
  const View view = make_view(frame.camera, frame.width, frame.height);
  const float radius = ball_radius * view.pixels_per_slope / length(frame.camera.eye);
  const float expected = std::numbers::pi_v<float> * radius * radius;
  // The shaded side of the ball is not counted, and grains make the edge uneven.
  if (static_cast<float>(area) < 0.5f * expected || static_cast<float>(area) > 1.3f * expected)
    return "snow covers " + std::to_string(area) + " pixels, expected about " +
           std::to_string(static_cast<int>(expected));
  if (brightness_at(image, frame, {-0.15f, 0.15f, 0.2f}) <
      brightness_at(image, frame, {0.18f, -0.18f, 0.1f}) + 15)
    return "the lit side of the snow is not brighter than the other";
  if (brightness_at(image, frame, {0.5f, -0.5f, 0}) + 12 >
      brightness_at(image, frame, {-0.6f, -0.5f, 0}))
    return "the snow casts no shadow on the ground";
  return {};
}

std::string check_text(Renderer& renderer, const Image& without, Frame frame) {
  frame.caption = {"neve"};
  const Image with = renderer.draw(frame);
  int changed = 0;
  for (std::size_t i = 0; i < with.pixels.size(); ++i)
    changed += std::abs(int{with.pixels[i]} - int{without.pixels[i]}) > 30;
  return changed > 60 ? "" : "text is not drawn";
}

}  // namespace

std::string self_test(gl::Context& context) try {
  Renderer renderer(context);
  const Frame frame = ball_over_ground();
  const Image image = renderer.draw(frame);
  if (std::string wrong = check_ball(image, frame); !wrong.empty()) return wrong;
  if (renderer.draw(frame).pixels != image.pixels) return "the same picture was drawn differently";
  return check_text(renderer, image, frame);
} catch (const std::exception& error) {
  return error.what();
}

}  // namespace neve::render
