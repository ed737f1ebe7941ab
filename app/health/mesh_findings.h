#pragma once
/// Findings about meshes that are not plain closed surfaces.

#include <vector>

#include "app/health/finding.h"
#include "app/scene/scene.h"

namespace neve::app::health {

/// Parts that cross, nest or are turned, open edges, vertices that were welded: how the meshes of
/// bodies, emitters, sinks and colliders were read.
void check_meshes(const scene::Scene& scene, std::vector<Finding>& findings);

/// Notes of what terrain has, and of depth and mass of the snow on it.
void note_terrain(const scene::Scene& scene, std::vector<Finding>& findings);

}  // namespace neve::app::health
