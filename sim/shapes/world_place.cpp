#include "sim/shapes/world_place.h"

#include <cmath>

#include "sim/files/mesh_reader.h"
#include "sim/files/point_reader.h"
#include "sim/shapes/solid.h"

namespace neve::sim::shapes {
namespace {

Vec3d middle_of(const std::vector<Vec3d>& points) {
  Vec3d low = points.front(), high = points.front();
  for (const Vec3d& x : points) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  return 0.5 * (low + high);
}

Vec3d middle_of_file(const Shape& shape) {
  if (const auto* mesh = std::get_if<Mesh>(&shape.form)) {
    const std::vector<Vec3d> vertices = files::read_mesh(mesh->file).vertices;
    return vertices.empty() ? Vec3d(0, 0, 0) : middle_of(vertices);
  }
  return middle_of(files::read_points(std::get<Points>(shape.form).file).x);
}

/// Metres of a unit of its file.
double scale_of(const Shape& shape) {
  const auto* mesh = std::get_if<Mesh>(&shape.form);
  return mesh ? mesh->scale : 1;
}

const Vec3d& origin_of(const Shape& shape) {
  const auto* mesh = std::get_if<Mesh>(&shape.form);
  return mesh ? mesh->origin : std::get<Points>(shape.form).origin;
}

void set_origin(Shape& shape, const Vec3d& origin) {
  if (auto* mesh = std::get_if<Mesh>(&shape.form)) mesh->origin = origin;
  if (auto* points = std::get_if<Points>(&shape.form)) points->origin = origin;
}

Vec3d offset_of(const Shape& shape) {
  return rotation_from_degrees(shape.rotation) * (scale_of(shape) * origin_of(shape));
}

}  // namespace

bool is_of_world(const Shape& shape) {
  const auto* mesh = std::get_if<Mesh>(&shape.form);
  const auto* points = std::get_if<Points>(&shape.form);
  return (mesh && mesh->coordinates == Coordinates::world) ||
         (points && points->coordinates == Coordinates::world);
}

bool needs_place(const Shape& shape) {
  return is_of_world(shape) && origin_of(shape).isZero(0);
}

void place_in_world(const std::vector<Shape*>& shapes) {
  std::optional<Vec3d> offset = world_offset({shapes.begin(), shapes.end()});
  for (Shape* shape : shapes) {
    if (!needs_place(*shape)) continue;
    if (!offset) {
      set_origin(*shape, middle_of_file(*shape).array().round());
      offset = offset_of(*shape);
      continue;
    }
    const Mat3d back = rotation_from_degrees(shape->rotation).transpose();
    set_origin(*shape, back * *offset / scale_of(*shape));
  }
}

std::optional<Vec3d> world_offset(const std::vector<const Shape*>& shapes) {
  for (const Shape* shape : shapes)
    if (is_of_world(*shape) && !needs_place(*shape)) return offset_of(*shape);
  return std::nullopt;
}

}  // namespace neve::sim::shapes
