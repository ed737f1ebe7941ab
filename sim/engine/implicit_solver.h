#pragma once
/// Step 6 of the paper: v_new of semi-implicit steps, by conjugate residuals.

#include <array>
#include <cstdint>
#include <vector>

#include "sim/engine/particle_contact.h"
#include "sim/kernels/implicit.h"
#include "sim/state/state.h"
#include "sim/types/reports.h"

namespace neve::sim::engine {

template <class Real>
class ImplicitSolver {
 public:
  /// v_star and v_new from v_free on the nodes; the warnings of the state say how often that ended
  /// early. Adds the work of the colliders to that of the nodes.
  /// @param step  of dt, whose nodes have v_free
  /// @return false: the result is of no use, the nodes have v_star, and no contact is settled
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
  /// J, of v_star: within the snow, see motion_squared, and of all of it.
  struct Motion {
    double squared, whole;
  };
  /// y of v_new. @return what its residual was measured by
  Motion find_velocities(const State<Real>& state, kernels::SolveArgs<Real>& a, double dt,
                         ParticleContact<Real>* contact);
  /// Loads and work of the colliders on the nodes that they hold, from v_new.
  /// @param gained  kg m/s that the snow got in the solve
  void book_held_nodes(const State<Real>& state, kernels::SolveArgs<Real>& a, const Vec3d& gained);
  Sums sum_over_nodes(const State<Real>& state, kernels::SolveSweep<Real> sweep,
                      const kernels::SolveArgs<Real>& a) const;

  LaneBuffer<Real> elasticity_, vectors_;
  std::vector<double> sums_;           ///< per node block, like the next
  std::vector<std::uint8_t> is_held_;  ///< see SolveArgs
  std::vector<std::uint32_t> held_blocks_, reaching_blocks_;
  SolveReport last_solve_;
};

}  // namespace neve::sim::engine
