#pragma once
/// A place for cameras that name none.

#include <vector>

#include "app/dry_run.h"
#include "app/scene/scene.h"

namespace neve::app {

/// Frames what a dry run saw from the side and slightly above, and small colliders near it. Round
/// numbers, the same for every frame. A camera that turns has it in the picture all the way round.
/// @param settings all but eye and target is kept
/// @param aspect width / height of the picture
CameraSettings automatic_camera(const Scene& scene, const std::vector<Moment>& moments,
                                const CameraSettings& settings, double aspect);

}  // namespace neve::app
