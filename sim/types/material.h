#pragma once
/// Constitutive parameters. The defaults are the paper's snow.

#include <array>
#include <string>

#include "sim/types/model.h"

namespace neve::sim {

/// Places for numbers that one law alone reads.
inline constexpr int own_numbers = 8;
/// Their defaults: sim/laws/law.cpp.
std::array<double, own_numbers> own_numbers_of_laws();

/// Variation between particles: relative standard deviations.
struct Variation {
  double density = 0, youngs_modulus = 0;
  double thresholds = 0;  ///< theta_c and theta_s together; of other laws their strength
  double size = 0.05;     ///< m, of stiffer and softer lumps; 0: each particle on its own
};

struct Material {
  std::string name = "snow";
  Model model{};
  double density = 400.0;                ///< rho, kg/m3
  double youngs_modulus = 1.4e5;         ///< E0, Pa
  double poisson_ratio = 0.2;            ///< nu
  double hardening = 10.0;               ///< xi
  double critical_compression = 0.025;   ///< theta_c
  double critical_stretch = 0.0075;      ///< theta_s
  double friction_angle = 39;            ///< degrees
  double consolidation_pressure = 4500;  ///< p0 of the start, Pa
  /// Numbers that no other law and no report reads: laws::Parameter says which law has which.
  std::array<double, own_numbers> own = own_numbers_of_laws();
  double strength = 1;  ///< factor of a particle on the surface of yield; no scene key
  /// Range of J_P, and the largest factor of hardening. The paper bounds none of them. Beyond 20
  /// snow is single particles, and their J_P only says for how long they have been alone.
  double min_J_P = 0.1, max_J_P = 20, max_hardening = 1e4;
  /// Share of its mass that snow which breaks fast sheds as dust while it is strained by 1; it
  /// keeps its mass.
  double dust = 0;
  Variation variation;
  /// Project the F_E of an elastic law as the paper's snow's. For comparison with solvers that let
  /// any model yield; no scene key. Such a run takes the staged driver and has no other material.
  bool yields = false;
};

/// Density of ice without air, kg/m3: no snow is denser.
inline constexpr double ice_density = 917;

/// Lame parameters at rest: mu = E/(2(1+nu)), lambda = E nu/((1+nu)(1-2nu)), Pa.
struct Lame {
  double mu, lambda;
};
Lame lame(double youngs_modulus, double poisson_ratio);
/// K = lambda + 2/3 mu, Pa.
double bulk_modulus(const Material& material);

/// The material of a particle that has factors on its stiffness and its thresholds.
Material scaled(const Material& material, double stiffness, double threshold);

/// sqrt((lambda + 2 mu)/rho) of undeformed material, m/s.
double sound_speed(const Material& material);

}  // namespace neve::sim
