#pragma once
/// The grid as the particles of this moment make it: for pictures, never for the run.

#include <vector>

#include "sim/simulation.h"

namespace neve::sim {

/// The nodes that particles can reach, in blocks of 4x4x4: values of node (i, j, k) of block b are
/// at 64 b + 16 i + 4 j + k. A node without mass has zeros.
struct RasterizedNodes {
  double spacing = 1;           ///< m, the cell size
  std::vector<Vec3i> block;     ///< from the lattice origin, in blocks; sorted by x, y, z
  std::vector<double> mass;     ///< kg, sum of w_ip m_p
  std::vector<Vec3d> velocity;  ///< m/s, as step 1 of the paper rasterises it
  /// For each list of values the mean of the particles around: sum w m a / sum w m.
  std::vector<std::vector<double>> mean;
};

/// @param values lists of one value per particle in id order
/// @throws std::invalid_argument when a list has another length
RasterizedNodes rasterize(const Simulation& simulation,
                          const std::vector<std::vector<double>>& values = {});

}  // namespace neve::sim
