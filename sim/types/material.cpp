#include "sim/types/material.h"

#include <cmath>

namespace neve::sim {

Lame lame(double youngs_modulus, double poisson_ratio) {
  const double E = youngs_modulus, nu = poisson_ratio;
  return {E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))};
}

double bulk_modulus(const Material& material) {
  const Lame l = lame(material.youngs_modulus, material.poisson_ratio);
  return l.lambda + 2.0 / 3 * l.mu;
}

Material scaled(const Material& material, double stiffness, double threshold) {
  Material out = material;
  out.youngs_modulus *= stiffness;
  out.critical_compression *= threshold;
  out.critical_stretch *= threshold;
  out.consolidation_pressure *= stiffness;  // the same share of the moduli
  out.strength *= threshold;
  return out;
}

double sound_speed(const Material& material) {
  const Lame l = lame(material.youngs_modulus, material.poisson_ratio);
  return std::sqrt((l.lambda + 2 * l.mu) / material.density);
}

}  // namespace neve::sim
