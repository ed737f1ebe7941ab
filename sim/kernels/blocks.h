#pragma once
/// Blocks of 4x4x4 nodes, their keys, and the private tile of a block of particles.

#include <cstdint>

#include "sim/base/lanes.h"
#include "sim/kernels/bspline.h"

namespace neve::sim::kernels {

inline constexpr int block_side = 4, block_nodes = 64;

/// Blocks lie within +-2^20 of the lattice's zero on each axis (4 million cells): beyond is
/// overflow.
inline constexpr int block_limit = (1 << 20) - 4;

/// Sorts by x, then y, then z; moving all blocks by the same offset keeps the order.
NEVE_INLINE std::uint64_t block_key(int bx, int by, int bz) {
  constexpr std::int64_t half = 1 << 20;
  return static_cast<std::uint64_t>(bx + half) << 42 | static_cast<std::uint64_t>(by + half) << 21 |
         static_cast<std::uint64_t>(bz + half);
}
NEVE_INLINE int block_coordinate(std::uint64_t key, int axis) {
  return static_cast<int>(key >> (42 - 21 * axis) & 0x1fffff) - (1 << 20);
}

/// Nodes that the particles of one block can reach: the block and its neighbours' first layers.
/// z is padded to whole rows of four nodes.
template <int K>
struct Tile {
  static constexpr int side = block_side + K - 1;
  static constexpr int side_z = 8;
  static constexpr int nodes = side * side * side_z;
  static constexpr int node(int i, int j, int k) { return (i * side + j) * side_z + k; }
  /// Layers of the neighbour at offset 1 that a tile covers.
  static constexpr int overlap = side - block_side;
};

/// A block of particles: a range of the sorted order.
struct BlockRange {
  std::uint64_t key;
  std::uint32_t begin, end;
};

/// The same, and where its eight node blocks are stored.
struct ParticleBlock {
  std::uint64_t key;
  std::uint32_t begin, end;
  std::uint32_t node_block[8];  ///< at offset (o>>2, o>>1&1, o&1)
  /// First and last cell with particles along x and y: they reach the rows from the first on, up to
  /// K - 1 beyond the last. The rest of the tile is not used, and holds anything.
  std::uint8_t first_cell[2], last_cell[2];
};

/// Rows of a tile along an axis that are in use, in the part that lies in a node block at an
/// offset of 0 or 1, counted there.
template <int K>
NEVE_INLINE void used_rows(const ParticleBlock& block, int axis, int offset, int& begin, int& end) {
  const int start = block_side * offset, size = offset ? Tile<K>::overlap : block_side;
  begin = block.first_cell[axis] - start;
  end = block.last_cell[axis] + K - start;
  begin = begin < 0 ? 0 : begin;
  end = end > size ? size : end;
}

/// A block of nodes: which tiles reach it, in the order in which they are added. -1: none.
struct NodeBlock {
  std::uint64_t key;
  std::int32_t tile[8];  ///< of the particle block at minus the same offset
};

/// Particles of one model that share no node with others: of one block, or of two with a cell each.
/// Nodes count from the first that they reach.
struct SprayCluster {
  std::uint32_t begin[2];   ///< in the sorted order
  std::uint8_t count[2];    ///< [1]: 0 without a second block
  std::int8_t shift[2][3];  ///< from nodes of the block to those of the cluster
  std::uint8_t size[2];     ///< nodes along x and y
  std::uint8_t rows;        ///< of four nodes along z
  std::uint8_t model;
};

}  // namespace neve::sim::kernels
