#pragma once
/// Colliders as meshes, grounds and lines of the renderer.

#include "app/scene/scene.h"
#include "render/frame/frame.h"

namespace neve::app::picture {

/// Adds the planes and the other colliders that the view's layers ask for, each in its style.
/// @param line_spacing m, of the grid lines of planes
void add_colliders(const scene::Scene& scene, const scene::View& view, double time,
                   float line_spacing, render::Frame& frame);

}  // namespace neve::app::picture
