#pragma once
/// Data of the kernel that marches through smoke: plain data, as splat_job.h.

#include "render/light/gbuffer_tile.h"
#include "render/light/light_job.h"

namespace neve::render::light {

inline constexpr int colormap_width = 64;

/// Rays from x_low to x_high - 1 and y_low to y_high - 1, as shaders/smoke.frag marches them.
struct SmokeJob {
  LaneView view;
  // The box of texels; see SmokeVolume.
  Vec3f grid_origin;  ///< of texel (0, 0, 0), relative to the eye, m
  Vec3i grid_size;
  float texel;  ///< m
  const float* texels;
  const unsigned char* bricks;
  Vec3i brick_count;
  float extinction;            ///< 1/m, of opacity 1
  const float* colormap;       ///< linear light, four numbers each; null: smoke is white
  float key_light, sky_light;  ///< on colours
  // Surfaces in front of the smoke.
  const GBufferTile* tiles;
  int tile_columns;
  // The rays.
  int samples_per_ray;
  float near, far;          ///< m along the view, where these rays may meet smoke
  float nearest, farthest;  ///< m along the view, of all smoke in the picture
  int x_low, x_high, y_low, y_high;
  float* sums[4];  ///< one number per ray each
  float* depth;    ///< m along the view, where rays ended
  int pitch;       ///< rays from one row to the next
};

}  // namespace neve::render::light
