#pragma once
/// Boxes as lines, and marks on single nodes.

#include <vector>

#include "app/picture/node_fields.h"
#include "render/frame/frame.h"
#include "sim/types/math.h"

namespace neve::app::picture {

/// The borders of all blocks that have a node with mass, shared ones once.
render::Lines block_lines(const render::NodeLattice& lattice, const std::vector<float>& density);

/// The view with the ranges of its slice as the fields of this frame have them, where it asks for
/// that.
scene::View with_ranges_of_frame(scene::View view, const FieldSamples& fields);

/// Marks the nodes with the smallest and the largest value of the field that the view shows (heat
/// map, arrows, smoke), with node and value; and in red the nodes whose value is no number, or that
/// cross more than a cell in a step.
/// @param dt  s, the longest step of the frame; 0: none was taken
void mark_extremes(const scene::View& view, const FieldSamples& fields, double dt,
                   render::Frame& frame);

/// The twelve edges of a box, m.
void append_box(const sim::Vec3d& low, const sim::Vec3d& high, render::Lines& lines);

}  // namespace neve::app::picture
