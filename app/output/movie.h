#pragma once
/// A movie of finished pictures, made by ffmpeg where there is one.

#include <filesystem>
#include <string>
#include <vector>

#include "app/output/movie_format.h"

namespace neve::app::output {

struct MovieRequest {
  std::filesystem::path picture_folder;  ///< holds 0000.png ...
  std::filesystem::path file;            ///< the movie
  int first_frame = 0, last_frame = 0;
  double fps = 24;         ///< of the scene
  bool has_alpha = false;  ///< of the pictures, laid over a plain colour where the format has none
  double longest = 0;      ///< s that ffmpeg may take; 0: as long as the largest pictures need
  MovieStyle style{};
  std::string time_code{};  ///< of the first picture; empty: none
};

enum class MovieOutcome {
  written,
  no_ffmpeg,
  failed,     ///< of ffmpeg
  unwritable  ///< of the disk
};

struct MovieResult {
  MovieOutcome outcome = MovieOutcome::failed;
  std::string reason;  ///< of a failure
};

/// Written under a temporary name, read again to count its frames (ffmpeg exits 0 on broken input)
/// and only then put in place. Most formats get even sides. A movie of another length is not kept.
/// An earlier movie of that name is removed first. A written one is on the disk. An ffmpeg that
/// takes far too long is stopped.
/// Never throws for failures of ffmpeg and of the disk.
MovieResult write_movie(const MovieRequest& request);

/// The style that can be made here, known before the first picture: the format that was asked for,
/// or, where nobody named one, the first of h264, vp9, prores and gif that this ffmpeg makes.
/// Without ffmpeg the style stays unchanged: pictures alone are what most want then.
/// @param fps  of the scene
/// @throws IoError where ffmpeg or the encoder of what was asked for is missing, Error for too fast
///         a GIF
MovieStyle available_movie(const MovieStyle& style, double fps);

/// "ffmpeg here makes no h264: movies are vp9"; empty where nothing changed.
std::string other_format_text(const MovieStyle& wanted, const MovieStyle& available);

// Arguments of ffmpeg for the formats of movies.

/// Appends the words of a text.
void append_words(std::vector<std::string>& arguments, const std::string& text);

/// Frames per second of the movie.
double movie_fps(const MovieRequest& request);

/// Returns the arguments that make the movie, to be run in the folder of the pictures.
/// @param palette  of a GIF, made before
std::vector<std::string> movie_arguments(const MovieRequest& request,
                                         const std::filesystem::path& target,
                                         const std::filesystem::path& palette);

/// Returns the arguments that find the colours of a GIF: one palette for all of its frames.
std::vector<std::string> palette_arguments(const MovieRequest& request,
                                           const std::filesystem::path& palette);

}  // namespace neve::app::output
