#include "render/frame/ground_place.h"

#include <algorithm>
#include <cmath>

namespace neve::render {
namespace {

/// Returns the direction of grid lines: the x axis laid into the plane, where it is not the normal.
Vec3f tangent_of(Vec3f normal) {
  const Vec3f axis = std::abs(normal.x) < 0.9f ? Vec3f{1, 0, 0} : Vec3f{0, 0, 1};
  return normalized(axis - dot(axis, normal) * normal);
}

/// Position of the eye between two lines, in units of their spacing. Computed in double on the CPU,
/// so that lines stay fixed far from the origin.
float between_lines(Vec3f eye, Vec3f direction, float spacing) {
  const double lines =
      (double{eye.x} * direction.x + double{eye.y} * direction.y + double{eye.z} * direction.z) /
      double{spacing};
  return static_cast<float>(lines - std::floor(lines));
}

}  // namespace

GroundPlace place_ground(const GroundPlane& ground, const Frame& frame, const View& view) {
  GroundPlace place{};
  place.normal = normalized(ground.normal);
  place.point = ground.point - view.eye;
  place.tangent = tangent_of(place.normal);
  place.bitangent = cross(place.tangent, place.normal);
  place.line_spacing = ground.line_spacing > 0 ? ground.line_spacing : 1e9f;
  place.eye_on_grid[0] = between_lines(view.eye, place.tangent, place.line_spacing);
  place.eye_on_grid[1] = between_lines(view.eye, place.bitangent, place.line_spacing);
  const Vec3f target = frame.camera.target - view.eye;
  place.fade_center = target - dot(target - place.point, place.normal) * place.normal;
  place.fade_distance = 0.62f * std::max(length(target), 1e-6f);
  // 1.3 pixels at 720p, in proportion above.
  const float scale = std::max(1.0f, static_cast<float>(frame.height) / 720);
  place.line_width = 1.3f * scale * static_cast<float>(frame.supersampling);
  return place;
}

bool is_seen_from_above(const GroundPlane& ground, const View& view) {
  return dot(ground.point - view.eye, ground.normal) < 0;
}

}  // namespace neve::render
