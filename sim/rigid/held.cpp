#include "sim/rigid/held.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
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

/// A step of one freedom on a spring and a damper, under a force that is constant in it. With the
/// impulse J over the inertia, of other forces and of the spring as it was at the start:
/// its way / dt = way_by_speed v + way_by_push J, and the speed at its end likewise: a push adds to
/// that as a speed adds to the way.
struct Swing {
  double way_by_speed, way_by_push;
  double end_by_speed;

  double end_by_push() const { return way_by_speed; }
};

/// Integral of the way that a speed of 1 makes in time 1, over that time.
/// @param stiffness  times dt^2 / inertia @param damping  times dt / inertia @param end  of x = 1
/// at rest
double way_of_push(double stiffness, double damping, double end) {
  constexpr double small = 1e-3, tiny = 1e-9;
  // Differences of nearly equal numbers: by its series.
  if (std::abs(stiffness) < small && damping < small)
    return 0.5 - damping / 6 + (damping * damping - stiffness) / 24 -
           damping * (damping * damping - 2 * stiffness) / 120;
  if (std::abs(stiffness) < tiny) return (1 + std::expm1(-damping) / damping) / damping;
  return (1 - end) / stiffness;
}

/// The exact motion, in a step of any length after one of any length, also away from a place where
/// the force is zero and its stiffness negative.
Swing exact_swing(double stiffness, double damping) {
  const double half = 0.5 * damping, over = half * half - stiffness;
  double even = 0, odd = 0;  // e^-half times cos and sin(t) / t, or cosh and sinh(u) / u
  if (over < 0) {
    const double turn = std::sqrt(-over);
    even = std::exp(-half) * std::cos(turn);
    odd = std::exp(-half) * std::sin(turn) / turn;
  } else {
    const double root = std::sqrt(over);
    const double slow = std::exp(root - half), fast = std::exp(-root - half);
    even = 0.5 * (slow + fast);
    odd = root < 1e-5 ? std::exp(-half) : 0.5 * (slow - fast) / root;
  }
  const double end_of_place = even + half * odd,
               push = way_of_push(stiffness, damping, end_of_place);
  return {odd, push, even - half * odd};
}

/// Implicit Euler: what is too fast for the step comes to rest.
Swing damped_swing(double stiffness, double damping) {
  const double kept = 1 / (1 + damping + stiffness);
  return {kept, kept, kept};
}

/// Swings of more than 12 steps a period are exact; those of less than six are damped. In between
/// both are mixed. Neither adds to the energy, nor does the mixture, whatever steps follow.
/// @param stiffest  that the spring is anywhere on the way of the freedom
Swing swing_of(double stiffness, double stiffest, double damping) {
  constexpr double finely = 0.5, coarsely = 1;  // rad in a step
  const double share = (std::sqrt(stiffest) - finely) / (coarsely - finely);
  const Swing b = damped_swing(stiffest, damping);
  if (share >= 1) return b;
  const Swing a = exact_swing(stiffness, damping);
  if (share <= 0) return a;
  const auto mix = [&](double from, double to) { return from + share * (to - from); };
  return {mix(a.way_by_speed, b.way_by_speed), mix(a.way_by_push, b.way_by_push),
          mix(a.end_by_speed, b.end_by_speed)};
}

/// One freedom on all its springs and dampers, in its own units.
struct Freedom {
  double inertia;
  double force = 0;  ///< of the springs, at the start of the step
  double stiffness = 0, stiffest = 0;
  double damping = 0;

  void add(double spring, double damper, double beyond) {
    force -= spring * beyond;
    stiffness += spring;
    stiffest += spring;
    damping += damper;
  }
};

struct SpringStep {
  double impulse = 0;  ///< of the springs, for the way in the step
  double later = 0;    ///< speed at its end beyond that of the way
};

