#pragma once
/// Energy of stretches, which the paper's snow and an elastic law share:
///   psi = mu |F_E - R|^2 + lambda/2 (J_E - 1)^2                          (the paper, equation 1)
///   tau = 2 mu (F_E - R) F_E^T + lambda (J_E - 1) J_E I = 2 mu (b - sqrt(b)) + ...
///   D = 2 mu (G V - [w]x) V + lambda J (2 J - 1) tr G I - lambda J (J - 1) G^T
/// with the left stretch V (F_E = V R), b = V^2, and dR = [w]x R, (tr V I - V) w = axial(G V - V
/// G^T), as in the paper's technical report.

#include "sim/laws/differential.h"
#include "sim/laws/hardening.h"
#ifndef NEVE_LANES_ALONE
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#endif

namespace neve::sim::laws {

/// Eigenvalues of b = F_E F_E^T between which its own decomposition is good to a few units in the
/// last place; outside, F_E itself is decomposed.
inline constexpr double eigen_lo = 0.1, eigen_hi = 4;

template <class Real>
inline constexpr int eigen_sweeps = sizeof(Real) == 4 ? 3 : 5;

/// Stress of particles whose strain is small (and, for snow, inside the
/// thresholds), by the square root of b = F_E F_E^T. F_E and J_P keep their bits.
/// @return the lanes where this holds
template <class V>
NEVE_INLINE MaskOf<V> stress_near_identity(MaterialLanes<V>& m, bool is_plastic) {
  using Real = ElementOf<V>;
  const V J = determinant(m.F()), one = all<V>(1);
  const Sym3<V> b = left_cauchy_green(m.F());
  V lo = all<V>(Real(1 - series_radius)), hi = all<V>(Real(1 + series_radius));
  if (is_plastic) {
    lo = larger_lanes(lo, m.lo() * m.lo());
    hi = smaller_lanes(hi, m.hi() * m.hi());
  }
  const MaskOf<V> holds = (J > V{}) & has_eigenvalues_within(b, lo, hi);
  V mu, lambda;
  m.harden(mu, lambda);
  const Sym3<V> deviation = add_identity(b, -one) - root_minus_identity(b);
  m.set_tau(add_identity(Real(2) * mu * deviation, lambda * (J - one) * J));
  m.wave_modulus() = Real(2) * mu * row_sum_norm(b) + lambda * J * J;
  return holds;
}

/// Stress from the stretches s and the axes U (row by row) of F_E, common to both decompositions.
template <class V>
NEVE_INLINE void stress_of_stretches(MaterialLanes<V>& m, const V* s, const V* U) {
  using Real = ElementOf<V>;
  V mu, lambda;
  m.harden(mu, lambda);
  const V one = all<V>(1), J_E = s[0] * s[1] * s[2], pressure = lambda * (J_E - one) * J_E;
  Sym3<V> tau{};
  for (int i = 0; i < 3; ++i) {
    const V x = U[i], y = U[3 + i], z = U[6 + i];
    const V d = fused(Real(2) * mu * (s[i] - one), s[i], pressure);
    const V dx = d * x, dy = d * y;
    tau = {fused(dx, x, tau.xx), fused(dy, y, tau.yy), fused(d * z, z, tau.zz),
           fused(dx, y, tau.xy), fused(dx, z, tau.xz), fused(dy, z, tau.yz)};
  }
  m.set_tau(tau);
  V largest = larger_lanes(s[0] * s[0], s[1] * s[1]);
  largest = larger_lanes(largest, s[2] * s[2]);
  m.wave_modulus() = Real(2) * mu * largest + lambda * J_E * J_E;
}

/// The lanes whose F_E is well enough conditioned for the eigenvalues of b.
template <class V>
NEVE_INLINE MaskOf<V> is_well_conditioned(MaterialLanes<V>& m, const Sym3<V>& b) {
  using Real = ElementOf<V>;
  const V lo = all<V>(Real(eigen_lo)), hi = all<V>(Real(eigen_hi));
  return (determinant(m.F()) > V{}) & has_eigenvalues_within(b, lo, hi);
}

/// The same stress by the eigenvalues of b, with the law's projection where `is_plastic`:
/// F_E' = U diag(s'/s) U^T F_E, written as a correction to F_E.
template <class Yield, class V>
NEVE_INLINE void stress_by_eigenvalues(MaterialLanes<V>& m, const SymmetricEigen<V>& eigen,
                                       bool is_plastic) {
  using Real = ElementOf<V>;
  const V* U = eigen.U;
  V s[3], change[3] = {}, cut = all<V>(1);
  for (int i = 0; i < 3; ++i) {
    const V found = square_root_lanes(eigen.l[i]);
    s[i] = found;
    if (!is_plastic) continue;
    s[i] = Yield::clamp_stretch(m, found, cut);
    change[i] = s[i] / found - Real(1);
  }
  if (is_plastic) {
    Yield::move_J_P(m, cut, cut != all<V>(1));
    // U^T F, stretched, and back.
    for (int column = 0; column < 3; ++column) {
      V* F = m.F();
      const V x = F[column], y = F[3 + column], z = F[6 + column];
      for (int i = 0; i < 3; ++i) {
        const V along = change[i] * fused(U[i], x, fused(U[3 + i], y, U[6 + i] * z));
        for (int row = 0; row < 3; ++row)
          F[3 * row + column] = fused(U[3 * row + i], along, F[3 * row + column]);
      }
    }
  }
  stress_of_stretches(m, s, U);
}

/// The same for any F_E, also singular and inverted ones.
template <class Yield, class V>
NEVE_INLINE void stress_by_decomposition(MaterialLanes<V>& m, bool is_plastic) {
  const SignedSvd<V> svd = signed_svd_lanes(m.F());
  V s[3] = {svd.s[0], svd.s[1], svd.s[2]};
  if (is_plastic) {
    V cut = all<V>(1);
    MaskOf<V> is_cut{};
    for (int i = 0; i < 3; ++i) {
      s[i] = Yield::clamp_stretch(m, svd.s[i], cut);
      is_cut |= s[i] != svd.s[i];
    }
    Yield::move_J_P(m, cut, is_cut);
    for (int a = 0; a < 3; ++a)
      for (int c = 0; c < 3; ++c) {
        const V F = svd.U[3 * a] * s[0] * svd.V[3 * c] +
                    svd.U[3 * a + 1] * s[1] * svd.V[3 * c + 1] +
                    svd.U[3 * a + 2] * s[2] * svd.V[3 * c + 2];
        m.F()[3 * a + c] = is_cut ? F : m.F()[3 * a + c];
      }
  }
  stress_of_stretches(m, s, svd.U);
}

/// Projects F_E and recomputes tau from it. Most particles take the cheap way; those that yield or
/// are far from the identity are moved together into full lanes. The grouping of lanes changes no
/// bit.
/// @tparam Yield  the law's projection of one stretch: clamp_stretch, move_J_P; yields: false has
///                none
template <class Real, class Set, class Yield>
class StretchUpdate {
 public:
  static constexpr int W = Set::template lanes<Real>;
  using V = Lanes<Real, W>;
  using M = MaterialLanes<V>;
  using Space = LawSpace<Real, W>;
  static_assert(M::words <= Space::words);

