#pragma once
/// Memory of the grid, and of the reports about a step.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <new>
#include <vector>

#include "sim/kernels/kernels.h"
#include "sim/state/health_watch.h"

namespace neve::sim::engine {

/// Memory for kernels: aligned to a cache line, never shrinks, not initialised.
template <class Real>
class LaneBuffer {
 public:
  LaneBuffer() = default;
  LaneBuffer(const LaneBuffer&) {}  // scratch: a copy makes its own
  LaneBuffer& operator=(const LaneBuffer&) = delete;

  Quad<Real>* at_least(std::size_t quads) {
    if (quads > capacity_) {
      capacity_ = quads + quads / 4;
      data_.reset();
      data_.reset(::operator new(capacity_ * 4 * sizeof(Real), alignment));
    }
    return static_cast<Quad<Real>*>(data_.get());
  }
  /// Gives the memory back; pointers into it are void.
  void release() {
    data_.reset();
    capacity_ = 0;
  }
  std::size_t bytes() const { return capacity_ * 4 * sizeof(Real); }

 private:
  static constexpr std::align_val_t alignment{64};
  struct Free {
    void operator()(void* p) const { ::operator delete(p, alignment); }
  };
  std::unique_ptr<void, Free> data_;
  std::size_t capacity_ = 0;
};

template <class Real>
struct GridStorage {
  LaneBuffer<Real> tiles, nodes;
  std::vector<kernels::BlockReport<Real>> reports;  ///< per particle block
  std::vector<double> node_contact_work;            ///< per node block, J
  std::vector<kernels::LoadSum> loads;              ///< per collider, of a step
  std::vector<Vec3d>
      moved;  ///< m, per collider: from its own point to the one of its load's moment

  /// Adds what snow did to colliders in a step, about their own points.
  void add_loads(double unit, std::vector<ColliderLoad>& to) const;
  /// Combines the reports of all blocks.
  StepReport step_report() const;

  /// Gives the memory back: of a start, when all particles were on the grid.
  void release() {
    tiles.release();
    nodes.release();
    reports = decltype(reports)();
    node_contact_work = decltype(node_contact_work)();
  }

  std::uint64_t memory_bytes() const {
    return tiles.bytes() + nodes.bytes() + sizeof(kernels::BlockReport<Real>) * reports.capacity() +
           8 * node_contact_work.capacity() + sizeof(kernels::LoadSum) * loads.capacity();
  }
};

template <class Real>
void GridStorage<Real>::add_loads(double unit, std::vector<ColliderLoad>& to) const {
  to.resize(loads.size());
  for (std::size_t k = 0; k < loads.size(); ++k) {
    Vec3d impulse, moment;
    for (int a = 0; a < 3; ++a) {
      impulse[a] = static_cast<double>(loads[k].impulse[a]) * unit;
      moment[a] = static_cast<double>(loads[k].moment[a]) * unit;
    }
    to[k].impulse -= impulse;
    to[k].angular_impulse -= moment + moved[k].cross(impulse);
  }
}

template <class Real>
StepReport GridStorage<Real>::step_report() const {
  kernels::BlockReport<Real> all;
  for (const kernels::BlockReport<Real>& r : reports) {
    all.max_speed_squared = std::max(all.max_speed_squared, r.max_speed_squared);
    all.max_sound_squared = std::max(all.max_sound_squared, r.max_sound_squared);
    all.max_strain_rate = std::max(all.max_strain_rate, r.max_strain_rate);
    all.min_J_P = std::min(all.min_J_P, r.min_J_P);
    all.max_J_P = std::max(all.max_J_P, r.max_J_P);
    all.contact_work += r.contact_work;
    all.inverted += r.inverted;
    all.inverted_unprojected += r.inverted_unprojected;
    all.not_finite += r.not_finite;
    all.overflowed += r.overflowed;
  }
  for (const double work : node_contact_work) all.contact_work += work;
  return {std::sqrt(static_cast<double>(all.max_speed_squared)),
          std::sqrt(static_cast<double>(all.max_sound_squared)),
          static_cast<double>(all.max_strain_rate),
          static_cast<double>(all.min_J_P),
          static_cast<double>(all.max_J_P),
          all.contact_work,
          all.inverted,
          all.inverted_unprojected,
          all.not_finite,
          all.overflowed};
}

}  // namespace neve::sim::engine
