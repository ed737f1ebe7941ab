#pragma once
/// Particles by blocks: brought up to date every step from the particles' keys.

#include <cstdint>
#include <vector>

#include "sim/base/thread_pool.h"
#include "sim/kernels/blocks.h"
#include "sim/state/reorder.h"
#include "sim/state/spray.h"
#include "sim/types/math.h"

namespace neve::sim::engine {

/// Particles in block order, and the blocks of nodes around those on the grid. The order is that of
/// block key, then model and cell, then storage; it depends neither on the number of threads nor on
/// the order before. Most particles are where they were a step ago, so only those that changed cell
/// or block are sorted.
class Partition {
 public:
  /// Sets the period in blocks per axis, 0: open. One block is enough: a stencil is no wider.
  void set_period(const Vec3i& period) {
    period_ = period;
    is_linked_ = false;
  }

  std::uint64_t wrapped(std::uint64_t key) const;
  /// Brings keys of particles into the first period.
  void wrap(std::vector<std::uint64_t>& keys, ThreadPool& pool, int threads) const;

  /// Particles may have been added at the end since the last call; if there are fewer, all are
  /// sorted again. After any other change of the storage invalidate() has to be called.
  /// @param keys, locals  per storage index, see SweepArgs
  void build(const std::vector<std::uint64_t>& keys, const std::vector<std::uint16_t>& locals,
             ThreadPool& pool, int threads);

  /// Puts all particles on the grid.
  void put_on_grid(ThreadPool& pool, int threads);
  /// Puts all particles on the grid but spray. @param kernel_nodes, is_free  see Spray::find
  template <class IsFree>
  void put_on_grid_but_spray(int kernel_nodes, const IsFree& is_free, ThreadPool& pool,
                             int threads) {
    spray_.find(all_, locals_, period_, kernel_nodes, is_free, pool, threads);
    list_grid_blocks(true);
    link_node_blocks(pool, threads);
  }
  /// Forgets the grid and gives its memory back.
  void release_grid();

  /// The next build sorts all particles: the storage has changed in another way.
  void invalidate();

  /// Brings storage into the order found; keys and locals follow.
  template <class Record>
  void sort_storage(std::vector<Record>& records, Reordering<Record>& reordering,
                    std::vector<std::uint64_t>& keys, std::vector<std::uint16_t>& locals,
                    ThreadPool& pool, int threads) {
    reordering.run(records, order_, pool, threads);
    storage_was_sorted(keys, locals, pool, threads);
  }

  const std::vector<std::uint32_t>& order() const { return order_; }
  const std::vector<std::uint16_t>& sorted_locals() const { return locals_; }
  /// Returns all blocks that have particles.
  const std::vector<kernels::BlockRange>& all_blocks() const { return all_; }
  /// Returns the blocks on the grid.
  const std::vector<kernels::ParticleBlock>& blocks() const { return blocks_; }
  const std::vector<kernels::NodeBlock>& node_blocks() const { return node_blocks_; }
  const std::vector<kernels::SprayCluster>& spray() const { return spray_.clusters(); }
  /// The blocks of particles [begin, end), in order, by their keys alone: whatever was built. Their
  /// ranges are empty.
  std::vector<kernels::BlockRange> blocks_of(const std::vector<std::uint64_t>& keys,
                                             std::size_t begin, std::size_t end) const;
  /// Blocks of nodes that particles reach, those of spray as well, by their keys alone.
  std::size_t reached_node_blocks(const std::vector<std::uint64_t>& keys) const;

  std::size_t memory_bytes() const;

  /// First block on the grid of a part of its particles, cut by their count; part = parts gives the
  /// end.
  std::uint32_t first_block(int part, int parts) const;

 private:
  /// A particle on its way to a block; place is local << 32 | storage index.
  struct Arrival {
    std::uint64_t key, place;
  };
  /// Arrivals of one part that go to the same block.
  struct ArrivalGroup {
    std::uint64_t key;
    std::uint32_t begin, count;
  };
  /// Particles of a block of the step before: [begin, stay) stay in their cell, [moved, end)
  /// changed cell. Those between them left.
  struct Kept {
    std::uint32_t begin = 0, stay = 0, moved = 0, end = 0;
  };
  /// Lists of one thread.
  struct Part {
    std::vector<Arrival> arrivals;
    std::vector<ArrivalGroup> groups;
    std::vector<std::size_t> next;
    std::vector<std::uint64_t> places, scattered;
  };
  /// Union of a list of keys and the same moved one block up an axis, in order. Index in the list,
  /// or -1.
  struct Union {
    std::vector<std::uint64_t> keys;
    std::vector<std::int32_t> here, below;
  };

  void storage_was_sorted(std::vector<std::uint64_t>& keys, std::vector<std::uint16_t>& locals,
                          ThreadPool& pool, int threads) const;
  void find_changes(const std::vector<std::uint64_t>& keys,
                    const std::vector<std::uint16_t>& locals, std::size_t known, ThreadPool& pool);
  void keep(std::size_t block, const std::vector<std::uint64_t>& keys,
            const std::vector<std::uint16_t>& locals, Part& part);
  static void group_arrivals(Part& part, std::size_t begin);
  void list_blocks();
  void place_particles(ThreadPool& pool);
  void fill(const kernels::BlockRange& block, const Kept& kept, Part& part);
  std::uint32_t first_of_all(int part, int parts) const;
  void list_grid_blocks(bool has_spray);
  void link_node_blocks(ThreadPool& pool, int threads);
  void find_node_blocks(ThreadPool& pool, int threads);
  void unite(const std::vector<std::uint64_t>& keys, int axis, Union& out) const;

  Vec3i period_{0, 0, 0};

  std::vector<std::uint32_t> order_, next_order_;    ///< sorted position -> storage index
  std::vector<std::uint16_t> locals_, next_locals_;  ///< per sorted position
  std::vector<kernels::BlockRange> all_, next_all_;
  std::vector<Kept> kept_;            ///< per block of the step before
  std::vector<std::int32_t> source_;  ///< per block: which it was in the step before, -1: none
  std::vector<Part> parts_;
  std::vector<ArrivalGroup> arrival_groups_;

  Spray spray_;
  std::vector<kernels::ParticleBlock> blocks_;
  std::vector<std::uint32_t> first_particles_;  ///< per block on the grid: particles before it
  std::uint32_t grid_particles_ = 0;
  std::vector<kernels::NodeBlock> node_blocks_;
  bool is_linked_ = false;  ///< node blocks are those of the blocks
  Union unions_[3];
};

}  // namespace neve::sim::engine
