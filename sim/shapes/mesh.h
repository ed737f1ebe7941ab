#pragma once
/// Closed polyhedra: the conditions for a mesh to be a solid, and its volume.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim/files/obj_reader.h"
#include "sim/shapes/solid.h"

namespace neve::sim::shapes {

/// Triangles that enclose a volume, oriented outward.
struct ClosedMesh {
  std::vector<Vec3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  double volume = 0;  ///< m3, divergence theorem; where parts of the mesh overlap they count twice
  std::size_t crossed_face = 0;  ///< number, from 1, of the first face whose sides cross; 0: none
};

/// Tight bounds of the rotated mesh.
Bounds bounds_of(const ClosedMesh& mesh, const Mat3d& rotation = Mat3d::Identity());

/// Welds vertices at the very same position, checks that every edge lies between exactly two faces
/// that agree about the outside, splits the polygons into triangles, and turns the mesh inside out
/// if its volume is negative. The mesh may intersect itself.
/// @param name of the mesh in messages
/// @throws ShapeError naming the defect, how often, where first (coordinates, face, line) and
///         what to do; also for a volume that is not finite, or 0 within rounding
ClosedMesh close_mesh(const files::PolygonMesh& mesh, const std::string& name);

/// The mesh in metres. @param scale metres per unit of the file
/// @throws ShapeError for a scale that is no number above 0, or makes the mesh larger than numbers
///         can tell or smaller than a nanometre
ClosedMesh scaled(ClosedMesh mesh, double scale, const std::string& name);

/// A mesh from a file as a solid: inside is where the winding number is above 0. Read once:
/// later calls return the same one, unless the file was written since.
/// @throws ShapeError
std::shared_ptr<const Form> read_mesh_solid(const std::string& path, double scale);
std::unique_ptr<const Form> make_mesh_solid(ClosedMesh mesh);

}  // namespace neve::sim::shapes
