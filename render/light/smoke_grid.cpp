#include "render/light/smoke_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "render/light/light_fields.h"

namespace neve::render::light {
namespace {

constexpr int nodes_per_block = 64;
constexpr float max_opacity = 16;

struct NodeBox {
  Vec3i low, high;  ///< nodes, both inclusive
};

/// Visible part of each block.
struct Blocks {
  std::vector<float> opacity;  ///< per node
  std::vector<int> seen;       ///< blocks with something to see
  std::vector<NodeBox> box;    ///< of the visible smoke, for each of those
};

Vec3i node_of(Vec3i block, int node) {
  return {4 * block.x + node / 16, 4 * block.y + node / 4 % 4, 4 * block.z + node % 4};
}

void extend(NodeBox& box, Vec3i node) {
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::min(box.low[axis], node[axis]);
    box.high[axis] = std::max(box.high[axis], node[axis]);
  }
}

Blocks look_at_blocks(const Smoke& smoke, ThreadPool* pool) {
  const std::vector<Vec3i>& block = smoke.nodes->block;
  Blocks blocks;
  blocks.opacity.resize(smoke.density.size());
  const float per_density = 1 / std::max(smoke.full_density, 1e-20f);
  const std::size_t count = block.size(), parts = std::min<std::size_t>(16, count);
  for_each_task(static_cast<int>(parts), pool, [&](int task) {
    const auto part = static_cast<std::size_t>(task);
    const std::size_t end = count * (part + 1) / parts * nodes_per_block;
    for (std::size_t i = count * part / parts * nodes_per_block; i < end; ++i)
      blocks.opacity[i] = std::min(
          max_opacity, smoke.density_scale * smoke_opacity(smoke.density[i] * per_density));
  });
  for (std::size_t b = 0; b < count; ++b) {
    NodeBox box{};
    bool is_seen = false;
    for (int n = 0; n < nodes_per_block; ++n) {
      if (!(blocks.opacity[b * nodes_per_block + static_cast<std::size_t>(n)] > 0)) continue;
      const Vec3i node = node_of(block[b], n);
      if (!is_seen) box = {node, node};
      is_seen = true;
      extend(box, node);
    }
    if (!is_seen) continue;
    blocks.seen.push_back(static_cast<int>(b));
    blocks.box.push_back(box);
  }
  return blocks;
}

/// Texels along an axis: those of the nodes from low to high, and an empty one at each end.
std::int64_t texels_along(std::int64_t low, std::int64_t high, int nodes_per_texel) {
  return (high - low) / nodes_per_texel + 3;
}

bool fits(const NodeBox& box, int nodes_per_texel) {
  std::int64_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t n = texels_along(box.low[axis], box.high[axis], nodes_per_texel);
    if (n > max_smoke_side) return false;
    count *= n;
  }
  return count <= max_smoke_texels;
}

/// Around nearly all blocks: the middle 99 % widened by half their width.
void leave_out_strays(const std::vector<NodeBox>& boxes, NodeBox& box) {
  std::vector<int> low, high;
  const std::size_t cut = boxes.size() < 8 ? 0 : std::max<std::size_t>(1, boxes.size() / 200);
  for (int axis = 0; axis < 3; ++axis) {
    low.clear();
    high.clear();
    for (const NodeBox& b : boxes) {
      low.push_back(b.low[axis]);
      high.push_back(b.high[axis]);
    }
    std::sort(low.begin(), low.end());
    std::sort(high.begin(), high.end());
    const std::int64_t first = low[cut], last = high[high.size() - 1 - cut];
    const std::int64_t extra = std::max<std::int64_t>(last - first, 4) / 2;
    box.low[axis] = static_cast<int>(std::max<std::int64_t>(box.low[axis], first - extra));
    box.high[axis] = static_cast<int>(std::min<std::int64_t>(box.high[axis], last + extra));
  }
}

bool is_inside(const NodeBox& box, Vec3i node) {
  for (int axis = 0; axis < 3; ++axis) {
    if (node[axis] < box.low[axis] || node[axis] > box.high[axis]) return false;
  }
  return true;
}

/// Place of a value in the range; not-a-number counts as its lower end.
float place_in_range(const Smoke& smoke, float value) {
  if (!(smoke.range_max > smoke.range_min)) return 0.5f;
  const float width = 0.5f * smoke.range_max - 0.5f * smoke.range_min;
  const float place = (0.5f * value - 0.5f * smoke.range_min) / width;
  return place > 0 ? std::min(place, 1.0f) : 0.0f;
}

}  // namespace

float smoke_opacity(float share) {
  return share > 0 && std::isfinite(share) ? std::pow(share, 0.7f) : 0.0f;
}

SmokeGrid make_smoke_grid(const Smoke& smoke, ThreadPool* pool) {
  SmokeGrid grid;
  if (!smoke.nodes || smoke.nodes->block.empty() || !(smoke.density_scale > 0)) return grid;
  const NodeLattice& nodes = *smoke.nodes;
  const Blocks blocks = look_at_blocks(smoke, pool);
  if (blocks.seen.empty()) return grid;

  NodeBox box = blocks.box.front();
  for (const NodeBox& b : blocks.box) {
    extend(box, b.low);
    extend(box, b.high);
  }
  if (!fits(box, 1)) leave_out_strays(blocks.box, box);
  int f = 1;  // nodes per texel and axis
  while (!fits(box, f)) f *= 2;

  const auto to_float = [](int i) { return static_cast<float>(i); };
  const Vec3f low = {to_float(box.low.x), to_float(box.low.y), to_float(box.low.z)};
  const float middle = 0.5f * to_float(f - 1) - to_float(f);  // of texel 0, in nodes from the first
  grid.spacing = to_float(f) * nodes.spacing;
  grid.origin = nodes.origin + nodes.spacing * (low + Vec3f{middle, middle, middle});
  grid.node_spacing = nodes.spacing;
  for (int axis = 0; axis < 3; ++axis)
    grid.size[axis] = static_cast<int>(texels_along(box.low[axis], box.high[axis], f));
  const std::size_t count = grid.index(0, 0, grid.size.z);
  std::vector<float> opacity(count), value(smoke.value.empty() ? 0 : count);

  const float share = 1 / to_float(f * f * f);
  for (const int b : blocks.seen) {
    for (int n = 0; n < nodes_per_block; ++n) {
      const std::size_t i =
          static_cast<std::size_t>(b) * nodes_per_block + static_cast<std::size_t>(n);
      const Vec3i node = node_of(nodes.block[static_cast<std::size_t>(b)], n);
      if (!(blocks.opacity[i] > 0) || !is_inside(box, node)) continue;
      const Vec3i at = node - box.low;
      const std::size_t texel = grid.index(at.x / f + 1, at.y / f + 1, at.z / f + 1);
      opacity[texel] += share * blocks.opacity[i];
      if (!value.empty())
        value[texel] += share * blocks.opacity[i] * place_in_range(smoke, smoke.value[i]);
    }
  }
  grid.opacity = std::move(opacity);
  grid.value = std::move(value);
  return grid;
}

}  // namespace neve::render::light
