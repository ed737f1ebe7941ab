#pragma once
/// Smoke with the light that reaches it, as the march of shaders/smoke.frag reads it, and its place
/// on the picture.

#include <cstdint>
#include <vector>

#include "render/frame/view.h"
#include "render/light/lighting.h"
#include "render/light/smoke_grid.h"
#include "render/light/smoke_job.h"

namespace neve::render::light {

struct SmokeVolume {
  /// Four per texel of the grid: opacity, and times that the key light, the sky, and the light that
  /// was scattered many times, or the place of the value in its range. Products interpolate as they
  /// should where one side is empty.
  std::vector<float> texels;
  /// Cubes of 4x4x4 texels, from texel 4 b to 4 b + 4: 255 where there is smoke between these.
  Vec3i brick_count{0, 0, 0};
  std::vector<std::uint8_t> bricks;  ///< index as in SmokeGrid
};

/// @param grid not empty @param pool may be null
SmokeVolume make_smoke_volume(const SmokeGrid& grid, const LightVolume& light, Vec3f toward_light,
                              ThreadPool* pool);

/// Linear light at colormap_width places of a colour map, four numbers each, the last one 0.
std::vector<float> linear_colors(ColorMap map);

/// Light on coloured smoke: it has no tint, so that colours equal those of the legend.
inline constexpr float key_on_colors = 1.15f, sky_on_colors = 0.55f;

/// Rays of a tile along each axis.
inline constexpr int smoke_rays_per_tile = 8;

/// Number of samples along each axis that share a ray: the smoke's own setting, or from the size of
/// its texels in the picture.
int samples_per_ray(const Smoke& smoke, const SmokeGrid& grid, const View& view);

/// Distances along the view between which each tile of the picture shows smoke.
struct SmokeSpans {
  int tile = 1, columns = 0, rows = 0;
  std::vector<float> near_far;      ///< m, two per tile; near > far: none
  float nearest = 0, farthest = 0;  ///< of all tiles; nearest > farthest: no smoke in view
};

/// @param tile side of a tile, samples of the view
SmokeSpans make_smoke_spans(const SmokeGrid& grid, const SmokeVolume& volume, const View& view,
                            int tile);

}  // namespace neve::render::light
