#pragma once
/// Files that scenes and sweeps are read from: by name, from standard input, from a pipe.

#include <filesystem>
#include <string>

namespace neve::app::scene {

/// The path behind a typed name: "-" is standard input, and ".toml" is added where only the file
/// with that suffix exists.
std::string path_of_scene(const std::string& typed);

/// The folder where the relative paths of a scene start; "" for the current one, as of a scene from
/// a pipe.
std::string base_dir_of(const std::string& file);

/// True for a file that stays: it can be read again, named in a command and written over. False for
/// standard input, pipes, and where nothing is.
bool is_lasting_file(const std::string& file);

/// The name of what is made of a scene: "drop" of "scenes/drop.toml", "stdin", or "pipe" of a
/// `<(command)`.
std::string name_of_scene(const std::string& file);

/// "a directory", "a pipe", "a link to nothing": what a path is that cannot be read as a file is;
/// "" of a file and of nothing.
std::string kind_of_no_file(const std::filesystem::path& path);

/// The text of a scene or sweep file. That of a pipe is kept, so that it can be read again.
/// @throws SceneError if it is missing or too large, IoError where the machine fails
std::string read_toml_file(const std::string& file);

}  // namespace neve::app::scene
