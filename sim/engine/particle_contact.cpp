#include "sim/engine/particle_contact.h"

#include <algorithm>
#include <cmath>

namespace neve::sim::engine {

namespace {

/// Passes after a solve: springs gave way, at each particle by another share.
constexpr int passes_after_solve = 4;
/// Passes at most with bodies that move by themselves, which answer after each until they are
/// settled. Only contacts near bodies take part in more than the others need.
constexpr int passes_with_bodies = 6;

/// ContactArgs::carried. Loads last in a longer step; what stopped snow in a short one does not.
constexpr double max_carried = 2;

/// ContactArgs::apart, 1/s. It makes up for what the iteration leaves undone, step by step in the
/// same direction, and nobody sees it: too little to make snow bounce.
constexpr double apart = 1;

/// ContactArgs::max_touching_gap
template <class Real>
double max_touching_gap(const State<Real>& state) {
  const std::vector<Real>& half = state.method.half_spacing;
  const double thinnest = static_cast<double>(*std::max_element(half.begin(), half.end()));
  const double wanted = kernels::touching_share * thinnest *
                        std::cbrt(static_cast<double>(state.particles.largest_mass));
  // The kernels' cube root is good to rounding.
  return std::min(1.001 * wanted, kernels::max_touching * state.method.settings.cell_size);
}

}  // namespace

/// Makes room before the first contact, so that steps allocate nothing later: blocks of nodes are
/// few, and an eighth of the particles rarely touches.
template <class Real>
void ParticleContact<Real>::make_room(std::size_t particles, const Partition& partition) {
  const std::size_t blocks = partition.blocks().size(), nodes = partition.node_blocks().size();
  candidates_.resize(particles);
  near_counts_.resize(blocks);
  counts_.resize(blocks);
  first_.resize(blocks);
  first_to_keep_.resize(blocks);
  blocks_.reserve(near_counts_.capacity());
  is_reached_.resize(nodes);
  node_blocks_.reserve(is_reached_.capacity());
  if (nodes_.size() < nodes) nodes_.resize(nodes * 5 / 4);
  if (contacts_.size() < particles / 8) contacts_.resize(particles / 8);
}

template <class Real>
kernels::ContactArgs<Real> ParticleContact<Real>::contact_args(
    State<Real>& state, const kernels::SweepArgs<Real>& step) {
  KeptContacts<Real>& contacts = state.particles.contacts;
  kernels::ContactArgs<Real> a{};
  a.step = step;
  a.poses = step.constants.colliders;
  a.half_spacing = state.method.half_spacing.data();
  a.max_touching_gap = static_cast<Real>(max_touching_gap(state));
  a.max_speed = static_cast<Real>(state.progress.limits.max_speed);
  a.candidates = candidates_.data();
  a.near_counts = near_counts_.data();
  a.counts = counts_.data();
  a.first = first_.data();
  a.kept = contacts.data();
  a.kept_count = contacts.size();
  a.head = contacts.heads();
  const double last_dt = state.progress.last_dt;
  const double longer = last_dt > 0 ? static_cast<double>(step.constants.dt) / last_dt : 1;
  a.carried = static_cast<Real>(std::min(longer, max_carried));
  a.first_to_keep = first_to_keep_.data();
  a.nodes = nodes_.data();
  return a;
}

/// Gives the contacts of each block their place. @return how many there are at most
template <class Real>
std::uint64_t ParticleContact<Real>::place_contacts() {
  std::uint64_t most = 0;
  for (std::size_t b = 0; b < counts_.size(); ++b) {
    first_[b] = most;
    most += counts_[b];
  }
  return most;
}

/// The same for those that are remembered. @return how many contacts there are
template <class Real>
std::uint32_t ParticleContact<Real>::place_kept() {
  std::uint32_t count = 0;
  for (const std::uint32_t b : blocks_) {
    first_to_keep_[b] = count;
    count += counts_[b];
  }
  return count;
}

template <class Real>
void ParticleContact<Real>::list_blocks() {
  blocks_.clear();
  for (std::size_t b = 0; b < counts_.size(); ++b)
    if (counts_[b] > 0) blocks_.push_back(static_cast<std::uint32_t>(b));
}

/// @param node_blocks  get those that blocks of particles reach
template <class Real>
void ParticleContact<Real>::list_node_blocks(const Partition& partition,
                                             const std::vector<std::uint32_t>& blocks,
                                             std::vector<std::uint32_t>& node_blocks) {
  std::fill(is_reached_.begin(), is_reached_.end(), std::uint8_t{0});
  for (const std::uint32_t b : blocks)
    for (const std::uint32_t n : partition.blocks()[b].node_block) is_reached_[n] = 1;
  node_blocks.clear();
  for (std::size_t n = 0; n < is_reached_.size(); ++n)
    if (is_reached_[n]) node_blocks.push_back(static_cast<std::uint32_t>(n));
}

/// Blocks that touch bodies are worked on as if there were no others.
template <class Real>
void ParticleContact<Real>::list_near_bodies(const Partition& partition) {
  if (bodies_.empty()) return;
  near_bodies_.blocks = bodies_.blocks();
  near_bodies_.node_blocks.reserve(is_reached_.size());
  list_node_blocks(partition, near_bodies_.blocks, near_bodies_.node_blocks);
  near_bodies_.counts.assign(counts_.size(), 0);
  for (const std::uint32_t b : near_bodies_.blocks) near_bodies_.counts[b] = counts_[b];
}

template <class Real>
void ParticleContact<Real>::over(const std::vector<std::uint32_t>& blocks, Sweep sweep,
                                 const State<Real>& state) const {
  over(blocks, sweep, args_, state);
}

template <class Real>
void ParticleContact<Real>::over(const std::vector<std::uint32_t>& blocks, Sweep sweep,
                                 const kernels::ContactArgs<Real>& a, const State<Real>& state) {
  state.pool->ranges(blocks.size(), state.active_threads(),
                     [&](std::size_t begin, std::size_t end) {
                       sweep(a, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end));
                     });
}

