#pragma once
/// Fills in what a scene leaves to the program, so that the scene alone makes the picture again.

#include "app/dry_run.h"
#include "app/plan.h"
#include "app/scene/scene.h"

namespace neve::app {

/// Cameras without a place and ranges that are "auto". They depend on the scene alone.
/// @param particle_count of the whole scene
void resolve(Scene& scene, std::size_t particle_count);

/// Whether a camera of the scene has no place yet.
bool needs_framing(const Scene& scene);

/// Places those cameras for what dry runs saw, in order of time.
void resolve_cameras(Scene& scene, const std::vector<Moment>& moments);

void resolve_ranges(Scene& scene, std::size_t particle_count);

}  // namespace neve::app
