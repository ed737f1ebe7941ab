#include "app/exports/stage_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/exports/stage_path.h"
#include "app/exports/usda.h"
#include "app/setup/camera_path.h"

namespace neve::app::exports {

namespace {

using sim::Mat3d;
using sim::Vec3d;

constexpr double height = 24;  // tenths of a unit, as film has millimetres

/// What a camera that follows has moved by, linear between samples.
Vec3d followed_at(const std::vector<Sample>& samples, double time) {
  const auto next = std::ranges::upper_bound(samples, time, {}, &Sample::time);
  const Sample& after = next == samples.end() ? samples.back() : *next;
  const Sample& before = next == samples.begin() ? after : *(next - 1);
  const Vec3d a = before.followed.value_or(Vec3d::Zero()),
              b = after.followed.value_or(Vec3d::Zero());
  const double seconds = after.time - before.time;
  return seconds > 0 ? Vec3d(a + (time - before.time) / seconds * (b - a)) : a;
}

setup::CameraPlace camera_at(const scene::Scene& scene, const std::vector<Sample>& samples,
                             double time) {
  setup::CameraPlace place = setup::camera_at(*scene.camera, time, scene::duration(scene));
  const Vec3d moved = followed_at(samples, time);
  place.eye += moved;
  place.target += moved;
  return place;
}

/// Nearest and farthest that a camera sees, m.
struct Range {
  double nearest = 1e300, farthest = 0;
  /// @param eye  in the axes of the box
  void add(const setup::Box& box, const Vec3d& eye) {
    const Vec3d inside = eye.cwiseMax(box.min).cwiseMin(box.max);
    nearest = std::min(nearest, (inside - eye).norm());
    add_farthest(box, eye);
  }
  void add_farthest(const setup::Box& box, const Vec3d& eye) {
    const Vec3d far = (eye - box.min).cwiseAbs().cwiseMax((eye - box.max).cwiseAbs());
    farthest = std::max(farthest, far.norm());
  }
};

/// Distances along the axis of view: less than those from the eye by what the corners of the
/// picture are aside.
std::string usd_clipping_range(const scene::Scene& scene, const Axes& axes,
                               const std::vector<Sample>& samples,
                               const std::vector<SeenCollider>& colliders) {
  const double aspect = 1.0 * scene.size.width / scene.size.height;
  Range seen;
  double widest = 0;
  for (const Sample& sample : samples) {
    const setup::CameraPlace camera = camera_at(scene, samples, sample.time);
    widest = std::max(widest, camera.fov);
    if (sample.snow) seen.add(*sample.snow, camera.eye);
    for (const SeenCollider& collider : colliders) {
      const PlacedShape* placed = sample.find(collider.name);
      if (!placed) continue;
      const Mat3d& rotation = placed->pose.rotation;
      const Vec3d eye = rotation.transpose() * (camera.eye - placed->pose.point);
      if (collider.normal) {
        seen.nearest = std::min(seen.nearest, std::abs(collider.normal->dot(eye)));
        seen.add_farthest(collider.box, eye);
      } else {
        seen.add(collider.box, eye);
      }
    }
  }
  if (!(seen.farthest > 0)) return {};
  const double slope = std::tan(0.5 * widest * std::numbers::pi / 180);
  const double corner = 1 / std::sqrt(1 + slope * slope * (1 + aspect * aspect));
  // Half of the way to the nearest and half as far again: things move between frames. Depths of
  // one picture are of no use where they span more than five orders.
  const double far = 1.5 * seen.farthest, near = std::max(0.5 * corner * seen.nearest, 1e-5 * far);
  return "            float2 clippingRange = (" +
         usd_number(static_cast<float>(axes.scale() * near)) + ", " +
         usd_number(static_cast<float>(axes.scale() * far)) + ")\n";
}

}  // namespace

Mat3d looking(const Vec3d& forward, const Vec3d& up) {
  Mat3d rotation;
  rotation.col(2) = -forward.normalized();
  rotation.col(0) = up.cross(rotation.col(2)).normalized();
  rotation.col(1) = rotation.col(2).cross(rotation.col(0));
  return rotation;
}

std::string usd_camera(const scene::Scene& scene, const Axes& axes,
                       const std::vector<Sample>& samples,
                       const std::vector<SeenCollider>& colliders) {
  if (!scene.camera || !scene.camera->eye || !scene.camera->target || samples.empty()) return {};
  const double width = height * scene.size.width / scene.size.height;
  std::vector<std::pair<double, std::string>> focal_lengths;
  for (const Sample& sample : samples) {
    const double half = 0.5 * camera_at(scene, samples, sample.time).fov * std::numbers::pi / 180;
    focal_lengths.emplace_back(sample.time, usd_number(0.5 * height / std::tan(half)));
  }
  const auto place_at = [&](double time) {
    const setup::CameraPlace place = camera_at(scene, samples, time);
    return Place{time, looking(place.target - place.eye, scene.camera->up), place.eye};
  };
  return "    def Xform \"view\"\n    {\n        def Camera \"camera\"\n        {\n" +
         std::string("            float horizontalAperture = ") + usd_number(width) +
         "\n            float verticalAperture = " + usd_number(height) + "\n" +
         usd_clipping_range(scene, axes, samples, colliders) +
         usd_property(scene, "            float focalLength", focal_lengths) +
         usd_placed(scene, axes, path_of(samples, place_at)) + "        }\n    }\n";
}

}  // namespace neve::app::exports
