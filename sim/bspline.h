#pragma once
/// B-spline weights of the 4 (cubic) or 3 (quadratic) nodes per axis around a particle.
/// Source: the paper, section 4 (cubic N); Steffen, Kirby, Berzins 2008 (quadratic).

#include "sim/base/lanes.h"
#include "sim/particles.h"

namespace neve::sim {

inline constexpr int cubic_nodes = 4;
inline constexpr int quadratic_nodes = 3;

/// D_p = h^2 times this, the inertia of the weights that APIC divides by (Jiang et al. 2015).
template <int K>
inline constexpr double apic_inertia = K == cubic_nodes ? 1.0 / 3.0 : 1.0 / 4.0;

/// Weights of one particle, per axis; w_ip is the product over the axes.
template <class Real, int K>
struct Weights {
  int base[3];     ///< first node of the stencil, lattice units
  Real w[3][K];    ///< N
  Real dw[3][K];   ///< N' in grid units: times 1/h is the derivative with respect to x_p
  Real arm[3][K];  ///< N (x_i - x_p)/h
};

/// N and N' of the stencil's nodes at distance from `first`, the particle's place in [1, 2) (cubic)
/// or [0.5, 1.5) (quadratic) counted from the first node. The outer cubic pieces are written as
/// cubes of the distance to the end of the support, which cannot go negative.
template <class Real>
NEVE_INLINE void spline(Real first, Real (&w)[cubic_nodes], Real (&dw)[cubic_nodes]) {
  const Real o = first - Real(1), a = Real(1) - o;
  w[0] = a * a * a * Real(1.0 / 6.0);
  w[1] = (Real(0.5) * o - Real(1)) * o * o + Real(2.0 / 3.0);
  w[2] = (Real(0.5) * a - Real(1)) * a * a + Real(2.0 / 3.0);
  w[3] = o * o * o * Real(1.0 / 6.0);
  dw[0] = Real(-0.5) * a * a;
  dw[1] = (Real(1.5) * o - Real(2)) * o;
  dw[2] = (Real(2) - Real(1.5) * a) * a;
  dw[3] = Real(0.5) * o * o;
}
template <class Real>
NEVE_INLINE void spline(Real first, Real (&w)[quadratic_nodes], Real (&dw)[quadratic_nodes]) {
  const Real a = Real(1.5) - first, b = first - Real(1), c = first - Real(0.5);
  w[0] = Real(0.5) * a * a;
  w[1] = Real(0.75) - b * b;
  w[2] = Real(0.5) * c * c;
  dw[0] = -a;
  dw[1] = Real(-2) * b;
  dw[2] = c;
}

/// First node of a particle's stencil on one axis.
template <int K, class Real>
NEVE_INLINE int stencil_base(int cell, Real offset) {
  if constexpr (K == cubic_nodes) return cell - 1;
  return offset < Real(0.5) ? cell - 1 : cell;
}

template <int K, class Real>
NEVE_INLINE Weights<Real, K> weights_of(const Particle<Real>& p) {
  Weights<Real, K> s;
  for (int axis = 0; axis < 3; ++axis) {
    s.base[axis] = stencil_base<K>(p.cell[axis], p.offset[axis]);
    const Real first = p.offset[axis] + static_cast<Real>(p.cell[axis] - s.base[axis]);
    spline(first, s.w[axis], s.dw[axis]);
    for (int k = 0; k < K; ++k) s.arm[axis][k] = s.w[axis][k] * (static_cast<Real>(k) - first);
  }
  return s;
}

}  // namespace neve::sim
