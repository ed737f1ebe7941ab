#include "render/snow/exposed_nodes.h"

#include <algorithm>
#include <atomic>
#include <bit>

#include "sim/base/lanes.h"

#include "render/surface/loops.h"

namespace neve::render::snow {

namespace {

/// Share at a node, and how fast it falls outwards.
struct NodeShare {
  float share;
  Vec3f fall;  ///< per node
};

NodeShare share_of(const float* padded, Vec3i node) {
  const float* at = padded + ((node.z + 1) * padded_side + node.y + 1) * padded_side + node.x + 1;
  const auto fall = [&](int step) { return 0.5f * (at[-step] - at[step]); };
  return {*at, {fall(1), fall(padded_side), fall(padded_side * padded_side)}};
}

/// Outward, unit: where snow is flat but for the bumps of single particles, without them; as it is
/// at edges and broken faces.
Vec3f without_bumps(Vec3f normal, Vec3f even) {
  constexpr float rough = 0.80f, flat = 0.95f;  // cosines of the angle between the two
  const float t = std::clamp((dot(normal, even) - rough) / (flat - rough), 0.0f, 1.0f);
  const float part = 0.85f * t * t * (3 - 2 * t);
  return normalized(normal * (1 - part) + even * part);
}

Vec3f floats(Vec3i v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

ExposedNodes::ExposedNodes(const Body& body) {
  std::size_t count = 0;
  blocks_.reserve(body.surface_box.size());
  for (const CellBox& box : body.surface_box) {
    const auto nodes = [](int low, int high) { return std::max(high - low + 2, 0); };
    const int row = nodes(box.low.x, box.high.x), slice = row * nodes(box.low.y, box.high.y);
    blocks_.push_back({count, box, row, slice});
    count += static_cast<std::size_t>(slice * nodes(box.low.z, box.high.z));
  }
  nodes_ = std::make_unique_for_overwrite<Exposure[]>(count);
}

Vec3i ExposedNodes::cell_of(const Block& block, Vec3f node) {
  const auto cell = [](float x, int low, int high) {
    return std::clamp(static_cast<int>(x), low, high);
  };
  const CellBox& box = block.box;
  return {cell(node.x, box.low.x, box.high.x), cell(node.y, box.low.y, box.high.y),
          cell(node.z, box.low.z, box.high.z)};
}

void ExposedNodes::want(std::uint32_t padded, Vec3f node) {
  Block& block = blocks_[padded];
  const Vec3i cell = cell_of(block, node);
  const std::uint64_t bit = std::uint64_t{1} << (8 * cell.y + cell.x);
  std::atomic_ref<std::uint64_t> slice(block.wanted[static_cast<std::size_t>(cell.z)]);
  if (!(slice.load(std::memory_order_relaxed) & bit))
    slice.fetch_or(bit, std::memory_order_relaxed);
}

void ExposedNodes::expose_wanted(const Body& body, const light::LightVolume& volume,
                                 const SnowLight& light, ThreadPool* pool) {
  surface::for_ranges(pool, blocks_.size(), [&](std::size_t begin, std::size_t end) {
    const auto near = std::make_unique_for_overwrite<NearField>();
    for (std::size_t b = begin; b < end; ++b)
      if (blocks_[b].wanted != blocks_[b].exposed)
        expose_block(static_cast<std::uint32_t>(b), body, volume, light, *near);
  });
}

void ExposedNodes::expose_block(std::uint32_t padded, const Body& body,
                                const light::LightVolume& volume, const SnowLight& light,
                                NearField& near) {
  Block& of = blocks_[padded];
  const float* value = body.padded.data() + std::size_t{padded} * padded_nodes;
  const std::uint32_t block = body.padded_block[padded];
  const float cell = body.field.cell;
  const Vec3f corner = floats(body.field.block[block] * 8);
  near.take(body.field, block);
  // Those of cells that are new, and of the cells before them: bit 9 j + i would not fit 64 bits.
  const auto is_new = [&](Vec3i c) {
    if (c.x < of.box.low.x || c.y < of.box.low.y || c.z < of.box.low.z || c.x > of.box.high.x ||
        c.y > of.box.high.y || c.z > of.box.high.z)
      return false;
    const auto k = static_cast<std::size_t>(c.z);
    return ((of.wanted[k] & ~of.exposed[k]) >> (8 * c.y + c.x) & 1) != 0;
  };
  const auto is_corner_of_new = [&](Vec3i n) {
    for (int c = 0; c < 8; ++c)
      if (is_new(n - Vec3i{c & 1, c >> 1 & 1, c >> 2})) return true;
    return false;
  };
  std::size_t at = of.first;
  for (int k = of.box.low.z; k <= of.box.high.z + 1; ++k)
    for (int j = of.box.low.y; j <= of.box.high.y + 1; ++j)
      for (int i = of.box.low.x; i <= of.box.high.x + 1; ++i, ++at) {
        if (!is_corner_of_new({i, j, k})) continue;
        const NodeShare here = share_of(value, {i, j, k});
        const Vec3f normal = normalized(here.fall);
        // Light is that of the surface beside the node, at most a cell away.
        const float away = (here.share - surface_share) / std::max(length(here.fall), 0.1f);
        SnowPlace place;
        place.block = block;
        place.node = floats({i, j, k}) + normal * std::clamp(away, -1.0f, 1.0f);
        place.world = (corner + place.node) * cell;
        nodes_[at] = expose(near, volume, light, place,
                            without_bumps(normal, normalized(near.even_fall({i, j, k}))));
      }
  of.exposed = of.wanted;
}

Exposure ExposedNodes::at(std::uint32_t padded, Vec3f node) const {
  const Block& block = blocks_[padded];
  const Vec3i cell = cell_of(block, node);
  const auto part = [](float x, int low) {
    return std::clamp(x - static_cast<float>(low), 0.0f, 1.0f);
  };
  const float x = part(node.x, cell.x), y = part(node.y, cell.y), z = part(node.z, cell.z);
  const Vec3i from = cell - block.box.low;
  const Exposure* low =
      nodes_.get() + block.first + (from.z * block.slice + from.y * block.row + from.x);
  // Two vectors of four numbers for each corner.
  std::array<Lanes<float, 4>, 2> sum{};
  for (int n = 0; n < 8; ++n) {
    const float w = ((n & 1) ? x : 1 - x) * ((n >> 1 & 1) ? y : 1 - y) * ((n >> 2) ? z : 1 - z);
    const auto corner = std::bit_cast<std::array<Lanes<float, 4>, 2>>(
        low[(n >> 2) * block.slice + (n >> 1 & 1) * block.row + (n & 1)]);
    sum[0] += w * corner[0];
    sum[1] += w * corner[1];
  }
  return std::bit_cast<Exposure>(sum);
}

}  // namespace neve::render::snow
