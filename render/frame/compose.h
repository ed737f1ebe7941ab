#pragma once
/// Pictures beside and below each other in one.

#include <array>
#include <vector>

#include "render/image/image.h"

namespace neve::render {

struct Tile {
  int x = 0, y = 0;  ///< px, of its upper left corner
  Image image;
};

/// A plain RGB picture with the tiles on it, later ones over earlier ones; parts beyond it
/// is cut off. Alpha of a tile shows the plain colour.
/// @param color sRGB
Image compose(int width, int height, std::array<std::uint8_t, 3> color,
              const std::vector<Tile>& tiles);

/// The picture made smaller; each pixel is the mean of the area that it covers.
/// @param width, height at most those of the picture, at least 1
Image shrink(const Image& picture, int width, int height);

}  // namespace neve::render
