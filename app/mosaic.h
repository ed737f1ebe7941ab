#pragma once
/// Several views in one picture, under one caption.

#include <functional>
#include <string>
#include <vector>

#include "app/frame_builder.h"
#include "app/scene/scene.h"
#include "render/renderer.h"

namespace neve::app {

struct MosaicTile {
  View view;         ///< as it is drawn: its own size here, no caption
  int x = 0, y = 0;  ///< px, of its upper left corner
};

/// Where everything goes; the same in every frame.
struct MosaicLayout {
  int width = 0, height = 0;  ///< px
  int caption_height = 0;     ///< px, of the strip at the top
  int font_size = 0;          ///< px, of the strip
  std::vector<MosaicTile> tiles;
};

/// The width is shared evenly; each tile keeps the shape of its view, each row is as high as its
/// highest tile.
/// @param caption_lines how many lines the caption will have
MosaicLayout layout_of(const Scene& scene, const Mosaic& mosaic, int caption_lines);

/// Size of the picture with the caption that a run without overrides has.
PictureSize size_of(const Scene& scene, const Mosaic& mosaic);

/// What a view shows; with rings, cause and remedy where a run diverged.
using BuildFrame = std::function<render::Frame(const View& view)>;

render::Image draw_mosaic(const Scene& scene, const Mosaic& mosaic, const FrameBuilder& builder,
                          const Snapshot& snapshot, render::Renderer& renderer);

/// The same with other frames and another caption.
render::Image draw_mosaic(const Scene& scene, const Mosaic& mosaic, const BuildFrame& build,
                          const std::vector<std::string>& caption, render::Renderer& renderer);

}  // namespace neve::app
