#pragma once
/// Colliders, and meshes that are open, as meshes, grounds and lines of the renderer.

#include <optional>

#include "app/scene/scene.h"
#include "render/frame/frame.h"

namespace neve::app::picture {

/// Adds the planes and the other colliders that the view's layers ask for, each in its style.
/// @param line_spacing m, of the grid lines of planes
void add_colliders(const scene::Scene& scene, const scene::View& view, double time,
                   float line_spacing, render::Frame& frame);

/// The layer of a view that draws a collider: the ground for planes and terrain.
scene::Layer layer_of(const scene::Collider& collider);

/// True if a collider of this style hides what is behind it: it is among the meshes and grounds of
/// a frame, and else among its ghosts and lines.
bool hides(scene::ColliderStyle style);

/// A collider that is no plane and keeps its shape, as triangles about its own point:
/// pose_at(...).point is where it goes, and pose_at(...).rotation turns it.
render::TriangleMesh local_mesh(const sim::shapes::Shape& shape);

/// Draws all open meshes of bodies, emitters, sinks and colliders, see-through, with their open
/// edges in red, framed by the camera. Returns nothing if every mesh is closed.
std::optional<render::Frame> open_edges_frame(const scene::Scene& scene);

}  // namespace neve::app::picture
