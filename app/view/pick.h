#pragma once
/// What is under the mouse.

#include <optional>

#include "app/slice.h"
#include "app/view/live_frame.h"
#include "app/view/orbit.h"

namespace neve::app {

/// The index of the nearest drawn particle. @param x, y share of the picture's height from its
/// middle, y up
/// @param clip what is cut away lets look through
std::optional<std::size_t> pick_particle(const Orbit& orbit, double x, double y,
                                         const LiveFrame& live,
                                         const std::optional<ClipPlane>& clip = {});

/// Where the ray meets the plane, before the eye.
std::optional<sim::Vec3d> pick_plane(const Orbit& orbit, double x, double y,
                                     const SlicePlane& plane);

}  // namespace neve::app
