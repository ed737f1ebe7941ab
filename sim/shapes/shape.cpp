#include "sim/shapes/shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "sim/shapes/deforming_mesh.h"
#include "sim/shapes/height_field.h"
#include "sim/shapes/mesh.h"
#include "sim/shapes/placed_points.h"
#include "sim/shapes/solid.h"
#include "sim/types/number_text.h"

namespace neve::sim::shapes {
namespace {

// ---- the analytic solids, about the origin, axis y ----------------------------------------------

using std::numbers::pi;

/// Half extents along the world's axes of a disc of radius 1 whose axis, y, was rotated.
Vec3d disc_extent(const Mat3d& rotation) {
  const Vec3d axis = rotation.col(1);
  return (1.0 - axis.array().square()).max(0.0).sqrt();
}

Bounds centred(const Vec3d& half) {
  return {-half, half};
}

/// Distance to the axis y.
double radial(const Vec3d& y) {
  return std::hypot(y.x(), y.z());
}

/// A form whose inside test is the sign of a distance.
class Analytic : public Form {
 public:
  bool contains(const Vec3d& y) const final { return clearance(y) <= 0; }
  Vec3d inner_point() const override { return Vec3d::Zero(); }
};

class SphereForm final : public Analytic {
 public:
  explicit SphereForm(double radius) : radius_(radius) {}
  double volume() const override { return 4.0 / 3.0 * pi * radius_ * radius_ * radius_; }
  double clearance(const Vec3d& y) const override { return y.norm() - radius_; }
  Bounds bounds_after(const Mat3d&) const override { return centred(Vec3d::Constant(radius_)); }

 private:
  double radius_;
};

class BoxForm final : public Analytic {
 public:
  explicit BoxForm(const Vec3d& size) : half_(0.5 * size) {}
  double volume() const override { return 8 * half_.prod(); }
  double clearance(const Vec3d& y) const override { return (y.cwiseAbs() - half_).maxCoeff(); }
  Bounds bounds_after(const Mat3d& rotation) const override {
    return centred(rotation.cwiseAbs() * half_);
  }

 private:
  Vec3d half_;
};

class CapsuleForm final : public Analytic {
 public:
  CapsuleForm(double length, double radius) : half_length_(0.5 * length), radius_(radius) {}
  double volume() const override {
    return pi * radius_ * radius_ * (2 * half_length_ + 4.0 / 3.0 * radius_);
  }
  double clearance(const Vec3d& y) const override {
    const double beyond = std::max(std::abs(y.y()) - half_length_, 0.0);
    return std::sqrt(y.x() * y.x() + beyond * beyond + y.z() * y.z()) - radius_;
  }
  Bounds bounds_after(const Mat3d& rotation) const override {
    return centred(rotation.col(1).cwiseAbs() * half_length_ + Vec3d::Constant(radius_));
  }

 private:
  double half_length_, radius_;
};

class CylinderForm final : public Analytic {
 public:
  CylinderForm(double radius, double height) : radius_(radius), half_height_(0.5 * height) {}
  double volume() const override { return pi * radius_ * radius_ * 2 * half_height_; }
  double clearance(const Vec3d& y) const override {
    return std::max(radial(y) - radius_, std::abs(y.y()) - half_height_);
  }
  Bounds bounds_after(const Mat3d& rotation) const override {
    return centred(rotation.col(1).cwiseAbs() * half_height_ + radius_ * disc_extent(rotation));
  }

 private:
  double radius_, half_height_;
};

/// A cone with the apex up.
class ConeForm final : public Analytic {
 public:
  ConeForm(double radius, double height) : radius_(radius), half_height_(0.5 * height) {}
  double volume() const override { return pi * radius_ * radius_ * 2 * half_height_ / 3; }
  double clearance(const Vec3d& y) const override {
    // The wall falls from the apex by the height over the radius; its normal is (height, radius).
    const double height = 2 * half_height_, slant = std::hypot(height, radius_);
    const double wall = (height * radial(y) + radius_ * (y.y() - half_height_)) / slant;
    return std::max(wall, -half_height_ - y.y());
  }
  Bounds bounds_after(const Mat3d& rotation) const override {
    const Vec3d apex = half_height_ * rotation.col(1), rim = radius_ * disc_extent(rotation);
    return {apex.cwiseMin(-apex - rim), apex.cwiseMax(-apex + rim)};
  }

