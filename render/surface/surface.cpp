#include "render/surface/surface.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/frame/frame.h"
#include "render/surface/cell_table.h"
#include "render/surface/loops.h"
#include "render/surface/pieces.h"

namespace neve::render::surface {

namespace {

constexpr std::uint64_t first_column = 0x0101010101010101ull, first_row = 0xffull;

/// Nearest that a vertex comes to a node, in cells: triangles keep an area.
constexpr float min_distance = 0.01f;

/// The corners inside of the cells in a slice: bit 8 j + i is that of cell (i, j).
using Corners = std::array<std::uint64_t, 8>;

/// The bits of a node's next neighbour along x: of the block, and of the one beyond.
std::uint64_t next_along_x(std::uint64_t own, std::uint64_t beyond) {
  return (own >> 1 & ~(first_column << 7)) | (beyond & first_column) << 7;
}
std::uint64_t next_along_y(std::uint64_t own, std::uint64_t beyond) {
  return own >> 8 | (beyond & first_row) << 56;
}

/// The cells whose low corner is in a block, the edges there, and where their mesh begins.
class Cells {
 public:
  Cells(const Field& field, const std::vector<InsideBits>& inside, std::size_t b)
      : field_(field), inside_(inside), b_(b) {}

  /// True if no cell is cut.
  bool are_uniform() const {
    const InsideBits own = bits(0, 0, 0);
    const std::uint64_t first = own.slice[0];
    if (first != 0 && first != ~0ull) return false;
    for (int n = 0; n < 8; ++n) {
      const InsideBits other = bits(n & 1, n >> 1 & 1, n >> 2);
      for (const std::uint64_t slice : other.slice)
        if (slice != first) return false;
    }
    return true;
  }

  Corners corners(int k) const {
    Corners corners;
    for (int above = 0; above < 2; ++above) {
      const int z = (k + above) >> 3, slice = (k + above) & 7;
      const auto of = [&](int x, int y) {
        return bits(x, y, z).slice[static_cast<std::size_t>(slice)];
      };
      const std::uint64_t own = of(0, 0), right = next_along_x(own, of(1, 0));
      const std::size_t to = static_cast<std::size_t>(4 * above);
      corners[to] = own;
      corners[to + 1] = right;
      corners[to + 2] = next_along_y(own, of(0, 1));
      corners[to + 3] = next_along_y(right, next_along_x(of(0, 1), of(1, 1)));
    }
    return corners;
  }

 private:
  /// Gives those of a block around; empty if there is none.
  InsideBits bits(int x, int y, int z) const {
    const std::uint32_t other = field_.near[b_][static_cast<std::size_t>(13 + 9 * z + 3 * y + x)];
    return other == no_block ? InsideBits{} : inside_[other];
  }

  const Field& field_;
  const std::vector<InsideBits>& inside_;
  std::size_t b_;
};

/// Edges of a block that have a vertex: bit 8 j + i of slice k, for each axis; and the numbers of
/// these vertices, which are in the order of axes, slices, bits.
struct CutEdges {
  std::array<std::array<std::uint64_t, 8>, 3> bits{};
  std::array<std::array<std::uint16_t, 8>, 3> before{};

