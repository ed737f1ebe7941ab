#pragma once
/// Flags of the commands that make movies: --movie, --movie-quality, --movie-fps.

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>

#include "app/output/movie_format.h"

namespace neve::app::cli {

/// Values that CLI11 hands over as text.
struct MovieTexts {
  std::optional<std::string> format, quality, fps;
};

void add_movie_flags(CLI::App& command, MovieTexts& texts);

/// @throws UsageError
output::MovieStyle finished_movie(const MovieTexts& texts);

}  // namespace neve::app::cli
