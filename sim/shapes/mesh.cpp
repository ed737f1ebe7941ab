#include "sim/shapes/mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <tuple>
#include <utility>

#include "sim/files/mesh_reader.h"
#include "sim/shapes/mesh_surface.h"
#include "sim/shapes/triangulate.h"
#include "sim/types/number_text.h"

namespace neve::sim::shapes {
namespace {

using Corner = std::uint32_t;

/// m, across a mesh: cells are no smaller.
constexpr double min_extent = 1e-9;

/// For every vertex the first one at the same position.
std::vector<Corner> weld(const std::vector<Vec3d>& vertices) {
  std::vector<Corner> order(vertices.size()), representative(vertices.size());
  std::iota(order.begin(), order.end(), Corner{0});
  const auto key = [&](Corner c) {
    return std::tuple(vertices[c].x(), vertices[c].y(), vertices[c].z(), c);
  };
  std::sort(order.begin(), order.end(), [&](Corner a, Corner b) { return key(a) < key(b); });
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool is_same = k > 0 && vertices[order[k]] == vertices[order[k - 1]];
    representative[order[k]] = is_same ? representative[order[k - 1]] : order[k];
  }
  return representative;
}

/// The corners of a polygon, welded, without those that repeat their neighbour.
void welded_corners(const files::PolygonMesh& mesh, const std::vector<Corner>& representative,
                    std::size_t polygon, std::vector<Corner>& corners) {
  corners.clear();
  for (std::size_t c = mesh.polygons[polygon].first; c < mesh.corner_end(polygon); ++c) {
    const Corner corner = representative[mesh.corners[c]];
    if (corners.empty() || corners.back() != corner) corners.push_back(corner);
  }
  while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
}

/// Side of a polygon, from the vertex of the lower number to the higher or the other way round.
struct Edge {
  Corner low, high;
  std::uint32_t polygon;
  bool is_upward;
};

std::vector<Edge> sorted_edges(const files::PolygonMesh& mesh,
                               const std::vector<Corner>& representative) {
  std::vector<Edge> edges;
  edges.reserve(mesh.corners.size());
  std::vector<Corner> corners;
  for (std::size_t p = 0; p < mesh.polygons.size(); ++p) {
    welded_corners(mesh, representative, p, corners);
    if (corners.size() < 3) continue;  // no area; its neighbours meet along the one edge it has
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Corner a = corners[k], b = corners[(k + 1) % corners.size()];
      edges.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(p), a < b});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.polygon) < std::tie(b.low, b.high, b.polygon);
  });
  return edges;
}

/// Defect of edges, and its count.
struct Defect {
  std::string what, advice;
  std::size_t count = 0;
  Edge first{};  ///< of the earliest face in the file

  void add(const Edge& edge) {
    if (count++ == 0 || edge.polygon < first.polygon) first = edge;
  }
};

[[noreturn]] void report(const Defect& defect, const files::PolygonMesh& mesh,
                         const std::string& name) {
  const Vec3d a = mesh.vertices[defect.first.low], b = mesh.vertices[defect.first.high];
  std::ostringstream text;
  text.imbue(std::locale::classic());
  const std::size_t line = mesh.polygons[defect.first.polygon].line;
  text << name << (line > 0 ? ":" + std::to_string(line) : "") << ": " << defect.what << ": "
       << defect.count << (defect.count == 1 ? " edge" : " edges") << ", the first of face "
       << defect.first.polygon + 1 << " between (" << a.x() << ", " << a.y() << ", " << a.z()
       << ") and (" << b.x() << ", " << b.y() << ", " << b.z() << "). " << defect.advice;
  throw ShapeError(text.str());
}

void check_edges(const files::PolygonMesh& mesh, const std::vector<Edge>& edges,
                 const std::string& name) {
  Defect open{"the mesh is open, these edges have a face on one side only",
              "Close the holes and merge vertices that nearly coincide"};
  Defect turned{"neighbouring faces disagree about which side is outside",
                "Recalculate the normals so that all faces are wound the same way"};
  Defect crowded{"the mesh is not manifold, more than two faces meet at an edge",
                 "Remove inner and duplicate faces, or move touching parts apart"};
  for (std::size_t k = 0; k < edges.size();) {
    std::size_t end = k;
    while (end < edges.size() && edges[end].low == edges[k].low && edges[end].high == edges[k].high)
      ++end;
    if (end - k == 1) open.add(edges[k]);
    if (end - k == 2 && edges[k].is_upward == edges[k + 1].is_upward) turned.add(edges[k]);
    if (end - k > 2) crowded.add(edges[k]);
    k = end;
  }
  for (const Defect* defect : {&crowded, &open, &turned})
    if (defect->count > 0) report(*defect, mesh, name);
}

