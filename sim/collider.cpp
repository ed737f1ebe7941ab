#include "sim/collider.h"

#include <Eigen/Geometry>
#include <stdexcept>

namespace neve::sim {
namespace {

struct Touch {
  double distance;
  Vec3d normal;
};

Touch touch(const Plane& plane, const Pose& pose, const Vec3d& x) {
  const Vec3d normal = pose.rotation * plane.normal.normalized();
  return {normal.dot(x - pose.point), normal};
}

Touch touch(const Sphere& sphere, const Pose& pose, const Vec3d& x) {
  const Vec3d d = x - pose.point;
  const double r = d.norm();
  return {r - sphere.radius, r > 0 ? Vec3d(d / r) : Vec3d(Vec3d::UnitY())};
}

Touch touch(const Box& box, const Pose& pose, const Vec3d& x) {
  const Vec3d local = pose.rotation.transpose() * (x - pose.point);
  const Vec3d beyond = local.cwiseAbs() - 0.5 * box.size;
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (beyond[a] > beyond[axis]) axis = a;
  const bool is_outside = beyond[axis] > 0;
  const double sign = local[axis] >= 0 ? 1.0 : -1.0;
  return {is_outside ? beyond.cwiseMax(0.0).norm() : beyond[axis], sign * pose.rotation.col(axis)};
}

/// Of a plane only the surface moves.
bool turns(const Collider& collider) {
  return !std::holds_alternative<Plane>(collider.shape.form);
}

template <class Other>
Touch touch(const Other&, const Pose&, const Vec3d&) {
  throw std::invalid_argument("colliders are planes, spheres and boxes");
}

}  // namespace

Pose pose_at(const Collider& collider, double time) {
  const Travel& travel = collider.travel;
  const double moving = time - travel.since;
  const Mat3d start = rotation_from_degrees(collider.shape.rotation);
  const Mat3d turned = turns(collider) ? rotation_from_vector(moving * collider.angular_velocity) *
                                             travel.turned * start
                                       : start;
  return {center(collider.shape) + travel.moved + moving * collider.velocity, turned};
}

Travel travel_after(const Collider& before, const Collider& after, double time) {
  if (before.velocity == after.velocity && before.angular_velocity == after.angular_velocity)
    return before.travel;
  const Travel& so_far = before.travel;
  const double moving = time - so_far.since;
  Travel travel;
  travel.since = time;
  travel.moved = so_far.moved + moving * before.velocity;
  if (turns(before))
    travel.turned = rotation_from_vector(moving * before.angular_velocity) * so_far.turned;
  return travel;
}

Surface surface_at(const Collider& collider, double time, const Vec3d& x) {
  const Pose pose = pose_at(collider, time);
  const auto [distance, normal] =
      std::visit([&](const auto& form) { return touch(form, pose, x); }, collider.shape.form);
  return {distance, normal, collider.velocity + collider.angular_velocity.cross(x - pose.point)};
}

double signed_distance(const Collider& collider, double time, const Vec3d& x) {
  return surface_at(collider, time, x).distance;
}

}  // namespace neve::sim
