#pragma once
/// Time of a step on this machine.

#include "sim/simulation.h"

namespace neve::app::health {

struct StepTime {
  double seconds = 0;      ///< the median; 0: none was made
  int steps = 0;           ///< all of them
  sim::SolveReport solve;  ///< the worst of them
};

/// Bounds a measurement.
struct StepTiming {
  int steps = 40;
  double seconds = 1;
};

/// Takes some steps after two that warm caches up.
/// @param frame  s, the longest step
StepTime measure_steps(sim::Simulation& simulation, double frame, const StepTiming& timing = {});

}  // namespace neve::app::health
