#include "sim/engine/implicit_solver.h"

#include <algorithm>
#include <cmath>

namespace neve::sim::engine {

namespace {

/// Tolerance below which the recurrences of the method still fall, and the true residual does not.
template <class Real>
constexpr double min_tolerance = sizeof(Real) == 4 ? 1e-6 : 1e-14;

/// The solve only takes energy where H is positive definite. Compressed snow can buckle, H is then
/// indefinite, and at a large dt a velocity may come out many times too large: beyond twice the
/// length of v_star it is not taken.
constexpr double max_growth_squared = 4;

/// A solution with a larger residual than this share of the motion is of no use.
constexpr double max_residual = 0.1;

/// Solutions of a step at most, each with the contacts that the one before asked for, and the share
/// of the motion that contact may still want to change after one. The rest closes after the solve:
/// see ParticleContact::settle.
constexpr int max_rounds = 4;
constexpr double contact_tolerance = 0.02;

/// Contacts are as stiff as the snow that presses against them can be: in units of 1 / D_p a node's
/// mass is 1, and the elastic part of the matrix is at most about beta (c dt / h)^2. Stiffer ones
/// take more iterations, in proportion to the root, and change a press by a few percent.
double contact_stiffness(const SolverSettings& settings, const StateLimits& limits, double dt) {
  const double cfl = limits.max_sound_speed * dt / settings.cell_size;
  return 1 + settings.beta * cfl * cfl;
}

/// Square of what residuals are measured by: |M^1/2 (v_star - V)|, with V the velocity of the
/// centre of mass, and with what gravity adds in a step, |M^1/2 g dt|. Snow that falls together
/// must be solved as well as the same snow at rest; a residual of the whole velocity would grow
/// with the fall. Below a share of the whole velocity rounding is all that is left.
/// @param sums  of SolveSweeps::start
double motion_squared(const std::array<double, kernels::solve_sums>& sums,
                      const SolverSettings& settings, double dt) {
  constexpr double min_share = 1e-4;
  const double whole = sums[0], mass = sums[4];
  if (!(mass > 0)) return 0;
  const double mean = (sums[1] * sums[1] + sums[2] * sums[2] + sums[3] * sums[3]) / mass;
  return std::max(whole - mean, min_share * min_share * whole) +
         mass * dt * dt * settings.gravity.squaredNorm();
}

template <class Real>
double tolerance(const SolverSettings& settings) {
  return std::max(settings.solve_tolerance, min_tolerance<Real>);
}

}  // namespace

template <class Real>
typename ImplicitSolver<Real>::Sums ImplicitSolver<Real>::sum_over_nodes(
    const State<Real>& state, kernels::SolveSweep<Real> sweep,
    const kernels::SolveArgs<Real>& a) const {
  state.over_node_blocks(sweep, a);
  // One after the other: the same bits at any number of threads.
  Sums all{};
  for (std::size_t block = 0; block < sums_.size(); block += all.size())
    for (std::size_t k = 0; k < all.size(); ++k) all[k] += sums_[block + k];
  return all;
}

/// Conjugate residuals (Saad, Iterative Methods for Sparse Linear Systems, section 6.8) from
/// y = M^1/2 v_star: |r| never grows, also where A is indefinite. Ends where A r is orthogonal to r
/// or no number; y then is the best so far. |A q|^2 of the next direction q = r + turn q follows
/// from sums over A r and the last A q: one sweep over the nodes less.
/// @param scale_squared  see motion_squared
template <class Real>
SolveReport ImplicitSolver<Real>::conjugate_residuals(const State<Real>& state,
                                                      kernels::SolveArgs<Real>& a,
                                                      double scale_squared,
                                                      ParticleContact<Real>* contact) const {
  const kernels::SolveSweeps<Real>& s = *state.method.solve_sweeps;
  const SolverSettings& settings = state.method.settings;
  const auto apply = [&](bool is_first) {
    state.over_particle_blocks(s.apply, a);
    if (contact) contact->hold(state, a, is_first);
  };
  apply(true);
  double rr = sum_over_nodes(state, s.residual, a)[0], rAr = 0, AqAq = 0;
  const auto residual = [&] { return scale_squared > 0 ? std::sqrt(rr / scale_squared) : 0.0; };
  SolveReport report;
  while (residual() > tolerance<Real>(settings) && report.iterations < settings.solve_iterations) {
    apply(false);
    const Sums sums = sum_over_nodes(state, s.image, a);
    const double turn = report.iterations == 0 ? 0 : sums[0] / rAr;
    rAr = sums[0];
    AqAq = sums[1] + turn * (2 * sums[2] + turn * AqAq);
    const double along = rAr / AqAq;
    if (rAr == 0 || !std::isfinite(along)) break;
    a.turn = static_cast<Real>(turn);
    a.along = static_cast<Real>(along);
    rr = sum_over_nodes(state, s.advance, a)[0];
    ++report.iterations;
  }
  report.residual = residual();
  report.all_iterations = static_cast<std::uint64_t>(report.iterations);
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
  sums_.resize(blocks * kernels::solve_sums);
  a.sums = sums_.data();
  is_held_.assign(blocks, 0);
  a.is_held = is_held_.data();
  return a;
}

template <class Real>
void ImplicitSolver<Real>::book_held_nodes(const State<Real>& state, kernels::SolveArgs<Real>& a,
                                           const Vec3d& gained) {
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
  over(held_blocks_, s.reaction);
  Sums found{};
  for (const std::uint32_t n : held_blocks_)
    for (std::size_t k = 0; k < 4; ++k) found[k] += sums_[n * kernels::solve_sums + k];
  for (int k = 0; k < 3; ++k)
    a.per_impulse[k] = static_cast<Real>(
        found[3] > 0 ? (gained[k] - found[static_cast<std::size_t>(k)]) / found[3] : 0);
  over(held_blocks_, s.react);
}

/// Finds velocities, again where contact asks for other impulses than the solve began with.
template <class Real>
typename ImplicitSolver<Real>::Motion ImplicitSolver<Real>::find_velocities(
    const State<Real>& state, kernels::SolveArgs<Real>& a, double dt,
    ParticleContact<Real>* contact) {
  const kernels::SolveSweeps<Real>& s = *state.method.solve_sweeps;
  const auto motion_now = [&](double missing) {
    const Sums sums = sum_over_nodes(state, s.motion, a);
    return Motion{std::max(motion_squared(sums, state.method.settings, dt), missing), sums[0]};
  };
  last_solve_ = {};
  last_solve_.solves = 1;
  const Real hold = a.hold;
  a.hold = 0;
  double missing = contact ? contact->look(state, a).missing : 0;
  a.hold = hold;
  Motion motion = motion_now(missing);
  for (int round = 1;; ++round) {
    const SolveReport solve = conjugate_residuals(state, a, motion.squared, contact);
    last_solve_.residual = solve.residual;
    last_solve_.iterations += solve.iterations;
    if (!contact) break;
    state.over_node_blocks(s.show, a);
    missing = contact->look(state, a).missing;
    if (round == max_rounds || !(missing > contact_tolerance * contact_tolerance * motion.squared))
      break;
    contact->renew(state, a);
    motion = motion_now(0);
  }
  last_solve_.all_iterations = static_cast<std::uint64_t>(last_solve_.iterations);
  return motion;
}

template <class Real>
bool ImplicitSolver<Real>::solve(State<Real>& state, const kernels::SweepArgs<Real>& step,
                                 double dt, ParticleContact<Real>* contact) {
  const kernels::SolveSweeps<Real>& s = *state.method.solve_sweeps;
  kernels::SolveArgs<Real> a = solve_args(state, step, dt);
  state.over_particle_blocks(s.keep_elasticity, a);
  state.over_node_blocks(s.start, a);
  const Motion motion = find_velocities(state, a, dt, contact);
  const double found = sum_over_nodes(state, s.size, a)[0];
  const double wanted = tolerance<Real>(state.method.settings);
  const bool is_useful = last_solve_.residual <= std::max(wanted, max_residual) &&
                         found <= max_growth_squared * std::max(motion.whole, motion.squared);
  if (!is_useful) {
    last_solve_.given_up = 1;
    ++state.progress.warnings.solves_given_up;
    return false;
  }
  if (last_solve_.residual > wanted) {
    last_solve_.cut_short = 1;
    ++state.progress.warnings.solves_cut_short;
  }
  const Vec3d spring = contact ? contact->look(state, a).spring : Vec3d(Vec3d::Zero());
  const Sums finished = sum_over_nodes(state, s.finish, a);
  const Vec3d gained(finished[0], finished[1], finished[2]);
  // The velocities of the nodes count from here on.
  a.u = step.nodes;
  a.u_stride = static_cast<std::size_t>(step.channels) * kernels::block_nodes;
  if (contact)
    contact->settle(state, a, gained - spring);
  else
    book_held_nodes(state, a, gained);
  return true;
}

template class ImplicitSolver<float>;
template class ImplicitSolver<double>;

}  // namespace neve::sim::engine
