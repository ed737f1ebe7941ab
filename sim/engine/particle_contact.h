#pragma once
/// Contact at particles for a whole step: which blocks take part, and the passes over them.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/base/thread_pool.h"
#include "sim/engine/method.h"
#include "sim/engine/partition.h"
#include "sim/kernels/particle_contact.h"

namespace neve::sim::engine {

template <class Real>
class ParticleContact {
 public:
  /// The nodes have v_free as v_new and get v_star; the first channel of tiles is overwritten, and
  /// the work of the colliders is added to that of the nodes.
  /// @param max_speed  of the particles before the step, m/s
  void act(const kernels::SweepArgs<Real>& step, double dt, double max_speed,
           const Method<Real>& method, const Partition& partition, ThreadPool& pool, int threads);

  std::size_t memory_bytes() const;

 private:
  kernels::ContactArgs<Real> args(const kernels::SweepArgs<Real>& step, double dt,
                                  const Method<Real>& method);
  void make_room(std::size_t particles, const Partition& partition);
  std::uint64_t place_contacts();
  void list_blocks();
  void list_node_blocks(const Partition& partition);

  std::vector<std::uint32_t> candidates_;            ///< per sorted position
  std::vector<std::uint32_t> near_counts_, counts_;  ///< per particle block, see ContactArgs
  std::vector<std::uint64_t> first_;
  std::vector<std::uint32_t> blocks_, node_blocks_;  ///< that take part
  std::vector<std::uint8_t> is_reached_;             ///< per node block
  std::vector<kernels::Contact<Real>> contacts_;
  std::vector<kernels::ContactNodes<Real>> nodes_;
};

}  // namespace neve::sim::engine