/// @return whether the triangles cover the polygon and nothing else
bool add_triangles(const std::vector<Corner>& corners, ClosedMesh& closed) {
  std::vector<Vec3d> polygon;
  for (const Corner corner : corners) polygon.push_back(closed.vertices[corner]);
  if (corners.size() > 3 && !is_convex(polygon))
    if (const auto triangles = cut_ears(polygon)) {
      for (const auto& [i, j, k] : *triangles)
        closed.triangles.push_back({corners[i], corners[j], corners[k]});
      return true;
    }
  // A fan is right for winding numbers and volumes even where sides cross: triangles that overlap
  // are wound in opposite directions and cancel.
  for (std::size_t k = 2; k < corners.size(); ++k)
    closed.triangles.push_back({corners[0], corners[k - 1], corners[k]});
  return corners.size() <= 3 || is_convex(polygon);
}

}  // namespace

Bounds bounds_of(const ClosedMesh& mesh, const Mat3d& rotation) {
  Bounds b{Vec3d::Constant(INFINITY), Vec3d::Constant(-INFINITY)};
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) {
      const Vec3d x = rotation * mesh.vertices[corner];
      b.min = b.min.cwiseMin(x);
      b.max = b.max.cwiseMax(x);
    }
  return b;
}

ClosedMesh close_mesh(const files::PolygonMesh& mesh, const std::string& name) {
  const std::vector<Corner> representative = weld(mesh.vertices);
  check_edges(mesh, sorted_edges(mesh, representative), name);

  ClosedMesh closed{mesh.vertices, {}, 0, 0};
  std::vector<Corner> corners;
  for (std::size_t p = 0; p < mesh.polygons.size(); ++p) {
    welded_corners(mesh, representative, p, corners);
    if (!add_triangles(corners, closed) && closed.crossed_face == 0) closed.crossed_face = p + 1;
  }

  if (closed.triangles.empty())
    throw ShapeError(name + ": no face has an area: the corners of each face coincide");
  const Bounds b = bounds_of(closed);
  const Vec3d origin = 0.5 * (b.min + b.max);  // keeps digits of meshes far from their origin
  for (const auto& [i, j, k] : closed.triangles) {
    const Vec3d u = closed.vertices[i] - origin, v = closed.vertices[j] - origin;
    closed.volume += u.dot(v.cross(closed.vertices[k] - origin)) / 6;
  }
  const double box = std::pow((b.max - b.min).maxCoeff(), 3);
  if (!std::isfinite(closed.volume) || !std::isfinite(box))
    throw ShapeError(name + ": the mesh is too large: its volume overflows. Scale it down");
  if (std::abs(closed.volume) <= 1e-14 * box)
    throw ShapeError(name + ": the mesh is flat: it encloses no volume. Give it thickness");
  if (closed.volume < 0) {
    for (auto& t : closed.triangles) std::swap(t[1], t[2]);
    closed.volume = -closed.volume;
  }
  return closed;
}

ClosedMesh scaled(ClosedMesh mesh, double scale, const std::string& name) {
  if (!(scale > 0) || !std::isfinite(scale))
    throw ShapeError(name + ": the scale of a mesh must be a finite number above 0");
  for (Vec3d& x : mesh.vertices) x *= scale;
  mesh.volume *= scale * scale * scale;
  const Bounds b = bounds_of(mesh);
  const double across = (b.max - b.min).maxCoeff();
  const std::string what = name + ": with scale = " + number_text(scale) + " the mesh is ";
  if (!std::isfinite(mesh.volume) || !std::isfinite(across))
    throw ShapeError(what +
                     "too large: its volume overflows. scale is metres per unit of the file");
  if (!(across >= min_extent && mesh.volume > 0))
    throw ShapeError(what + number_text(across) + " m across; expected at least " +
                     number_text(min_extent) + " m. scale is metres per unit of the file");
  return mesh;
}

std::shared_ptr<const Form> read_mesh_solid(const std::string& path, double scale) {
  static Recent<Form> recent;
  return recent.get(file_stamp(path) + "|" + number_text(scale, 17), [&] {
    return make_mesh_solid(scaled(close_mesh(files::read_mesh(path), path), scale, path));
  });
}

}  // namespace neve::sim::shapes
