#pragma once
/// Reads particles back, in id order, and sums over them.

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "sim/kernels/contact.h"
#include "sim/state/state.h"
#include "sim/types/particle_arrays.h"
#include "sim/types/reports.h"

namespace neve::sim::engine {

/// Ranks of particles in id order.
class Ranks {
 public:
  /// Ids are ranks.
  Ranks() = default;
  /// @param by_id  ranks; those of ids without a particle are ignored
  static Ranks by_id(std::vector<std::uint32_t> by_id) { return {std::move(by_id), {}}; }
  /// @param ids  of all particles, in order: where most ids are of particles that left
  static Ranks among(std::vector<std::uint32_t> ids) { return {{}, std::move(ids)}; }

  bool are_ids() const { return by_id_.empty() && ids_.empty(); }
  template <class Real>
  std::size_t operator[](const kernels::Particle<Real>& p) const {
    const auto id = static_cast<std::uint32_t>(p.id);
    if (are_ids()) return id;
    if (!by_id_.empty()) return by_id_[id];
    return static_cast<std::size_t>(std::lower_bound(ids_.begin(), ids_.end(), id) - ids_.begin());
  }

 private:
  Ranks(std::vector<std::uint32_t> by_id, std::vector<std::uint32_t> ids)
      : by_id_(std::move(by_id)), ids_(std::move(ids)) {}

  std::vector<std::uint32_t> by_id_, ids_;
};

template <class Real>
class StateReader {
 public:
  explicit StateReader(const State<Real>& state) : state_(state) {}

  Ranks ranks() const;
  ParticleArrays particles() const;
  std::vector<Mat3d> kirchhoff() const;
  std::vector<Vec3i> cells() const;
  std::uint64_t state_hash() const;
  Summary summary() const;

 private:
  Ranks ranks_among_few() const;
  struct Sums : Summary {
    double snow_mass = 0;  ///< kg
  };
  Sums sum_of(std::size_t begin, std::size_t end) const;
  /// Snow at the surfaces of colliders.
  struct AtSurfaces {
    double max_depth = 0;              ///< m, of the deepest particle; 0 where all are outside
    std::vector<double> max_pressure;  ///< Pa, per collider; see Summary
  };
  AtSurfaces at_surfaces() const;
  void look_at_surfaces(std::size_t begin, std::size_t end,
                        const std::vector<kernels::LocalCollider<double>>& colliders,
                        AtSurfaces& found) const;

  const State<Real>& state_;
};

}  // namespace neve::sim::engine
