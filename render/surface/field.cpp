#include "render/surface/field.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "render/surface/filter.h"
#include "render/surface/grain_order.h"
#include "render/surface/loops.h"
#include "sim/base/lanes.h"

namespace neve::render::surface {

namespace {

/// A block takes what its particles give to its own nodes and to the first two of the next blocks.
/// Its rows are as long as three vectors of four.
constexpr int tile_side = block_side + 2, tile_row = 12,
              tile_nodes = tile_side * tile_side * tile_row;

/// Bytes a block of nodes needs until the mesh is made: its values twice, its neighbours, labels
/// of its pieces, bits; and the tile of one with particles.
constexpr double block_bytes = 2 * 4.0 * block_nodes + 108 + 2.0 * block_nodes + 400;
constexpr double tile_bytes = 4.0 * tile_nodes;

/// Widths of the kernel beyond which its tail of a few millionths is left out.
constexpr double max_widths = 4.5;

/// A particle that has grown without bound fills no more cells than this.
constexpr float max_cells = 1e6f;

/// First node of the kernel of a particle, and the weights of the three nodes along each axis.
struct Spline {
  Vec3i node;
  std::array<std::array<float, 3>, 3> weight;  ///< by axis
};

NEVE_INLINE Spline spline_at(const NodePlace& place) {
  Spline spline{spline_node(place), {}};
  for (int axis = 0; axis < 3; ++axis) {
    const float u = place.rest[axis] + (place.rest[axis] < 0.5f ? 1.0f : 0.0f);  // 0.5 to 1.5
    spline.weight[static_cast<std::size_t>(axis)] = {
        0.5f * (1.5f - u) * (1.5f - u), 0.75f - (u - 1) * (u - 1), 0.5f * (u - 0.5f) * (u - 0.5f)};
  }
  return spline;
}

/// All blocks with a node that a particle reaches, or one beside such a node, in order.
/// @param reach of the filter, cells
std::vector<BlockKey> reached_blocks(const Occupied& occupied, int reach, std::uint64_t max_bytes) {
  BlockMap all(2 * occupied.map.size());
  const double tiles = tile_bytes * static_cast<double>(occupied.map.size());
  for (std::size_t b = 0; b < occupied.map.size(); ++b) {
    const Vec3i place = block_place(occupied.map.keys()[b]);
    Vec3i low, high;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = place[axis] + ((occupied.reach[b].low[axis] - reach - 1) >> 3);
      high[axis] = place[axis] + ((occupied.reach[b].high[axis] + 2 + reach + 1) >> 3);
    }
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) all.insert(block_key({x, y, z}));
    const double bytes = tiles + block_bytes * static_cast<double>(all.size());
    if (max_bytes > 0 && bytes > static_cast<double>(max_bytes)) throw MemoryError(bytes);
  }
  std::vector<BlockKey> keys = all.keys();
  std::sort(keys.begin(), keys.end());
  return keys;
}

void find_neighbours(const std::vector<BlockKey>& keys, const BlockMap& map, Field& field,
                     ThreadPool* pool) {
  field.block.resize(keys.size());
  field.near.resize(keys.size());
  for_ranges(pool, keys.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const Vec3i place = field.block[b] = block_place(keys[b]);
      for (int n = 0; n < 27; ++n) {
        const Vec3i step{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
        field.near[b][static_cast<std::size_t>(n)] = map.find(block_key(place + step));
      }
    }
  });
}

using V = Quad<float>;

/// Weights along x of the nodes of a tile's row, four to a vector: what lies in memory is read as
/// it was written, which is quick.
struct RowWeights {
  int first;                ///< vector of the row
  std::array<V, 2> weight;  ///< of its nodes, and of those of the next vector
};

RowWeights row_weights(int node, const std::array<float, 3>& w) {
  using I = MaskOf<V>;
  const int first = std::min(node >> 2, 1);
  RowWeights row{first, {}};
  I at = I{0, 1, 2, 3} - all<I>(node - 4 * first);
  for (V& weight : row.weight) {
    weight = at == I{} ? all<V>(w[0]) : V{};
    weight = at == all<I>(1) ? all<V>(w[1]) : weight;
    weight = at == all<I>(2) ? all<V>(w[2]) : weight;
    at += 4;
  }
  return row;
}

/// Spreads the volume of a block's particles over a tile of nodes, which it clears before.
void fill_tile(std::span<const PlacedGrain> grains, float cell, V* tile) {
  constexpr int row_vectors = tile_row / 4;
  const float per_cell = 1 / (cell * cell * cell);
  std::fill_n(tile, tile_nodes / 4, V{});
  for (const PlacedGrain& grain : grains) {
    NodePlace place;
    find_node(grain.position, cell, place);
    const Spline spline = spline_at(place);
    const auto& [wx, wy, wz] = spline.weight;
    const float share = std::min(grain.volume * per_cell, max_cells);
    const RowWeights along = row_weights(spline.node.x & 7, wx);
    V* corner =
        tile + ((spline.node.z & 7) * tile_side + (spline.node.y & 7)) * row_vectors + along.first;
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j) {
        const float w = share * wz[static_cast<std::size_t>(k)] * wy[static_cast<std::size_t>(j)];
        V* row = corner + (k * tile_side + j) * row_vectors;
        row[0] += w * along.weight[0];
        row[1] += w * along.weight[1];
      }
  }
}

