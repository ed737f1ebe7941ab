#pragma once
/// The lattice of cells, and positions in it.

#include <cmath>

#include "sim/kernels/blocks.h"
#include "sim/kernels/particles.h"
#include "sim/state/records.h"
#include "sim/types/math.h"

namespace neve::sim::engine {

struct Lattice {
  double cell_size = 1;   ///< h, m
  Vec3i origin{0, 0, 0};  ///< in blocks of 4 cells; positions are measured from it

  /// First cell of a block, counted from the origin.
  Vec3i first_cell(std::uint64_t block) const {
    Vec3i cell;
    for (int a = 0; a < 3; ++a)
      cell[a] = kernels::block_side * (kernels::block_coordinate(block, a) - origin[a]);
    return cell;
  }

  /// Sets cell and offset of a particle. @return false: the position is outside the lattice
  template <class Real>
  bool locate(const Vec3d& x, kernels::Particle<Real>& p) const {
    for (int a = 0; a < 3; ++a) {
      const double in_cells = x[a] / cell_size;
      if (!(std::abs(in_cells) < 4.0 * kernels::block_limit)) return false;
      int cell = 0;
      split(in_cells, cell, p.offset[a]);
      p.cell[a] = cell + kernels::block_side * origin[a];
    }
    return true;
  }

  /// Returns the place of a particle from the origin, m.
  template <class Real>
  Vec3d position(const kernels::Particle<Real>& p) const {
    Vec3d x;
    for (int a = 0; a < 3; ++a)
      x[a] = (static_cast<double>(p.cell[a] - kernels::block_side * origin[a]) +
              static_cast<double>(p.offset[a])) *
             cell_size;
    return x;
  }
};

}  // namespace neve::sim::engine
