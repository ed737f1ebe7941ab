#pragma once
/// Vertices and polygons of a mesh, and their reader from Wavefront OBJ files.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sim/types/math.h"

namespace neve::sim::files {

/// Polygons over shared vertices, in file order.
struct PolygonMesh {
  /// Corners first to first of the next polygon; line in the file, from 1; 0: the file has no
  /// lines.
  struct Polygon {
    std::size_t first;
    std::size_t line;
  };
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> corners;  ///< indices of vertices, valid
  std::vector<Polygon> polygons;       ///< 3 corners or more each

  std::size_t corner_end(std::size_t polygon) const {
    return polygon + 1 < polygons.size() ? polygons[polygon + 1].first : corners.size();
  }
};

/// Reads `v` and `f` (index forms v, v/vt, v//vn, v/vt/vn, negative ones count back from the last
/// vertex), lines continued by a backslash; everything else is ignored. A file that neve wrote with
/// z up or in other units is turned and scaled back. Independent of the locale.
/// @param name of the text in messages: name:line: ...
/// @throws ShapeError for malformed numbers, bad indices, polygons of less than three corners and
///         files without any
PolygonMesh parse_obj(std::string_view text, const std::string& name);

}  // namespace neve::sim::files
