#pragma once
/// A grid that nothing acts on: masses and velocities of the particles, and what they gather of
/// them.

#include <vector>

#include "sim/kernels/kernels.h"
#include "sim/state/state.h"

namespace neve::sim::engine {

/// A grid of which nothing lasts, but it takes the tiles and nodes of the state.
template <class Real>
class StillGrid {
 public:
  /// @param state  with keys, and at least one particle
  explicit StillGrid(State<Real>& state);

  /// Steps 1 of the particles as they are now.
  void rasterize();
  /// Step 2, of particles that have no volume yet; after rasterize(). The paper divides a mass by
  /// the density of the grid, which is that of a mixture where light snow lies on heavy: there each
  /// mass counts by the room that it takes alone, so that its neighbours' density is beside the
  /// point.
  void estimate_volumes();
  /// Gathers velocities of the nodes, per storage index.
  const std::vector<kernels::Gathered<Real>>& gather();
  /// Affine velocities of particles that have none: the fit that a step would make of them, again
  /// and again. Particles of FLIP keep their velocities: an affine one that the first steps find
  /// beside them would be energy from nowhere.
  void fit_affine_velocities();

 private:
  State<Real>& state_;
  kernels::SweepArgs<Real> a_;
  std::vector<kernels::StagedNodes<Real>> nodes_;
  std::vector<kernels::Gathered<Real>> gathered_;
};

}  // namespace neve::sim::engine