  explicit StretchUpdate(Space& space) : packed_(space.word) {}

  /// See LawKernels::update.
  NEVE_INLINE void operator()(ParticleLanes<Real, W>* batch, int count,
                              const MaterialConstants<Real>* table, bool is_projected,
                              V* wave_modulus, unsigned* is_inverted, FirstLook<V>* looks) {
    const bool is_plastic = is_projected && Yield::yields;
    unsigned rest[gather_group / W];
    int packed = 0;
    for (int k = 0; k * W < count; ++k) {
      M m;
      take_lanes(batch[k], table, m);
      const unsigned used = lane_bits(first_lanes<MaskOf<V>>(count - k * W));
      is_inverted[k] = used & ~lane_bits(determinant(m.F()) > V{});
      rest[k] = used & ~lane_bits(stress_near_identity(m, is_plastic));
      keep_stress(m, batch[k], wave_modulus[k]);
      if (looks) looks[k] = {batch[k].J_P, wave_modulus[k]};
      if (rest[k] == 0) continue;
      const LanePacking<V> packing(rest[k]);
      for (int w = 0; w < M::words; ++w)
        if (!is_result(w)) packing.compress(m.word[w], packed_[w] + packed);
      packed += __builtin_popcount(rest[k]);
    }
    if (packed == 0) return;
    int first = 0;
    for (; packed - first > W; first += 2 * W) decompose<2>(first, packed, is_plastic);
    if (first < packed) decompose<1>(first, packed, is_plastic);
    packed = 0;
    for (int k = 0; k * W < count; ++k) {
      if (rest[k] == 0) continue;
      const LanePacking<V> packing(rest[k]);
      const auto take = [&](V& v, int word)
                            NEVE_INLINE_BODY { v = packing.expand(v, packed_[word] + packed); };
      for (int q = 0; q < 9; ++q) take(batch[k].F_E[q], M::word_F + q);
      for (int q = 0; q < 6; ++q) take(batch[k].tau[q], M::word_tau + q);
      take(batch[k].J_P, M::word_J_P);
      take(wave_modulus[k], M::word_wave_modulus);
      packed += __builtin_popcount(rest[k]);
    }
  }

