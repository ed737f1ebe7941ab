#pragma once
/// Step 6 of the paper: v_new of semi-implicit steps, by conjugate residuals.

#include <cstdint>
#include <vector>

#include "sim/engine/state.h"
#include "sim/kernels/implicit.h"
#include "sim/types/reports.h"

namespace neve::sim::engine {

template <class Real>
class ImplicitSolver {
 public:
  /// v_new from v_star on the nodes; the warnings of the state say how often that ended early.
  /// @param step  of dt, whose nodes have v_star
  /// @return false: the result is of no use, and the nodes keep v_star
  bool solve(State<Real>& state, const kernels::SweepArgs<Real>& step, double dt);

  const SolveReport& last_solve() const { return last_solve_; }

  std::uint64_t memory_bytes() const {
    return elasticity_.bytes() + vectors_.bytes() + 8 * products_.capacity();
  }

 private:
  kernels::SolveArgs<Real> solve_args(const State<Real>& state,
                                      const kernels::SweepArgs<Real>& step, double dt);
  SolveReport conjugate_residuals(const State<Real>& state, kernels::SolveArgs<Real>& a,
                                  double size) const;
  double sum_over_nodes(const State<Real>& state, kernels::SolveSweep<Real> sweep,
                        const kernels::SolveArgs<Real>& a) const;

  LaneBuffer<Real> elasticity_, vectors_;
  std::vector<double> products_;  ///< per node block
  SolveReport last_solve_;
};

}  // namespace neve::sim::engine
