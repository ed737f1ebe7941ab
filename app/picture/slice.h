#pragma once
/// A plane through the grid as arrows, streamlines and a heat map, with its frame and its place in
/// words.

#include "app/picture/snapshot.h"
#include "render/frame/frame.h"

namespace neve::app::picture {

/// Position of the plane at one moment.
struct SlicePlane {
  sim::Vec3d point, normal;  ///< m, unit
  sim::Vec3d across, up;     ///< unit, in the plane
};

/// @param followed  see followed_by()
SlicePlane slice_plane(const scene::SliceStyle& slice, double time,
                       const sim::Vec3d& followed = sim::Vec3d::Zero());

/// The scale of the plane in the picture.
struct SliceSight {
  double pixels_per_metre = 1;  ///< at the plane, along its shorter direction as the camera sees it
  double spacing = 0.01;        ///< m, of packed particles
};

/// Adds the parts of the slice that the view's layers ask for. Adds nothing where the plane meets
/// no snow.
void add_slice(const scene::Scene& scene, const scene::View& view, const Snapshot& snapshot,
               const SlicePlane& plane, const SliceSight& sight, render::Frame& frame);

}  // namespace neve::app::picture
