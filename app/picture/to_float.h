#pragma once
/// Vectors and rotations of the simulation as the renderer takes them.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "render/frame/turn.h"
#include "render/shapes/mesh_shapes.h"
#include "sim/base/vec.h"
#include "sim/types/math.h"

namespace neve::app::picture {

inline Vec3f to_float(const sim::Vec3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

inline render::shapes::Rotation to_rotation(const sim::Mat3d& matrix) {
  render::shapes::Rotation rotation;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      rotation[static_cast<std::size_t>(3 * row + column)] =
          static_cast<float>(matrix(row, column));
  return rotation;
}

/// Rotation of F_E: its columns made orthogonal one after the other. Snow yields before F_E is far
/// from a rotation, so it differs from that of the polar decomposition by hundredths.
/// @return no turn where F_E has none
inline render::PackedTurn turn_of(const sim::Mat3d& F_E) {
  sim::Mat3d R;
  R.col(0) = F_E.col(0).normalized();
  R.col(1) = (F_E.col(1) - R.col(0) * R.col(0).dot(F_E.col(1))).normalized();
  R.col(2) = R.col(0).cross(R.col(1));
  const Eigen::Quaterniond q(R);
  if (!(std::abs(q.norm() - 1) < 1e-3)) return render::no_turn;
  const auto packed = [](double x) {
    return static_cast<std::int16_t>(std::lround(32767 * std::clamp(x, -1.0, 1.0)));
  };
  return {packed(q.w()), packed(q.x()), packed(q.y()), packed(q.z())};
}

}  // namespace neve::app::picture
