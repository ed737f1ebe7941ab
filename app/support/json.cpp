#include "app/support/json.h"

namespace neve::app {

Json parse_json(std::string_view text) {
  const auto keep = [](int depth, Json::parse_event_t, Json&) { return depth <= 64; };
  return Json::parse(text.begin(), text.end(), keep);
}

Json parse_json(std::span<const std::uint8_t> bytes) {
  return parse_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::string to_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace neve::app
