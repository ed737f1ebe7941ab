#include "render/surface/pieces.h"

#include <algorithm>
#include <numeric>

#include "render/surface/loops.h"

namespace neve::render::surface {

namespace {

constexpr InsideBits full_block = {~0ull, ~0ull, ~0ull, ~0ull, ~0ull, ~0ull, ~0ull, ~0ull};

/// Cells: no node that is looked for is further away than the next block.
constexpr int max_reach = 6;

/// Sets that grow together; the smallest member names each.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  std::uint32_t find(std::uint32_t a) {
    while (parent_[a] != a) a = parent_[a] = parent_[parent_[a]];
    return a;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

InsideBits inside_of(const float* value) {
  InsideBits bits;
  for (std::size_t k = 0; k < block_side; ++k)
    for (std::size_t n = 0; n < 64; ++n)
      bits.slice[k] |= std::uint64_t{value[64 * k + n] >= surface_share} << n;
  return bits;
}

/// Rows of nodes in a block that are inside and connected in the row get a label; rows that touch
/// get the same one.
class BlockLabels {
 public:
  /// @param labels of the nodes of a block: from 0, or no_label
  static constexpr std::uint16_t no_label = 0xffff;

  /// @return how many there are
  static std::uint16_t find(const InsideBits& bits, std::uint16_t* labels) {
    std::fill_n(labels, block_nodes, no_label);
    if (bits == InsideBits{}) return 0;
    if (bits == full_block) {
      std::fill_n(labels, block_nodes, std::uint16_t{0});
      return 1;
    }
    std::array<std::uint16_t, block_nodes> parent;
    const auto root = [&](std::uint16_t a) {
      while (parent[a] != a) a = parent[a] = parent[parent[a]];
      return a;
    };
    for (std::uint16_t n = 0; n < block_nodes; ++n) {
      if ((bits.slice[n >> 6] >> (n & 63) & 1) == 0) continue;
      parent[n] = labels[n] = n;
      for (const auto& [is_edge, step] :
           {std::pair{(n & 7) == 0, 1}, {(n >> 3 & 7) == 0, 8}, {n < 64, 64}}) {
        if (is_edge || labels[n - step] == no_label) continue;
        const std::uint16_t a = root(n), b = root(static_cast<std::uint16_t>(n - step));
        parent[std::max(a, b)] = std::min(a, b);
      }
    }
    return number(labels, root, parent);
  }

 private:
  /// Gives the roots numbers from 0 in their order.
  static std::uint16_t number(std::uint16_t* labels, const auto& root,
                              const std::array<std::uint16_t, block_nodes>& parent) {
    std::array<std::uint16_t, block_nodes> number_of;
    std::uint16_t count = 0;
    for (std::uint16_t n = 0; n < block_nodes; ++n) {
      if (labels[n] == no_label) continue;
      if (parent[n] == n) number_of[n] = count++;
      labels[n] = number_of[root(n)];
    }
    return count;
  }
};

/// Labels of all nodes: those of block b from first[b] on.
struct Labels {
  std::vector<std::uint16_t> of_node;
  std::vector<std::uint32_t> first;

  std::uint32_t at(std::size_t b, std::size_t node) const {
    const std::uint16_t label = of_node[b * block_nodes + node];
    return label == BlockLabels::no_label ? no_block : first[b] + label;
  }
};

Labels label_blocks(const std::vector<InsideBits>& inside, ThreadPool* pool) {
  Labels labels;
  labels.of_node.resize(inside.size() * block_nodes);
  labels.first.assign(inside.size() + 1, 0);
  for_ranges(pool, inside.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      labels.first[b + 1] = BlockLabels::find(inside[b], labels.of_node.data() + b * block_nodes);
  });
  for (std::size_t b = 0; b < inside.size(); ++b) labels.first[b + 1] += labels.first[b];
  return labels;
}

/// Joins labels across the sides of blocks.
Sets join_blocks(const Field& field, const std::vector<InsideBits>& inside, const Labels& labels) {
  Sets sets(labels.first.back());
  constexpr std::array<std::size_t, 3> neighbour{14, 16, 22}, step{1, 8, 64};
  for (std::size_t b = 0; b < inside.size(); ++b)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t other = field.near[b][neighbour[axis]];
      if (other == no_block || inside[b] == InsideBits{} || inside[other] == InsideBits{}) continue;
      if (inside[b] == full_block && inside[other] == full_block) {
        sets.join(labels.first[b], labels.first[other]);
        continue;
      }
      const std::size_t u = step[(axis + 1) % 3], v = step[(axis + 2) % 3];
      for (std::size_t n = 0; n < 64; ++n) {
        const std::size_t low = (n & 7) * u + (n >> 3) * v;
        const std::uint32_t a = labels.at(b, low + 7 * step[axis]), c = labels.at(other, low);
        if (a != no_block && c != no_block) sets.join(a, c);
      }
    }
  return sets;
}

