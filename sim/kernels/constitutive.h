#pragma once
/// Stress and plastic projection of particles of one model, in lanes.
///
/// All models take mu = mu0 e^(xi (1 - J_P)) and lambda likewise (the paper, equation 2), with the
/// factor held between min_hardening and the material's max_hardening. Stress is the Kirchhoff
/// stress tau = P F_E^T: the force of a particle is -V0 tau grad_w, J cancels.

#include "sim/kernels/cam_clay.h"
#include "sim/kernels/decompose.h"
#include "sim/kernels/particle_lanes.h"
#include "sim/kernels/row.h"
#include "sim/kernels/sand.h"

namespace neve::sim::kernels {

/// Torn snow is at least this stiff, relative to snow at rest. Its forces are far below the
/// rounding of its weight, but no product of them is so small that processors slow down
/// (denormals).
inline constexpr double min_hardening = 1e-12;

/// Eigenvalues of b = F_E F_E^T between which its own decomposition is good to a few units in the
/// last place; outside, F_E itself is decomposed.
inline constexpr double eigen_lo = 0.1, eigen_hi = 4;

template <class Real>
inline constexpr int eigen_sweeps = sizeof(Real) == 4 ? 3 : 5;

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

/// Fixed-corotated stress of particles whose strain is small (and, for snow, inside the
/// thresholds), by the square root of b = F_E F_E^T:
///   psi = mu |F_E - R|^2 + lambda/2 (J_E - 1)^2                          (the paper, equation 1)
///   tau = 2 mu (F_E - R) F_E^T + lambda (J_E - 1) J_E I = 2 mu (b - sqrt(b)) + ...
/// F_E and J_P keep their bits. @return the lanes where this holds
template <class V>
NEVE_INLINE MaskOf<V> corotated_near_identity(MaterialLanes<V>& m, bool is_plastic) {
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
NEVE_INLINE void corotated_stress(MaterialLanes<V>& m, const V* s, const V* U) {
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

/// The snow's projection of one stretch: clamped to [1 - theta_c, 1 + theta_s]; what is cut off
/// goes into J_P (the paper, section 7, equations 11 and 12). A negative stretch, of a particle
/// turned inside out, is turned back: it counts by its size, so that J_P stays positive.
template <class V>
NEVE_INLINE V clamp_stretch(MaterialLanes<V>& m, V s, V& cut) {
  const V clamped = smaller_lanes(larger_lanes(s, m.lo()), m.hi());
  cut = s != clamped ? cut * (absolute_lanes(s) / clamped) : cut;
  return clamped;
}

/// J_P after a projection that cut off `cut`, where it did: J_P' = J_P |s1 s2 s3| / (s1' s2' s3'),
/// held in the range of the material. Beyond the range F_P is forgotten, F_E and its stress are
/// not: snow yields on at constant stiffness. NaN stays NaN.
template <class V>
NEVE_INLINE void move_J_P(MaterialLanes<V>& m, V cut, MaskOf<V> is_cut) {
  using M = MaterialLanes<V>;
  const V least = m.word[M::word_min_J_P], most = m.word[M::word_max_J_P];
  V moved = m.J_P() * cut;
  moved = moved < least ? least : moved;
  moved = moved > most ? most : moved;
  m.J_P() = is_cut ? moved : m.J_P();
}

/// The lanes whose F_E is well enough conditioned for the eigenvalues of b.
template <class V>
NEVE_INLINE MaskOf<V> is_well_conditioned(MaterialLanes<V>& m, const Sym3<V>& b) {
  using Real = ElementOf<V>;
  const V lo = all<V>(Real(eigen_lo)), hi = all<V>(Real(eigen_hi));
  return (determinant(m.F()) > V{}) & has_eigenvalues_within(b, lo, hi);
}

/// The same stress by the eigenvalues of b, with the projection of snow where `is_plastic`:
/// F_E' = U diag(s'/s) U^T F_E, written as a correction to F_E.
template <class V>
NEVE_INLINE void corotated_by_eigenvalues(MaterialLanes<V>& m, const SymmetricEigen<V>& eigen,
                                          bool is_plastic) {
  using Real = ElementOf<V>;
  const V* U = eigen.U;
  V s[3], change[3] = {}, cut = all<V>(1);
  for (int i = 0; i < 3; ++i) {
    const V found = square_root_lanes(eigen.l[i]);
    s[i] = found;
    if (!is_plastic) continue;
    s[i] = clamp_stretch(m, found, cut);
    change[i] = s[i] / found - Real(1);
  }
  if (is_plastic) {
    move_J_P(m, cut, cut != all<V>(1));
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
  corotated_stress(m, s, U);
}

/// The same for any F_E, also singular and inverted ones.
template <class V>
NEVE_INLINE void corotated_by_decomposition(MaterialLanes<V>& m, bool is_plastic) {
  const SignedSvd<V> svd = signed_svd_lanes(m.F());
  V s[3] = {svd.s[0], svd.s[1], svd.s[2]};
  if (is_plastic) {
    V cut = all<V>(1);
    MaskOf<V> is_cut{};
    for (int i = 0; i < 3; ++i) {
      s[i] = clamp_stretch(m, svd.s[i], cut);
      is_cut |= s[i] != svd.s[i];
    }
    move_J_P(m, cut, is_cut);
    for (int a = 0; a < 3; ++a)
      for (int c = 0; c < 3; ++c) {
        const V F = svd.U[3 * a] * s[0] * svd.V[3 * c] +
                    svd.U[3 * a + 1] * s[1] * svd.V[3 * c + 1] +
                    svd.U[3 * a + 2] * s[2] * svd.V[3 * c + 2];
        m.F()[3 * a + c] = is_cut ? F : m.F()[3 * a + c];
      }
  }
  corotated_stress(m, s, svd.U);
}

/// Compressible neo-Hookean stress:
///   psi = mu/2 (tr F^T F - 3) - mu ln J + lambda/2 (ln J)^2,  tau = mu (b - I) + lambda ln J I.
/// The energy is infinite at J = 0; below that the logarithm is held, and the run is told.
template <class V>
NEVE_INLINE void neo_hookean(MaterialLanes<V>& m) {
  using Real = ElementOf<V>;
  const V J = determinant(m.F()), one = all<V>(1);
  V mu, lambda;
  m.harden(mu, lambda);
  const Sym3<V> b = left_cauchy_green(m.F());
  const V log_J = logarithm_lanes(larger_lanes(J, all<V>(Real(1e-6))));
  m.set_tau(add_identity(mu * add_identity(b, -one), lambda * log_J));
  m.wave_modulus() = mu * (row_sum_norm(b) + one) + lambda * (one + absolute_lanes(log_J));
}

/// Projects F_E (snow) and recomputes tau from it, for batches of one model. Most particles take
/// the cheap way; those that yield or are far from the identity are moved together into full lanes.
/// The grouping of lanes changes no bit.
template <class Real, class Set, int max_batches>
class MaterialUpdate {
 public:
  static constexpr int W = Set::template lanes<Real>;
  using V = Lanes<Real, W>;
  using M = MaterialLanes<V>;

  /// @param look          look(k, batch, wave modulus): called for every batch as the cheap way
  ///                      leaves it, also of particles that need the other
  /// @param count         of particles; the last batch may have lanes to spare
  /// @param is_projected  false leaves F_E and J_P as they are: stress of a state, at the start
  /// @param wave_modulus  per batch, out
  /// @param is_inverted   per batch, out: a bit for every lane with det F_E <= 0 before projection
  template <class Look>
  NEVE_NOINLINE void operator()(ParticleLanes<Real, W>* batch, int count, ModelKind model,
                                const MaterialConstants<Real>* table, bool is_projected,
                                V* wave_modulus, unsigned* is_inverted, const Look& look) {
    if (model == ModelKind::cam_clay || model == ModelKind::sand) {
      for (int k = 0; k * W < count; ++k) {
        const unsigned used = lane_bits(first_lanes<MaskOf<V>>(count - k * W));
        is_inverted[k] = used & (model == ModelKind::sand
                                     ? as_sand(batch[k], table, is_projected, wave_modulus[k])
                                     : as_clay(batch[k], table, is_projected, wave_modulus[k]));
        look(k, batch[k], wave_modulus[k]);
      }
      return;
    }
    const bool is_plastic = is_projected && model == ModelKind::snow;
    unsigned rest[max_batches];
    int packed = 0;
    for (int k = 0; k * W < count; ++k) {
      M m;
      take_lanes(batch[k], table, m);
      const unsigned used = lane_bits(first_lanes<MaskOf<V>>(count - k * W));
      is_inverted[k] = used & ~lane_bits(determinant(m.F()) > V{});
      rest[k] = 0;
      if (model == ModelKind::neo_hookean)
        neo_hookean(m);
      else
        rest[k] = used & ~lane_bits(corotated_near_identity(m, is_plastic));
      keep_stress(m, batch[k], wave_modulus[k]);
      look(k, batch[k], wave_modulus[k]);
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

  NEVE_INLINE static void keep_stress(M& m, ParticleLanes<Real, W>& p, V& wave_modulus) {
    for (int q = 0; q < 6; ++q) p.tau[q] = m.word[M::word_tau + q];
    wave_modulus = m.wave_modulus();
  }

  NEVE_NOINLINE static unsigned as_clay(ParticleLanes<Real, W>& p,
                                        const MaterialConstants<Real>* table, bool is_projected,
                                        V& wave_modulus) {
    return cam_clay(p, table, is_projected, wave_modulus);
  }
  NEVE_NOINLINE static unsigned as_sand(ParticleLanes<Real, W>& p,
                                        const MaterialConstants<Real>* table, bool is_projected,
                                        V& wave_modulus) {
    return sand(p, table, is_projected, wave_modulus);
  }

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
      corotated_by_eigenvalues(m[n], eigen[n], is_plastic);
      if (rest[n] != 0) decompose_rest(m[n], q + n * W, rest[n], is_plastic);
      for (int w = 0; w < M::word_mu; ++w) store_lanes(m[n].word[w], packed_[w] + q + n * W);
    });
  }

  /// Lanes `rest` of the batch at q again, by F_E itself.
  NEVE_NOINLINE void decompose_rest(M& m, int q, unsigned rest, bool is_plastic) {
    M again;
    for (int w = 0; w < M::words; ++w)
      if (!is_result(w)) again.word[w] = load_lanes<V>(packed_[w] + q);
    corotated_by_decomposition(again, is_plastic);
    Integer<Real> is_rest[W];
    for (int l = 0; l < W; ++l) is_rest[l] = -static_cast<Integer<Real>>(rest >> l & 1);
    const auto mask = load_lanes<MaskOf<V>>(is_rest);
    for (int w = 0; w < M::word_mu; ++w) m.word[w] = mask ? again.word[w] : m.word[w];
  }

  Real packed_[M::words][(max_batches + 1) * W] = {};
};

}  // namespace neve::sim::kernels
