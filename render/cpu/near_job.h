#pragma once
/// Data of the kernel that finds the grains of snow nearest to places: plain data, as splat_job.h.

namespace neve::render::cpu {

/// Grains lie in cubes of two nodes; a block of 8x8x8 nodes has 4x4x4 of them, x fastest.
inline constexpr int cubes_per_side = 4, cubes_per_block = 64;

inline constexpr unsigned no_grain = 0xffffffffu;

/// Places and results are arrays of `count` numbers.
struct NearJob {
  int count;
  const unsigned* block;       ///< of the field, with the place in it; no_grain: far from any
  const float* node[3];        ///< from the corner of the block, 0 to 8
  const float* world[3];       ///< m
  const unsigned (*near)[27];  ///< blocks around each block, x fastest; no_grain: none
  const unsigned* first;       ///< grain of each cube of each block, and the end
  const float* grain[3];       ///< m; 16 numbers more than there are grains
  unsigned *nearest, *second;  ///< no_grain: none
  float *nearest_squared, *second_squared;  ///< m2
};

}  // namespace neve::render::cpu
