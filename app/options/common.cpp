#include "app/options/common.h"

#include <algorithm>
#include <filesystem>

#include "app/advice/suggest.h"
#include "app/options/languages.h"
#include "app/scene/toml/value.h"
#include "app/support/errors.h"
#include "app/support/film_rate.h"
#include "app/support/text.h"
#include "render/gl/context.h"

namespace neve::app::options {

namespace {

void check_backend(const std::string& flag, const std::string& name) {
  const auto& backends = render::gl::backend_names();
  if (std::find(backends.begin(), backends.end(), name) != backends.end()) return;
  const advice::Entry* other = advice::entry_of("backend", name);
  throw UsageError(flag, "unknown backend \"" + name + "\"",
                   other ? other->sentence + "; expected one of " + joined(backends, ", ")
                         : advice::suggest_one_of(name, {"", backends}));
}

std::vector<std::string> format_names() {
  std::vector<std::string> names;
  for (const output::MovieFormat format : output::all_movie_formats)
    names.emplace_back(output::name(format));
  names.emplace_back("none");
  return names;
}

/// Advice on a word that names no format.
std::string format_advice(const std::string& word) {
  const std::string all = joined(format_names(), ", ");
  const std::string suffixes = ", or the suffix of the file: mp4, webm, mov";
  if (word == "avi" || word == "mkv")
    return "neve cannot write " + word + "; expected " + all + suffixes +
           "; most programs read mp4";
  return advice::suggest_one_of(word, {"format of a movie", format_names()}) + suffixes;
}

void read_format(const std::string& text, output::MovieStyle& movie) {
  const auto format = output::movie_format_named(text);
  if (text != "none" && !format)
    throw UsageError("--movie", "there is no format \"" + text + "\"", format_advice(text));
  movie.is_chosen = movie.has_format = true;
  movie.is_made = format.has_value();
  if (format) movie.format = *format;
}

void check_log(const std::string& flag, const std::string& file) {
  if (!is_log_name(file))
    throw UsageError(flag, "\"" + file + "\" is not a log",
                     "expected a file for the messages, as in --log run.log");
}

}  // namespace

bool is_log_name(const std::string& file) {
  const std::string suffix = lower_text(std::filesystem::path(file).extension().string());
  for (const char* other : {".toml", ".png", ".json", ".exr", ".obj", ".ply", ".stl", ".csv"})
    if (suffix == other) return false;
  return true;
}

void describe_threads(Command& visit, int& threads, const char* help) {
  visit("--threads", threads,
        number<int>("N", 0, 1024, "a whole number from 0 (one per core, the default) to 1024"),
        help);
}

void describe_backend(Command& visit, std::string& backend, const char* help) {
  visit("--backend", backend, text("NAME", "osmesa", check_backend), help);
}

void describe_caps(Command& visit, setup::CapTexts& caps) {
  visit("--max-memory", caps.memory,
        text("SIZE", "8GiB", [](auto& flag, auto& text) { setup::memory_cap(text, flag); }),
        "Refuse runs that need more memory, whatever the scene allows; NEVE_MAX_MEMORY sets this "
        "for all commands");
  visit("--max-particles", caps.particles,
        text("N", "2e6", [](auto& flag, auto& text) { setup::particle_cap(text, flag); }),
        "Refuse runs of more particles, whatever the scene allows; NEVE_MAX_PARTICLES sets this "
        "for all commands");
  visit.check([&caps] { setup::hold_caps(caps); });
}

void describe_movie(Command& visit, output::MovieStyle& movie) {
  visit.custom(
      "--movie", "NAME", "gif", [&movie](const std::string& text) { read_format(text, movie); },
      [&movie]() -> std::string {
        if (!movie.has_format) return "";
        return movie.is_made ? output::name(movie.format) : "none";
      },
      "Format of movies: h264 (mp4, default), h265 (mp4), vp9 (webm), prores (mov, for editing), "
      "gif, webp (for pages), or none");
  const Language<int> quality = number<int>("N", 1, 100, "a whole number from 1 to 100");
  visit.custom(
      "--movie-quality", quality.type, quality.example,
      [&movie, quality](const std::string& text) {
        movie.quality = quality.read("--movie-quality", text);
        movie.is_chosen = true;
      },
      [&movie]() -> std::string {
        // The usual quality is said where nothing else asks for a movie.
        const bool is_asked_for = movie.is_chosen && !movie.has_format && movie.fps == 0;
        const bool is_usual = movie.quality == output::MovieStyle{}.quality && !is_asked_for;
        return is_usual ? "" : std::to_string(movie.quality);
      },
      "Quality of movies, 1 to 100; default: 80, for watching");
  const Language<double> fps =
      number<double>("RATE", 0.1, 1000, "0.1 to 1000 frames a second, as in --movie-fps 12");
  visit.custom(
      "--movie-fps", fps.type, fps.example,
      [&movie, fps](const std::string& text) {
        movie.fps = exact_rate(fps.read("--movie-fps", text));
        movie.is_chosen = true;
      },
      [&movie, fps] { return movie.fps == 0 ? "" : fps.write(movie.fps); },
      "Frames per second of movies; fewer than the scene's make slow motion; default: those of "
      "the scene");
}

void describe_progress(Command& visit, ProgressOptions& progress) {
  const Language<bool> language{
      "NAME", "json",
      [](const std::string& flag, const std::string& text) {
        if (text != "text" && text != "json")
          throw UsageError(flag, "cannot use \"" + text + "\"",
                           advice::suggest_one_of(text, {"", {"text", "json"}}));
        return text == "json";
      },
      [](const bool& is_json) { return std::string(is_json ? "json" : "text"); }};
  visit("--progress", progress.is_json, language,
        "text: lines for people (default); json: one JSON object a line on standard error");
  visit("--log", progress.log, text("FILE", "run.log", check_log),
        "Append all messages to a file, with times, details and every frame");
}

void describe_verbosity(Command& visit, Verbosity& verbosity, const char* verbose,
                        const char* quiet) {
  visit.sets("--quiet,-q", verbosity, Verbosity::quiet, quiet);
  if (!verbose) return;
  visit.sets("--verbose,-v", verbosity, Verbosity::verbose, verbose)
      .excludes({"--quiet"}, "give one of the two");
}

}  // namespace neve::app::options
