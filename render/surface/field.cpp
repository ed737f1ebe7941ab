#include "render/surface/field.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "render/surface/block_map.h"
#include "render/surface/loops.h"
#include "sim/base/lanes.h"

namespace neve::render::surface {

namespace {

/// First node of the kernel of a particle.
NEVE_INLINE Vec3i spline_node(const NodePlace& p) {
  return {p.node.x - (p.rest.x < 0.5f ? 1 : 0), p.node.y - (p.rest.y < 0.5f ? 1 : 0),
          p.node.z - (p.rest.z < 0.5f ? 1 : 0)};
}

/// Blocks with particles, and how far in them their first nodes are.
struct Occupied {
  BlockMap map;
  struct Reach {
    Vec3i low{7, 7, 7}, high{0, 0, 0};

    void include(Vec3i from, Vec3i to) {
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], from[axis]);
        high[axis] = std::max(high[axis], to[axis]);
      }
    }
  };
  std::vector<Reach> reach;

  std::uint32_t insert(BlockKey key) {
    const std::uint32_t b = map.insert(key);
    if (b >= reach.size()) reach.resize(b + 1);
    return b;
  }
};

/// A run of particles, and the blocks that they are in.
struct Run {
  Occupied occupied;
  std::vector<std::uint32_t> count;  ///< particles in each of these blocks
  std::vector<std::uint32_t> next;   ///< where the next of them goes in the bins
};

/// The particles in runs, one for each part.
struct Runs {
  std::vector<Run> run;
  std::vector<std::uint32_t> block_of;  ///< number of its block in its run; no_block: left out

  Runs(const Grains& grains, float cell, ThreadPool* pool);
};

constexpr BlockKey no_key = ~BlockKey{0};

void fill_run(const Grains& grains, float cell, std::size_t begin, std::size_t end, Run& to,
              std::vector<std::uint32_t>& block_of) {
  BlockKey last = no_key;
  std::uint32_t b = no_block;
  for (std::size_t p = begin; p < end; ++p) {
    NodePlace place;
    const float volume = grains.volume[p];
    if (!(volume > 0) || !is_finite(volume) || !find_node(grains.position[p], cell, place))
      continue;
    const Vec3i node = spline_node(place);
    const BlockKey key = block_key({node.x >> 3, node.y >> 3, node.z >> 3});
    if (key != last) {
      b = to.occupied.insert(last = key);
      to.count.resize(to.occupied.map.size());
    }
    const Vec3i in{node.x & 7, node.y & 7, node.z & 7};
    to.occupied.reach[b].include(in, in);
    ++to.count[b];
    block_of[p] = b;
  }
}

Runs::Runs(const Grains& grains, float cell, ThreadPool* pool)
    : run(part_count(pool)), block_of(grains.position.size(), no_block) {
  for_parts(pool, block_of.size(), [&](std::size_t part, std::size_t begin, std::size_t end) {
    fill_run(grains, cell, begin, end, run[part], block_of);
  });
}

Occupied occupied_blocks(const Runs& runs) {
  Occupied all;
  for (const Run& run : runs.run)
    for (std::size_t b = 0; b < run.count.size(); ++b) {
      const Occupied::Reach& reach = run.occupied.reach[b];
      all.reach[all.insert(run.occupied.map.keys()[b])].include(reach.low, reach.high);
    }
  return all;
}

/// Fills the bins. A run knows where its particles go, so all runs can go there at once.
/// @param map  of the blocks of the field
void sort_grains(const Grains& grains, Runs& runs, const BlockMap& map, ThreadPool* pool,
                 GrainField& made) {
  std::vector<std::uint32_t> count(map.size(), 0);
  for (Run& run : runs.run) {
    run.next.resize(run.count.size());
    for (std::size_t b = 0; b < run.count.size(); ++b) {
      std::uint32_t& before = count[map.find(run.occupied.map.keys()[b])];
      run.next[b] = before;
      before += run.count[b];
    }
  }
  Bins& bins = made.grains;
  bins.first.assign(map.size() + 1, 0);
  for (std::size_t b = 0; b < map.size(); ++b) bins.first[b + 1] = bins.first[b] + count[b];
  bins.grain.resize(bins.first.back());
  made.placed.resize(bins.first.back());
  for_parts(pool, runs.block_of.size(), [&](std::size_t part, std::size_t begin, std::size_t end) {
    Run& run = runs.run[part];
    for (std::size_t b = 0; b < run.next.size(); ++b)
      run.next[b] += bins.first[map.find(run.occupied.map.keys()[b])];
    for (std::size_t p = begin; p < end; ++p) {
      if (runs.block_of[p] == no_block) continue;
      const std::uint32_t to = run.next[runs.block_of[p]]++;
      bins.grain[to] = static_cast<std::uint32_t>(p);
      made.placed[to] = {grains.position[p], grains.volume[p]};
    }
  });
}

