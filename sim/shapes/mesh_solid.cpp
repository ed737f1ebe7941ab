#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "sim/shapes/mesh.h"

namespace neve::sim::shapes {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Which way an edge, seen along x, passes p in z on p's right: +1 upward, -1 downward, 0 not.
/// The answer for b, a is exactly minus that for a, b, so that triangles along an edge never
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

/// Winding number about p of the triangle seen along x: its sides that pass p, summed.
int winding(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p) {
  return passing(a, b, p) + passing(b, c, p) + passing(c, a, p);
}

/// Intersection of the line through p along x with the triangle. It never leaves the triangle's own
/// range, so rounding in triangles seen edge-on cannot move it further.
double meeting_x(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p) {
  const auto [low, high] = std::minmax({a.x(), b.x(), c.x()});
  const Vec3d n = (b - a).cross(c - a);
  const double x = a.x() - (n.y() * (p.y() - a.y()) + n.z() * (p.z() - a.z())) / n.x();
  return x > low ? std::min(x, high) : low;  // NaN of a degenerate triangle: low
}

/// Triangles by the cells of a grid over y and z that their bounds touch.
class Columns {
 public:
  Columns(const std::vector<Vec3d>& vertices, const std::vector<Triangle>& triangles,
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

  /// Triangles whose bounds may hold p, as a range of indices.
  std::pair<const std::uint32_t*, const std::uint32_t*> at(const Vec3d& p) const {
    const std::size_t cell = index(cell_of(p.y(), 1), cell_of(p.z(), 2));
    return {entries_.data() + first_[cell], entries_.data() + first_[cell + 1]};
  }

 private:
  static constexpr double max_cells = 4096;

  struct Range {
    int y0, y1, z0, z1;
  };

  /// Monotone, so that a point between two others is never in a cell outside theirs.
  int cell_of(double x, int axis) const {
    const double cell = (x - origin_[axis]) * per_metre_;
    const int last = cells_[static_cast<std::size_t>(axis - 1)] - 1;
    return cell > 0 ? static_cast<int>(std::min(cell, static_cast<double>(last))) : 0;
  }

  std::size_t index(int y, int z) const {
    return static_cast<std::size_t>(z) * static_cast<std::size_t>(cells_[0]) +
           static_cast<std::size_t>(y);
  }

  Range range_of(const std::vector<Vec3d>& vertices, const Triangle& t) const {
    const Vec3d &a = vertices[t[0]], &b = vertices[t[1]], &c = vertices[t[2]];
    const Vec3d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    return {cell_of(low.y(), 1), cell_of(high.y(), 1), cell_of(low.z(), 2), cell_of(high.z(), 2)};
  }

  std::size_t entry_count(const std::vector<Vec3d>& vertices,
                          const std::vector<Triangle>& triangles, std::size_t limit) const {
    std::size_t count = 0;
    for (std::size_t t = 0; t < triangles.size() && count <= limit; ++t) {
      const Range r = range_of(vertices, triangles[t]);
      count +=
          static_cast<std::size_t>(r.y1 - r.y0 + 1) * static_cast<std::size_t>(r.z1 - r.z0 + 1);
    }
    return count;
  }

  /// Counting sort of the triangles into cells.
  void fill(const std::vector<Vec3d>& vertices, const std::vector<Triangle>& triangles) {
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

  Vec3d origin_;
  double per_metre_ = 0;
  std::array<int, 2> cells_{};
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> entries_;
};

class MeshSolid final : public Form {
 public:
  explicit MeshSolid(ClosedMesh mesh)
      : mesh_(std::move(mesh)),
        bounds_(bounds_of(mesh_)),
        columns_(mesh_.vertices, mesh_.triangles, bounds_) {}

  double volume() const override { return mesh_.volume; }
  double clearance(const Vec3d&) const override { return 0; }
  Bounds bounds_after(const Mat3d& rotation) const override { return bounds_of(mesh_, rotation); }

  /// Counts the surfaces that a ray from p along +x leaves, minus those it enters.
  bool contains(const Vec3d& p) const override {
    if ((p.array() < bounds_.min.array()).any() || (p.array() > bounds_.max.array()).any())
      return false;
    int count = 0;
    const auto [begin, end] = columns_.at(p);
    for (const std::uint32_t* t = begin; t != end; ++t) {
      const auto& [a, b, c] = corners(*t);
      const int w = winding(a, b, c, p);
      if (w != 0 && meeting_x(a, b, c, p) > p.x()) count += w;
    }
    return count > 0;
  }

  Vec3d inner_point() const override;

 private:
  std::tuple<const Vec3d&, const Vec3d&, const Vec3d&> corners(std::uint32_t t) const {
    const Triangle& corner = mesh_.triangles[t];
    return {mesh_.vertices[corner[0]], mesh_.vertices[corner[1]], mesh_.vertices[corner[2]]};
  }

  /// Length of the longest stretch inside on the line through p along x; its middle goes to p.
  double longest_stretch(Vec3d& p) const;

  ClosedMesh mesh_;
  Bounds bounds_;
  Columns columns_;
};

double MeshSolid::longest_stretch(Vec3d& p) const {
  std::vector<std::pair<double, int>> meetings;
  const auto [begin, end] = columns_.at(p);
  for (const std::uint32_t* t = begin; t != end; ++t) {
    const auto& [a, b, c] = corners(*t);
    if (const int w = winding(a, b, c, p)) meetings.emplace_back(meeting_x(a, b, c, p), w);
  }
  std::sort(meetings.begin(), meetings.end());
  double longest = 0;
  int depth = 0;
  for (std::size_t k = 0; k + 1 < meetings.size(); ++k) {
    depth -= meetings[k].second;
    const double from = meetings[k].first, to = meetings[k + 1].first;
    if (depth <= 0 || to - from <= longest) continue;
    longest = to - from;
    p.x() = 0.5 * (from + to);
  }
  return longest;
}

/// Every part of the inside has a triangle around it, so the lines through the triangles' middles
/// are tried.
Vec3d MeshSolid::inner_point() const {
  double best = 0;
  Vec3d inner = Vec3d::Zero();
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    const auto& [a, b, c] = corners(t);
    Vec3d p = (a + b + c) / 3;
    const double length = longest_stretch(p);
    if (length <= best || !contains(p)) continue;
    best = length;
    inner = p;
  }
  if (best == 0) throw ShapeError("no point of the mesh is inside: every part is wound inward");
  return inner;
}

}  // namespace

std::unique_ptr<const Form> make_mesh_solid(ClosedMesh mesh) {
  return std::make_unique<MeshSolid>(std::move(mesh));
}

}  // namespace neve::sim::shapes
