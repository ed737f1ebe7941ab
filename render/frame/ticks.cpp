#include "render/frame/ticks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "render/frame/range.h"

namespace neve::render {
namespace {

/// Smallest round step that makes no more than count intervals.
double nice_step(double width, int count) {
  const double rough = width / std::max(count, 1);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 2.5, 5.0}) {
    if (factor * power >= rough * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

/// Digits that tell values apart which differ by step; exponents only for very large or small ones.
std::string format(double value, double largest, double step) {
  if (std::abs(value) < 1e-9 * step) return "0";
  char text[64];
  const int magnitude = static_cast<int>(std::floor(std::log10(largest)));
  int decimals = 0;
  // 2.5 needs one digit more than 2: count until the step is a whole number of units.
  for (double unit = step; decimals < 12 && std::abs(unit - std::round(unit)) > 1e-6 * unit;
       ++decimals)
    unit *= 10;
  if (magnitude < 5 && magnitude >= -3) {
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
    return text;
  }
  const double mantissa_step = step / std::pow(10.0, magnitude);
  int digits = 0;
  for (double unit = mantissa_step; digits < 9 && std::abs(unit - std::round(unit)) > 1e-6 * unit;
       ++digits)
    unit *= 10;
  std::snprintf(text, sizeof text, "%.*fe%d", digits, value / std::pow(10.0, magnitude), magnitude);
  return text;
}

}  // namespace

std::vector<Tick> nice_ticks(double min, double max, int count) {
  if (!std::isfinite(min) || !std::isfinite(max)) return {};
  if (!has_width(min, max)) {
    char text[64];
    std::snprintf(text, sizeof text, "%.4g", min);
    return {{min, text}};
  }
  const double largest = std::max(std::abs(min), std::abs(max));
  const double step = nice_step(max - min, count);
  std::vector<Tick> ticks;
  const double slack = 1e-6 * step;
  for (double k = std::ceil((min - slack) / step); k * step <= max + slack; ++k)
    ticks.push_back({k * step, format(k * step, largest, step)});
  return ticks;
}

}  // namespace neve::render
