#pragma once
/// Formats of movies: what they are called, which files hold them, which encoder makes them.

#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace neve::app::output {

enum class MovieFormat { h264, h265, vp9, prores, gif, webp };

inline constexpr std::array all_movie_formats{MovieFormat::h264, MovieFormat::h265,
                                              MovieFormat::vp9,  MovieFormat::prores,
                                              MovieFormat::gif,  MovieFormat::webp};

struct MovieFormatInfo {
  const char *name, *suffix, *encoder;  ///< of ffmpeg
};
/// Formats in their order. The first of a suffix is the format of files that are only named by it.
inline constexpr std::array<MovieFormatInfo, all_movie_formats.size()> movie_format_infos{
    {{"h264", ".mp4", "libx264"},
     {"h265", ".mp4", "libx265"},
     {"vp9", ".webm", "libvpx-vp9"},
     {"prores", ".mov", "prores_ks"},
     {"gif", ".gif", "gif"},
     {"webp", ".webp", "libwebp_anim"}}};

constexpr const MovieFormatInfo& info_of(MovieFormat format) {
  return movie_format_infos[static_cast<std::size_t>(format)];
}
constexpr const char* name(MovieFormat format) {
  return info_of(format).name;
}

/// Finds the format of a name, or of the suffix of a file without its point: "mp4" is h264.
inline std::optional<MovieFormat> movie_format_named(const std::string& word) {
  for (const MovieFormat format : all_movie_formats)
    if (name(format) == word || info_of(format).suffix == "." + word) return format;
  return std::nullopt;
}

/// True unless it is an animated picture. Files of a video say the time code of their first
/// picture, and have even sides: pictures of odd ones get a line of black.
constexpr bool is_video(MovieFormat format) {
  return format != MovieFormat::gif && format != MovieFormat::webp;
}

/// Settings of a movie.
struct MovieStyle {
  MovieFormat format = MovieFormat::h264;
  int quality = 80;         ///< 1 to 100
  double fps = 0;           ///< frames per second of the movie; 0: those of the scene
  bool is_made = true;      ///< false: pictures only
  bool is_chosen = false;   ///< somebody asked for it: that it cannot be made is an error
  bool has_format = false;  ///< somebody named the format
};

}  // namespace neve::app::output
