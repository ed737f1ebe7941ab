#pragma once
/// Rotations of many points, small enough to pass along.

#include <array>
#include <cstdint>

#include "sim/base/vec.h"

namespace neve::render {

/// A unit quaternion w, x, y, z times 32767.
using PackedTurn = std::array<std::int16_t, 4>;

inline constexpr PackedTurn no_turn{32767, 0, 0, 0};

/// A rotation by a unit quaternion.
struct Turn {
  float w = 1;
  Vec3f axis;

  explicit Turn(const PackedTurn& q)
      : w(static_cast<float>(q[0]) / 32767),
        axis(Vec3f{static_cast<float>(q[1]), static_cast<float>(q[2]), static_cast<float>(q[3])} *
             (1.0f / 32767)) {}
  Vec3f forth(Vec3f v) const { return v + cross(axis, cross(axis, v) + v * w) * 2; }
  Vec3f back(Vec3f v) const { return v + cross(axis, cross(axis, v) - v * w) * 2; }
};

}  // namespace neve::render
