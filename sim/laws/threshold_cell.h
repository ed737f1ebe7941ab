#pragma once
/// Thresholds of snow in cells of another size than those that they were meant for.

#include <vector>

#include "sim/types/material.h"
#include "sim/types/settings.h"

namespace neve::sim::laws {

/// Returns the factor on critical_stretch, or on the tension a law bears: sqrt(threshold_cell /
/// cell_size). A crack is a cell wide, and the energy of its strain grows with the square of the
/// threshold: so its energy per area stays. The crack band of fracture mechanics.
double threshold_factor(const SolverSettings& settings);

/// A material, or all, as it is in the cells of the settings.
Material in_cells(const Material& material, const SolverSettings& settings);
std::vector<Material> in_cells(const std::vector<Material>& materials,
                               const SolverSettings& settings);

}  // namespace neve::sim::laws