/// @param speed  at the start  @param push  impulse of all else
SpringStep spring_step(const Freedom& on, double speed, double push, double dt) {
  const double square = dt * dt / on.inertia;
  const Swing swing =
      swing_of(on.stiffness * square, on.stiffest * square, on.damping * dt / on.inertia);
  const double pushed = (push + on.force * dt) / on.inertia;
  const double way = swing.way_by_speed * speed + swing.way_by_push * pushed;
  const double end = swing.end_by_speed * speed + swing.end_by_push() * pushed;
  return {on.inertia * (way - speed) - push, end - way};
}

}  // namespace

double hinge_angle(const Vec3d& axis, const Mat3d& turned, double near) {
  constexpr double whole = 2 * std::numbers::pi;
  const double least = axis.dot(vector_of(turned)), turns = std::round((near - least) / whole);
  return turns == 0 ? least : least + whole * turns;
}

Held::Held(btRigidBody& body, const shapes::Collider& collider, const MassProperties& mass,
           const Mat3d& rotation, double unit)
    : btTypedConstraint(D6_CONSTRAINT_TYPE, body),
      held_(collider.body),
      mass_(mass.mass),
      size_(std::sqrt(0.5 * mass.inertia.trace() / mass.mass)),
      unit_(unit),
      start_(shapes::center(collider.shape) + rotation * mass.centre),
      rotation_(rotation),
      arm_(rotation.transpose() * (collider.body.joint_point - start_)),
      axis_(collider.body.joint_axis.stableNormalized()),
      centre_(start_),
      now_(rotation) {}

bool Held::turns_freely(const shapes::RigidBody& body) {
  return body.joint == Joint::none &&
         std::none_of(body.hold.begin(), body.hold.end(),
                      [](HeldAxis axis) { return axis >= HeldAxis::turn_x; });
}

std::optional<Held::Pivot> Held::pivot_of(const shapes::RigidBody& body) {
  if (body.joint != Joint::hinge && body.joint != Joint::ball) return {};
  const Vec3d axis = body.joint_axis.stableNormalized();
  int about = -1, turns_held = 0;  // the axis of the scene that it turns about
  for (int a = 0; a < 3; ++a) {
    const bool turns = !is_held(body, turn_about(a));
    turns_held += !turns;
    if (body.joint == Joint::hinge ? std::abs(axis[a]) > 1 - 1e-12 : turns) about = a;
  }
  if (body.joint == Joint::ball && turns_held == 0 && body.hold.empty()) return Pivot{};
  if (body.joint == Joint::ball && turns_held != 2) return {};
  // Beside its joint, the body may be held along the axis and in the turns across it: as it is.
  for (const HeldAxis held : body.hold)
    if (about < 0 || (held != static_cast<HeldAxis>(about) && held < HeldAxis::turn_x) ||
        held == turn_about(about))
      return {};
  return Pivot{body.joint == Joint::hinge ? axis : Vec3d(Vec3d::Unit(about))};
}

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
  const Mat3d turned = now_ * rotation_.transpose();
  int free = 0;
  // A single free axis is held in its direction; with two there is no attitude that the body should
  // have gone back to.
  Vec3d back = -vector_of(turned);
  for (int a = 0; a < 3; ++a) {
    if (is_held(held_, static_cast<HeldAxis>(a)))
      rows.push_back({Vec3d::Unit(a), Vec3d::Zero(), start_[a] - centre_[a]});
    if (is_held(held_, turn_about(a))) continue;
    back = ++free == 1 ? Vec3d(turned.col(a).cross(Vec3d::Unit(a))) : Vec3d::Zero();
  }
  for (int a = 0; a < 3; ++a)
    if (is_held(held_, turn_about(a))) rows.push_back({Vec3d::Zero(), Vec3d::Unit(a), back[a]});
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