  std::uint32_t number(std::size_t axis, int node) const {
    const auto slice = static_cast<std::size_t>(node >> 6);
    const std::uint64_t below = (1ull << (node & 63)) - 1;
    return before[axis][slice] +
           static_cast<std::uint32_t>(std::popcount(bits[axis][slice] & below));
  }
};

/// A block that the surface goes through.
struct CutBlock {
  std::uint32_t block = 0;
  CutEdges edges;
  std::uint32_t vertices = 0, triangles = 0;
  std::size_t first_vertex = 0, first_triangle = 0;
};

int corner_bits(const Corners& corners, int cell) {
  int bits = 0;
  for (std::size_t c = 0; c < 8; ++c) bits |= static_cast<int>(corners[c] >> cell & 1) << c;
  return bits;
}

/// use(cell) for each cell of a slice that is cut.
template <class Use>
void for_cut_cells(const Corners& corners, const Use& use) {
  std::uint64_t any = 0, all = ~0ull;
  for (const std::uint64_t c : corners) {
    any |= c;
    all &= c;
  }
  for (std::uint64_t left = any & ~all; left != 0; left &= left - 1) use(std::countr_zero(left));
}

void count_block(const Cells& cells, CutBlock& cut) {
  const std::array<CellCase, 256>& table = cell_table();
  for (int k = 0; k < block_side; ++k) {
    const Corners corners = cells.corners(k);
    for (std::size_t axis = 0; axis < 3; ++axis)
      cut.edges.bits[axis][static_cast<std::size_t>(k)] = corners[0] ^ corners[1u << axis];
    for_cut_cells(corners, [&](int cell) {
      cut.triangles += table[static_cast<std::size_t>(corner_bits(corners, cell))].triangles;
    });
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t k = 0; k < block_side; ++k) {
      cut.edges.before[axis][k] = static_cast<std::uint16_t>(cut.vertices);
      cut.vertices += static_cast<std::uint32_t>(std::popcount(cut.edges.bits[axis][k]));
    }
}

/// Returns the way downhill in a field, per cell.
Vec3f fall_at(const Field& field, std::size_t b, Vec3i n) {
  const auto value = [&](int x, int y, int z) { return field.at(b, n.x + x, n.y + y, n.z + z); };
  return 0.5f * Vec3f{value(-1, 0, 0) - value(1, 0, 0), value(0, -1, 0) - value(0, 1, 0),
                      value(0, 0, -1) - value(0, 0, 1)};
}

/// A vertex on the edge from a node along an axis.
void place_vertex(const Field& field, std::size_t b, Vec3i node, int axis, Vec3f& position,
                  Vec3f& normal) {
  Vec3i next = node;
  ++next[axis];
  const float low = field.at(b, node.x, node.y, node.z), high = field.at(b, next.x, next.y, next.z);
  const float t = std::clamp((surface_share - low) / (high - low), min_distance, 1 - min_distance);
  for (int a = 0; a < 3; ++a) {
    const double place = static_cast<double>(block_side * field.block[b][a] + node[a]);
    const double along = a == axis ? static_cast<double>(t) : 0;
    position[a] = static_cast<float>(static_cast<double>(field.cell) * (place + along));
  }
  Vec3f along_edge;
  along_edge[axis] = low < high ? -1.0f : 1.0f;
  const Vec3f fall = (1 - t) * fall_at(field, b, node) + t * fall_at(field, b, next);
  const float steepness = length(fall);
  normal = steepness > 1e-12f ? fall / steepness : along_edge;
}

void write_vertices(const Field& field, const CutBlock& cut, TriangleMesh& mesh) {
  std::vector<Vec3f>&position = mesh.position.edit(), &normal = mesh.normal.edit();
  std::size_t to = cut.first_vertex;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (int k = 0; k < block_side; ++k)
      for (std::uint64_t left = cut.edges.bits[axis][static_cast<std::size_t>(k)]; left != 0;
           left &= left - 1) {
        const int n = std::countr_zero(left);
        place_vertex(field, cut.block, {n & 7, n >> 3, k}, static_cast<int>(axis), position[to],
                     normal[to]);
        ++to;
      }
}

/// Numbers of vertices in the whole mesh.
class VertexNumbers {
 public:
  VertexNumbers(const Field& field, const std::vector<CutBlock>& cuts)
      : field_(field), cuts_(cuts) {
    cut_of_.assign(field.block.size(), no_block);
    for (std::size_t c = 0; c < cuts.size(); ++c)
      cut_of_[cuts[c].block] = static_cast<std::uint32_t>(c);
  }

  /// @param edge of the cell whose low corner is a node of the block
  std::uint32_t of(std::size_t b, Vec3i node, int edge) const {
    const int corner = low_corner(edge);
    const Vec3i n = node + Vec3i{corner & 1, corner >> 1 & 1, corner >> 2};
    const int side = 13 + 9 * (n.z >> 3) + 3 * (n.y >> 3) + (n.x >> 3);
    const CutBlock& cut = cuts_[cut_of_[field_.near[b][static_cast<std::size_t>(side)]]];
    const int in_block = (n.z & 7) << 6 | (n.y & 7) << 3 | (n.x & 7);
    return static_cast<std::uint32_t>(cut.first_vertex) +
           cut.edges.number(static_cast<std::size_t>(edge / 4), in_block);
  }

