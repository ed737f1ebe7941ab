#include "sim/seeding/sampling.h"

#include "sim/base/hash.h"
#include "sim/seeding/sampling_blocks.h"

namespace neve::sim::seeding {
namespace {

/// Calls visit(i, j, k, is_full) for every cell of a block, x fastest.
template <class Visit>
void each_cell(const LatticeBlock& block, const Visit& visit) {
  const auto& [i0, j0, k0] = block.first_cell;
  for (std::int64_t k = k0; k < k0 + block_cells; ++k)
    for (std::int64_t j = j0; j < j0 + block_cells; ++j)
      for (std::int64_t i = i0; i < i0 + block_cells; ++i) visit(i, j, k);
}

Vec3d as_vector(std::int64_t i, std::int64_t j, std::int64_t k) {
  return {static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
}

std::uint64_t bits(std::int64_t i) {
  return static_cast<std::uint64_t>(i);
}

}  // namespace

std::vector<Vec3d> sample_jittered(const shapes::Solid& solid, double spacing, std::uint64_t key) {
  std::vector<Vec3d> points;
  for (const LatticeBlock& block : blocks_in(solid, Vec3d::Zero(), spacing))
    each_cell(block, [&](std::int64_t i, std::int64_t j, std::int64_t k) {
      const std::uint64_t cell = mix64(mix64(mix64(key, bits(k)), bits(j)), bits(i));
      const Vec3d jitter(unit_double(mix64(cell)), unit_double(mix64(cell + 1)),
                         unit_double(mix64(cell + 2)));
      const Vec3d y = spacing * (as_vector(i, j, k) + jitter);
      if (block.is_full || solid.contains_local(y)) points.push_back(y);
    });
  return points;
}

std::vector<Vec3d> sample_lattice(const shapes::Solid& solid, double spacing) {
  const shapes::Bounds bounds = solid.local_bounds();
  const Vec3d count = lattice_size(bounds.max - bounds.min, spacing);
  // The points are the middles of cells; an odd number of them has one in the middle of the bounds.
  const Vec3d origin = 0.5 * (bounds.min + bounds.max) - 0.5 * spacing * count;
  std::vector<Vec3d> points;
  for (const LatticeBlock& block : blocks_in(solid, origin, spacing))
    each_cell(block, [&](std::int64_t i, std::int64_t j, std::int64_t k) {
      const Vec3d cell = as_vector(i, j, k);
      const bool is_counted = (cell.array() >= 0).all() && (cell.array() < count.array()).all();
      const Vec3d y = origin + spacing * (cell + Vec3d::Constant(0.5));
      if (is_counted && (block.is_full || solid.contains_local(y))) points.push_back(y);
    });
  return points;
}

}  // namespace neve::sim::seeding
