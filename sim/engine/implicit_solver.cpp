#include "sim/engine/implicit_solver.h"

#include <algorithm>
#include <cmath>

namespace neve::sim::engine {

namespace {

/// Below this the recurrences of the method still fall, and the true residual does not.
template <class Real>
constexpr double least_tolerance = sizeof(Real) == 4 ? 1e-6 : 1e-14;

/// The solve only takes energy where H is positive definite. Compressed snow can buckle, H is then
/// indefinite, and at a large dt a velocity may come out many times too large: beyond twice the
/// length of v_star it is not taken.
constexpr double max_growth_squared = 4;

template <class Real>
double tolerance(const SolverSettings& settings) {
  return std::max(settings.solve_tolerance, least_tolerance<Real>);
}

}  // namespace

template <class Real>
double ImplicitSolver<Real>::sum_over_nodes(const State<Real>& state,
                                            kernels::SolveSweep<Real> sweep,
                                            const kernels::SolveArgs<Real>& a) const {
  state.over_node_blocks(sweep, a);
  // One after the other: the same bits at any number of threads.
  double sum = 0;
  for (const double product : products_) sum += product;
  return sum;
}

/// Conjugate residuals (Saad, Iterative Methods for Sparse Linear Systems, section 6.8) from
/// y = M^1/2 v_star: |r| never grows, also where A is indefinite. Ends where A r is orthogonal to r
/// or no number; y then is the best so far.
/// @param size |M^1/2 v_star|^2
template <class Real>
SolveReport ImplicitSolver<Real>::conjugate_residuals(const State<Real>& state,
                                                      kernels::SolveArgs<Real>& a,
                                                      double size) const {
  const kernels::SolveSweeps<Real>& s = *state.method.solve_sweeps;
  const SolverSettings& settings = state.method.settings;
  state.over_particle_blocks(s.apply, a);
  double rr = sum_over_nodes(state, s.residual, a), rAr = 0;
  const auto residual = [&] { return size > 0 ? std::sqrt(rr / size) : 0.0; };
  SolveReport report;
  while (residual() > tolerance<Real>(settings) && report.iterations < settings.solve_iterations) {
    state.over_particle_blocks(s.apply, a);
    const double before = rAr;
    rAr = sum_over_nodes(state, s.image, a);
    a.turn = report.iterations == 0 ? Real(0) : static_cast<Real>(rAr / before);
    const double AqAq = sum_over_nodes(state, s.direct, a);
    const double along = rAr / AqAq;
    if (rAr == 0 || !std::isfinite(along)) break;
    a.along = static_cast<Real>(along);
    rr = sum_over_nodes(state, s.advance, a);
    ++report.iterations;
  }
  report.residual = residual();
  return report;
}

template <class Real>
kernels::SolveArgs<Real> ImplicitSolver<Real>::solve_args(const State<Real>& state,
                                                          const kernels::SweepArgs<Real>& step,
                                                          double dt) {
  const SolverSettings& settings = state.method.settings;
  kernels::SolveArgs<Real> a{};
  a.step = step;
  a.beta_dt_squared = static_cast<Real>(settings.beta * dt * dt);
  a.collides = settings.collide_after_solve;
  const std::size_t blocks = state.particles.partition.node_blocks().size();
  a.elasticity = elasticity_.at_least(kernels::elasticity_quads * state.particles.size());
  a.vectors = vectors_.at_least(blocks * kernels::solve_vectors * kernels::block_nodes);
  products_.resize(blocks);
  a.products = products_.data();
  return a;
}

template <class Real>
bool ImplicitSolver<Real>::solve(State<Real>& state, const kernels::SweepArgs<Real>& step,
                                 double dt) {
  const kernels::SolveSweeps<Real>& s = *state.method.solve_sweeps;
  kernels::SolveArgs<Real> a = solve_args(state, step, dt);
  state.over_particle_blocks(s.keep_elasticity, a);
  const double given = sum_over_nodes(state, s.start, a);
  last_solve_ = conjugate_residuals(state, a, given);
  const double found = sum_over_nodes(state, s.size, a);
  // Snow at rest has a residual of 1. NaN is of no use either.
  const bool is_useful = last_solve_.residual < 1 && found <= max_growth_squared * given;
  if (!is_useful) {
    last_solve_.given_up = 1;
    ++state.progress.warnings.solves_given_up;
    return false;
  }
  if (last_solve_.residual > tolerance<Real>(state.method.settings)) {
    last_solve_.cut_short = 1;
    ++state.progress.warnings.solves_cut_short;
  }
  state.over_node_blocks(s.finish, a);
  return true;
}

template class ImplicitSolver<float>;
template class ImplicitSolver<double>;

}  // namespace neve::sim::engine
