#pragma once
/// A particle of snow as dust sees it.

#include <cstdint>

#include "sim/types/math.h"

namespace neve::sim::dust {

struct SnowGrain {
  Vec3d x, v;         ///< m, from the lattice origin; m/s
  double m = 0;       ///< kg
  double volume = 0;  ///< m3, at the density of its material
  double J_P = 1;
  double dust = 0;  ///< see Material::dust
  std::uint32_t id = 0;
};

}  // namespace neve::sim::dust
