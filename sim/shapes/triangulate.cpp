#include "sim/shapes/triangulate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

namespace neve::sim::shapes {
namespace {

using Point = Eigen::Vector2d;

constexpr double tests_per_corner = 20'000;

/// Returns twice the area, with its sign.
double area_of(const Point& a, const Point& b, const Point& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

/// Length: twice the area; direction: the side from which the corners run counter-clockwise.
Vec3d normal_of(const std::vector<Vec3d>& polygon) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t k = 2; k < polygon.size(); ++k)
    sum += (polygon[k - 1] - polygon[0]).cross(polygon[k] - polygon[0]);
  return sum;
}

/// The corners seen along the normal, counter-clockwise.
std::vector<Point> flattened(const std::vector<Vec3d>& polygon) {
  const Vec3d normal = normal_of(polygon).normalized();
  const Vec3d across = normal.unitOrthogonal(), along = normal.cross(across);
  std::vector<Point> flat;
  for (const Vec3d& x : polygon)
    flat.emplace_back(across.dot(x - polygon[0]), along.dot(x - polygon[0]));
  return flat;
}

/// Corners that are left, and the test for an ear among them.
class Ears {
 public:
  explicit Ears(std::vector<Point> flat) : flat_(std::move(flat)), left_(flat_.size()) {
    std::iota(left_.begin(), left_.end(), std::size_t{0});
  }

  std::size_t left() const { return left_.size(); }

  CornerTriple around(std::size_t k) const {
    const std::size_t n = left_.size();
    return {left_[(k + n - 1) % n], left_[k], left_[(k + 1) % n]};
  }

  bool is_turned(std::size_t k) const {
    const auto [i, j, m] = around(k);
    return area_of(flat_[i], flat_[j], flat_[m]) < 0;
  }

  void cut(std::size_t k) {
    tests_ += 0.1 * static_cast<double>(left_.size() - k);  // moving is cheaper than testing
    left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(k));
  }
  double tests() const { return tests_; }

  /// @param is_flat  look for corners on a straight line instead
  bool is_ear(std::size_t k, bool is_flat) {
    tests_ += 1;
    const auto [i, j, m] = around(k);
    const Point &a = flat_[i], &b = flat_[j], &c = flat_[m];
    const double area = area_of(a, b, c), size = (b - a).squaredNorm() + (c - b).squaredNorm();
    if (is_flat) return std::abs(area) <= 1e-12 * size;
    if (!(area > 1e-12 * size)) return false;
    return std::none_of(left_.begin(), left_.end(), [&](std::size_t other) {
      tests_ += 1;
      const Point& p = flat_[other];
      // Corners in one place touch: they are no obstacle.
      if (p == a || p == b || p == c) return false;
      return area_of(a, b, p) >= 0 && area_of(b, c, p) >= 0 && area_of(c, a, p) >= 0;
    });
  }

 private:
  std::vector<Point> flat_;
  std::vector<std::size_t> left_;
  double tests_ = 0;  ///< of corners, so far
};

}  // namespace

bool is_convex(const std::vector<Vec3d>& polygon) {
  const Vec3d normal = normal_of(polygon);
  const std::size_t n = polygon.size();
  for (std::size_t k = 0; n > 3 && k < n; ++k) {
    const Vec3d &here = polygon[k], &next = polygon[(k + 1) % n], &after = polygon[(k + 2) % n];
    if ((next - here).cross(after - next).dot(normal) < -1e-6 * normal.squaredNorm()) return false;
  }
  return true;
}

std::optional<std::vector<CornerTriple>> cut_ears(const std::vector<Vec3d>& polygon) {
  Ears ears(flattened(polygon));
  std::vector<CornerTriple> triangles;
  // The search for ears takes up to the third power of the corners; it is given up before a file
  // that is twice as long takes more than twice the time.
  const double most = std::min(1e9, tests_per_corner * static_cast<double>(polygon.size()));
  while (ears.left() > 3) {
    if (ears.tests() > most) return std::nullopt;
    std::optional<std::size_t> found;
    for (const bool is_flat : {false, true})
      for (std::size_t k = 0; k < ears.left() && !found; ++k)
        if (ears.is_ear(k, is_flat)) found = k;
    if (!found) return std::nullopt;
    triangles.push_back(ears.around(*found));
    ears.cut(*found);
  }
  if (ears.is_turned(1)) return std::nullopt;
  triangles.push_back(ears.around(1));
  return triangles;
}

}  // namespace neve::sim::shapes
