#pragma once
/// Layout of the views of a mosaic.

#include <vector>

#include "app/scene/scene.h"

namespace neve::app::setup {

struct MosaicTile {
  scene::View view;  ///< as it is drawn: its own size here, no caption
  int x = 0, y = 0;  ///< px, of its upper left corner
};

/// Places of all parts; the same in every frame.
struct MosaicLayout {
  int width = 0, height = 0;  ///< px
  int caption_height = 0;     ///< px, of the strip at the top
  int font_size = 0;          ///< px, of the strip
  std::vector<MosaicTile> tiles;
};

/// The width is shared evenly; each tile keeps the shape of its view, each row is as high as its
/// highest tile.
/// @param caption_lines  that have room
MosaicLayout layout_of(const scene::Scene& scene, const scene::Mosaic& mosaic, int caption_lines);

/// Lines that a caption has room for. All pictures of a film have the same, so what only some of
/// them tell does not count: it is smaller where it comes.
/// @param has_words  all tell of overrides or of a prediction
int caption_lines(const scene::Scene& scene, bool has_words);

/// The largest number of lines in a caption of any run.
inline constexpr int max_caption_lines = 3;

/// @param caption_lines  as for layout_of
scene::PictureSize size_of(const scene::Scene& scene, const scene::Mosaic& mosaic,
                           int caption_lines);

}  // namespace neve::app::setup
