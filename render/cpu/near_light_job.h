#pragma once
/// Data of the kernel that finds what near snow leaves of the light on nodes of a surface: plain
/// data, as splat_job.h.

#include "sim/base/vec.h"

namespace neve::render::cpu {

/// Nodes around a block of 8x8x8 that near shadows reach, and the values of one block with them, x
/// fastest.
inline constexpr int near_margin = 7, near_side = 8 + 2 * near_margin,
                     near_nodes = near_side * near_side * near_side;

/// Lists have `count` numbers, and are long enough for whole vectors of max_light_lanes.
struct NearLightJob {
  int count;
  const float* near;       ///< share that snow fills
  const float* place[3];   ///< in nodes from the corner of the block
  const float* normal[3];  ///< unit, outward
  Vec3f toward;            ///< unit, to the light
  float* before_sun;       ///< out: thickness of the snow that shades a place, about in nodes
  float* within;           ///< out: of the snow that light comes through
  float* open_sky;         ///< out: part of the sky that near snow leaves
};

}  // namespace neve::render::cpu
