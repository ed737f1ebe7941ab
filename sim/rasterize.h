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

/// The grid that some of the particles make, as if the others were not there.
/// @param rows  of Simulation::particles()
RasterizedNodes rasterize_some(const Simulation& simulation, const std::vector<std::size_t>& rows);

}  // namespace neve::sim
