#pragma once
/// Parts of the change of stress with strain, D = dP F_E^T for dF = G F_E, that laws share.

#include "sim/kernels/law.h"

namespace neve::sim::laws {

using namespace kernels;

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

/// D + on_transpose G^T + on_identity I
template <class V>
NEVE_INLINE void add_volume_change(const V& on_transpose, const V& on_identity, const V* G, V* D) {
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) D[3 * a + b] = fused(on_transpose, G[3 * b + a], D[3 * a + b]);
  for (int a = 0; a < 9; a += 4) D[a] += on_identity;
}

/// Hooke's law at what F_E has become: D = mu (G + G^T) + lambda tr G I. For a law that has no
/// derivative of its own: the solve of semi-implicit steps then takes a stiffness that is right at
/// rest.
template <class V, class I>
NEVE_INLINE Elasticity<V> small_strain(const Record<V, I>& p,
                                       const MaterialConstants<ElementOf<V>>* table) {
  V mu{}, lambda{};
  const I material = p.material();
  for (int l = 0; l < lane_count<V>; ++l)
    mu[l] = table[material[l]].mu0, lambda[l] = table[material[l]].lambda0;
  return {Sym3<V>{}, p.V0 * p.stiffness * mu, p.V0 * p.stiffness * lambda};
}
template <class V>
NEVE_INLINE void small_strain_change(const Elasticity<V>& e, const V* G, V* D) {
  for (int q = 0; q < 9; ++q) D[q] = e.V0_mu * G[q];
  add_volume_change(e.V0_mu, e.V0_lambda * (G[0] + G[4] + G[8]), G, D);
}

}  // namespace neve::sim::laws
