#pragma once
/// JSON text to the plain data that scenes are read from: every value and key with its place, which
/// the JSON library does not tell.

#include <string>
#include <string_view>

#include "app/scene/toml/value.h"

namespace neve::app::view::replay {

/// Values nested deeper than any script needs are left empty.
/// @param file only named in errors
/// @throws SceneError for invalid JSON, for null, and for a key that is given twice
scene::toml::Value parse_json_values(std::string_view text, const std::string& file);

}  // namespace neve::app::view::replay
