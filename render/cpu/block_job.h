#pragma once
/// Data of the kernel that finds a level of a field in a block of its nodes: plain data, as
/// splat_job.h.

#include "render/light/gbuffer_tile.h"
#include "render/light/light_job.h"
#include "sim/base/vec.h"

namespace neve::render::cpu {

/// Nodes -1 to 9 of a block of 8x8x8 cells along each axis.
inline constexpr int padded_side = 11, padded_nodes = padded_side * padded_side * padded_side;

/// First hits of the rays of a tile, rows from the bottom up.
struct TileHits {
  alignas(64) float distance[light::tile_samples];  ///< m along the view; 0: none
  alignas(64) unsigned block[light::tile_samples];  ///< number of the block that was hit
};

/// Places in the block are in nodes from its corner.
struct BlockJob {
  light::LaneView view;
  const float* padded;  ///< values, x fastest
  float level;
  float per_cell;                    ///< 1/m
  Vec3f eye;                         ///< place of the eye
  Vec3f box_low, box_high;           ///< part of the block that has the level
  float nearest;                     ///< m along the view, of that part
  unsigned number;                   ///< of the block
  int x, y;                          ///< lower left sample of the tile
  int x_low, x_high, y_low, y_high;  ///< samples of the tile that may see it, ends included
  TileHits* hits;
};

}  // namespace neve::render::cpu
