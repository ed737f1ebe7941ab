#pragma once
/// Triangles of a cell by which of its corners are inside.
///
/// Corner k of a cell lies at (k & 1, k >> 1 & 1, k >> 2 & 1). Edge 4 a + n runs along axis a from
/// the corner that has bit 0 of n along the axis after a, and bit 1 along the one after that.

#include <array>
#include <cstdint>

namespace neve::render::surface {

struct CellCase {
  std::uint8_t triangles = 0;
  std::array<std::uint8_t, 15> edge{};  ///< three a triangle, counter-clockwise from outside
};

constexpr int low_corner(int edge) {
  const int axis = edge / 4;
  return (edge & 1) << (axis + 1) % 3 | (edge >> 1 & 1) << (axis + 2) % 3;
}
constexpr int high_corner(int edge) {
  return low_corner(edge) | 1 << edge / 4;
}

/// Index: bit k is set where corner k is inside.
///
/// Each face is cut by segments that follow from the corners of the face alone; where it is
/// ambiguous, corners inside are kept apart. The segments of neighbours therefore fit. In a cell
/// they join to loops, and each loop is a fan without diagonals in faces, which a neighbour could
/// draw too: so each edge of the mesh belongs to two triangles, and each vertex to one fan.
/// Source: Lorensen, Cline 1987, Marching Cubes; Montani, Scateni, Scopigno 1994, A modified
/// look-up table for implicit disambiguation of Marching Cubes.
/// Check: CellTable.*
const std::array<CellCase, 256>& cell_table();

}  // namespace neve::render::surface
