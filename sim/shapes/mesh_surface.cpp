#include "sim/shapes/mesh_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numeric>
#include <unsupported/Eigen/BVH>

namespace neve::sim::shapes {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// True if faces may have the inside, or the outside, on both of their sides.
bool has_inner_faces(const SolidMesh& mesh) {
  const MeshReading& reading = mesh.reading;
  return mesh.inside != Inside::above_half &&
         (reading.parts > 1 || reading.crossed > 0 || reading.inside_out > 0);
}

/// The pieces of triangles that have the inside on one side only. A triangle that others cross is
/// halved until its pieces are small: they end at the crossing to about this share of the mesh.
class Border {
 public:
  Border(const SolidMesh& mesh, const Form& solid, const MeshLines* lines)
      : mesh_(mesh),
        solid_(solid),
        lines_(lines),
        size_((bounds_of(mesh).max - bounds_of(mesh).min).maxCoeff()) {}

  bool all_same(std::uint32_t t) {
    const auto [a, b, c] = corners(t);
    const Vec3d middle = (a + b + c) / 3;
    constexpr std::size_t asked = 2 * (places.size() + 1);
    if (lines_) tests_ += asked * lines_->count_at(middle);
    if (tests_ > max_line_tests(mesh_.triangles.size())) return is_border_ = true;
    is_border_ = is_border(middle, a, b, c);
    for (const auto& [of_a, of_b] : places) {
      const Vec3d q = a + of_a * (b - a) + of_b * (c - a);
      if (is_border(q, a, b, c) != is_border_) return false;
    }
    return true;
  }
  bool is_border() const { return is_border_; }

  /// visit(a, b, c) for the pieces of a triangle on the border.
  template <class Visit>
  void cut(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Visit& visit) {
    const std::array sides{(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()};
    const auto longest = std::max_element(sides.begin(), sides.end());
    if (*longest <= std::pow(share * size_, 2)) {
      const Vec3d middle = (a + b + c) / 3;
      if (lines_) tests_ += 2 * lines_->count_at(middle);
      if (is_border(middle, a, b, c)) visit(a, b, c);
      return;
    }
    const auto halve = [&](const Vec3d& p, const Vec3d& q, const Vec3d& r) {
      const Vec3d middle = 0.5 * (p + q);
      cut(p, middle, r, visit);
      cut(middle, q, r, visit);
    };
    if (longest == sides.begin()) return halve(a, b, c);
    longest == sides.begin() + 1 ? halve(b, c, a) : halve(c, a, b);
  }

  std::array<Vec3d, 3> corners(std::uint32_t t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return {mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]};
  }

 private:
  static constexpr double share = 1.0 / 128;
  /// Places inside a triangle, near its corners and sides.
  static constexpr std::array<std::pair<double, double>, 6> places{
      {{0.02, 0.02}, {0.96, 0.02}, {0.02, 0.96}, {0.49, 0.02}, {0.02, 0.49}, {0.49, 0.49}}};

  bool is_border(const Vec3d& q, const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
    const Vec3d off = 1e-7 * size_ * (b - a).cross(c - a).normalized();
    return solid_.contains(q + off) != solid_.contains(q - off);
  }

  const SolidMesh& mesh_;
  const Form& solid_;
  const MeshLines* lines_;
  double size_;
  std::size_t tests_ = 0;
  bool is_border_ = false;
};

/// @param origin  becomes the triangle of each piece; stays empty where every triangle is kept
SolidMesh border_of(const SolidMesh& mesh, const Form& solid, const MeshLines* lines,
                    std::vector<std::uint32_t>& origin) {
  Border border(mesh, solid, lines);
  SolidMesh pieces;
  bool is_all = true;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = border.corners(t);
    const auto keep = [&](const Vec3d& p, const Vec3d& q, const Vec3d& r) {
      const auto first = static_cast<std::uint32_t>(pieces.vertices.size());
      pieces.vertices.insert(pieces.vertices.end(), {p, q, r});
      pieces.triangles.push_back({first, first + 1, first + 2});
      origin.push_back(t);
    };
    const bool is_same = border.all_same(t);
    is_all = is_all && is_same && border.is_border();
    // Pieces would be without number where all triangles cross all others.
    constexpr std::size_t max_pieces = 1'000'000;
    const bool is_full = pieces.triangles.size() >= max_pieces;
    if (!is_same && !is_full)
      border.cut(a, b, c, keep);
    else if (!is_same || border.is_border())
      keep(a, b, c);
  }
  if (is_all) origin.clear();
  return pieces;
}

/// Returns triangles without those that occur again, whichever way they are wound: the first of two
/// equally near ones wins, and a search would look at all of them.
std::vector<std::uint32_t> distinct(const std::vector<Triangle>& triangles) {
  const auto key = [&](std::uint32_t t) {
    Triangle corners = triangles[t];
    std::sort(corners.begin(), corners.end());
    return std::pair(corners, t);
  };
  std::vector<std::uint32_t> index(triangles.size());
  std::iota(index.begin(), index.end(), 0u);
  std::sort(index.begin(), index.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  const auto again = std::unique(index.begin(), index.end(), [&](std::uint32_t a, std::uint32_t b) {
    return key(a).first == key(b).first;
  });
  index.erase(again, index.end());
  std::sort(index.begin(), index.end());
  return index;
}

}  // namespace

