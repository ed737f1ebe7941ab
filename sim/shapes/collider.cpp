#include "sim/shapes/collider.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/shapes/deforming_mesh.h"
#include "sim/shapes/height_field.h"
#include "sim/shapes/mesh_surface.h"
#include "sim/shapes/solid.h"

namespace neve::sim::shapes {
namespace {

/// Distance and normal of a place in the axes of the form, about its centre.
struct Touch {
  double distance;
  Vec3d normal;
  Vec3d velocity{0, 0, 0};  ///< m/s, of a shape that deforms
};

/// Position of a place beside the axis y of a round form.
struct Beside {
  double out;     ///< m, from the axis
  Vec3d outward;  ///< unit vector
  explicit Beside(const Vec3d& y) : out(std::hypot(y.x(), y.z())) {
    outward = out > 0 ? Vec3d(y.x() / out, 0, y.z() / out) : Vec3d(Vec3d::UnitX());
  }
};

double beyond(double a, double b) {
  return std::hypot(std::max(a, 0.0), std::max(b, 0.0));
}

Touch touch(const Box& box, const Vec3d& y) {
  const Vec3d q = y.cwiseAbs() - 0.5 * box.size;
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (q[a] > q[axis]) axis = a;
  const double sign = y[axis] >= 0 ? 1.0 : -1.0;
  return {q[axis] > 0 ? q.cwiseMax(0.0).norm() : q[axis], sign * Vec3d::Unit(axis)};
}

Touch touch(const Capsule& capsule, const Vec3d& y) {
  const double half = 0.5 * (capsule.b - capsule.a).norm();
  const Vec3d away = y - Vec3d(0, std::clamp(y.y(), -half, half), 0);
  const double r = away.norm();
  return {r - capsule.radius, r > 0 ? Vec3d(away / r) : Vec3d(Vec3d::UnitX())};
}

Touch touch(const Cylinder& cylinder, const Vec3d& y) {
  const Beside m(y);
  const double wall = m.out - cylinder.radius, end = std::abs(y.y()) - 0.5 * cylinder.height;
  const Vec3d normal = wall >= end ? m.outward : Vec3d((y.y() >= 0 ? 1.0 : -1.0) * Vec3d::UnitY());
  return {std::max(wall, end) > 0 ? beyond(wall, end) : std::max(wall, end), normal};
}

/// Returns the distance from a point to a segment, in the plane of a meridian.
double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                           const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double part = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - part * along).norm();
}

Touch touch(const Cone& cone, const Vec3d& y) {
  const Beside m(y);
  const double half = 0.5 * cone.height, slant = std::hypot(cone.height, cone.radius);
  const double wall = (cone.height * m.out + cone.radius * (y.y() - half)) / slant;
  const double base = -y.y() - half;
  const Vec3d normal = wall >= base
                           ? Vec3d((cone.height * m.outward + cone.radius * Vec3d::UnitY()) / slant)
                           : Vec3d(-Vec3d::UnitY());
  if (std::max(wall, base) <= 0) return {std::max(wall, base), normal};
  const Eigen::Vector2d p(m.out, y.y()), rim(cone.radius, -half), apex(0, half), foot(0, -half);
  return {std::min(distance_to_segment(p, rim, apex), distance_to_segment(p, foot, rim)), normal};
}

Touch touch(const Torus& torus, const Vec3d& y) {
  const Beside m(y);
  const double out = m.out - torus.major_radius, r = std::hypot(out, y.y());
  const Vec3d normal =
      r > 0 ? Vec3d((out * m.outward + y.y() * Vec3d::UnitY()) / r) : Vec3d(Vec3d::UnitY());
  return {r - torus.minor_radius, normal};
}

Touch touch(const Points&, const Vec3d&) {
  throw std::invalid_argument("points have no surface: they cannot be a collider");
}

Touch touch(const Cover&, const Vec3d&) {
  throw std::invalid_argument("a cover is snow: it cannot be a collider");
}

/// False for a plane, of which only the surface moves.
bool turns(const Collider& collider) {
  return !std::holds_alternative<Plane>(collider.shape.form);
}

