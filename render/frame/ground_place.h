#pragma once
/// Lines and fading of a ground, the same for OpenGL and for the CPU.

#include "render/frame/frame.h"
#include "render/frame/view.h"

namespace neve::render {

/// A ground plane relative to the eye, m; see shaders/ground.frag.
struct GroundPlace {
  Vec3f point, normal, tangent, bitangent;
  float eye_on_grid[2];  ///< between two lines, in units of their spacing
  float line_spacing;
  Vec3f fade_center;
  float fade_distance;
  float line_width;  ///< samples
};

GroundPlace place_ground(const GroundPlane& ground, const Frame& frame, const View& view);

/// A solid ground is drawn only where it is seen from above.
bool is_seen_from_above(const GroundPlane& ground, const View& view);

}  // namespace neve::render
