#include "app/setup/mosaic_layout.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "app/setup/curves.h"
#include "app/setup/plan.h"

namespace neve::app::setup {

namespace {

/// Weight of a sheet twice as wide as wanted, relative to the share of gaps.
constexpr double weight_of_shape = 0.15;

const scene::View& view_called(const scene::Scene& scene, const std::string& name) {
  const auto found = std::find_if(scene.views.begin(), scene.views.end(),
                                  [&](const scene::View& view) { return view.name == name; });
  return found != scene.views.end() ? *found : scene.views.front();
}

double shape_of(const scene::PictureSize& size) {
  return static_cast<double>(size.width) / size.height;
}

/// Chooses the columns for few gaps, and about the shape of the output.
int column_count(const scene::Scene& scene, const scene::Mosaic& mosaic) {
  const int count = static_cast<int>(mosaic.views.size());
  if (mosaic.columns > 0) return std::min(count, mosaic.columns);
  double tile = 0;
  for (const std::string& name : mosaic.views)
    tile += shape_of(size_of(scene, view_called(scene, name))) / count;
  const double wanted = shape_of(scene.size);
  int best = 1;
  double least = 1e300;
  // The wider of two equally good layouts wins: three views side by side.
  for (int columns = count; columns >= 1; --columns) {
    const int rows = (count + columns - 1) / columns;
    const double empty = 1 - static_cast<double>(count) / (rows * columns);
    const double shape = std::abs(std::log(tile * columns / rows / wanted));
    const double cost = empty + weight_of_shape * shape;
    if (cost < least - 1e-9) least = cost, best = columns;
  }
  return best;
}

scene::View tile_view(const scene::Scene& scene, const std::string& name, int width) {
  scene::View view = view_called(scene, name);
  const scene::PictureSize own = size_of(scene, view);
  const int height = static_cast<int>(std::lround(1.0 * width * own.height / own.width));
  view.size = scene::PictureSize{width, std::max(height, 1)};
  view.background = scene::Background::gradient;
  std::erase(view.layers, scene::Layer::caption);
  return view;
}

}  // namespace

MosaicLayout layout_of(const scene::Scene& scene, const scene::Mosaic& mosaic, int caption_lines) {
  MosaicLayout layout;
  layout.width = mosaic.width.value_or(scene.size.width);
  layout.font_size = std::clamp(static_cast<int>(std::lround(layout.width / 80.0)), 10, 160);
  if (caption_lines > 0)
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
    const scene::View view = tile_view(scene, name, std::max(1, left_of(column + 1) - gap - x));
    row_height = std::max(row_height, view.size->height);
    layout.tiles.push_back({view, x, y});
    ++column;
  }
  layout.height = y + row_height;
  return layout;
}

int caption_lines(const scene::Scene& scene, bool has_words) {
  const bool has_more = has_words || !curves_text(scene, 0).empty() ||
                        scene.solver.on_divergence == sim::OnDivergence::ignore;
  return (scene.title.empty() ? 1 : 2) + (has_more ? 1 : 0);
}

scene::PictureSize size_of(const scene::Scene& scene, const scene::Mosaic& mosaic,
                           int caption_lines) {
  const MosaicLayout layout = layout_of(scene, mosaic, caption_lines);
  return {layout.width, layout.height};
}

}  // namespace neve::app::setup
