#include "sim/shapes/mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/files/mesh_reader.h"
#include "sim/shapes/held_files.h"
#include "sim/shapes/mesh_edges.h"
#include "sim/shapes/mesh_parts.h"
#include "sim/shapes/mesh_surface.h"
#include "sim/shapes/triangulate.h"
#include "sim/shapes/winding_number.h"
#include "sim/types/number_text.h"

namespace neve::sim::shapes {
namespace {

using Corner = std::uint32_t;

/// m, across a mesh: cells are no smaller.
constexpr double min_extent = 1e-9;
/// Share of a volume, and of its mass, that lines may be wrong by: nobody sees it in a film.
constexpr double max_volume_error = 0.02;

/// @return whether the triangles cover the polygon and nothing else
bool add_triangles(const std::vector<Corner>& corners, SolidMesh& closed) {
  std::vector<Vec3d> polygon;
  for (const Corner corner : corners) polygon.push_back(closed.vertices[corner]);
  if (corners.size() > 3 && !is_convex(polygon))
    if (const auto triangles = cut_ears(polygon)) {
      for (const auto& [i, j, k] : *triangles)
        closed.triangles.push_back({corners[i], corners[j], corners[k]});
      return true;
    }
  // A fan is right for winding numbers and volumes even where sides cross: triangles that overlap
  // are wound in opposite directions and cancel.
  for (std::size_t k = 2; k < corners.size(); ++k)
    closed.triangles.push_back({corners[0], corners[k - 1], corners[k]});
  return corners.size() <= 3 || is_convex(polygon);
}

}  // namespace

/// Source: Eberly, Polyhedral mass properties (revisited), 2002.
void Moments::add_tetrahedron(const Vec3d& a, const Vec3d& b, const Vec3d& c, double times) {
  const Vec3d u = a - from, v = b - from, w = c - from;
  const double part = times * u.dot(v.cross(w)) / 6;
  const Vec3d sum = u + v + w;
  volume += part;
  first += part / 4 * sum;
  second += part / 20 *
            (u * u.transpose() + v * v.transpose() + w * w.transpose() + sum * sum.transpose());
}

void Moments::add_point(const Vec3d& at, double part) {
  const Vec3d arm = at - from;
  volume += part;
  first += part * arm;
  second += part * arm * arm.transpose();
}

void Moments::add_rod(const Vec3d& middle, double length, double area) {
  add_point(middle, length * area);
  second(0, 0) += length * area * length * length / 12;
}

void Moments::add(const Moments& other, double times) {
  volume += times * other.volume;
  first += times * other.first;
  second += times * other.second;
}

void Moments::scale(double factor) {
  const double cube = factor * factor * factor;
  from *= factor;
  volume *= cube;
  first *= cube * factor;
  second *= cube * factor * factor;
}

Bounds bounds_of(const SolidMesh& mesh, const Mat3d& rotation) {
  Bounds b;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) b.add(Vec3d(rotation * mesh.vertices[corner]));
  return b;
}

SolidMesh solid_mesh(const files::PolygonMesh& mesh, const std::string& name, Fill fill) {
  return solid_mesh(mesh, name, fill, coinciding(mesh.vertices));
}