/// The label of a node by its place from the corner of a block.
std::uint32_t label_at(const Field& field, const Labels& labels, std::size_t b, Vec3i in) {
  const int side = ((in.z + 8) >> 3) * 9 + ((in.y + 8) >> 3) * 3 + ((in.x + 8) >> 3);
  const std::uint32_t other = field.near[b][static_cast<std::size_t>(side)];
  if (other == no_block) return no_block;
  return labels.at(other, static_cast<std::size_t>((in.z & 7) << 6 | (in.y & 7) << 3 | (in.x & 7)));
}

/// The label that a particle belongs to: that of the nearest node, or the first one in the smallest
/// cube of nodes around it. @param reach half the side of the largest cube
std::uint32_t label_of_grain(Vec3f position, std::size_t b, int reach, const Field& field,
                             const Labels& labels) {
  NodePlace place;
  find_node(position, field.cell, place);
  const auto rounded = [](float rest) { return rest < 0.5f ? 0 : 1; };
  const Vec3i nearest = place.node - field.block[b] * block_side +
                        Vec3i{rounded(place.rest.x), rounded(place.rest.y), rounded(place.rest.z)};
  std::uint32_t label = label_at(field, labels, b, nearest);
  for (int r = 1; r <= reach && label == no_block; ++r)
    for (int z = -r; z <= r && label == no_block; ++z)
      for (int y = -r; y <= r && label == no_block; ++y)
        for (int x = -r; x <= r && label == no_block; ++x)
          label = label_at(field, labels, b, nearest + Vec3i{x, y, z});
  return label;
}

/// The label of each particle; no_block also for those that the field leaves out.
std::vector<std::uint32_t> label_grains(const Grains& grains, const Bins& blocks, int reach,
                                        const Field& field, const Labels& labels,
                                        ThreadPool* pool) {
  std::vector<std::uint32_t> label(grains.position.size(), no_block);
  for_ranges(pool, field.block.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (std::uint32_t k = blocks.first[b]; k < blocks.first[b + 1]; ++k) {
        const std::uint32_t p = blocks.grain[k];
        label[p] = label_of_grain(grains.position[p], b, reach, field, labels);
      }
  });
  return label;
}

/// Nodes of pieces that are not kept fall below the surface.
void remove_nodes(const Labels& labels, const std::vector<bool>& is_kept, std::size_t b,
                  InsideBits& inside, float* value) {
  for (std::size_t n = 0; n < block_nodes; ++n) {
    const std::uint32_t label = labels.at(b, n);
    if (label == no_block || is_kept[label]) continue;
    inside.slice[n >> 6] &= ~(1ull << (n & 63));
    value[n] = 0.5f * surface_share;
  }
}

}  // namespace

Pieces find_pieces(const Grains& grains, const Bins& blocks, const PieceRules& rules, Field& field,
                   ThreadPool* pool) {
  Pieces pieces;
  pieces.inside.resize(field.block.size());
  for_ranges(pool, field.block.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      pieces.inside[b] = inside_of(field.value.data() + b * block_nodes);
  });
  const Labels labels = label_blocks(pieces.inside, pool);
  Sets sets = join_blocks(field, pieces.inside, labels);
  std::vector<std::uint32_t> label =
      label_grains(grains, blocks, std::clamp(rules.reach, 0, max_reach), field, labels, pool);
  std::vector<std::uint32_t> size(labels.first.back(), 0);
  for (std::uint32_t& l : label)
    if (l != no_block) ++size[l = sets.find(l)];
  std::vector<bool> is_kept(size.size());
  for (std::uint32_t l = 0; l < size.size(); ++l) {
    const std::uint32_t root = sets.find(l);
    is_kept[l] = size[root] >= static_cast<std::uint32_t>(std::max(rules.smallest, 0));
    if (root == l && is_kept[l]) ++pieces.count;
  }
  for (std::size_t p = 0; p < label.size(); ++p)
    if (label[p] == no_block || !is_kept[label[p]])
      pieces.loose.push_back(static_cast<std::uint32_t>(p));
  if (std::find(is_kept.begin(), is_kept.end(), false) == is_kept.end()) return pieces;
  for_ranges(pool, field.block.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      remove_nodes(labels, is_kept, b, pieces.inside[b], field.value.data() + b * block_nodes);
  });
  return pieces;
}

}  // namespace neve::render::surface
