#pragma once
/// Cost of a step: its time on this machine, and how it grows as snow spreads over the grid.

#include <vector>

#include "sim/simulation.h"

namespace neve::app::forecast {

/// Spread of the snow over the grid.
struct Spread {
  double blocks = 0;  ///< per particle; 0: not known
  double alone = 0;   ///< share of the blocks that have no neighbour, and take no room on the grid
};

Spread spread_of(const sim::Simulation& simulation, const sim::SolverSettings& solver);

/// Cost of a step over that of packed snow.
double cost_of_step(const Spread& spread);

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

/// Takes some steps after two that warm caches up, which count where there is no time for more.
/// @param frame  s, the longest step
StepTime measure_steps(sim::Simulation& simulation, double frame, const StepTiming& timing = {});

/// 0 of an empty list.
double median_of(std::vector<double> list);

}  // namespace neve::app::forecast
