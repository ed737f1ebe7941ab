#pragma once
/// A plane through the grid as arrows and a heat map, with its frame and its place in words.

#include "app/picture/snapshot.h"
#include "render/frame/frame.h"

namespace neve::app::picture {

/// Position of the plane at one moment.
struct SlicePlane {
  sim::Vec3d point, normal;  ///< m, unit
  sim::Vec3d across, up;     ///< unit, in the plane
};

/// @param followed centre of mass of the body that the slice follows, if it does
SlicePlane slice_plane(const scene::SliceStyle& slice, double time,
                       const std::optional<sim::Vec3d>& followed);

/// Adds the parts of the slice that the view's layers ask for. Adds nothing where the plane meets
/// no snow.
/// @param pixels_per_metre of the picture at the plane, decides how close arrows may be
void add_slice(const scene::View& view, const FieldSamples& fields, const SlicePlane& plane,
               double pixels_per_metre, render::Frame& frame);

}  // namespace neve::app::picture
