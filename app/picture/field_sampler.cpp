#include "app/picture/field_sampler.h"

#include <algorithm>
#include <cmath>

namespace neve::app::picture {

namespace {

bool comes_before(const Vec3i& a, const Vec3i& b) {
  return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
}

}  // namespace

std::optional<std::size_t> node_index(const render::NodeLattice& lattice, const Vec3i& node) {
  const Vec3i block{node.x >> 2, node.y >> 2, node.z >> 2};
  const auto found =
      std::lower_bound(lattice.block.begin(), lattice.block.end(), block, comes_before);
  if (found == lattice.block.end() || !(*found == block)) return std::nullopt;
  return 64 * static_cast<std::size_t>(found - lattice.block.begin()) +
         static_cast<std::size_t>(16 * (node.x & 3) + 4 * (node.y & 3) + (node.z & 3));
}

std::optional<FieldSampler::Stencil> FieldSampler::at(const sim::Vec3d& point) const {
  const render::NodeLattice& lattice = *fields_.lattice;
  const double h = static_cast<double>(lattice.spacing);
  std::array<int, 3> low{};
  std::array<float, 3> part{};
  for (int axis = 0; axis < 3; ++axis) {
    const double in_cells = point[axis] / h;
    if (!(std::abs(in_cells) < 1e9)) return std::nullopt;
    // A point on a node takes that node's value, also where rounding put it just below.
    double whole = std::floor(in_cells + 1e-6);
    const auto a = static_cast<std::size_t>(axis);
    low[a] = static_cast<int>(whole);
    part[a] = static_cast<float>(std::max(0.0, in_cells - whole));
    if (part[a] < 1e-5f) part[a] = 0;
  }
  Stencil stencil;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3i offset{corner >> 2, corner >> 1 & 1, corner & 1};
    const float weight = (offset.x ? part[0] : 1 - part[0]) * (offset.y ? part[1] : 1 - part[1]) *
                         (offset.z ? part[2] : 1 - part[2]);
    if (weight <= 0) continue;
    const auto index = node_index(lattice, Vec3i{low[0], low[1], low[2]} + offset);
    if (!index || !(fields_.density[*index] > 0)) continue;
    const auto k = static_cast<std::size_t>(stencil.count++);
    stencil.node[k] = *index;
    stencil.weight[k] = weight;
    stencil.cover += weight;
  }
  if (stencil.count == 0) return std::nullopt;
  for (float& weight : stencil.weight) weight /= stencil.cover;
  return stencil;
}

}  // namespace neve::app::picture
