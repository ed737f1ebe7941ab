#pragma once
/// Interpolates what was found at the corners of cells, in lanes of the numbers of a corner.

#include "render/cpu/exposure_job.h"
#include "render/cpu/lane_math.h"

namespace neve::render::cpu {
namespace {

/// @tparam V  another type for each instruction set
template <class V>
NEVE_INLINE void mix_exposures(const ExposureJob& job) {
  using Numbers = Lanes<float, exposure_numbers>;
  for (int m = 0; m < job.count; ++m) {
    const float x = job.part[0][m], y = job.part[1][m], z = job.part[2][m];
    Numbers sum{};
    for (int n = 0; n < 8; ++n) {
      const float w = ((n & 1) ? x : 1 - x) * ((n >> 1 & 1) ? y : 1 - y) * ((n >> 2) ? z : 1 - z);
      Numbers corner;
      __builtin_memcpy(&corner,
                       job.corner[m] + (n >> 2) * job.slice[m] + (n >> 1 & 1) * job.row[m] +
                           (n & 1) * exposure_numbers,
                       sizeof corner);
      sum += w * corner;
    }
    for (int number = 0; number < exposure_numbers - 1; ++number)
      job.out[number][job.to[m]] = sum[number];
  }
}

}  // namespace
}  // namespace neve::render::cpu
