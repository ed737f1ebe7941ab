#include "sim/shapes/curve.h"

#include <algorithm>

namespace neve::sim::shapes {

CurvePlace::CurvePlace(const std::vector<double>& times, double time) {
  next =
      static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
  if (!is_between(times)) return;
  span = times[next] - times[next - 1];
  part = (time - times[next - 1]) / span;
}

double slope_at(const std::vector<double>& times, std::size_t k, double before, double after) {
  if (k == 0 || k + 1 == times.size() || !(before * after > 0)) return 0;
  const double first = times[k] - times[k - 1], second = times[k + 1] - times[k];
  const double w1 = 2 * second + first, w2 = second + 2 * first;
  return (w1 + w2) / (w1 / before + w2 / after);
}

CurveValue curve_at(const std::vector<double>& times, const std::vector<double>& x,
                    const CurvePlace& place) {
  if (place.next == 0) return {x.front(), 0};
  if (place.next == times.size()) return {x.back(), 0};
  const auto mean = [&](std::size_t k) { return (x[k + 1] - x[k]) / (times[k + 1] - times[k]); };
  const auto slope = [&](std::size_t k) {
    if (k == 0 || k + 1 == times.size()) return 0.0;
    return slope_at(times, k, mean(k - 1), mean(k));
  };
  const double a = x[place.next - 1], b = x[place.next];
  const double m = place.span * slope(place.next - 1), n = place.span * slope(place.next);
  const double s = place.part, r = 1 - s;
  const double value =
      (1 + 2 * s) * r * r * a + s * r * r * m + s * s * (3 - 2 * s) * b - s * s * r * n;
  const double change = 6 * s * r * (b - a) + r * (1 - 3 * s) * m + s * (3 * s - 2) * n;
  return {value, change / place.span};
}

}  // namespace neve::sim::shapes
