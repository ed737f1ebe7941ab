#include "app/scene/valid.h"

#include <algorithm>
#include <cmath>

#include "app/scene/toml/value.h"
#include "app/support/text.h"

namespace neve::app::scene {
namespace {

constexpr std::size_t max_name_length = 64;  // views name folders

bool is_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-';
}

}  // namespace

bool Valid::contains(double x) const {
  return std::isfinite(x) && (is_min_open ? x > min : x >= min) &&
         (is_max_open ? x < max : x <= max) && !(x > 0 && x < min_above_0);
}

std::string Valid::text_of_bounds() const {
  std::string bounds = "value";
  if (min_above_0 > 0)
    return "0 or " + toml::number_text(min_above_0) + " <= value <= " + toml::number_text(max);
  if (std::isfinite(min)) {
    // One bound reads better with the value first: value > 0.
    if (!std::isfinite(max))
      return bounds + (is_min_open ? " > " : " >= ") + toml::number_text(min);
    bounds = toml::number_text(min) + (is_min_open ? " < " : " <= ") + bounds;
  }
  if (std::isfinite(max)) bounds += (is_max_open ? " < " : " <= ") + toml::number_text(max);
  return bounds;
}

std::string Valid::advice_on(double x) const {
  constexpr double few = 2;  // what has such bounds is a share, and what is beyond no slip
  const double share = 0.01 * x;
  if (!(min >= 0 && max <= few && x > few && x <= 100 && contains(share))) return {};
  return "per cent? As a share of 1 it is " + rough_text(share);
}

bool is_identifier(const std::string& text) {
  return !text.empty() && text.size() <= max_name_length &&
         std::all_of(text.begin(), text.end(), is_word);
}

}  // namespace neve::app::scene
