#pragma once
/// Chooses eye and target for automatic cameras.

#include <optional>
#include <vector>

#include "app/scene/scene.h"
#include "app/setup/coarse_run.h"
#include "app/setup/subject.h"

namespace neve::app::setup {

/// Frames the snow of a coarse run from the side and slightly above, and small colliders near it.
/// The numbers are round, and the same for every frame. A camera that turns has it in the picture
/// all the way round. For Shown::moments, the smallest snow takes about a third of the picture's
/// width.
/// @param settings all but eye and target is kept
/// @param aspect width / height of the picture
/// @param normal of a plane that should be seen from its front, a little askew
scene::CameraSettings automatic_camera(const scene::Scene& scene,
                                       const std::vector<CoarseMoment>& moments,
                                       const scene::CameraSettings& settings, double aspect,
                                       const std::optional<sim::Vec3d>& normal = {},
                                       Shown shown = Shown::fall);

}  // namespace neve::app::setup
