#include "render/cpu/smoke_march.h"

#include <algorithm>
#include <vector>

#include "render/light/light_fields.h"

namespace neve::render::cpu {
namespace {

/// True if a tile of rays or a neighbour may show smoke: shading reads the next ray too.
bool is_near_smoke(const light::SmokeSpans& spans, int column, int row) {
  for (int j = std::max(row - 1, 0); j <= std::min(row + 1, spans.rows - 1); ++j)
    for (int i = std::max(column - 1, 0); i <= std::min(column + 1, spans.columns - 1); ++i) {
      const float* span = spans.near_far.data() + 2 * (j * spans.columns + i);
      if (span[0] <= span[1]) return true;
    }
  return false;
}

}  // namespace

void SmokeMarch::make_rays(int width, int height) {
  const std::size_t wanted = 5 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (size_ >= wanted) return;
  rays_.reset();
  rays_ = std::make_unique_for_overwrite<float[]>(wanted);
  size_ = wanted;
}

std::optional<light::SmokeCover> SmokeMarch::march(const Smoke& smoke, const light::SmokeGrid& grid,
                                                   const light::SmokeVolume& volume,
                                                   const Light& light, const Surfaces& surfaces,
                                                   const View& view) {
  const int n = light::samples_per_ray(smoke, grid, view);
  const light::SmokeSpans spans =
      light::make_smoke_spans(grid, volume, view, light::smoke_rays_per_tile * n);
  if (spans.nearest > spans.farthest) return std::nullopt;
  const int width = (view.width + n - 1) / n, height = (view.height + n - 1) / n;
  make_rays(width, height);
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const std::vector<float> colors =
      smoke.value.empty() ? std::vector<float>{} : light::linear_colors(smoke.colormap);
  light::SmokeJob job{};
  job.view = lane_view(view);
  job.grid_origin = grid.origin - view.eye;
  job.grid_size = grid.size;
  job.texel = grid.spacing;
  job.texels = volume.texels.data();
  job.bricks = volume.bricks.data();
  job.brick_count = volume.brick_count;
  job.extinction = grid.extinction();
  job.colormap = colors.empty() ? nullptr : colors.data();
  job.key_light = light::key_on_colors * light.intensity;
  job.sky_light = light::sky_on_colors * light.ambient;
  job.tiles = surfaces.kept();
  job.tile_columns = surfaces.columns();
  job.samples_per_ray = n;
  job.nearest = spans.nearest;
  job.farthest = spans.farthest;
  job.pitch = width;
  for (std::size_t c = 0; c < 4; ++c) job.sums[c] = rays_.get() + c * count;
  job.depth = rays_.get() + 4 * count;
  light::for_each_task(spans.columns * spans.rows, pool_, [&](int tile) {
    const int column = tile % spans.columns, row = tile / spans.columns;
    light::SmokeJob mine = job;
    mine.near = spans.near_far[2 * static_cast<std::size_t>(tile)];
    mine.far = spans.near_far[2 * static_cast<std::size_t>(tile) + 1];
    mine.x_low = column * light::smoke_rays_per_tile;
    mine.y_low = row * light::smoke_rays_per_tile;
    mine.x_high = std::min(mine.x_low + light::smoke_rays_per_tile, width);
    mine.y_high = std::min(mine.y_low + light::smoke_rays_per_tile, height);
    if (is_near_smoke(spans, column, row)) {
      kernels_.march(mine);
    } else {
      for (int y = mine.y_low; y < mine.y_high; ++y)
        for (float* sums : mine.sums)
          std::fill_n(sums + static_cast<std::ptrdiff_t>(y) * width + mine.x_low,
                      mine.x_high - mine.x_low, 0.0f);
    }
  });
  light::SmokeCover cover{};
  for (std::size_t c = 0; c < 4; ++c) cover.sums[c] = job.sums[c];
  cover.depth = job.depth;
  cover.width = width;
  cover.height = height;
  cover.samples_per_ray = static_cast<float>(n);
  cover.nearest = spans.nearest;
  cover.farthest = spans.farthest;
  cover.spacing = grid.spacing;
  cover.is_colored = smoke.value.empty() ? 0 : 1;
  return cover;
}

}  // namespace neve::render::cpu