 private:
  static constexpr bool is_result(int w) { return w >= M::word_wave_modulus && w < M::word_mu; }

  /// N batches of packed particles from the q-th.
  template <int N>
  NEVE_NOINLINE void decompose(int q, int packed, bool is_plastic) {
    M m[N];
    Sym3<V> b[N];
    SymmetricEigen<V> eigen[N];
    unsigned rest[N];
    unrolled<N>([&](auto n) NEVE_INLINE_BODY {
      for (int w = 0; w < M::words; ++w)
        if (!is_result(w)) m[n].word[w] = load_lanes<V>(packed_[w] + q + n * W);
      b[n] = left_cauchy_green(m[n].F());
      const unsigned used = lane_bits(first_lanes<MaskOf<V>>(packed - q - n * W));
      rest[n] = used & ~lane_bits(is_well_conditioned(m[n], b[n]));
    });
    symmetric_eigen<N, eigen_sweeps<Real>>(b, eigen);
    unrolled<N>([&](auto n) NEVE_INLINE_BODY {
      stress_by_eigenvalues<Yield>(m[n], eigen[n], is_plastic);
      if (rest[n] != 0) decompose_rest(m[n], q + n * W, rest[n], is_plastic);
      for (int w = 0; w < M::word_mu; ++w) store_lanes(m[n].word[w], packed_[w] + q + n * W);
    });
  }

  /// Lanes `rest` of the batch at q again, by F_E itself.
  NEVE_NOINLINE void decompose_rest(M& m, int q, unsigned rest, bool is_plastic) {
    M again;
    for (int w = 0; w < M::words; ++w)
      if (!is_result(w)) again.word[w] = load_lanes<V>(packed_[w] + q);
    stress_by_decomposition<Yield>(again, is_plastic);
    Integer<Real> is_rest[W];
    for (int l = 0; l < W; ++l) is_rest[l] = -static_cast<Integer<Real>>(rest >> l & 1);
    const auto mask = load_lanes<MaskOf<V>>(is_rest);
    for (int w = 0; w < M::word_mu; ++w) m.word[w] = mask ? again.word[w] : m.word[w];
  }

