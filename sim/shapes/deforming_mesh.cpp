#include "sim/shapes/deforming_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>
#include <utility>

#include "sim/files/mesh_reader.h"
#include "sim/shapes/held_files.h"
#include "sim/shapes/mesh_edges.h"
#include "sim/shapes/numbered_files.h"
#include "sim/types/number_text.h"

namespace neve::sim::shapes {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Largest number of vertices of all files together: 384 MiB.
constexpr std::size_t max_vertices = std::size_t{1} << 24;

/// Refuses numbers without a file, all at once.
void require_files(const MeshSequence& sequence, const std::vector<std::string>& paths) {
  std::vector<int> missing;
  for (std::size_t k = 0; k < paths.size(); ++k)
    if (std::error_code error; !std::filesystem::is_regular_file(paths[k], error))
      missing.push_back(sequence.first + static_cast<int>(k));
  if (missing.empty()) return;
  constexpr std::size_t max_named = 5;
  std::string numbers;
  for (std::size_t k = 0; k < std::min(missing.size(), max_named); ++k)
    numbers += (k > 0 ? ", " : "") + std::to_string(missing[k]);
  if (missing.size() > max_named)
    numbers += " and " + std::to_string(missing.size() - max_named) + " more";
  throw ShapeError(numbered_file(sequence.files, missing.front()) +
                   ": no such file; missing of the numbers " + std::to_string(sequence.first) +
                   " to " + std::to_string(sequence.last) + ": " + numbers +
                   ". Export these files, or change first and last");
}

/// "FILE:LINE" of a polygon, or "FILE" of a format without lines.
std::string place_of(const files::PolygonMesh& mesh, std::size_t polygon, const std::string& file) {
  const std::size_t line = mesh.polygons[polygon].line;
  return file + (line > 0 ? ":" + std::to_string(line) : "");
}

void require_same_topology(const files::PolygonMesh& first, const std::string& first_file,
                           const files::PolygonMesh& mesh, const std::string& file) {
  const std::string advice = " than " + first_file +
                             ". Numbered files have the same vertices and faces in the same "
                             "order: export them without modifiers that change the topology";
  const auto count = [](std::size_t n, const char* what) { return std::to_string(n) + what; };
  if (mesh.vertices.size() != first.vertices.size())
    throw ShapeError(file + ": the mesh has " + count(mesh.vertices.size(), " vertices, other ") +
                     "topology" + advice + " (" + count(first.vertices.size(), " vertices)"));
  for (std::size_t p = 0; p < std::min(mesh.polygons.size(), first.polygons.size()); ++p) {
    const auto corners = [p](const files::PolygonMesh& m) {
      const auto at = [&](std::size_t c) {
        return m.corners.begin() + static_cast<std::ptrdiff_t>(c);
      };
      return std::pair(at(m.polygons[p].first), at(m.corner_end(p)));
    };
    const auto [a, a_end] = corners(mesh);
    const auto [b, b_end] = corners(first);
    if (!std::equal(a, a_end, b, b_end))
      throw ShapeError(place_of(mesh, p, file) + ": face " + std::to_string(p + 1) +
                       " has other corners" + advice);
  }
  if (mesh.polygons.size() != first.polygons.size())
    throw ShapeError(file + ": the mesh has " + count(mesh.polygons.size(), " faces, other ") +
                     "topology" + advice + " (" + count(first.polygons.size(), " faces)"));
}

/// Returns for each vertex the first that it coincides with in every file: vertices that only touch
/// in one of them come apart in others. Most meshes have none, and are not read again for it.
std::vector<std::uint32_t> together_in_all(const files::PolygonMesh& first,
                                           const std::vector<std::string>& paths) {
  std::vector<std::uint32_t> together = coinciding(first.vertices);
  const auto any = [&] {
    for (std::size_t v = 0; v < together.size(); ++v)
      if (together[v] != v) return true;
    return false;
  };
  for (std::size_t k = 1; k < paths.size() && any(); ++k) {
    const files::PolygonMesh mesh = files::read_mesh(paths[k]);
    require_same_topology(first, paths.front(), mesh, paths[k]);
    together = coinciding(mesh.vertices, together);
  }
  return together;
}

/// Vertices that triangles have, in the order of the file; the triangles count these alone then.
std::vector<std::uint32_t> keep_used(std::size_t count, std::vector<Triangle>& triangles) {
  constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> index(count, unused), kept;
  for (const Triangle& t : triangles)
    for (const std::uint32_t corner : t) index[corner] = 0;
  for (std::size_t v = 0; v < count; ++v)
    if (index[v] != unused) {
      index[v] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(static_cast<std::uint32_t>(v));
    }
  for (Triangle& t : triangles)
    for (std::uint32_t& corner : t) corner = index[corner];
  return kept;
}

std::vector<Vec3d> kept_vertices(const files::PolygonMesh& mesh,
                                 const std::vector<std::uint32_t>& kept, double scale) {
  std::vector<Vec3d> vertices;
  vertices.reserve(kept.size());
  for (const std::uint32_t v : kept) vertices.push_back(scale * mesh.vertices[v]);
  return vertices;
}

/// Volume in m3 and area in m2 of triangles, from a point near them: it keeps digits.
std::pair<double, double> measures(const std::vector<Vec3d>& vertices,
                                   const std::vector<Triangle>& triangles, const Vec3d& origin) {
  double volume = 0, area = 0;
  for (const auto& [i, j, k] : triangles) {
    const Vec3d a = vertices[i] - origin, b = vertices[j] - origin, c = vertices[k] - origin;
    volume += a.dot(b.cross(c)) / 6;
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  return {volume, area};
}

/// Shares of the corners of a triangle in a place on it; of one without area, of its nearest
/// corner.
Vec3d shares_of(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& point) {
  const Vec3d u = b - a, v = c - a, w = point - a;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), determinant = uu * vv - uv * uv;
  if (determinant > 1e-20 * uu * vv) {
    const double of_b = (vv * w.dot(u) - uv * w.dot(v)) / determinant;
    const double of_c = (uu * w.dot(v) - uv * w.dot(u)) / determinant;
    return {1 - of_b - of_c, of_b, of_c};
  }
  const Vec3d away(w.squaredNorm(), (point - b).squaredNorm(), (point - c).squaredNorm());
  Eigen::Index nearest = 0;
  away.minCoeff(&nearest);
  return Vec3d::Unit(nearest);
}

}  // namespace