SolidMesh solid_mesh(const files::PolygonMesh& mesh, const std::string& name, Fill fill,
                     std::vector<std::uint32_t> together) {
  MeshEdges edges = find_edges(mesh, name, std::move(together));
  const bool is_open = !edges.defect.empty();
  if (is_open && (fill == Fill::closed || fill == Fill::even_odd))
    throw ShapeError(edges.defect + ", or fill what it nearly encloses: fill = \"winding\"");

  SolidMesh solid;
  solid.vertices = mesh.vertices;
  if (is_open || fill == Fill::winding) solid.inside = Inside::above_half;
  if (fill == Fill::even_odd) solid.inside = Inside::odd;
  std::vector<Corner> corners;
  std::vector<std::uint32_t> part;  // of each triangle
  for (std::size_t p = 0; p < mesh.polygons.size(); ++p) {
    merged_corners(mesh, edges.vertex, p, corners);
    if (edges.is_turned[p]) std::reverse(corners.begin(), corners.end());
    solid.reading.turned_faces += edges.is_turned[p];
    if (!add_triangles(corners, solid) && solid.crossed_face == 0) {
      solid.crossed_face = p + 1;
      solid.crossed_line = mesh.polygons[p].line;
    }
    part.resize(solid.triangles.size(), edges.part[p]);
  }
  if (solid.triangles.empty())
    throw ShapeError(name + ": no face has an area: the corners of each face coincide");
  solid.reading.parts = edges.part_count;
  solid.reading.near_welds = edges.near_welds;
  solid.reading.open_edges = edges.open_edges.size();
  solid.open_edges = std::move(edges.open_edges);

  const Bounds b = bounds_of(solid);
  const double box = std::pow((b.max - b.min).maxCoeff(), 3);
  if (!std::isfinite(box) || !std::isfinite(enclosed_by_faces(solid)))
    throw ShapeError(name + ": the mesh is too large: its volume overflows. Scale it down");
  if (!(box > 0))
    throw ShapeError(name + ": the mesh is too small: its volume is rounded to 0. Scale it up");
  if (solid.inside == Inside::above_half)
    measure_winding(solid, name);
  else
    read_parts(solid, part, edges.part_count);
  if (solid.reading.volume_error > max_volume_error)
    throw ShapeError(
        name + ": its " + std::to_string(solid.reading.parts) +
        " parts lie in and across one another in so many layers that the volume of "
        "them together cannot be measured. Unite them in the program that made the mesh");
  if (!(solid.volume > 1e-14 * box))
    throw ShapeError(is_open
                         ? edges.defect
                         : name + ": the mesh is flat: it encloses no volume. Give it thickness");
  return solid;
}

SolidMesh scaled(SolidMesh mesh, double scale, const std::string& name) {
  if (!(scale > 0) || !std::isfinite(scale))
    throw ShapeError(name + ": the scale of a mesh must be a finite number above 0");
  for (Vec3d& x : mesh.vertices) x *= scale;
  mesh.volume *= scale * scale * scale;
  if (mesh.moments) mesh.moments->scale(scale);
  const Bounds b = bounds_of(mesh);
  const double across = (b.max - b.min).maxCoeff();
  const std::string what = name + ": with scale = " + number_text(scale) + " the mesh is ";
  if (!std::isfinite(mesh.volume) || !std::isfinite(across))
    throw ShapeError(what +
                     "too large: its volume overflows. scale is metres per unit of the file");
  if (!(across >= min_extent && mesh.volume > 0))
    throw ShapeError(what + number_text(across) + " m across; expected at least " +
                     number_text(min_extent) + " m. scale is metres per unit of the file");
  return mesh;
}

std::string reading_key(const Mesh& mesh) {
  return file_stamp(mesh.file) + "|" + number_text(mesh.scale, 17) + "|" +
         std::to_string(static_cast<int>(mesh.fill)) + "|" + number_text(mesh.origin.x(), 17) +
         "|" + number_text(mesh.origin.y(), 17) + "|" + number_text(mesh.origin.z(), 17);
}

std::shared_ptr<const SolidMesh> read_solid_mesh(const Mesh& mesh) {
  static Recent<SolidMesh> recent;
  return recent.get(reading_key(mesh), [&] {
    files::PolygonMesh read = files::read_mesh(mesh.file);
    require_unchanged(mesh.file);
    for (Vec3d& x : read.vertices) x -= mesh.origin;
    return std::make_shared<const SolidMesh>(
        scaled(solid_mesh(read, mesh.file, mesh.fill), mesh.scale, mesh.file));
  });
}

std::shared_ptr<const Form> read_mesh_solid(const Mesh& mesh) {
  static Recent<Form> recent;
  return recent.get(reading_key(mesh), [&] { return make_mesh_solid(*read_solid_mesh(mesh)); });
}

}  // namespace neve::sim::shapes
