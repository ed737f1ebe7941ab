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

/// Contacts are as stiff as the snow that presses against them can be: in units of 1 / D_p a node's
/// mass is 1, and the elastic part of the matrix is at most about beta (c dt / h)^2. Stiffer ones
/// take more iterations, in proportion to the root, and change a press by a few percent.
double contact_stiffness(const SolverSettings& settings, const StateLimits& limits, double dt) {
  const double cfl = limits.max_sound_speed * dt / settings.cell_size;
  return 1 + settings.beta * cfl * cfl;
}

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
                                                      kernels::SolveArgs<Real>& a, double size,
                                                      ParticleContact<Real>* contact) const {
  const kernels::SolveSweeps<Real>& s = *state.method.solve_sweeps;
  const SolverSettings& settings = state.method.settings;
  const auto apply = [&](bool is_first) {
    state.over_particle_blocks(s.apply, a);
    if (contact) contact->hold(state, a, is_first);
  };
  apply(true);
  double rr = sum_over_nodes(state, s.residual, a), rAr = 0;
  const auto residual = [&] { return size > 0 ? std::sqrt(rr / size) : 0.0; };
  SolveReport report;
  while (residual() > tolerance<Real>(settings) && report.iterations < settings.solve_iterations) {
    apply(false);
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
  a.hold = static_cast<Real>(contact_stiffness(settings, state.progress.limits, dt));
  a.collides = settings.collide_after_solve;
  const std::size_t blocks = state.particles.partition.node_blocks().size();
  a.elasticity = elasticity_.at_least(kernels::elasticity_quads * state.particles.size());
  a.vectors = vectors_.at_least(blocks * kernels::solve_vectors * kernels::block_nodes);
  a.u = a.vectors + kernels::solve_u * kernels::block_nodes;
  a.u_stride = kernels::solve_vectors * kernels::block_nodes;
  products_.resize(blocks);
  a.products = products_.data();
  is_held_.assign(blocks, 0);
  a.is_held = is_held_.data();
  return a;
}

template <class Real>
void ImplicitSolver<Real>::add_work_on_held_nodes(const State<Real>& state,
                                                  const kernels::SolveArgs<Real>& a) {
  const kernels::SolveSweeps<Real>& s = *state.method.solve_sweeps;
  const Partition& partition = state.particles.partition;
  held_blocks_.clear();
  reaching_blocks_.clear();
  for (std::size_t n = 0; n < is_held_.size(); ++n) {
    if (!is_held_[n]) continue;
    held_blocks_.push_back(static_cast<std::uint32_t>(n));
    for (const std::int32_t source : partition.node_blocks()[n].tile)
      if (source >= 0) reaching_blocks_.push_back(static_cast<std::uint32_t>(source));
  }
  if (held_blocks_.empty()) return;
  std::sort(reaching_blocks_.begin(), reaching_blocks_.end());
  reaching_blocks_.erase(std::unique(reaching_blocks_.begin(), reaching_blocks_.end()),
                         reaching_blocks_.end());
  const auto over = [&](const std::vector<std::uint32_t>& blocks, kernels::SolveSweep<Real> sweep) {
    state.pool->ranges(blocks.size(), state.active_threads(),
                       [&](std::size_t begin, std::size_t end) {
                         for (std::size_t k = begin; k < end; ++k)
                           sweep(a, blocks[k], blocks[k] + 1);
                       });
  };
  over(reaching_blocks_, s.apply);
  over(held_blocks_, s.react);
}

template <class Real>
bool ImplicitSolver<Real>::solve(State<Real>& state, const kernels::SweepArgs<Real>& step,
                                 double dt, ParticleContact<Real>* contact) {
  const kernels::SolveSweeps<Real>& s = *state.method.solve_sweeps;
  kernels::SolveArgs<Real> a = solve_args(state, step, dt);
  state.over_particle_blocks(s.keep_elasticity, a);
  const double given = sum_over_nodes(state, s.start, a);
  last_solve_ = conjugate_residuals(state, a, given, contact);
  const double found = sum_over_nodes(state, s.size, a);
  // Snow at rest has a residual of 1. NaN is of no use either.
  const bool is_useful = last_solve_.residual < 1 && found <= max_growth_squared * given;
  // From here on the velocities of the nodes count.
  a.u = step.nodes;
  a.u_stride = static_cast<std::size_t>(step.channels) * kernels::block_nodes;
  if (!is_useful) {
    a.hold = 0;
    if (contact) contact->settle(state, a);
    last_solve_.given_up = 1;
    ++state.progress.warnings.solves_given_up;
    return false;
  }
  if (last_solve_.residual > tolerance<Real>(state.method.settings)) {
    last_solve_.cut_short = 1;
    ++state.progress.warnings.solves_cut_short;
  }
  state.over_node_blocks(s.finish, a);
  if (contact)
    contact->settle(state, a);
  else
    add_work_on_held_nodes(state, a);
  return true;
}

template class ImplicitSolver<float>;
template class ImplicitSolver<double>;

}  // namespace neve::sim::engine