 private:
  const Field& field_;
  const std::vector<CutBlock>& cuts_;
  std::vector<std::uint32_t> cut_of_;
};

void write_triangles(const Cells& cells, const CutBlock& cut, const VertexNumbers& numbers,
                     TriangleMesh& mesh) {
  const std::array<CellCase, 256>& table = cell_table();
  std::vector<std::uint32_t>& index = mesh.index.edit();
  std::size_t to = 3 * cut.first_triangle;
  for (int k = 0; k < block_side; ++k) {
    const Corners corners = cells.corners(k);
    for_cut_cells(corners, [&](int cell) {
      const CellCase& c = table[static_cast<std::size_t>(corner_bits(corners, cell))];
      for (std::size_t e = 0; e < std::size_t{3} * c.triangles; ++e)
        index[to++] = numbers.of(cut.block, {cell & 7, cell >> 3, k}, c.edge[e]);
    });
  }
}

std::vector<CutBlock> cut_blocks(const Field& field, const std::vector<InsideBits>& inside,
                                 ThreadPool* pool) {
  std::vector<std::uint8_t> is_cut(field.block.size());
  for_ranges(pool, field.block.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      is_cut[b] = Cells(field, inside, b).are_uniform() ? 0 : 1;
  });
  std::vector<CutBlock> cuts;
  for (std::size_t b = 0; b < is_cut.size(); ++b)
    if (is_cut[b]) cuts.push_back({static_cast<std::uint32_t>(b), {}, 0, 0, 0, 0});
  for_ranges(pool, cuts.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      count_block(Cells(field, inside, cuts[c].block), cuts[c]);
  });
  return cuts;
}

/// Marching cubes: a vertex on each edge of the lattice between inside and outside, where the field
/// falls to surface_share, but not at the ends; normals point along the field's fall. Triangles are
/// counter-clockwise from outside, each stays in its cell, and those of one cell do not cross: so
/// the mesh is closed, two triangles share each edge, and it does not cut itself.
/// @param inside of the field's nodes; all blocks beside a node that is inside must be there
/// Check: Surface.IsClosed..., CellTable.*
TriangleMesh triangles_of(const Field& field, const std::vector<InsideBits>& inside,
                          ThreadPool* pool) {
  std::vector<CutBlock> cuts = cut_blocks(field, inside, pool);
  std::size_t vertices = 0, triangles = 0;
  for (CutBlock& cut : cuts) {
    cut.first_vertex = vertices;
    cut.first_triangle = triangles;
    vertices += cut.vertices;
    triangles += cut.triangles;
  }
  TriangleMesh mesh;
  mesh.position.edit().resize(vertices);
  mesh.normal.edit().resize(vertices);
  mesh.index.edit().resize(3 * triangles);
  const VertexNumbers numbers(field, cuts);
  for_ranges(pool, cuts.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      write_vertices(field, cuts[c], mesh);
      write_triangles(Cells(field, inside, cuts[c].block), cuts[c], numbers, mesh);
    }
  });
  return mesh;
}

}  // namespace

Surface make_surface(const Grains& grains, const Settings& settings, ThreadPool* pool) {
  GrainField made = make_field(grains, settings.kernel, settings.max_bytes, pool);
  // A particle that sticks out of a piece, but is within the kernel's width of it, is no spray.
  const float width = settings.kernel.width / settings.kernel.cell;
  const PieceRules rules{settings.smallest_piece, static_cast<int>(std::ceil(width))};
  Pieces pieces = find_pieces(grains, made.grains, rules, made.field, pool);
  Surface surface;
  surface.mesh = triangles_of(made.field, pieces.inside, pool);
  surface.spray = std::move(pieces.loose);
  surface.pieces = pieces.count;
  return surface;
}

}  // namespace neve::render::surface
