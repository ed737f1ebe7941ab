#pragma once
/// Decompositions of 3x3 matrices in lanes: each lane for itself, so that what a lane finds does
/// not depend on its neighbours.

#include "sim/base/lanes.h"

namespace neve::sim::kernels {

/// Symmetric 3x3 as xx yy zz xy xz yz; V is lanes.
template <class V>
struct Sym3 {
  V xx, yy, zz, xy, xz, yz;
};

template <class V>
NEVE_INLINE Sym3<V> operator+(const Sym3<V>& a, const Sym3<V>& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
}
template <class V>
NEVE_INLINE Sym3<V> operator-(const Sym3<V>& a, const Sym3<V>& b) {
  return {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.xz - b.xz, a.yz - b.yz};
}
template <class V>
NEVE_INLINE Sym3<V> operator*(V s, const Sym3<V>& a) {
  return {s * a.xx, s * a.yy, s * a.zz, s * a.xy, s * a.xz, s * a.yz};
}
/// a + s I
template <class V>
NEVE_INLINE Sym3<V> add_identity(const Sym3<V>& a, V s) {
  return {a.xx + s, a.yy + s, a.zz + s, a.xy, a.xz, a.yz};
}
/// a b for commuting symmetric matrices, where the product is symmetric.
template <class V>
NEVE_INLINE Sym3<V> commuting_product(const Sym3<V>& a, const Sym3<V>& b) {
  return {fused(a.xx, b.xx, fused(a.xy, b.xy, a.xz * b.xz)),
          fused(a.xy, b.xy, fused(a.yy, b.yy, a.yz * b.yz)),
          fused(a.xz, b.xz, fused(a.yz, b.yz, a.zz * b.zz)),
          fused(a.xx, b.xy, fused(a.xy, b.yy, a.xz * b.yz)),
          fused(a.xx, b.xz, fused(a.xy, b.yz, a.xz * b.zz)),
          fused(a.xy, b.xz, fused(a.yy, b.yz, a.yz * b.zz))};
}
/// All eigenvalues > 0 beyond rounding, by the leading minors. Entries are differences of numbers
/// of order 1, each off by some units in the last place: what that may do to a minor is asked for.
template <class V>
NEVE_INLINE MaskOf<V> is_positive_definite(const Sym3<V>& a) {
  using Real = ElementOf<V>;
  constexpr Real unit = sizeof(Real) == 4 ? Real(1e-6) : Real(2e-15);
  const V minor = fused_negative(a.xy, a.xy, a.xx * a.yy);
  const V p = fused_negative(a.xy, a.xz, a.xx * a.yz), q = fused_negative(a.yy, a.xz, a.xy * a.yz);
  const V det = fused(a.zz, minor, fused(a.xz, q, -a.yz * p));
  const V xx = absolute_lanes(a.xx), yy = absolute_lanes(a.yy), zz = absolute_lanes(a.zz);
  const V minor_noise = unit * (xx + yy), det_noise = unit * fused(xx, yy, zz * (xx + yy));
  return smaller_lanes(a.xx, smaller_lanes(minor - minor_noise, det - det_noise)) > V{};
}
/// All eigenvalues of b in (lo, hi).
template <class V>
NEVE_INLINE MaskOf<V> has_eigenvalues_within(const Sym3<V>& b, V lo, V hi) {
  const Sym3<V> below{hi - b.xx, hi - b.yy, hi - b.zz, -b.xy, -b.xz, -b.yz};
  return is_positive_definite(add_identity(b, -lo)) & is_positive_definite(below);
}
/// Largest absolute row sum: no eigenvalue is larger.
template <class V>
NEVE_INLINE V row_sum_norm(const Sym3<V>& a) {
  const V xy = absolute_lanes(a.xy), xz = absolute_lanes(a.xz), yz = absolute_lanes(a.yz);
  return larger_lanes(absolute_lanes(a.xx) + xy + xz,
                      larger_lanes(absolute_lanes(a.yy) + xy + yz, absolute_lanes(a.zz) + xz + yz));
}

/// Determinant of a matrix given row by row.
template <class V>
NEVE_INLINE V determinant(const V* F) {
  const V x = fused_negative(F[5], F[7], F[4] * F[8]), y = fused_negative(F[5], F[6], F[3] * F[8]);
  const V z = fused_negative(F[4], F[6], F[3] * F[7]);
  return fused(F[2], z, fused_negative(F[1], y, F[0] * x));
}

template <class V>
NEVE_INLINE V determinant(const Sym3<V>& a) {
  const V F[9] = {a.xx, a.xy, a.xz, a.xy, a.yy, a.yz, a.xz, a.yz, a.zz};
  return determinant(F);
}

template <class V>
NEVE_INLINE V dot3(const V* a, const V* b) {
  return fused(a[0], b[0], fused(a[1], b[1], a[2] * b[2]));
}

/// b = F F^T
template <class V>
NEVE_INLINE Sym3<V> left_cauchy_green(const V* F) {
  return {dot3(F, F),     dot3(F + 3, F + 3), dot3(F + 6, F + 6),
          dot3(F, F + 3), dot3(F, F + 6),     dot3(F + 3, F + 6)};
}

/// Largest |eigenvalue of b - I| for which root_minus_identity holds.
inline constexpr double series_radius = 0.1;

/// sqrt(b) - I = sum of binomial(1/2, k) (b - I)^k from k = 1: no cancellation at small strain. The
/// truncation error is below 5e-7 of the strain in float and 1e-15 in double.
template <class V>
NEVE_INLINE Sym3<V> root_minus_identity(const Sym3<V>& b) {
  using Real = ElementOf<V>;
  constexpr int degree = sizeof(Real) == 4 ? 5 : 13;
  Real coefficient[degree + 1] = {1};
  for (int k = 1; k <= degree; ++k)
    coefficient[k] = coefficient[k - 1] * (Real(1.5) - static_cast<Real>(k)) / static_cast<Real>(k);
  const Sym3<V> e = add_identity(b, all<V>(-1));
  Sym3<V> sum = add_identity(all<V>(coefficient[degree]) * e, all<V>(coefficient[degree - 1]));
  for (int k = degree - 2; k >= 1; --k)
    sum = add_identity(commuting_product(sum, e), all<V>(coefficient[k]));
  return commuting_product(sum, e);
}

/// b = U diag(l) U^T: columns of U, row by row.
template <class V>
struct SymmetricEigen {
  V U[9], l[3];
};

/// Turns axes p and q so that entry pq becomes 0; r is the third axis. Without a division: the
/// doubled angle's cosine and sine are (d, e) / |(d, e)|, halved by cos^2 = (1 + cos 2 angle) / 2.
template <class V>
NEVE_INLINE void jacobi_rotation(V& pp, V& qq, V& pq, V& rp, V& rq, V* U, int p, int q) {
  using Real = ElementOf<V>;
  const V half = all<V>(0.5), zero{};
  const V d = qq - pp, e = pq + pq;
  // Keeps two equal eigenvalues apart: their angle is 0, not 0/0.
  const V d_abs =
      larger_lanes(absolute_lanes(d), all<V>(sizeof(Real) == 4 ? Real(1e-15) : Real(1e-100)));
  const V inv_r = inverse_square_root(fused(d_abs, d_abs, e * e));
  const V cos_squared = fused(half, d_abs * inv_r, half);
  const V inv_cos = inverse_square_root(cos_squared);
  const V c = cos_squared * inv_cos;
  const V s_abs = half * e * inv_r * inv_cos;
  const V s = d < zero ? -s_abs : s_abs;
  const V shift = s * inv_cos * pq;
  pp = pp - shift;
  qq = qq + shift;
  pq = zero;
  const auto turn = [&](V& a, V& b) NEVE_INLINE_BODY {
    const V was = a;
    a = fused_negative(s, b, c * was);
    b = fused(s, was, c * b);
  };
  turn(rp, rq);
  for (int axis = 0; axis < 3; ++axis) turn(U[3 * axis + p], U[3 * axis + q]);
}

/// Cyclic Jacobi for N matrices b with entries of order 1 and eigenvalues not more than a
/// hundredfold apart. A fixed number of sweeps: convergence is quadratic, and no lane waits for
/// another. The matrices take turns, since one rotation waits for the one before it. Source: Golub
/// and Van Loan, Matrix Computations, section 8.5.
template <int N, int sweeps, class V>
NEVE_INLINE void symmetric_eigen(Sym3<V>* b, SymmetricEigen<V>* out) {
  unrolled<N>([&](auto n) NEVE_INLINE_BODY {
    for (int q = 0; q < 9; ++q) out[n].U[q] = all<V>(q % 4 == 0 ? 1 : 0);
  });
#pragma GCC unroll 1
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    unrolled<N>([&](auto n) NEVE_INLINE_BODY {
      jacobi_rotation(b[n].xx, b[n].yy, b[n].xy, b[n].xz, b[n].yz, out[n].U, 0, 1);
    });
    unrolled<N>([&](auto n) NEVE_INLINE_BODY {
      jacobi_rotation(b[n].xx, b[n].zz, b[n].xz, b[n].xy, b[n].yz, out[n].U, 0, 2);
    });
    unrolled<N>([&](auto n) NEVE_INLINE_BODY {
      jacobi_rotation(b[n].yy, b[n].zz, b[n].yz, b[n].xy, b[n].xz, out[n].U, 1, 2);
    });
  }
  unrolled<N>([&](auto n) NEVE_INLINE_BODY {
    out[n].l[0] = b[n].xx;
    out[n].l[1] = b[n].yy;
    out[n].l[2] = b[n].zz;
  });
}

