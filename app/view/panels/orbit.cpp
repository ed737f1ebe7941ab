#include "app/view/panels/orbit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace neve::app::view::panels {

namespace {

using sim::Vec3d;

constexpr double pi = 3.14159265358979323846;
constexpr double steepest = 0.5 * pi - 1e-3;
constexpr double radians_per_height = 1.2 * pi;
constexpr double zoom_of_notch = 0.88;

}  // namespace

Orbit::Orbit(const Vec3d& eye, const Vec3d& target, const Vec3d& up, double fov)
    : target_(target), fov_(fov) {
  const Vec3d offset = eye - target;
  distance_ = std::max(1e-6, offset.norm());
  pitch_ =
      std::clamp(std::asin(std::clamp(offset.y() / distance_, -1.0, 1.0)), -steepest, steepest);
  yaw_ = std::atan2(offset.x(), offset.z());
  roll_ = std::atan2(up.dot(level_right()), up.dot(level_right().cross(forward())));
}

Vec3d Orbit::forward() const {
  return -Vec3d(std::sin(yaw_) * std::cos(pitch_), std::sin(pitch_),
                std::cos(yaw_) * std::cos(pitch_));
}

Vec3d Orbit::level_right() const {
  return Vec3d(std::cos(yaw_), 0, -std::sin(yaw_));
}

Vec3d Orbit::right() const {
  const Vec3d level = level_right();
  return std::cos(roll_) * level - std::sin(roll_) * level.cross(forward());
}

Vec3d Orbit::up() const {
  return right().cross(forward());
}

Vec3d Orbit::eye() const {
  return target_ - distance_ * forward();
}

scene::CameraSettings Orbit::settings() const {
  scene::CameraSettings camera;
  camera.eye = eye();
  camera.target = target_;
  camera.fov = fov_;
  if (roll_ != 0) camera.up = up();
  return camera;
}

void Orbit::turn(double dx, double dy) {
  roll_ = 0;
  yaw_ = std::remainder(yaw_ - radians_per_height * dx, 2 * pi);
  pitch_ = std::clamp(pitch_ + radians_per_height * dy, -steepest, steepest);
}

void Orbit::pan(double dx, double dy) {
  const double height = 2 * distance_ * std::tan(0.5 * fov_ * pi / 180);  // m, of the picture
  target_ += height * (-dx * right() + dy * up());
}

void Orbit::zoom(double notches, double x, double y) {
  const double factor = std::pow(zoom_of_notch, notches);
  const double height = 2 * distance_ * std::tan(0.5 * fov_ * pi / 180);
  // The point under the mouse at the target's distance stays there.
  target_ += (1 - factor) * height * (x * right() + y * up());
  distance_ = std::clamp(distance_ * factor, 1e-4, 1e6);
}

void Orbit::frame(const sim::shapes::Bounds& box, double aspect) {
  target_ = 0.5 * (box.min + box.max);
  const double radius = std::max(1e-4, 0.5 * (box.max - box.min).norm());
  const double half = 0.5 * fov_ * pi / 180;
  const double narrow = std::atan(std::tan(half) * std::min(1.0, aspect));
  distance_ = 1.05 * radius / std::sin(narrow);
}

void Orbit::look_along(int axis) {
  Orbit wanted = *this;
  wanted.roll_ = 0;
  wanted.yaw_ = axis == 0 ? 0.5 * pi : 0;
  wanted.pitch_ = axis == 1 ? steepest : 0;
  if (std::abs(std::remainder(wanted.yaw_ - yaw_, 2 * pi)) < 1e-9 &&
      std::abs(wanted.pitch_ - pitch_) < 1e-9) {
    wanted.pitch_ = -wanted.pitch_;
    if (axis != 1) wanted.yaw_ = std::remainder(wanted.yaw_ + pi, 2 * pi);
  }
  *this = wanted;
}

Vec3d Orbit::project(const Vec3d& place) const {
  const Vec3d offset = place - eye();
  const double along = offset.dot(forward());
  const double height = 2 * along * std::tan(0.5 * fov_ * pi / 180);
  return {offset.dot(right()) / height, offset.dot(up()) / height, along};
}

Vec3d Orbit::ray(double x, double y) const {
  const double height = 2 * std::tan(0.5 * fov_ * pi / 180);
  return (forward() + height * (x * right() + y * up())).normalized();
}

}  // namespace neve::app::view::panels
