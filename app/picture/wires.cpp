#include "app/picture/wires.h"

#include <algorithm>
#include <array>

#include "app/picture/to_float.h"

namespace neve::app::picture {

namespace {

using sim::Vec3d;

/// An edge of a block: the axis along it, and in blocks where it starts.
using Edge = std::array<int, 4>;

bool has_mass(const std::vector<float>& density, std::size_t block) {
  return std::any_of(density.begin() + static_cast<std::ptrdiff_t>(64 * block),
                     density.begin() + static_cast<std::ptrdiff_t>(64 * (block + 1)),
                     [](float d) { return d > 0; });
}

std::vector<Edge> edges_of(const render::NodeLattice& lattice, const std::vector<float>& density) {
  std::vector<Edge> edges;
  for (std::size_t b = 0; b < lattice.block.size(); ++b) {
    if (!has_mass(density, b)) continue;
    const Vec3i at = lattice.block[b];
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 4; ++side) {
        Vec3i start = at;
        start[(axis + 1) % 3] += side & 1;
        start[(axis + 2) % 3] += side >> 1;
        // Along the edge last, so that sorted edges of one line follow each other.
        edges.push_back({axis, start[(axis + 1) % 3], start[(axis + 2) % 3], start[axis]});
      }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace

render::Lines block_lines(const render::NodeLattice& lattice, const std::vector<float>& density) {
  const std::vector<Edge> edges = edges_of(lattice, density);
  const float side = 4 * lattice.spacing;
  render::Lines lines;
  lines.opacity = 0.35f;
  lines.width = 1;
  const auto corner = [&](const Edge& edge, int along) {
    const int axis = edge[0];
    Vec3f p;
    p[axis] = static_cast<float>(along) * side;
    p[(axis + 1) % 3] = static_cast<float>(edge[1]) * side;
    p[(axis + 2) % 3] = static_cast<float>(edge[2]) * side;
    return lattice.origin + p;
  };
  // Edges that continue one another make one line.
  for (std::size_t first = 0; first < edges.size();) {
    std::size_t next = first + 1;
    Edge expected = edges[first];
    while (++expected[3], next < edges.size() && edges[next] == expected) ++next;
    lines.ends.push_back(corner(edges[first], edges[first][3]));
    lines.ends.push_back(corner(edges[first], expected[3]));
    first = next;
  }
  return lines;
}

void append_box(const Vec3d& low, const Vec3d& high, render::Lines& lines) {
  const auto corner = [&](int k) {
    const Vec3d p(k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(),
                  k & 4 ? high.z() : low.z());
    return to_float(p);
  };
  for (int k = 0; k < 8; ++k)
    for (const int bit : {1, 2, 4})
      if (!(k & bit)) {
        lines.ends.push_back(corner(k));
        lines.ends.push_back(corner(k | bit));
      }
}

}  // namespace neve::app::picture
