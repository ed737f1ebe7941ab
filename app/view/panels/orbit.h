#pragma once
/// The camera of a viewport, moved as 3D programs do.

#include "app/scene/scene.h"

namespace neve::app::view::panels {

class Orbit {
 public:
  Orbit() = default;
  /// Begins with the place and the upright of the present picture, until it is turned.
  Orbit(const sim::Vec3d& eye, const sim::Vec3d& target, const sim::Vec3d& up, double fov);

  sim::Vec3d eye() const;
  const sim::Vec3d& target() const { return target_; }
  double fov() const { return fov_; }
  double distance() const { return distance_; }
  scene::CameraSettings settings() const;

  /// Turns about the target; the horizon is level then. @param dx, dy share of the picture's height
  void turn(double dx, double dy);
  /// Moves so that what is at the target follows the mouse. @param dx, dy as above
  void pan(double dx, double dy);
  /// Comes nearer by so many notches, towards the point under the mouse.
  /// @param x, y of the mouse, share of the picture's height from its middle, y up
  void zoom(double notches, double x, double y);
  /// The box fills the picture, seen from where it is seen now.
  void frame(const sim::shapes::Bounds& box, double aspect);
  /// Looks along an axis: 0 x, 1 y, 2 z; from the other side the second time.
  void look_along(int axis);
  void move_target(const sim::Vec3d& target) { target_ = target; }

  sim::Vec3d right() const;
  sim::Vec3d up() const;
  sim::Vec3d forward() const;

  /// Projection of a place into the picture: share of its height from the middle, y up, and the
  /// distance along the view. A distance that is not positive is behind the eye.
  sim::Vec3d project(const sim::Vec3d& place) const;
  /// Direction from the eye through a point of the picture, unit.
  sim::Vec3d ray(double x, double y) const;

  bool operator==(const Orbit&) const = default;

 private:
  sim::Vec3d level_right() const;

  sim::Vec3d target_{0, 0, 0};
  double yaw_ = 0.6, pitch_ = 0.3;  ///< radians: of the eye about y from +z, and above the horizon
  double roll_ = 0;      ///< radians, of the picture about its middle; 0: the horizon is level
  double distance_ = 3;  ///< m
  double fov_ = 30;      ///< vertical, degrees
};

}  // namespace neve::app::view::panels
