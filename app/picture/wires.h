#pragma once
/// Boxes as lines.

#include <vector>

#include "render/frame/frame.h"
#include "sim/types/math.h"

namespace neve::app::picture {

/// The borders of all blocks that have a node with mass, shared ones once.
render::Lines block_lines(const render::NodeLattice& lattice, const std::vector<float>& density);

/// The twelve edges of a box, m.
void append_box(const sim::Vec3d& low, const sim::Vec3d& high, render::Lines& lines);

}  // namespace neve::app::picture
