#pragma once
/// Relief of grains: a cube of noise that repeats, with several octaves.

#include <array>
#include <vector>

#include "sim/base/lanes.h"
#include "sim/base/vec.h"

namespace neve::render::snow {

struct Relief {
  float height = 0;  ///< about -1 to 1
  Vec3f slope;       ///< its gradient, per unit of place
};

/// Octaves of wavelengths 1, 1/2, 1/4 ... of a unit. Same bits everywhere.
class GrainNoise {
 public:
  GrainNoise();
  /// @param place in units; repeats after 4
  /// @param detail 0: all octaves; 1: without the finest; 2: only the coarsest
  NEVE_INLINE Relief at(Vec3f place, int detail) const;

  static constexpr int side = 32, levels = 3, texels_per_unit = side / 4;
  /// Number of a texel; places repeat.
  static constexpr std::size_t texel(int i, int j, int k) {
    constexpr int mask = side - 1;
    return static_cast<std::size_t>(((k & mask) * side + (j & mask)) * side + (i & mask));
  }

 private:
  using Texel = Lanes<float, 4>;  ///< height, and its gradient
  std::array<std::vector<Texel>, levels> levels_;
};

/// One for all.
const GrainNoise& grain_noise();

Relief GrainNoise::at(Vec3f place, int detail) const {
  const Texel* from = levels_[static_cast<std::size_t>(detail)].data();
  const Vec3f p = place * static_cast<float>(texels_per_unit);
  const int i = floor_to_int(p.x), j = floor_to_int(p.y), k = floor_to_int(p.z);
  const float x = p.x - static_cast<float>(i), y = p.y - static_cast<float>(j),
              z = p.z - static_cast<float>(k);
  const auto row = [&](int b, int c) NEVE_INLINE_BODY {
    const Texel low = from[texel(i, j + b, k + c)], high = from[texel(i + 1, j + b, k + c)];
    return low + (high - low) * x;
  };
  const auto slice = [&](int c) NEVE_INLINE_BODY {
    const Texel low = row(0, c), high = row(1, c);
    return low + (high - low) * y;
  };
  const Texel low = slice(0), high = slice(1), sum = low + (high - low) * z;
  return {sum[0], {sum[1], sum[2], sum[3]}};
}

}  // namespace neve::render::snow
