#include "app/picture/mosaic.h"

#include <algorithm>
#include <array>

#include "app/setup/mosaic_layout.h"
#include "render/frame/compose.h"

namespace neve::app::picture {

namespace {

constexpr std::array<std::uint8_t, 3> strip_color{38, 42, 49};

/// A title, measurements, and the overrides on a line of their own.
std::vector<std::string> strip_caption(const std::vector<std::string>& lines, bool has_title) {
  const auto joined = [&](std::size_t first, std::size_t end) {
    std::string text;
    for (std::size_t k = first; k < std::min(end, lines.size()); ++k)
      text += (text.empty() ? "" : "   \u00b7   ") + lines[k];
    return text;
  };
  std::vector<std::string> strip;
  if (lines.empty()) return strip;
  const std::size_t facts = has_title ? 1 : 0;
  if (has_title) strip.push_back(lines.front());
  strip.push_back(joined(facts, facts + 2));
  if (lines.size() > facts + 2) strip.push_back(joined(facts + 2, lines.size()));
  return strip;
}

}  // namespace

render::Image draw_mosaic(const scene::Scene& scene, const scene::Mosaic& mosaic,
                          const BuildFrame& build, const std::vector<std::string>& lines,
                          int caption_lines, render::Renderer& renderer, const DrawFrame& draw) {
  const setup::MosaicLayout layout = setup::layout_of(scene, mosaic, caption_lines);
  std::vector<render::Tile> tiles;
  for (const setup::MosaicTile& tile : layout.tiles) {
    render::Frame frame = build(tile.view);
    // The name comes before the view's own words, the counter and the slate.
    if (!lines.empty()) frame.caption.insert(frame.caption.begin(), tile.view.name);
    tiles.push_back({tile.x, tile.y, draw ? draw(tile.view, frame) : renderer.draw(frame)});
  }
  render::Frame strip;
  strip.width = layout.width;
  strip.height = layout.height;
  strip.caption = strip_caption(lines, !scene.title.empty());
  strip.caption_height = layout.caption_height;
  strip.font_size = layout.font_size;
  // Lines that only some pictures have get no room of their own: heights stay within a film.
  const auto count = static_cast<int>(strip.caption.size());
  if (count > caption_lines) strip.font_size = layout.font_size * (1 + caption_lines) / (1 + count);
  return renderer.draw_over(render::compose(layout.width, layout.height, strip_color, tiles),
                            strip);
}

}  // namespace neve::app::picture
