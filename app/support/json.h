#pragma once
/// JSON with keys in the order they were written, and a reader that cannot be made to recurse deep.

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

namespace neve::app {

using Json = nlohmann::ordered_json;

/// @throws nlohmann::json::exception; values nested deeper than 64 levels are dropped
inline Json parse_json(std::string_view text) {
  const auto keep = [](int depth, Json::parse_event_t, Json&) { return depth <= 64; };
  return Json::parse(text.begin(), text.end(), keep);
}

inline Json parse_json(std::span<const std::uint8_t> bytes) {
  return parse_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

/// JSON has no NaN and no infinities: they become null.
inline Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

/// A count that is kept as a double, as a whole number where it is one: 19393, not 19393.0.
inline Json count_json(double count) {
  const bool is_whole =
      std::isfinite(count) && std::abs(count) < 9e15 && count == std::floor(count);
  return is_whole ? Json(static_cast<std::int64_t>(count)) : number_or_null(count);
}

/// JSON as text; invalid UTF-8 becomes U+FFFD instead of an exception.
inline std::string to_text(const Json& json, int indent = 2) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace neve::app
