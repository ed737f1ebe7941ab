#include "app/view/panels/slider_scale.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "app/scene/flat.h"
#include "app/scene/params.h"

namespace neve::app::view::panels {

namespace {

/// A slider reaches so many times less and more than usual.
constexpr double slider_reach = 100;
/// Wider ranges have too much on a pixel.
constexpr double widest_linear = 200;

}  // namespace

double least(const scene::Valid& valid) {
  return valid.is_min_open ? std::nextafter(valid.min, HUGE_VAL) : valid.min;
}

double greatest(const scene::Valid& valid) {
  return valid.is_max_open ? std::nextafter(valid.max, -HUGE_VAL) : valid.max;
}

SliderScale slider_scale(const scene::Valid& valid, const std::optional<double>& usual,
                         double value) {
  const bool is_bounded = std::isfinite(valid.min) && std::isfinite(valid.max);
  if (!is_bounded) return {};
  const double min = least(valid), max = greatest(valid);
  if (scene::spans_decades(valid, usual)) {
    double low = usual ? std::max(min, *usual / slider_reach) : min;
    double high = usual ? std::min(max, *usual * slider_reach) : max;
    if (value > 0) low = std::min(low, value);
    high = std::max(high, value);
    return {SliderScale::Kind::logarithmic, low, high, min == 0};
  }
  if (max - min <= widest_linear) return {SliderScale::Kind::linear, min, max, false};
  return {};
}

double share_of(const SliderScale& scale, double value) {
  if (!(scale.high > scale.low)) return 0;
  const bool is_log = scale.kind == SliderScale::Kind::logarithmic;
  if (is_log && !(value > scale.low)) return 0;
  const double share = is_log ? std::log(value / scale.low) / std::log(scale.high / scale.low)
                              : (value - scale.low) / (scale.high - scale.low);
  return std::clamp(share, 0.0, 1.0);
}

std::optional<double> usual_number(const std::string& address) {
  // Listing all parameters takes too long for every frame of the panels.
  static std::map<std::string, std::optional<double>> known;
  if (const auto found = known.find(address); found != known.end()) return found->second;
  std::optional<double> usual;
  if (const auto info = scene::param_at(address); info && info->default_value) {
    if (const auto* number = std::get_if<double>(&info->default_value->data)) usual = *number;
    if (const auto* whole = std::get_if<std::int64_t>(&info->default_value->data))
      usual = static_cast<double>(*whole);
  }
  return known[address] = usual;
}

}  // namespace neve::app::view::panels
