#pragma once
/// Picks the object under the mouse.

#include <optional>

#include "app/picture/slice.h"
#include "app/view/panels/orbit.h"
#include "app/view/session/live_frame.h"

namespace neve::app::view::panels {

/// The index of the nearest drawn particle. @param x, y share of the picture's height from its
/// middle, y up
/// @param clip particles that it cuts away are ignored
std::optional<std::size_t> pick_particle(const Orbit& orbit, double x, double y,
                                         const session::LiveFrame& live,
                                         const std::optional<scene::ClipPlane>& clip = {});

/// The nearest place on snow or on a collider.
std::optional<sim::Vec3d> pick_surface(const Orbit& orbit, double x, double y,
                                       const session::LiveFrame& live);

/// Intersection of the ray with the plane, in front of the eye.
std::optional<sim::Vec3d> pick_plane(const Orbit& orbit, double x, double y,
                                     const picture::SlicePlane& plane);

}  // namespace neve::app::view::panels
