#include "sim/shapes/mesh_columns.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace neve::sim::shapes {
namespace {

constexpr double max_cells = 4096;

/// Tells which way an edge, seen along x, passes p in z on p's right: +1 upward, -1 downward, 0
/// not. The answer for b, a is exactly minus that for a, b, so that triangles along an edge never
/// disagree about the side on which p lies, for any rounding and any position of p on the edge.
int passing(const Vec3d& a, const Vec3d& b, const Vec3d& p) {
  const bool is_upward = a.z() <= p.z() && p.z() < b.z();
  const bool is_downward = b.z() <= p.z() && p.z() < a.z();
  if (!is_upward && !is_downward) return 0;
  const Vec3d &low = is_upward ? a : b, &high = is_upward ? b : a;
  const double side =
      (high.y() - low.y()) * (p.z() - low.z()) - (p.y() - low.y()) * (high.z() - low.z());
  if (side <= 0) return 0;
  return is_upward ? 1 : -1;
}

}  // namespace

int winding(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p) {
  return passing(a, b, p) + passing(b, c, p) + passing(c, a, p);
}

double meeting_x(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p) {
  const auto [low, high] = std::minmax({a.x(), b.x(), c.x()});
  const Vec3d n = (b - a).cross(c - a);
  const double x = a.x() - (n.y() * (p.y() - a.y()) + n.z() * (p.z() - a.z())) / n.x();
  return x > low ? std::min(x, high) : low;  // NaN of a degenerate triangle: low
}

Columns::Columns(const std::vector<Vec3d>& vertices, const std::vector<Triangle>& triangles,
                 const Bounds& bounds)
    : origin_(bounds.min) {
  // About two cells per triangle; coarser if triangles are so long that the lists would explode.
  const Vec3d size = bounds.max - bounds.min;
  const double count = 2.0 * static_cast<double>(triangles.size());
  const std::size_t limit = 24 * triangles.size() + 64;
  double edge =
      std::max(std::sqrt(size.y() * size.z() / count), std::max(size.y(), size.z()) / max_cells);
  for (;; edge *= 1.5) {
    per_metre_ = 1 / edge;
    cells_ = {static_cast<int>(size.y() * per_metre_) + 1,
              static_cast<int>(size.z() * per_metre_) + 1};
    if (entry_count(vertices, triangles, limit) <= limit) break;
  }
  fill(vertices, triangles);
}

Columns::Range Columns::range_of(const std::vector<Vec3d>& vertices, const Triangle& t) const {
  const Vec3d &a = vertices[t[0]], &b = vertices[t[1]], &c = vertices[t[2]];
  const Vec3d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
  return {cell_of(low.y(), 1), cell_of(high.y(), 1), cell_of(low.z(), 2), cell_of(high.z(), 2)};
}

std::size_t Columns::entry_count(const std::vector<Vec3d>& vertices,
                                 const std::vector<Triangle>& triangles, std::size_t limit) const {
  std::size_t count = 0;
  for (std::size_t t = 0; t < triangles.size() && count <= limit; ++t) {
    const Range r = range_of(vertices, triangles[t]);
    count += static_cast<std::size_t>(r.y1 - r.y0 + 1) * static_cast<std::size_t>(r.z1 - r.z0 + 1);
  }
  return count;
}

/// Counting sort of the triangles into cells.
void Columns::fill(const std::vector<Vec3d>& vertices, const std::vector<Triangle>& triangles) {
  first_.assign(index(0, cells_[1]) + 1, 0);
  const auto each = [&](const auto& visit) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const Range r = range_of(vertices, triangles[t]);
      for (int z = r.z0; z <= r.z1; ++z)
        for (int y = r.y0; y <= r.y1; ++y) visit(index(y, z), static_cast<std::uint32_t>(t));
    }
  };
  each([&](std::size_t cell, std::uint32_t) { ++first_[cell + 1]; });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  entries_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  each([&](std::size_t cell, std::uint32_t t) { entries_[next[cell]++] = t; });
}

}  // namespace neve::sim::shapes
