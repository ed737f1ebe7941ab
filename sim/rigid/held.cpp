#include "sim/rigid/held.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/QR>
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

/// A step of one freedom on a spring and a damper, under a force that is constant in it. With the
/// place x from where the spring is at rest, and the impulse J of other forces over the inertia:
/// its way / dt = way_by_speed v + way_by_place x / dt + way_by_push J, and the speed at its end
/// likewise.
struct Swing {
  double way_by_speed, way_by_place, way_by_push;
  double end_by_speed, end_by_place, end_by_push;
};

/// Integral of the way that a speed of 1 makes in time 1, over that time.
/// @param stiffness  times dt^2 / inertia @param damping  times dt / inertia @param end  of x = 1
/// at rest
double way_of_push(double stiffness, double damping, double end) {
  constexpr double small = 1e-3, tiny = 1e-9;
  if (stiffness < small && damping < small)  // differences of nearly equal numbers: by its series
    return 0.5 - damping / 6 + (damping * damping - stiffness) / 24 -
           damping * (damping * damping - 2 * stiffness) / 120;
  if (stiffness < tiny) return (1 + std::expm1(-damping) / damping) / damping;
  return (1 - end) / stiffness;
}

/// The exact motion, in a step of any length after one of any length.
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
  return {odd, -stiffness * push, push, even - half * odd, -stiffness * odd, odd};
}

/// Implicit Euler: what is too fast for the step comes to rest.
Swing damped_swing(double stiffness, double damping) {
  const double kept = 1 / (1 + damping + stiffness);
  return {kept, -stiffness * kept, kept, kept, -stiffness * kept, kept};
}

/// Swings of more than 12 steps a period are exact; those of less than six are damped. In between
/// both are mixed. Neither adds to the energy, nor does the mixture, whatever steps follow.
Swing swing_of(double stiffness, double damping) {
  constexpr double finely = 0.5, coarsely = 1;  // rad in a step
  const double share = (std::sqrt(stiffness) - finely) / (coarsely - finely);
  const Swing b = damped_swing(stiffness, damping);
  if (share >= 1) return b;
  const Swing a = exact_swing(stiffness, damping);
  if (share <= 0) return a;
  const auto mix = [&](double from, double to) { return from + share * (to - from); };
  return {mix(a.way_by_speed, b.way_by_speed), mix(a.way_by_place, b.way_by_place),
          mix(a.way_by_push, b.way_by_push),   mix(a.end_by_speed, b.end_by_speed),
          mix(a.end_by_place, b.end_by_place), mix(a.end_by_push, b.end_by_push)};
}

struct SpringStep {
  double impulse = 0;  ///< of the spring, for the way in the step
  double later = 0;    ///< speed at its end beyond that of the way
};

/// @param beyond  of rest  @param speed  at the start  @param push  impulse of all else
/// @param inertia  of the freedom
SpringStep spring(double stiffness, double damping, double beyond, double speed, double push,
                  double inertia, double dt) {
  const Swing swing = swing_of(stiffness * dt * dt / inertia, damping * dt / inertia);
  const double by_push = push / inertia, by_place = beyond / dt;
  const double way =
      swing.way_by_speed * speed + swing.way_by_place * by_place + swing.way_by_push * by_push;
  const double end =
      swing.end_by_speed * speed + swing.end_by_place * by_place + swing.end_by_push * by_push;
  return {inertia * (way - speed) - push, end - way};
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
  const std::vector<Row> held = rows();
  if (held.empty()) return given;  // a spring or a damper alone
  const auto count = static_cast<Eigen::Index>(held.size());
  // The rows, and the speeds that an impulse along each gives; a row may repeat others.
  Eigen::MatrixXd row(count, 6), given_by(6, count);
  const Eigen::LDLT<Mat3d> turning = inertia.ldlt();
  for (Eigen::Index k = 0; k < count; ++k) {
    const Row& r = held[static_cast<std::size_t>(k)];
    row.row(k) << r.along.transpose(), r.about.transpose();
    if (r.along.isZero(0)) row.row(k) *= size_;  // a length, as the others
    given_by.col(k) << row.row(k).head<3>().transpose() / mass_,
        turning.solve(Vec3d(row.row(k).tail<3>()));
  }
  Eigen::Matrix<double, 6, 1> speeds;
  speeds << given.velocity, given.spin;
  const Eigen::MatrixXd response = row * given_by;
  // Values, not expressions: each one that holds the decomposition would be compiled anew.
  const Eigen::VectorXd missing = row * speeds;
  const Eigen::VectorXd impulses = response.completeOrthogonalDecomposition().solve(missing);
  speeds -= given_by * impulses;
  return {speeds.head<3>(), speeds.tail<3>()};
}

Held::Speeds Held::add_springs(double dt, const Speeds& before, const Speeds& pushed,
                               const Mat3d& inertia, Vec3d& impulse, Vec3d& moment) const {
  Speeds later{Vec3d::Zero(), Vec3d::Zero()};
  if (held_.spring_stiffness > 0 || held_.spring_damping > 0) {
    for (int a = 0; a < 3; ++a) {
      const SpringStep along =
          spring(held_.spring_stiffness, held_.spring_damping, centre_[a] - held_.spring_place[a],
                 before.velocity[a], mass_ * (pushed.velocity[a] - before.velocity[a]), mass_, dt);
      impulse[a] += along.impulse;
      later.velocity[a] += along.later;
    }
  }
  if (held_.joint_stiffness <= 0 && held_.joint_damping <= 0) return later;
  if (held_.joint == Joint::slider) {
    const double speed = axis_.dot(before.velocity);
    const SpringStep along =
        spring(held_.joint_stiffness, held_.joint_damping, axis_.dot(centre_ - start_), speed,
               mass_ * (axis_.dot(pushed.velocity) - speed), mass_, dt);
    impulse += along.impulse * axis_;
    later.velocity += along.later * axis_;
  } else if (held_.joint == Joint::hinge) {
    const Vec3d arm = now_ * arm_, off = arm - axis_.dot(arm) * axis_;
    const double about = axis_.dot(inertia * axis_) + mass_ * off.squaredNorm();
    // The joint will turn the momentum of the free body into a spin about the axis.
    const auto turning = [&](const Speeds& free) {
      return axis_.dot(inertia * free.spin) - mass_ * axis_.dot(arm.cross(free.velocity));
    };
    const SpringStep turn =
        spring(held_.joint_stiffness, held_.joint_damping,
               hinge_angle(axis_, now_ * rotation_.transpose(), angle_), turning(before) / about,
               turning(pushed) - turning(before), about, dt);
    moment += turn.impulse * axis_;
    later.spin += turn.later * axis_;
    later.velocity -= turn.later * axis_.cross(arm);
  }
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
