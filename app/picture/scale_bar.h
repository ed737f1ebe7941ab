#pragma once
/// The bar that says how long a length is in the picture.

#include "app/picture/slice.h"

namespace neve::app::picture {

/// Pixels of the finished picture that a metre has at a place, seen from the front.
double pixels_per_metre(const render::Frame& frame, Vec3f place);

/// Adds a round length of about a sixth of the picture: on the plane of a slice, otherwise at the
/// middle of the snow, which its text then says. None if the camera is not in front of that place.
void add_scale_bar(const scene::View& view, const Snapshot& snapshot, const SlicePlane& plane,
                   render::Frame& frame);

}  // namespace neve::app::picture
