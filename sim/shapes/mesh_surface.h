#pragma once
/// A closed mesh ready for distances to its surface.

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "sim/shapes/held_files.h"
#include "sim/shapes/mesh.h"
#include "sim/shapes/mesh_columns.h"

namespace neve::sim::shapes {

class MeshSurface {
 public:
  /// The surface of parts that overlap is the faces between inside and outside alone.
  explicit MeshSurface(SolidMesh mesh);
  ~MeshSurface();

  const SolidMesh& mesh() const { return mesh_; }
  const Bounds& bounds() const { return bounds_; }  ///< tight

  /// Boxes around faces that a place is in, on average: so many faces a search looks at, or more.
  double overlap() const { return overlap_; }

  /// Returns the exact distance, m; at most `most` if given: larger distances are `most`.
  double distance(const Vec3d& y, double most = INFINITY) const;
  /// True for a place that bodies of the mesh fill.
  bool contains(const Vec3d& y) const { return solid_->contains(y); }
  /// The same of places on a line, see MeshLines.
  void inside_along_x(const Vec3d& first, double spacing, std::vector<std::uint8_t>& inside) const;
  double signed_distance(const Vec3d& y) const;
  /// The place of the surface that is nearest to y; of several as near that of the first triangle.
  /// @param most  m, the search is quicker where it is known that something is as near
  struct Place {
    double distance;         ///< m
    std::uint32_t triangle;  ///< of mesh()
    Vec3d point;
  };
  Place nearest_place(const Vec3d& y, double most = INFINITY) const;
  /// Returns the way outward from the nearest place, or on the surface the normal of its triangle.
  Vec3d normal(const Vec3d& y) const;

 private:
  struct Tree;
  struct Nearest;
  Nearest nearest(const Vec3d& y, double most) const;
  /// Returns the triangle of mesh() that a triangle belongs to.
  std::uint32_t origin(std::uint32_t triangle) const {
    return origin_.empty() ? triangle : origin_[triangle];
  }

  SolidMesh mesh_;
  Bounds bounds_;
  double overlap_ = 0;
  std::unique_ptr<const Form> solid_;
  const MeshLines* lines_;             ///< solid_, if its inside is found along lines
  SolidMesh border_;                   ///< where not all faces are between inside and outside
  std::vector<std::uint32_t> origin_;  ///< of the triangles of border_; empty: there is none
  std::unique_ptr<const Tree> tree_;
};

/// The surface of a mesh in metres about the origin of its file. Read and prepared once: later
/// calls return the same one while it is in use or was used lately. A file that was written since
/// is read again. Threads may call at the same time.
/// @throws ShapeError when the file cannot be read, the mesh is open, or a face crosses itself
std::shared_ptr<const MeshSurface> mesh_surface(const Mesh& mesh);

/// @throws ShapeError where a face crosses itself: it has no surface
void require_faces(const SolidMesh& mesh, const std::string& file);

/// The place of a triangle that is nearest to p.
Vec3d nearest_on_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p);

}  // namespace neve::sim::shapes
