#pragma once
/// A shape prepared for many queries of its size and of points inside.

#include <memory>

#include "sim/shapes/shape.h"

namespace neve::sim::shapes {

/// The kind of a solid, about the origin and unrotated. One class per shape, in shape.cpp.
class Form {
 public:
  virtual ~Form() = default;
  virtual double volume() const = 0;                             ///< m3
  virtual Bounds bounds_after(const Mat3d& rotation) const = 0;  ///< tight
  virtual bool contains(const Vec3d& y) const = 0;
  /// Returns a bound never further from 0 than the signed distance; 0 says nothing is known.
  virtual double clearance(const Vec3d& y) const = 0;
  virtual Vec3d inner_point() const = 0;
};

/// The local frame has its origin at the shape's centre and the axes of the unrotated shape
/// (capsule: y along a to b), so nothing local depends on the place of the shape. x = center +
/// rotation * local.
class Solid {
 public:
  /// @throws ShapeError when a mesh cannot be read or is open, or the shape has no finite
  ///         volume > 0; std::invalid_argument for a plane
  explicit Solid(const Shape& shape);

  const Vec3d& center() const { return center_; }
  const Mat3d& rotation() const { return rotation_; }
  double volume() const { return form_->volume(); }                               ///< m3
  Bounds local_bounds() const { return form_->bounds_after(Mat3d::Identity()); }  ///< tight
  Bounds bounds() const;  ///< in the world, tight
  /// Bounds of the shape at another centre, with this rotation instead of its own.
  Bounds bounds_at(const Vec3d& center, const Mat3d& rotation) const;

  /// Returns the extent of its projection on a direction that is not zero, m.
  double extent(const Vec3d& direction) const;

  bool contains_local(const Vec3d& y) const { return form_->contains(y); }
  bool contains(const Vec3d& x) const {
    return form_->contains(rotation_.transpose() * (x - center_));
  }

  /// Bound of the signed distance at a local point: the surface is at least |clearance| away, and
  /// the point is inside where it is negative. A mesh says 0: unknown.
  double clearance(const Vec3d& y) const { return form_->clearance(y); }

  /// Returns some local point inside.
  Vec3d inner_point() const { return form_->inner_point(); }

 private:
  Vec3d center_;
  Mat3d axes_;  ///< of the form, before the shape's rotation
  Mat3d rotation_;
  std::shared_ptr<const Form> form_;  ///< copies share it: it never changes
};

}  // namespace neve::sim::shapes
