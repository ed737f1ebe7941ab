#pragma once
/// The drawing kernels of one instruction set, for the files that are compiled for it.

#include "render/cpu/block_kernel.h"
#include "render/cpu/draw_kernels.h"
#include "render/cpu/exposure_kernel.h"
#include "render/cpu/grain_look_kernel.h"
#include "render/cpu/ground_kernel.h"
#include "render/cpu/near_kernel.h"
#include "render/cpu/near_light_kernel.h"
#include "render/cpu/shade_kernel.h"
#include "render/cpu/smoke_kernel.h"
#include "render/cpu/snow_light_kernel.h"
#include "render/cpu/splat_kernel.h"

namespace neve::render::cpu {

/// @tparam V lanes of float; another type for each instruction set
template <class V>
constexpr DrawKernels draw_kernel_table(const char* name) {
  return {name,
          [](const ProjectJob& job) { project_discs<V>(job); },
          [](const TileJob& job) { draw_tile_lanes<V>(job); },
          [](const GroundJob& job, light::GBufferTile& tile, int x, int y) {
            ground_tile_lanes<V>(job, tile, x, y);
          },
          [](const SolidJob& job, light::GBufferTile& tile) { solid_tile_lanes<V>(job, tile); },
          [](const light::SmokeJob& job) { march_rays<V>(job); },
          [](const BlockJob& job) { march_block_lanes<V>(job); },
          [](const NearJob& job) { find_nearest<V>(job); },
          [](const NearLightJob& job) { light_near<V>(job); },
          [](const ExposureJob& job) { mix_exposures<V>(job); },
          [](const GrainLookJob& job) { look_at_grains<V>(job); },
          [](const SnowLightJob& job) { light_snow<V>(job); },
          [](const ShadeJob& job) { shade_tile_lanes<V>(job); }};
}

}  // namespace neve::render::cpu
