#pragma once
/// The way back: options as the words that give them, for child processes, scripts and commands to
/// paste.

#include <filesystem>
#include <string>
#include <vector>

#include "app/options/option.h"

namespace neve::app::options {

/// The command and the options that differ from those of `usual`, which nobody has changed:
/// "render", "scene.toml", "--set", "material.snow.hardening=5"
std::vector<std::string> words_of(const Command& command, const Command& usual);

template <class Options>
std::vector<std::string> words_of(Options options) {
  Options defaults;
  Command command, usual;
  describe(command, options);
  describe(usual, defaults);
  return words_of(command, usual);
}

/// Words as a line to paste into a shell, behind the name of the program.
std::string shell_line(const std::vector<std::string>& words,
                       const std::filesystem::path& program = "neve");

}  // namespace neve::app::options
