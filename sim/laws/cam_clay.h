#pragma once
/// Cohesive Cam Clay: snow whose moduli stay and whose yield surface grows.
///
/// With b = F_E F_E^T, J = det F_E, b' = J^(-2/3) b and K = lambda + 2/3 mu:
///   psi = mu/2 (tr b' - 3) + K/2 ((J^2 - 1)/2 - ln J)
///   tau = mu dev b' + K/2 (J^2 - 1) I,   p = K/2 (1 - J^2),   q = sqrt(3/2) mu |dev b'|
///   y = (1 + 2 beta) q^2 + M^2 (p + beta p0)(p - p0) <= 0
///   p0 = K (1e-5 + sinh(xi max(-alpha, 0))),   alpha = alpha0 + ln J_P
/// An ellipse from -beta p0 to p0. Beyond its tips the state goes to the tip; else, by the rule of
/// flow,
///   radial     along the line to its centre, so that snow packs (and hardens) right of the centre
///              and opens (and softens) left of it: ln J_P is the whole history
///   isochoric  at the same p, and det F_E stays; it hardens or softens as if it had gone along
///              that line. J_P is this history, no longer det F_P
/// p0 is that from before the step. Sources: Gaume et al. 2018, Dynamic anticrack propagation in
/// snow, Nature Communications 9; Wolper et al. 2019, CD-MPM, ACM Transactions on Graphics 38
/// (surface, hardening, the isochoric rule). They keep tr b in the place of det F_E: then p drifts
/// in shear that keeps the volume.
///
/// The step needs b and no singular values: the return scales dev b', and the mean of b' follows
/// from det b' = 1. F_E is any F with F F^T = b.
///
/// D = a (G b + t G^T - 2/3 tr(G b) I - 2/3 tr G (b - t I)) + K J^2 tr G I - K/2 (J^2 - 1) G^T,
///   a = mu J^(-2/3), t = tr b/3, at a fixed plastic state.

#include "sim/laws/differential.h"
#ifndef NEVE_LANES_ALONE
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "sim/laws/friction.h"
#include "sim/laws/law.h"
#endif

