#pragma once
/// The layers of a slice, each on its own.

#include "app/picture/field_sampler.h"
#include "app/picture/slice_shape.h"

namespace neve::app::picture {

/// A slice at one moment. What it refers to outlives it.
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

/// What the footnote says of arrows.
struct ArrowScale {
  int every = 1;            ///< nodes from arrow to arrow
  double longest_near = 0;  ///< of those near the point; 0: they are none of their own
};

/// Where the view asks for it, nodes near a point have an arrow each, in a scale of their own:
/// where little moves, they would be dots.
ArrowScale add_arrows(const SliceMoment& slice, render::Frame& frame);

/// The part of the field in the plane: coloured by its magnitude, or white on a heat map.
void add_streamlines(const SliceMoment& slice, render::Frame& frame);

}  // namespace neve::app::picture
