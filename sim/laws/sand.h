#pragma once
/// Sand: a cone of friction, and the volume that it gained while it was apart.
///
/// With stretches s of F_E = U diag(s) V^T and e = ln s (Hencky):
///   psi = mu e.e + lambda/2 (sum e)^2,   tau = U diag(2 mu e + lambda sum e) U^T
/// and alpha = ln J_P >= 0 the volume gained, which has to be given back before sand bears
/// pressure:
///   e_hat = e + alpha/3,  t = sum e_hat,  d = e_hat - t/3,
///   gamma = |d| + (3 lambda + 2 mu)/(2 mu) a t
///
///   t >= 0     grains do not touch:         e' = 0
///   gamma > 0  beyond the cone q = M p:     e' = e_hat - gamma d/|d|
///   else                                    e' = e_hat
///
/// with a = sqrt(2/3) M/3, and alpha grows by sum e - sum e'.
/// Sources: Klar et al. 2016, Drucker-Prager elastoplasticity for sand animation, ACM Transactions
/// on Graphics 35 (cone); Tampubolon et al. 2017, Multi-species simulation of porous sand and water
/// mixtures, ACM Transactions on Graphics 36 (volume correction).

#include "sim/laws/differential.h"
#ifndef NEVE_LANES_ALONE
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/laws/friction.h"
#include "sim/laws/law.h"
#endif

