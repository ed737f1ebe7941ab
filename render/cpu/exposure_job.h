#pragma once
/// Data of the kernel that interpolates what was found at the corners of cells: plain data, as
/// splat_job.h.

namespace neve::render::cpu {

/// Numbers of a corner: a whole vector, the last of which is not used.
inline constexpr int exposure_numbers = 8;

/// Lists have `count` numbers.
struct ExposureJob {
  int count;
  const float* const* corner;  ///< the first corner of the cell of each place
  const int *row, *slice;      ///< numbers from one corner to the next along y, and along z
  const float* part[3];        ///< of the way through the cell, 0 to 1
  const int* to;               ///< where in the results
  float* out[exposure_numbers - 1];
};

}  // namespace neve::render::cpu
