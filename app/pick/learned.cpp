#include "app/pick/learned.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace neve::app::pick {

namespace {

using search::Point;

/// Places along an axis through the favourite.
constexpr int places_along = 41;

std::vector<Point> line_through(const Point& favourite, std::size_t axis) {
  std::vector<Point> line(places_along, favourite);
  for (int k = 0; k < places_along; ++k)
    line[static_cast<std::size_t>(k)][static_cast<Eigen::Index>(axis)] =
        static_cast<double>(k) / (places_along - 1);
  return line;
}

AxisTaste taste_along(const search::Preference& taste, const Point& favourite, std::size_t axis) {
  const std::vector<Point> line = line_through(favourite, axis);
  const Eigen::VectorXd liking = taste.means(line);
  const Eigen::VectorXd perhaps =
      liking + taste.covariances(line).diagonal().cwiseMax(0).cwiseSqrt();
  AxisTaste found;
  found.axis = axis;
  found.effect = liking.maxCoeff() - liking.minCoeff();
  // One less is chosen a third as often; a place that may well be better is not left out.
  constexpr double nearly = 1;
  const double enough = liking.maxCoeff() - nearly;
  int first = 0, last = places_along - 1;
  while (perhaps[first] < enough) ++first;
  while (perhaps[last] < enough) --last;
  found.low = static_cast<double>(first) / (places_along - 1);
  found.high = static_cast<double>(last) / (places_along - 1);
  return found;
}

std::string short_value(const PickAxis& axis, double u) {
  return fmt::format("{:.3g}", axis.value(u));
}

}  // namespace

std::vector<AxisTaste> axis_tastes(const std::vector<PickAxis>& axes,
                                   const search::Preference& taste, const Point& favourite) {
  std::vector<AxisTaste> tastes;
  for (std::size_t k = 0; k < axes.size(); ++k) tastes.push_back(taste_along(taste, favourite, k));
  std::stable_sort(tastes.begin(), tastes.end(),
                   [](const AxisTaste& a, const AxisTaste& b) { return a.effect > b.effect; });
  return tastes;
}

std::vector<std::string> taste_lines(const std::vector<PickAxis>& axes,
                                     const std::vector<AxisTaste>& tastes, const Point& favourite) {
  // Three times as often, twenty times as often.
  constexpr double noticed = 1, strong = 3;
  std::vector<std::string> lines;
  for (const AxisTaste& found : tastes) {
    const PickAxis& axis = axes[found.axis];
    const std::string unit = axis.unit.empty() ? "" : " " + axis.unit;
    if (found.effect < noticed) {
      lines.push_back(fmt::format("{}: no preference seen between {} and {}{}", axis.name,
                                  short_value(axis, 0), short_value(axis, 1), unit));
      continue;
    }
    const std::string liked =
        short_value(axis, favourite[static_cast<Eigen::Index>(found.axis)]) + unit;
    constexpr double nearly_all = 0.95;
    if (found.high - found.low > nearly_all)
      lines.push_back(
          fmt::format("{}: {} so far; any other value may be liked as much", axis.name, liked));
    else
      lines.push_back(fmt::format("{}: {}, {} between {} and {}{}", axis.name, liked,
                                  found.effect < strong ? "perhaps liked" : "liked",
                                  short_value(axis, found.low), short_value(axis, found.high),
                                  unit));
  }
  return lines;
}

