#pragma once
/// Particles to nodes, with any quantity in the place of the velocity: the transfer of the steps.

#include <vector>

#include "sim/state/state.h"
#include "sim/types/grid_fields.h"

namespace neve::sim::engine {

/// @param copy  of the state of a run, which is not changed
/// @param values  lists of one value per particle in id order
/// @throws std::invalid_argument when a list has another length
template <class Real>
RasterizedNodes rasterize(State<Real> copy, const std::vector<std::vector<double>>& values);

/// The same of some particles alone. @param rows  their places in id order
template <class Real>
RasterizedNodes rasterize_some(State<Real> copy, const std::vector<std::size_t>& rows);

}  // namespace neve::sim::engine
