#pragma once
/// Light and smoke as kernels read them: plain data, no standard header.
///
/// Positions are relative to the eye, in m, with the axes of the world. Samples count from the
/// lower left corner of the picture.

#include "sim/base/vec.h"

namespace neve::render::light {

/// The camera; see View.
struct LaneView {
  Vec3f right, up, forward;
  float pixels_per_slope;
  float near_distance;  ///< m
  int width, height;    ///< samples
};

/// A LightVolume. Four bytes per cell: normal of the body and density, signed; key light and sky,
/// 16 bits each.
struct LightCells {
  Vec3f origin;
  float cell;
  Vec3i count;
  const unsigned *body, *light;
};

/// Smoke that is laid over the surfaces, one number per ray; see SmokeRays.
struct SmokeCover {
  const float* sums[4];
  const float* depth;
  int width, height;  ///< rays
  float samples_per_ray, nearest, farthest, spacing;
  int is_colored;
};

}  // namespace neve::render::light
