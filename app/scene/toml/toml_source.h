#pragma once
/// TOML text to plain data, guarded: any bytes give a Table or a located SceneError.

#include <string>
#include <string_view>

#include "app/scene/toml/value.h"

namespace neve::app::scene::toml {

/// @param file only named in errors
/// @throws SceneError
Table parse_toml(std::string_view text, const std::string& file);

/// The text that a value in quotes stands for, its escapes resolved; anything else as it is.
std::string unquoted(const std::string& value);

}  // namespace neve::app::scene::toml
