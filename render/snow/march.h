#pragma once
/// Finds where rays of the picture meet the surface of a body of snow: blocks in the order of their
/// distance, each with the rays that may meet it.

#include <cstdint>
#include <vector>

#include "render/cpu/draw_kernels.h"
#include "render/frame/view.h"
#include "render/light/gbuffer_tile.h"
#include "render/snow/body.h"

namespace neve::render::snow {

using cpu::TileHits;  ///< blocks are numbers in padded_block

/// A block on the picture.
struct BlockOnPicture {
  float nearest;                     ///< m along the view
  std::uint32_t padded;              ///< its number
  int x_low, x_high, y_low, y_high;  ///< samples that may see it, ends included
};

class Marcher {
 public:
  /// Both outlive it.
  Marcher(const Body& body, const View& view,
          const cpu::DrawKernels& kernels = cpu::chosen_draw_kernels());
  /// @param x, y  lower left sample of the tile
  void march_tile(int x, int y, TileHits& hits) const;

  /// Place of a hit in nodes from the corner of its block.
  Vec3f place_of(std::uint32_t padded, Vec3f from_eye) const {
    return (from_eye - corner_[padded]) * (1 / body_.field.cell);
  }
  /// Returns the ray through the middle of a sample, 1 along the view.
  Vec3f ray(int x, int y) const;

 private:
  void march_block(const BlockOnPicture& block, int x, int y, TileHits& hits) const;

  const cpu::DrawKernels& kernels_;
  const Body& body_;
  const View& view_;
  light::LaneView lane_view_;
  std::vector<Vec3f> corner_;           ///< of padded blocks, relative to the eye, m
  std::vector<BlockOnPicture> blocks_;  ///< those in view
  int columns_ = 0;
  std::vector<std::uint32_t> first_, list_;  ///< blocks of each tile, nearest first
};

}  // namespace neve::render::snow
