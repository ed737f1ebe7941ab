#include "render/frame/view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace neve::render {

View make_view(const Camera& camera, int width, int height) {
  View view;
  view.eye = camera.eye;
  const Vec3f toward = camera.target - camera.eye;
  const float distance = length(toward);
  view.forward = distance > 0 ? toward / distance : Vec3f{0, 0, -1};
  view.right = cross(view.forward, normalized(camera.up));
  if (!(length(view.right) > 1e-4f)) {
    const Vec3f other = std::abs(view.forward.y) < 0.9f ? Vec3f{0, 1, 0} : Vec3f{0, 0, -1};
    view.right = cross(view.forward, other);
  }
  view.right = normalized(view.right);
  view.up = cross(view.right, view.forward);
  const float half = std::clamp(camera.fov, 1.0f, 170.0f) * std::numbers::pi_v<float> / 360;
  view.pixels_per_slope = 0.5f * static_cast<float>(height) / std::tan(half);
  view.width = width;
  view.height = height;
  view.near_distance = std::max(0.01f * distance, 1e-6f);
  return view;
}

Vec3f View::project(Vec3f world) const {
  const Vec3f p = world - eye;
  const float z = dot(p, forward);
  const float scale = z > 0 ? pixels_per_slope / z : 0;
  return {0.5f * static_cast<float>(width) + scale * dot(p, right),
          0.5f * static_cast<float>(height) + scale * dot(p, up), z};
}

}  // namespace neve::render
