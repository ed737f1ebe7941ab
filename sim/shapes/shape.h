#pragma once
/// Shapes that bodies fill and colliders keep clear.

#include <string>
#include <variant>
#include <vector>

#include "sim/types/errors.h"
#include "sim/types/math.h"

namespace neve::sim::shapes {

struct Sphere {
  Vec3d center{0, 0, 0};
  double radius = 0.1;
};
struct Box {
  Vec3d center{0, 0, 0};
  Vec3d size{0.2, 0.2, 0.2};
};
struct Capsule {
  Vec3d a{0, 0, 0}, b{0, 0.2, 0};
  double radius = 0.1;
};
/// Axis y, center in the middle of the axis; so are cone (apex up) and torus.
struct Cylinder {
  Vec3d center{0, 0, 0};
  double radius = 0.1, height = 0.2;
};
struct Cone {
  Vec3d center{0, 0, 0};
  double radius = 0.1, height = 0.2;
};
struct Torus {
  Vec3d center{0, 0, 0};
  double major_radius = 0.15, minor_radius = 0.05;
};
/// Solid where (x - point) . normal <= 0.
struct Plane {
  Vec3d point{0, 0, 0};
  Vec3d normal{0, 1, 0};
};
/// Rule for the inside of a mesh.
enum class Fill {
  automatic,  ///< closed where the mesh is closed, else winding
  closed,     ///< what closed parts enclose together; a part wound inward in another is a cavity
  even_odd,   ///< the same, but parts in one another are snow and cavity in turns
  winding     ///< where the generalized winding number is above 1/2: for open meshes
};
/// Coordinates of a file: of its own, or of a map as UTM, see world_place.h.
enum class Coordinates { own, world };
/// A mesh in a file, scaled about the file's origin, which goes to center.
struct Mesh {
  std::string file;  ///< resolved path
  double scale = 1.0;
  Vec3d center{0, 0, 0};
  Fill fill = Fill::automatic;
  Coordinates coordinates = Coordinates::own;
  Vec3d origin{0, 0, 0};  ///< coordinates in the file that are taken for its origin
};
/// A closed mesh that deforms: numbered files of one topology, see sim/shapes/deforming_mesh.h.
struct MeshSequence {
  std::string files;  ///< resolved path with %d or %04d in place of the number
  int first = 1, last = 2;
  double rate = 24;  ///< files per second
  double start = 0;  ///< s, of the first file
  double scale = 1.0;
  Vec3d center{0, 0, 0};
};
/// Particles in a PLY or CSV file, see sim/files/point_reader.h.
struct Points {
  std::string file;       ///< resolved path
  double spacing = 0;     ///< m; of a file without volumes each point has spacing^3; 0: not given
  double thinning = 1;    ///< one point of this many is used, and represents all of them
  Vec3d center{0, 0, 0};  ///< where the origin of the file goes
  Coordinates coordinates = Coordinates::own;
  Vec3d origin{0, 0, 0};  ///< coordinates in the file that are taken for its origin
};

/// The ground below a height field from a file, see sim/shapes/height_field.h. East on the map is
/// x, north is -z, up is y.
struct Terrain {
  std::string file;          ///< resolved path
  double spacing = 0;        ///< m, from post to post, of a picture; 0: not given
  double low = 0, high = 0;  ///< m, heights of black and white of a picture
  Vec3d center{0, 0, 0};     ///< where the origin of the file goes
  Coordinates coordinates = Coordinates::own;
  Vec3d origin{0, 0, 0};  ///< east, north and up in the file that are taken for its origin
};
/// Snow on a terrain or a mesh, between its surface, the highest where there are several, and a
/// depth straight above it, within a rectangle or, with a radius, a disc. Rotation is about y
/// alone.
struct Cover {
  std::string on;                ///< name of a collider
  double depth = 0.1;            ///< m, vertical
  double width = 0, length = 0;  ///< m, along x and z
  double radius = 0;             ///< m
  Vec3d center{0, 0, 0};         ///< middle of the outline; y: how far above the ground it lies
  std::variant<Terrain, Mesh> ground{};  ///< of that collider
  Vec3d turned{0, 0, 0};                 ///< degrees, of that collider
};

struct Shape {
  std::variant<Sphere, Box, Capsule, Cylinder, Cone, Torus, Plane, Mesh, MeshSequence, Points,
               Terrain, Cover>
      form;
  Vec3d rotation{0, 0, 0};  ///< degrees, R = Rz Ry Rx, about the shape's centre
};

/// A box along the axes, in metres; empty until something is added.
struct Bounds {
  Vec3d min = Vec3d::Constant(1e300), max = Vec3d::Constant(-1e300);

  void add(const Bounds& other) {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
  }
  void add(const Vec3d& x) { add(Bounds{x, x}); }
  Vec3d center() const { return 0.5 * (min + max); }
  double diagonal() const { return (max - min).norm(); }
};

/// Centre of rotation and angular velocity: the middle of a capsule, the point of a plane, the
/// place of the file's origin for meshes, points or terrain.
Vec3d center(const Shape& shape);

/// True for solids that keep their form: neither endless, as planes and terrain, nor deforming.
bool is_rigid_solid(const Shape& shape);

/// Paths of all files of a sequence. @throws ShapeError for a path that is no pattern, or too many
std::vector<std::string> files_of(const MeshSequence& sequence);

/// Axes that the form of a shape is described in, before its rotation: of a capsule y points from a
/// to b, of all others they are those of the world.
Mat3d form_axes(const Shape& shape);

/// Measures of solid shapes only. Each call prepares the shape, which reads the file of a mesh or
/// of points; class Solid (sim/shapes/solid.h) prepares it once for many questions.
/// @throws ShapeError when a mesh cannot be read or is open, or the shape has no finite volume > 0;
///         std::invalid_argument for a plane
double volume(const Shape& shape);  ///< m3, exact for analytic shapes, of the polyhedron for meshes
Bounds bounds(const Shape& shape);  ///< tight
bool contains(const Shape& shape, const Vec3d& x);

}  // namespace neve::sim::shapes
