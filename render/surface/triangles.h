#pragma once
/// A closed mesh around the nodes that are inside.

#include "render/frame/frame.h"
#include "render/surface/pieces.h"

namespace neve::render::surface {

/// Marching cubes: a vertex on each edge of the lattice between inside and outside, where the field
/// falls to surface_share, but not at the ends; normals point along the field's fall. Triangles are
/// counter-clockwise from outside, each stays in its cell, and those of one cell do not cross: so
/// the mesh is closed, two triangles share each edge, and it does not cut itself.
/// @param inside of the field's nodes; all blocks beside a node that is inside must be there
/// Check: Surface.IsClosed..., CellTable.*
TriangleMesh triangles_of(const Field& field, const std::vector<InsideBits>& inside,
                          ThreadPool* pool);

}  // namespace neve::render::surface
