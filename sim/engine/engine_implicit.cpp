/// Step 6 of the paper: v_new of semi-implicit steps, by conjugate residuals.

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/engine/engine.h"

namespace neve::sim::engine {

namespace {

/// Below this the recurrences of the method go on falling, and the true residual does not.
template <class Real>
constexpr double least_tolerance = sizeof(Real) == 4 ? 1e-6 : 1e-14;

/// Where H is positive definite the solve only takes energy. Compressed snow can buckle, H is then
/// indefinite, and at a large dt a velocity may come out many times too large: beyond twice the
/// length of v_star it is not taken.
constexpr double most_growth_squared = 4;

/// Explicit steps in the place of one, at most.
constexpr double most_parts = 1000;

}  // namespace

template <class Real>
double Engine<Real>::over_nodes_summed(kernels::SolveSweep<Real> sweep,
                                       const kernels::SolveArgs<Real>& a) {
  over_node_blocks(sweep, a);
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
SolveReport Engine<Real>::conjugate_residuals(kernels::SolveArgs<Real>& a, double size) {
  const kernels::SolveSweeps<Real>& s = *solve_sweeps_;
  over_particle_blocks(s.apply, a);
  double rr = over_nodes_summed(s.residual, a), rAr = 0;
  const auto residual = [&] { return size > 0 ? std::sqrt(rr / size) : 0.0; };
  SolveReport report;
  while (residual() > tolerance() && report.iterations < settings_.solve_iterations) {
    over_particle_blocks(s.apply, a);
    const double before = rAr;
    rAr = over_nodes_summed(s.image, a);
    a.turn = report.iterations == 0 ? Real(0) : static_cast<Real>(rAr / before);
    const double AqAq = over_nodes_summed(s.direct, a);
    const double along = rAr / AqAq;
    if (rAr == 0 || !std::isfinite(along)) break;
    a.along = static_cast<Real>(along);
    rr = over_nodes_summed(s.advance, a);
    ++report.iterations;
  }
  report.residual = residual();
  return report;
}

template <class Real>
double Engine<Real>::tolerance() const {
  return std::max(settings_.solve_tolerance, least_tolerance<Real>);
}

template <class Real>
bool Engine<Real>::solve_velocities(const kernels::SweepArgs<Real>& step, double dt) {
  const kernels::SolveSweeps<Real>& s = *solve_sweeps_;
  kernels::SolveArgs<Real> a{};
  a.step = step;
  a.beta_dt_squared = static_cast<Real>(settings_.beta * dt * dt);
  a.collides = settings_.collide_after_solve;
  const std::size_t blocks = partition_.node_blocks().size();
  a.elasticity = elasticity_.at_least(kernels::elasticity_quads * particles_.size());
  a.vectors = solve_vectors_.at_least(blocks * kernels::solve_vectors * kernels::block_nodes);
  products_.resize(blocks);
  a.products = products_.data();
  over_particle_blocks(s.keep_elasticity, a);
  const double given = over_nodes_summed(s.start, a);
  last_solve_ = conjugate_residuals(a, given);
  const double found = over_nodes_summed(s.size, a);
  // Snow that stands still has a residual of 1. NaN is of no use either.
  const bool is_useful = last_solve_.residual < 1 && found <= most_growth_squared * given;
  if (!is_useful) {
    last_solve_.given_up = 1;
    ++warnings_.solves_given_up;
    return false;
  }
  if (last_solve_.residual > tolerance()) {
    last_solve_.cut_short = 1;
    ++warnings_.solves_cut_short;
  }
  over_node_blocks(s.finish, a);
  return true;
}

template <class Real>
int Engine<Real>::explicit_parts(double dt) const {
  SolverSettings settings = settings_;
  settings.beta = 0;
  const double parts = std::ceil(dt / stable_dt(settings, limits_));
  return static_cast<int>(std::clamp(parts, 1.0, most_parts));
}

template <class Real>
DtLimit Engine<Real>::explicit_limit() const {
  SolverSettings settings = settings_;
  settings.beta = 0;
  settings.time_step = TimeStep::adaptive;
  return engine::choose_dt(settings, limits_, std::numeric_limits<double>::infinity()).limit;
}

template bool Engine<float>::solve_velocities(const kernels::SweepArgs<float>&, double);
template bool Engine<double>::solve_velocities(const kernels::SweepArgs<double>&, double);
template int Engine<float>::explicit_parts(double) const;
template int Engine<double>::explicit_parts(double) const;
template DtLimit Engine<float>::explicit_limit() const;
template DtLimit Engine<double>::explicit_limit() const;

}  // namespace neve::sim::engine
