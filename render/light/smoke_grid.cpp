#include "render/light/smoke_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "render/frame/range.h"
#include "render/light/light_fields.h"

namespace neve::render::light {
namespace {

constexpr int nodes_per_block = 64;
constexpr float max_opacity = 16;
/// Nodes per texel and axis up to which smoke loses resolution before it loses strays.
constexpr int max_coarsening_for_strays = 4;

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

bool is_inside(const NodeBox& box, Vec3i node) {
  for (int axis = 0; axis < 3; ++axis) {
    if (node[axis] < box.low[axis] || node[axis] > box.high[axis]) return false;
  }
  return true;
}

/// Nodes per texel and axis with which a box fits.
int coarsening_of(const NodeBox& box) {
  int f = 1;
  while (!fits(box, f)) f *= 2;
  return f;
}

NodeBox box_around(const std::vector<NodeBox>& boxes) {
  NodeBox all = boxes.front();
  for (const NodeBox& b : boxes) {
    extend(all, b.low);
    extend(all, b.high);
  }
  return all;
}

/// The middle 99 % of the blocks along each axis.
NodeBox middle_box(const std::vector<NodeBox>& boxes) {
  std::vector<int> low, high;
  NodeBox middle{};
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
    middle.low[axis] = low[cut];
    middle.high[axis] = high[high.size() - 1 - cut];
  }
  return middle;
}

/// Returns the box around those near the middle: as far away as the coarsest texels reach that
/// smoke takes without strays, on one side or on both, and at least half the width of the middle.
NodeBox without_strays(const std::vector<NodeBox>& boxes) {
  constexpr std::int64_t reach = std::int64_t{max_coarsening_for_strays} * (max_smoke_side - 3);
  const NodeBox middle = middle_box(boxes);
  NodeBox near = middle;
  for (const int sides : {1, 2}) {
    std::vector<NodeBox> kept;
    for (const NodeBox& b : boxes) {
      bool is_near = true;
      for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t low = middle.low[axis], high = middle.high[axis], width = high - low;
        const std::int64_t margin = std::max((reach - width) / sides, width / 2);
        is_near = is_near && b.low[axis] >= low - margin && b.high[axis] <= high + margin;
      }
      if (is_near) kept.push_back(b);
    }
    if (kept.empty()) return box_around(boxes);
    near = box_around(kept);
    if (fits(near, max_coarsening_for_strays)) break;
  }
  return near;
}

/// Returns the box around all smoke, or around that without strays if this keeps its resolution.
NodeBox drawn_box(const std::vector<NodeBox>& boxes) {
  const NodeBox all = box_around(boxes);
  if (fits(all, max_coarsening_for_strays)) return all;
  const NodeBox near = without_strays(boxes);
  return coarsening_of(near) < coarsening_of(all) ? near : all;
}

bool has_nodes(const Smoke& smoke) {
  return smoke.nodes && !smoke.nodes->block.empty() && smoke.density_scale > 0;
}

/// Place of a value in the range; not-a-number counts as its lower end.
float place_in_range(const Smoke& smoke, float value) {
  if (!has_width(static_cast<double>(smoke.range_min), static_cast<double>(smoke.range_max)))
    return 0.5f;
  const float width = 0.5f * smoke.range_max - 0.5f * smoke.range_min;
  const float place = (0.5f * value - 0.5f * smoke.range_min) / width;
  return place > 0 ? std::min(place, 1.0f) : 0.0f;
}

}  // namespace

float smoke_opacity(float share) {
  return share > 0 && std::isfinite(share) ? std::pow(share, 0.7f) : 0.0f;
}

std::size_t strays_of(const Smoke& smoke) {
  if (!has_nodes(smoke)) return 0;
  // Most smoke fits: then nothing has to be known of its nodes.
  const std::vector<Vec3i>& blocks = smoke.nodes->block;
  NodeBox all{node_of(blocks.front(), 0), node_of(blocks.front(), nodes_per_block - 1)};
  for (const Vec3i& block : blocks) {
    extend(all, node_of(block, 0));
    extend(all, node_of(block, nodes_per_block - 1));
  }
  if (fits(all, max_coarsening_for_strays)) return 0;
  const std::vector<NodeBox> boxes = look_at_blocks(smoke, nullptr).box;
  if (boxes.empty()) return 0;
  const NodeBox box = drawn_box(boxes);
  return static_cast<std::size_t>(std::ranges::count_if(
      boxes, [&](const NodeBox& b) { return !is_inside(box, b.low) || !is_inside(box, b.high); }));
}

SmokeGrid make_smoke_grid(const Smoke& smoke, ThreadPool* pool) {
  SmokeGrid grid;
  if (!has_nodes(smoke)) return grid;
  const NodeLattice& nodes = *smoke.nodes;
  const Blocks blocks = look_at_blocks(smoke, pool);
  if (blocks.seen.empty()) return grid;

  const NodeBox box = drawn_box(blocks.box);
  const int f = coarsening_of(box);  // nodes per texel and axis

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
