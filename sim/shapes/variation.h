#pragma once
/// Snow is not uniform: per-particle factors on density, stiffness and thresholds.

#include <cstdint>

#include "sim/types/material.h"
#include "sim/types/math.h"

namespace neve::sim::shapes {

/// Factors of one particle; means over many particles are 1.
struct Factors {
  double density = 1, stiffness = 1, threshold = 1;
};

/// The largest factor that particles get for a relative deviation.
double max_factor(double deviation);
/// The deviation, at most 2, with that largest factor.
double deviation_of(double largest);

/// Log-normal noise with the relative deviations of the material, cut at three of them; smooth over
/// `size`, or each particle on its own where that is 0.
/// @param y       m, in a frame that moves with the snow
/// @param key     of the piece of snow
/// @param number  of the particle in it, where each is on its own
Factors vary(const Variation& variation, std::uint64_t key, std::uint64_t number, const Vec3d& y);

}  // namespace neve::sim::shapes
