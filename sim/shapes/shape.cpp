#include "sim/shapes/shape.h"

#include <Eigen/Geometry>
#include <cmath>

#include "sim/shapes/deforming_mesh.h"
#include "sim/shapes/height_field.h"
#include "sim/shapes/mesh.h"
#include "sim/shapes/placed_points.h"
#include "sim/shapes/solid.h"
#include "sim/shapes/solid_forms.h"
#include "sim/types/number_text.h"

namespace neve::sim::shapes {
namespace {

/// Turns y into the direction of the capsule's axis, by the smallest angle; the axis of a ball, as
/// a capsule may be, stays.
Mat3d capsule_axes(const Capsule& capsule) {
  const Vec3d axis = capsule.b - capsule.a;
  if (axis.squaredNorm() == 0) return Mat3d::Identity();
  return Eigen::Quaterniond::FromTwoVectors(Vec3d::UnitY(), axis).toRotationMatrix();
}

struct MakeForm {
  const Vec3d& rotation;  ///< degrees
  using Result = std::shared_ptr<const Form>;
  Result operator()(const Sphere& s) const { return make_sphere(s.radius); }
  Result operator()(const Box& s) const { return make_box(s.size); }
  Result operator()(const Capsule& s) const { return make_capsule((s.b - s.a).norm(), s.radius); }
  Result operator()(const Cylinder& s) const { return make_cylinder(s.radius, s.height); }
  Result operator()(const Cone& s) const { return make_cone(s.radius, s.height); }
  Result operator()(const Torus& s) const { return make_torus(s.major_radius, s.minor_radius); }
  Result operator()(const Plane&) const {
    throw std::invalid_argument("a plane has no volume: it can only be a collider");
  }
  Result operator()(const Mesh& s) const { return read_mesh_solid(s); }
  /// As it is in the first file.
  Result operator()(const MeshSequence& s) const {
    return make_mesh_solid(deforming_mesh(s)->mesh(0, 0));
  }
  Result operator()(const Points& s) const { return make_points_solid(s); }
  Result operator()(const Terrain& s) const { return make_terrain_solid(s); }
  Result operator()(const Cover& s) const { return make_cover_solid(s, rotation.y()); }
};

struct CenterOf {
  template <class S>
  Vec3d operator()(const S& s) const {
    return s.center;
  }
  Vec3d operator()(const Capsule& s) const { return 0.5 * (s.a + s.b); }
  Vec3d operator()(const Plane& s) const { return s.point; }
};

}  // namespace

Solid::Solid(const Shape& shape)
    : center_(shapes::center(shape)),
      axes_(form_axes(shape)),
      rotation_(rotation_from_degrees(shape.rotation) * axes_),
      form_(std::visit(MakeForm{shape.rotation}, shape.form)) {
  const double v = form_->volume();
  if (!(v > 0) || !std::isfinite(v))
    throw ShapeError("the volume of the shape is " + number_text(v) +
                     " m3; expected a finite number above 0");
}

double Solid::extent(const Vec3d& direction) const {
  const Mat3d to_x =
      Eigen::Quaterniond::FromTwoVectors(direction, Vec3d::UnitX()).toRotationMatrix();
  const Bounds b = form_->bounds_after(to_x * rotation_);
  return b.max.x() - b.min.x();
}

Bounds Solid::bounds() const {
  const Bounds b = form_->bounds_after(rotation_);
  return {center_ + b.min, center_ + b.max};
}

Bounds Solid::bounds_at(const Vec3d& center, const Mat3d& rotation) const {
  const Bounds b = form_->bounds_after(rotation * axes_);
  return {center + b.min, center + b.max};
}

Mat3d form_axes(const Shape& shape) {
  const auto* capsule = std::get_if<Capsule>(&shape.form);
  return capsule ? capsule_axes(*capsule) : Mat3d(Mat3d::Identity());
}

bool is_rigid_solid(const Shape& shape) {
  return !std::holds_alternative<Plane>(shape.form) &&
         !std::holds_alternative<Terrain>(shape.form) &&
         !std::holds_alternative<MeshSequence>(shape.form);
}

Vec3d center(const Shape& shape) {
  return std::visit(CenterOf{}, shape.form);
}
double volume(const Shape& shape) {
  return Solid(shape).volume();
}
Bounds bounds(const Shape& shape) {
  return Solid(shape).bounds();
}
bool contains(const Shape& shape, const Vec3d& x) {
  return Solid(shape).contains(x);
}

}  // namespace neve::sim::shapes
