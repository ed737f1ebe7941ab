#pragma once
/// Fields of the grid's nodes as plain arrays, for pictures, dumps and tests.

#include <array>
#include <cstdint>
#include <vector>

#include "sim/types/math.h"
#include "sim/types/particle_arrays.h"
#include "sim/types/reports.h"
#include "sim/types/stage.h"

namespace neve::sim {

/// The nodes that particles can reach, in blocks of 4x4x4: values of node (i, j, k) of block b are
/// at 64 b + 16 i + 4 j + k. A node without mass has zeros.
struct RasterizedNodes {
  double spacing = 1;           ///< m, the cell size
  std::vector<Vec3i> block;     ///< from the lattice origin, in blocks; sorted by x, y, z
  std::vector<double> mass;     ///< kg, sum of w_ip m_p
  std::vector<Vec3d> velocity;  ///< m/s, as step 1 of the paper rasterises it
  /// Mean of the particles around each node for each list of values: sum w m a / sum w m.
  std::vector<std::vector<double>> mean;
};

/// Fields of the nodes that carry mass, SI units.
struct NodeFields {
  std::vector<Vec3i> node;  ///< lattice index, counted from the lattice origin
  std::vector<double> mass;
  std::vector<Vec3d> momentum, force, v_old, v_free, v_star, v_new;
};

struct StagedStep {
  NodeFields nodes;
  ParticleArrays after;  ///< id order, at the end of the step
  std::vector<Mat3d> grad_v, F_E_trial;
  std::vector<Vec3d> v_before_collision;
  /// kg m/s, of velocities that particles keep beside that of the grid: taken by colliders that
  /// hold on to them.
  Vec3d own_taken{0, 0, 0};
  std::vector<ColliderLoad> loads;  ///< per collider, of the step
  std::uint64_t state_hash = 0;     ///< of the state at the end
  /// Its solve is of no use: a run takes shorter steps in its place.
  bool is_given_up = false;
  /// s that each stage took, one after the other; deformation has the gathering of velocities for
  /// the stages after it. A copy moves no colliders.
  std::array<double, stage_names.size()> seconds{};
};

}  // namespace neve::sim
