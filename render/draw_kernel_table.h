#pragma once
/// The drawing kernels of one instruction set, for the files that are compiled for it.

#include "render/draw_kernels.h"
#include "render/ground_kernel.h"
#include "render/shade_kernel.h"
#include "render/smoke_kernel.h"
#include "render/splat_kernel.h"

namespace neve::render {

/// @tparam V lanes of float; another type for each instruction set
template <class V>
constexpr DrawKernels draw_kernel_table(const char* name) {
  return {name,
          [](const ProjectJob& job) { project_discs<V>(job); },
          [](const TileJob& job) { draw_tile_lanes<V>(job); },
          [](const GroundJob& job, GBufferTile& tile, int x, int y) {
            ground_tile_lanes<V>(job, tile, x, y);
          },
          [](const SolidJob& job, GBufferTile& tile) { solid_tile_lanes<V>(job, tile); },
          [](const SmokeJob& job) { march_rays<V>(job); },
          [](const ShadeJob& job) { shade_tile_lanes<V>(job); }};
}

}  // namespace neve::render
