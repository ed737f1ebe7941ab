#pragma once
/// B-spline weights of the 4 (cubic) or 3 (quadratic) nodes per axis around a particle.
/// Source: the paper, section 4 (cubic N); Steffen, Kirby, Berzins 2008 (quadratic).

#include "sim/base/lanes.h"

namespace neve::sim::kernels {

inline constexpr int cubic_nodes = 4;
inline constexpr int quadratic_nodes = 3;

/// D_p = h^2 times this, the inertia of the weights that APIC divides by (Jiang et al. 2015).
template <int K>
inline constexpr double apic_inertia = K == cubic_nodes ? 1.0 / 3.0 : 1.0 / 4.0;

/// N and N' of the stencil's nodes; `first` is the particle's place in [1, 2) (cubic) or [0.5, 1.5)
/// (quadratic) counted from the first node, a number or lanes. N' is in grid units: times 1/h is
/// the derivative with respect to x_p. The outer cubic pieces are written as cubes of the distance
/// to the end of the support, which cannot go negative.
template <class Real, class V>
NEVE_INLINE void spline(V first, V (&w)[cubic_nodes], V (&dw)[cubic_nodes]) {
  const V o = first - Real(1), a = Real(1) - o;
  w[0] = a * a * a * Real(1.0 / 6.0);
  w[1] = (Real(0.5) * o - Real(1)) * o * o + Real(2.0 / 3.0);
  w[3] = o * o * o * Real(1.0 / 6.0);
  // 1/6 and 2/3 are rounded: evaluated by itself, this one would make the sum 1 + 1e-7 in float,
  // and APIC would gain that share of its velocity every step.
  w[2] = Real(1) - (w[0] + w[1] + w[3]);
  dw[0] = Real(-0.5) * a * a;
  dw[1] = (Real(1.5) * o - Real(2)) * o;
  dw[2] = (Real(2) - Real(1.5) * a) * a;
  dw[3] = Real(0.5) * o * o;
}
template <class Real, class V>
NEVE_INLINE void spline(V first, V (&w)[quadratic_nodes], V (&dw)[quadratic_nodes]) {
  const V a = Real(1.5) - first, b = first - Real(1), c = first - Real(0.5);
  w[0] = Real(0.5) * a * a;
  w[1] = Real(0.75) - b * b;
  w[2] = Real(0.5) * c * c;
  dw[0] = -a;
  dw[1] = Real(-2) * b;
  dw[2] = c;
}

/// First node of a particle's stencil on one axis; numbers or lanes.
template <int K, class Real, class V, class I>
NEVE_INLINE I stencil_base(I cell, V offset) {
  if constexpr (K == cubic_nodes) return cell - 1;
  return offset < Real(0.5) ? cell - 1 : cell;
}

}  // namespace neve::sim::kernels
