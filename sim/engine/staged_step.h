#pragma once
/// A step by the staged driver for people to read: every field in SI units.

#include "sim/state/state.h"
#include "sim/types/grid_fields.h"

namespace neve::sim::engine {

/// @param copy  of the state of a run, which is not changed
template <class Real>
StagedStep staged_step(State<Real> copy, double dt);

}  // namespace neve::sim::engine
