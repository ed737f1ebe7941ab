#pragma once
/// The kernels of all laws, for the files that compile them for an instruction set. Those files
/// define NEVE_LANES_ALONE: they read what laws do in lanes, and neither Eigen nor the standard
/// library.

#include "sim/kernels/law.h"
#include "sim/laws/files.h"

namespace neve::sim::laws {

/// A law has `step` for one batch, or an Update for all of them.
template <class Law>
concept HasUpdate = requires {
  Law::moves_particles_between_lanes;
};

template <class Law, class Real, class Set>
struct LawEntry {
  using Kernels = kernels::LawKernels<Real, Set>;
  using V = typename Kernels::V;
  using Batch = typename Kernels::Batch;
  using Table = kernels::MaterialConstants<Real>;
  static constexpr int W = Kernels::W;

  static void update(Batch* batch, int count, const Table* table, bool is_projected,
                     kernels::LawSpace<Real, W>& space, V* wave_modulus, unsigned* is_inverted,
                     kernels::FirstLook<V>* looks) {
    if constexpr (HasUpdate<Law>) {
      typename Law::template Update<Real, Set> all{space};
      all(batch, count, table, is_projected, wave_modulus, is_inverted, looks);
    } else {
      for (int k = 0; k * W < count; ++k) {
        const unsigned used = lane_bits(first_lanes<MaskOf<V>>(count - k * W));
        is_inverted[k] = used & Law::step(batch[k], table, is_projected, wave_modulus[k]);
        if (looks) looks[k] = {batch[k].J_P, wave_modulus[k]};
      }
    }
  }
  static void elasticity(const Batch& batch, const Table* table, kernels::Elasticity<V>& out) {
    out = Law::elasticity(batch, table);
  }
  static void stress_change(const kernels::Elasticity<V>& e, const V* G, V* D) {
    Law::stress_change(e, G, D);
  }

  static constexpr Kernels kernels{Law::is_plastic, update, elasticity, stress_change};
};

template <class Real, class Set>
struct LawTable {
  static const kernels::LawKernels<Real, Set>& at(int model) {
#define NEVE_ENTRY_OF_LAW(name) &LawEntry<name::InLanes, Real, Set>::kernels,
    static constexpr const kernels::LawKernels<Real, Set>* all[] = {NEVE_LAWS(NEVE_ENTRY_OF_LAW)};
#undef NEVE_ENTRY_OF_LAW
    return *all[model];
  }
};

}  // namespace neve::sim::laws
