#pragma once
/// The layers of a slice, each on its own.

#include "app/picture/field_sampler.h"
#include "app/picture/slice_shape.h"

namespace neve::app::picture {

/// A slice at one moment. The objects that it refers to outlive it.
struct SliceMoment {
  const scene::View& view;
  const FieldSamples& fields;
  const SlicePlane& plane;
  const SliceShape& shape;
  double pixels_per_metre;
  int picture_height;  ///< px

  double cell() const { return static_cast<double>(fields.lattice->spacing); }
};

void add_heat_map(const SliceMoment& slice, render::Frame& frame);

/// The numbers of arrows for the footnote.
struct ArrowScale {
  int every = 1;            ///< nodes from arrow to arrow
  double longest_near = 0;  ///< of those near the point; 0: they are none of their own
};

/// Adds arrows. If the view asks for it, each node near a point has one, in a scale of their own:
/// in that of all others, small motions would be dots.
ArrowScale add_arrows(const SliceMoment& slice, render::Frame& frame);

/// The part of the field in the plane: coloured by its magnitude, or white on a heat map.
void add_streamlines(const SliceMoment& slice, render::Frame& frame);

}  // namespace neve::app::picture
