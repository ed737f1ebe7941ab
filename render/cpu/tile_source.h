#pragma once
/// Another way to draw into tiles of the G-buffer than spheres, grounds and solids.

#include "render/light/gbuffer_tile.h"

namespace neve::render::cpu {

class TileSource {
 public:
  TileSource() = default;
  TileSource(const TileSource&) = delete;
  TileSource& operator=(const TileSource&) = delete;
  virtual ~TileSource() = default;
  /// Draws over a tile that holds spheres; several threads may draw a tile each.
  /// @param x, y  lower left sample of the tile
  /// @param lit  takes the light in parts too; may be null
  virtual void draw_tile(int x, int y, light::GBufferTile& tile, light::LitTile* lit) const = 0;
};

}  // namespace neve::render::cpu
