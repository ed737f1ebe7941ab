#pragma once
/// Stress and plastic projection of one particle, for kernels.
///
/// All models take mu = mu0 e^(xi (1 - J_P)) and lambda likewise (the paper, equation 2). Stress is
/// the Kirchhoff stress tau = P F_E^T: the force of a particle is -V0 tau grad_w, J cancels.

#include "sim/decompose.h"
#include "sim/particles.h"

namespace neve::sim {

enum class ModelKind : std::uint8_t { snow = 0, corotated = 1, neo_hookean = 2 };
inline constexpr int model_count = 3;

/// A row of the material table as kernels see it.
template <class Real>
struct MaterialConstants {
  Real mu0, lambda0;  ///< Pa
  Real xi;
  Real theta_c, theta_s;
};

/// What the update of one particle found, besides the new state in the record.
template <class Real>
struct MaterialResponse {
  Real wave_modulus;  ///< rho0 c^2 of the fastest elastic wave, Pa
  bool is_inverted;   ///< trial det F_E <= 0
};

template <class Real>
NEVE_INLINE void store(const Sym3<Real>& s, Real* tau) {
  tau[0] = s.xx, tau[1] = s.yy, tau[2] = s.zz, tau[3] = s.xy, tau[4] = s.xz, tau[5] = s.yz;
}

/// sum_i d[i] u_i u_i^T with u_i the columns of U.
template <class Real>
NEVE_INLINE Sym3<Real> from_principal(const Real* U, const Real* d) {
  Sym3<Real> a{};
  for (int i = 0; i < 3; ++i) {
    const Real x = U[i], y = U[3 + i], z = U[6 + i];
    a.xx += d[i] * x * x, a.yy += d[i] * y * y, a.zz += d[i] * z * z;
    a.xy += d[i] * x * y, a.xz += d[i] * x * z, a.yz += d[i] * y * z;
  }
  return a;
}

/// Stretches inside which sqrt(b) is taken by Newton's iteration instead of a decomposition.
inline constexpr double series_min_stretch = 0.7, series_max_stretch = 1.35;

/// All singular values of F strictly inside [lo, hi], from b = F F^T without its eigenvalues.
template <class Real>
NEVE_INLINE bool stretches_within(const Sym3<Real>& b, Real lo, Real hi) {
  return is_positive_definite(add_identity(b, -lo * lo)) &&
         is_positive_definite(add_identity(Real(-1) * b, hi * hi));
}

/// Fixed-corotated stress, with the projection of snow where `is_plastic`:
///   psi = mu |F_E - R|^2 + lambda/2 (J_E - 1)^2                          (the paper, equation 1)
///   tau = 2 mu (F_E - R) F_E^T + lambda (J_E - 1) J_E I
/// Singular values of the trial F_E are clamped to [1 - theta_c, 1 + theta_s]; what is cut off goes
/// into J_P (the paper, section 7, equations 11 and 12). F_E on entry is the trial value.
template <class Real>
NEVE_INLINE MaterialResponse<Real> update_corotated(Particle<Real>& p,
                                                    const MaterialConstants<Real>& k,
                                                    bool is_plastic) {
  const Real lo = Real(1) - k.theta_c * p.threshold, hi = Real(1) + k.theta_s * p.threshold;
  const Real J = determinant(p.F_E);
  const Sym3<Real> b = left_cauchy_green(p.F_E);
  Real min_stretch = Real(series_min_stretch), max_stretch = Real(series_max_stretch);
  if (is_plastic) {
    min_stretch = larger(min_stretch, lo);
    max_stretch = smaller(max_stretch, hi);
  }
  // Elastic: nothing is projected, F_E and J_P keep their bits.
  if (J > Real(0) && stretches_within(b, min_stretch, max_stretch)) {
    const Real hard = p.stiffness * exponential(k.xi * (Real(1) - p.J_P));
    const Real mu = hard * k.mu0, lambda = hard * k.lambda0;
    const Sym3<Real> e = add_identity(b, Real(-1));
    const Sym3<Real> deviation = e + Real(-1) * root_minus_identity(b);
    store(add_identity(Real(2) * mu * deviation, lambda * (J - Real(1)) * J), p.tau);
    return {Real(2) * mu * row_sum_norm(b) + lambda * J * J, false};
  }
  const SignedSvd<Real> svd = signed_svd(p.F_E);
  Real s[3] = {svd.s[0], svd.s[1], svd.s[2]};
  if (is_plastic) {
    Real cut = 1;
    for (int i = 0; i < 3; ++i) {
      s[i] = clamp_to(svd.s[i], lo, hi);
      cut *= svd.s[i] / s[i];
    }
    if (s[0] != svd.s[0] || s[1] != svd.s[1] || s[2] != svd.s[2]) {
      p.J_P *= cut;
      for (int a = 0; a < 3; ++a)
        for (int c = 0; c < 3; ++c)
          p.F_E[3 * a + c] = svd.U[3 * a] * s[0] * svd.V[3 * c] +
                             svd.U[3 * a + 1] * s[1] * svd.V[3 * c + 1] +
                             svd.U[3 * a + 2] * s[2] * svd.V[3 * c + 2];
    }
  }
  const Real hard = p.stiffness * exponential(k.xi * (Real(1) - p.J_P));
  const Real mu = hard * k.mu0, lambda = hard * k.lambda0;
  const Real J_E = s[0] * s[1] * s[2];
  Real d[3], largest = 0;
  for (int i = 0; i < 3; ++i) {
    d[i] = Real(2) * mu * (s[i] - Real(1)) * s[i] + lambda * (J_E - Real(1)) * J_E;
    largest = larger(largest, s[i] * s[i]);
  }
  store(from_principal(svd.U, d), p.tau);
  return {Real(2) * mu * largest + lambda * J_E * J_E, !(J > Real(0))};
}

/// Compressible neo-Hookean stress:
///   psi = mu/2 (tr F^T F - 3) - mu ln J + lambda/2 (ln J)^2,  tau = mu (b - I) + lambda ln J I.
/// The energy is infinite at J = 0; below that the logarithm is held, and the run is told.
template <class Real>
NEVE_INLINE MaterialResponse<Real> update_neo_hookean(Particle<Real>& p,
                                                      const MaterialConstants<Real>& k) {
  const Real J = determinant(p.F_E);
  const Real hard = p.stiffness * exponential(k.xi * (Real(1) - p.J_P));
  const Real mu = hard * k.mu0, lambda = hard * k.lambda0;
  const Sym3<Real> b = left_cauchy_green(p.F_E);
  const Real log_J = logarithm(larger(J, Real(1e-6)));
  store(add_identity(mu * add_identity(b, Real(-1)), lambda * log_J), p.tau);
  return {mu * (row_sum_norm(b) + Real(1)) + lambda * (Real(1) + absolute(log_J)), !(J > Real(0))};
}

/// Projects F_E (snow) and recomputes tau from it.
template <class Real>
NEVE_INLINE MaterialResponse<Real> update_material(Particle<Real>& p,
                                                   const MaterialConstants<Real>& k) {
  switch (static_cast<ModelKind>(p.model)) {
    case ModelKind::snow:
      return update_corotated(p, k, true);
    case ModelKind::corotated:
      return update_corotated(p, k, false);
    default:
      return update_neo_hookean(p, k);
  }
}

/// tau of the state as it is: at the start of a run and when a material changes. Nothing is
/// projected, so an elastic strain beyond the thresholds waits for the next step.
template <class Real>
NEVE_INLINE MaterialResponse<Real> refresh_stress(Particle<Real>& p,
                                                  const MaterialConstants<Real>& k) {
  if (static_cast<ModelKind>(p.model) == ModelKind::neo_hookean) return update_neo_hookean(p, k);
  return update_corotated(p, k, false);
}

}  // namespace neve::sim
