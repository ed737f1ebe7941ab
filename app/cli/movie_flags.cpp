#include "app/cli/movie_flags.h"

#include <map>
#include <vector>

#include "app/setup/argument_text.h"
#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::cli {

namespace {

std::vector<std::string> format_names() {
  std::vector<std::string> names;
  for (const output::MovieFormat format : output::all_movie_formats())
    names.emplace_back(output::name(format));
  names.emplace_back("none");
  return names;
}

/// Advice on a word that names no format.
std::string format_advice(const std::string& word) {
  static const std::map<std::string, std::string> elsewhere{
      {"hevc", "h265"}, {"x264", "h264"},        {"x265", "h265"},
      {"avc", "h264"},  {"quicktime", "prores"}, {"av1", "vp9"}};
  if (word == "avi" || word == "mkv")
    return "no " + word + " is written; expected " + joined(format_names(), ", ") +
           ", or the suffix of the file: mp4, webm, mov; most programs read mp4";
  const auto found = elsewhere.find(word);
  return (found != elsewhere.end()
              ? "did you mean " + found->second + "? expected " + joined(format_names(), ", ")
              : names_advice(word, format_names())) +
         ", or the suffix of the file: mp4, webm, mov";
}

}  // namespace

void add_movie_flags(CLI::App& command, MovieTexts& texts) {
  command
      .add_option("--movie", texts.format,
                  "Format of movies: h264 (mp4, default), h265 (mp4), vp9 (webm), prores (mov, for "
                  "editing), gif, webp (for pages), or none")
      ->type_name("NAME");
  command
      .add_option("--movie-quality", texts.quality,
                  "Quality of movies, 1 to 100; default: 80, good to look at")
      ->type_name("N");
  command
      .add_option("--movie-fps", texts.fps,
                  "Frames of a movie per second; fewer than the scene's are slow motion; default: "
                  "those of the scene")
      ->type_name("RATE");
}

output::MovieStyle finished_movie(const MovieTexts& texts) {
  output::MovieStyle style;
  style.is_chosen = texts.format || texts.quality || texts.fps;
  style.has_format = texts.format.has_value();
  if (texts.format == "none") {
    style.is_made = false;
  } else if (texts.format) {
    const auto format = output::movie_format_named(*texts.format);
    if (!format)
      throw UsageError("--movie", "there is no format \"" + *texts.format + "\"",
                       format_advice(*texts.format));
    style.format = *format;
  }
  if (texts.quality) {
    const std::optional<int> quality = number_of<int>(*texts.quality);
    if (!quality || *quality < 1 || *quality > 100)
      throw UsageError("--movie-quality", "cannot use \"" + *texts.quality + "\"",
                       "expected a whole number from 1 to 100");
    style.quality = *quality;
  }
  if (texts.fps) {
    const std::optional<double> fps = setup::finite_number(*texts.fps);
    if (!fps || *fps < 0.1 || *fps > 1000)
      throw UsageError("--movie-fps", "cannot use \"" + *texts.fps + "\"",
                       "expected 0.1 to 1000 frames a second, as in --movie-fps 12");
    style.fps = *fps;
  }
  return style;
}

}  // namespace neve::app::cli
