#pragma once
/// Which particle belongs to which block: rebuilt every step from the particles' keys.

#include <cstdint>
#include <vector>

#include "sim/base/thread_pool.h"
#include "sim/blocks.h"
#include "sim/math.h"

namespace neve::sim {

/// Particles in block order, and the blocks of nodes around them. The order is that of block key,
/// then model and cell, then storage; it does not depend on the number of threads.
class Partition {
 public:
  /// In blocks per axis, 0: open. One block is enough: a stencil is no wider.
  void set_period(const Vec3i& period) { period_ = period; }

  /// Brings keys of particles into the first period.
  void wrap(std::vector<std::uint64_t>& keys, ThreadPool& pool, int threads) const;

  /// @param keys, locals  per storage index, see SweepArgs
  void build(const std::vector<std::uint64_t>& keys, const std::vector<std::uint16_t>& locals,
             ThreadPool& pool, int threads);

  /// Storage now is in the order found: sorted position q holds particle q.
  void storage_was_sorted();

  const std::vector<std::uint32_t>& order() const { return order_; }
  const std::vector<ParticleBlock>& blocks() const { return blocks_; }
  const std::vector<NodeBlock>& node_blocks() const { return node_blocks_; }

  std::size_t memory_bytes() const;

  /// First block of the range of a thread, cut by particle count; thread = threads gives the end.
  std::uint32_t first_block(int thread, int threads) const;

 private:
  void find_blocks(const std::vector<std::uint64_t>& keys, ThreadPool& pool, int threads);
  void count_and_place(const std::vector<std::uint64_t>& keys, ThreadPool& pool, int threads);
  void sort_inside_blocks(const std::vector<std::uint16_t>& locals, ThreadPool& pool, int threads);
  void link_node_blocks();
  std::uint64_t wrapped(std::uint64_t key) const;

  Vec3i period_{0, 0, 0};

  std::vector<std::uint32_t> order_, block_of_, links_;
  std::vector<std::uint64_t> block_keys_, previous_keys_;
  std::vector<ParticleBlock> blocks_;
  std::vector<NodeBlock> node_blocks_;
  std::vector<std::vector<std::uint64_t>> found_;
  std::vector<std::vector<std::uint32_t>> counts_, scratch_;
};

}  // namespace neve::sim
