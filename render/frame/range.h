#pragma once
/// Ranges of an axis or a colour bar.

#include <algorithm>
#include <cmath>

namespace neve::render {

/// Share of the largest number below which a difference is none to a reader of an axis.
inline constexpr double min_difference = 1e-6;

/// True if a range has more than one value to a reader: floats next to each other are one.
inline bool has_width(double min, double max) {
  return max - min > min_difference * std::max(std::abs(min), std::abs(max));
}

}  // namespace neve::render
