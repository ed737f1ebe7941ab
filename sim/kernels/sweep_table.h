#pragma once
/// All sweeps of the drivers by kernel and transfer.

#include "sim/kernels/spray_sweep.h"
#include "sim/kernels/sweeps.h"

namespace neve::sim::kernels {

template <class Real, int K, TransferKind transfer, class Set>
struct SweepTable {
  using S = SweepsFor<Real, K, transfer, Set>;
  static constexpr Sweeps<Real> table{S::fused_channels,
                                      S::particles_to_grid,
                                      S::grid_update,
                                      S::grid_to_particles,
                                      SprayFor<Real, K, transfer, Set>::step,
                                      S::rasterize,
                                      S::collect_momentum,
                                      S::volumes,
                                      S::elastic_forces,
                                      S::collect_force,
                                      S::grid_velocities,
                                      S::grid_collisions,
                                      S::lay_out_velocities,
                                      S::gather,
                                      S::deformation,
                                      S::particle_velocities,
                                      S::particle_collisions,
                                      S::advection,
                                      S::push_out,
                                      S::refresh};
};

/// Returns the sweeps of a kernel and transfer, for the files that instantiate them.
template <class Real, class Set>
const Sweeps<Real>& choose_sweeps(int nodes, TransferKind transfer) {
  constexpr int cubic = cubic_nodes, quadratic = quadratic_nodes;
  using enum TransferKind;
  if (nodes == cubic) {
    if (transfer == flip) return SweepTable<Real, cubic, flip, Set>::table;
    if (transfer == apic) return SweepTable<Real, cubic, apic, Set>::table;
    if (transfer == aflip) return SweepTable<Real, cubic, aflip, Set>::table;
    return SweepTable<Real, cubic, mls, Set>::table;
  }
  if (transfer == flip) return SweepTable<Real, quadratic, flip, Set>::table;
  if (transfer == apic) return SweepTable<Real, quadratic, apic, Set>::table;
  if (transfer == aflip) return SweepTable<Real, quadratic, aflip, Set>::table;
  return SweepTable<Real, quadratic, mls, Set>::table;
}

}  // namespace neve::sim::kernels
