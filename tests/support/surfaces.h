#pragma once
/// Checks of closed meshes.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "render/frame/frame.h"

namespace neve::test {

using render::TriangleMesh;
using Vec3d3 = Vec3<double>;

inline Vec3d3 corner_of(const TriangleMesh& mesh, std::size_t corner) {
  const Vec3f p = mesh.position[mesh.index[corner]];
  return {double(p.x), double(p.y), double(p.z)};
}

/// Returns the volume; it is positive where triangles are counter-clockwise from outside.
inline double enclosed_volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t c = 0; c < mesh.index.size(); c += 3)
    sum += dot(corner_of(mesh, c), cross(corner_of(mesh, c + 1), corner_of(mesh, c + 2)));
  return sum / 6;
}

/// Edges that do not belong to exactly two triangles, which run along them in opposite directions.
inline std::size_t open_edges(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
  for (std::size_t c = 0; c < mesh.index.size(); ++c) {
    const std::uint32_t from = mesh.index[c], to = mesh.index[c % 3 == 2 ? c - 2 : c + 1];
    ++count[{from, to}];
  }
  std::size_t open = 0;
  for (const auto& [edge, n] : count) {
    const auto other = count.find({edge.second, edge.first});
    if (n != 1 || other == count.end() || other->second != 1) ++open;
  }
  return open;
}

/// Vertices whose triangles are not one fan around them. The mesh must have no open edges.
inline std::size_t pinched_vertices(const TriangleMesh& mesh) {
  // Each vertex has a ring of neighbours: after the corner `a` of a triangle comes the corner `b`.
  std::vector<std::map<std::uint32_t, std::uint32_t>> next(mesh.position.size());
  for (std::size_t c = 0; c < mesh.index.size(); ++c) {
    const std::size_t first = c - c % 3;
    next[mesh.index[c]][mesh.index[first + (c + 1) % 3]] = mesh.index[first + (c + 2) % 3];
  }
  std::size_t pinched = 0;
  for (const auto& around : next) {
    if (around.empty()) continue;
    std::size_t steps = 0;
    std::uint32_t at = around.begin()->first;
    do {
      at = around.at(at);
      ++steps;
    } while (at != around.begin()->first && steps <= around.size());
    if (steps != around.size()) ++pinched;
  }
  return pinched;
}

/// True if the segment from p to q passes through the inside of a triangle.
inline bool pierces(Vec3d3 p, Vec3d3 q, const std::array<Vec3d3, 3>& t, double tolerance) {
  const Vec3d3 n = cross(t[1] - t[0], t[2] - t[0]);
  const double from = dot(n, p - t[0]), to = dot(n, q - t[0]);
  if (!(from * to < 0)) return false;
  const Vec3d3 x = p + (from / (from - to)) * (q - p);
  for (std::size_t k = 0; k < 3; ++k)
    if (dot(cross(t[(k + 1) % 3] - t[k], x - t[k]), n) <= tolerance * dot(n, n)) return false;
  return true;
}

/// True if two triangles cross. Corners that both have do not count.
inline bool triangles_cross(const std::array<Vec3d3, 3>& a, const std::array<Vec3d3, 3>& b) {
  constexpr double tolerance = 1e-7;  // of a triangle's area: positions are in single precision
  const auto edges_pierce = [&](const auto& s, const auto& t) {
    const auto is_corner = [&](Vec3d3 x) { return std::find(t.begin(), t.end(), x) != t.end(); };
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d3 p = s[k], q = s[(k + 1) % 3];
      if (!is_corner(p) && !is_corner(q) && pierces(p, q, t, tolerance)) return true;
    }
    return false;
  };
  return edges_pierce(a, b) || edges_pierce(b, a);
}

/// Pairs of triangles of a mesh that cross. @param size of the boxes to look in, about that of a
/// triangle
inline std::size_t crossing_triangles(const TriangleMesh& mesh, double size) {
  const auto triangle = [&](std::size_t t) {
    return std::array<Vec3d3, 3>{corner_of(mesh, 3 * t), corner_of(mesh, 3 * t + 1),
                                 corner_of(mesh, 3 * t + 2)};
  };
  std::map<std::array<int, 3>, std::vector<std::size_t>> boxes;
  for (std::size_t t = 0; t < mesh.index.size() / 3; ++t) {
    std::array<int, 3> low{}, high{};
    for (int a = 0; a < 3; ++a) {
      const auto at = [&](std::size_t k) {
        return static_cast<int>(std::floor(triangle(t)[k][a] / size));
      };
      low[static_cast<std::size_t>(a)] = std::min({at(0), at(1), at(2)});
      high[static_cast<std::size_t>(a)] = std::max({at(0), at(1), at(2)});
    }
    for (int x = low[0]; x <= high[0]; ++x)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int z = low[2]; z <= high[2]; ++z) boxes[{x, y, z}].push_back(t);
  }
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (const auto& [place, list] : boxes)
    for (std::size_t i = 0; i < list.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (triangles_cross(triangle(list[i]), triangle(list[j])))
          found.emplace_back(list[i], list[j]);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found.size();
}

}  // namespace neve::test
