#pragma once
/// One frame drawn by OpenGL and on the CPU: the same picture.

#include <algorithm>
#include <cmath>
#include <string>

#include "gl_test.h"

namespace neve::render {

/// A ball off the lattice, so that no two spheres are alike.
inline Frame rough_ball(int width, int height) {
  Frame frame = small_frame(width, height);
  frame.camera = {.eye = {0.9f, 0.6f, 1.4f}, .target = {0, 0, 0}, .up = {0, 1, 0}, .fov = 40};
  frame.light.direction = {-0.6f, 0.6f, 0.5f};
  frame.grounds.push_back({.point = {0, -0.42f, 0}});
  add_ball(frame, {0, 0, 0}, 0.4f, 0.025f);
  for (std::size_t i = 0; i < frame.points.position.size(); ++i) {
    const float x = static_cast<float>(i);
    frame.points.position.edit()[i] =
        frame.points.position[i] + 0.01f * Vec3f{std::sin(x), std::sin(2.3f * x), std::sin(5 * x)};
  }
  return frame;
}

/// Pixels of which a channel differs by more than so many of 255.
inline int differing_pixels(const Image& a, const Image& b, int allowed) {
  int count = 0;
  const auto channels = static_cast<std::size_t>(a.channels);
  for (std::size_t i = 0; i < a.pixels.size(); i += channels) {
    int largest = 0;
    for (std::size_t c = 0; c < channels; ++c)
      largest = std::max(largest, std::abs(int{a.pixels[i + c]} - int{b.pixels[i + c]}));
    if (largest > allowed) ++count;
  }
  return count;
}

/// Draws a frame both ways. If both agree on which sphere a sample shows, 8-bit albedo, half
/// normals and rounding of the depth make its colour differ by 1 or 2 of 255. On the edge of a
/// sphere, and where two meet, rounding decides which one a sample shows, and a pixel may differ by
/// anything; those may be one in two thousand. On average 0.02 of 255 where the processor runs the
/// shaders too; a GPU filters textures to 8 bits of the way between texels, and has its own powers:
/// 0.03 to 0.05 were seen, and 0.12 of a sphere that fills the picture.
inline void expect_same_picture(render::gl::Context& context, const Frame& frame,
                                const std::string& what) {
  Renderer gl(context, {}, nullptr, ParticlePath::gl), cpu(context, {}, nullptr, ParticlePath::cpu);
  const Image a = gl.draw(frame), b = cpu.draw(frame);
  EXPECT_LE(differing_pixels(a, b, 2), frame.width * frame.height / 2000) << what;
  EXPECT_LE(compare(a, b).mean, context.is_software ? 0.02 : 0.15) << what;
  Frame nothing = frame;
  nothing.points = {};
  nothing.smoke = {};
  nothing.arrows.clear();
  nothing.heat_maps.clear();
  EXPECT_GT(compare(a, gl.draw(nothing)).mean, 0.2) << what << ": nothing is there to compare";
}

}  // namespace neve::render
