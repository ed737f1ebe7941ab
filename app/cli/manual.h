#pragma once
/// Man pages and completions of shells, from the same descriptions as --help.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

namespace neve::app::cli {

/// The page of a command in troff. @param name  "neve", "neve render", "neve bench sim"
std::string man_page(const CLI::App& command, const std::string& name, const std::string& footer);

/// Commands and flags for a shell; files complete everything else.
std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);
std::string fish_completion(const CLI::App& app);

/// Writes DIR/man1/neve-render.1 and so on, DIR/bash/neve, DIR/zsh/_neve and DIR/fish/neve.fish.
/// @throws IoError
void write_manual(const CLI::App& app, const std::filesystem::path& folder);

}  // namespace neve::app::cli
