#pragma once
/// Laws whose moduli grow as they pack, and shrink as they loosen:
///   mu = mu0 e^(xi (1 - J_P)) and lambda likewise (the paper, equation 2)
/// with the factor held between min_hardening and the material's max_hardening. Stress is the
/// Kirchhoff stress tau = P F_E^T: the force of a particle is -V0 tau grad_w, J cancels.

#include "sim/kernels/decompose.h"
#include "sim/kernels/law.h"
#include "sim/kernels/particle_lanes.h"
#ifndef NEVE_LANES_ALONE
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "sim/laws/law.h"
#endif

namespace neve::sim::laws {

using namespace kernels;

/// Torn snow is at least this stiff, relative to snow at rest. Its forces are far below the
/// rounding of its weight, but no product of them is so small that processors slow down
/// (denormals).
inline constexpr double min_hardening = 1e-12;

/// Inputs and results of a material for particles in lanes: plain words, so that particles can be
/// packed into full lanes.
template <class V>
struct MaterialLanes {
  using Real = ElementOf<V>;
  enum Word {
    word_F = 0,
    word_J_P = 9,
    word_wave_modulus = 10,
    word_tau = 11,  // 10 to 16 are results
    word_mu = 17,
    word_lambda,
    word_xi,
    word_lo,
    word_hi,
    word_min_J_P,
    word_max_J_P,
    word_max_hardening,
    words
  };
  V word[words];

  NEVE_INLINE V* F() { return word + word_F; }
  NEVE_INLINE V& J_P() { return word[word_J_P]; }
  /// rho0 c^2 of the fastest elastic wave, Pa
  NEVE_INLINE V& wave_modulus() { return word[word_wave_modulus]; }
  NEVE_INLINE V lo() const { return word[word_lo]; }
  NEVE_INLINE V hi() const { return word[word_hi]; }

  NEVE_INLINE void set_tau(const Sym3<V>& t) {
    V* tau = word + word_tau;
    tau[0] = t.xx, tau[1] = t.yy, tau[2] = t.zz, tau[3] = t.xy, tau[4] = t.xz, tau[5] = t.yz;
  }

  /// Moduli after hardening.
  NEVE_INLINE void harden(V& mu, V& lambda) {
    const V grown = exponential_lanes(word[word_xi] * (Real(1) - J_P()));
    const V hardening =
        smaller_lanes(larger_lanes(grown, all<V>(Real(min_hardening))), word[word_max_hardening]);
    mu = hardening * word[word_mu];
    lambda = hardening * word[word_lambda];
  }
};

template <class V, class I>
NEVE_INLINE void take_lanes(const Record<V, I>& p, const MaterialConstants<ElementOf<V>>* table,
                            MaterialLanes<V>& m) {
  using Real = ElementOf<V>;
  using M = MaterialLanes<V>;
  for (int q = 0; q < 9; ++q) m.F()[q] = p.F_E[q];
  m.J_P() = p.J_P;
  constexpr int constants = 8;
  V k[constants];
  const I material = p.material();
  if (!any_lane(material != all<I>(material[0]))) {
    const MaterialConstants<Real>& row = table[material[0]];
    const Real constant[constants] = {row.mu0,     row.lambda0, row.xi,      row.theta_c,
                                      row.theta_s, row.min_J_P, row.max_J_P, row.max_hardening};
    for (int q = 0; q < constants; ++q) k[q] = all<V>(constant[q]);
  } else {
    for (int l = 0; l < lane_count<V>; ++l) {
      const MaterialConstants<Real>& row = table[material[l]];
      k[0][l] = row.mu0, k[1][l] = row.lambda0, k[2][l] = row.xi;
      k[3][l] = row.theta_c, k[4][l] = row.theta_s;
      k[5][l] = row.min_J_P, k[6][l] = row.max_J_P, k[7][l] = row.max_hardening;
    }
  }
  m.word[M::word_mu] = p.stiffness * k[0];
  m.word[M::word_lambda] = p.stiffness * k[1];
  m.word[M::word_xi] = k[2];
  m.word[M::word_lo] = Real(1) - k[3] * p.threshold;
  m.word[M::word_hi] = Real(1) + k[4] * p.threshold;
  m.word[M::word_min_J_P] = k[5];
  m.word[M::word_max_J_P] = k[6];
  m.word[M::word_max_hardening] = k[7];
}

/// Returns what a solve keeps of a particle. @param shape  what its law keeps of F_E
template <class V, class I>
NEVE_INLINE Elasticity<V> hardened_elasticity(const Record<V, I>& p,
                                              const MaterialConstants<ElementOf<V>>* table,
                                              const Sym3<V>& shape) {
  MaterialLanes<V> m;
  take_lanes(p, table, m);
  V mu, lambda;
  m.harden(mu, lambda);
  return {shape, p.V0 * mu, p.V0 * lambda};
}

/// A batch takes its stress.
template <class V, class I>
NEVE_INLINE void keep_stress(MaterialLanes<V>& m, Record<V, I>& p, V& wave_modulus) {
  for (int q = 0; q < 6; ++q) p.tau[q] = m.word[MaterialLanes<V>::word_tau + q];
  wave_modulus = m.wave_modulus();
}

#ifndef NEVE_LANES_ALONE
/// Returns the stiffness over that at rest.
inline double hardening_factor(const Material& material, double J_P) {
  return std::clamp(std::exp(material.hardening * (1 - J_P)), min_hardening,
                    material.max_hardening);
}

/// Moduli after hardening, Pa.
inline Lame hardened(const Material& material, double J_P) {
  const Lame l = lame(material.youngs_modulus, material.poisson_ratio);
  const double factor = hardening_factor(material, J_P);
  return {l.mu * factor, l.lambda * factor};
}

/// Returns the wave modulus of the largest stretch, Pa.
inline double stretched_wave_modulus(const Material& m, const Mat3d& F_E, double J_P) {
  const Lame l = hardened(m, J_P);
  const double stretch = F_E.jacobiSvd().singularValues()[0], J = F_E.determinant();
  return 2 * l.mu * stretch * stretch + l.lambda * J * J;
}

/// Compression by theta_c in each direction, shear by both thresholds: the elastic limit of
/// undeformed snow, which elastic laws take, too. J_E = (1 + theta)^3.
inline Scale scale_of_thresholds(const Material& m) {
  const Lame l = lame(m.youngs_modulus, m.poisson_ratio);
  const double pressed = std::clamp(m.critical_compression, 0.001, 0.5);
  const double sheared = std::clamp(m.critical_compression + m.critical_stretch, 0.001, 0.5);
  return {(3 * l.lambda + 2 * l.mu) * pressed, 2 * l.mu * sheared,
          std::max(3 * m.critical_compression, 3 * m.critical_stretch)};
}

namespace parameter {
inline constexpr Parameter hardening{.key = "hardening",
                                     .member = &Material::hardening,
                                     .bounds = {0, 100},
                                     .help = "The paper's xi: rate at which packed snow stiffens."};
}
#endif

}  // namespace neve::sim::laws
