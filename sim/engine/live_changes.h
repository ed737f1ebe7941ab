#pragma once
/// Other parameters between two steps of a run.

#include <vector>

#include "sim/state/state.h"

namespace neve::sim::engine {

/// Changes what needs no restart, see Simulation::apply.
/// @throws std::invalid_argument for all else, and then nothing has changed
template <class Real>
void apply(const SolverSettings& settings, const std::vector<Material>& materials,
           const std::vector<shapes::Collider>& colliders, State<Real>& state);

/// Returns the colliders of now: pose_at(collider, time) is the place of each of them.
template <class Real>
std::vector<shapes::Collider> colliders_now(const State<Real>& state);

}  // namespace neve::sim::engine
