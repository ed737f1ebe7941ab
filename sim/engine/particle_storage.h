#pragma once
/// Particle records, and the block of nodes that each belongs to.

#include <cstdint>
#include <vector>

#include "sim/engine/partition.h"
#include "sim/engine/reorder.h"
#include "sim/kernels/particles.h"

namespace neve::sim::engine {

template <class Real>
struct ParticleStorage {
  std::vector<kernels::Particle<Real>> records;
  std::vector<std::uint64_t> keys;    ///< of blocks, per record; the sweeps keep them up to date
  std::vector<std::uint16_t> locals;  ///< model and cell in the block, per record
  Real largest_mass = 0;              ///< kg: none that was ever there has more, see refresh
  Partition partition;
  Reordering<kernels::Particle<Real>> reordering;

  std::size_t size() const { return records.size(); }

  void resize(std::size_t count) {
    records.resize(count);
    keys.resize(count);
    locals.resize(count);
  }

  /// The last record takes its place. The partition is to be told afterwards: forget().
  void remove(std::size_t q) {
    records[q] = records.back();
    keys[q] = keys.back();
    locals[q] = locals.back();
    resize(size() - 1);
  }

  /// Other records: keys and locals are not known yet.
  void replace(const std::vector<kernels::Particle<Real>>& others) {
    records = others;
    keys.assign(others.size(), 0);
    locals.assign(others.size(), 0);
    partition.forget();
  }

  std::uint64_t memory_bytes() const {
    return sizeof(kernels::Particle<Real>) * records.capacity() + reordering.memory_bytes() +
           8 * keys.capacity() + 2 * locals.capacity() + partition.memory_bytes();
  }
};

}  // namespace neve::sim::engine
