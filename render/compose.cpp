#include "render/compose.h"

#include <algorithm>

namespace neve::render {
namespace {

std::size_t offset(const Image& image, int x, int y) {
  return static_cast<std::size_t>(image.channels) *
         (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
          static_cast<std::size_t>(x));
}

void put(const Tile& tile, Image& picture) {
  const Image& image = tile.image;
  const int left = std::max(0, -tile.x), top = std::max(0, -tile.y);
  const int right = std::min(image.width, picture.width - tile.x);
  const int bottom = std::min(image.height, picture.height - tile.y);
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      const std::uint8_t* from = image.pixels.data() + offset(image, x, y);
      std::uint8_t* to = picture.pixels.data() + offset(picture, tile.x + x, tile.y + y);
      const int alpha = image.channels == 4 ? from[3] : 255;
      for (int c = 0; c < 3; ++c)
        to[c] = static_cast<std::uint8_t>((from[c] * alpha + to[c] * (255 - alpha) + 127) / 255);
    }
}

}  // namespace

Image compose(int width, int height, std::array<std::uint8_t, 3> color,
              const std::vector<Tile>& tiles) {
  Image picture{width, height, 3, {}};
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  picture.pixels.reserve(3 * count);
  for (std::size_t i = 0; i < count; ++i)
    picture.pixels.insert(picture.pixels.end(), color.begin(), color.end());
  for (const Tile& tile : tiles) put(tile, picture);
  return picture;
}

}  // namespace neve::render
