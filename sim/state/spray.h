#pragma once
/// Particles that share no node with others.

#include <cstdint>
#include <vector>

#include "sim/base/thread_pool.h"
#include "sim/kernels/blocks.h"
#include "sim/types/math.h"

namespace neve::sim::engine {

/// Clusters of spray: blocks of few particles whose nodes no other particle reaches, and pairs of
/// blocks with a cell each that share nodes with each other alone. In a cluster every node gets
/// what it would get on the grid, in the same order.
class Spray {
 public:
  /// @param blocks, locals  of all particles, in order, see Partition
  /// @param period  in blocks per axis, 0: open
  /// @param is_free  is_free(key): no collider is near the block; called by all threads
  template <class IsFree>
  void find(const std::vector<kernels::BlockRange>& blocks,
            const std::vector<std::uint16_t>& locals, const Vec3i& period, int kernel_nodes,
            const IsFree& is_free, ThreadPool& pool, int threads);

  const std::vector<kernels::SprayCluster>& clusters() const { return clusters_; }
  /// Returns for each block if it is part of a cluster.
  const std::vector<std::uint8_t>& is_spray() const { return is_spray_; }
  std::size_t memory_bytes() const;

 private:
  using Blocks = std::vector<kernels::BlockRange>;
  /// First and last cell of the block's particles: x, y and z in a byte each.
  struct Box {
    std::uint32_t low, high;
    int at(int axis) const { return static_cast<int>(low >> (8 * axis) & 3); }
    int extent(int axis) const { return static_cast<int>(high >> (8 * axis) & 3) - at(axis); }
  };
  /// Neighbours that share nodes: the block of one, or one of these.
  enum : std::int32_t { no_neighbour = -1, not_spray = -2 };

  void find_boxes(const Blocks& blocks, const std::vector<std::uint16_t>& locals,
                  const Vec3i& period, std::size_t begin, std::size_t end);
  void find_neighbours(const Blocks& blocks, std::size_t begin, std::size_t end);
  void list_clusters(const Blocks& blocks, const std::vector<std::uint16_t>& locals);
  void add_block(const Blocks& blocks, std::size_t b);
  bool add_pair(const Blocks& blocks, const std::vector<std::uint16_t>& locals, std::size_t b);

  int kernel_nodes_ = 0;
  std::vector<Box> boxes_;               ///< per block
  std::vector<std::int32_t> neighbour_;  ///< per block
  std::vector<std::uint8_t> is_spray_;   ///< per block
  std::vector<kernels::SprayCluster> clusters_;
};

template <class IsFree>
void Spray::find(const std::vector<kernels::BlockRange>& blocks,
                 const std::vector<std::uint16_t>& locals, const Vec3i& period, int kernel_nodes,
                 const IsFree& is_free, ThreadPool& pool, int threads) {
  kernel_nodes_ = kernel_nodes;
  boxes_.resize(blocks.size());
  neighbour_.resize(blocks.size());
  is_spray_.resize(blocks.size());
  pool.ranges(blocks.size(), threads, [&](std::size_t begin, std::size_t end) {
    find_boxes(blocks, locals, period, begin, end);
  });
  pool.ranges(blocks.size(), threads, [&](std::size_t begin, std::size_t end) {
    find_neighbours(blocks, begin, end);
    for (std::size_t b = begin; b < end; ++b)
      if (neighbour_[b] != not_spray && !is_free(blocks[b].key)) neighbour_[b] = not_spray;
  });
  list_clusters(blocks, locals);
}

}  // namespace neve::sim::engine
