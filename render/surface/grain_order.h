#pragma once
/// Particles sorted into the blocks of a field that their kernels begin in, on all threads.

#include <algorithm>
#include <vector>

#include "render/surface/field.h"

namespace neve::render::surface {

/// First node of the kernel of a particle.
NEVE_INLINE Vec3i spline_node(const NodePlace& p) {
  return {p.node.x - (p.rest.x < 0.5f ? 1 : 0), p.node.y - (p.rest.y < 0.5f ? 1 : 0),
          p.node.z - (p.rest.z < 0.5f ? 1 : 0)};
}

/// Blocks with particles, and how far in them their first nodes are.
struct Occupied {
  BlockMap map;
  struct Reach {
    Vec3i low{7, 7, 7}, high{0, 0, 0};

    void include(Vec3i from, Vec3i to) {
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], from[axis]);
        high[axis] = std::max(high[axis], to[axis]);
      }
    }
  };
  std::vector<Reach> reach;

  std::uint32_t insert(BlockKey key) {
    const std::uint32_t b = map.insert(key);
    if (b >= reach.size()) reach.resize(b + 1);
    return b;
  }
};

/// A run of particles, and the blocks that they are in.
struct Run {
  Occupied occupied;
  std::vector<std::uint32_t> count;  ///< particles in each of these blocks
  std::vector<std::uint32_t> next;   ///< where the next of them goes in the bins
};

/// The particles in runs, one for each part.
struct Runs {
  std::vector<Run> run;
  std::vector<std::uint32_t> block_of;  ///< number of its block in its run; no_block: left out

  Runs(const Grains& grains, float cell, ThreadPool* pool);
};

Occupied occupied_blocks(const Runs& runs);

/// Fills the bins. A run knows where its particles go, so all runs can go there at once.
/// @param map  of the blocks of the field
void sort_grains(const Grains& grains, Runs& runs, const BlockMap& map, ThreadPool* pool,
                 GrainField& made);

}  // namespace neve::render::surface