  Real (*packed_)[gather_group + W];
};

/// U diag(s) U^T, U row by row.
template <class V>
NEVE_INLINE Sym3<V> turned_back(const V* U, const V* s) {
  Sym3<V> out{};
  for (int i = 0; i < 3; ++i) {
    const V x = U[i], y = U[3 + i], z = U[6 + i];
    const V sx = s[i] * x, sy = s[i] * y;
    out = {fused(sx, x, out.xx), fused(sy, y, out.yy), fused(s[i] * z, z, out.zz),
           fused(sx, y, out.xy), fused(sx, z, out.xz), fused(sy, z, out.yz)};
  }
  return out;
}
template <class V>
NEVE_INLINE Sym3<V> select(MaskOf<V> mask, const Sym3<V>& a, const Sym3<V>& b) {
  return {mask ? a.xx : b.xx, mask ? a.yy : b.yy, mask ? a.zz : b.zz,
          mask ? a.xy : b.xy, mask ? a.xz : b.xz, mask ? a.yz : b.yz};
}

/// V of F = V R with a proper rotation R; the smallest stretch of an inverted F is negative.
template <class V>
NEVE_INLINE Sym3<V> left_stretch(const V* F) {
  using Real = ElementOf<V>;
  Sym3<V> b = left_cauchy_green(F);
  const V J = determinant(F);
  const MaskOf<V> is_near = (J > V{}) & has_eigenvalues_within(b, all<V>(Real(1 - series_radius)),
                                                               all<V>(Real(1 + series_radius)));
  Sym3<V> stretch = add_identity(root_minus_identity(b), all<V>(1));
  if (!any_lane(~is_near)) return stretch;
  const MaskOf<V> is_tame =
      (J > V{}) & has_eigenvalues_within(b, all<V>(Real(eigen_lo)), all<V>(Real(eigen_hi)));
  SymmetricEigen<V> eigen;
  symmetric_eigen<1, eigen_sweeps<Real>>(&b, &eigen);
  V s[3];
  for (int i = 0; i < 3; ++i) s[i] = square_root_lanes(larger_lanes(eigen.l[i], V{}));
  stretch = select(is_near, stretch, turned_back(eigen.U, s));
  if (!any_lane(~(is_near | is_tame))) return stretch;
  const SignedSvd<V> svd = signed_svd_lanes(F);
  return select(is_near | is_tame, stretch, turned_back(svd.U, svd.s));
}

/// w of (tr V I - V) w = k. The eigenvalues are sums of two stretches: a body so crushed that one
/// of them is nearly 0 turns at its least push, and is held.
template <class V>
NEVE_INLINE void solve_for_spin(const Sym3<V>& stretch, const V* k, V* w) {
  using Real = ElementOf<V>;
  const V xx = stretch.yy + stretch.zz, yy = stretch.xx + stretch.zz, zz = stretch.xx + stretch.yy;
  const V xy = -stretch.xy, xz = -stretch.xz, yz = -stretch.yz;
  const V c_xx = fused_negative(yz, yz, yy * zz), c_xy = fused_negative(xy, zz, xz * yz);
  const V c_xz = fused_negative(xz, yy, xy * yz), c_yy = fused_negative(xz, xz, xx * zz);
  const V c_yz = fused_negative(xx, yz, xy * xz), c_zz = fused_negative(xy, xy, xx * yy);
  const V det = fused(xx, c_xx, fused(xy, c_xy, xz * c_xz));
  const V size = xx + yy + zz;
  constexpr Real least = sizeof(Real) == 4 ? Real(1e-6) : Real(1e-12);
  constexpr Real tiny = sizeof(Real) == 4 ? Real(1e-30) : Real(1e-200);
  const V inverse = all<V>(1) / larger_lanes(det, fused(least * size, size * size, all<V>(tiny)));
  w[0] = inverse * fused(c_xx, k[0], fused(c_xy, k[1], c_xz * k[2]));
  w[1] = inverse * fused(c_xy, k[0], fused(c_yy, k[1], c_yz * k[2]));
  w[2] = inverse * fused(c_xz, k[0], fused(c_yz, k[1], c_zz * k[2]));
}

/// Functions in lanes that the laws of this energy share.
struct StretchesInLanes {
  static constexpr bool moves_particles_between_lanes = true;

