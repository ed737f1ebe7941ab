#pragma once
/// Room for newborn snow: births wait where particles are in their way.

#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "sim/seeding/flow.h"
#include "sim/state/state.h"

namespace neve::sim::engine {

/// Places of the particles near births. A density on the grid would not do: at the edge of a stream
/// its weights reach into the air, and snow there looks thin at any density.
template <class Real>
class Room {
 public:
  /// @param state  after a step, with its partition, or before the first; has to outlive this
  explicit Room(const State<Real>& state);

  /// True if the particles around a birth leave it room.
  bool has_room(const seeding::Birth& birth);
  void take(const seeding::Birth& birth);

 private:
  static constexpr std::uint32_t none = 0xffffffff;
  struct Place {
    Vec3d x;
    double V0;  ///< m3
    double J_P;
    std::uint32_t next;  ///< in the same cell
  };

  void add(const Vec3d& x, double V0, double J_P);
  void add(const kernels::Particle<Real>& p);
  void add_block(std::uint64_t key);
  void add_blocks_around(const Vec3i& cell, int cells);
  Vec3i cell_of(const Vec3d& x) const;

  const State<Real>& state_;
  double cell_size_;
  std::vector<Place> places_;
  std::unordered_map<std::uint64_t, std::uint32_t> first_;  ///< place of each cell
  std::unordered_set<std::uint64_t> blocks_;                ///< that were added
  /// Particles come sorted by cell: most follow one of the same.
  std::uint64_t last_key_ = 0;
  std::uint32_t* last_first_ = nullptr;
};

}  // namespace neve::sim::engine
