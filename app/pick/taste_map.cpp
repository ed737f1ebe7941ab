/// The map of what was learned.

#include <algorithm>
#include <cmath>

#include "app/pick/learned.h"
#include "app/sweep/plan/labels.h"
#include "render/overlay/svg.h"

namespace neve::app::pick {

namespace {

using search::Point;
using Rgb = std::array<std::uint8_t, 3>;

constexpr int map_cells = 32;  // along each axis

/// Blue, white, red would suggest a middle; this is one hue from dark to light. White shines
/// through where little is known.
Rgb liking_colour(double share, double known) {
  const auto mix = [&](double from, double to) {
    const double colour = from + (to - from) * std::clamp(share, 0.0, 1.0);
    return static_cast<std::uint8_t>(std::lround(colour * known + 255 * (1 - known)));
  };
  return {mix(24, 250), mix(38, 214), mix(84, 120)};
}

std::vector<Point> map_places(const Point& favourite, Eigen::Index x, Eigen::Index y) {
  std::vector<Point> places;
  for (int row = 0; row < map_cells; ++row)
    for (int column = 0; column < map_cells; ++column) {
      Point place = favourite;
      place[y] = 1 - (row + 0.5) / map_cells;
      place[x] = (column + 0.5) / map_cells;
      places.push_back(std::move(place));
    }
  return places;
}

std::vector<Rgb> map_colours(const search::Preference& taste, const std::vector<Point>& places) {
  const Eigen::VectorXd liking = taste.means(places);
  const double least = liking.minCoeff(), span = std::max(1e-9, liking.maxCoeff() - least);
  std::vector<Rgb> colours;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double known = 1 - taste.deviation(places[k]) / taste.smoothness().amplitude;
    colours.push_back(liking_colour((liking[static_cast<Eigen::Index>(k)] - least) / span,
                                    std::clamp(0.3 + 1.2 * known, 0.3, 1.0)));
  }
  return colours;
}

void add_dot(const Point& place, Eigen::Index x, Eigen::Index y, render::PlotSeries& series) {
  series.x.push_back(static_cast<float>(place[x]));
  series.value.push_back(static_cast<float>(place[y]));
}

}  // namespace

render::Plot taste_map(const std::vector<PickAxis>& axes, const search::Preference& taste,
                       const std::vector<search::Round>& rounds,
                       const std::vector<AxisTaste>& tastes, const Point& favourite) {
  constexpr Rgb red{214, 40, 40}, dark{20, 24, 34};
  const PickAxis &across = axes[tastes.front().axis],
                 &upwards = axes[tastes[tastes.size() > 1 ? 1 : 0].axis];
  const auto x = &across - axes.data(), y = &upwards - axes.data();
  render::PlotSeries best{.name = {}, .color = red, .x = {}, .value = {}},
      chosen{.name = {}, .color = red, .x = {}, .value = {}},
      others{.name = {}, .color = dark, .x = {}, .value = {}};
  best.dot_radius = 10.5f;
  chosen.dot_radius = 5;
  others.dot_radius = 3.5f;
  best.has_rings = others.has_rings = true;
  add_dot(favourite, x, y, best);
  for (const search::Round& round : rounds)
    for (int k = 0; k < static_cast<int>(round.tiles.size()); ++k) {
      const bool is_chosen =
          std::find(round.chosen.begin(), round.chosen.end(), k) != round.chosen.end();
      add_dot(round.tiles[static_cast<std::size_t>(k)], x, y, is_chosen ? chosen : others);
    }
  render::Plot map;
  map.title = sweep::plan::titled(upwards.name, upwards.unit) + ", upwards";
  map.x_title = sweep::plan::titled(across.name, across.unit);
  map.x_unit.clear();
  map.x_ticks = {{0, short_value(across, 0)}, {1, short_value(across, 1)}};
  map.ticks = {{0, short_value(upwards, 0)}, {1, short_value(upwards, 1)}};
  map.cell_columns = map_cells;
  map.cells = map_colours(taste, map_places(favourite, x, y));
  map.series = {best, chosen, others};
  return map;
}

std::string map_svg(const render::Plot& map) {
  constexpr float font = 15, left = 96, top = 40, side = 480;
  render::overlay::SvgCanvas canvas(font);
  render::overlay::draw_plot(map, {left, left + side, top, top + side}, {}, canvas);
  canvas.text({left, top + side + 3.2f * font}, render::Note::Anchor::left, {205, 213, 224, 255},
              map_words);
  return canvas.drawing(left + side + 40, top + side + 5 * font, false);
}

}  // namespace neve::app::pick
