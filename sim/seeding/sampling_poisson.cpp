#include <algorithm>
#include <bit>

#include "sim/base/hash.h"
#include "sim/seeding/sampling.h"
#include "sim/seeding/sampling_blocks.h"

namespace neve::sim::seeding {
namespace {

/// Points in cubic cells as wide as the smallest distance, chained by hash: points of other cells
/// in a chain cost a look and nothing else.
class Neighbours {
 public:
  Neighbours(double distance, std::size_t count)
      : distance_(distance), first_(std::bit_ceil(2 * count + 1), none) {
    points_.reserve(count);
    next_.reserve(count);
  }

  bool is_free(const Vec3d& y) const {
    const Vec3d cell = (y / distance_).array().floor();
    // Its own cell first: most darts that fail do so there.
    if (!is_free_in(cell, y)) return false;
    for (double k = -1; k <= 1; ++k)
      for (double j = -1; j <= 1; ++j)
        for (double i = -1; i <= 1; ++i)
          if (!is_free_in(cell + Vec3d(i, j, k), y)) return false;
    return true;
  }

  void add(const Vec3d& y) {
    const std::size_t slot = slot_of((y / distance_).array().floor());
    next_.push_back(first_[slot]);
    first_[slot] = static_cast<std::uint32_t>(points_.size());
    points_.push_back(y);
  }

  const std::vector<Vec3d>& points() const { return points_; }

 private:
  static constexpr std::uint32_t none = 0xffffffffu;

  bool is_free_in(const Vec3d& cell, const Vec3d& y) const {
    for (std::uint32_t p = first_[slot_of(cell)]; p != none; p = next_[p])
      if ((points_[p] - y).squaredNorm() < distance_ * distance_) return false;
    return true;
  }

  std::size_t slot_of(const Vec3d& cell) const {
    const auto bits = [](double c) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(c));
    };
    const std::uint64_t mixed = bits(cell.x()) * 0x9e3779b97f4a7c15ull ^
                                bits(cell.y()) * 0xc2b2ae3d27d4eb4full ^
                                bits(cell.z()) * 0x165667b19e3779f9ull;
    return static_cast<std::size_t>(mixed ^ (mixed >> 29)) & (first_.size() - 1);
  }

  double distance_;
  std::vector<std::uint32_t> first_, next_;
  std::vector<Vec3d> points_;
};

/// The darts arrive all over the place; the solver wants neighbours together. Blocks as the other
/// samplers have them, darts of a block in the order in which they came.
std::vector<Vec3d> ordered_by_block(const std::vector<Vec3d>& points, double spacing) {
  using Block = std::array<std::int64_t, 3>;
  std::vector<std::pair<Block, std::size_t>> order(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Vec3d block = (points[p] / (spacing * block_cells)).array().floor();
    order[p] = {{static_cast<std::int64_t>(block.z()), static_cast<std::int64_t>(block.y()),
                 static_cast<std::int64_t>(block.x())},
                p};
  }
  std::sort(order.begin(), order.end());
  std::vector<Vec3d> sorted;
  sorted.reserve(points.size());
  for (const auto& [block, p] : order) sorted.push_back(points[p]);
  return sorted;
}

// Darts per lattice cell of the blocks before a solid counts as full. Well above what solids larger
// than a few spacings take, see sampling.h.
constexpr std::uint64_t darts_per_cell = 400;

// Darts for a solid of so many points: a needle that fills next to nothing of its blocks is given
// up after a few seconds instead of a day.
constexpr std::uint64_t darts_for(std::uint64_t points) {
  return 10'000'000 + 10'000 * points;
}

}  // namespace

std::vector<Vec3d> sample_poisson(const shapes::Solid& solid, double spacing, std::uint64_t key) {
  const std::vector<LatticeBlock> blocks = blocks_in(solid, Vec3d::Zero(), spacing);
  const auto wanted = static_cast<std::size_t>(
      std::max(1.0, std::round(solid.volume() / (spacing * spacing * spacing))));
  const std::uint64_t max_darts = std::min(
      darts_per_cell * block_cells * block_cells * block_cells * blocks.size(), darts_for(wanted));

  Neighbours taken(poisson_distance_in_spacings * spacing, wanted);
  for (std::uint64_t t = 0; t < max_darts && taken.points().size() < wanted; ++t) {
    const std::uint64_t dart = mix64(key, t);
    const auto& [first, is_full] =
        blocks[static_cast<std::size_t>(unit_double(dart) * static_cast<double>(blocks.size()))];
    const Vec3d corner(static_cast<double>(first[0]), static_cast<double>(first[1]),
                       static_cast<double>(first[2]));
    const Vec3d place(unit_double(mix64(dart + 1)), unit_double(mix64(dart + 2)),
                      unit_double(mix64(dart + 3)));
    const Vec3d y = spacing * (corner + block_cells * place);
    if ((is_full || solid.contains_local(y)) && taken.is_free(y)) taken.add(y);
  }
  return ordered_by_block(taken.points(), spacing);
}

}  // namespace neve::sim::seeding
