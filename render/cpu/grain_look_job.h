#pragma once
/// Data of the kernel that looks at grains of snow from near: plain data, as splat_job.h.

#include "sim/base/vec.h"

namespace neve::render::cpu {

/// Samples read a grain as one piece, since they ask for grains in no order.
struct alignas(32) Grain {
  Vec3f position;      ///< m, a little off the particle: grain shows no lattice
  unsigned color = 0;  ///< as the G-buffer has it (gbuffer_tile.h)
  unsigned seed = 0;   ///< a random number that stays with the particle
  short turn[4]{};     ///< as PackedTurn
  float relief = 1;    ///< factor of its relief
};

/// Texels of the noise that relief is made of, along each axis; it repeats.
inline constexpr int noise_side = 32, noise_levels = 3, noise_texels_per_unit = noise_side / 4;

/// Lists have `count` numbers, and are long enough for whole vectors of max_light_lanes.
struct GrainLookJob {
  int count;
  float spacing;                     ///< m, of packed particles
  const Grain* grains;               ///< all there are
  const float* noise[noise_levels];  ///< height and its gradient of each texel; the finest first
  const unsigned* grain;             ///< which; beyond count any existing one
  const float* world[3];             ///< m, of samples
  const float* sample_size;          ///< m
  int wants_facets;                  ///< or leaves them
  float* albedo[3];                  ///< out: linear
  float *slope[3], *height;          ///< out: of the relief
  float* facet[3];                   ///< out: unit; 0: too small to be seen
};

/// Samples per spacing below which nothing sparkles; see snow_light_kernel.h.
inline constexpr float min_sparkling = 2;

}  // namespace neve::render::cpu