Held::Speeds Held::allowed(const Speeds& given, const Mat3d& inertia) const {
  using Six = Eigen::Matrix<double, 6, 1>;
  const Mat3d turning = inertia.inverse();
  const auto speeds_of = [&](const Six& impulse) {
    Six speeds;
    speeds << impulse.head<3>() / mass_, turning * impulse.tail<3>();
    return speeds;
  };
  Six speeds;
  speeds << given.velocity, given.spin;
  // Each impulse is one that gives no speed along the rows before.
  std::vector<Six> impulses;
  for (const Row& r : rows()) {
    constexpr double nothing = 1e-20;  // of a square: the row repeats others
    Six row;
    row << r.along, r.about;
    const double whole = row.dot(speeds_of(row));
    for (int pass = 0; pass < 2; ++pass)  // the second takes what rounding has left
      for (const Six& other : impulses) row -= row.dot(speeds_of(other)) * other;
    const double left = row.dot(speeds_of(row));
    if (left <= nothing * whole) continue;
    row /= std::sqrt(left);
    speeds -= row.dot(speeds) * speeds_of(row);
    impulses.push_back(row);
  }
  return {speeds.head<3>(), speeds.tail<3>()};
}

Held::Speeds Held::add_springs(double dt, const Speeds& before, const Speeds& pushed,
                               const Mat3d& inertia, Vec3d& impulse, Vec3d& moment) const {
  Speeds later{Vec3d::Zero(), Vec3d::Zero()};
  const bool has_spring = held_.spring_stiffness > 0 || held_.spring_damping > 0;
  const bool has_joint = held_.joint_stiffness > 0 || held_.joint_damping > 0;
  if (!has_spring && !has_joint) return later;
  if (held_.joint == Joint::hinge || held_.joint == Joint::ball)
    return add_turns(dt, before, pushed, inertia, impulse, moment);
  const auto add_along = [&](const Vec3d& axis, const Freedom& freedom) {
    const double speed = axis.dot(before.velocity);
    const SpringStep along =
        spring_step(freedom, speed, mass_ * (axis.dot(pushed.velocity) - speed), dt);
    impulse += along.impulse * axis;
    later.velocity += along.later * axis;
  };
  if (held_.joint == Joint::slider) {
    Freedom along{mass_};
    along.add(held_.joint_stiffness, held_.joint_damping, axis_.dot(centre_ - start_));
    along.add(held_.spring_stiffness, held_.spring_damping,
              axis_.dot(centre_ - held_.spring_place));
    add_along(axis_, along);
    return later;
  }
  for (int a = 0; a < 3; ++a) {
    Freedom along{mass_};
    along.add(held_.spring_stiffness, held_.spring_damping, centre_[a] - held_.spring_place[a]);
    add_along(Vec3d::Unit(a), along);
  }
  return later;
}

