#include "sim/material.h"

#include <cmath>

namespace neve::sim {

Lame lame(double youngs_modulus, double poisson_ratio) {
  const double E = youngs_modulus, nu = poisson_ratio;
  return {E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))};
}

double sound_speed(const Material& material) {
  const Lame l = lame(material.youngs_modulus, material.poisson_ratio);
  return std::sqrt((l.lambda + 2 * l.mu) / material.density);
}

}  // namespace neve::sim
