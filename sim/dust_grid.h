#pragma once
/// Dust as a density on a lattice: for pictures and exports, never for the run.

#include "sim/types/dust.h"
#include "sim/types/grid_fields.h"

namespace neve::sim {

/// Mass and mean velocity on nodes half a cell of the air apart. Each particle of dust is spread
/// over the five nodes around it along each axis: between a cubic and a quintic B-spline in width.
/// The sum of the masses is that of the dust, but for rounding.
RasterizedNodes dust_nodes(const DustArrays& dust);

}  // namespace neve::sim