template <class Real>
void ParticleContact<Real>::act(State<Real>& state, const kernels::SweepArgs<Real>& step,
                                bool is_before_solve) {
  KeptContacts<Real>& kept = state.particles.contacts;
  blocks_.clear();
  if (step.constants.collider_count == 0) return kept.keep_none();
  const Partition& partition = state.particles.partition;
  const kernels::ContactSweeps<Real>& sweeps = *state.method.contact_sweeps;
  make_room(step.particle_count, partition);
  kept.resize(step.particle_count);
  kept.reserve(step.particle_count / 8);
  kernels::ContactArgs<Real>& a = args_ = contact_args(state, step);
  a.is_before_solve = is_before_solve;
  a.apart = Real(apart);
  state.over_particle_blocks(sweeps.find, a);
  const std::uint64_t most = place_contacts();
  if (most == 0) return kept.keep_none();
  if (contacts_.size() < most) contacts_.resize(2 * most);
  a.contacts = contacts_.data();
  list_blocks();
  a.blocks = blocks_.data();
  over(blocks_, sweeps.start, state);
  list_blocks();
  if (blocks_.empty()) return kept.keep_none();
  const std::uint32_t count = place_kept();
  list_node_blocks(partition, blocks_, node_blocks_);
  a.node_blocks = node_blocks_.data();
  over(node_blocks_, sweeps.weigh, state);
  kept_count_ = count;
  bodies_.begin(state, a, blocks_);
  list_near_bodies(partition);
  follow_bodies(state);
  if (is_before_solve) return over(blocks_, sweeps.rows, state);
  const int passes = state.method.settings.contact_passes;
  for (int k = 1; !a.is_last; ++k) {
    a.is_last = is_enough(k, passes);
    // The contacts that were remembered have been read.
    if (a.is_last) a.keep = kept.room_for(count);
    pass(k, passes, state);
    if (!a.is_last) follow_bodies(state);
  }
}

/// @param wanted  passes where there are no bodies
template <class Real>
bool ParticleContact<Real>::is_enough(int pass, int wanted) const {
  if (pass < wanted) return false;
  return bodies_.empty() || bodies_.are_settled() || pass >= passes_with_bodies;
}

/// Bodies answer the impulses that there are.
template <class Real>
void ParticleContact<Real>::follow_bodies(const State<Real>& state) {
  if (bodies_.empty()) return;
  bodies_.answer(state, args_);
}

/// The last one is for all: the step gets its impulses from it.
template <class Real>
void ParticleContact<Real>::pass(int number, int wanted, const State<Real>& state) {
  const kernels::ContactSweeps<Real>& sweeps = *state.method.contact_sweeps;
  if (number < wanted || args_.is_last) {
    over(blocks_, sweeps.press, state);
    over(node_blocks_, sweeps.yield, state);
    return;
  }
  kernels::ContactArgs<Real> a = args_;
  a.blocks = near_bodies_.blocks.data();
  a.node_blocks = near_bodies_.node_blocks.data();
  a.counts = near_bodies_.counts.data();
  over(near_bodies_.blocks, sweeps.press, a, state);
  over(near_bodies_.node_blocks, sweeps.yield, a, state);
}

