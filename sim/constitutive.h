#pragma once
/// Stress and plastic projection, four particles of one model at a time.
///
/// All models take mu = mu0 e^(xi (1 - J_P)) and lambda likewise (the paper, equation 2). Stress is
/// the Kirchhoff stress tau = P F_E^T: the force of a particle is -V0 tau grad_w, J cancels.

#include "sim/decompose.h"
#include "sim/particles.h"

namespace neve::sim {

enum class ModelKind : std::uint8_t { snow = 0, corotated = 1, neo_hookean = 2 };

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
  bool is_inverted;   ///< det F_E <= 0 before projection
};

/// Stretches inside which sqrt(b) is taken by Newton's iteration instead of a decomposition.
inline constexpr double series_min_stretch = 0.7, series_max_stretch = 1.35;

inline constexpr int lane_count = 4;

/// Four particles with each quantity in a quad.
template <class Real>
struct MaterialLanes {
  using V = Quad<Real>;
  V F[9], J_P, stiffness;
  V mu0, lambda0, xi, lo, hi;  ///< moduli at rest; bounds of the stretches of snow
  V wave_modulus;
  Sym3<V> tau;

  /// Empty lanes repeat the first particle.
  NEVE_INLINE MaterialLanes(Particle<Real>* const* p, int count,
                            const MaterialConstants<Real>* materials) {
    for (int l = 0; l < lane_count; ++l) {
      const Particle<Real>& from = *p[l < count ? l : 0];
      const MaterialConstants<Real>& k = materials[from.material];
      for (int q = 0; q < 9; ++q) F[q][l] = from.F_E[q];
      J_P[l] = from.J_P;
      stiffness[l] = from.stiffness;
      mu0[l] = k.mu0;
      lambda0[l] = k.lambda0;
      xi[l] = k.xi;
      lo[l] = Real(1) - k.theta_c * from.threshold;
      hi[l] = Real(1) + k.theta_s * from.threshold;
    }
  }

  NEVE_INLINE V hardening() const { return stiffness * exponential_lanes(xi * (Real(1) - J_P)); }

  NEVE_INLINE void store_stress(int l, Particle<Real>& p) const {
    p.tau[0] = tau.xx[l], p.tau[1] = tau.yy[l], p.tau[2] = tau.zz[l];
    p.tau[3] = tau.xy[l], p.tau[4] = tau.xz[l], p.tau[5] = tau.yz[l];
  }
};

/// Fixed-corotated stress of particles whose stretches are small (and, for snow, inside the
/// thresholds), by the square root of b = F_E F_E^T:
///   psi = mu |F_E - R|^2 + lambda/2 (J_E - 1)^2                          (the paper, equation 1)
///   tau = 2 mu (F_E - R) F_E^T + lambda (J_E - 1) J_E I = 2 mu (b - sqrt(b)) + ...
/// F_E and J_P keep their bits. @return the lanes where this holds
template <class Real>
NEVE_INLINE MaskOf<Quad<Real>> corotated_near_identity(MaterialLanes<Real>& m, bool is_plastic) {
  using V = Quad<Real>;
  const V J = determinant(m.F), one = all<V>(1);
  const Sym3<V> b = left_cauchy_green(m.F);
  V lo = all<V>(series_min_stretch), hi = all<V>(series_max_stretch);
  if (is_plastic) {
    lo = larger_lanes(lo, m.lo);
    hi = smaller_lanes(hi, m.hi);
  }
  // All stretches inside (lo, hi) without an eigenvalue: b - lo^2 and hi^2 - b positive definite.
  const MaskOf<V> holds = (J > V{}) & is_positive_definite(add_identity(b, -lo * lo)) &
                          is_positive_definite(add_identity(-one * b, hi * hi));
  if (!any_lane(holds)) return holds;
  const V hard = m.hardening(), mu = hard * m.mu0, lambda = hard * m.lambda0;
  const Sym3<V> deviation = add_identity(b, -one) - root_minus_identity(b);
  m.tau = add_identity(Real(2) * mu * deviation, lambda * (J - one) * J);
  m.wave_modulus = Real(2) * mu * row_sum_norm(b) + lambda * J * J;
  return holds;
}

