#pragma once
/// Fills in what a scene leaves to the program, so that the scene alone makes the picture again.

#include "app/plan.h"
#include "app/scene/scene.h"

namespace neve::app {

/// Cameras without a place and ranges that are "auto". They depend on the scene alone.
/// @param particle_count of the whole scene
void resolve(Scene& scene, std::size_t particle_count);

}  // namespace neve::app
