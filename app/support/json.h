#pragma once
/// JSON with keys in the order they were written, and a reader that cannot be made to recurse deep.

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace neve::app {

using Json = nlohmann::ordered_json;

/// @throws nlohmann::json::exception; values nested deeper than 64 levels are dropped
Json parse_json(std::string_view text);
Json parse_json(std::span<const std::uint8_t> bytes);

/// JSON as text; invalid UTF-8 becomes U+FFFD instead of an exception.
std::string to_text(const Json& json, int indent = 2);

/// A whole number that an Int holds; 1e127 converted to int would have no defined value.
/// @throws std::runtime_error for anything else
template <class Int>
Int whole_number(const Json& json) {
  if (json.is_number_unsigned() && std::in_range<Int>(json.get<std::uint64_t>()))
    return static_cast<Int>(json.get<std::uint64_t>());
  if (json.is_number_integer() && !json.is_number_unsigned() &&
      std::in_range<Int>(json.get<std::int64_t>()))
    return static_cast<Int>(json.get<std::int64_t>());
  const double value = json.is_number_float() ? json.get<double>() : 0.5;
  if (std::abs(value) < 9e15 && value == std::floor(value) &&
      std::in_range<Int>(static_cast<std::int64_t>(value)))
    return static_cast<Int>(value);
  throw std::runtime_error(to_text(json, -1).substr(0, 40) +
                           ": expected a whole number that is not too large");
}

/// The same of a member that may be missing.
template <class Int>
Int whole_number_or(const Json& json, const char* key, Int otherwise) {
  return json.contains(key) ? whole_number<Int>(json.at(key)) : otherwise;
}

/// JSON has no NaN and no infinities: they become null.
inline Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

/// A count or bound that is kept as a double, as a whole number where it is one: 19393, not
/// 19393.0.
inline Json count_json(double count) {
  constexpr double exact = 9007199254740992;  // 2^53: doubles below have neighbours 1 apart
  const bool is_whole =
      std::isfinite(count) && std::abs(count) <= exact && count == std::floor(count);
  return is_whole ? Json(static_cast<std::int64_t>(count)) : number_or_null(count);
}

}  // namespace neve::app