DeformingMesh::DeformingMesh(const MeshSequence& sequence)
    : rate_(sequence.rate), start_(sequence.start) {
  const std::vector<std::string> paths = files_of(sequence);
  require_files(sequence, paths);
  const files::PolygonMesh first = files::read_mesh(paths.front());
  const SolidMesh closed =
      solid_mesh(first, paths.front(), Fill::closed, together_in_all(first, paths));
  require_faces(closed, paths.front());
  reading_ = closed.reading;
  triangles_ = scaled(closed, sequence.scale, paths.front()).triangles;
  const std::vector<std::uint32_t> kept = keep_used(first.vertices.size(), triangles_);
  if (kept.size() > max_vertices / paths.size())
    throw ShapeError(sequence.files + ": " + std::to_string(paths.size()) + " files of " +
                     std::to_string(kept.size()) + " vertices; at most " +
                     std::to_string(max_vertices) +
                     " in all are allowed. Use fewer files, or a simpler mesh");
  for (const std::string& path : paths) {
    const files::PolygonMesh mesh = path == paths.front() ? first : files::read_mesh(path);
    require_same_topology(first, paths.front(), mesh, path);
    add(kept_vertices(mesh, kept, sequence.scale), path);
  }
  measure_speeds();
}

void DeformingMesh::add(std::vector<Vec3d> vertices, const std::string& file) {
  Bounds bounds;
  for (const Vec3d& x : vertices) bounds.add(x);
  const auto [volume, area] = measures(vertices, triangles_, bounds.center());
  const double box = std::pow((bounds.max - bounds.min).maxCoeff(), 3);
  if (!std::isfinite(box) || !std::isfinite(volume) || !std::isfinite(area))
    throw ShapeError(file + ": the mesh is too large: its volume overflows. Scale it down");
  if (!(volume > 1e-14 * box))
    throw ShapeError(file + ": the mesh is flat or inside out: it encloses " + number_text(volume) +
                     " m3. Keep its faces outward as in the first file");
  if (const double thickness = 2 * volume / area; thickness < thickness_) {
    thickness_ = thickness;
    thinnest_ = file;
  }
  vertices_.push_back(std::move(vertices));
  volume_.push_back(volume);
  bounds_.push_back(bounds);
}

void DeformingMesh::measure_speeds() {
  for (std::size_t k = 0; k < intervals(); ++k) {
    double squared = 0;
    for (std::size_t v = 0; v < vertices_[k].size(); ++v)
      squared = std::max(squared, (vertices_[k + 1][v] - vertices_[k][v]).squaredNorm());
    fastest_.push_back(std::sqrt(squared) * rate_);
  }
}

