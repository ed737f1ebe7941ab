#pragma once
/// Decompositions of 3x3 matrices for kernels: signed SVD, and the square root of F F^T near I.

#include "sim/base/lanes.h"

namespace neve::sim {

/// Symmetric 3x3 as xx yy zz xy xz yz.
template <class Real>
struct Sym3 {
  Real xx, yy, zz, xy, xz, yz;
};

template <class Real>
NEVE_INLINE Sym3<Real> operator+(const Sym3<Real>& a, const Sym3<Real>& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
}
template <class Real>
NEVE_INLINE Sym3<Real> operator*(Real s, const Sym3<Real>& a) {
  return {s * a.xx, s * a.yy, s * a.zz, s * a.xy, s * a.xz, s * a.yz};
}
/// a + s I
template <class Real>
NEVE_INLINE Sym3<Real> add_identity(const Sym3<Real>& a, Real s) {
  return {a.xx + s, a.yy + s, a.zz + s, a.xy, a.xz, a.yz};
}
/// a b for commuting symmetric matrices, where the product is symmetric.
template <class Real>
NEVE_INLINE Sym3<Real> commuting_product(const Sym3<Real>& a, const Sym3<Real>& b) {
  return {a.xx * b.xx + a.xy * b.xy + a.xz * b.xz, a.xy * b.xy + a.yy * b.yy + a.yz * b.yz,
          a.xz * b.xz + a.yz * b.yz + a.zz * b.zz, a.xx * b.xy + a.xy * b.yy + a.xz * b.yz,
          a.xx * b.xz + a.xy * b.yz + a.xz * b.zz, a.xy * b.xz + a.yy * b.yz + a.yz * b.zz};
}
template <class Real>
NEVE_INLINE Sym3<Real> inverse(const Sym3<Real>& a) {
  const Sym3<Real> c{a.yy * a.zz - a.yz * a.yz, a.xx * a.zz - a.xz * a.xz,
                     a.xx * a.yy - a.xy * a.xy, a.xz * a.yz - a.xy * a.zz,
                     a.xy * a.yz - a.xz * a.yy, a.xy * a.xz - a.xx * a.yz};
  return (Real(1) / (a.xx * c.xx + a.xy * c.xy + a.xz * c.xz)) * c;
}
/// All eigenvalues > 0, by the leading minors.
template <class Real>
NEVE_INLINE bool is_positive_definite(const Sym3<Real>& a) {
  const Real minor = a.xx * a.yy - a.xy * a.xy;
  const Real det =
      a.zz * minor - a.yz * (a.xx * a.yz - a.xy * a.xz) + a.xz * (a.xy * a.yz - a.yy * a.xz);
  return a.xx > Real(0) && minor > Real(0) && det > Real(0);
}
/// Largest absolute row sum: no eigenvalue is larger.
template <class Real>
NEVE_INLINE Real row_sum_norm(const Sym3<Real>& a) {
  const Real xy = absolute(a.xy), xz = absolute(a.xz), yz = absolute(a.yz);
  return larger(absolute(a.xx) + xy + xz,
                larger(absolute(a.yy) + xy + yz, absolute(a.zz) + xz + yz));
}

template <class Real>
NEVE_INLINE Real determinant(const Real* F) {
  return F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
         F[2] * (F[3] * F[7] - F[4] * F[6]);
}

/// b = F F^T
template <class Real>
NEVE_INLINE Sym3<Real> left_cauchy_green(const Real* F) {
  return {F[0] * F[0] + F[1] * F[1] + F[2] * F[2], F[3] * F[3] + F[4] * F[4] + F[5] * F[5],
          F[6] * F[6] + F[7] * F[7] + F[8] * F[8], F[0] * F[3] + F[1] * F[4] + F[2] * F[5],
          F[0] * F[6] + F[1] * F[7] + F[2] * F[8], F[3] * F[6] + F[4] * F[7] + F[5] * F[8]};
}

/// sqrt(b) - I for b whose eigenvalues lie in [0.49, 1.83] (stretches 0.7 to 1.35).
/// Newton's iteration for the square root from (I + b)/2, then the identity
/// sqrt(b) - I = (b - I)(I + sqrt(b))^-1, which has no cancellation at small strain and damps what
/// error is left: below 1e-6 of the strain after 2 rounds, below 1e-15 after 4.
template <class Real>
NEVE_INLINE Sym3<Real> root_minus_identity(const Sym3<Real>& b) {
  constexpr int rounds = sizeof(Real) == 4 ? 2 : 4;
  Sym3<Real> y = Real(0.5) * add_identity(b, Real(1));
  for (int k = 0; k < rounds; ++k) y = Real(0.5) * (y + commuting_product(inverse(y), b));
  return commuting_product(add_identity(b, Real(-1)), inverse(add_identity(y, Real(1))));
}

/// F = U diag(s) V^T with proper rotations U and V; the smallest |s| carries the sign of det F.
template <class Real>
struct SignedSvd {
  Real U[9], V[9];  ///< row by row
  Real s[3];        ///< unsorted
};

/// Sum of the first three lanes of a product.
template <class Real>
NEVE_INLINE Real dot3(Quad<Real> a, Quad<Real> b) {
  const Quad<Real> product = a * b;
  return product[0] + product[1] + product[2];
}

/// Turns two rows of G, and the columns of U with them, until the rows are orthogonal.
/// @return whether they were not
template <class Real>
NEVE_INLINE bool make_orthogonal(Quad<Real>& g_p, Quad<Real>& g_q, Quad<Real>& u_p, Quad<Real>& u_q,
                                 Real tolerance) {
  const Real pp = dot3<Real>(g_p, g_p), qq = dot3<Real>(g_q, g_q), pq = dot3<Real>(g_p, g_q);
  if (!(pq * pq > tolerance * tolerance * pp * qq)) return false;
  const Real d = qq - pp, e = pq + pq;
  const Real t_abs = absolute(e) / (absolute(d) + square_root(d * d + e * e));
  const Real t = (d < Real(0)) != (e < Real(0)) ? -t_abs : t_abs;
  const Real c = Real(1) / square_root(Real(1) + t * t), s = c * t;
  const Quad<Real> g = g_p, u = u_p;
  g_p = g * c - g_q * s;
  g_q = g * s + g_q * c;
  u_p = u * c - u_q * s;
  u_q = u * s + u_q * c;
  return true;
}

/// One-sided Jacobi: turns pairs of rows of F until all are orthogonal, so small singular values
/// keep their relative accuracy, which F F^T would lose. Total for any finite F, also singular
/// ones. Source: Hestenes 1958; Golub and Van Loan, Matrix Computations, section 8.6.
template <class Real>
NEVE_INLINE SignedSvd<Real> signed_svd(const Real* F) {
  constexpr Real tolerance = sizeof(Real) == 4 ? Real(2e-7) : Real(2e-16);
  constexpr int most_sweeps = 12;
  // F is scaled to a largest entry of 1, so that no square underflows or overflows.
  Real scale = 0;
  for (int q = 0; q < 9; ++q) scale = larger(scale, absolute(F[q]));
  const Real inv_scale = scale > Real(0) ? Real(1) / scale : Real(0);
  Quad<Real> g0 = Quad<Real>{F[0], F[1], F[2], 0} * inv_scale;
  Quad<Real> g1 = Quad<Real>{F[3], F[4], F[5], 0} * inv_scale;
  Quad<Real> g2 = Quad<Real>{F[6], F[7], F[8], 0} * inv_scale;
  Quad<Real> u0{1, 0, 0, 0}, u1{0, 1, 0, 0}, u2{0, 0, 1, 0};  // columns of U
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    bool has_turned = make_orthogonal<Real>(g0, g1, u0, u1, tolerance);
    has_turned |= make_orthogonal<Real>(g0, g2, u0, u2, tolerance);
    has_turned |= make_orthogonal<Real>(g1, g2, u1, u2, tolerance);
    if (!has_turned) break;
  }
  Real g[3][3], u[3][3];
  for (int a = 0; a < 3; ++a) {
    g[0][a] = g0[a], g[1][a] = g1[a], g[2][a] = g2[a];
    u[0][a] = u0[a], u[1][a] = u1[a], u[2][a] = u2[a];
  }

