#include "sim/shapes/world_place.h"

#include "sim/files/mesh_reader.h"
#include "sim/files/point_reader.h"
#include "sim/shapes/height_field.h"
#include "sim/shapes/solid.h"

namespace neve::sim::shapes {
namespace {

Vec3d middle_of(const std::vector<Vec3d>& points) {
  Bounds box;
  for (const Vec3d& x : points) box.add(x);
  return box.center();
}

/// Returns the middle of a file in the coordinates of the file.
Vec3d middle_of_file(const Shape& shape) {
  if (const auto* mesh = std::get_if<Mesh>(&shape.form)) {
    const std::vector<Vec3d> vertices = files::read_mesh(mesh->file).vertices;
    return vertices.empty() ? Vec3d(0, 0, 0) : middle_of(vertices);
  }
  if (const auto* terrain = std::get_if<Terrain>(&shape.form)) return middle_of(*terrain);
  return middle_of(files::read_points(std::get<Points>(shape.form).file).x);
}

/// Metres of a unit of its file.
double scale_of(const Shape& shape) {
  const auto* mesh = std::get_if<Mesh>(&shape.form);
  return mesh ? mesh->scale : 1;
}

/// Coordinates of a map, east, north and up, in the axes of a terrain; and back.
Vec3d terrain_axes(const Vec3d& map) {
  return {map.x(), map.z(), -map.y()};
}
Vec3d map_axes(const Vec3d& x) {
  return {x.x(), -x.z(), x.y()};
}

const Vec3d& origin_of(const Shape& shape) {
  if (const auto* mesh = std::get_if<Mesh>(&shape.form)) return mesh->origin;
  if (const auto* terrain = std::get_if<Terrain>(&shape.form)) return terrain->origin;
  return std::get<Points>(shape.form).origin;
}

/// @param place  of the scene's origin in the file, in metres along the axes of the shape
void set_place(Shape& shape, const Vec3d& place) {
  if (auto* mesh = std::get_if<Mesh>(&shape.form)) mesh->origin = place / mesh->scale;
  if (auto* points = std::get_if<Points>(&shape.form)) points->origin = place;
  if (auto* terrain = std::get_if<Terrain>(&shape.form)) terrain->origin = map_axes(place);
}

/// Moves the origin of a shape to the middle of its file, in whole units.
void set_middle(Shape& shape) {
  const Vec3d middle = middle_of_file(shape).array().round();
  if (auto* mesh = std::get_if<Mesh>(&shape.form)) mesh->origin = middle;
  if (auto* points = std::get_if<Points>(&shape.form)) points->origin = middle;
  if (auto* terrain = std::get_if<Terrain>(&shape.form)) terrain->origin = middle;
}

Vec3d offset_of(const Shape& shape) {
  const bool is_terrain = std::holds_alternative<Terrain>(shape.form);
  const Vec3d place =
      is_terrain ? terrain_axes(origin_of(shape)) : Vec3d(scale_of(shape) * origin_of(shape));
  return rotation_from_degrees(shape.rotation) * place;
}

}  // namespace

bool is_of_world(const Shape& shape) {
  const auto* mesh = std::get_if<Mesh>(&shape.form);
  const auto* points = std::get_if<Points>(&shape.form);
  const auto* terrain = std::get_if<Terrain>(&shape.form);
  return (mesh && mesh->coordinates == Coordinates::world) ||
         (points && points->coordinates == Coordinates::world) ||
         (terrain && terrain->coordinates == Coordinates::world);
}

bool needs_place(const Shape& shape) {
  return is_of_world(shape) && origin_of(shape).isZero(0);
}

void place_in_world(const std::vector<Shape*>& shapes) {
  std::optional<Vec3d> offset = world_offset({shapes.begin(), shapes.end()});
  for (Shape* shape : shapes) {
    if (!needs_place(*shape)) continue;
    if (!offset) {
      set_middle(*shape);
      offset = offset_of(*shape);
      continue;
    }
    const Mat3d back = rotation_from_degrees(shape->rotation).transpose();
    set_place(*shape, back * *offset);
  }
}

std::optional<Vec3d> world_offset(const std::vector<const Shape*>& shapes) {
  for (const Shape* shape : shapes)
    if (is_of_world(*shape) && !needs_place(*shape)) return offset_of(*shape);
  return std::nullopt;
}

}  // namespace neve::sim::shapes
