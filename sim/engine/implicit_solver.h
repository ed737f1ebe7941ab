#pragma once
/// Step 6 of the paper: v_new of semi-implicit steps, by conjugate residuals.

#include <array>
#include <cstdint>
#include <vector>

#include "sim/engine/particle_contact.h"
#include "sim/engine/state.h"
#include "sim/kernels/implicit.h"
#include "sim/types/reports.h"

namespace neve::sim::engine {

template <class Real>
class ImplicitSolver {
 public:
  /// v_star and v_new from v_free on the nodes; the warnings of the state say how often that ended
  /// early. Adds the work of the colliders to that of the nodes.
  /// @param step  of dt, whose nodes have v_free
  /// @return false: the result is of no use, and the nodes have v_star
  /// @param contact  at particles, which has acted for this step; or none
  bool solve(State<Real>& state, const kernels::SweepArgs<Real>& step, double dt,
             ParticleContact<Real>* contact);

  const SolveReport& last_solve() const { return last_solve_; }

  std::uint64_t memory_bytes() const {
    return elasticity_.bytes() + vectors_.bytes() + 8 * sums_.capacity() + is_held_.capacity() +
           4 * (held_blocks_.capacity() + reaching_blocks_.capacity());
  }

 private:
  using Sums = std::array<double, kernels::solve_sums>;

  kernels::SolveArgs<Real> solve_args(const State<Real>& state,
                                      const kernels::SweepArgs<Real>& step, double dt);
  SolveReport conjugate_residuals(const State<Real>& state, kernels::SolveArgs<Real>& a,
                                  double scale_squared, ParticleContact<Real>* contact) const;
  /// The colliders' work on the nodes that they hold, from v_new.
  void add_work_on_held_nodes(const State<Real>& state, const kernels::SolveArgs<Real>& a);
  Sums sum_over_nodes(const State<Real>& state, kernels::SolveSweep<Real> sweep,
                      const kernels::SolveArgs<Real>& a) const;

  LaneBuffer<Real> elasticity_, vectors_;
  std::vector<double> sums_;           ///< per node block, like the next
  std::vector<std::uint8_t> is_held_;  ///< see SolveArgs
  std::vector<std::uint32_t> held_blocks_, reaching_blocks_;
  SolveReport last_solve_;
};

}  // namespace neve::sim::engine