namespace neve::sim::laws::cam_clay {

/// Places of the numbers of this law in MaterialConstants::own.
enum Constant { constant_M, constant_beta, constant_xi, constant_alpha0, constant_is_isochoric };

/// p0/K of snow without strength, so that the ellipse never shrinks to a point.
inline constexpr double min_strength = 1e-5;
/// xi |alpha| counts up to here: sinh of it is 2e8.
inline constexpr double max_consolidation = 20;
/// J^2 of the state that the deviator yields to is at least this.
inline constexpr double min_J_squared = 0.01;
/// Limit of |det F_E| below which the directions of F_E are rounding: they are forgotten.
inline constexpr double crushed_J = 1e-3;

/// Inputs of cam clay for particles in lanes, and what the return finds.
template <class V>
struct ClayLanes {
  V mu, K;  ///< Pa
  V p0;     ///< Pa, before the step
  V M, beta;
  V min_J_P, max_J_P;
  V is_isochoric{};  ///< 1, or 0: radial
};

/// sinh x for 0 <= x <= 20.
template <class V>
NEVE_INLINE V hyperbolic_sine(V x) {
  using Real = ElementOf<V>;
  constexpr Real reach = sizeof(Real) == 4 ? Real(0.5) : Real(0.1);
  const V x2 = x * x;
  V series = fused(x2, all<V>(Real(1.0 / 362880)), all<V>(Real(1.0 / 5040)));
  series = fused(x2, series, all<V>(Real(1.0 / 120)));
  series = fused(x2, series, all<V>(Real(1.0 / 6)));
  series = fused(x * x2, series, x);
  const auto is_far = x > all<V>(reach);
  if (!any_lane(is_far)) return series;
  const V e = exponential_lanes(x);
  return is_far ? Real(0.5) * (e - Real(1) / e) : series;
}

/// x^(-1/3) for normal x > 0. In float an estimate from the exponent (relative error 3.5 %) is
/// sharpened by two cubic steps.
template <class V>
NEVE_INLINE V inverse_cube_root(V x) {
  using Real = ElementOf<V>;
  if constexpr (sizeof(Real) == 4) {
    using I = MaskOf<V>;
    const V bits = __builtin_convertvector(reinterpret_cast<I>(x), V);
    V y = reinterpret_cast<V>(0x54a2fa8c - __builtin_convertvector(bits * (1.0f / 3), I));
    for (int step = 0; step < 2; ++step) {
      const V r = fused_negative(x * y, y * y, all<V>(1));
      y = fused(y * r, fused(r, all<V>(2.0f / 9), all<V>(1.0f / 3)), y);
    }
    return y;
  } else {
    return exponential_lanes(logarithm_lanes(x) * Real(-1.0 / 3));
  }
}

template <class V, class I>
NEVE_INLINE ClayLanes<V> take_clay(const Record<V, I>& p,
                                   const MaterialConstants<ElementOf<V>>* table) {
  using Real = ElementOf<V>;
  constexpr int constants = 8;
  V k[constants];
  const I material = p.material();
  const auto numbers = [](const MaterialConstants<Real>& row, Real* out) NEVE_INLINE_BODY {
    out[0] = row.mu0, out[1] = row.lambda0 + Real(2.0 / 3) * row.mu0, out[2] = row.own[constant_xi];
    out[3] = row.own[constant_alpha0], out[4] = row.own[constant_M];
    out[5] = row.own[constant_beta];
    out[6] = row.min_J_P, out[7] = row.max_J_P;
  };
  Real number[constants];
  if (!any_lane(material != all<I>(material[0]))) {
    numbers(table[material[0]], number);
    for (int q = 0; q < constants; ++q) k[q] = all<V>(number[q]);
  } else {
    for (int l = 0; l < lane_count<V>; ++l) {
      numbers(table[material[l]], number);
      for (int q = 0; q < constants; ++q) k[q][l] = number[q];
    }
  }
  const V packed = larger_lanes(-(k[3] + logarithm_lanes(p.J_P)), V{});
  const V x = smaller_lanes(k[2] * packed, all<V>(Real(max_consolidation)));
  ClayLanes<V> m;
  m.mu = p.stiffness * k[0];
  m.K = p.stiffness * k[1];
  m.p0 = p.threshold * m.K * (hyperbolic_sine(x) + Real(min_strength));
  m.M = k[4], m.beta = k[5];
  m.min_J_P = k[6], m.max_J_P = k[7];
  return m;
}

/// 1 where the material of a lane flows at constant volume, else 0.
template <class V, class I>
NEVE_INLINE V isochoric_lanes(const Record<V, I>& p, const MaterialConstants<ElementOf<V>>* table) {
  const I material = p.material();
  const V first = all<V>(table[material[0]].own[constant_is_isochoric]);
  if (!any_lane(material != all<I>(material[0]))) return first;
  V out;
  for (int l = 0; l < lane_count<V>; ++l) out[l] = table[material[l]].own[constant_is_isochoric];
  return out;
}

/// Result that the surface makes of a trial state.
template <class V>
struct ClayReturn {
  V k;                     ///< factor on the deviator
  V J_squared;             ///< after the step
  V J_squared_of_history;  ///< what J_P takes it for
  MaskOf<V> yields;
  MaskOf<V> keeps_volume{};  ///< of those
};
/// @param J_squared, size  of the trial state: det b and |dev b'|^2
template <bool some_are_isochoric, class V>
NEVE_INLINE ClayReturn<V> return_to_surface(const ClayLanes<V>& m, const V& J_squared,
                                            const V& size) {
  using Real = ElementOf<V>;
  const V one = all<V>(1), scale = one / m.K;
  // All pressures over K.
  const V p = Real(0.5) * (one - J_squared), p0 = m.p0 * scale, tip = -m.beta * p0;
  const V q_squared = Real(1.5) * (m.mu * scale) * (m.mu * scale) * size;
  const V centre = Real(0.5) * (p0 + tip), half = Real(0.5) * (p0 - tip);
  const V across = m.M * (p - centre), reach = m.M * half;
  const V r_squared =
      fused(across, across, fused(m.beta, Real(2) * q_squared, q_squared)) / (reach * reach);
  const auto is_packed = p > p0, is_open = p < tip;
  ClayReturn<V> out;
  out.yields = is_packed | is_open | (r_squared > one);
  out.k = one / square_root_lanes(larger_lanes(r_squared, one));
  const V pulled = fused(-Real(2) * (p - centre), out.k, one - Real(2) * centre);
  V J = larger_lanes(pulled, all<V>(Real(min_J_squared)));
  J = is_packed ? one - Real(2) * p0 : J;
  J = is_open ? one - Real(2) * tip : J;
  out.J_squared = out.yields ? J : J_squared;
  out.J_squared_of_history = out.J_squared;
  out.k = is_packed | is_open ? V{} : out.k;
  if constexpr (!some_are_isochoric) return out;
  out.keeps_volume = (m.is_isochoric > V{}) & out.yields & ~is_packed & ~is_open;
  if (any_lane(out.keeps_volume)) {
    const V below = larger_lanes((p - tip) * (p0 - p), V{});
    const V weighed = fused(m.beta, Real(2) * q_squared, q_squared);
    const V k = m.M * square_root_lanes(below / (weighed > V{} ? weighed : one));
    out.k = out.keeps_volume ? smaller_lanes(k, one) : out.k;
    out.J_squared = out.keeps_volume ? J_squared : out.J_squared;
  }
  return out;
}

/// The mean m of a matrix m I + k d with determinant 1 and positive eigenvalues, d of trace 0: the
/// largest root of a cubic, by Newton from a chord above it (m is convex in k).
/// @param t  m for k = 1
template <class V>
NEVE_INLINE V unit_determinant_mean(const V& k, const V& t, const V& size, const V& det_d) {
  using Real = ElementOf<V>;
  constexpr int steps = sizeof(Real) == 4 ? 4 : 6;
  const V A = Real(0.5) * k * k * size, C = fused(k * k * k, det_d, all<V>(-1));
  V m = fused(k, t - Real(1), all<V>(1));
  for (int step = 0; step < steps; ++step) {
    const V m2 = m * m;
    m -= fused(m, m2 - A, C) / fused(all<V>(3), m2, -A);
  }
  return m;
}

/// F becomes F' with F' F'^T = s^2 b_new for F F^T ~ b_old, both of determinant 1, by their
/// triangular factors: F' = s L_new L_old^-1 F turns no further than F did.
template <class V>
NEVE_INLINE void take_stretch(V* F, const Sym3<V>& b_old, const Sym3<V>& b_new, const V& s) {
  const V one = all<V>(1);
  const V o2 = fused_negative(b_old.xy, b_old.xy, b_old.xx * b_old.yy);
  const V n2 = fused_negative(b_new.xy, b_new.xy, b_new.xx * b_new.yy);
  // Four reciprocals for the price of one.
  const V old_pair = b_old.xx * o2, new_pair = b_new.xx * n2;
  const V inverse = one / (old_pair * new_pair);
  const V by_old = inverse * new_pair, by_new = inverse * old_pair;
  const V io1 = by_old * o2, io2 = by_old * b_old.xx, in1 = by_new * n2, in2 = by_new * b_new.xx;
  const V o21 = b_old.xy * io1, o31 = b_old.xz * io1;
  const V o32 = fused_negative(b_old.xy, b_old.xz, b_old.xx * b_old.yz) * io2;
  const V n21 = b_new.xy * in1, n31 = b_new.xz * in1;
  const V n32 = fused_negative(b_new.xy, b_new.xz, b_new.xx * b_new.yz) * in2;
  // Roots of the ratios of the pivots, whose product is 1.
  const V a = b_new.xx * io1, c = n2 * io2;
  const V root_a = inverse_square_root(a), root_c = inverse_square_root(c);
  const V r1 = s * a * root_a, r2 = s * c * root_c * root_a, r3 = s * root_c;
  for (int column = 0; column < 3; ++column) {
    const V x = F[column], y = F[3 + column], z = F[6 + column];
    const V gx = r1 * x, gy = r2 * fused_negative(o21, x, y);
    const V gz = r3 * (fused(fused(o21, o32, -o31), x, fused_negative(o32, y, z)));
    F[column] = gx;
    F[3 + column] = fused(n21, gx, gy);
    F[6 + column] = fused(n31, gx, fused(n32, gy, gz));
  }
}

/// Scales F to the determinant J, which it nearly has. Roots are rounded to one side: where nothing
/// else sets the volume, it would shrink by 8e-8 a step in float.
template <class V>
NEVE_INLINE void set_volume(V* F, const V& J, const MaskOf<V>& where) {
  using Real = ElementOf<V>;
  const V rest = (J - determinant(F)) / (Real(3) * J);
  for (int q = 0; q < 9; ++q) F[q] = where ? fused(rest, F[q], F[q]) : F[q];
}

/// Step 7 and stress of a batch.
/// @param is_projected  false leaves F_E and J_P as they are
/// @param wave_modulus  out: rho0 c^2 of the fastest wave, K (1 + J^2)/2 + mu (5/9 tr b' -
/// b'_min/3),
///                      with b'_min from below
/// @tparam some_are_isochoric  false: all flow radially, which is the faster step
/// @return lanes with det F_E <= 0 before
template <bool some_are_isochoric, class V, class I>
NEVE_INLINE unsigned take_step(Record<V, I>& p, const MaterialConstants<ElementOf<V>>* table,
                               bool is_projected, V& wave_modulus) {
  using Real = ElementOf<V>;
  constexpr Real tiny = sizeof(Real) == 4 ? Real(1e-6) : Real(1e-12);
  ClayLanes<V> m = take_clay(p, table);
  if constexpr (some_are_isochoric) m.is_isochoric = isochoric_lanes(p, table);
  const V one = all<V>(1), signed_J = determinant(p.F_E);
  const V J = larger_lanes(absolute_lanes(signed_J), all<V>(tiny)), J_squared = J * J;
  const Sym3<V> b = inverse_cube_root(J_squared) * left_cauchy_green(p.F_E);
  const V t = (b.xx + b.yy + b.zz) * Real(1.0 / 3);
  const Sym3<V> d = add_identity(b, -t);
  const V size = fused(d.xx, d.xx, fused(d.yy, d.yy, d.zz * d.zz)) +
                 Real(2) * fused(d.xy, d.xy, fused(d.xz, d.xz, d.yz * d.yz));
  ClayReturn<V> found{one, J_squared, J_squared, MaskOf<V>{}, MaskOf<V>{}};
  if (is_projected) found = return_to_surface<some_are_isochoric>(m, J_squared, size);
  const MaskOf<V> is_positive = signed_J > V{};
  const MaskOf<V> is_changed = found.yields | ~is_positive;
  if (is_projected && any_lane(is_changed)) {
    const V det_d = fused(d.xx, fused_negative(d.yz, d.yz, d.yy * d.zz),
                          fused(d.xy, fused_negative(d.xy, d.zz, d.xz * d.yz),
                                d.xz * fused_negative(d.yy, d.xz, d.xy * d.yz)));
    // A body turned inside out is mirrored back; one without directions gets new ones.
    const MaskOf<V> is_crushed = J < all<V>(Real(crushed_J));
    found.k = is_crushed & is_changed ? V{} : found.k;
    const V mean = unit_determinant_mean(found.k, t, size, det_d);
    V F[9];
    for (int q = 0; q < 9; ++q) {
      const V mirrored = q % 3 == 2 ? (is_positive ? p.F_E[q] : -p.F_E[q]) : p.F_E[q];
      F[q] = is_crushed ? (q % 4 == 0 ? one : V{}) : mirrored;
    }
    const Sym3<V> old{is_crushed ? one : b.xx, is_crushed ? one : b.yy, is_crushed ? one : b.zz,
                      is_crushed ? V{} : b.xy, is_crushed ? V{} : b.xz, is_crushed ? V{} : b.yz};
    const V growth = found.J_squared / (is_crushed ? one : J_squared);
    take_stretch(F, old, add_identity(found.k * d, mean),
                 inverse_square_root(inverse_cube_root(growth)));
    if constexpr (some_are_isochoric)
      if (any_lane(found.keeps_volume)) set_volume(F, J, found.keeps_volume);
    V J_P = p.J_P * (J * inverse_square_root(found.J_squared_of_history));
    J_P = J_P < m.min_J_P ? m.min_J_P : J_P;
    J_P = J_P > m.max_J_P ? m.max_J_P : J_P;
    p.J_P = found.yields ? J_P : p.J_P;
    for (int q = 0; q < 9; ++q) p.F_E[q] = is_changed ? F[q] : p.F_E[q];
  }
  const V shear = m.mu * found.k, squeeze = Real(0.5) * m.K * (found.J_squared - one);
  const Sym3<V> tau = add_identity(shear * d, squeeze);
  p.tau[0] = tau.xx, p.tau[1] = tau.yy, p.tau[2] = tau.zz;
  p.tau[3] = tau.xy, p.tau[4] = tau.xz, p.tau[5] = tau.yz;
  const V mean = fused(found.k, t - one, one);
  const V spread = Real(0.81649658092772603) * found.k * square_root_lanes(size);
  const V least = larger_lanes(mean - spread, V{});
  wave_modulus = fused(m.K, Real(0.5) * (one + found.J_squared),
                       m.mu * (Real(5.0 / 3) * mean - Real(1.0 / 3) * least));
  return lane_bits(~is_positive);
}

struct InLanes {
  static constexpr bool is_plastic = true;

