#include "sim/rigid/mass.h"

#include <Eigen/Geometry>
#include <numbers>
#include <stdexcept>

#include "sim/shapes/deforming_mesh.h"
#include "sim/shapes/mesh_surface.h"
#include "sim/shapes/solid.h"

namespace neve::sim::rigid {

namespace {

constexpr double pi = std::numbers::pi;

/// Mass properties of a shape at 1 kg/m3.
struct Unit {
  double volume = 0;
  Vec3d centre{0, 0, 0};
  Mat3d inertia = Mat3d::Zero();  ///< about the centre of mass
};

Mat3d diagonal(double x, double y, double z) {
  return Vec3d(x, y, z).asDiagonal();
}

Unit unit(const shapes::Sphere& s) {
  const double volume = 4.0 / 3.0 * pi * s.radius * s.radius * s.radius;
  const double about = 0.4 * volume * s.radius * s.radius;
  return {volume, Vec3d::Zero(), diagonal(about, about, about)};
}

Unit unit(const shapes::Box& s) {
  const Vec3d square = s.size.cwiseAbs2();
  const double volume = s.size.prod(), part = volume / 12;
  return {volume, Vec3d::Zero(),
          diagonal(part * (square.y() + square.z()), part * (square.z() + square.x()),
                   part * (square.x() + square.y()))};
}

Unit unit(const shapes::Cylinder& s) {
  const double square = s.radius * s.radius, volume = pi * square * s.height;
  const double across = volume * (3 * square + s.height * s.height) / 12;
  return {volume, Vec3d::Zero(), diagonal(across, 0.5 * volume * square, across)};
}

/// A cylinder and two half spheres, whose centres of mass are 3/8 of the radius beyond its ends.
Unit unit(const shapes::Capsule& s) {
  const double r = s.radius, square = r * r, length = (s.b - s.a).norm();
  const double wall = pi * square * length, ends = 4.0 / 3.0 * pi * square * r;
  const double along = 0.5 * wall * square + 0.4 * ends * square;
  const double across = wall * (3 * square + length * length) / 12 +
                        ends * (0.4 * square + 0.25 * length * length + 0.375 * length * r);
  return {wall + ends, Vec3d::Zero(), diagonal(across, along, across)};
}

/// The centre of mass of a cone lies a quarter of the height above its base.
Unit unit(const shapes::Cone& s) {
  const double square = s.radius * s.radius, volume = pi * square * s.height / 3;
  const double across = volume * (0.15 * square + 3.0 / 80.0 * s.height * s.height);
  return {volume, Vec3d(0, -0.25 * s.height, 0), diagonal(across, 0.3 * volume * square, across)};
}

Unit unit(const shapes::Torus& s) {
  const double R = s.major_radius * s.major_radius, r = s.minor_radius * s.minor_radius;
  const double volume = 2 * pi * pi * s.major_radius * r;
  const double across = volume * (0.5 * R + 0.625 * r);
  return {volume, Vec3d::Zero(), diagonal(across, volume * (R + 0.75 * r), across)};
}

shapes::Moments moments_of(const shapes::SolidMesh& mesh) {
  if (mesh.moments) return *mesh.moments;
  const std::vector<Vec3d>& vertices = mesh.vertices;
  shapes::Moments moments;
  // Moments are about a vertex, not about the file's origin, which may be far away.
  moments.from = vertices.front();
  for (const auto& t : mesh.triangles)
    moments.add_tetrahedron(vertices[t[0]], vertices[t[1]], vertices[t[2]]);
  return moments;
}

Unit unit(const shapes::Mesh& s) {
  const std::shared_ptr<const shapes::MeshSurface> surface = shapes::mesh_surface(s);
  const shapes::Moments moments = moments_of(surface->mesh());
  const double volume = moments.volume;
  if (!(volume > 0)) throw std::invalid_argument("its mesh has no volume that could have a mass");
  const Vec3d centre = moments.first / volume;
  const Mat3d about = moments.second - volume * centre * centre.transpose();
  const double filled = surface->mesh().moments ? volume : shapes::volume({s, Vec3d::Zero()});
  return {filled, moments.from + centre,
          filled / volume * (about.trace() * Mat3d::Identity() - about)};
}

template <class Form>
Unit unit(const Form&) {
  throw std::invalid_argument(
      "only a sphere, box, capsule, cylinder, cone, torus or mesh can have a mass");
}

}  // namespace

MassProperties mass_properties(const shapes::Shape& shape, double density) {
  const Unit one = std::visit([](const auto& form) { return unit(form); }, shape.form);
  return {density * one.volume, one.centre, density * one.inertia};
}

MassProperties mass_properties(const shapes::Collider& collider) {
  const shapes::RigidBody& body = collider.body;
  MassProperties out = mass_properties(collider.shape, body.density > 0 ? body.density : 1.0);
  if (body.mass > 0) {
    out.inertia *= body.mass / out.mass;
    out.mass = body.mass;
  }
  if (body.inertia.minCoeff() > 0) out.inertia = body.inertia.asDiagonal();
  return out;
}

Vec3d centre_at(const shapes::Collider& collider, double time) {
  const shapes::Shape& shape = collider.shape;
  const shapes::Pose pose = shapes::pose_at(collider, time);
  std::shared_ptr<const shapes::MeshSurface> surface;
  if (const auto* mesh = std::get_if<shapes::Mesh>(&shape.form))
    surface = shapes::mesh_surface(*mesh);
  if (const auto* sequence = std::get_if<shapes::MeshSequence>(&shape.form))
    surface = shapes::surface_at(*sequence, shapes::shape_time(collider, time));
  if (surface) {
    const shapes::Moments moments = moments_of(surface->mesh());
    return moments.volume > 0
               ? Vec3d(pose.point + pose.rotation * (moments.from + moments.first / moments.volume))
               : shapes::bounds_at(collider, time).center();
  }
  if (std::holds_alternative<shapes::Points>(shape.form) ||
      std::holds_alternative<shapes::Cover>(shape.form))
    return shapes::bounds_at(collider, time).center();
  if (!shapes::is_rigid_solid(shape)) return pose.point;
  return pose.point + pose.rotation * shapes::form_axes(shape) * mass_properties(shape, 1).centre;
}

}  // namespace neve::sim::rigid
