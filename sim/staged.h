#pragma once
/// One step through the staged driver, one stage at a time with every field kept: for the debugger,
/// for dumps and for the comparison with a reference.

#include "sim/simulation.h"
#include "sim/types/grid_fields.h"

namespace neve::sim {

/// Works on a copy: the simulation stays as it is.
StagedStep staged_step(const Simulation& simulation, double dt);

}  // namespace neve::sim