/// Distance from the pose's point to the furthest place, m; 0 if a turn about it changes nothing.
struct FurthestPlace {
  double operator()(const Sphere&) const { return 0; }
  double operator()(const Plane&) const { return 0; }
  double operator()(const Points&) const { return 0; }
  double operator()(const Cover&) const { return 0; }
  double operator()(const Terrain& s) const {
    const Bounds& box = height_field(s)->bounds();
    return box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).norm();
  }
  double operator()(const Box& s) const { return 0.5 * s.size.norm(); }
  double operator()(const Capsule& s) const { return 0.5 * (s.b - s.a).norm() + s.radius; }
  double operator()(const Cylinder& s) const { return std::hypot(s.radius, 0.5 * s.height); }
  double operator()(const Cone& s) const { return std::hypot(s.radius, 0.5 * s.height); }
  double operator()(const Torus& s) const { return s.major_radius + s.minor_radius; }
  double operator()(const Mesh& s) const {
    double furthest = 0;
    for (const Vec3d& x : mesh_surface(s)->mesh().vertices) furthest = std::max(furthest, x.norm());
    return furthest;
  }
  double operator()(const MeshSequence& s) const { return deforming_mesh(s)->furthest(); }
};

bool is_round(const Shape& shape) {
  return std::holds_alternative<Capsule>(shape.form) ||
         std::holds_alternative<Cylinder>(shape.form) || std::holds_alternative<Cone>(shape.form) ||
         std::holds_alternative<Torus>(shape.form);
}

/// @param furthest  m, see FurthestPlace
double speed_at(const Collider& collider, double furthest, double time) {
  const Pose pose = pose_at(collider, time);
  Vec3d spin = pose.angular_velocity;
  if (is_round(collider.shape)) {
    const Vec3d axis = pose.rotation * form_axes(collider.shape).col(1);
    spin -= spin.dot(axis) * axis;
  }
  return pose.velocity.norm() + spin.norm() * furthest;
}

bool same_motion(const Collider& a, const Collider& b) {
  return a.velocity == b.velocity && a.angular_velocity == b.angular_velocity;
}

}  // namespace

Pose pose_at(const Collider& collider, double time) {
  const PoseOffset& offset = collider.pose_offset;
  if (!collider.keyframes.empty())
    return motion_at(collider.keyframes, center(collider.shape), collider.shape.rotation,
                     time - offset.delay);
  const double moving = time - offset.since;
  const Mat3d start = offset.turned * rotation_from_degrees(collider.shape.rotation);
  const auto [velocity, spin] =
      offset.motion.value_or(std::array{collider.velocity, collider.angular_velocity});
  return {center(collider.shape) + offset.moved + moving * velocity,
          turns(collider) ? rotation_from_vector(moving * spin) * start : start, velocity, spin};
}

double shape_time(const Collider& collider, double time) {
  return time - collider.pose_offset.delay;
}

PoseOffset offset_after(const Collider& before, const Collider& after, double time) {
  if (!after.keyframes.empty()) return before.pose_offset;
  if (before.keyframes.empty() && same_motion(before, after)) return before.pose_offset;
  PoseOffset offset = before.pose_offset;
  offset.since = time;
  if (!before.keyframes.empty()) {
    const Pose now = pose_at(before, time);
    offset.moved = now.point - center(before.shape);
    offset.turned = now.rotation * rotation_from_degrees(before.shape.rotation).transpose();
    return offset;
  }
  const double moving = time - before.pose_offset.since;
  offset.moved += moving * before.velocity;
  if (turns(before))
    offset.turned = rotation_from_vector(moving * before.angular_velocity) * offset.turned;
  return offset;
}

PoseOffset body_offset_after(const Collider& before, const Collider& after, double time) {
  if (same_motion(before, after)) return before.pose_offset;
  const Pose now = pose_at(before, time);
  // The given one of the two speeds is set; the other stays as the body has it by now.
  const auto given = [](const Vec3d& was, const Vec3d& is, const Vec3d& now) {
    return was == is ? now : is;
  };
  return {time,
          now.point - center(before.shape),
          now.rotation * rotation_from_degrees(before.shape.rotation).transpose(),
          before.pose_offset.delay,
          std::array{given(before.velocity, after.velocity, now.velocity),
                     given(before.angular_velocity, after.angular_velocity, now.angular_velocity)},
          before.pose_offset.joint_angle};
}

PoseOffset delayed(PoseOffset offset, double seconds) {
  offset.since += seconds;
  offset.delay += seconds;
  return offset;
}

Bounds bounds_at(const Collider& collider, double time) {
  const Pose pose = pose_at(collider, time);
  if (const auto* mesh = std::get_if<Mesh>(&collider.shape.form)) {
    const Bounds b = bounds_of(mesh_surface(*mesh)->mesh(), pose.rotation);
    return {pose.point + b.min, pose.point + b.max};
  }
  if (const auto* sequence = std::get_if<MeshSequence>(&collider.shape.form)) {
    const Bounds b =
        bounds_of(surface_at(*sequence, shape_time(collider, time))->mesh(), pose.rotation);
    return {pose.point + b.min, pose.point + b.max};
  }
  return Solid(collider.shape).bounds_at(pose.point, pose.rotation);
}

