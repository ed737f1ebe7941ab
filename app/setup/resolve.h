#pragma once
/// Fills in the automatic values of a scene, so that the scene alone makes the picture again.

#include <cstddef>
#include <vector>

#include "app/scene/override.h"
#include "app/scene/scene.h"
#include "app/setup/coarse_run.h"
#include "app/setup/plan.h"
#include "app/setup/subject.h"

namespace neve::app::setup {

/// Cameras without a place and ranges that are "auto". They depend on the scene alone.
/// @param particle_count of the whole scene
void resolve(scene::Scene& scene, std::size_t particle_count);

/// Leaves open again what neve found of cameras, ranges and points in a resolved scene, of a run or
/// a picture, if changes are of what it followed from and do not give it.
/// @param changes  that the scene has already
void reopen(scene::Scene& scene, const std::vector<scene::Override>& changes);

/// Leaves open again all cameras of such a scene that neve found.
void reopen_cameras(scene::Scene& scene);

/// Gives all pictures of a scene this size; cameras that neve found for another shape are open
/// again.
void set_size(const scene::PictureSize& size, scene::Scene& scene);

/// True if a camera of the scene has no place yet.
bool needs_framing(const scene::Scene& scene);

/// Places those cameras for the snow of coarse runs, in order of time.
void resolve_cameras(scene::Scene& scene, const std::vector<CoarseMoment>& moments,
                     Shown shown = Shown::fall);
/// Places them for the snow of a coarse run of the scene, which is made only where there are any.
void resolve_cameras(scene::Scene& scene);

void resolve_ranges(scene::Scene& scene, std::size_t particle_count);

}  // namespace neve::app::setup