 private:
  double radius_, half_height_;
};

class TorusForm final : public Analytic {
 public:
  TorusForm(double major_radius, double minor_radius)
      : major_(major_radius), minor_(minor_radius) {}
  double volume() const override {
    const double R = major_, r = minor_;
    if (R >= r) return 2 * pi * pi * R * r * r;
    // A spindle: the tube meets itself on the axis and the overlap counts once. Pappus over the
    // part of the tube's disc on one side of the axis.
    const double cut = std::sqrt(r * r - R * R);
    const double area = 0.5 * (0.5 * pi * r * r + R * cut + r * r * std::asin(R / r));
    return 4 * pi * (R * area + cut * cut * cut / 3);
  }
  double clearance(const Vec3d& y) const override {
    return std::hypot(radial(y) - major_, y.y()) - minor_;
  }
  Bounds bounds_after(const Mat3d& rotation) const override {
    return centred(major_ * disc_extent(rotation) + Vec3d::Constant(minor_));
  }
  Vec3d inner_point() const override { return {major_, 0, 0}; }

 private:
  double major_, minor_;
};

// ---- shapes -------------------------------------------------------------------------------------

/// The rotation by the smallest angle that turns the direction of FROM into that of TO. Eigen's
/// Quaternion::FromTwoVectors gives the same, and takes seconds to compile: for opposite
/// directions, where any axis across them will do, it decomposes a matrix.
Mat3d turn_between(const Vec3d& from, const Vec3d& to) {
  const Vec3d a = from.normalized(), b = to.normalized();
  const double cosine = b.dot(a);
  if (cosine < -1 + 1e-12) {
    const Vec3d across = Vec3d::UnitZ() - a.z() * a;
    const Vec3d axis = across.squaredNorm() > 1e-6 ? across.normalized() : Vec3d(-1, 0, 0);
    return 2 * axis * axis.transpose() - Mat3d::Identity();
  }
  const double s = std::sqrt(2 * (1 + cosine)), inverse = 1 / s;
  const Vec3d axis = a.cross(b) * inverse;
  return Eigen::Quaterniond(s / 2, axis.x(), axis.y(), axis.z()).toRotationMatrix();
}

/// Turns y into the direction of the capsule's axis, by the smallest angle; the axis of a ball, as
/// a capsule may be, stays.
Mat3d capsule_axes(const Capsule& capsule) {
  const Vec3d axis = capsule.b - capsule.a;
  if (axis.squaredNorm() == 0) return Mat3d::Identity();
  return turn_between(Vec3d::UnitY(), axis);
}

struct MakeForm {
  const Vec3d& rotation;  ///< degrees
  using Result = std::shared_ptr<const Form>;
  Result operator()(const Sphere& s) const { return std::make_unique<SphereForm>(s.radius); }
  Result operator()(const Box& s) const { return std::make_unique<BoxForm>(s.size); }
  Result operator()(const Capsule& s) const {
    return std::make_unique<CapsuleForm>((s.b - s.a).norm(), s.radius);
  }
  Result operator()(const Cylinder& s) const {
    return std::make_unique<CylinderForm>(s.radius, s.height);
  }
  Result operator()(const Cone& s) const { return std::make_unique<ConeForm>(s.radius, s.height); }
  Result operator()(const Torus& s) const {
    return std::make_unique<TorusForm>(s.major_radius, s.minor_radius);
  }
  Result operator()(const Plane&) const {
    throw std::invalid_argument("a plane has no volume: it can only be a collider");
  }
  Result operator()(const Mesh& s) const { return read_mesh_solid(s); }
  /// Takes the mesh as it is in the first file.
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
  const Mat3d to_x = turn_between(direction, Vec3d::UnitX());
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
