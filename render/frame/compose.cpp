#include "render/frame/compose.h"

#include <algorithm>
#include <cmath>

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

Image shrink(const Image& picture, int width, int height) {
  const auto channels = static_cast<std::size_t>(picture.channels);
  Image small{width, height, picture.channels, {}};
  small.pixels.reserve(channels * static_cast<std::size_t>(width) *
                       static_cast<std::size_t>(height));
  const float across = static_cast<float>(picture.width) / static_cast<float>(width),
              down = static_cast<float>(picture.height) / static_cast<float>(height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float left = static_cast<float>(x) * across, top = static_cast<float>(y) * down;
      const float right = left + across, bottom = top + down;
      float sum[4] = {}, area = 0;
      const int last_row = std::min(static_cast<int>(std::ceil(bottom)), picture.height),
                last_column = std::min(static_cast<int>(std::ceil(right)), picture.width);
      for (int row = static_cast<int>(top); row < last_row; ++row)
        for (int column = static_cast<int>(left); column < last_column; ++column) {
          const auto r = static_cast<float>(row), c = static_cast<float>(column);
          const float share = (std::min(right, c + 1) - std::max(left, c)) *
                              (std::min(bottom, r + 1) - std::max(top, r));
          const std::uint8_t* from = picture.pixels.data() + offset(picture, column, row);
          for (std::size_t k = 0; k < channels; ++k) sum[k] += share * static_cast<float>(from[k]);
          area += share;
        }
      for (std::size_t k = 0; k < channels; ++k)
        small.pixels.push_back(static_cast<std::uint8_t>(sum[k] / area + 0.5f));
    }
  return small;
}

}  // namespace neve::render