/// Symmetric weights that sum to 1; the weight of k nodes away.
struct Filter {
  int radius = 0;  ///< at most 7: a pass reaches no further than the next block
  int passes = 0;
  std::array<float, 8> weight{};

  int reach() const { return radius * passes; }
};

/// Largest variance of a sum of three neighbours that looks like a part of a Gaussian.
constexpr double widest_step = 0.5;

/// Filters a block along the axis whose neighbours are `inner` numbers apart.
template <int inner>
void filter_block(const Filter& filter, const Field& field, std::size_t b, float* out) {
  constexpr int along = inner == 1 ? 1 : inner == 8 ? 3 : 9;
  constexpr int line = inner * block_side;
  const auto values = [&](int side) -> const float* {
    const std::uint32_t block = field.near[b][static_cast<std::size_t>(13 + side * along)];
    return block == no_block ? nullptr : field.value.data() + std::size_t{block_nodes} * block;
  };
  const float *before = values(-1), *own = values(0), *after = values(1);
  const int margin = filter.radius * inner;
  // The line with as much of its neighbours as the filter sees.
  float wide[3 * line];
  for (int begin = 0; begin < block_nodes; begin += line) {
    if (before)
      std::copy_n(before + begin + line - margin, margin, wide);
    else
      std::fill_n(wide, margin, 0.0f);
    std::copy_n(own + begin, line, wide + margin);
    if (after)
      std::copy_n(after + begin, margin, wide + margin + line);
    else
      std::fill_n(wide + margin + line, margin, 0.0f);
    float sum[line];
    const float* middle = wide + margin;
    for (int n = 0; n < line; ++n) sum[n] = filter.weight[0] * middle[n];
    for (int k = 1; k <= filter.radius; ++k) {
      const float weight = filter.weight[static_cast<std::size_t>(k)];
      const float *left = middle - k * inner, *right = middle + k * inner;
      for (int n = 0; n < line; ++n) sum[n] += weight * (left[n] + right[n]);
    }
    std::copy_n(sum, line, out + begin);
  }
}

template <int inner>
void filter_axis(const Filter& filter, Field& field, std::vector<float>& spare, ThreadPool* pool) {
  for_ranges(pool, field.block.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      filter_block<inner>(filter, field, b, spare.data() + block_nodes * b);
  });
  field.value.swap(spare);
}

/// Makes one of this variance, in squared cells, along an axis. Sums of three neighbours, repeated,
/// are close to a Gaussian and never negative.
Filter make_filter(double variance) {
  Filter filter;
  if (!(variance > 0)) return filter;
  constexpr double most = 7 * widest_step;
  filter.passes = static_cast<int>(std::ceil(variance / most));
  const double of_pass = variance / filter.passes;
  filter.radius = std::max(1, static_cast<int>(std::ceil(of_pass / widest_step)));
  const double side = 0.5 * of_pass / filter.radius;
  std::array<double, 17> weight{};  // of -8 to 8 nodes away
  weight[8] = 1;
  for (int step = 0; step < filter.radius; ++step) {
    const std::array<double, 17> before = weight;
    for (std::size_t k = 1; k < 16; ++k)
      weight[k] = (1 - 2 * side) * before[k] + side * (before[k - 1] + before[k + 1]);
  }
  for (std::size_t k = 0; k <= static_cast<std::size_t>(filter.radius); ++k)
    filter.weight[k] = static_cast<float>(weight[8 + k]);
  return filter;
}

/// Spreads the values of a field along its axes.
void apply(const Filter& filter, Field& field, ThreadPool* pool) {
  std::vector<float> spare(filter.passes > 0 ? field.value.size() : 0);
  for (int pass = 0; pass < filter.passes; ++pass) {
    filter_axis<64>(filter, field, spare, pool);
    filter_axis<8>(filter, field, spare, pool);
    filter_axis<1>(filter, field, spare, pool);
  }
}

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
