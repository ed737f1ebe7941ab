#pragma once
/// Files with the coordinates of a map, as UTM: far from the scene's origin single precision ends,
/// so an offset is taken out of them in double precision when they are read.

#include <optional>
#include <vector>

#include "sim/shapes/shape.h"

namespace neve::sim::shapes {

/// True for a mesh, points or terrain with coordinates = "world".
bool is_of_world(const Shape& shape);
/// The same, and nobody has said yet where the scene's origin lies in its file.
bool needs_place(const Shape& shape);

/// Takes one offset out of all files that need a place, so that they keep their places to each
/// other: that of a file that has one, or the middle of the first file in whole units.
/// @throws ShapeError for a file that cannot be read
void place_in_world(const std::vector<Shape*>& shapes);

/// The scene's origin in the world of such files, in metres along the axes of the scene; absent: no
/// file is of a world.
std::optional<Vec3d> world_offset(const std::vector<const Shape*>& shapes);

}  // namespace neve::sim::shapes
