#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

#include "sim/shapes/mesh.h"
#include "sim/shapes/mesh_columns.h"
#include "sim/shapes/winding_number.h"

namespace neve::sim::shapes {
namespace {

class MeshSolid final : public Form, public MeshLines {
 public:
  explicit MeshSolid(SolidMesh mesh)
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
    return is_inside(count);
  }

  Vec3d inner_point() const override;

  std::size_t count_at(const Vec3d& p) const override {
    const auto [begin, end] = columns_.at(p);
    return static_cast<std::size_t>(end - begin);
  }
  void inside_along_x(Vec3d p, double spacing, std::vector<std::uint8_t>& inside) const override;

 private:
  std::tuple<const Vec3d&, const Vec3d&, const Vec3d&> corners(std::uint32_t t) const {
    const Triangle& corner = mesh_.triangles[t];
    return {mesh_.vertices[corner[0]], mesh_.vertices[corner[1]], mesh_.vertices[corner[2]]};
  }

  bool is_inside(int depth) const {
    return mesh_.inside == Inside::odd ? depth % 2 != 0 : depth > 0;
  }

  using Meetings = std::vector<std::pair<double, int>>;
  /// Returns the meetings of the line through p along x, by x, with the winding numbers.
  Meetings meetings(const Vec3d& p) const;
  /// Length of the longest stretch inside on the line through p along x; its middle goes to p.
  double longest_stretch(Vec3d& p) const;

  SolidMesh mesh_;
  Bounds bounds_;
  Columns columns_;
};

MeshSolid::Meetings MeshSolid::meetings(const Vec3d& p) const {
  Meetings found;
  const auto [begin, end] = columns_.at(p);
  for (const std::uint32_t* t = begin; t != end; ++t) {
    const auto& [a, b, c] = corners(*t);
    if (const int w = winding(a, b, c, p)) found.emplace_back(meeting_x(a, b, c, p), w);
  }
  std::sort(found.begin(), found.end());
  return found;
}

void MeshSolid::inside_along_x(Vec3d p, double spacing, std::vector<std::uint8_t>& inside) const {
  const Meetings found = meetings(p);
  int count = 0;  // of the faces behind the place
  for (const auto& [x, w] : found) count += w;
  const double first = p.x();
  std::size_t next = 0;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    p.x() = first + spacing * static_cast<double>(i);
    for (; next < found.size() && found[next].first <= p.x(); ++next) count -= found[next].second;
    const bool is_within =
        (p.array() >= bounds_.min.array()).all() && (p.array() <= bounds_.max.array()).all();
    inside[i] = is_within && is_inside(count);
  }
}

double MeshSolid::longest_stretch(Vec3d& p) const {
  const Meetings meetings = this->meetings(p);
  double longest = 0;
  int depth = 0;
  for (std::size_t k = 0; k + 1 < meetings.size(); ++k) {
    depth -= meetings[k].second;
    const double from = meetings[k].first, to = meetings[k + 1].first;
    if (!is_inside(depth) || to - from <= longest) continue;
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
  std::size_t tests = 0;
  const std::size_t most = max_line_tests(mesh_.triangles.size());
  for (std::uint32_t t = 0; t < mesh_.triangles.size() && (tests <= most || best == 0); ++t) {
    const auto& [a, b, c] = corners(t);
    Vec3d p = (a + b + c) / 3;
    tests += 10 * count_at(p);  // they are sorted
    const double length = longest_stretch(p);
    if (length <= best || !contains(p)) continue;
    best = length;
    inner = p;
  }
  if (best == 0) throw ShapeError("no point of the mesh is inside: every part is wound inward");
  return inner;
}

/// The inside of an open mesh.
class OpenMeshSolid final : public Form {
 public:
  explicit OpenMeshSolid(SolidMesh mesh)
      : mesh_(std::move(mesh)),
        bounds_(bounds_of(mesh_)),
        winding_(mesh_.vertices, mesh_.triangles) {}

  double volume() const override { return mesh_.volume; }
  double clearance(const Vec3d&) const override { return 0; }
  Bounds bounds_after(const Mat3d& rotation) const override { return bounds_of(mesh_, rotation); }
  bool contains(const Vec3d& p) const override {
    return (p.array() >= bounds_.min.array()).all() && (p.array() <= bounds_.max.array()).all() &&
           winding_.at(p) > 0.5;
  }
  Vec3d inner_point() const override;

 private:
  SolidMesh mesh_;
  Bounds bounds_;
  WindingNumber winding_;
};

/// The place behind a triangle that is enclosed most.
Vec3d OpenMeshSolid::inner_point() const {
  constexpr std::size_t max_tried = 4096;
  const double depth = 1e-3 * (bounds_.max - bounds_.min).minCoeff();
  const std::size_t stride = mesh_.triangles.size() / max_tried + 1;
  double best = 0.5;
  std::optional<Vec3d> inner;
  for (std::size_t t = 0; t < mesh_.triangles.size(); t += stride) {
    const auto& [i, j, k] = mesh_.triangles[t];
    const Vec3d &a = mesh_.vertices[i], &b = mesh_.vertices[j], &c = mesh_.vertices[k];
    const Vec3d p = (a + b + c) / 3 - depth * (b - a).cross(c - a).normalized();
    if (const double w = winding_.at(p); w > best && contains(p)) best = w, inner = p;
  }
  if (!inner) throw ShapeError("no point of the open mesh is inside: close its holes");
  return *inner;
}

}  // namespace

std::unique_ptr<const Form> make_mesh_solid(SolidMesh mesh) {
  if (mesh.inside == Inside::above_half) return std::make_unique<OpenMeshSolid>(std::move(mesh));
  return std::make_unique<MeshSolid>(std::move(mesh));
}

}  // namespace neve::sim::shapes
