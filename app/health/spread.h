#pragma once
/// How the snow fills the grid, and what that makes of the cost of a step.

#include "sim/simulation.h"

namespace neve::app::health {

/// Spread of the snow over the grid.
struct Spread {
  double blocks = 0;  ///< per particle; 0: not known
  double alone = 0;   ///< share of the blocks that have no neighbour
};

Spread spread_of(const sim::Simulation& simulation);

/// Cost of a step over that of packed snow.
double cost_of_step(const Spread& spread);

}  // namespace neve::app::health
