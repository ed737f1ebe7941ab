#pragma once
/// Formats of movies: what they are called, which files hold them, which encoder makes them.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace neve::app::output {

enum class MovieFormat { h264, h265, vp9, prores, gif, webp };

const char* name(MovieFormat format);
const std::vector<MovieFormat>& all_movie_formats();
/// Of a name, or of the suffix of a file without its point: "mp4" is h264.
std::optional<MovieFormat> movie_format_named(const std::string& word);

/// ".mp4"
const char* movie_suffix(MovieFormat format);
/// The encoder of ffmpeg: "libx264".
const char* movie_encoder(MovieFormat format);

/// Whether files of this format say the time code of their first picture.
constexpr bool holds_time_code(MovieFormat format) {
  return format != MovieFormat::gif && format != MovieFormat::webp;
}

/// How a movie is to be made.
struct MovieStyle {
  MovieFormat format = MovieFormat::h264;
  int quality = 80;         ///< 1 to 100
  double fps = 0;           ///< frames per second of the movie; 0: those of the scene
  bool is_made = true;      ///< false: pictures only
  bool is_chosen = false;   ///< somebody asked for it: that it cannot be made is an error
  bool has_format = false;  ///< somebody named the format
};

}  // namespace neve::app::output
