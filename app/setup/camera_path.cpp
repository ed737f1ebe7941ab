#include "app/setup/camera_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/shapes/curve.h"

namespace neve::app::setup {

namespace {

/// Eases a share of the way: it goes from 0 to 1, at rest at both ends.
double eased(double part) {
  const double x = std::clamp(part, 0.0, 1.0);
  return x * x * x * (x * (6 * x - 15) + 10);
}

CameraPlace own_place(const scene::CameraSettings& settings) {
  return {settings.eye.value_or(sim::Vec3d(2, 1, 2)), settings.target.value_or(sim::Vec3d::Zero()),
          settings.fov};
}

CameraPlace place_on_path(const scene::CameraSettings& settings, double time) {
  const CameraPlace own = own_place(settings);
  if (settings.keyframes.empty()) return own;
  std::vector<double> times;
  std::vector<CameraPlace> places;
  for (const scene::CameraKeyframe& key : settings.keyframes) {
    times.push_back(key.time);
    places.push_back(
        {key.eye.value_or(own.eye), key.target.value_or(own.target), key.fov.value_or(own.fov)});
  }
  const sim::shapes::CurvePlace at(times, time);
  const auto value = [&](auto member) {
    std::vector<double> x;
    for (const CameraPlace& place : places) x.push_back(member(place));
    return sim::shapes::curve_at(times, x, at).value;
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

bool has_place(const scene::CameraSettings& camera) {
  if (camera.eye && camera.target) return true;
  const auto is_placed = [](const scene::CameraKeyframe& key) { return key.eye && key.target; };
  return !camera.keyframes.empty() &&
         std::all_of(camera.keyframes.begin(), camera.keyframes.end(), is_placed);
}

double turned(const scene::CameraSettings& settings, double time, double duration) {
  if (settings.orbit) return *settings.orbit * (duration > 0 ? eased(time / duration) : 0);
  if (settings.turntable) return 360 * time / *settings.turntable;
  return 0;
}

sim::Vec3d turn_about(const sim::Vec3d& up, double degrees, const sim::Vec3d& vector) {
  const double angle = std::remainder(degrees, 360.0) * std::numbers::pi / 180;
  return Eigen::AngleAxisd(angle, up.normalized()) * vector;
}

CameraPlace camera_at(const scene::CameraSettings& settings, double time, double duration) {
  CameraPlace place = place_on_path(settings, time);
  const double turn = turned(settings, time, duration);
  if (turn != 0) place.eye = place.target + turn_about(settings.up, turn, place.eye - place.target);
  return place;
}

}  // namespace neve::app::setup
