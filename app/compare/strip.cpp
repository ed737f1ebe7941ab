#include "app/compare/pair_pictures.h"

#include <algorithm>
#include <cmath>

#include "render/frame/compose.h"

namespace neve::app::compare {

namespace {

using Rgb = std::array<std::uint8_t, 3>;

constexpr Rgb strip_ground{30, 33, 39}, strip_bright{240, 244, 250}, strip_soft{190, 199, 212};
constexpr int gap = 4;  // px between two pictures

int font_for(int width) {
  return std::clamp(static_cast<int>(std::lround(width / 46.0)), 12, 40);
}
int head_for(int font) {
  return static_cast<int>(std::lround(3.4 * font));
}

}  // namespace

scene::PictureSize size_with_strip(const scene::PictureSize& image, int count) {
  const int font = font_for(image.width);
  return {count * image.width + (count - 1) * gap,
          head_for(font) + image.height + static_cast<int>(std::lround(1.9 * font))};
}

render::Image with_strip(const std::vector<render::Image>& images,
                         const std::array<StripWords, 2>& words, const std::string& line,
                         render::Renderer& renderer) {
  const render::Image& first = images.front();
  const int font = font_for(first.width), head = head_for(font);
  const auto count = static_cast<int>(images.size());
  const auto [width, height] = size_with_strip({first.width, first.height}, count);
  std::vector<render::Tile> tiles;
  for (int k = 0; k < count; ++k)
    tiles.push_back({k * (first.width + gap), head, images[static_cast<std::size_t>(k)]});
  render::Frame frame;
  frame.width = width;
  frame.height = height;
  frame.font_size = font;
  const auto size = static_cast<float>(font);
  const float half = 0.5f * static_cast<float>(width), room = half - 1.6f * size;
  for (std::size_t side = 0; side < 2; ++side) {
    const float x = static_cast<float>(side) * half + 0.8f * size;
    frame.notes.push_back(
        {x, 0.4f * size, words[side].title, render::Note::Anchor::left, room, true, strip_bright});
    frame.notes.push_back(
        {x, 2.0f * size, words[side].values, render::Note::Anchor::left, room, false, strip_soft});
  }
  frame.notes.push_back({0.8f * size, static_cast<float>(head + first.height) + 0.4f * size, line,
                         render::Note::Anchor::left, static_cast<float>(width) - 1.6f * size, false,
                         strip_soft});
  return renderer.draw_over(render::compose(width, height, strip_ground, tiles), frame);
}

render::Image wiped(const render::Image& left, const render::Image& right, double share) {
  render::Image image = left;
  const int edge = std::clamp(static_cast<int>(std::lround(share * left.width)), 0, left.width);
  const auto channels = static_cast<std::size_t>(left.channels);
  for (int y = 0; y < left.height; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(left.width);
    const std::size_t from = (row + static_cast<std::size_t>(edge)) * channels,
                      end = (row + static_cast<std::size_t>(left.width)) * channels;
    std::copy(right.pixels.begin() + static_cast<std::ptrdiff_t>(from),
              right.pixels.begin() + static_cast<std::ptrdiff_t>(end),
              image.pixels.begin() + static_cast<std::ptrdiff_t>(from));
    // A line where one becomes the other.
    for (int x = std::max(0, edge - 1); x < std::min(left.width, edge + 1); ++x)
      for (std::size_t c = 0; c < std::min<std::size_t>(3, channels); ++c)
        image.pixels[(row + static_cast<std::size_t>(x)) * channels + c] = strip_bright[c];
  }
  return image;
}

render::Image opaque(render::Image image) {
  if (image.channels == 3) return image;
  const int width = image.width, height = image.height;
  return render::compose(width, height, strip_ground, {{0, 0, std::move(image)}});
}

}  // namespace neve::app::compare
