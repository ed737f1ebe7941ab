#pragma once
/// One step through the staged driver, one stage at a time with every field kept: for the debugger,
/// for dumps and for the comparison with a reference.

#include <array>

#include "sim/simulation.h"
#include "sim/stage.h"

namespace neve::sim {

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
  std::uint64_t state_hash = 0;  ///< of the state at the end
  /// s that each stage took, one after the other; deformation has the gathering of velocities for
  /// the stages after it. A copy moves no colliders.
  std::array<double, stage_names.size()> seconds{};
};

/// Works on a copy: the simulation stays as it is.
StagedStep staged_step(const Simulation& simulation, double dt);

}  // namespace neve::sim