namespace neve::sim::laws::sand {

/// M, the only number of this law in MaterialConstants::own.
inline constexpr int constant_M = 0;

/// Squares of stretches count as at least this: e = ln s has to end somewhere.
inline constexpr double min_stretch_squared = 1e-8;

template <class V>
struct SandLanes {
  V mu, lambda;  ///< Pa
  V cone;        ///< a
  V max_J_P;
};

template <class V, class I>
NEVE_INLINE SandLanes<V> take_sand(const Record<V, I>& p,
                                   const MaterialConstants<ElementOf<V>>* table) {
  SandLanes<V> m;
  const I material = p.material();
  for (int l = 0; l < lane_count<V>; ++l) {
    const MaterialConstants<ElementOf<V>>& row = table[material[l]];
    m.mu[l] = row.mu0, m.lambda[l] = row.lambda0;
    m.cone[l] = row.own[constant_M] * ElementOf<V>(0.81649658092772603 / 3),
    m.max_J_P[l] = row.max_J_P;
  }
  m.mu *= p.stiffness, m.lambda *= p.stiffness, m.cone *= p.threshold;
  return m;
}

/// Axes and squared stretches of F; U row by row.
template <class V>
struct SandAxes {
  V U[9], l[3];
};
template <class V>
NEVE_INLINE SandAxes<V> axes_of(const V* F) {
  using Real = ElementOf<V>;
  Sym3<V> b = left_cauchy_green(F);
  const MaskOf<V> is_tame =
      (determinant(F) > V{}) & has_eigenvalues_within(b, all<V>(Real(0.1)), all<V>(Real(4)));
  SymmetricEigen<V> eigen;
  symmetric_eigen<1, sizeof(Real) == 4 ? 3 : 5>(&b, &eigen);
  SandAxes<V> out;
  for (int k = 0; k < 3; ++k) out.l[k] = eigen.l[k];
  for (int k = 0; k < 9; ++k) out.U[k] = eigen.U[k];
  if (any_lane(~is_tame)) {
    const SignedSvd<V> svd = signed_svd_lanes(F);
    for (int k = 0; k < 3; ++k) out.l[k] = is_tame ? out.l[k] : svd.s[k] * svd.s[k];
    for (int k = 0; k < 9; ++k) out.U[k] = is_tame ? out.U[k] : svd.U[k];
  }
  for (int k = 0; k < 3; ++k) out.l[k] = larger_lanes(out.l[k], all<V>(Real(min_stretch_squared)));
  return out;
}

/// U diag(d) U^T
template <class V>
NEVE_INLINE Sym3<V> in_axes(const V* U, const V* d) {
  Sym3<V> out{};
  for (int i = 0; i < 3; ++i) {
    const V x = U[i], y = U[3 + i], z = U[6 + i], dx = d[i] * x, dy = d[i] * y;
    out = {fused(dx, x, out.xx), fused(dy, y, out.yy), fused(d[i] * z, z, out.zz),
           fused(dx, y, out.xy), fused(dx, z, out.xz), fused(dy, z, out.yz)};
  }
  return out;
}

/// Step 7 and stress of a batch.
/// @param is_projected  false leaves F_E and J_P as they are
/// @param wave_modulus  out: lambda + 2 mu and the largest compressive tau, Pa
/// @return lanes with det F_E <= 0 before
template <class V, class I>
NEVE_INLINE unsigned take_step(Record<V, I>& p, const MaterialConstants<ElementOf<V>>* table,
                               bool is_projected, V& wave_modulus) {
  using Real = ElementOf<V>;
  const SandLanes<V> m = take_sand(p, table);
  const MaskOf<V> is_positive = determinant(p.F_E) > V{};
  // A body turned inside out is mirrored back.
  V F[9];
  for (int q = 0; q < 9; ++q) F[q] = q % 3 == 2 ? (is_positive ? p.F_E[q] : -p.F_E[q]) : p.F_E[q];
  const SandAxes<V> axes = axes_of(F);
  V e[3];
  for (int k = 0; k < 3; ++k) e[k] = Real(0.5) * logarithm_lanes(axes.l[k]);
  if (is_projected) {
    // Packed snow that became sand has no volume to give back: it would be pressed from inside.
    const V loose = larger_lanes(p.J_P, all<V>(1));
    const V before = e[0] + e[1] + e[2], gained = logarithm_lanes(loose);
    const V third = Real(1.0 / 3) * gained, t = before + gained, mean = Real(1.0 / 3) * t;
    V d[3];
    for (int k = 0; k < 3; ++k) d[k] = e[k] + third - mean;
    const V size = square_root_lanes(dot3(d, d));
    const V gamma = fused((Real(1.5) * m.lambda + m.mu) / m.mu * t, m.cone, size);
    const MaskOf<V> is_apart = t >= V{}, slides = gamma > V{};
    const V kept = slides ? all<V>(1) - gamma / (size > V{} ? size : all<V>(1)) : all<V>(1);
    const MaskOf<V> is_changed = is_apart | slides | (gained != V{}) | ~is_positive;
    const MaskOf<V> is_crushed = smaller_lanes(axes.l[0], smaller_lanes(axes.l[1], axes.l[2])) <=
                                 all<V>(Real(min_stretch_squared));
    V s[3], change[3];
    for (int k = 0; k < 3; ++k) {
      const V returned = is_apart ? V{} : fused(kept, d[k], mean);
      const V by = is_changed ? returned - e[k] : V{};
      e[k] = is_changed ? returned : e[k];
      s[k] = exponential_lanes(e[k]);
      change[k] = exponential_lanes(by);
    }
    V J_P = is_apart ? loose * exponential_lanes(before) : all<V>(1);
    J_P = J_P > m.max_J_P ? m.max_J_P : J_P;
    p.J_P = (is_apart | slides | (gained != V{})) ? J_P : p.J_P;
    const Sym3<V> A = in_axes(axes.U, change);
    for (int c = 0; c < 3; ++c) {
      const V x = F[c], y = F[3 + c], z = F[6 + c];
      const V moved[3] = {fused(A.xx, x, fused(A.xy, y, A.xz * z)),
                          fused(A.xy, x, fused(A.yy, y, A.yz * z)),
                          fused(A.xz, x, fused(A.yz, y, A.zz * z))};
      for (int row = 0; row < 3; ++row) {
        const V found = is_crushed ? axes.U[3 * row + c] * s[c] : moved[row];
        p.F_E[3 * row + c] = is_changed ? found : p.F_E[3 * row + c];
      }
    }
  }
  V tau[3], largest{};
  for (int k = 0; k < 3; ++k) {
    tau[k] = fused(Real(2) * m.mu, e[k], m.lambda * (e[0] + e[1] + e[2]));
    largest = larger_lanes(largest, -tau[k]);
  }
  const Sym3<V> stress = in_axes(axes.U, tau);
  p.tau[0] = stress.xx, p.tau[1] = stress.yy, p.tau[2] = stress.zz;
  p.tau[3] = stress.xy, p.tau[4] = stress.xz, p.tau[5] = stress.yz;
  wave_modulus = fused(all<V>(2), m.mu, m.lambda) + largest;
  return lane_bits(~is_positive);
}

/// ln(a/b)/(a - b) for positive numbers.
template <class V>
NEVE_INLINE V logarithmic_slope(const V& a, const V& b) {
  using Real = ElementOf<V>;
  const V sum = a + b, z = (a - b) / sum, z2 = z * z;
  V series = all<V>(Real(2.0 / 17));
  for (int k = 15; k >= 1; k -= 2) series = fused(series, z2, all<V>(Real(2.0 / k)));
  const MaskOf<V> is_close = absolute_lanes(z) < all<V>(Real(0.1));
  const V apart = is_close ? all<V>(1) : a - b;
  return is_close ? series / sum : (logarithm_lanes(a) - logarithm_lanes(b)) / apart;
}

/// V0 D for the gradient G, as stress_change of the other laws, from b alone: in the axes of b,
/// dtau_ii = 2 mu G_ii + lambda tr G, dtau_ij = mu ln(l_i/l_j)/(l_i - l_j) (l_j G_ij + l_i G_ji),
/// D = dtau - tau G^T.
template <class V>
NEVE_INLINE void change_in_axes(const Sym3<V>& shape, const V& V0_mu, const V& V0_lambda,
                                const V* G, V* D) {
  using Real = ElementOf<V>;
  Sym3<V> b = shape;
  SymmetricEigen<V> eigen;
  symmetric_eigen<1, sizeof(Real) == 4 ? 4 : 6>(&b, &eigen);
  const V* U = eigen.U;
  V l[3], e[3];
  for (int k = 0; k < 3; ++k) {
    l[k] = larger_lanes(eigen.l[k], all<V>(Real(min_stretch_squared)));
    e[k] = Real(0.5) * logarithm_lanes(l[k]);
  }
  const V volume = e[0] + e[1] + e[2], trace = G[0] + G[4] + G[8];
  V half[9], g[9], d[9];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      half[3 * i + j] =
          fused(G[3 * i], U[j], fused(G[3 * i + 1], U[3 + j], G[3 * i + 2] * U[6 + j]));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      g[3 * i + j] = fused(U[i], half[j], fused(U[3 + i], half[3 + j], U[6 + i] * half[6 + j]));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const V tau = fused(Real(2) * V0_mu, e[i], V0_lambda * volume);
      V change = fused(Real(2) * V0_mu, g[3 * i + j], V0_lambda * trace);
      if (i != j)
        change =
            V0_mu * logarithmic_slope(l[i], l[j]) * fused(l[j], g[3 * i + j], l[i] * g[3 * j + i]);
      d[3 * i + j] = fused_negative(tau, g[3 * j + i], change);
    }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      half[3 * i + j] =
          fused(d[3 * i], U[3 * j], fused(d[3 * i + 1], U[3 * j + 1], d[3 * i + 2] * U[3 * j + 2]));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      D[3 * i + j] =
          fused(U[3 * i], half[j], fused(U[3 * i + 1], half[3 + j], U[3 * i + 2] * half[6 + j]));
}

