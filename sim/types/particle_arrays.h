#pragma once
/// Particles as plain arrays: input and output of a simulation.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/types/material.h"
#include "sim/types/math.h"

namespace neve::sim {

/// Particles as plain arrays in id order, SI units. Empty optional arrays take their defaults.
struct ParticleArrays {
  std::vector<Vec3d> x;           ///< m, measured from the lattice origin
  std::vector<Vec3d> v;           ///< m/s
  std::vector<double> m;          ///< kg
  std::vector<double> V0;         ///< m3; empty or 0: estimated (the paper's step 2)
  std::vector<Mat3d> F_E;         ///< default I
  std::vector<double> J_P;        ///< det F_P, default 1
  std::vector<Mat3d> C;           ///< 1/s, all transfers but FLIP, default 0
  std::vector<int> material;      ///< index, default 0
  std::vector<double> stiffness;  ///< factor on mu and lambda, default 1
  std::vector<double> threshold;  ///< factor on theta_c and theta_s, or p0; default 1
  std::vector<std::uint32_t> id;  ///< increasing; default 0, 1, 2, ...

  std::uint32_t id_of(std::size_t index) const {
    return id.empty() ? static_cast<std::uint32_t>(index) : id[index];
  }
  /// Index of the first particle with at least this id; the number of particles if there is none.
  std::size_t first_from(std::uint64_t id) const;
  /// Index of a particle; nothing if it is not (any more) there.
  std::optional<std::size_t> index_of(std::uint64_t id) const;
  /// The material with the particle's own factors.
  Material material_of(std::size_t index, const std::vector<Material>& materials) const;
};

}  // namespace neve::sim
