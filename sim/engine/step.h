#pragma once
/// One step, by two drivers: one stage after the other, or fused into three sweeps.

#include <array>
#include <chrono>
#include <vector>

#include "sim/engine/implicit_solver.h"
#include "sim/engine/particle_contact.h"
#include "sim/state/state.h"
#include "sim/types/reports.h"
#include "sim/types/stage.h"

namespace neve::sim::engine {

/// Does some work, and adds the time that it takes.
template <class Work>
void timed(double& seconds, const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Parts of a step with memory of their own; nothing in it lasts from one step to the next.
template <class Real>
struct StepParts {
  ImplicitSolver<Real> solver;
  ParticleContact<Real> contact;
  PhaseSeconds seconds;  ///< of the fused driver, since the start
  bool keeps_spray_on_grid = false;
};

/// The fused driver, which runs: spray takes explicit steps without the grid, and sweeps keep in
/// registers whatever one stage hands to the next.
template <class Real>
class FusedDriver {
 public:
  FusedDriver(State<Real>& state, StepParts<Real>& parts, double dt)
      : state_(state), parts_(parts), seconds_(parts.seconds), dt_(dt) {}

  /// @return false: the solve failed, and the particles are as they were
  bool step(bool is_implicit);

 private:
  void sort_particles(bool is_implicit);
  void particles_to_grid();
  void update_grid(bool is_implicit);
  bool solve_velocities();
  void grid_to_particles();
  void move_colliders();

  State<Real>& state_;
  StepParts<Real>& parts_;
  PhaseSeconds& seconds_;
  const double dt_;
  kernels::SweepArgs<Real> a_{};
};

/// Fields that the stages of a step leave behind.
template <class Real>
struct StageFields {
  std::vector<kernels::StagedNodes<Real>> nodes;     ///< per node block
  std::vector<kernels::Gathered<Real>> gathered;     ///< per record, like those below
  std::vector<Real> F_trial, v_before_collision;     ///< 9 and 3 numbers
  std::vector<Real> carrier;                         ///< 3 numbers, see SweepArgs
  Vec3d momentum = Vec3d::Zero();                    ///< kg m/s, of the particles at the start
  Vec3d own_taken = Vec3d::Zero();                   ///< see StagedStep
  std::array<double, stage_names.size()> seconds{};  ///< see StagedStep
};

/// The staged driver, for debugging and dumps: it keeps every field and can skip stages.
template <class Real>
class StagedDriver {
 public:
  StagedDriver(State<Real>& state, StepParts<Real>& parts, StageFields<Real>& fields, double dt)
      : state_(state), parts_(parts), fields_(fields), dt_(dt) {}

  void step();

 private:
  void sort_particles();
  void rasterize();
  void estimate_volumes();
  void add_elastic_forces();
  void update_grid_velocities();
  void collide_grid();
  void solve_velocities();
  void update_deformation();
  void update_particle_velocities();
  void collide_particles();
  void move_particles();
  void move_colliders();

  using NodeVelocities = Quad<Real> (kernels::StagedNodes<Real>::*)[kernels::block_nodes];
  struct Nothing {
    void operator()() const {}
  };
  /// Measures a stage. If the settings skip it, only `instead` is done.
  template <class Work, class Instead = Nothing>
  void stage(Stage stage, const Work& work, const Instead& instead = {});
  /// change(nodes, n) for every node.
  template <class Change>
  void each_node(const Change& change);
  void collide_at_particles();
  /// Lays a field of the nodes out as particles gather it.
  void write_velocities(NodeVelocities field);
  /// Reads a field of the nodes back from there.
  void read_velocities(NodeVelocities field);
  void over_particle_blocks(kernels::Sweep<Real> sweep) { state_.over_particle_blocks(sweep, a_); }
  void over_node_blocks(kernels::Sweep<Real> sweep) { state_.over_node_blocks(sweep, a_); }
  Vec3d momentum() const;
  void clear_node_contact_work();
  void rest_light_nodes();
  void deform();

  State<Real>& state_;
  StepParts<Real>& parts_;
  StageFields<Real>& fields_;
  const double dt_;
  kernels::SweepArgs<Real> a_{};
};

}  // namespace neve::sim::engine
