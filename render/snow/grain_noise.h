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
  Relief at(Vec3f place, int detail) const;

  static constexpr int side = 32, levels = 3;

 private:
  using Texel = Lanes<float, 4>;  ///< height, and its gradient
  std::array<std::vector<Texel>, levels> levels_;
};

/// One for all.
const GrainNoise& grain_noise();

}  // namespace neve::render::snow
