#pragma once
/// Common parts of tests that draw: opening a context or skipping, small frames, reading pixels.

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "render/renderer.h"
#include "tests/support/needs.h"

/// Opens a context, or ends the test where there is none.
#define OPEN_OR_SKIP(context, choice)                                           \
  std::string context##_reason;                                                 \
  const auto context = neve::render::open_or_explain(choice, context##_reason); \
  if (!context) SKIP_OR_FAIL(context##_reason)

namespace neve::render {

inline std::unique_ptr<render::gl::Context> open_or_explain(const std::string& choice,
                                                            std::string& reason) {
  try {
    return render::gl::open_context(choice);
  } catch (const render::gl::ContextError& error) {
    reason = error.what();
    return nullptr;
  }
}

struct Pixel {
  int r = 0, g = 0, b = 0;
  int brightness() const { return (r + g + b) / 3; }
};

inline Pixel pixel(const Image& image, int x, int y) {
  const std::size_t at = 3 * static_cast<std::size_t>(y * image.width + x);
  return {image.pixels.at(at), image.pixels.at(at + 1), image.pixels.at(at + 2)};
}

/// Returns a frame seen along -z from distance 2; one unit at the origin is as high as the picture.
inline Frame small_frame(int width = 120, int height = 90) {
  Frame frame;
  frame.width = width;
  frame.height = height;
  frame.camera = {.eye = {0, 0, 2}, .target = {0, 0, 0}, .up = {0, 1, 0}, .fov = 28.0725f};
  frame.light.direction = {0, 0.3f, 1};
  return frame;
}

inline void add_point(Frame& frame, Vec3f position) {
  frame.points.id.edit().push_back(static_cast<std::uint32_t>(frame.points.position.size()));
  frame.points.position.edit().push_back(position);
}

/// A ball of packed points.
inline void add_ball(Frame& frame, Vec3f center, float radius, float spacing) {
  frame.points.spacing = spacing;
  frame.points.radius = 0.7f * spacing;
  const int n = static_cast<int>(radius / spacing);
  for (int i = -n; i <= n; ++i) {
    for (int j = -n; j <= n; ++j) {
      for (int k = -n; k <= n; ++k) {
        const Vec3f p =
            spacing * Vec3f{static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)};
        if (length(p) <= radius) add_point(frame, center + p);
      }
    }
  }
}

}  // namespace neve::render
