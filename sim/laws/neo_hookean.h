#pragma once
/// Compressible neo-Hookean, elastic:
///   psi = mu/2 (tr F^T F - 3) - mu ln J + lambda/2 (ln J)^2,  tau = mu (b - I) + lambda ln J I
///   D = mu (G b + G^T) + lambda (tr G I - ln J G^T)
/// The energy is infinite at J = 0; below that the logarithm is held, and the run is told.

#include "sim/laws/differential.h"
#include "sim/laws/hardening.h"
#ifndef NEVE_LANES_ALONE
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#endif

namespace neve::sim::laws::neo_hookean {

struct InLanes {
  static constexpr bool is_plastic = false;

  template <class V, class I>
  NEVE_INLINE static unsigned step(Record<V, I>& p, const MaterialConstants<ElementOf<V>>* table,
                                   bool, V& wave_modulus) {
    using Real = ElementOf<V>;
    MaterialLanes<V> m;
    take_lanes(p, table, m);
    const V J = determinant(m.F()), one = all<V>(1);
    V mu, lambda;
    m.harden(mu, lambda);
    const Sym3<V> b = left_cauchy_green(m.F());
    const V log_J = logarithm_lanes(larger_lanes(J, all<V>(Real(1e-6))));
    m.set_tau(add_identity(mu * add_identity(b, -one), lambda * log_J));
    m.wave_modulus() = mu * (row_sum_norm(b) + one) + lambda * (one + absolute_lanes(log_J));
    keep_stress(m, p, wave_modulus);
    return ~lane_bits(J > V{});
  }

  template <class V, class I>
  NEVE_INLINE static Elasticity<V> elasticity(const Record<V, I>& p,
                                              const MaterialConstants<ElementOf<V>>* table) {
    return hardened_elasticity(p, table, left_cauchy_green(p.F_E));
  }

  template <class V>
  NEVE_INLINE static void stress_change(const Elasticity<V>& e, const V* G, V* D) {
    using Real = ElementOf<V>;
    times(G, e.shape, D);
    // J^2 = det b; held where step() holds it.
    const V log_J =
        Real(0.5) * logarithm_lanes(larger_lanes(determinant(e.shape), all<V>(Real(1e-12))));
    for (int q = 0; q < 9; ++q) D[q] = e.V0_mu * D[q];
    add_volume_change(e.V0_mu - e.V0_lambda * log_J, e.V0_lambda * (G[0] + G[4] + G[8]), G, D);
  }
};

#ifndef NEVE_LANES_ALONE
inline double energy_density(const Material& m, const Mat3d& F_E, double J_P) {
  const Lame l = hardened(m, J_P);
  const double J = F_E.determinant();
  if (!(J > 0)) return std::numeric_limits<double>::infinity();
  const double log_J = std::log(J);
  return 0.5 * l.mu * (F_E.squaredNorm() - 3) - l.mu * log_J + 0.5 * l.lambda * log_J * log_J;
}

inline Mat3d first_piola(const Material& m, const Mat3d& F_E, double J_P) {
  const Lame l = hardened(m, J_P);
  const Mat3d inverse_transposed = F_E.inverse().transpose();
  return l.mu * (F_E - inverse_transposed) +
         l.lambda * std::log(F_E.determinant()) * inverse_transposed;
}

/// Returns the modulus of the largest stretch s, Pa: mu s^2 + mu + lambda (1 - log J), from the
/// second derivative of the energy along a plane wave. Below 0 all but mu s^2 counts as 0.
inline double wave_modulus(const Material& m, const Mat3d& F_E, double J_P) {
  const Lame l = hardened(m, J_P);
  const double s = F_E.jacobiSvd().singularValues()[0];
  const double log_J = std::log(std::max(F_E.determinant(), 1e-6));
  return l.mu * s * s + std::max(l.mu + l.lambda * (1 - log_J), 0.0);
}

inline constexpr Parameter parameters[] = {parameter::hardening};

inline constexpr Law law{.kind = "elastic",
                         .hardens = true,
                         .is_plastic = InLanes::is_plastic,
                         .parameters = parameters,
                         .rate = &parameters[0],
                         .caption = "elastic, hardening {}",
                         .energy_density = energy_density,
                         .first_piola = first_piola,
                         .wave_modulus = wave_modulus,
                         .scale = scale_of_thresholds};
#endif

}  // namespace neve::sim::laws::neo_hookean
