#include "app/camera_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace neve::app {

namespace {

/// From 0 to 1, at rest at both ends.
double eased(double part) {
  const double x = std::clamp(part, 0.0, 1.0);
  return x * x * x * (x * (6 * x - 15) + 10);
}

/// Slope at a keyframe between two others: the weighted harmonic mean of Fritsch and Butland, zero
/// where the values turn back.
double slope_between(double t0, double t1, double t2, double x0, double x1, double x2) {
  const double before = (x1 - x0) / (t1 - t0), after = (x2 - x1) / (t2 - t1);
  if (!(before * after > 0)) return 0;
  const double w1 = 2 * (t2 - t1) + (t1 - t0), w2 = (t2 - t1) + 2 * (t1 - t0);
  return (w1 + w2) / (w1 / before + w2 / after);
}

/// The curve through (t[k], x[k]) at a time, constant before the first and after the last.
class Curve {
 public:
  Curve(const std::vector<double>& times, double time) : t_(times) {
    const auto later = std::upper_bound(t_.begin(), t_.end(), time);
    next_ = static_cast<std::size_t>(later - t_.begin());
    if (next_ == 0 || next_ == t_.size()) return;
    span_ = t_[next_] - t_[next_ - 1];
    s_ = (time - t_[next_ - 1]) / span_;
  }

  double operator()(const std::vector<double>& x) const {
    if (next_ == 0) return x.front();
    if (next_ == t_.size()) return x.back();
    const double a = x[next_ - 1], b = x[next_];
    const double m = span_ * slope(x, next_ - 1), n = span_ * slope(x, next_);
    const double s = s_, r = 1 - s;
    return (1 + 2 * s) * r * r * a + s * r * r * m + s * s * (3 - 2 * s) * b - s * s * r * n;
  }

 private:
  double slope(const std::vector<double>& x, std::size_t k) const {
    if (k == 0 || k + 1 == t_.size()) return 0;
    return slope_between(t_[k - 1], t_[k], t_[k + 1], x[k - 1], x[k], x[k + 1]);
  }

  const std::vector<double>& t_;
  std::size_t next_ = 0;  ///< first keyframe after the time
  double span_ = 1, s_ = 0;
};

CameraPlace own_place(const CameraSettings& settings) {
  return {settings.eye.value_or(sim::Vec3d(2, 1, 2)), settings.target.value_or(sim::Vec3d::Zero()),
          settings.fov};
}

CameraPlace place_on_path(const CameraSettings& settings, double time) {
  const CameraPlace own = own_place(settings);
  if (settings.keyframes.empty()) return own;
  std::vector<double> times;
  std::vector<CameraPlace> places;
  for (const CameraKeyframe& key : settings.keyframes) {
    times.push_back(key.time);
    places.push_back(
        {key.eye.value_or(own.eye), key.target.value_or(own.target), key.fov.value_or(own.fov)});
  }
  const Curve curve(times, time);
  const auto value = [&](auto member) {
    std::vector<double> x;
    for (const CameraPlace& place : places) x.push_back(member(place));
    return curve(x);
  };
  CameraPlace now;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    now.eye[axis] = value([&](const CameraPlace& p) { return p.eye[axis]; });
    now.target[axis] = value([&](const CameraPlace& p) { return p.target[axis]; });
  }
  now.fov = value([](const CameraPlace& p) { return p.fov; });
  return now;
}

}  // namespace

double turned(const CameraSettings& settings, double time, double duration) {
  if (settings.orbit) return *settings.orbit * (duration > 0 ? eased(time / duration) : 0);
  if (settings.turntable) return 360 * time / *settings.turntable;
  return 0;
}

sim::Vec3d turn_about(const sim::Vec3d& up, double degrees, const sim::Vec3d& vector) {
  const double angle = std::remainder(degrees, 360.0) * std::numbers::pi / 180;
  return Eigen::AngleAxisd(angle, up.normalized()) * vector;
}

CameraPlace camera_at(const CameraSettings& settings, double time, double duration) {
  CameraPlace place = place_on_path(settings, time);
  const double turn = turned(settings, time, duration);
  if (turn != 0) place.eye = place.target + turn_about(settings.up, turn, place.eye - place.target);
  return place;
}

}  // namespace neve::app
