#pragma once
/// Man pages and completions of shells, from the same descriptions as --help.

#include <filesystem>

#include "app/cli/command_line.h"

namespace neve::app::cli {

/// Writes DIR/man1/neve-render.1 and so on, DIR/bash/neve, DIR/zsh/_neve and DIR/fish/neve.fish.
/// @throws IoError
void write_manual(const Entry& program, const std::filesystem::path& folder);

}  // namespace neve::app::cli
