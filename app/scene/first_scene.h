#pragma once
/// The scene that `neve new` writes: small, and explained line by line.

#include <string>

namespace neve::app::scene {

/// Returns TOML that renders as it is. Above each parameter are its sentence, unit and range, from
/// describe.h.
/// @param title   of the scene
/// @param file    the scene's file name, for the commands in its first comment
/// @param schema  file name of the JSON Schema beside it
std::string first_scene(const std::string& title, const std::string& file,
                        const std::string& schema);

}  // namespace neve::app::scene
