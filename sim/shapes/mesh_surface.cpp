#include "sim/shapes/mesh_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <limits>
#include <sstream>
#include <system_error>
#include <unsupported/Eigen/BVH>

#include "sim/files/mesh_reader.h"

namespace neve::sim::shapes {
namespace {

/// The place of a triangle that is nearest to p.
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

}  // namespace

using Box3 = Eigen::AlignedBox<double, 3>;

struct MeshSurface::Tree {
  Eigen::KdBVH<double, 3, std::uint32_t> boxes;
};

/// The search for the nearest triangle, as BVMinimize wants it.
struct MeshSurface::Nearest {
  using Scalar = double;
  const ClosedMesh& mesh;
  Vec3d p;
  double squared;  ///< m2, to the nearest so far
  Vec3d place{0, 0, 0};
  std::uint32_t triangle = std::numeric_limits<std::uint32_t>::max();

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

MeshSurface::MeshSurface(ClosedMesh mesh)
    : mesh_(std::move(mesh)), bounds_(bounds_of(mesh_)), solid_(make_mesh_solid(mesh_)) {
  std::vector<std::uint32_t> index(mesh_.triangles.size());
  std::vector<Box3> boxes(index.size());
  for (std::size_t t = 0; t < index.size(); ++t) {
    index[t] = static_cast<std::uint32_t>(t);
    for (const std::uint32_t corner : mesh_.triangles[t]) boxes[t].extend(mesh_.vertices[corner]);
  }
  auto tree = std::make_unique<Tree>();
  tree->boxes.init(index.begin(), index.end(), boxes.begin(), boxes.end());
  tree_ = std::move(tree);
}

MeshSurface::~MeshSurface() = default;

MeshSurface::Nearest MeshSurface::nearest(const Vec3d& y, double most) const {
  Nearest search{mesh_, y, most * most};
  Eigen::BVMinimize(tree_->boxes, search);
  return search;
}

MeshSurface::Place MeshSurface::nearest_place(const Vec3d& y, double most) const {
  const Nearest found = nearest(y, most);
  // Nothing is that near.
  if (found.triangle >= mesh_.triangles.size()) return nearest_place(y);
  return {std::sqrt(found.squared), found.triangle, found.place};
}

double MeshSurface::distance(const Vec3d& y, double most) const {
  return std::sqrt(nearest(y, most).squared);
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
  const auto& [a, b, c] = mesh_.triangles[found.triangle];
  return (mesh_.vertices[b] - mesh_.vertices[a])
      .cross(mesh_.vertices[c] - mesh_.vertices[a])
      .normalized();
}

std::string file_stamp(const std::string& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  const auto time = std::filesystem::last_write_time(path, error);
  return path + "|" + std::to_string(size) + "|" +
         std::to_string(error ? 0 : time.time_since_epoch().count());
}

std::shared_ptr<const MeshSurface> mesh_surface(const Mesh& mesh) {
  static Recent<MeshSurface> recent;
  std::ostringstream name;
  name.precision(17);
  name << file_stamp(mesh.file) << "|" << mesh.scale;
  return recent.get(name.str(), [&] {
    const files::PolygonMesh polygons = files::read_mesh(mesh.file);
    ClosedMesh closed = close_mesh(polygons, mesh.file);
    if (const std::size_t face = closed.crossed_face; face > 0) {
      const std::size_t line = polygons.polygons[face - 1].line;
      throw ShapeError(mesh.file + (line > 0 ? ":" + std::to_string(line) : "") + ": face " +
                       std::to_string(face) +
                       " crosses itself: it has no triangles. Triangulate the mesh");
    }
    return std::make_shared<const MeshSurface>(scaled(std::move(closed), mesh.scale, mesh.file));
  });
}

}  // namespace neve::sim::shapes
