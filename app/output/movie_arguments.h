#pragma once
/// Arguments of ffmpeg for the formats of movies.

#include <filesystem>
#include <string>
#include <vector>

#include "app/output/movie.h"

namespace neve::app::output {

/// Appends the words of a text.
void append_words(std::vector<std::string>& arguments, const std::string& text);

/// Frames per second of the movie.
double movie_fps(const MovieRequest& request);

/// Those that make the movie, to be run in the folder of the pictures.
/// @param palette  of a GIF, made before
std::vector<std::string> movie_arguments(const MovieRequest& request,
                                         const std::filesystem::path& target,
                                         const std::filesystem::path& palette);

/// Those that find the colours of a GIF: one palette for all of its frames.
std::vector<std::string> palette_arguments(const MovieRequest& request,
                                           const std::filesystem::path& palette);

}  // namespace neve::app::output