namespace {

constexpr int map_size = 480, map_left = 96, map_top = 40, map_cells = 32;

/// Blue, white, red would suggest a middle; this is one hue from dark to light.
std::string liking_colour(double share) {
  const auto mix = [&](double from, double to) {
    return static_cast<int>(from + (to - from) * std::clamp(share, 0.0, 1.0));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", mix(24, 250), mix(38, 214), mix(84, 120));
}

struct MapAxes {
  std::size_t x = 0, y = 0;  ///< equal where there is one axis
};

std::vector<Point> map_places(const Point& favourite, const MapAxes& shown) {
  std::vector<Point> places;
  for (int row = 0; row < map_cells; ++row)
    for (int column = 0; column < map_cells; ++column) {
      Point place = favourite;
      place[static_cast<Eigen::Index>(shown.y)] = 1 - (row + 0.5) / map_cells;
      place[static_cast<Eigen::Index>(shown.x)] = (column + 0.5) / map_cells;
      places.push_back(std::move(place));
    }
  return places;
}

/// Opacity says how much is known: 1 where nothing is left of the first uncertainty.
std::string map_squares(const search::Preference& taste, const std::vector<Point>& places) {
  const Eigen::VectorXd liking = taste.means(places);
  const double least = liking.minCoeff(), span = std::max(1e-9, liking.maxCoeff() - least);
  constexpr double side = static_cast<double>(map_size) / map_cells;
  std::string svg = "<g shape-rendering=\"crispEdges\">\n";
  for (int k = 0; k < map_cells * map_cells; ++k) {
    const double known =
        1 - taste.deviation(places[static_cast<std::size_t>(k)]) / taste.smoothness().amplitude;
    svg += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\" "
        "opacity=\"{:.2f}\"/>\n",
        map_left + (k % map_cells) * side, map_top + (k / map_cells) * side, side, side,
        liking_colour((liking[k] - least) / span), std::clamp(0.3 + 1.2 * known, 0.3, 1.0));
  }
  return svg + "</g>\n";
}

std::string map_dot(const Point& place, const MapAxes& shown, bool is_chosen) {
  return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\" stroke=\"#fff\"/>\n",
                     map_left + place[static_cast<Eigen::Index>(shown.x)] * map_size,
                     map_top + (1 - place[static_cast<Eigen::Index>(shown.y)]) * map_size,
                     is_chosen ? 5 : 3, is_chosen ? "#d33" : "none");
}

std::string map_words(const std::vector<PickAxis>& axes, const MapAxes& shown) {
  const auto text = [](double x, double y, const char* anchor, const std::string& words) {
    return fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                       words);
  };
  const auto title = [](const PickAxis& axis) {
    return axis.name + (axis.unit.empty() ? "" : " (" + axis.unit + ")");
  };
  const PickAxis &x = axes[shown.x], &y = axes[shown.y];
  const double bottom = map_top + map_size + 18;
  std::string svg = text(map_left, bottom, "start", short_value(x, 0)) +
                    text(map_left + map_size / 2, bottom, "middle", title(x)) +
                    text(map_left + map_size, bottom, "end", short_value(x, 1));
  svg +=
      text(map_left, 24, "start",
           title(y) + " upwards. Light: liked; pale: little known; red: chosen; ring: favourite");
  return svg + text(map_left - 6, map_top + map_size, "end", short_value(y, 0)) +
         text(map_left - 6, map_top + 12, "end", short_value(y, 1));
}

}  // namespace

std::string taste_map(const std::vector<PickAxis>& axes, const search::Preference& taste,
                      const std::vector<search::Round>& rounds,
                      const std::vector<AxisTaste>& tastes, const Point& favourite) {
  const MapAxes shown{tastes.front().axis, tastes[tastes.size() > 1 ? 1 : 0].axis};
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\" font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
      map_left + map_size + 24, map_top + map_size + 32);
  svg += map_squares(taste, map_places(favourite, shown));
  for (const search::Round& round : rounds)
    for (int k = 0; k < static_cast<int>(round.tiles.size()); ++k)
      svg += map_dot(round.tiles[static_cast<std::size_t>(k)], shown,
                     std::find(round.chosen.begin(), round.chosen.end(), k) != round.chosen.end());
  svg += fmt::format(
      "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"9\" fill=\"none\" stroke=\"#d33\" "
      "stroke-width=\"2\"/>\n",
      map_left + favourite[static_cast<Eigen::Index>(shown.x)] * map_size,
      map_top + (1 - favourite[static_cast<Eigen::Index>(shown.y)]) * map_size);
  return svg + map_words(axes, shown) + "</svg>\n";
}

}  // namespace neve::app::pick
