#pragma once
/// Relief of grains: a cube of noise that repeats, with several octaves.

#include <array>
#include <vector>

#include "render/cpu/grain_look_job.h"

namespace neve::render::snow {

/// Octaves of wavelengths 1, 1/2, 1/4 ... of a unit. Same bits everywhere.
class GrainNoise {
 public:
  GrainNoise();
  /// Height, about -1 to 1, and its gradient per unit of each texel.
  /// @param level 0: all octaves; 1: without the finest; 2: only the coarsest
  const float* texels(int level) const { return levels_[static_cast<std::size_t>(level)].data(); }

  static constexpr int side = cpu::noise_side, levels = cpu::noise_levels,
                       texels_per_unit = cpu::noise_texels_per_unit;
  /// Number of a texel; places repeat.
  static constexpr std::size_t texel(int i, int j, int k) {
    constexpr int mask = side - 1;
    return static_cast<std::size_t>(((k & mask) * side + (j & mask)) * side + (i & mask));
  }

 private:
  std::array<std::vector<float>, levels> levels_;
};

/// One for all.
const GrainNoise& grain_noise();

}  // namespace neve::render::snow
