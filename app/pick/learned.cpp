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

/// Returns words for a person who likes an end of the range; "" away from the ends.
std::string end_words(double u) {
  constexpr double near_end = 0.05;  // of the range
  if (u > 1 - near_end) return "; at the upper end of its range: more may be liked better";
  if (u < near_end) return "; at the lower end of its range: less may be liked better";
  return "";
}

}  // namespace

std::string short_value(const PickAxis& axis, double u) {
  return fmt::format("{:.3g}", axis.value(u));
}

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
    const double place = favourite[static_cast<Eigen::Index>(found.axis)];
    const std::string liked = short_value(axis, place) + unit;
    constexpr double nearly_all = 0.95;
    if (found.high - found.low > nearly_all)
      lines.push_back(
          fmt::format("{}: {} so far; any other value may be liked as much", axis.name, liked));
    else
      lines.push_back(fmt::format("{}: {}, {} between {} and {}{}", axis.name, liked,
                                  found.effect < strong ? "perhaps liked" : "liked",
                                  short_value(axis, found.low), short_value(axis, found.high),
                                  unit));
    lines.back() += end_words(place);
  }
  return lines;
}

}  // namespace neve::app::pick
