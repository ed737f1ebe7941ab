#pragma once
/// Colliders as what the renderer draws.

#include "app/scene/scene.h"
#include "render/frame.h"

namespace neve::app {

inline Vec3f to_float(const sim::Vec3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// Adds the planes and the other colliders that the view's layers ask for, each in its style.
/// @param line_spacing m, of the grid lines of planes
void add_colliders(const Scene& scene, const View& view, double time, float line_spacing,
                   render::Frame& frame);

}  // namespace neve::app
