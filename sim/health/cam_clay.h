#pragma once
/// Cam clay in numbers: see sim/kernels/cam_clay.h for what it is.

#include "sim/types/material.h"
#include "sim/types/math.h"

namespace neve::sim::health::cam_clay {

/// M of a friction angle: 6 sin phi / (3 - sin phi), the slope q/p of the critical state.
double critical_slope(double friction_angle);
/// The inverse, degrees.
double friction_angle(double critical_slope);

/// Pa
double bulk_modulus(const Material& material);

/// alpha at J_P = 1: where p0 is the consolidation pressure of the start.
double alpha0(const Material& material);

/// Pa: where the snow yields under pressure, packed to J_P.
double p0(const Material& material, double J_P);

/// r of a state: 1 on the yield surface, below inside, as the return measures it.
double nearness_to_yield(const Material& material, const Mat3d& F_E, double J_P);

/// J/m3
double energy_density(const Material& material, const Mat3d& F_E);
/// Pa
Mat3d first_piola(const Material& material, const Mat3d& F_E);
/// rho0 c^2, Pa
double wave_modulus(const Material& material, const Mat3d& F_E);

/// States that the surface of p0 holds.
struct Limits {
  double pressure;      ///< Pa, largest
  double tension;       ///< Pa
  double deviator;      ///< Pa, largest q
  double min_J, max_J;  ///< of F_E; min_J is 0 where p0 is beyond any pressure
};
Limits limits(const Material& material, double J_P);

}  // namespace neve::sim::health::cam_clay