struct InLanes {
  static constexpr bool is_plastic = true;

  template <class V, class I>
  NEVE_INLINE static unsigned step(Record<V, I>& p, const MaterialConstants<ElementOf<V>>* table,
                                   bool is_projected, V& wave_modulus) {
    return take_step(p, table, is_projected, wave_modulus);
  }

  template <class V, class I>
  NEVE_INLINE static Elasticity<V> elasticity(const Record<V, I>& p,
                                              const MaterialConstants<ElementOf<V>>* table) {
    const SandLanes<V> m = take_sand(p, table);
    return {left_cauchy_green(p.F_E), p.V0 * m.mu, p.V0 * m.lambda};
  }

  template <class V>
  NEVE_INLINE static void stress_change(const Elasticity<V>& e, const V* G, V* D) {
    change_in_axes(e.shape, e.V0_mu, e.V0_lambda, G, D);
  }
};

#ifndef NEVE_LANES_ALONE
/// Logarithms of the stretches, axes, and the principal Kirchhoff stress.
struct Hencky {
  Vec3d e, tau;
  Mat3d U;

  Hencky(const Material& m, const Mat3d& F_E) {
    const Eigen::SelfAdjointEigenSolver<Mat3d> eigen(F_E * F_E.transpose());
    U = eigen.eigenvectors();
    e = 0.5 * eigen.eigenvalues().array().max(min_stretch_squared).log();
    const Lame l = lame(m.youngs_modulus, m.poisson_ratio);
    tau = 2 * l.mu * e + l.lambda * e.sum() * Vec3d::Ones();
  }
};

