#include "sim/state/spray.h"

#include <algorithm>
#include <cstdlib>

#include "sim/kernels/kernels.h"

namespace neve::sim::engine {

namespace {

/// More make good use of a block on the grid. They are taken to their nodes together, as there.
constexpr std::uint32_t max_particles = kernels::scatter_group;

/// Three small numbers, a byte each; also of differences, whose sum with `bias` is positive.
constexpr std::uint32_t packed(int x, int y, int z) {
  return static_cast<std::uint32_t>(x) + (static_cast<std::uint32_t>(y) << 8) +
         (static_cast<std::uint32_t>(z) << 16);
}
constexpr std::uint32_t bias = packed(64, 64, 64);
/// True if no number is negative.
constexpr bool are_positive(std::uint32_t with_bias) {
  return (with_bias & bias) == bias;
}

constexpr std::uint32_t cell_of(std::uint16_t local) {
  return packed(local >> 4 & 3, local >> 2 & 3, local & 3);
}

constexpr int model_of(std::uint16_t local) {
  return local >> 6;
}

std::uint32_t count_of(const kernels::BlockRange& block) {
  return block.end - block.begin;
}

bool is_inside(const kernels::BlockRange& block, const Vec3i& period) {
  for (int a = 0; a < 3; ++a) {
    const int at = kernels::block_coordinate(block.key, a);
    if (period[a] > 0 && (at == 0 || at == period[a] - 1)) return false;
  }
  return true;
}

/// Three blocks of a line along z: below, beside and above the block that is looked at.
struct Line {
  std::uint64_t offset;  ///< from the key of that block to the first
  std::uint32_t cells;   ///< to the second
  std::size_t at;        ///< the first block that is not before these
};

}  // namespace

/// Blocks at the ends of a period are no spray: they have neighbours at the other end.
void Spray::find_boxes(const Blocks& blocks, const std::vector<std::uint16_t>& locals,
                       const Vec3i& period, std::size_t begin, std::size_t end) {
  for (std::size_t b = begin; b < end; ++b) {
    const kernels::BlockRange& block = blocks[b];
    neighbour_[b] = not_spray;
    boxes_[b] = {packed(0, 0, 0), packed(3, 3, 3)};
    if (count_of(block) > max_particles) continue;
    Box& box = boxes_[b] = {cell_of(locals[block.begin]), cell_of(locals[block.begin])};
    for (std::uint32_t p = block.begin + 1; p < block.end; ++p)
      for (std::uint32_t byte = 0xff; byte <= 0xff0000; byte <<= 8) {
        const std::uint32_t cell = cell_of(locals[p]) & byte;
        box.low = std::min(box.low & byte, cell) | (box.low & ~byte);
        box.high = std::max(box.high & byte, cell) | (box.high & ~byte);
      }
    // The block is sorted by model.
    const bool is_alike = model_of(locals[block.begin]) == model_of(locals[block.end - 1]);
    if (is_alike && is_inside(block, period)) neighbour_[b] = no_neighbour;
  }
}

/// Blocks are in order, so the lines of blocks around one that is looked at move forward with it.
void Spray::find_neighbours(const Blocks& blocks, std::size_t begin, std::size_t end) {
  Line lines[9];
  for (int k = 0; k < 9; ++k) {
    const int x = k / 3 - 1, y = k % 3 - 1;
    const std::uint64_t offset = kernels::block_key(x, y, -1) - kernels::block_key(0, 0, 0);
    const auto at = std::partition_point(blocks.begin(), blocks.end(), [&](const auto& block) {
      return block.key < blocks[begin].key + offset;
    });
    lines[k] = {offset, packed(kernels::block_side * x, kernels::block_side * y, 0),
                static_cast<std::size_t>(at - blocks.begin())};
  }
  // Rows along z are read in fours, whatever the weight of the last.
  const std::uint32_t reach = bias + packed(kernel_nodes_ - 1, kernel_nodes_ - 1, 3);
  for (std::size_t b = begin; b < end; ++b) {
    std::int32_t found = neighbour_[b];
    if (found == not_spray) continue;
    const Box box = boxes_[b];
    for (Line& line : lines) {
      const std::uint64_t first = blocks[b].key + line.offset;
      std::size_t n = line.at;
      while (n < blocks.size() && blocks[n].key < first) ++n;
      line.at = n;
      for (; n < blocks.size() && blocks[n].key <= first + 2; ++n) {
        const int up = static_cast<int>(blocks[n].key - first) - 1;
        const std::uint32_t apart = line.cells + packed(0, 0, kernels::block_side * up);
        const bool share_nodes = are_positive(box.high + reach - apart - boxes_[n].low) &&
                                 are_positive(boxes_[n].high + reach + apart - box.low);
        if (share_nodes && n != b)
          found = found == no_neighbour ? static_cast<std::int32_t>(n) : not_spray;
      }
    }
    neighbour_[b] = found;
  }
}

void Spray::list_clusters(const Blocks& blocks, const std::vector<std::uint16_t>& locals) {
  clusters_.clear();
  std::fill(is_spray_.begin(), is_spray_.end(), std::uint8_t{0});
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (is_spray_[b] || neighbour_[b] == not_spray) continue;
    if (neighbour_[b] == no_neighbour)
      add_block(blocks, b);
    else if (!add_pair(blocks, locals, b))
      continue;
    clusters_.back().model = static_cast<std::uint8_t>(model_of(locals[blocks[b].begin]));
  }
}

