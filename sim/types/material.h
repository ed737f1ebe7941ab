#pragma once
/// Constitutive parameters. The defaults are the paper's snow.

#include <string>

namespace neve::sim {

/// snow: the paper's. cam_clay and sand: the files of these names in sim/kernels. The others are
/// elastic.
enum class Model { snow, corotated, neo_hookean, cam_clay, sand };

/// Laws that pack, tear and can be packed again.
constexpr bool is_snow(Model model) {
  return model == Model::snow || model == Model::cam_clay;
}
/// Laws whose moduli grow by e^(xi (1 - J_P)) as they pack.
constexpr bool hardens(Model model) {
  return model != Model::cam_clay && model != Model::sand;
}

/// Variation between particles: relative standard deviations.
struct Variation {
  double density = 0, youngs_modulus = 0;
  double thresholds = 0;  ///< theta_c and theta_s together; p0 of cam clay; friction of sand
  double size = 0.05;     ///< m, of stiffer and softer lumps; 0: each particle on its own
};

struct Material {
  std::string name = "snow";
  Model model = Model::snow;
  double density = 400.0;               ///< rho, kg/m3
  double youngs_modulus = 1.4e5;        ///< E0, Pa
  double poisson_ratio = 0.2;           ///< nu
  double hardening = 10.0;              ///< xi
  double critical_compression = 0.025;  ///< theta_c
  double critical_stretch = 0.0075;     ///< theta_s
  /// Cam clay: its yield surface is an ellipse over the pressure, from -beta p0 to p0.
  double friction_angle = 39;            ///< degrees, of the critical state (M = 1.6), and of sand
  double cohesion = 0.4;                 ///< beta
  double consolidation_pressure = 4500;  ///< p0 of the start, Pa
  double consolidation_hardening = 1;    ///< xi of p0
  double strength = 1;                   ///< factor of a particle on p0, or friction; no scene key
  /// Range of J_P, and the largest factor of hardening. The paper bounds none of them. Beyond 20
  /// snow is single particles, and their J_P only says for how long they have been alone.
  double min_J_P = 0.1, max_J_P = 20, max_hardening = 1e4;
  Variation variation;
  /// Project neo-Hookean F_E as the snow's. For comparison with solvers that let any model yield;
  /// no scene key. Such a run takes the staged driver and has no other material.
  bool yields = false;
};

/// Of ice without air, kg/m3: no snow is denser.
inline constexpr double ice_density = 917;

/// Lame parameters at rest: mu = E/(2(1+nu)), lambda = E nu/((1+nu)(1-2nu)), Pa.
struct Lame {
  double mu, lambda;
};
Lame lame(double youngs_modulus, double poisson_ratio);

/// The material of a particle that has factors on its stiffness and its thresholds.
Material scaled(const Material& material, double stiffness, double threshold);

/// sqrt((lambda + 2 mu)/rho) of undeformed material, m/s.
double sound_speed(const Material& material);

}  // namespace neve::sim