  template <class V, class I>
  NEVE_INLINE static Elasticity<V> elasticity(const Record<V, I>& p,
                                              const MaterialConstants<ElementOf<V>>* table) {
    return hardened_elasticity(p, table, left_stretch(p.F_E));
  }

  template <class V>
  NEVE_INLINE static void stress_change(const Elasticity<V>& e, const V* G, V* D) {
    using Real = ElementOf<V>;
    const V trace = G[0] + G[4] + G[8], J = determinant(e.shape);
    V GV[9], w[3];
    times(G, e.shape, GV);
    const V k[3] = {GV[7] - GV[5], GV[2] - GV[6], GV[3] - GV[1]};
    solve_for_spin(e.shape, k, w);
    GV[1] += w[2], GV[2] -= w[1], GV[3] -= w[2];
    GV[5] += w[0], GV[6] += w[1], GV[7] -= w[0];
    times(GV, e.shape, D);
    for (int q = 0; q < 9; ++q) D[q] = Real(2) * e.V0_mu * D[q];
    const V on_transpose = -e.V0_lambda * J * (J - Real(1));
    add_volume_change(on_transpose, e.V0_lambda * J * (Real(2) * J - Real(1)) * trace, G, D);
  }
};

#ifndef NEVE_LANES_ALONE
struct Stretches {
  Mat3d U, V;
  Vec3d s;

  explicit Stretches(const Mat3d& F) {
    double rows[9];
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) rows[3 * a + b] = F(a, b);
    const SignedSvd<double> svd = signed_svd(rows);
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        U(a, b) = svd.U[3 * a + b];
        V(a, b) = svd.V[3 * a + b];
      }
      s[a] = svd.s[a];
    }
  }
};

inline double energy_of(const Lame& l, const Vec3d& s) {
  const double J = s.prod();
  return l.mu * (s.array() - 1).square().sum() + 0.5 * l.lambda * (J - 1) * (J - 1);
}
inline Mat3d piola_of(const Lame& l, const Mat3d& F_E, const Stretches& p) {
  const double J = p.s.prod();
  // J F^-T by cross products of columns: also right where F is singular.
  Mat3d cofactor;
  cofactor.col(0) = F_E.col(1).cross(F_E.col(2));
  cofactor.col(1) = F_E.col(2).cross(F_E.col(0));
  cofactor.col(2) = F_E.col(0).cross(F_E.col(1));
  return 2 * l.mu * (F_E - p.U * p.V.transpose()) + l.lambda * (J - 1) * cofactor;
}

inline double energy_of_stretches(const Material& m, const Mat3d& F_E, double J_P) {
  return energy_of(hardened(m, J_P), Stretches(F_E).s);
}
inline Mat3d piola_of_stretches(const Material& m, const Mat3d& F_E, double J_P) {
  return piola_of(hardened(m, J_P), F_E, Stretches(F_E));
}
inline ElasticResponse response_of_stretches(const Material& m, const Mat3d& F_E, double J_P) {
  const Lame l = hardened(m, J_P);
  const Stretches p(F_E);
  return {energy_of(l, p.s), piola_of(l, F_E, p)};
}
inline std::array<double, 4> energies_of_stretches(const std::array<const Material*, 4>& materials,
                                                   const std::array<Mat3d, 4>& F_E,
                                                   const std::array<double, 4>& J_P) {
  Quad<double> rows[9];
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      for (std::size_t l = 0; l < 4; ++l) rows[3 * a + b][l] = F_E[l](a, b);
  const SignedSvd<Quad<double>> svd = signed_svd_lanes(rows);
  std::array<double, 4> out;
  for (std::size_t l = 0; l < 4; ++l)
    out[l] =
        energy_of(hardened(*materials[l], J_P[l]), Vec3d(svd.s[0][l], svd.s[1][l], svd.s[2][l]));
  return out;
}
#endif

}  // namespace neve::sim::laws
