#pragma once
/// Functions that sweeps call of the law of a material. They are compiled by themselves, once per
/// instruction set, so that a change of a law compiles no sweep again.

#include "sim/kernels/decompose.h"
#include "sim/kernels/particle_lanes.h"
#include "sim/kernels/row.h"

namespace neve::sim::kernels {

/// Particles that are taken through steps 7 to 10 together, so that laws work on full lanes.
inline constexpr int gather_group = 64;

/// Data kept of a particle during a solve: two quads.
template <class V>
struct Elasticity {
  Sym3<V> shape;       ///< what its law keeps of F_E: b = F_E F_E^T, or its root
  V V0_mu, V0_lambda;  ///< J; moduli as its law has them now
};

/// Memory for laws that move particles between lanes. It has numbers from the start, so that lanes
/// to spare have, too.
template <class Real, int W>
struct LawSpace {
  static constexpr int words = 25;
  Real word[words][gather_group + W] = {};
};

/// A batch as the law first saw it: before particles that need a longer way took it.
template <class V>
struct FirstLook {
  V J_P, wave_modulus;
};

template <class Real, class Set>
struct LawKernels {
  static constexpr int W = Set::template lanes<Real>;
  using V = Lanes<Real, W>;
  using Batch = ParticleLanes<Real, W>;

  bool is_plastic;  ///< returns what is turned inside out

  /// Step 7, second half: projects F_E, and tau from it, for particles of the law.
  /// @param count         of particles, at most gather_group; the last batch may have lanes to
  /// spare
  /// @param is_projected  false leaves F_E and J_P as they are: stress of a state, at the start
  /// @param wave_modulus  per batch, out: rho0 c^2 of the fastest elastic wave, Pa
  /// @param is_inverted   per batch, out: a bit for every lane with det F_E <= 0 before projection
  /// @param looks         per batch, out; may be null
  void (*update)(Batch* batch, int count, const MaterialConstants<Real>* table, bool is_projected,
                 LawSpace<Real, W>& space, V* wave_modulus, unsigned* is_inverted,
                 FirstLook<V>* looks);

  /// Keeps what the solve of semi-implicit steps needs.
  void (*elasticity)(const Batch& batch, const MaterialConstants<Real>* table, Elasticity<V>& out);

  /// V0 D for the gradient G of displacements, both row by row: with dF = G F_E the nodes feel
  /// -sum V0 D grad_w_ip, where D = dP F_E^T. @return in D, J per unit of G
  void (*stress_change)(const Elasticity<V>& e, const V* G, V* D);
};

/// The kernels of a law. One file per instruction set defines its own.
template <class Set>
struct LawSet {
  static const LawKernels<float, Set>& kernels(int model, float);
  static const LawKernels<double, Set>& kernels(int model, double);
};

}  // namespace neve::sim::kernels
