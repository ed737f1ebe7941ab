#pragma once
/// What a run costs, or many do: a number with the range in which it lies.

#include <algorithm>

namespace neve::app::forecast {

/// Steps, seconds or work. The truth lies within the range on every shipped scene.
struct Cost {
  double expected = 0, least = 0, most = 0;

  Cost& operator+=(const Cost& other) {
    expected += other.expected;
    least += other.least;
    most += other.most;
    return *this;
  }
  friend Cost operator*(const Cost& cost, double factor) {
    return {factor * cost.expected, factor * cost.least, factor * cost.most};
  }
  /// The longer of two that run side by side.
  friend Cost longest(const Cost& a, const Cost& b) {
    return {std::max(a.expected, b.expected), std::max(a.least, b.least), std::max(a.most, b.most)};
  }
};

/// Of something that no copy was made for.
inline Cost rough_cost(double expected) {
  return {expected, 0.5 * expected, 4 * expected};
}

}  // namespace neve::app::forecast