void Spray::add_block(const Blocks& blocks, std::size_t b) {
  const Box& box = boxes_[b];
  kernels::SprayCluster cluster{};
  cluster.begin[0] = blocks[b].begin;
  cluster.count[0] = static_cast<std::uint8_t>(count_of(blocks[b]));
  for (int a = 0; a < 3; ++a) cluster.shift[0][a] = static_cast<std::int8_t>(-box.at(a));
  for (int a = 0; a < 2; ++a)
    cluster.size[a] = static_cast<std::uint8_t>(box.extent(a) + kernel_nodes_);
  cluster.rows = box.extent(2) == 0 ? 1 : 2;
  is_spray_[b] = 1;
  clusters_.push_back(cluster);
}

/// The order of the two does not matter: a node adds up no more than two cells.
bool Spray::add_pair(const Blocks& blocks, const std::vector<std::uint16_t>& locals,
                     std::size_t b) {
  const auto other = static_cast<std::size_t>(neighbour_[b]);
  const kernels::BlockRange pair[2] = {blocks[b], blocks[other]};
  const Box boxes[2] = {boxes_[b], boxes_[other]};
  if (neighbour_[other] != static_cast<std::int32_t>(b) || boxes[0].low != boxes[0].high ||
      boxes[1].low != boxes[1].high || count_of(pair[0]) + count_of(pair[1]) > max_particles ||
      model_of(locals[pair[0].begin]) != model_of(locals[pair[1].begin]))
    return false;
  kernels::SprayCluster cluster{};
  for (int k = 0; k < 2; ++k) {
    cluster.begin[k] = pair[k].begin;
    cluster.count[k] = static_cast<std::uint8_t>(count_of(pair[k]));
  }
  for (int a = 0; a < 3; ++a) {
    const int blocks_apart =
        kernels::block_coordinate(pair[1].key, a) - kernels::block_coordinate(pair[0].key, a);
    const int apart = kernels::block_side * blocks_apart + boxes[1].at(a) - boxes[0].at(a);
    cluster.shift[0][a] = static_cast<std::int8_t>(std::max(0, -apart) - boxes[0].at(a));
    cluster.shift[1][a] = static_cast<std::int8_t>(std::max(0, apart) - boxes[1].at(a));
    if (a < 2)
      cluster.size[a] = static_cast<std::uint8_t>(std::abs(apart) + kernel_nodes_);
    else
      cluster.rows = apart == 0 ? 1 : 2;
  }
  is_spray_[b] = is_spray_[other] = 1;
  clusters_.push_back(cluster);
  return true;
}

std::size_t Spray::memory_bytes() const {
  return sizeof(Box) * boxes_.capacity() + 4 * neighbour_.capacity() + is_spray_.capacity() +
         sizeof(kernels::SprayCluster) * clusters_.capacity();
}

}  // namespace neve::sim::engine
