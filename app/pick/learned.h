#pragma once
/// Words and a map of what a search has learned.

#include <string>
#include <vector>

#include "app/pick/axes.h"
#include "app/pick/search/rounds.h"
#include "render/frame/frame.h"

namespace neve::app::pick {

/// The change of liking along an axis through the favourite.
struct AxisTaste {
  std::size_t axis = 0;
  double effect = 0;         ///< greatest less least expected liking
  double low = 0, high = 1;  ///< ends of the part that is liked nearly as much as the favourite
};

/// Returns the tastes of all axes, the most telling one first. @param favourite not empty
std::vector<AxisTaste> axis_tastes(const std::vector<PickAxis>& axes,
                                   const search::Preference& taste, const search::Point& favourite);

/// One sentence for each axis.
std::vector<std::string> taste_lines(const std::vector<PickAxis>& axes,
                                     const std::vector<AxisTaste>& tastes,
                                     const search::Point& favourite);

/// Expected liking over the two most telling axes, through the favourite. One axis is both.
render::Plot taste_map(const std::vector<PickAxis>& axes, const search::Preference& taste,
                       const std::vector<search::Round>& rounds,
                       const std::vector<AxisTaste>& tastes, const search::Point& favourite);
inline constexpr const char* map_words =
    "Light: liked. Pale: little known. Red: chosen. Ring: favourite so far.";
std::string map_svg(const render::Plot& map);

/// A value with three digits, without its unit.
std::string short_value(const PickAxis& axis, double u);

}  // namespace neve::app::pick