double largest_speed(const Collider& collider) {
  const bool may_turn =
      !collider.keyframes.empty() || !pose_at(collider, 0).angular_velocity.isZero(0);
  const double furthest = may_turn ? std::visit(FurthestPlace{}, collider.shape.form) : 0;
  double speed = collider.keyframes.empty() ? speed_at(collider, furthest, 0) : 0;
  for (std::size_t k = 1; k < collider.keyframes.size(); ++k) {
    // A monotone cubic is nowhere three times as quick as the mean: looked for instead of solved.
    constexpr int looks = 32;
    const double from = collider.keyframes[k - 1].time, to = collider.keyframes[k].time;
    for (int look = 0; look <= looks; ++look) {
      const double time = from + (to - from) * look / looks + collider.pose_offset.delay;
      speed = std::max(speed, speed_at(collider, furthest, time));
    }
  }
  const auto* sequence = std::get_if<MeshSequence>(&collider.shape.form);
  return sequence ? speed + deforming_mesh(*sequence)->fastest() : speed;
}

/// Touch at a place of the world. The middle of a sphere looks up however it has turned.
struct ColliderAt::Touching {
  const ColliderAt& at;
  const Vec3d& x;

  Touch operator()(const Plane& plane) const {
    const Vec3d normal = at.pose_.rotation * plane.normal.normalized();
    return {normal.dot(x - at.pose_.point), normal};
  }
  Touch operator()(const Sphere& sphere) const {
    const Vec3d d = x - at.pose_.point;
    const double r = d.norm();
    return {r - sphere.radius, r > 0 ? Vec3d(d / r) : Vec3d(Vec3d::UnitY())};
  }
  Touch operator()(const MeshSequence&) const {
    const Mat3d& rotation = at.pose_.rotation;
    const Vec3d y = rotation.transpose() * (x - at.pose_.point);
    Touch out{at.mesh_->signed_distance(y), rotation * at.mesh_->normal(y)};
    const DeformingMesh::Moment now = at.deforming_->moment(at.time_);
    if (!now.moves) return out;
    const MeshSurface::Place nearest = at.mesh_->nearest_place(y);
    out.velocity = rotation * at.deforming_->velocity(now.interval, at.mesh_->mesh(),
                                                      nearest.triangle, nearest.point);
    return out;
  }
  template <class Form>
  Touch operator()(const Form& form) const {
    const Mat3d axes = at.pose_.rotation * form_axes(at.shape_);
    const Touch own = touch_of(form, axes.transpose() * (x - at.pose_.point));
    return {own.distance, axes * own.normal};
  }

 private:
  Touch touch_of(const Mesh&, const Vec3d& y) const {
    return {at.mesh_->signed_distance(y), at.mesh_->normal(y)};
  }
  Touch touch_of(const Terrain&, const Vec3d& y) const {
    const auto place = at.field_->at(y.x(), y.z());
    return {at.field_->distance(y), place ? place->normal : Vec3d(Vec3d::UnitY())};
  }
  template <class Form>
  Touch touch_of(const Form& form, const Vec3d& y) const {
    return touch(form, y);
  }
};

ColliderAt::ColliderAt(const Collider& collider, double time)
    : shape_(collider.shape), pose_(pose_at(collider, time)), time_(shape_time(collider, time)) {
  if (const auto* mesh = std::get_if<Mesh>(&shape_.form)) mesh_ = mesh_surface(*mesh);
  if (const auto* terrain = std::get_if<Terrain>(&shape_.form)) field_ = height_field(*terrain);
  if (const auto* sequence = std::get_if<MeshSequence>(&shape_.form)) {
    mesh_ = shapes::surface_at(*sequence, time_);
    deforming_ = deforming_mesh(*sequence);
  }
}

Surface ColliderAt::surface(const Vec3d& x) const {
  const auto [distance, normal, velocity] = std::visit(Touching{*this, x}, shape_.form);
  return {distance, normal,
          pose_.velocity + pose_.angular_velocity.cross(x - pose_.point) + velocity};
}

Surface surface_at(const Collider& collider, double time, const Vec3d& x) {
  return ColliderAt(collider, time).surface(x);
}

double signed_distance(const Collider& collider, double time, const Vec3d& x) {
  return surface_at(collider, time, x).distance;
}

}  // namespace neve::sim::shapes
