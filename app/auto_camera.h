#pragma once
/// A place for cameras that name none.

#include <vector>

#include "app/dry_run.h"
#include "app/scene/scene.h"

namespace neve::app {

/// Frames what a dry run saw from the side and slightly above, and small colliders near it. Round
/// numbers, the same for every frame.
/// @param settings up and fov are kept, eye and target replaced
/// @param aspect width / height of the picture
CameraSettings automatic_camera(const Scene& scene, const std::vector<Moment>& moments,
                                const CameraSettings& settings, double aspect);

}  // namespace neve::app