/// F = U diag(s) V^T with proper rotations U and V, s[0] >= s[1] >= |s[2]|; s[2] has the sign of
/// det F. Matrices row by row.
template <class T>
struct SignedSvd {
  T U[9], V[9];
  T s[3];
};

/// A row of G and the column of U that belongs to it.
template <class V>
struct JacobiRow {
  V g[3], u[3];
};

/// Turns two rows of G, and the columns of U with them, until the rows are orthogonal, in the lanes
/// where they are not yet. @return those lanes
template <class V>
NEVE_INLINE MaskOf<V> make_orthogonal(JacobiRow<V>& p, JacobiRow<V>& q, V tolerance_squared) {
  const V pp = dot3(p.g, p.g), qq = dot3(q.g, q.g), pq = dot3(p.g, q.g);
  const MaskOf<V> is_turned = pq * pq > tolerance_squared * pp * qq;
  const V zero{}, one = all<V>(1);
  const V d = qq - pp, e = pq + pq;
  const V t_abs = absolute_lanes(e) / (absolute_lanes(d) + square_root_lanes(d * d + e * e));
  const V t = (d < zero) != (e < zero) ? -t_abs : t_abs;
  const V inv = one / square_root_lanes(one + t * t);
  const V c = is_turned ? inv : one, s = is_turned ? inv * t : zero;
  for (int a = 0; a < 3; ++a) {
    const V g = p.g[a], u = p.u[a];
    p.g[a] = fused_negative(s, q.g[a], c * g);
    q.g[a] = fused(s, g, c * q.g[a]);
    p.u[a] = fused_negative(s, q.u[a], c * u);
    q.u[a] = fused(s, u, c * q.u[a]);
  }
  return is_turned;
}