Held::Speeds Held::add_turns(double dt, const Speeds& before, const Speeds& pushed,
                             const Mat3d& inertia, Vec3d& impulse, Vec3d& moment) const {
  const std::optional<Pivot> pivot = pivot_of(held_);
  // Forces are taken where the body is in the middle of the step, so many rad away at most.
  constexpr double farthest = 0.25;
  const bool is_hinge = held_.joint == Joint::hinge || (pivot && pivot->axis);
  const Vec3d axis = pivot ? pivot->axis.value_or(axis_) : axis_;
  // A hinge lets nothing move along its axis.
  const auto moving = [&](const Vec3d& x) { return is_hinge ? Vec3d(x - axis.dot(x) * axis) : x; };
  const Vec3d arm = moving(now_ * -arm_);  // of the centre of mass, from the joint
  const double square = arm.squaredNorm();
  const Mat3d about = inertia + mass_ * inertia_at(arm);
  // The pull of the spring along the arm moves nothing. The rest is the weight of a pendulum: its
  // stiffness is negative where it stands on its head.
  const Vec3d weight = moving(held_.spring_stiffness * (held_.spring_place - held_.joint_point));
  // The joint will turn the momentum of the free body into a spin about it.
  const auto momentum = [&](const Speeds& free) {
    return Vec3d(inertia * free.spin + mass_ * arm.cross(free.velocity));
  };
  const Vec3d start = momentum(before), push = momentum(pushed) - start;
  Speeds later{Vec3d::Zero(), Vec3d::Zero()};
  if (is_hinge) {
    Freedom turn{axis.dot(about * axis)};
    if (held_.joint == Joint::hinge)
      turn.add(held_.joint_stiffness, held_.joint_damping,
               hinge_angle(axis, now_ * rotation_.transpose(), angle_));
    const double rate = axis.dot(start) / turn.inertia,
                 half = std::clamp(0.5 * dt * rate, -farthest, farthest);
    const Vec3d middle = Eigen::AngleAxisd(half, axis) * arm;
    turn.force += axis.dot(middle.cross(weight)) + middle.dot(weight) * half;
    turn.stiffness += middle.dot(weight);
    turn.stiffest += arm.norm() * weight.norm();
    turn.damping += held_.spring_damping * square;
    const SpringStep step = spring_step(turn, rate, axis.dot(push), dt);
    moment += step.impulse * axis;
    later.spin = step.later * axis;
  } else if (square > 0) {
    // Ways across the arm, in the two directions in which an impulse gives a speed along itself.
    const Mat3d turning = about.inverse();
    const auto spin = [&](const Vec3d& m) { return Vec3d(turning * m); };
    const auto speed = [&](const Vec3d& m) { return Vec3d(spin(m).cross(arm)); };
    const std::array<Vec3d, 2> ways = across(arm / std::sqrt(square));
    const std::array<Vec3d, 2> given{speed(arm.cross(ways[0])), speed(arm.cross(ways[1]))};
    const double turned = 0.5 * std::atan2(2 * ways[0].dot(given[1]),
                                           ways[0].dot(given[0]) - ways[1].dot(given[1])),
                 c = std::cos(turned), s = std::sin(turned);
    const Vec3d moved = arm.cross(speed(start)) / square;  // rad/s
    const double angle = std::min(0.5 * dt * moved.norm(), farthest);
    const Eigen::AngleAxisd half(angle, moved.stableNormalized());
    const Vec3d middle = half * arm;
    for (const Vec3d& way : {Vec3d(c * ways[0] + s * ways[1]), Vec3d(c * ways[1] - s * ways[0])}) {
      Freedom along{1 / way.dot(speed(arm.cross(way)))};
      along.stiffness = middle.dot(weight) / square;
      along.force =
          (half * way).dot(weight) + along.stiffness * angle * half.axis().cross(arm).dot(way);
      along.stiffest = weight.norm() / std::sqrt(square);
      along.damping = held_.spring_damping;
      const SpringStep step =
          spring_step(along, way.dot(speed(start)), along.inertia * way.dot(speed(push)), dt);
      impulse += step.impulse * way;
      later.spin += spin(arm.cross(along.inertia * step.later * way));
    }
  }
  later.velocity = later.spin.cross(arm);
  return later;
}

void Held::getInfo1(btConstraintInfo1* info) {
  info->m_numConstraintRows = static_cast<int>(rows().size());
  info->nub = 0;
}

void Held::getInfo2(btConstraintInfo2* info) {
  int at = 0;
  for (const Row& row : rows()) {
    const bool is_turn = row.along.isZero(0);
    // Ways and arms of a row are lengths, a turn is none.
    const double unit = is_turn ? 1 : unit_;
    for (int x = 0; x < 3; ++x) {
      info->m_J1linearAxis[at + x] = row.along[x];
      info->m_J1angularAxis[at + x] = row.about[x] / unit;
    }
    const double limit = recovery * (is_turn ? 1 : std::max(size_, arm_.norm()));
    info->m_constraintError[at] =
        std::clamp(info->fps * info->erp * row.error, -limit, limit) / unit;
    at += info->rowskip;
  }
}

}  // namespace neve::sim::rigid
