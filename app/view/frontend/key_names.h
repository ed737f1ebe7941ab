#pragma once
/// Names of keys in scripts and help.

#include <optional>
#include <string>
#include <vector>

namespace neve::app::view::frontend {

/// "a" to "z", digits, signs, "space", "escape", "f1" ...; capitals count as small letters.
/// @return its code, see namespace key
std::optional<int> key_named(const std::string& name);

/// @return "" for a code that has no name
std::string key_name(int key);

/// Lists every name, for a misspelt one.
std::vector<std::string> key_names();

}  // namespace neve::app::view::frontend
