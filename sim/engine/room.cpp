#include "sim/engine/room.h"

#include <algorithm>
#include <cmath>

namespace neve::sim::engine {

namespace {

/// Particles of few per cell look no farther than this, cells.
constexpr double max_radius = 2;

/// J_P of loose snow that still takes its volume; torn snow is in nobody's way. Snow that is born
/// looser than that counts what lies around it by its own measure.
constexpr double max_loose = 2;

/// Blocks list particles by where they were before the step, by the first node of their stencil:
/// which is up to one cell before their own, and they moved by less than a cell.
constexpr int block_cells_below = 2, block_cells_above = 1;

/// Cells far apart may share a key: distances tell.
std::uint64_t cell_key(const Vec3i& cell) {
  constexpr std::uint64_t bits = (1 << 21) - 1;
  std::uint64_t key = 0;
  for (int a = 0; a < 3; ++a) key = key << 21 | (static_cast<std::uint64_t>(cell[a]) & bits);
  return key;
}

}  // namespace

template <class Real>
Room<Real>::Room(const State<Real>& state)
    : state_(state), cell_size_(state.method.lattice.cell_size) {
  if (!state.particles.partition.all_blocks().empty()) return;
  for (const kernels::Particle<Real>& p : state.particles.records) add(p);
}

template <class Real>
bool Room<Real>::has_room(const seeding::Birth& birth) {
  const double wanted = seeding::room_radius * std::cbrt(birth.V0 * birth.J_P);
  const double radius = std::min(wanted, max_radius * cell_size_);
  // A little less: eight per cell reach one cell, however the root is rounded.
  const int reach = static_cast<int>(std::ceil(radius / cell_size_ - 1e-9));
  const Vec3i middle = cell_of(birth.x);
  add_blocks_around(middle, reach);
  const double loosest = std::max(max_loose, birth.J_P);
  double filled = 0;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j)
      for (int k = -reach; k <= reach; ++k) {
        const auto cell = first_.find(cell_key(middle + Vec3i(i, j, k)));
        if (cell == first_.end()) continue;
        for (std::uint32_t at = cell->second; at != none; at = places_[at].next)
          if ((places_[at].x - birth.x).squaredNorm() < radius * radius)
            filled += places_[at].V0 * std::min(places_[at].J_P, loosest);
      }
  return filled <= birth.room * std::pow(radius / wanted, 3);
}

template <class Real>
void Room<Real>::take(const seeding::Birth& birth) {
  add(birth.x, birth.V0, birth.J_P);
}

template <class Real>
void Room<Real>::add(const Vec3d& x, double V0, double J_P) {
  const std::uint64_t key = cell_key(cell_of(x));
  if (!last_first_ || key != last_key_) {
    last_key_ = key;
    last_first_ = &first_.try_emplace(key, none).first->second;
  }
  places_.push_back({x, V0, J_P, *last_first_});
  *last_first_ = static_cast<std::uint32_t>(places_.size() - 1);
}

template <class Real>
void Room<Real>::add(const kernels::Particle<Real>& p) {
  add(state_.position(p), static_cast<double>(p.V0), static_cast<double>(p.J_P));
}

template <class Real>
void Room<Real>::add_block(std::uint64_t key) {
  if (!blocks_.insert(key).second) return;
  const Partition& partition = state_.particles.partition;
  const std::vector<kernels::BlockRange>& list = partition.all_blocks();
  const auto found = std::lower_bound(
      list.begin(), list.end(), key,
      [](const kernels::BlockRange& block, std::uint64_t wanted) { return block.key < wanted; });
  if (found == list.end() || found->key != key) return;
  for (std::uint32_t k = found->begin; k < found->end; ++k)
    add(state_.particles.records[partition.order()[k]]);
}

template <class Real>
void Room<Real>::add_blocks_around(const Vec3i& cell, int cells) {
  const auto block_of = [](int first_node) { return first_node >> 2; };
  Vec3i first, last;
  for (int a = 0; a < 3; ++a) {
    const int on_lattice = cell[a] + kernels::block_side * state_.method.lattice.origin[a];
    first[a] = block_of(on_lattice - cells - block_cells_below);
    last[a] = block_of(on_lattice + cells + block_cells_above);
  }
  for (int i = first[0]; i <= last[0]; ++i)
    for (int j = first[1]; j <= last[1]; ++j)
      for (int k = first[2]; k <= last[2]; ++k)
        add_block(state_.particles.partition.wrapped(kernels::block_key(i, j, k)));
}

template <class Real>
Vec3i Room<Real>::cell_of(const Vec3d& x) const {
  Vec3i cell;
  // Births outside of the lattice are refused elsewhere.
  constexpr double last = 4.0 * kernels::block_limit;
  for (int a = 0; a < 3; ++a)
    cell[a] = static_cast<int>(std::clamp(std::floor(x[a] / cell_size_), -last, last));
  return cell;
}

template class Room<float>;
template class Room<double>;

}  // namespace neve::sim::engine
