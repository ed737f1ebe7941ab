#include "app/mosaic.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/plan.h"
#include "render/compose.h"

namespace neve::app {

namespace {

constexpr std::array<std::uint8_t, 3> strip_color{38, 42, 49};
/// How much a sheet twice as wide as wanted counts against gaps of that share of it.
constexpr double weight_of_shape = 0.15;

const View& view_called(const Scene& scene, const std::string& name) {
  const auto found = std::find_if(scene.views.begin(), scene.views.end(),
                                  [&](const View& view) { return view.name == name; });
  return found != scene.views.end() ? *found : scene.views.front();
}

double shape_of(const PictureSize& size) {
  return static_cast<double>(size.width) / size.height;
}

/// Few gaps, and about the shape of the output.
int column_count(const Scene& scene, const Mosaic& mosaic) {
  const int count = static_cast<int>(mosaic.views.size());
  if (mosaic.columns > 0) return std::min(count, mosaic.columns);
  double tile = 0;
  for (const std::string& name : mosaic.views)
    tile += shape_of(size_of(scene, view_called(scene, name))) / count;
  const double wanted = shape_of(scene.size);
  int best = 1;
  double least = 1e300;
  // Of two that are as good the wider one: three views side by side.
  for (int columns = count; columns >= 1; --columns) {
    const int rows = (count + columns - 1) / columns;
    const double empty = 1 - static_cast<double>(count) / (rows * columns);
    const double shape = std::abs(std::log(tile * columns / rows / wanted));
    const double cost = empty + weight_of_shape * shape;
    if (cost < least - 1e-9) least = cost, best = columns;
  }
  return best;
}

View tile_view(const Scene& scene, const std::string& name, int width) {
  View view = view_called(scene, name);
  const PictureSize own = size_of(scene, view);
  const int height = static_cast<int>(std::lround(1.0 * width * own.height / own.width));
  view.size = PictureSize{width, std::max(height, 1)};
  view.background = Background::gradient;
  std::erase(view.layers, Layer::caption);
  return view;
}

/// A title, what was measured, and the overrides on a line of their own.
std::vector<std::string> strip_caption(const std::vector<std::string>& lines, bool has_title) {
  const auto joined = [&](std::size_t first, std::size_t end) {
    std::string text;
    for (std::size_t k = first; k < std::min(end, lines.size()); ++k)
      text += (text.empty() ? "" : "   \u00b7   ") + lines[k];
    return text;
  };
  std::vector<std::string> strip;
  const std::size_t facts = has_title ? 1 : 0;
  if (has_title && !lines.empty()) strip.push_back(lines.front());
  strip.push_back(joined(facts, facts + 2));
  if (lines.size() > facts + 2) strip.push_back(joined(facts + 2, lines.size()));
  return strip;
}

}  // namespace

MosaicLayout layout_of(const Scene& scene, const Mosaic& mosaic, int caption_lines) {
  MosaicLayout layout;
  layout.width = mosaic.width.value_or(scene.size.width);
  layout.font_size = std::clamp(static_cast<int>(std::lround(layout.width / 80.0)), 10, 160);
  layout.caption_height =
      static_cast<int>(std::lround(layout.font_size * (1.3 + 1.3 * caption_lines)));
  const int columns = column_count(scene, mosaic), gap = std::max(2, layout.width / 400);
  // Shares of the width that add up to it: columns may differ by a pixel.
  const auto left_of = [&](int c) { return c * (layout.width + gap) / columns; };
  int y = layout.caption_height, row_height = 0, column = 0;
  for (const std::string& name : mosaic.views) {
    if (column == columns) {
      y += row_height + gap;
      row_height = column = 0;
    }
    const int x = left_of(column);
    const View view = tile_view(scene, name, std::max(1, left_of(column + 1) - gap - x));
    row_height = std::max(row_height, view.size->height);
    layout.tiles.push_back({view, x, y});
    ++column;
  }
  layout.height = y + row_height;
  return layout;
}

PictureSize size_of(const Scene& scene, const Mosaic& mosaic) {
  const MosaicLayout layout = layout_of(scene, mosaic, 2);
  return {layout.width, layout.height};
}

render::Image draw_mosaic(const Scene& scene, const Mosaic& mosaic, const FrameBuilder& builder,
                          const Snapshot& snapshot, render::Renderer& renderer) {
  return draw_mosaic(
      scene, mosaic, [&](const View& view) { return builder.build(view, snapshot); },
      builder.caption(snapshot), renderer);
}

render::Image draw_mosaic(const Scene& scene, const Mosaic& mosaic, const BuildFrame& build,
                          const std::vector<std::string>& lines, render::Renderer& renderer) {
  const std::vector<std::string> caption = strip_caption(lines, !scene.title.empty());
  const MosaicLayout layout = layout_of(scene, mosaic, static_cast<int>(caption.size()));
  std::vector<render::Tile> tiles;
  for (const MosaicTile& tile : layout.tiles) {
    render::Frame frame = build(tile.view);
    frame.caption = {tile.view.name};
    tiles.push_back({tile.x, tile.y, renderer.draw(frame)});
  }
  render::Frame strip;
  strip.width = layout.width;
  strip.height = layout.height;
  strip.caption = caption;
  strip.caption_height = layout.caption_height;
  strip.font_size = layout.font_size;
  return renderer.draw_over(render::compose(layout.width, layout.height, strip_color, tiles),
                            strip);
}

}  // namespace neve::app
