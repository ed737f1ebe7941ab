#include "sim/shapes/mesh_edges.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <sstream>
#include <tuple>
#include <unordered_map>

#include "sim/base/hash.h"
#include "sim/shapes/shape.h"

namespace neve::sim::shapes {
namespace {

using Corner = std::uint32_t;

/// Vertices that are nearer than this share of the mesh's extent nearly coincide: ten times what
/// single precision and six written digits leave of a number.
constexpr double near = 1e-5;

std::vector<Corner> every_vertex(const files::PolygonMesh& mesh) {
  std::vector<Corner> vertex(mesh.vertices.size());
  std::iota(vertex.begin(), vertex.end(), Corner{0});
  return vertex;
}

/// Side of a polygon, from the vertex of the lower number to the higher or the other way round.
struct Edge {
  Corner low, high;
  std::uint32_t polygon;
  bool is_upward;
};

std::vector<Edge> sorted_edges(const files::PolygonMesh& mesh, const std::vector<Corner>& vertex) {
  std::vector<Edge> edges;
  edges.reserve(mesh.corners.size());
  std::vector<Corner> corners;
  for (std::size_t p = 0; p < mesh.polygons.size(); ++p) {
    merged_corners(mesh, vertex, p, corners);
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

/// visit(sides) for each edge, with the sides of polygons along it.
template <class Visit>
void each_edge(const std::vector<Edge>& edges, const Visit& visit) {
  for (std::size_t k = 0; k < edges.size();) {
    std::size_t end = k;
    while (end < edges.size() && edges[end].low == edges[k].low && edges[end].high == edges[k].high)
      ++end;
    visit(std::span(edges).subspan(k, end - k));
    k = end;
  }
}

/// Sets of polygons that hang together, each with the winding relative to the first of its set.
class Patches {
 public:
  explicit Patches(std::size_t count) : parent_(count), is_against_(count, false) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }

  /// The first of the set; the winding of p relative to it is known then.
  std::uint32_t root(std::uint32_t p) {
    std::uint32_t top = p;
    bool is_against = false;
    for (; parent_[top] != top; top = parent_[top]) is_against ^= is_against_[top];
    while (parent_[p] != top && p != top) {
      const std::uint32_t next = parent_[p];
      const bool rest = is_against ^ is_against_[p];
      parent_[p] = top;
      is_against_[p] = is_against;
      is_against = rest;
      p = next;
    }
    return top;
  }
  bool is_against(std::uint32_t p) { return root(p) != p && is_against_[p]; }

  /// @return whether the windings of a and b may relate so
  bool join(std::uint32_t a, std::uint32_t b, bool are_against) {
    const std::uint32_t first = root(a), second = root(b);
    const bool relation = is_against(a) ^ is_against(b) ^ are_against;
    if (first == second) return !relation;
    const auto [keep, give] = std::minmax(first, second);
    parent_[give] = keep;
    is_against_[give] = relation;
    return true;
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<bool> is_against_;  ///< relative to the parent
};

/// Defect of edges, and its count.
struct Defect {
  const char *what, *advice;
  std::size_t count = 0;
  Edge first{};  ///< of the earliest face in the file

  void add(const Edge& edge) {
    if (count++ == 0 || edge.polygon < first.polygon) first = edge;
  }
};

std::string text_of(const Defect& defect, const files::PolygonMesh& mesh, const std::string& name) {
  const Vec3d a = mesh.vertices[defect.first.low], b = mesh.vertices[defect.first.high];
  std::ostringstream text;
  text.imbue(std::locale::classic());
  const std::size_t line = mesh.polygons[defect.first.polygon].line;
  text << name << (line > 0 ? ":" + std::to_string(line) : "") << ": " << defect.what << ": "
       << defect.count << (defect.count == 1 ? " edge" : " edges") << ", the first of face "
       << defect.first.polygon + 1 << " between (" << a.x() << ", " << a.y() << ", " << a.z()
       << ") and (" << b.x() << ", " << b.y() << ", " << b.z() << "). " << defect.advice;
  return text.str();
}

/// One way to make vertices one, and the mesh that comes of it.
struct Attempt {
  MeshEdges edges;
  bool is_manifold = false;  ///< two faces along every edge
};

/// Turns the smaller share of each patch.
std::vector<bool> turned(Patches& patches, std::size_t count) {
  std::vector<std::size_t> size(count, 0), against(count, 0);
  for (std::uint32_t p = 0; p < count; ++p) {
    ++size[patches.root(p)];
    against[patches.root(p)] += patches.is_against(p);
  }
  std::vector<bool> is_turned(count);
  for (std::uint32_t p = 0; p < count; ++p) {
    const std::uint32_t root = patches.root(p);
    is_turned[p] = patches.is_against(p) == (2 * against[root] <= size[root]);
  }
  return is_turned;
}

/// Faces along an edge that run upward, less those that run downward.
template <class Turned>
int balance(std::span<const Edge> sides, const Turned& is_turned) {
  int sum = 0;
  for (const Edge& side : sides) sum += side.is_upward != is_turned[side.polygon] ? 1 : -1;
  return sum;
}

/// Patches that are not closed alone are one part with those at their open side.
void number_parts(const std::vector<Edge>& edges, Patches& patches, MeshEdges& found) {
  const std::size_t count = found.is_turned.size();
  Patches parts(count);
  std::vector<std::pair<std::uint32_t, int>> sums;  // of patches at an edge
  each_edge(edges, [&](std::span<const Edge> sides) {
    if (sides.size() < 3) return;
    sums.clear();
    for (const Edge& side : sides)
      sums.emplace_back(patches.root(side.polygon), balance(std::span(&side, 1), found.is_turned));
    // Thousands of patches may meet at an edge.
    std::sort(sums.begin(), sums.end());
    std::uint32_t first = 0;
    bool has_first = false;
    for (std::size_t k = 0; k < sums.size();) {
      const std::uint32_t patch = sums[k].first;
      int sum = 0;
      for (; k < sums.size() && sums[k].first == patch; ++k) sum += sums[k].second;
      if (sum == 0) continue;
      if (has_first) parts.join(first, patch, false);
      first = patch;
      has_first = true;
    }
  });
  constexpr std::uint32_t none = 0xffffffff;
  std::vector<std::uint32_t> number(count, none);
  found.part.resize(count);
  for (std::uint32_t p = 0; p < count; ++p) {
    std::uint32_t& n = number[parts.root(patches.root(p))];
    if (n == none) n = static_cast<std::uint32_t>(found.part_count++);
    found.part[p] = n;
  }
}

Attempt attempt(const files::PolygonMesh& mesh, const std::string& name,
                std::vector<Corner> vertex) {
  Attempt made;
  made.edges.vertex = std::move(vertex);
  const std::vector<Edge> edges = sorted_edges(mesh, made.edges.vertex);
  Defect open{"the mesh is open, these edges have a face on one side only",
              "Close the holes and merge vertices that nearly coincide"};
  Defect one_sided{"neighbouring faces cannot agree about which side is outside",
                   "Cut the mesh where it turns into its own other side"};
  Defect crowded{"the mesh is not manifold, more than two faces meet at an edge",
                 "Remove inner and duplicate faces, or move touching parts apart"};
  Patches patches(mesh.polygons.size());
  bool is_manifold = true;
  each_edge(edges, [&](std::span<const Edge> sides) {
    is_manifold = is_manifold && sides.size() == 2;
    if (sides.size() == 2 &&
        !patches.join(sides[0].polygon, sides[1].polygon, sides[0].is_upward == sides[1].is_upward))
      one_sided.add(sides[0]);
  });
  made.edges.is_turned = turned(patches, mesh.polygons.size());
  each_edge(edges, [&](std::span<const Edge> sides) {
    if (balance(sides, made.edges.is_turned) == 0) return;
    if (sides.size() != 2) (sides.size() == 1 ? open : crowded).add(sides[0]);
    made.edges.open_edges.push_back({sides[0].low, sides[0].high});
  });
  number_parts(edges, patches, made.edges);
  for (const Defect* defect : {&open, &crowded, &one_sided})
    if (defect->count > 0 && made.edges.defect.empty())
      made.edges.defect = text_of(*defect, mesh, name);
  made.is_manifold = is_manifold && made.edges.defect.empty();
  return made;
}

/// Makes vertices on open edges that nearly coincide one. @return how many
std::size_t weld_near(const files::PolygonMesh& mesh, const MeshEdges& open,
                      std::vector<Corner>& vertex) {
  Bounds box;
  for (const Corner c : mesh.corners) box.add(mesh.vertices[c]);
  const double tolerance = near * (box.max - box.min).maxCoeff();
  if (!(tolerance > 0) || !std::isfinite(tolerance)) return 0;
  const auto cell_of = [&](const Vec3d& x) {
    return ((x - box.min) / (2 * tolerance)).array().floor().cast<std::int64_t>().eval();
  };
  const auto key_of = [](std::int64_t x, std::int64_t y, std::int64_t z) {
    return mix64(static_cast<std::uint64_t>(x),
                 mix64(static_cast<std::uint64_t>(y), static_cast<std::uint64_t>(z)));
  };
  std::vector<Corner> rim;
  for (const auto& [a, b] : open.open_edges) rim.insert(rim.end(), {a, b});
  std::sort(rim.begin(), rim.end());
  rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
  std::unordered_map<std::uint64_t, Corner> kept;  // one a cell: others of the cell go to it
  std::vector<Corner> goes_to = every_vertex(mesh);
  std::size_t count = 0;
  for (const Corner v : rim) {
    const auto cell = cell_of(mesh.vertices[v]);
    bool is_near = false;
    for (int n = 0; n < 27 && !is_near; ++n) {
      const auto other =
          kept.find(key_of(cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1));
      if (other == kept.end()) continue;
      is_near = (mesh.vertices[v] - mesh.vertices[other->second]).norm() <= tolerance;
      if (is_near) goes_to[v] = other->second;
    }
    if (is_near) ++count;
    if (!is_near) kept.emplace(key_of(cell[0], cell[1], cell[2]), v);
  }
  for (Corner& v : vertex) v = goes_to[v];
  return count;
}

}  // namespace

std::vector<std::uint32_t> coinciding(const std::vector<Vec3d>& vertices,
                                      const std::vector<std::uint32_t>& among) {
  std::vector<Corner> order(vertices.size()), representative(vertices.size());
  std::iota(order.begin(), order.end(), Corner{0});
  const auto set_of = [&](Corner c) { return among.empty() ? Corner{0} : among[c]; };
  const auto key = [&](Corner c) {
    return std::tuple(set_of(c), vertices[c].x(), vertices[c].y(), vertices[c].z(), c);
  };
  std::sort(order.begin(), order.end(), [&](Corner a, Corner b) { return key(a) < key(b); });
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool is_same = k > 0 && set_of(order[k]) == set_of(order[k - 1]) &&
                         vertices[order[k]] == vertices[order[k - 1]];
    representative[order[k]] = is_same ? representative[order[k - 1]] : order[k];
  }
  return representative;
}

void merged_corners(const files::PolygonMesh& mesh, const std::vector<std::uint32_t>& vertex,
                    std::size_t polygon, std::vector<std::uint32_t>& corners) {
  corners.clear();
  for (std::size_t c = mesh.polygons[polygon].first; c < mesh.corner_end(polygon); ++c) {
    const Corner corner = vertex[mesh.corners[c]];
    if (corners.empty() || corners.back() != corner) corners.push_back(corner);
  }
  while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
}

MeshEdges find_edges(const files::PolygonMesh& mesh, const std::string& name,
                     std::vector<std::uint32_t> together) {
  Attempt welded = attempt(mesh, name, std::move(together));
  if (welded.is_manifold) return std::move(welded.edges);
  if (Attempt as_written = attempt(mesh, name, every_vertex(mesh)); as_written.is_manifold)
    return std::move(as_written.edges);
  if (welded.edges.defect.empty()) return std::move(welded.edges);
  std::vector<Corner> vertex = welded.edges.vertex;
  if (const std::size_t count = weld_near(mesh, welded.edges, vertex); count > 0) {
    Attempt near_ones = attempt(mesh, name, std::move(vertex));
    near_ones.edges.near_welds = count;
    if (near_ones.edges.open_edges.size() < welded.edges.open_edges.size())
      return std::move(near_ones.edges);
  }
  return std::move(welded.edges);
}

}  // namespace neve::sim::shapes