  template <class V, class I>
  NEVE_INLINE static unsigned step(Record<V, I>& p, const MaterialConstants<ElementOf<V>>* table,
                                   bool is_projected, V& wave_modulus) {
    if (any_lane(isochoric_lanes(p, table) > V{}))
      return take_step<true>(p, table, is_projected, wave_modulus);
    return take_step<false>(p, table, is_projected, wave_modulus);
  }

  /// V0_lambda is that of K.
  template <class V, class I>
  NEVE_INLINE static Elasticity<V> elasticity(const Record<V, I>& p,
                                              const MaterialConstants<ElementOf<V>>* table) {
    const ClayLanes<V> m = take_clay(p, table);
    return {left_cauchy_green(p.F_E), p.V0 * m.mu, p.V0 * m.K};
  }

  template <class V>
  NEVE_INLINE static void stress_change(const Elasticity<V>& e, const V* G, V* D) {
    using Real = ElementOf<V>;
    const Sym3<V>& b = e.shape;
    const V trace = G[0] + G[4] + G[8];
    times(G, b, D);
    const V t = (b.xx + b.yy + b.zz) * Real(1.0 / 3), along = D[0] + D[4] + D[8];
    constexpr Real tiny = sizeof(Real) == 4 ? Real(1e-12) : Real(1e-24);
    const V J_squared = larger_lanes(determinant(b), all<V>(tiny));
    const V a = e.V0_mu * inverse_cube_root(J_squared), spread = Real(-2.0 / 3) * trace;
    const V b_row[9] = {b.xx, b.xy, b.xz, b.xy, b.yy, b.yz, b.xz, b.yz, b.zz};
    for (int q = 0; q < 9; ++q) D[q] = a * fused(spread, b_row[q], D[q]);
    const V on_transpose = fused(a, t, Real(-0.5) * e.V0_lambda * (J_squared - Real(1)));
    const V on_identity =
        fused(e.V0_lambda * J_squared, trace, -a * fused(spread, t, Real(2.0 / 3) * along));
    add_volume_change(on_transpose, on_identity, G, D);
  }
};

#ifndef NEVE_LANES_ALONE
/// Places in Material::own.
enum Own { cohesion, consolidation_hardening, flow };

/// Values of `flow`, and their names.
inline constexpr double radial = 0, isochoric = 1;
inline constexpr const char* names_of_flow[] = {"radial", "isochoric"};

inline bool is_isochoric(const Material& m) {
  return m.own[flow] == isochoric;
}
inline bool counts_volume(const Material& m) {
  return !is_isochoric(m);
}

/// det F_E, of an inverted one that of its mirror image, and the isochoric b.
struct Strain {
  double J;
  Mat3d b;

