#pragma once
/// The triangles of a mesh that a line along x may meet, and how it meets them.

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "sim/shapes/mesh.h"

namespace neve::sim::shapes {

using Triangle = std::array<std::uint32_t, 3>;

/// Winding number about p of the triangle seen along x: its sides that pass p, summed. It is 1
/// where a line through p along +x leaves the inside.
int winding(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p);

/// Intersection of the line through p along x with the triangle. It never leaves the triangle's own
/// range, so rounding in triangles seen edge-on cannot move it further.
double meeting_x(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p);

/// Triangles by the cells of a grid over y and z that their bounds touch.
class Columns {
 public:
  Columns(const std::vector<Vec3d>& vertices, const std::vector<Triangle>& triangles,
          const Bounds& bounds);

  /// Triangles whose bounds may hold p, as a range of indices.
  std::pair<const std::uint32_t*, const std::uint32_t*> at(const Vec3d& p) const {
    const std::size_t cell = index(cell_of(p.y(), 1), cell_of(p.z(), 2));
    return {entries_.data() + first_[cell], entries_.data() + first_[cell + 1]};
  }

 private:
  struct Range {
    int y0, y1, z0, z1;
  };

  /// The cell is monotone in x: a point between two others is never in a cell outside theirs.
  int cell_of(double x, int axis) const {
    const double cell = (x - origin_[axis]) * per_metre_;
    const int last = cells_[static_cast<std::size_t>(axis - 1)] - 1;
    return cell > 0 ? static_cast<int>(std::min(cell, static_cast<double>(last))) : 0;
  }

  std::size_t index(int y, int z) const {
    return static_cast<std::size_t>(z) * static_cast<std::size_t>(cells_[0]) +
           static_cast<std::size_t>(y);
  }

  Range range_of(const std::vector<Vec3d>& vertices, const Triangle& t) const;
  std::size_t entry_count(const std::vector<Vec3d>& vertices,
                          const std::vector<Triangle>& triangles, std::size_t limit) const;
  void fill(const std::vector<Vec3d>& vertices, const std::vector<Triangle>& triangles);

  Vec3d origin_;
  double per_metre_ = 0;
  std::array<int, 2> cells_{};
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> entries_;
};

/// A solid whose inside is found along lines: a place asks as many triangles as lie behind one
/// another there, and a line along x asks them once.
class MeshLines {
 public:
  virtual ~MeshLines() = default;
  /// Triangles that are asked about p.
  virtual std::size_t count_at(const Vec3d& p) const = 0;
  /// Form::contains() of p, of the place `spacing` further along x, and so on.
  virtual void inside_along_x(Vec3d p, double spacing, std::vector<std::uint8_t>& inside) const = 0;
};

/// Triangles that are asked in all for one mesh, before the answer is taken from what was seen: in
/// meshes of other people all may lie behind one another. Usual meshes ask few for each triangle.
inline std::size_t max_line_tests(std::size_t triangles) {
  constexpr std::size_t least = 400'000'000, usual = 2'500;
  return std::max(least, usual * triangles);
}

}  // namespace neve::sim::shapes
