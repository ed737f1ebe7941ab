#pragma once
/// The kernels that draw on the CPU, compiled once for each instruction set.

#include "render/cpu/block_job.h"
#include "render/cpu/exposure_job.h"
#include "render/cpu/grain_look_job.h"
#include "render/cpu/near_job.h"
#include "render/cpu/near_light_job.h"
#include "render/cpu/snow_light_job.h"
#include "render/cpu/splat_job.h"
#include "render/cpu/surface_job.h"
#include "render/light/smoke_job.h"

namespace neve::render::cpu {

/// All instruction sets give the same bits.
struct DrawKernels {
  const char* simd;
  void (*project)(const ProjectJob&);
  /// The first in a tile: clears it.
  void (*splat_tile)(const TileJob&);
  /// @param x, y lower left sample of the tile
  void (*ground_tile)(const GroundJob&, light::GBufferTile&, int x, int y);
  void (*solid_tile)(const SolidJob&, light::GBufferTile&);
  void (*march)(const light::SmokeJob&);
  void (*march_block)(const BlockJob&);
  void (*find_nearest)(const NearJob&);
  void (*light_near)(const NearLightJob&);
  void (*mix_exposures)(const ExposureJob&);
  void (*look_at_grains)(const GrainLookJob&);
  void (*light_snow)(const SnowLightJob&);
  void (*shade_tile)(const ShadeJob&);
};

extern const DrawKernels draw_baseline;
#ifdef NEVE_X86_DRAW
extern const DrawKernels draw_avx2;
#endif

/// The fastest that this machine can run; NEVE_SIMD=baseline takes the plain ones.
const DrawKernels& chosen_draw_kernels();

}  // namespace neve::render::cpu