  explicit Strain(const Mat3d& F_E)
      : J(std::max(std::abs(F_E.determinant()), 1e-12)),
        b(std::pow(J, -2.0 / 3) * F_E * F_E.transpose()) {}
  double mean() const { return b.trace() / 3; }
  Mat3d deviator() const { return b - mean() * Mat3d::Identity(); }
};

inline double shear_modulus(const Material& m) {
  return lame(m.youngs_modulus, m.poisson_ratio).mu;
}

/// alpha at J_P = 1: where p0 is the consolidation pressure of the start.
inline double alpha0(const Material& m) {
  const double share = m.consolidation_pressure / bulk_modulus(m) - min_strength;
  return -std::asinh(std::max(share, 0.0)) / m.own[consolidation_hardening];
}

/// Returns the pressure at which the snow yields, packed to J_P, Pa.
inline double p0(const Material& m, double J_P) {
  const double packed = std::max(-(alpha0(m) + std::log(J_P)), 0.0);
  const double x = std::min(m.own[consolidation_hardening] * packed, max_consolidation);
  return m.strength * bulk_modulus(m) * (min_strength + std::sinh(x));
}

/// r of a state: 1 on the yield surface, below inside, as the return measures it.
inline double nearness_to_yield(const Material& m, const Mat3d& F_E, double J_P) {
  const Strain strain(F_E);
  const double top = p0(m, J_P), beta = m.own[cohesion], M = critical_slope(m.friction_angle);
  const double p = 0.5 * bulk_modulus(m) * (1 - strain.J * strain.J);
  const double q = std::sqrt(1.5) * shear_modulus(m) * strain.deviator().norm();
  const double across = M * (p - 0.5 * (1 - beta) * top);
  return std::sqrt(across * across + (1 + 2 * beta) * q * q) / (M * 0.5 * (1 + beta) * top);
}

inline double energy_density(const Material& m, const Mat3d& F_E, double = 1) {
  const Strain strain(F_E);
  return 0.5 * shear_modulus(m) * (strain.b.trace() - 3) +
         0.5 * bulk_modulus(m) * (0.5 * (strain.J * strain.J - 1) - std::log(strain.J));
}

inline Mat3d first_piola(const Material& m, const Mat3d& F_E, double = 1) {
  const Strain strain(F_E);
  const Mat3d tau = shear_modulus(m) * strain.deviator() +
                    0.5 * bulk_modulus(m) * (strain.J * strain.J - 1) * Mat3d::Identity();
  return tau * F_E.inverse().transpose();
}

inline double wave_modulus(const Material& m, const Mat3d& F_E, double = 1) {
  const Strain strain(F_E);
  const double least =
      Eigen::SelfAdjointEigenSolver<Mat3d>(strain.b, Eigen::EigenvaluesOnly).eigenvalues()[0];
  return 0.5 * bulk_modulus(m) * (1 + strain.J * strain.J) +
         shear_modulus(m) * (5 * strain.mean() - least) / 3;
}

inline Surface surface(const Material& m, double J_P) {
  const double K = bulk_modulus(m), top = p0(m, J_P), beta = m.own[cohesion];
  return {.pressure = std::min(top, 0.5 * K),
          .tension = beta * top,
          .deviator =
              critical_slope(m.friction_angle) * 0.5 * (1 + beta) * top / std::sqrt(1 + 2 * beta),
          .min_J = std::sqrt(std::max(1 - 2 * top / K, 0.0)),
          .max_J = std::sqrt(1 + 2 * beta * top / K)};
}

inline void constants(const Material& m, double (&own)[own_constants]) {
  own[constant_M] = critical_slope(m.friction_angle);
  own[constant_beta] = m.own[cohesion];
  own[constant_xi] = m.own[consolidation_hardening];
  own[constant_alpha0] = alpha0(m);
  own[constant_is_isochoric] = is_isochoric(m) ? 1 : 0;
}

inline void refine(Material& m, double factor) {
  m.own[cohesion] *= factor;
}

inline Scale scale(const Material& m) {
  const Surface held = surface(m, 1);
  return {m.consolidation_pressure, held.deviator, std::max(1 - held.min_J, held.max_J - 1)};
}

inline double largest_pressure(const Material& m) {
  return 0.5 * bulk_modulus(m);
}

/// The slope M from which radial flow never makes energy. Left of the centre c of the surface,
/// shear that yields raises the pressure: it costs p (c - p)/K and pays q^2/(3 mu), for small
/// strains. Isochoric flow only shrinks the deviator.
inline double min_slope(const Material& m) {
  const double beta = m.own[cohesion], c = 0.5 * (1 - beta);
  constexpr int places = 64;
  double most = 0;
  for (int k = 1; k < places; ++k) {
    const double p = c * k / places;
    most = std::max(most, p * (c - p) * (1 + 2 * beta) / ((p + beta) * (1 - p)));
  }
  return std::sqrt(3 * shear_modulus(m) / bulk_modulus(m) * most);
}

inline void concerns(const Material& m, std::vector<Concern>& found) {
  const double K = bulk_modulus(m), least = is_isochoric(m) ? 0 : friction_angle(min_slope(m));
  if (m.friction_angle < least)
    found.push_back({"friction_angle",
                     "at {} degrees shear packs this snow by more energy than it has: flow makes "
                     "energy out of nothing",
                     {m.friction_angle},
                     "a friction_angle of {} or more",
                     least});
  if (m.consolidation_pressure < 0.4 * K) return;
  found.push_back({"consolidation_pressure",
                   "{} Pa is more than snow of youngs_modulus {} Pa can bear ({} Pa): it is "
                   "squeezed like rubber before it packs",
                   {m.consolidation_pressure, m.youngs_modulus, 0.5 * K},
                   "a youngs_modulus of {} or more",
                   10 * m.youngs_modulus * m.consolidation_pressure / K});
}

/// J_P after isochoric flow of a state between the tips, which is outside of the surface: det F_E
/// over that of the state on the line to the centre.
inline double history_after(const Material& m, const YieldStep& step) {
  const double K = bulk_modulus(m), J = Strain(step.F_E).J, top = p0(m, step.J_P);
  const double centre = 0.5 * (1 - m.own[cohesion]) * top, p = 0.5 * K * (1 - J * J);
  const double pulled = centre + (p - centre) / nearness_to_yield(m, step.F_E, step.J_P);
  return step.J_P * J / std::sqrt(1 - 2 * pulled / K);
}

/// Isochoric flow keeps det F_E, and J_P alone hardens or softens.
inline void test_isochoric_flow(const Material& m, const YieldStep& step,
                                std::vector<Claim>& claims) {
  const Surface held = surface(m, step.J_P);
  const double J = Strain(step.F_E).J;
  if (J < held.min_J || J > held.max_J) return;
  claims.push_back({"det F_E in isochoric flow", Strain(step.F_E_after).J / J - 1, rounding});
  claims.push_back(
      {"J_P of isochoric flow", step.J_P_after / history_after(m, step) - 1, on_surfaces});
}

/// A trial state inside of the surface stays; one outside ends on it, and keeps its volume and the
/// directions of its strain.
inline void test_yield(const Material& m, const YieldStep& step, std::vector<Claim>& claims) {
  const Mat3d &F = step.F_E, &found = step.F_E_after;
  const Mat3d before = Strain(F).deviator(), after = Strain(found).deviator();
  const double size = before.squaredNorm();
  const double along = size > 0 ? std::max(before.cwiseProduct(after).sum() / size, 0.0) : 0;
  claims.push_back({"strain in other directions", (after - along * before).norm(), rounding});
  const double near = nearness_to_yield(m, F, step.J_P);
  if (F.determinant() > 0 && near < 0.99)
    claims.push_back({"F_E within the surface", (found - F).cwiseAbs().maxCoeff(), rounding});
  else if (near > 1.01) {
    claims.push_back(
        {"distance to the surface", nearness_to_yield(m, found, step.J_P) - 1, on_surfaces});
    if (is_isochoric(m)) test_isochoric_flow(m, step, claims);
  }
}
inline constexpr SelfTest self_test{"ends on its surface, keeps volume and directions", 0.95,
                                    test_yield};

inline constexpr Parameter parameters[] = {
    parameter::friction_angle,
    {.key = "cohesion",
     .own = cohesion,
     .own_default = 0.4,
     .bounds = {0, 10},
     .help = "cam_clay: tension that snow bears, as a share of its consolidation pressure."},
    {.key = "consolidation_pressure",
     .member = &Material::consolidation_pressure,
     .unit = Unit::pascal,
     .bounds = {1e-3, 1e12},
     .help = "cam_clay: pressure that the snow of the start bears before it packs."},
    {.key = "consolidation_hardening",
     .own = consolidation_hardening,
     .own_default = 1,
     .bounds = {1e-3, 1e3},
     .help = "cam_clay: rate at which snow that packs gains consolidation pressure."},
    {.key = "flow",
     .own = flow,
     .own_default = radial,
     .names = names_of_flow,
     .help =
         "cam_clay: sheared snow packs or opens (radial), or keeps its volume (isochoric: J_P is "
         "its hardening alone)."}};

inline constexpr Law law{.kind = "snow as soil",
                         .is_snow = true,
                         .is_plastic = InLanes::is_plastic,
                         .is_benched = true,
                         .parameters = parameters,
                         .rate = &parameters[3],
                         .caption = "cam clay, {} degrees, cohesion {}, p0 {} Pa, hardening {}",
                         .energy_density = energy_density,
                         .first_piola = first_piola,
                         .wave_modulus = wave_modulus,
                         .nearness_to_yield = nearness_to_yield,
                         .consolidation_pressure = p0,
                         .constants = constants,
                         .refine = refine,
                         .scale = scale,
                         .surface = surface,
                         .largest_pressure = largest_pressure,
                         .concerns = concerns,
                         .counts_volume = counts_volume,
                         .self_test = &self_test};
#endif

}  // namespace neve::sim::laws::cam_clay
