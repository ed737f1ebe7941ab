#pragma once
/// Decompositions of 3x3 matrices in lanes: four particles at a time, each lane for itself, so that
/// what a lane finds does not depend on its neighbours.

#include "sim/base/lanes.h"

namespace neve::sim {

/// Symmetric 3x3 as xx yy zz xy xz yz; V is a Quad.
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
  return {a.xx * b.xx + a.xy * b.xy + a.xz * b.xz, a.xy * b.xy + a.yy * b.yy + a.yz * b.yz,
          a.xz * b.xz + a.yz * b.yz + a.zz * b.zz, a.xx * b.xy + a.xy * b.yy + a.xz * b.yz,
          a.xx * b.xz + a.xy * b.yz + a.xz * b.zz, a.xy * b.xz + a.yy * b.yz + a.yz * b.zz};
}
template <class V>
NEVE_INLINE Sym3<V> inverse(const Sym3<V>& a) {
  const Sym3<V> c{a.yy * a.zz - a.yz * a.yz, a.xx * a.zz - a.xz * a.xz, a.xx * a.yy - a.xy * a.xy,
                  a.xz * a.yz - a.xy * a.zz, a.xy * a.yz - a.xz * a.yy, a.xy * a.xz - a.xx * a.yz};
  return (all<V>(1) / (a.xx * c.xx + a.xy * c.xy + a.xz * c.xz)) * c;
}
/// All eigenvalues > 0, by the leading minors.
template <class V>
NEVE_INLINE MaskOf<V> is_positive_definite(const Sym3<V>& a) {
  const V minor = a.xx * a.yy - a.xy * a.xy;
  const V det =
      a.zz * minor - a.yz * (a.xx * a.yz - a.xy * a.xz) + a.xz * (a.xy * a.yz - a.yy * a.xz);
  const V zero{};
  return (a.xx > zero) & (minor > zero) & (det > zero);
}
/// Largest absolute row sum: no eigenvalue is larger.
template <class V>
NEVE_INLINE V row_sum_norm(const Sym3<V>& a) {
  const V xy = absolute_lanes(a.xy), xz = absolute_lanes(a.xz), yz = absolute_lanes(a.yz);
  return larger_lanes(absolute_lanes(a.xx) + xy + xz,
                      larger_lanes(absolute_lanes(a.yy) + xy + yz, absolute_lanes(a.zz) + xz + yz));
}

/// Of a matrix given row by row.
template <class T>
NEVE_INLINE T determinant(const T* F) {
  return F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
         F[2] * (F[3] * F[7] - F[4] * F[6]);
}

/// b = F F^T
template <class V>
NEVE_INLINE Sym3<V> left_cauchy_green(const V* F) {
  return {F[0] * F[0] + F[1] * F[1] + F[2] * F[2], F[3] * F[3] + F[4] * F[4] + F[5] * F[5],
          F[6] * F[6] + F[7] * F[7] + F[8] * F[8], F[0] * F[3] + F[1] * F[4] + F[2] * F[5],
          F[0] * F[6] + F[1] * F[7] + F[2] * F[8], F[3] * F[6] + F[4] * F[7] + F[5] * F[8]};
}

/// sqrt(b) - I for b whose eigenvalues lie in [0.49, 1.83] (stretches 0.7 to 1.35).
/// Newton's iteration for the square root from (I + b)/2, then the identity
/// sqrt(b) - I = (b - I)(I + sqrt(b))^-1, which has no cancellation at small strain and damps what
/// error is left: below 1e-6 of the strain after 2 rounds, below 1e-15 after 4.
template <class V>
NEVE_INLINE Sym3<V> root_minus_identity(const Sym3<V>& b) {
  constexpr int rounds = sizeof(V) == 16 ? 2 : 4;
  const V half = all<V>(0.5), one = all<V>(1);
  Sym3<V> y = half * add_identity(b, one);
  for (int k = 0; k < rounds; ++k) y = half * (y + commuting_product(inverse(y), b));
  return commuting_product(add_identity(b, -one), inverse(add_identity(y, one)));
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

template <class V>
NEVE_INLINE V dot3(const V* a, const V* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

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
    p.g[a] = c * g - s * q.g[a];
    q.g[a] = s * g + c * q.g[a];
    p.u[a] = c * u - s * q.u[a];
    q.u[a] = s * u + c * q.u[a];
  }
  return is_turned;
}

/// Where `mask`, a quarter turn: (p, q) becomes (q, -p), which swaps their lengths and keeps U
/// proper.
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
  constexpr double tolerance = sizeof(V) == 16 ? 4e-7 : 4e-16;
  constexpr int most_sweeps = 12;
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
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
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
  const MaskOf<V> takes_x = absolute_lanes(v[0][0]) < all<V>(0.6);
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

}  // namespace neve::sim
