#pragma once
/// What a search has learned, in words and as a map.

#include <string>
#include <vector>

#include "app/pick/axes.h"
#include "app/pick/search/rounds.h"

namespace neve::app::pick {

/// How liking changes along an axis through the favourite.
struct AxisTaste {
  std::size_t axis = 0;
  double effect = 0;         ///< greatest less least expected liking
  double low = 0, high = 1;  ///< ends of the part that is liked nearly as much as the favourite
};

/// Of all axes, the most telling one first. @param favourite not empty
std::vector<AxisTaste> axis_tastes(const std::vector<PickAxis>& axes,
                                   const search::Preference& taste, const search::Point& favourite);

/// One sentence for each axis.
std::vector<std::string> taste_lines(const std::vector<PickAxis>& axes,
                                     const std::vector<AxisTaste>& tastes,
                                     const search::Point& favourite);

/// Expected liking over the two most telling axes, through the favourite. One axis is both.
struct TasteMap {
  static constexpr int cells = 32;  ///< along each axis

  struct Cell {
    int red = 0, green = 0, blue = 0;  ///< 0 to 255; light where it is liked
    double opacity = 1;                ///< pale where little is known
  };
  /// A tile that was shown, at its places on the two axes.
  struct Dot {
    double x = 0, y = 0;
    bool is_chosen = false;
  };

  std::size_t x_axis = 0, y_axis = 0;
  std::vector<Cell> squares;  ///< rows from the top, the greatest y
  std::vector<Dot> dots;
  double favourite_x = 0, favourite_y = 0;
};
TasteMap taste_map(const search::Preference& taste, const std::vector<search::Round>& rounds,
                   const std::vector<AxisTaste>& tastes, const search::Point& favourite);

/// "name (unit)"
std::string axis_title(const PickAxis& axis);
/// A value with three digits, without its unit.
std::string short_value(const PickAxis& axis, double u);

/// The map as SVG. Tiles that were shown are dots, chosen ones are filled, the favourite has a
/// ring.
std::string map_svg(const std::vector<PickAxis>& axes, const TasteMap& map);

}  // namespace neve::app::pick
