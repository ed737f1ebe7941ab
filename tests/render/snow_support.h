#pragma once
/// Snow that tests of the view snow look at.

#include "both_ways.h"

namespace neve::render {

/// A rough ball whose particles are drawn as a surface.
inline Frame snow_ball(int width, int height) {
  Frame frame = rough_ball(width, height);
  frame.has_snow_surface = true;
  return frame;
}

/// A ball with a crack, a thin sheet beside it, and a few loose particles.
inline Frame torn_snow(int width, int height) {
  Frame frame = snow_ball(width, height);
  Points& points = frame.points;
  for (Vec3f& p : points.position.edit())
    if (p.x + 0.2f * p.y > 0.1f) p.x += 0.08f;
  for (int i = -8; i <= 8; ++i)
    for (int j = -8; j <= 8; ++j)
      add_point(frame, {0.62f, 0.025f * static_cast<float>(i), 0.025f * static_cast<float>(j)});
  for (int i = 0; i < 5; ++i) add_point(frame, {-0.6f, 0.1f * static_cast<float>(i), 0.3f});
  return frame;
}

}  // namespace neve::render
