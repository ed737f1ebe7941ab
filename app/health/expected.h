#pragma once
/// The size of numbers in a healthy step, from the scene alone and the state that it starts from.

#include <string>

#include "app/scene/scene.h"
#include "sim/simulation.h"

namespace neve::app::health {

struct Expectation {
  scene::Range range;
  std::string why;
};

class Expected {
 public:
  Expected(const scene::Scene& scene, const sim::ParticleArrays& state, double dt);

  static double negligible_share();  ///< of rho h^3; lighter nodes have meaningless velocities
  double negligible_mass() const;    ///< kg, the same for the lightest material in use
  Expectation node_mass() const;     ///< kg
  Expectation speed() const;         ///< m/s
  Expectation momentum() const;      ///< kg m/s, of a node
  Expectation force() const;         ///< N, of a node
  /// m/s, v_free - v_old, of the lightest node that counts
  Expectation velocity_change() const;
  Expectation strain_rate() const;  ///< 1/s
  Expectation stress() const;       ///< Pa, Frobenius norm of tau; unlimited for elastic models
  Expectation stretch() const;      ///< singular values of F_E
  Expectation J_E() const;
  Expectation J_P() const;
  Expectation volume() const;  ///< m3, V0

 private:
  double stress_limit() const;
  void include_surface(const sim::Material& material);
  /// 1/h: the largest gradient of a weight over that weight, at a node that counts
  double steepest_gradient() const;

  const scene::Scene& scene_;
  double dt_, h_;
  double density_ = 0;   ///< kg/m3, of the heaviest material in use
  double lightest_ = 0;  ///< kg, of a particle
  double heaviest_ = 0;  ///< kg
  double min_J_P_ = 1;
  double compression_ = 0, stretch_ = 0;  ///< largest theta_c, theta_s in use, or as much
  double surface_stress_ = 0;             ///< Pa, largest that a yield surface holds
  double stiffest_ = 0;                   ///< Pa, largest mu and lambda together
  double loosest_ = 1;                    ///< largest max_J_P
  double hardened_ = 1;                   ///< largest factor of hardening at min_J_P_
  double lightest_density_ = 0;           ///< kg/m3
  bool is_bounded_ = true;                ///< all snow: elastic models have no limit
};

}  // namespace neve::app::health
