#pragma once
/// The artificial viscosity of snow in numbers: see sim/kernels/shock.h for what it is.

namespace neve::sim::health {

/// c_q^2 and c_l of shock_viscosity = 1.
inline constexpr double shock_quadratic = 1.5 * 1.5, shock_linear = 0.5;

/// Returns the shock pressure, Pa, for a rate of compression D (1/s) and a speed of sound c.
/// @param share  shock_viscosity
inline double shock_pressure(double share, double density, double h, double D, double c) {
  return share * density * h * (shock_quadratic * h * D * D + shock_linear * c * D);
}

}  // namespace neve::sim::health
