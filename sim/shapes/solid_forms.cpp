#include "sim/shapes/solid_forms.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace neve::sim::shapes {
namespace {

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

}  // namespace

std::unique_ptr<const Form> make_sphere(double radius) {
  return std::make_unique<SphereForm>(radius);
}
std::unique_ptr<const Form> make_box(const Vec3d& size) {
  return std::make_unique<BoxForm>(size);
}
std::unique_ptr<const Form> make_capsule(double length, double radius) {
  return std::make_unique<CapsuleForm>(length, radius);
}
std::unique_ptr<const Form> make_cylinder(double radius, double height) {
  return std::make_unique<CylinderForm>(radius, height);
}
std::unique_ptr<const Form> make_cone(double radius, double height) {
  return std::make_unique<ConeForm>(radius, height);
}
std::unique_ptr<const Form> make_torus(double major_radius, double minor_radius) {
  return std::make_unique<TorusForm>(major_radius, minor_radius);
}

}  // namespace neve::sim::shapes
