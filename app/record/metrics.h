#pragma once
/// Shape statistics of a particle state.

#include <cstddef>

#include "sim/simulation.h"

namespace neve::app::record {

struct Metrics {
  double spread = 0;    ///< m, horizontal radius about the centre that holds 90 % of the particles
  double height = 0;    ///< m, between the lowest and the highest 2 % of the particles
  double mean_J_P = 1;  ///< weighted by mass
  std::size_t fragments = 0;    ///< groups of occupied cells that touch, corners included
  double largest_fragment = 0;  ///< share of the particles that are in the largest of them
  double powder = 0;            ///< share of the particles that are alone in theirs
  double crumbs = 0;            ///< share of them in groups of 2 to 100
  double max_depth_cells = 0;   ///< of the particle that is deepest in a collider, cells
};

/// Particles whose position is no number are left out.
/// @param cell_size m, of the solver: snow closer than a cell is one piece
Metrics measure(const sim::ParticleArrays& particles, double cell_size);

}  // namespace neve::app::record
