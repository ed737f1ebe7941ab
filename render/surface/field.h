#pragma once
/// Share of each place that snow fills, on the nodes of a lattice of which only blocks of 8x8x8 are
/// there.
///
/// Particles give their volume to the nodes by quadratic B-splines, and a filter along each axis
/// spreads it further: together a kernel close to a Gaussian, whose cost does not depend on its
/// width. Inside, the shares are about 1, and they fall to 0 across the surface; a flat surface
/// lies where they are one half, however wide the kernel is. That is why the mesh encloses the
/// volume of its particles without calibration, unlike distances to particles (Zhu, Bridson 2005)
/// or to ellipsoids (Yu, Turk 2013), which need an offset that depends on how particles are packed.
/// A surface of curvature k recedes by about width^2 k / 2.

#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "render/surface/bins.h"
#include "sim/base/thread_pool.h"
#include "sim/base/vec.h"

namespace neve::render::surface {

/// Snow as far as a surface wants to see it.
struct Grains {
  std::span<const Vec3f> position;  ///< m; particles that are not finite or far off are left out
  std::span<const float> volume;    ///< m3, as deformed
};

struct Kernel {
  float cell = 0.01f;   ///< m between nodes, > 0
  float width = 0.01f;  ///< m, standard deviation along each axis, at least half a cell
};

inline constexpr int block_side = 8, block_nodes = 512;

/// Node (i, j, k) of a block is number 64 k + 8 j + i.
struct Field {
  float cell = 1;                                   ///< m
  std::vector<Vec3i> block;                         ///< in blocks from the origin; by z, then y, x
  std::vector<std::array<std::uint32_t, 27>> near;  ///< numbers of blocks around, x fastest
  std::vector<float> value;                         ///< 512 a block

  /// Value of a node by its place from the corner of a block, from -8 to 15 along each axis. 0
  /// where there is no block.
  float at(std::size_t b, int i, int j, int k) const;
};

/// A particle in its bin, side by side with those that are looked at next.
struct PlacedGrain {
  Vec3f position;  ///< m
  float volume;    ///< m3
};

struct GrainField {
  Field field;
  Bins grains;                      ///< by the block that their kernel begins in
  std::vector<PlacedGrain> placed;  ///< those of the bins
};

/// A lattice that does not fit in the memory it may have.
struct MemoryError : std::runtime_error {
  explicit MemoryError(double bytes);
  double bytes;  ///< that it would need at least
};

/// Makes a field, the same at any number of threads. All nodes beside one that is not 0 exist.
/// @param max_bytes 0: no limit @param pool may be null @throws MemoryError
GrainField make_field(const Grains& grains, const Kernel& kernel, std::uint64_t max_bytes,
                      ThreadPool* pool);

/// A place on the lattice.
struct NodePlace {
  Vec3i node;  ///< the node below
  Vec3f rest;  ///< from there, 0 to 1
};
/// @return false: not finite, or off the lattice
NEVE_INLINE bool find_node(Vec3f position, float cell, NodePlace& place) {
  for (int axis = 0; axis < 3; ++axis) {
    const double x = static_cast<double>(position[axis]) / static_cast<double>(cell);
    // Leaves room for the blocks around, which need places too.
    if (!(x > -8e6 && x < 8e6)) return false;
    const int below = floor_to_int(x);
    place.node[axis] = below;
    place.rest[axis] = static_cast<float>(x - below);
  }
  return true;
}

inline float Field::at(std::size_t b, int i, int j, int k) const {
  const int n = ((k + 8) >> 3) * 9 + ((j + 8) >> 3) * 3 + ((i + 8) >> 3);
  const std::uint32_t other = near[b][static_cast<std::size_t>(n)];
  if (other == no_block) return 0;
  const int node = (k & 7) << 6 | (j & 7) << 3 | (i & 7);
  return value[std::size_t{block_nodes} * other + static_cast<std::size_t>(node)];
}

}  // namespace neve::render::surface