/// Source: Ericson, Real-Time Collision Detection, section 5.1.5.
Vec3d nearest_on_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p) {
  const Vec3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + (d1 > d3 ? d1 / (d1 - d3) : 0.0) * ab;
  const Vec3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + (d2 > d6 ? d2 / (d2 - d6) : 0.0) * ac;
  const double va = d3 * d6 - d5 * d4;
  const double u = d4 - d3, w = d5 - d6;
  if (va <= 0 && u >= 0 && w >= 0) return b + (u + w > 0 ? u / (u + w) : 0.0) * (c - b);
  const double sum = va + vb + vc;
  return sum > 0 ? Vec3d(a + (vb / sum) * ab + (vc / sum) * ac) : a;
}

using Box3 = Eigen::AlignedBox<double, 3>;

struct MeshSurface::Tree {
  Eigen::KdBVH<double, 3, std::uint32_t> boxes;
};

/// The search for the nearest triangle, as BVMinimize wants it.
struct MeshSurface::Nearest {
  using Scalar = double;
  const SolidMesh& mesh;
  Vec3d p;
  double squared;  ///< m2, to the nearest so far
  Vec3d place{0, 0, 0};
  std::uint32_t triangle = none;

  double minimumOnVolume(const Box3& box) const {
    const double away = box.squaredExteriorDistance(p);
    return away < squared ? away : std::numeric_limits<double>::max();
  }
  double minimumOnObject(std::uint32_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3d q = nearest_on_triangle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], p);
    const double away = (p - q).squaredNorm();
    // The first of two equally near triangles wins: the result must not depend on the search order.
    if (away < squared || (away == squared && t < triangle))
      squared = away, place = q, triangle = t;
    return away;
  }
};

MeshSurface::MeshSurface(SolidMesh mesh)
    : mesh_(std::move(mesh)),
      bounds_(bounds_of(mesh_)),
      solid_(make_mesh_solid(mesh_)),
      lines_(dynamic_cast<const MeshLines*>(solid_.get())) {
  if (has_inner_faces(mesh_)) border_ = border_of(mesh_, *solid_, lines_, origin_);
  const SolidMesh& surface = origin_.empty() ? mesh_ : border_;
  const std::vector<std::uint32_t> index = distinct(surface.triangles);
  std::vector<Box3> boxes(index.size());
  for (std::size_t k = 0; k < index.size(); ++k)
    for (const std::uint32_t corner : surface.triangles[index[k]])
      boxes[k].extend(surface.vertices[corner]);
  for (const Box3& box : boxes) overlap_ += box.volume();
  const double whole = (bounds_.max - bounds_.min).prod();
  overlap_ = whole > 0 ? overlap_ / whole : 0;
  auto tree = std::make_unique<Tree>();
  tree->boxes.init(index.begin(), index.end(), boxes.begin(), boxes.end());
  tree_ = std::move(tree);
}

MeshSurface::~MeshSurface() = default;

MeshSurface::Nearest MeshSurface::nearest(const Vec3d& y, double most) const {
  Nearest search{origin_.empty() ? mesh_ : border_, y, most * most};
  Eigen::BVMinimize(tree_->boxes, search);
  return search;
}

MeshSurface::Place MeshSurface::nearest_place(const Vec3d& y, double most) const {
  const Nearest found = nearest(y, most);
  // Nothing is that near.
  if (found.triangle == none) return nearest_place(y);
  return {std::sqrt(found.squared), origin(found.triangle), found.place};
}

double MeshSurface::distance(const Vec3d& y, double most) const {
  return std::sqrt(nearest(y, most).squared);
}

void MeshSurface::inside_along_x(const Vec3d& first, double spacing,
                                 std::vector<std::uint8_t>& inside) const {
  if (lines_) return lines_->inside_along_x(first, spacing, inside);
  for (std::size_t i = 0; i < inside.size(); ++i)
    inside[i] = contains({first.x() + spacing * static_cast<double>(i), first.y(), first.z()});
}

double MeshSurface::signed_distance(const Vec3d& y) const {
  const double away = distance(y);
  return contains(y) ? -away : away;
}

Vec3d MeshSurface::normal(const Vec3d& y) const {
  const Nearest found = nearest(y, INFINITY);
  const double away = std::sqrt(found.squared);
  const double size = (bounds_.max - bounds_.min).norm();
  if (away > 1e-9 * size) return (contains(y) ? -1 : 1) * (y - found.place) / away;
  const auto& [a, b, c] = mesh_.triangles[origin(found.triangle)];
  return (mesh_.vertices[b] - mesh_.vertices[a])
      .cross(mesh_.vertices[c] - mesh_.vertices[a])
      .normalized();
}

std::shared_ptr<const MeshSurface> mesh_surface(const Mesh& mesh) {
  static Recent<MeshSurface> recent;
  return recent.get(reading_key(mesh), [&] {
    const std::shared_ptr<const SolidMesh> solid = read_solid_mesh(mesh);
    require_faces(*solid, mesh.file);
    return std::make_shared<const MeshSurface>(*solid);
  });
}

void require_faces(const SolidMesh& mesh, const std::string& file) {
  if (mesh.crossed_face == 0) return;
  const std::string line = mesh.crossed_line > 0 ? ":" + std::to_string(mesh.crossed_line) : "";
  throw ShapeError(file + line + ": face " + std::to_string(mesh.crossed_face) +
                   " crosses itself: it has no triangles. Triangulate the mesh");
}

}  // namespace neve::sim::shapes
