#pragma once
/// The start of a run: from particles as arrays to a state that a step can be taken from.

#include "sim/state/state.h"
#include "sim/types/particle_arrays.h"
#include "sim/types/reports.h"

namespace neve::sim::engine {

/// Fills the storage of a new state.
/// @return the extremes of F_E and J_P
/// @throws std::invalid_argument when arrays disagree in length or hold impossible numbers
template <class Real>
StartState load(const ParticleArrays& in, State<Real>& state);

/// Finds all that the first step relies on: stress, keys, volumes of new bodies, the limits on dt
/// and the energy.
/// @param start  gets the extremes of speed
template <class Real>
void prepare(State<Real>& state, StartState& start);

}  // namespace neve::sim::engine
