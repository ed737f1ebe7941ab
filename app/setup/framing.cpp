#include "app/setup/framing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "app/setup/camera_path.h"

namespace neve::app::setup {

using sim::Vec3d;

namespace {

/// Directions of the picture.
struct Axes {
  Vec3d right, up;
  Axes(const Vec3d& towards_eye, const Lens& lens) : right(lens.up.cross(towards_eye)) {
    if (right.norm() < 1e-6) right = towards_eye.unitOrthogonal();
    right.normalize();
    up = towards_eye.cross(right);
  }
};

}  // namespace

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

Box box_of(const std::vector<Vec3d>& points) {
  Box box;
  for (const Vec3d& x : points) box.add(x);
  return box;
}

Vec3d median(const std::vector<Vec3d>& points) {
  Vec3d result;
  std::vector<double> values(points.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(points.begin(), points.end(), values.begin(),
                   [&](const Vec3d& x) { return x[axis]; });
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    result[axis] = *middle;
  }
  return result;
}

std::vector<Vec3d> without_outliers(std::vector<Vec3d> points, double share) {
  std::erase_if(points, [](const Vec3d& x) { return !x.allFinite(); });
  if (points.empty()) return points;
  const Vec3d middle = median(points);
  const auto kept = static_cast<std::ptrdiff_t>(static_cast<double>(points.size()) * (1 - share));
  std::nth_element(points.begin(), points.begin() + kept, points.end(),
                   [&](const Vec3d& a, const Vec3d& b) {
                     return (a - middle).squaredNorm() < (b - middle).squaredNorm();
                   });
  points.resize(static_cast<std::size_t>(std::max<std::ptrdiff_t>(kept, 1)));
  return points;
}

std::vector<Vec3d> scattered(std::vector<Vec3d> points, double factor) {
  if (points.empty()) return points;
  const Vec3d middle = median(points);
  for (Vec3d& x : points)
    for (const int axis : {0, 2}) x[axis] = middle[axis] + factor * (x[axis] - middle[axis]);
  return points;
}

std::vector<Vec3d> turned_backwards(const std::vector<Vec3d>& points, const Vec3d& middle,
                                    const Lens& lens) {
  if (!lens.is_turning()) return points;
  std::vector<Vec3d> seen;
  seen.reserve(points.size() * lens.turns.size());
  for (const double turn : lens.turns)
    for (const Vec3d& x : points) seen.push_back(middle + turn_about(lens.up, -turn, x - middle));
  return seen;
}

Extent extent_of(const std::vector<Vec3d>& points, const Shot& shot, const Lens& lens) {
  const Axes axes(shot.towards_eye, lens);
  const Framing& framing = shot.framing;
  Extent extent;
  for (const Vec3d& point : points) {
    const Vec3d q = point - framing.target;
    const double depth =
        std::max(framing.distance - q.dot(shot.towards_eye), 0.1 * framing.distance);
    const double x = q.dot(axes.right) / (depth * lens.slope * lens.aspect),
                 y = q.dot(axes.up) / (depth * lens.slope);
    extent.left = std::min(extent.left, x), extent.right = std::max(extent.right, x);
    extent.bottom = std::min(extent.bottom, y), extent.top = std::max(extent.top, y);
  }
  return extent;
}

Framing fit(const std::vector<Vec3d>& points, const Vec3d& middle, const Vec3d& towards_eye,
            const Lens& lens) {
  const Axes axes(towards_eye, lens);
  const double t = lens.slope, aspect = lens.aspect;
  // Nearer, a wide lens would have points behind it, and end in one of them.
  const double least = std::max(0.5 * box_of(points).diagonal(), 1e-3);
  Framing framing{middle, std::max(2 * box_of(points).diagonal() / t, least)};
  for (int round = 0; round < 30; ++round) {
    auto [left, rightmost, bottom, top] = extent_of(points, {framing, towards_eye}, lens);
    const double reach = t * framing.distance;
    if (lens.is_turning()) {
      framing.target += 0.5 * (bottom + top) * reach * lens.up;
      rightmost = std::max(rightmost, -left), left = -rightmost;
    } else {
      framing.target += 0.5 * ((left + rightmost) * aspect * reach * axes.right +
                               (bottom + top) * reach * axes.up);
    }
    const double share = 0.5 * std::max(rightmost - left, top - bottom);
    framing.distance =
        std::max(framing.distance * std::clamp(share / lens.filled, 0.5, 2.0), least);
  }
  return framing;
}

Framing between(const Framing& from, const Framing& to, double part) {
  return {from.target + part * (to.target - from.target),
          from.distance + part * (to.distance - from.distance)};
}

}  // namespace neve::app::setup
