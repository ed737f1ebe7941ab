#pragma once
/// Change of the stress of particles with their strain, in lanes: the parts of the Hessian of the
/// elastic energy.
///
/// With dF = G F_E for a gradient G of displacements, the nodes feel -sum V0 D grad_w_ip, where
/// D = dP F_E^T. Written with the left stretch V (F_E = V R) and b = V^2, R drops out:
///   corotated    D = 2 mu (G V - [w]x) V + lambda J (2 J - 1) tr G I - lambda J (J - 1) G^T,
///                dR = [w]x R, (tr V I - V) w = axial(G V - V G^T)
///   neo-Hookean  D = mu (G b + G^T) + lambda (tr G I - ln J G^T)
///   cam clay     D = a (G b + t G^T - 2/3 tr(G b) I - 2/3 tr G (b - t I)) + K J^2 tr G I
///                    - K/2 (J^2 - 1) G^T,   a = mu J^(-2/3), t = tr b/3, at a fixed plastic state
/// Source: derivatives of the stresses of constitutive.h; dR as in the paper's technical report.

#include "sim/kernels/constitutive.h"

namespace neve::sim::kernels {

/// Data kept of a particle during a solve: two quads.
template <class V>
struct Elasticity {
  Sym3<V> shape;       ///< V of snow and corotated, b of the others
  V V0_mu, V0_lambda;  ///< hardened, J; of cam clay mu and K
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

template <class V, class I>
NEVE_INLINE Elasticity<V> elasticity(const Record<V, I>& p, ModelKind model,
                                     const MaterialConstants<ElementOf<V>>* table) {
  if (model == ModelKind::cam_clay) {
    const CamClayLanes<V> m = take_cam_clay(p, table);
    return {left_cauchy_green(p.F_E), p.V0 * m.mu, p.V0 * m.K};
  }
  if (model == ModelKind::sand) {
    const SandLanes<V> m = take_sand(p, table);
    return {left_cauchy_green(p.F_E), p.V0 * m.mu, p.V0 * m.lambda};
  }
  MaterialLanes<V> m;
  take_lanes(p, table, m);
  V mu, lambda;
  m.harden(mu, lambda);
  const bool takes_b = model == ModelKind::neo_hookean;
  return {takes_b ? left_cauchy_green(p.F_E) : left_stretch(p.F_E), p.V0 * mu, p.V0 * lambda};
}

template <class V>
NEVE_INLINE V determinant(const Sym3<V>& a) {
  const V F[9] = {a.xx, a.xy, a.xz, a.xy, a.yy, a.yz, a.xz, a.yz, a.zz};
  return determinant(F);
}

/// M a, row by row.
template <class V>
NEVE_INLINE void times(const V* M, const Sym3<V>& a, V* out) {
  for (int row = 0; row < 9; row += 3) {
    const V x = M[row], y = M[row + 1], z = M[row + 2];
    out[row] = fused(x, a.xx, fused(y, a.xy, z * a.xz));
    out[row + 1] = fused(x, a.xy, fused(y, a.yy, z * a.yz));
    out[row + 2] = fused(x, a.xz, fused(y, a.yz, z * a.zz));
  }
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

/// V0 D for the gradient G of displacements, both row by row. @return in D, J per unit of G
template <class V>
NEVE_INLINE void stress_change(const Elasticity<V>& e, ModelKind model, const V* G, V* D) {
  using Real = ElementOf<V>;
  if (model == ModelKind::sand) return sand_stress_change(e.shape, e.V0_mu, e.V0_lambda, G, D);
  const V trace = G[0] + G[4] + G[8];
  V on_transpose, on_identity;
  if (model == ModelKind::cam_clay) {
    const Sym3<V>& b = e.shape;
    times(G, b, D);
    const V t = (b.xx + b.yy + b.zz) * Real(1.0 / 3), along = D[0] + D[4] + D[8];
    constexpr Real tiny = sizeof(Real) == 4 ? Real(1e-12) : Real(1e-24);
    const V J_squared = larger_lanes(determinant(b), all<V>(tiny));
    const V a = e.V0_mu * inverse_cube_root(J_squared), spread = Real(-2.0 / 3) * trace;
    const V b_row[9] = {b.xx, b.xy, b.xz, b.xy, b.yy, b.yz, b.xz, b.yz, b.zz};
    for (int q = 0; q < 9; ++q) D[q] = a * fused(spread, b_row[q], D[q]);
    on_transpose = fused(a, t, Real(-0.5) * e.V0_lambda * (J_squared - Real(1)));
    on_identity =
        fused(e.V0_lambda * J_squared, trace, -a * fused(spread, t, Real(2.0 / 3) * along));
  } else if (model == ModelKind::neo_hookean) {
    times(G, e.shape, D);
    // J^2 = det b; held where neo_hookean() holds it.
    const V log_J =
        Real(0.5) * logarithm_lanes(larger_lanes(determinant(e.shape), all<V>(Real(1e-12))));
    for (int q = 0; q < 9; ++q) D[q] = e.V0_mu * D[q];
    on_transpose = e.V0_mu - e.V0_lambda * log_J;
    on_identity = e.V0_lambda * trace;
  } else {
    const V J = determinant(e.shape);
    V GV[9], w[3];
    times(G, e.shape, GV);
    const V k[3] = {GV[7] - GV[5], GV[2] - GV[6], GV[3] - GV[1]};
    solve_for_spin(e.shape, k, w);
    GV[1] += w[2], GV[2] -= w[1], GV[3] -= w[2];
    GV[5] += w[0], GV[6] += w[1], GV[7] -= w[0];
    times(GV, e.shape, D);
    for (int q = 0; q < 9; ++q) D[q] = Real(2) * e.V0_mu * D[q];
    on_transpose = -e.V0_lambda * J * (J - Real(1));
    on_identity = e.V0_lambda * J * (Real(2) * J - Real(1)) * trace;
  }
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) D[3 * a + b] = fused(on_transpose, G[3 * b + a], D[3 * a + b]);
  for (int a = 0; a < 9; a += 4) D[a] += on_identity;
}

}  // namespace neve::sim::kernels