template <class Real>
void ParticleContact<Real>::over_springs(Sweep sweep, const State<Real>& state,
                                         const kernels::SolveArgs<Real>& solve, bool is_first) {
  args_.is_first = is_first;
  args_.u = solve.u;
  args_.u_stride = solve.u_stride;
  args_.hold = solve.hold;
  args_.beta_dt_squared = solve.beta_dt_squared;
  over(blocks_, sweep, state);
}

template <class Real>
void ParticleContact<Real>::hold(const State<Real>& state, const kernels::SolveArgs<Real>& solve,
                                 bool is_first) {
  over_springs(state.method.contact_sweeps->hold, state, solve, is_first);
}

template <class Real>
typename ParticleContact<Real>::Solution ParticleContact<Real>::look(
    const State<Real>& state, const kernels::SolveArgs<Real>& solve) {
  sums_.resize(kernels::contact_sums * blocks_.size());
  args_.sums = sums_.data();
  over_springs(state.method.contact_sweeps->measure, state, solve, true);
  // One after the other: the same bits at any number of threads.
  Solution solution;
  for (std::size_t k = 0; k < sums_.size(); k += kernels::contact_sums) {
    solution.missing += sums_[k];
    solution.spring += Vec3d::Map(&sums_[k + 1]);
  }
  return solution;
}

template <class Real>
void ParticleContact<Real>::renew(const State<Real>& state, const kernels::SolveArgs<Real>& solve) {
  const kernels::ContactSweeps<Real>& sweeps = *state.method.contact_sweeps;
  over_springs(sweeps.renew, state, solve, true);
  args_.is_last = true;
  over(node_blocks_, sweeps.take, state);
  over(node_blocks_, sweeps.yield, state);
}

template <class Real>
void ParticleContact<Real>::settle(State<Real>& state, const kernels::SolveArgs<Real>& solve,
                                   const Vec3d& unexplained) {
  if (blocks_.empty()) return;
  over_springs(state.method.contact_sweeps->settle, state, solve, true);
  args_.only_closes = true;
  pass_again(state);
  share(unexplained);
  book(state);
}

/// Shares what the springs do not explain by the impulse of contacts; without any, in equal parts.
template <class Real>
void ParticleContact<Real>::share(const Vec3d& unexplained) {
  double pressed = 0;
  std::size_t count = 0;
  for (const std::uint32_t b : blocks_)
    for (std::uint32_t k = 0; k < counts_[b]; ++k, ++count)
      pressed += std::abs(static_cast<double>(contacts_[first_[b] + k].impulse));
  for (int x = 0; x < 3; ++x) {
    args_.per_impulse[x] = pressed > 0 ? static_cast<Real>(unexplained[x] / pressed) : Real(0);
    args_.per_contact[x] =
        pressed > 0 ? Real(0) : static_cast<Real>(unexplained[x] / static_cast<double>(count));
  }
}

template <class Real>
void ParticleContact<Real>::pass_again(const State<Real>& state) {
  over(node_blocks_, state.method.contact_sweeps->take, state);
  args_.is_last = false;
  for (int k = 1; !args_.is_last; ++k) {
    follow_bodies(state);
    args_.is_last = is_enough(k, passes_after_solve);
    pass(k, passes_after_solve, state);
  }
}

template <class Real>
void ParticleContact<Real>::settle_without(State<Real>& state) {
  if (blocks_.empty()) return;
  pass_again(state);
  book(state);
}

template <class Real>
void ParticleContact<Real>::book(State<Real>& state) {
  args_.keep = state.particles.contacts.room_for(kept_count_);
  over(blocks_, state.method.contact_sweeps->book, state);
}

template <class Real>
std::size_t ParticleContact<Real>::memory_bytes() const {
  return sizeof(std::uint32_t) *
             (candidates_.capacity() + near_counts_.capacity() + counts_.capacity() +
              blocks_.capacity() + node_blocks_.capacity()) +
         sizeof(std::uint64_t) * first_.capacity() + 4 * first_to_keep_.capacity() +
         8 * sums_.capacity() + is_reached_.capacity() +
         sizeof(std::uint32_t) *
             (near_bodies_.blocks.capacity() + near_bodies_.node_blocks.capacity() +
              near_bodies_.counts.capacity()) +
         bodies_.memory_bytes() + sizeof(kernels::Contact<Real>) * contacts_.capacity() +
         sizeof(kernels::ContactNodes<Real>) * nodes_.capacity();
}

template class ParticleContact<float>;
template class ParticleContact<double>;

}  // namespace neve::sim::engine
