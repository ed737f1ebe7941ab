#pragma once
/// Vectors of the simulation as the renderer takes them.

#include "sim/base/vec.h"
#include "sim/types/math.h"

namespace neve::app::picture {

inline Vec3f to_float(const sim::Vec3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace neve::app::picture