  // The two larger rows fix two axes of V; the third is their cross product, so V is proper and the
  // third singular value takes the sign.
  Real norm[3];
  for (int i = 0; i < 3; ++i)
    norm[i] = square_root(g[i][0] * g[i][0] + g[i][1] * g[i][1] + g[i][2] * g[i][2]);
  int n = norm[1] < norm[0] ? 1 : 0;
  if (norm[2] < norm[n]) n = 2;
  int p = (n + 1) % 3, q = (n + 2) % 3;
  Real v[3][3];
  const bool is_swapped = norm[p] < norm[q];
  const int first = is_swapped ? q : p, second = is_swapped ? p : q;
  if (norm[first] > Real(0)) {
    for (int a = 0; a < 3; ++a) v[first][a] = g[first][a] / norm[first];
  } else {
    for (int a = 0; a < 3; ++a) v[first][a] = a == first ? Real(1) : Real(0);
  }
  if (norm[second] > tolerance * norm[first] && norm[second] > Real(0)) {
    for (int a = 0; a < 3; ++a) v[second][a] = g[second][a] / norm[second];
  } else {
    // Rank one: any direction across the first will do; take the axis it leans on least.
    int least = absolute(v[first][1]) < absolute(v[first][0]) ? 1 : 0;
    if (absolute(v[first][2]) < absolute(v[first][least])) least = 2;
    Real square = 0;
    for (int a = 0; a < 3; ++a) {
      v[second][a] = (a == least ? Real(1) : Real(0)) - v[first][least] * v[first][a];
      square += v[second][a] * v[second][a];
    }
    const Real inv_length = Real(1) / square_root(square);
    for (int a = 0; a < 3; ++a) v[second][a] *= inv_length;
  }
  SignedSvd<Real> out;
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    v[n][a] = v[p][b] * v[q][c] - v[p][c] * v[q][b];
  }
  for (int i = 0; i < 3; ++i) {
    out.s[i] = scale * (g[i][0] * v[i][0] + g[i][1] * v[i][1] + g[i][2] * v[i][2]);
    for (int a = 0; a < 3; ++a) {
      out.U[3 * a + i] = u[i][a];
      out.V[3 * a + i] = v[i][a];
    }
  }
  return out;
}

}  // namespace neve::sim
