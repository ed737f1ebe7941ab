/// The map of what was learned, as numbers and as SVG.

#include <fmt/core.h>

#include <algorithm>

#include "app/pick/learned.h"

namespace neve::app::pick {

namespace {

using search::Point;

/// Blue, white, red would suggest a middle; this is one hue from dark to light.
TasteMap::Cell liking_colour(double share) {
  const auto mix = [&](double from, double to) {
    return static_cast<int>(from + (to - from) * std::clamp(share, 0.0, 1.0));
  };
  return {mix(24, 250), mix(38, 214), mix(84, 120), 1};
}

std::vector<Point> map_places(const Point& favourite, const TasteMap& map) {
  constexpr int n = TasteMap::cells;
  std::vector<Point> places;
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column) {
      Point place = favourite;
      place[static_cast<Eigen::Index>(map.y_axis)] = 1 - (row + 0.5) / n;
      place[static_cast<Eigen::Index>(map.x_axis)] = (column + 0.5) / n;
      places.push_back(std::move(place));
    }
  return places;
}

/// Opacity says how much is known: 1 where nothing is left of the first uncertainty.
std::vector<TasteMap::Cell> map_squares(const search::Preference& taste,
                                        const std::vector<Point>& places) {
  const Eigen::VectorXd liking = taste.means(places);
  const double least = liking.minCoeff(), span = std::max(1e-9, liking.maxCoeff() - least);
  std::vector<TasteMap::Cell> squares;
  for (std::size_t k = 0; k < places.size(); ++k) {
    TasteMap::Cell cell = liking_colour((liking[static_cast<Eigen::Index>(k)] - least) / span);
    const double known = 1 - taste.deviation(places[k]) / taste.smoothness().amplitude;
    cell.opacity = std::clamp(0.3 + 1.2 * known, 0.3, 1.0);
    squares.push_back(cell);
  }
  return squares;
}

}  // namespace

TasteMap taste_map(const search::Preference& taste, const std::vector<search::Round>& rounds,
                   const std::vector<AxisTaste>& tastes, const Point& favourite) {
  TasteMap map;
  map.x_axis = tastes.front().axis;
  map.y_axis = tastes[tastes.size() > 1 ? 1 : 0].axis;
  const auto x = static_cast<Eigen::Index>(map.x_axis), y = static_cast<Eigen::Index>(map.y_axis);
  map.squares = map_squares(taste, map_places(favourite, map));
  for (const search::Round& round : rounds)
    for (int k = 0; k < static_cast<int>(round.tiles.size()); ++k) {
      const Point& place = round.tiles[static_cast<std::size_t>(k)];
      const bool is_chosen =
          std::find(round.chosen.begin(), round.chosen.end(), k) != round.chosen.end();
      map.dots.push_back({place[x], place[y], is_chosen});
    }
  map.favourite_x = favourite[x];
  map.favourite_y = favourite[y];
  return map;
}

namespace {

constexpr int map_size = 480, map_left = 96, map_top = 40;

std::string svg_squares(const TasteMap& map) {
  constexpr int n = TasteMap::cells;
  constexpr double side = static_cast<double>(map_size) / n;
  std::string svg = "<g shape-rendering=\"crispEdges\">\n";
  for (int k = 0; k < n * n; ++k) {
    const TasteMap::Cell& cell = map.squares[static_cast<std::size_t>(k)];
    svg += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
        "fill=\"#{:02x}{:02x}{:02x}\" opacity=\"{:.2f}\"/>\n",
        map_left + (k % n) * side, map_top + (k / n) * side, side, side, cell.red, cell.green,
        cell.blue, cell.opacity);
  }
  return svg + "</g>\n";
}

std::string svg_dot(const TasteMap::Dot& dot) {
  return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\" stroke=\"#fff\"/>\n",
                     map_left + dot.x * map_size, map_top + (1 - dot.y) * map_size,
                     dot.is_chosen ? 5 : 3, dot.is_chosen ? "#d33" : "none");
}

std::string svg_words(const PickAxis& x, const PickAxis& y) {
  const auto text = [](double at_x, double at_y, const char* anchor, const std::string& words) {
    return fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\">{}</text>\n", at_x, at_y, anchor,
                       words);
  };
  const double bottom = map_top + map_size + 18;
  std::string svg = text(map_left, bottom, "start", short_value(x, 0)) +
                    text(map_left + map_size / 2, bottom, "middle", axis_title(x)) +
                    text(map_left + map_size, bottom, "end", short_value(x, 1));
  svg += text(
      map_left, 24, "start",
      axis_title(y) + " upwards. Light: liked; pale: little known; red: chosen; ring: favourite");
  return svg + text(map_left - 6, map_top + map_size, "end", short_value(y, 0)) +
         text(map_left - 6, map_top + 12, "end", short_value(y, 1));
}

}  // namespace

std::string map_svg(const std::vector<PickAxis>& axes, const TasteMap& map) {
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\" font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
      map_left + map_size + 24, map_top + map_size + 32);
  svg += svg_squares(map);
  for (const TasteMap::Dot& dot : map.dots) svg += svg_dot(dot);
  svg += fmt::format(
      "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"9\" fill=\"none\" stroke=\"#d33\" "
      "stroke-width=\"2\"/>\n",
      map_left + map.favourite_x * map_size, map_top + (1 - map.favourite_y) * map_size);
  return svg + svg_words(axes[map.x_axis], axes[map.y_axis]) + "</svg>\n";
}

}  // namespace neve::app::pick