/// Applies a quarter turn where `mask` is set: (p, q) becomes (q, -p), which swaps their lengths
/// and keeps U proper.
template <class V>
NEVE_INLINE void quarter_turn(JacobiRow<V>& p, JacobiRow<V>& q, V& length_p, V& length_q,
                              MaskOf<V> mask) {
  for (int a = 0; a < 3; ++a) {
    const V g = p.g[a], u = p.u[a];
    p.g[a] = mask ? q.g[a] : g;
    q.g[a] = mask ? -g : q.g[a];
    p.u[a] = mask ? q.u[a] : u;
    q.u[a] = mask ? -u : q.u[a];
  }
  const V swapped = length_p;
  length_p = mask ? length_q : length_p;
  length_q = mask ? swapped : length_q;
}

/// One-sided Jacobi: turns pairs of rows of F until all are orthogonal, so small singular values
/// keep their relative accuracy, which F F^T would lose. Total for any finite F, also singular
/// ones. Source: Hestenes 1958; Golub and Van Loan, Matrix Computations, section 8.6.
template <class V>
NEVE_INLINE SignedSvd<V> signed_svd_lanes(const V* F) {
  using Real = ElementOf<V>;
  constexpr Real tolerance = sizeof(Real) == 4 ? Real(4e-7) : Real(4e-16);
  constexpr int max_sweeps = 12;
  const V zero{}, one = all<V>(1);
  // F is scaled to a largest entry of 1, so that no square underflows or overflows.
  V scale = zero;
  for (int q = 0; q < 9; ++q) scale = larger_lanes(scale, absolute_lanes(F[q]));
  const V inv_scale = scale > zero ? one / scale : zero;
  JacobiRow<V> row[3];
  for (int i = 0; i < 3; ++i)
    for (int a = 0; a < 3; ++a) {
      row[i].g[a] = F[3 * i + a] * inv_scale;
      row[i].u[a] = i == a ? one : zero;
    }
  const V limit = all<V>(tolerance * tolerance);
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    MaskOf<V> has_turned = make_orthogonal(row[0], row[1], limit);
    has_turned |= make_orthogonal(row[0], row[2], limit);
    has_turned |= make_orthogonal(row[1], row[2], limit);
    if (!any_lane(has_turned)) break;
  }
  V length[3];
  for (int i = 0; i < 3; ++i) length[i] = square_root_lanes(dot3(row[i].g, row[i].g));
  quarter_turn(row[0], row[1], length[0], length[1], length[0] < length[1]);
  quarter_turn(row[1], row[2], length[1], length[2], length[1] < length[2]);
  quarter_turn(row[0], row[1], length[0], length[1], length[0] < length[1]);

  // The two larger rows fix two axes of V; the third is their cross product, so V is proper and the
  // third singular value takes the sign.
  V v[3][3];
  const MaskOf<V> is_zero = !(length[0] > zero);
  for (int a = 0; a < 3; ++a) v[0][a] = is_zero ? (a == 0 ? one : zero) : row[0].g[a] / length[0];
  // Rank one: any direction across the first will do.
  const MaskOf<V> is_line = !(length[1] > all<V>(tolerance) * length[0]);
  const MaskOf<V> takes_x = absolute_lanes(v[0][0]) < all<V>(Real(0.6));
  const V lean = takes_x ? v[0][0] : v[0][1];
  const V inv_across = one / square_root_lanes(one - lean * lean);
  for (int a = 0; a < 3; ++a) {
    const V axis = takes_x ? (a == 0 ? one : zero) : (a == 1 ? one : zero);
    v[1][a] = is_line ? (axis - lean * v[0][a]) * inv_across : row[1].g[a] / length[1];
  }
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    v[2][a] = v[0][b] * v[1][c] - v[0][c] * v[1][b];
  }
  SignedSvd<V> out;
  for (int i = 0; i < 3; ++i) {
    out.s[i] = scale * dot3(row[i].g, v[i]);
    for (int a = 0; a < 3; ++a) {
      out.U[3 * a + i] = row[i].u[a];
      out.V[3 * a + i] = v[i][a];
    }
  }
  return out;
}

/// The same for one matrix.
template <class Real>
inline SignedSvd<Real> signed_svd(const Real* F) {
  Quad<Real> lanes[9];
  for (int q = 0; q < 9; ++q) lanes[q] = all<Quad<Real>>(F[q]);
  const SignedSvd<Quad<Real>> svd = signed_svd_lanes(lanes);
  SignedSvd<Real> out;
  for (int q = 0; q < 9; ++q) {
    out.U[q] = svd.U[q][0];
    out.V[q] = svd.V[q][0];
  }
  for (int i = 0; i < 3; ++i) out.s[i] = svd.s[i][0];
  return out;
}

}  // namespace neve::sim::kernels