DeformingMesh::Moment DeformingMesh::moment(double time) const {
  const double files = (time - start_) * rate_, last = static_cast<double>(intervals());
  if (!(files >= 0)) return {};
  if (files >= last) return {intervals() - 1, 1, false};
  const double interval = std::floor(files);
  return {static_cast<std::size_t>(interval), files - interval, true};
}

SolidMesh DeformingMesh::mesh(std::size_t interval, double part) const {
  SolidMesh mesh;
  mesh.vertices = vertices_[interval];
  mesh.triangles = triangles_;
  mesh.reading = reading_;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    mesh.vertices[v] += part * (vertices_[interval + 1][v] - vertices_[interval][v]);
  mesh.volume = measures(mesh.vertices, triangles_, mesh.vertices.front()).first;
  return mesh;
}

SolidMesh DeformingMesh::mesh_at(double time) const {
  const Moment now = moment(time);
  return mesh(now.interval, now.part);
}

Vec3d DeformingMesh::velocity(std::size_t interval, const SolidMesh& mesh, std::uint32_t triangle,
                              const Vec3d& point) const {
  const Triangle& t = triangles_[triangle];
  const Vec3d shares =
      shares_of(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], point);
  Vec3d way = Vec3d::Zero();
  for (std::size_t c = 0; c < 3; ++c)
    way += shares[static_cast<Eigen::Index>(c)] *
           (vertices_[interval + 1][t[c]] - vertices_[interval][t[c]]);
  return rate_ * way;
}

double DeformingMesh::fastest(double from, double to) const {
  const double last = static_cast<double>(intervals());
  const double begin = std::floor((from - start_) * rate_), end = (to - start_) * rate_;
  if (!(end >= 0) || !(begin < last)) return 0;
  double speed = 0;
  for (double k = std::max(begin, 0.0); k < last && k <= end; ++k)
    speed = std::max(speed, fastest_[static_cast<std::size_t>(k)]);
  return speed;
}

double DeformingMesh::fastest() const {
  return *std::max_element(fastest_.begin(), fastest_.end());
}

Bounds DeformingMesh::bounds(std::size_t interval) const {
  Bounds both = bounds_[interval];
  both.add(bounds_[interval + 1]);
  return both;
}

Bounds DeformingMesh::bounds() const {
  Bounds all;
  for (const Bounds& b : bounds_) all.add(b);
  return all;
}

double DeformingMesh::furthest() const {
  double furthest = 0;
  for (const std::vector<Vec3d>& vertices : vertices_)
    for (const Vec3d& x : vertices) furthest = std::max(furthest, x.norm());
  return furthest;
}

std::size_t DeformingMesh::bytes() const {
  return vertices_.size() * vertices_.front().size() * sizeof(Vec3d) +
         triangles_.size() * sizeof(Triangle);
}

namespace {

/// Tells sequences apart, and what was written into their files later.
std::string name_of(const MeshSequence& sequence) {
  std::ostringstream name;
  name.precision(17);
  for (int number = sequence.first; number <= sequence.last; ++number)
    name << file_stamp(numbered_file(sequence.files, number)) << "|";
  name << sequence.first << "|" << sequence.last << "|" << sequence.rate << "|" << sequence.start
       << "|" << sequence.scale;
  return name.str();
}

}  // namespace

std::shared_ptr<const DeformingMesh> deforming_mesh(const MeshSequence& sequence) {
  static Recent<DeformingMesh> recent;
  return recent.get(name_of(sequence), [&] {
    auto mesh = std::make_shared<DeformingMesh>(sequence);
    for (const std::string& file : files_of(sequence)) require_unchanged(file);
    return mesh;
  });
}

std::shared_ptr<const MeshSurface> surface_at(const MeshSequence& sequence, double time) {
  static Recent<MeshSurface> recent(Made::each_moment);
  const std::shared_ptr<const DeformingMesh> mesh = deforming_mesh(sequence);
  const DeformingMesh::Moment now = mesh->moment(time);
  std::ostringstream name;
  name.precision(17);
  name << name_of(sequence) << "|" << now.interval << "|" << now.part;
  return recent.get(name.str(), [&] {
    return std::make_shared<MeshSurface>(mesh->mesh(now.interval, now.part));
  });
}

}  // namespace neve::sim::shapes
