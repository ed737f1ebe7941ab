#pragma once
/// The camera as the passes need it. Passes work relative to the eye, with the axes of the world,
/// so that a scene far from the origin keeps its precision.

#include "render/frame/frame.h"

namespace neve::render {

struct View {
  Vec3f eye;                    ///< world, m
  Vec3f right, up, forward;     ///< unit, world axes
  float pixels_per_slope = 1;   ///< pixels per unit of tan(angle)
  int width = 1, height = 1;    ///< samples
  float near_distance = 0.01f;  ///< m; depth = 1 - near / distance along forward

  /// Position on the picture in samples, y up, and distance along forward; distance <= 0: behind.
  Vec3f project(Vec3f world) const;
  bool operator==(const View&) const = default;
};

/// Any camera gives a usable view: a zero direction looks along -z, a parallel up is replaced, the
/// angle is kept within 1 to 170 degrees.
View make_view(const Camera& camera, int width, int height);

}  // namespace neve::render
