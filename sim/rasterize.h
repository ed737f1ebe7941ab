#pragma once
/// The grid that the present particles make: for pictures, never for the run.

#include <vector>

#include "sim/simulation.h"
#include "sim/types/grid_fields.h"

namespace neve::sim {

/// @param values lists of one value per particle in id order
/// @throws std::invalid_argument when a list has another length
RasterizedNodes rasterize(const Simulation& simulation,
                          const std::vector<std::vector<double>>& values = {});

}  // namespace neve::sim