inline double energy_density(const Material& m, const Mat3d& F_E, double = 1) {
  const Lame l = lame(m.youngs_modulus, m.poisson_ratio);
  const Vec3d e = Hencky(m, F_E).e;
  return l.mu * e.squaredNorm() + 0.5 * l.lambda * e.sum() * e.sum();
}

inline Mat3d first_piola(const Material& m, const Mat3d& F_E, double = 1) {
  const Hencky h(m, F_E);
  return h.U * h.tau.asDiagonal() * h.U.transpose() * F_E.inverse().transpose();
}

inline double wave_modulus(const Material& m, const Mat3d& F_E, double = 1) {
  const Lame l = lame(m.youngs_modulus, m.poisson_ratio);
  return l.lambda + 2 * l.mu + std::max(0.0, -Hencky(m, F_E).tau.minCoeff());
}

/// q over M p: 1 where the sand slides, and without pressure.
inline double nearness_to_yield(const Material& m, const Mat3d& F_E, double = 1) {
  const Vec3d tau = Hencky(m, F_E).tau;
  const double p = -tau.mean(), q = std::sqrt(1.5) * (tau.array() + p).matrix().norm();
  const double slope = m.strength * critical_slope(m.friction_angle);
  return p > 0 ? q / (slope * p) : 1;
}

inline void constants(const Material& m, double (&own)[own_constants]) {
  own[constant_M] = critical_slope(m.friction_angle);
}

/// The surface of sand begins at no stress.
inline Scale scale(const Material& m) {
  constexpr double any = std::numeric_limits<double>::infinity();
  return {any, any, 3 * std::max(m.critical_compression, m.critical_stretch)};
}

/// Grains that are apart bear nothing, those that slide are on the cone, and the volume that they
/// gained is kept until it is given back.
inline void test_yield(const Material& m, const YieldStep& step, std::vector<Claim>& claims) {
  const Mat3d &F = step.F_E, &found = step.F_E_after;
  if (std::abs(F.determinant()) * step.J_P >= 1) {
    claims.push_back({"strain of grains that are apart",
                      (found * found.transpose() - Mat3d::Identity()).cwiseAbs().maxCoeff(),
                      rounding});
    return;
  }
  claims.push_back({"volume gained by grains that press", step.J_P_after - 1, rounding});
  const double near = nearness_to_yield(m, found);
  constexpr Tolerance also_where_little_presses{on_surfaces.single, on_surfaces.single};
  claims.push_back(
      {"friction beyond the cone", std::max(near - 1, 0.0), also_where_little_presses});
  if (F.determinant() > 0 && nearness_to_yield(m, F) > 1.5)
    claims.push_back({"distance to the cone", near - 1, on_surfaces});
}
inline constexpr SelfTest self_test{
    "bears nothing apart, slides on its cone, gives back the volume it gained", 1.05, test_yield};

inline constexpr Parameter parameters[] = {parameter::friction_angle};

inline constexpr Law law{.kind = "grains",
                         .is_plastic = InLanes::is_plastic,
                         .is_granular = true,
                         .parameters = parameters,
                         .caption = "sand, {} degrees",
                         .energy_density = energy_density,
                         .first_piola = first_piola,
                         .wave_modulus = wave_modulus,
                         .nearness_to_yield = nearness_to_yield,
                         .constants = constants,
                         .scale = scale,
                         .self_test = &self_test};
#endif

}  // namespace neve::sim::laws::sand