/// The same stress for any F_E, with the projection of snow where `is_plastic`: singular values are
/// clamped to [1 - theta_c, 1 + theta_s], what is cut off goes into J_P (the paper, section 7,
/// equations 11 and 12).
template <class Real>
NEVE_INLINE void corotated_by_decomposition(MaterialLanes<Real>& m, bool is_plastic) {
  using V = Quad<Real>;
  const SignedSvd<V> svd = signed_svd_lanes(m.F);
  const V one = all<V>(1);
  V s[3] = {svd.s[0], svd.s[1], svd.s[2]};
  if (is_plastic) {
    V cut = one;
    MaskOf<V> is_cut{};
    for (int i = 0; i < 3; ++i) {
      s[i] = smaller_lanes(larger_lanes(svd.s[i], m.lo), m.hi);
      cut *= svd.s[i] / s[i];
      is_cut |= s[i] != svd.s[i];
    }
    m.J_P = is_cut ? m.J_P * cut : m.J_P;
    for (int a = 0; a < 3; ++a)
      for (int c = 0; c < 3; ++c) {
        const V F = svd.U[3 * a] * s[0] * svd.V[3 * c] +
                    svd.U[3 * a + 1] * s[1] * svd.V[3 * c + 1] +
                    svd.U[3 * a + 2] * s[2] * svd.V[3 * c + 2];
        m.F[3 * a + c] = is_cut ? F : m.F[3 * a + c];
      }
  }
  const V hard = m.hardening(), mu = hard * m.mu0, lambda = hard * m.lambda0;
  const V J_E = s[0] * s[1] * s[2], pressure = lambda * (J_E - one) * J_E;
  Sym3<V> tau{};
  for (int i = 0; i < 3; ++i) {
    const V x = svd.U[i], y = svd.U[3 + i], z = svd.U[6 + i];
    const V d = Real(2) * mu * (s[i] - one) * s[i] + pressure;
    tau = tau + d * Sym3<V>{x * x, y * y, z * z, x * y, x * z, y * z};
  }
  m.tau = tau;
  const V largest = larger_lanes(s[0] * s[0], s[2] * s[2]);
  m.wave_modulus = Real(2) * mu * largest + lambda * J_E * J_E;
}

/// Compressible neo-Hookean stress:
///   psi = mu/2 (tr F^T F - 3) - mu ln J + lambda/2 (ln J)^2,  tau = mu (b - I) + lambda ln J I.
/// The energy is infinite at J = 0; below that the logarithm is held, and the run is told.
template <class Real>
NEVE_INLINE void neo_hookean(MaterialLanes<Real>& m) {
  using V = Quad<Real>;
  const V J = determinant(m.F), one = all<V>(1);
  const V hard = m.hardening(), mu = hard * m.mu0, lambda = hard * m.lambda0;
  const Sym3<V> b = left_cauchy_green(m.F);
  V log_J;
  for (int l = 0; l < lane_count; ++l) log_J[l] = logarithm(larger(J[l], Real(1e-6)));
  m.tau = add_identity(mu * add_identity(b, -one), lambda * log_J);
  m.wave_modulus = mu * (row_sum_norm(b) + one) + lambda * (one + absolute_lanes(log_J));
}

/// Projects F_E (snow) and recomputes tau from it, for any number of particles.
/// @param is_projected false leaves F_E and J_P as they are: stress of a state, at the start of a
/// run
template <class Real>
NEVE_INLINE void update_materials(Particle<Real>* const* particles, int count,
                                  const MaterialConstants<Real>* materials, bool is_projected,
                                  MaterialResponse<Real>* responses) {
  constexpr int most = 64;
  for (int begin = 0; begin < count;) {
    // A batch has one model; particles of a block are sorted by it.
    const auto model = static_cast<ModelKind>(particles[begin]->model);
    int end = begin;
    while (end < count && end - begin < most &&
           static_cast<ModelKind>(particles[end]->model) == model)
      ++end;
    const bool is_plastic = is_projected && model == ModelKind::snow;
    Particle<Real>* rest[most];
    MaterialResponse<Real>* rest_response[most];
    int rest_count = 0;
    for (int q = begin; q < end; q += lane_count) {
      const int lanes = smaller(lane_count, end - q);
      MaterialLanes<Real> m(particles + q, lanes, materials);
      const Quad<Real> J = determinant(m.F);
      MaskOf<Quad<Real>> is_done = Quad<Real>{} == Quad<Real>{};
      if (model == ModelKind::neo_hookean)
        neo_hookean(m);
      else
        is_done = corotated_near_identity(m, is_plastic);
      for (int l = 0; l < lanes; ++l) {
        responses[q + l].is_inverted = !(J[l] > Real(0));
        if (is_done[l]) {
          responses[q + l].wave_modulus = m.wave_modulus[l];
          m.store_stress(l, *particles[q + l]);
        } else {
          rest[rest_count] = particles[q + l];
          rest_response[rest_count++] = &responses[q + l];
        }
      }
    }
    // Those that yield or are far from the identity, packed into full batches.
    for (int q = 0; q < rest_count; q += lane_count) {
      const int lanes = smaller(lane_count, rest_count - q);
      MaterialLanes<Real> m(rest + q, lanes, materials);
      corotated_by_decomposition(m, is_plastic);
      for (int l = 0; l < lanes; ++l) {
        Particle<Real>& p = *rest[q + l];
        for (int k = 0; k < 9; ++k) p.F_E[k] = m.F[k][l];
        p.J_P = m.J_P[l];
        m.store_stress(l, p);
        rest_response[q + l]->wave_modulus = m.wave_modulus[l];
      }
    }
    begin = end;
  }
}

/// The same for one particle.
template <class Real>
inline MaterialResponse<Real> update_material(Particle<Real>& p, const MaterialConstants<Real>& k) {
  Particle<Real>* const one[] = {&p};
  MaterialResponse<Real> response;
  // The record says which row of a table is its own; here the table has one row.
  const std::uint16_t material = p.material;
  p.material = 0;
  update_materials(one, 1, &k, true, &response);
  p.material = material;
  return response;
}

}  // namespace neve::sim
