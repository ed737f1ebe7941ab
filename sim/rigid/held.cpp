#include "sim/rigid/held.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace neve::sim::rigid {

namespace {

using shapes::HeldAxis;
using shapes::Joint;

bool is_held(const shapes::RigidBody& body, HeldAxis axis) {
  return std::find(body.hold.begin(), body.hold.end(), axis) != body.hold.end();
}

HeldAxis turn_about(int axis) {
  return static_cast<HeldAxis>(static_cast<int>(HeldAxis::turn_x) + axis);
}

/// w with exp([w]x) = R.
Vec3d vector_of(const Mat3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

/// Two unit vectors across a third.
std::array<Vec3d, 2> across(const Vec3d& axis) {
  const Vec3d first = axis.unitOrthogonal();
  return {first, axis.cross(first)};
}

/// 1/s. A body is put back by so many times its size, or radians. Contact lets a body out of what
/// it overlaps without regard to what holds it; put back in a single step, it was thrown along what
/// is free, by 1e9 m/s.
constexpr double recovery = 2;

/// Impulse of a spring and a damper along one freedom.
/// @param beyond  of rest  @param speed  of it  @param inertia  of the freedom
double spring(double stiffness, double damping, double beyond, double speed, double inertia,
              double dt) {
  const double resistance = dt * (damping + stiffness * dt);
  return -(stiffness * beyond * dt + resistance * speed) / (1 + resistance / inertia);
}

}  // namespace

double hinge_angle(const Vec3d& axis, const Mat3d& turned, double near) {
  constexpr double whole = 2 * std::numbers::pi;
  const double least = axis.dot(vector_of(turned)), turns = std::round((near - least) / whole);
  return turns == 0 ? least : least + whole * turns;
}

Held::Held(btRigidBody& body, const shapes::Collider& collider, const MassProperties& mass,
           const Mat3d& rotation)
    : btTypedConstraint(D6_CONSTRAINT_TYPE, body),
      held_(collider.body),
      mass_(mass.mass),
      size_(std::sqrt(0.5 * mass.inertia.trace() / mass.mass)),
      start_(shapes::center(collider.shape) + rotation * mass.centre),
      rotation_(rotation),
      arm_(rotation.transpose() * (collider.body.joint_point - start_)),
      axis_(collider.body.joint_axis.stableNormalized()),
      centre_(start_),
      now_(rotation) {}

bool Held::holds(const shapes::RigidBody& body) {
  return !body.hold.empty() || body.joint != Joint::none || body.spring_stiffness > 0 ||
         body.spring_damping > 0;
}

void Held::set_place(const Vec3d& centre, const Mat3d& rotation, double angle) {
  centre_ = centre;
  now_ = rotation;
  angle_ = angle;
}

std::vector<Held::Row> Held::rows() const {
  std::vector<Row> rows;
  const Vec3d back = -vector_of(now_ * rotation_.transpose());
  bool turns = false;
  for (int a = 0; a < 3; ++a) {
    if (is_held(held_, static_cast<HeldAxis>(a)))
      rows.push_back({Vec3d::Unit(a), Vec3d::Zero(), start_[a] - centre_[a]});
    turns = turns || !is_held(held_, turn_about(a));
  }
  // About one axis alone, there is no attitude that it should have gone back to.
  for (int a = 0; a < 3; ++a)
    if (is_held(held_, turn_about(a)))
      rows.push_back({Vec3d::Zero(), Vec3d::Unit(a), turns ? 0 : back[a]});
  add_joint(rows);
  return rows;
}

void Held::add_joint(std::vector<Row>& rows) const {
  if (held_.joint == Joint::none) return;
  if (held_.joint == Joint::slider) {
    for (const Vec3d& b : across(axis_))
      rows.push_back({b, Vec3d::Zero(), b.dot(start_ - centre_)});
    const Vec3d back = -vector_of(now_ * rotation_.transpose());
    for (int a = 0; a < 3; ++a) rows.push_back({Vec3d::Zero(), Vec3d::Unit(a), back[a]});
    return;
  }
  const Vec3d arm = now_ * arm_, missing = held_.joint_point - (centre_ + arm);
  for (int a = 0; a < 3; ++a)
    rows.push_back({Vec3d::Unit(a), arm.cross(Vec3d::Unit(a)), missing[a]});
  if (held_.joint == Joint::ball) return;
  const Vec3d tilt = (now_ * rotation_.transpose() * axis_).cross(axis_);
  for (const Vec3d& b : across(axis_)) rows.push_back({Vec3d::Zero(), b, b.dot(tilt)});
}

void Held::add_springs(double dt, const Vec3d& velocity, const Vec3d& spin, const Mat3d& inertia,
                       Vec3d& impulse, Vec3d& moment) const {
  if (held_.spring_stiffness > 0 || held_.spring_damping > 0) {
    for (int a = 0; a < 3; ++a)
      impulse[a] += spring(held_.spring_stiffness, held_.spring_damping,
                           centre_[a] - held_.spring_place[a], velocity[a], mass_, dt);
  }
  if (held_.joint_stiffness <= 0 && held_.joint_damping <= 0) return;
  if (held_.joint == Joint::slider) {
    impulse += axis_ * spring(held_.joint_stiffness, held_.joint_damping,
                              axis_.dot(centre_ - start_), axis_.dot(velocity), mass_, dt);
  } else if (held_.joint == Joint::hinge) {
    const Vec3d arm = now_ * arm_, off = arm - axis_.dot(arm) * axis_;
    const double about = axis_.dot(inertia * axis_) + mass_ * off.squaredNorm();
    // The joint will turn the momentum of the free body into this spin.
    const double turning = axis_.dot(inertia * spin) - mass_ * axis_.dot(arm.cross(velocity));
    moment += axis_ * spring(held_.joint_stiffness, held_.joint_damping,
                             hinge_angle(axis_, now_ * rotation_.transpose(), angle_),
                             turning / about, about, dt);
  }
}

void Held::getInfo1(btConstraintInfo1* info) {
  info->m_numConstraintRows = static_cast<int>(rows().size());
  info->nub = 0;
}

void Held::getInfo2(btConstraintInfo2* info) {
  int at = 0;
  for (const Row& row : rows()) {
    for (int x = 0; x < 3; ++x) {
      info->m_J1linearAxis[at + x] = row.along[x];
      info->m_J1angularAxis[at + x] = row.about[x];
    }
    const double limit = recovery * (row.along.isZero(0) ? 1 : std::max(size_, arm_.norm()));
    info->m_constraintError[at] = std::clamp(info->fps * info->erp * row.error, -limit, limit);
    at += info->rowskip;
  }
}

}  // namespace neve::sim::rigid