/// Adds the part of a tile that lies in the block `side` away from its own: 0 or 1 along each axis.
void add_tile(const float* tile, Vec3i side, float* value) {
  const auto count = [](int s) { return s == 0 ? block_side : 2; };
  for (int k = 0; k < count(side.z); ++k)
    for (int j = 0; j < count(side.y); ++j) {
      const float* from =
          tile + ((k + 8 * side.z) * tile_side + j + 8 * side.y) * tile_row + 8 * side.x;
      float* to = value + (k * block_side + j) * block_side;
      for (int i = 0; i < count(side.x); ++i) to[i] += from[i];
    }
}

/// Every node gets its sums in one order: by particles in a block, then by blocks.
void gather_volume(GrainField& made, ThreadPool* pool) {
  Field& field = made.field;
  const std::vector<std::uint32_t>& first = made.grains.first;
  std::vector<std::uint32_t> tile_of(field.block.size(), no_block), full;
  for (std::size_t b = 0; b < field.block.size(); ++b) {
    if (first[b] == first[b + 1]) continue;
    tile_of[b] = static_cast<std::uint32_t>(full.size());
    full.push_back(static_cast<std::uint32_t>(b));
  }
  const auto tiles = std::make_unique_for_overwrite<V[]>(full.size() * (tile_nodes / 4));
  for_ranges(pool, full.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      fill_tile({made.placed.data() + first[full[t]], made.placed.data() + first[full[t] + 1]},
                field.cell, tiles.get() + t * (tile_nodes / 4));
  });
  const auto* nodes = reinterpret_cast<const float*>(tiles.get());
  for_ranges(pool, field.block.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (int side = 0; side < 8; ++side) {
        const Vec3i away{side & 1, side >> 1 & 1, side >> 2};
        const auto n = static_cast<std::size_t>(13 - 9 * away.z - 3 * away.y - away.x);
        const std::uint32_t other = field.near[b][n];
        if (other == no_block || tile_of[other] == no_block) continue;
        add_tile(nodes + std::size_t{tile_of[other]} * tile_nodes, away,
                 field.value.data() + b * block_nodes);
      }
  });
}

/// Clears the nodes of a block beside a block that is not there, in the direction of it.
void clear_side(Vec3i away, float* value) {
  const auto first = [](int side) { return side > 0 ? block_side - 1 : 0; };
  const auto last = [](int side) { return side < 0 ? 0 : block_side - 1; };
  for (int k = first(away.z); k <= last(away.z); ++k)
    for (int j = first(away.y); j <= last(away.y); ++j)
      for (int i = first(away.x); i <= last(away.x); ++i)
        value[(k * block_side + j) * block_side + i] = 0;
}

/// Next to an absent block nothing is inside, whatever the kernels would leave there.
void clear_rim(Field& field, ThreadPool* pool) {
  for_ranges(pool, field.block.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (int n = 0; n < 27; ++n)
        if (field.near[b][static_cast<std::size_t>(n)] == no_block)
          clear_side({n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1}, field.value.data() + b * block_nodes);
  });
}

}  // namespace

MemoryError::MemoryError(double bytes_needed)
    : std::runtime_error("the lattice of a surface needs " + std::to_string(bytes_needed) +
                         " bytes"),
      bytes(bytes_needed) {}

GrainField make_field(const Grains& grains, const Kernel& kernel, std::uint64_t max_bytes,
                      ThreadPool* pool) {
  GrainField made;
  made.field.cell = kernel.cell;
  const double cells = static_cast<double>(kernel.width) / static_cast<double>(kernel.cell);
  const Filter filter = make_filter(cells * cells - 0.25);  // a quadratic B-spline has 1/4
  Runs runs(grains, kernel.cell, pool);
  // Repeated filters reach further than a Gaussian of their width has any weight.
  const int reach = std::min(filter.reach(), static_cast<int>(std::ceil(max_widths * cells)));
  const std::vector<BlockKey> blocks = reached_blocks(occupied_blocks(runs), reach, max_bytes);
  BlockMap map(blocks.size());
  for (const BlockKey key : blocks) map.insert(key);
  find_neighbours(blocks, map, made.field, pool);
  made.field.value.assign(blocks.size() * block_nodes, 0.0f);
  sort_grains(grains, runs, map, pool, made);
  gather_volume(made, pool);
  apply(filter, made.field, pool);
  clear_rim(made.field, pool);
  return made;
}

}  // namespace neve::render::surface
