#pragma once
/// Vectors and rotations of the simulation as the renderer takes them.

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

}  // namespace neve::app::picture
