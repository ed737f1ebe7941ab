#pragma once
/// Sand in numbers: see sim/kernels/sand.h for what it is.

#include "sim/types/material.h"
#include "sim/types/math.h"

namespace neve::sim::health::sand {

/// J/m3
double energy_density(const Material& material, const Mat3d& F_E);
/// Pa
Mat3d first_piola(const Material& material, const Mat3d& F_E);
/// rho0 c^2, Pa
double wave_modulus(const Material& material, const Mat3d& F_E);
/// q over M p: 1 where the sand slides; infinite without pressure.
double nearness_to_yield(const Material& material, const Mat3d& F_E);

}  // namespace neve::sim::health::sand
