#pragma once
/// TOML text to plain data, guarded: any bytes give a Table or a located SceneError.

#include <string>
#include <string_view>

#include "app/scene/toml/value.h"

namespace neve::app::scene::toml {

/// @param file only named in errors
/// @throws SceneError
Table parse_toml(std::string_view text, const std::string& file);

}  // namespace neve::app::scene::toml
