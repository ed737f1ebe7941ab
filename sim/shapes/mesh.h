#pragma once
/// Polyhedra: the conditions for a mesh to be a solid, what is inside it, and its volume.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/files/obj_reader.h"
#include "sim/shapes/solid.h"

namespace neve::sim::shapes {

/// Notes on the reading of a mesh, where that is not plain.
struct MeshReading {
  std::size_t parts = 1;         ///< closed surfaces without a common edge
  std::size_t turned_parts = 0;  ///< wound inward, and read outward
  std::size_t turned_faces = 0;  ///< wound against their neighbours
  std::size_t nested = 0;        ///< parts in another that make no difference: it is filled
  std::size_t cavities = 0;      ///< parts in another that are empty
  double crossed = 0;            ///< share of the volume that parts which cross have in common
  double volume_error = 0;       ///< about, share of the volume: few lines through parts that cross
  double inside_out = 0;         ///< volume wound inward, which is left out, as a share of the rest
  std::size_t near_welds = 0;    ///< vertices that nearly coincided with another
  std::size_t open_edges = 0;
  double in_doubt = 0;  ///< of an open mesh: share of the volume with winding numbers near 1/2
};

/// Rule for the inside of triangles, by the winding number about a place.
enum class Inside { positive, odd, above_half };

/// Volume of a region and its moments about a place: what its mass, centre of mass and inertia
/// follow from. Parts are added; what is added with a negative number is taken away.
struct Moments {
  Vec3d from{0, 0, 0};           ///< m, the place
  double volume = 0;             ///< m3
  Vec3d first{0, 0, 0};          ///< m4
  Mat3d second = Mat3d::Zero();  ///< m5

  /// The tetrahedron between the place and a triangle, negative where the triangle looks at the
  /// place. All faces of a polyhedron together are the polyhedron.
  void add_tetrahedron(const Vec3d& a, const Vec3d& b, const Vec3d& c, double times = 1);
  void add_point(const Vec3d& at, double part);
  /// Adds a rod along x, of a thin cross section. @param middle  of it
  void add_rod(const Vec3d& middle, double length, double area);
  /// @param other  about the same place
  void add(const Moments& other, double times);
  /// Converts the moments to another unit of length.
  void scale(double factor);
};

/// Triangles that enclose a volume, oriented outward.
struct SolidMesh {
  std::vector<Vec3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  double volume = 0;             ///< m3, of what is inside
  std::size_t crossed_face = 0;  ///< number, from 1, of the first face whose sides cross; 0: none
  std::size_t crossed_line = 0;  ///< of the file; 0: it has no lines
  Inside inside = Inside::positive;
  MeshReading reading{};
  std::vector<std::array<std::uint32_t, 2>> open_edges{};
  /// Moments of the inside where the faces together are something else: parts in one another may
  /// count twice or with the wrong sign, and an open mesh has no sum.
  std::optional<Moments> moments{};
};

/// Tight bounds of the rotated mesh.
Bounds bounds_of(const SolidMesh& mesh, const Mat3d& rotation = Mat3d::Identity());

/// Finds the edges (mesh_edges.h), splits the polygons into triangles, and turns each closed part
/// outward (mesh_parts.h). The mesh may intersect itself.
/// @param name of the mesh in messages
/// @throws ShapeError for an open mesh that is to be closed, naming the defect, how often, where
///         first (coordinates, face, line) and what to do; also for a volume that is not finite, or
///         0 within rounding
SolidMesh solid_mesh(const files::PolygonMesh& mesh, const std::string& name,
                     Fill fill = Fill::automatic);
/// @param together  for each vertex the first of those that it may be one with: see mesh_edges.h
SolidMesh solid_mesh(const files::PolygonMesh& mesh, const std::string& name, Fill fill,
                     std::vector<std::uint32_t> together);

/// The mesh in metres. @param scale metres per unit of the file
/// @throws ShapeError for a scale that is no number above 0, or makes the mesh larger than numbers
///         can tell or smaller than a nanometre
SolidMesh scaled(SolidMesh mesh, double scale, const std::string& name);

/// Tells one reading of a file from another: its stamp, scale and fill.
std::string reading_key(const Mesh& mesh);

/// A mesh from a file, in metres. Read once, as what follows.
/// @throws ShapeError
std::shared_ptr<const SolidMesh> read_solid_mesh(const Mesh& mesh);

/// A mesh from a file as a solid. Read once: later calls return the same one, unless the file was
/// written since.
/// @throws ShapeError
std::shared_ptr<const Form> read_mesh_solid(const Mesh& mesh);
std::unique_ptr<const Form> make_mesh_solid(SolidMesh mesh);

}  // namespace neve::sim::shapes
