#include "sim/shapes/keyframes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim/shapes/curve.h"

namespace neve::sim::shapes {
namespace {

using Quat = Eigen::Quaterniond;

/// exp: the rotation by |w| radians about w.
Quat turned_by(const Vec3d& w) {
  const double angle = w.norm();
  if (angle == 0) return Quat::Identity();
  return Quat(Eigen::AngleAxisd(angle, w / angle));
}

/// log: the rotation vector, at most pi long.
Vec3d rotation_vector(Quat q) {
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (sine < 1e-300) return Vec3d::Zero();
  return 2 * std::atan2(sine, q.w()) / sine * q.vec();
}

/// The attitudes at the keyframes and the turns between them.
class Attitudes {
 public:
  Attitudes(const std::vector<double>& times, const std::vector<Vec3d>& degrees,
            const CurvePlace& place)
      : times_(times), degrees_(degrees), place_(place) {}

  /// @param angular_velocity  rad/s in the world
  Quat operator()(Vec3d& angular_velocity) const {
    angular_velocity.setZero();
    if (place_.next == 0) return at(0);
    if (place_.next == times_.size()) return at(times_.size() - 1);
    const std::size_t k = place_.next - 1;
    const Quat start = at(k), end = at(k + 1);
    // Three turns one after the other, in the axes of the thing: those at the ends give the angular
    // velocities there, the middle one the rest.
    const Vec3d first = spin(k) * (place_.span / 3), last = spin(k + 1) * (place_.span / 3);
    const Vec3d middle =
        rotation_vector(turned_by(-first) * start.conjugate() * end * turned_by(-last));
    const double s = place_.part, r = 1 - s;
    const double share[3] = {1 - r * r * r, s * s * (3 - 2 * s), s * s * s};
    const double rate[3] = {3 * r * r, 6 * s * r, 3 * s * s};
    const Quat A = turned_by(share[0] * first), B = turned_by(share[1] * middle),
               C = turned_by(share[2] * last);
    const Vec3d own =
        C.conjugate() * (B.conjugate() * (rate[0] * first) + rate[1] * middle) + rate[2] * last;
    const Quat now = (start * A * B * C).normalized();
    angular_velocity = now * own / place_.span;
    return now;
  }

 private:
  Quat at(std::size_t k) const { return Quat(rotation_from_degrees(degrees_[k])); }

  /// Returns the spin from keyframe k to the next one, in the axes of the thing, per second.
  Vec3d mean_spin(std::size_t k) const {
    return rotation_vector(at(k).conjugate() * at(k + 1)) / (times_[k + 1] - times_[k]);
  }

  /// Returns the spin at keyframe k.
  Vec3d spin(std::size_t k) const {
    if (k == 0 || k + 1 == times_.size()) return Vec3d::Zero();
    const Vec3d before = mean_spin(k - 1), after = mean_spin(k);
    Vec3d out;
    for (int a = 0; a < 3; ++a) out[a] = slope_at(times_, k, before[a], after[a]);
    return out;
  }

  const std::vector<double>& times_;
  const std::vector<Vec3d>& degrees_;
  const CurvePlace& place_;
};

/// The two keyframes on either side of a time: the slopes at the nearer ones depend on the others.
std::vector<PoseKeyframe> keyframes_around(const std::vector<PoseKeyframe>& all, double time) {
  const auto next = std::upper_bound(
      all.begin(), all.end(), time, [](double t, const PoseKeyframe& key) { return t < key.time; });
  const auto first = next - std::min<std::ptrdiff_t>(2, next - all.begin());
  const auto end = next + std::min<std::ptrdiff_t>(2, all.end() - next);
  return {first, end};
}

}  // namespace

RigidMotion motion_at(const std::vector<PoseKeyframe>& all, const Vec3d& position,
                      const Vec3d& degrees, double time) {
  const std::vector<PoseKeyframe> keyframes = keyframes_around(all, time);
  std::vector<double> times;
  std::vector<Vec3d> angles;
  for (const PoseKeyframe& key : keyframes) {
    times.push_back(key.time);
    angles.push_back(key.rotation.value_or(degrees));
  }
  const CurvePlace place(times, time);
  RigidMotion out;
  std::vector<double> x(keyframes.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < x.size(); ++k)
      x[k] = keyframes[k].position.value_or(position)[axis];
    const CurveValue found = curve_at(times, x, place);
    out.point[axis] = found.value;
    out.velocity[axis] = found.slope;
  }
  out.rotation = Attitudes(times, angles, place)(out.angular_velocity).toRotationMatrix();
  return out;
}

double written_turn(const Vec3d& degrees, const Vec3d& next) {
  return (next - degrees).cwiseAbs().maxCoeff();
}

}  // namespace neve::sim::shapes
