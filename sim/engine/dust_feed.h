#pragma once
/// Shows the snow and the colliders of a run to its dust.

#include "sim/dust/dust.h"
#include "sim/state/state.h"

namespace neve::sim::engine {

/// True if some snow sheds dust, or feels the air.
template <class Real>
bool wants_dust(const Method<Real>& method);

/// A step of the dust up to a time. It changes the snow only where DustSettings::spray_drag asks
/// for it: the work of the air is then part of the energy that the snow may have.
template <class Real>
void advance_dust(double time, State<Real>& state, dust::Dust& dust);

}  // namespace neve::sim::engine
