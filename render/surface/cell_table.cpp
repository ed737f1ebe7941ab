#include "render/surface/cell_table.h"

namespace neve::render::surface {

namespace {

constexpr int no_edge = -1;

constexpr int edge_between(int a, int b) {
  for (int edge = 0; edge < 12; ++edge) {
    const int low = low_corner(edge), high = high_corner(edge);
    if ((low == a && high == b) || (low == b && high == a)) return edge;
  }
  return no_edge;
}

using Face = std::array<int, 4>;  ///< corners, counter-clockwise from outside

constexpr std::array<Face, 6> make_faces() {
  std::array<Face, 6> faces{};
  for (int axis = 0; axis < 3; ++axis) {
    const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, far = 1 << axis;
    faces[static_cast<std::size_t>(2 * axis)] = {0, v, u | v, u};
    faces[static_cast<std::size_t>(2 * axis + 1)] = {far, far | u, far | u | v, far | v};
  }
  return faces;
}
constexpr std::array<Face, 6> faces = make_faces();

constexpr int at(const Face& face, int k) {
  return face[static_cast<std::size_t>(k & 3)];
}

constexpr bool share_a_face(int a, int b) {
  for (const Face& face : faces) {
    int found = 0;
    for (int k = 0; k < 4; ++k) {
      const int edge = edge_between(at(face, k), at(face, k + 1));
      found += (edge == a ? 1 : 0) + (edge == b ? 1 : 0);
    }
    if (found == 2) return true;
  }
  return false;
}

/// The next edge on its loop, for each edge of a cell that the surface cuts.
using NextEdges = std::array<int, 12>;

/// Around a face, each run of corners inside has one segment, from the edge where the run begins to
/// the one where it ends.
constexpr void add_segments(const Face& face, int corners, NextEdges& next) {
  const auto is_inside = [&](int k) { return (corners >> at(face, k) & 1) != 0; };
  for (int k = 0; k < 4; ++k) {
    if (is_inside(k) || !is_inside(k + 1)) continue;
    int end = k + 1;
    while (is_inside(end + 1)) ++end;
    const int enter = edge_between(at(face, k), at(face, k + 1));
    const int leave = edge_between(at(face, end), at(face, end + 1));
    next[static_cast<std::size_t>(enter)] = leave;
  }
}

struct Loop {
  int size = 0;
  std::array<int, 12> edge{};

  constexpr int at(int k) const { return edge[static_cast<std::size_t>(k % size)]; }
};

/// Takes the loop of an edge out of the list.
constexpr Loop take_loop(int edge, NextEdges& next) {
  Loop loop;
  while (next[static_cast<std::size_t>(edge)] != no_edge) {
    loop.edge[static_cast<std::size_t>(loop.size++)] = edge;
    const int after = next[static_cast<std::size_t>(edge)];
    next[static_cast<std::size_t>(edge)] = no_edge;
    edge = after;
  }
  return loop;
}

/// Finds the first corner of the loop whose fan has no diagonal in a face; there always is one.
constexpr int fan_start(const Loop& loop) {
  for (int start = 0; start < loop.size; ++start) {
    bool is_free = true;
    for (int k = 2; k + 1 < loop.size; ++k)
      is_free = is_free && !share_a_face(loop.at(start), loop.at(start + k));
    if (is_free) return start;
  }
  return no_edge;
}

constexpr CellCase make_case(int corners) {
  NextEdges next{};
  next.fill(no_edge);
  for (const Face& face : faces) add_segments(face, corners, next);
  CellCase cell;
  for (int edge = 0; edge < 12; ++edge) {
    const Loop loop = take_loop(edge, next);
    const int start = fan_start(loop);
    for (int k = 1; k + 1 < loop.size; ++k) {
      std::size_t to = std::size_t{3} * cell.triangles++;
      for (const int corner : {0, k, k + 1})
        cell.edge[to++] = static_cast<std::uint8_t>(loop.at(start + corner));
    }
  }
  return cell;
}

std::array<CellCase, 256> make_table() {
  std::array<CellCase, 256> table{};
  for (int corners = 0; corners < 256; ++corners)
    table[static_cast<std::size_t>(corners)] = make_case(corners);
  return table;
}

}  // namespace

const std::array<CellCase, 256>& cell_table() {
  static const std::array<CellCase, 256> table = make_table();
  return table;
}

}  // namespace neve::render::surface
