#pragma once
/// Flags that say where a screen is: a window, a page or a script.

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "app/view/view_options.h"

namespace neve::app::cli::devices {

/// Adds --window, --web and --listen. @param listen  for finish_screen()
void add_place(CLI::App& command, view::ScreenOptions& screen, std::optional<std::string>& listen);
/// Adds --replay and --record.
void add_scripts(CLI::App& command, view::ScreenOptions& screen);
/// @throws UsageError for flags that exclude each other, and for an impossible address
void finish_screen(view::ScreenOptions& screen, const std::optional<std::string>& listen);

}  // namespace neve::app::cli::devices
