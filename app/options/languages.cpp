#include "app/options/languages.h"

#include <fmt/core.h>

#include <filesystem>
#include <limits>

#include "app/scene/scene_file.h"

namespace neve::app::options {

namespace {

namespace fs = std::filesystem;

/// @param meant  "" if nothing is known
[[noreturn]] void refuse_value(const std::string& flag, const std::string& text,
                               const std::string& meant, const std::string& expected) {
  const std::string question = advice::did_you_mean(meant);
  throw UsageError(flag, "cannot use \"" + text + "\"",
                   question + (question.empty() ? "" : " ") + expected);
}

/// The two whole numbers of a text with other signs between them; empty: it has not two.
std::vector<std::string> two_numbers(const std::string& text) {
  const char* const digits = "0123456789";
  const std::string plain = trimmed(text);
  const std::size_t first = plain.find_first_not_of(digits), last = plain.find_last_not_of(digits);
  if (first == std::string::npos || first == 0 || last + 1 == plain.size()) return {};
  const std::string between = trimmed(plain.substr(first, last + 1 - first));
  for (const char* sign : {"..", ":", ",", ";", "*", "X", "by", ""})
    if (between == sign) return {plain.substr(0, first), plain.substr(last + 1)};
  return {};
}

/// "1920x1080" of "1920*1080", "hd" and the like; empty: nothing known.
std::string size_meant(const std::string& text) {
  if (const advice::Entry* entry = advice::entry_of("size of a picture", text))
    return entry->names.front();
  return joined(two_numbers(text), "x");
}

/// "1-48", "48", and "-8-20" where handles reach below 0.
setup::FrameRange read_frames(const std::string& flag, const std::string& text) {
  constexpr int last_possible = 2'000'000;
  const std::size_t dash = text.find('-', 1);
  const auto first = dash == std::string::npos ? setup::FrameRange::from_start
                                               : number_of<int>(text.substr(0, dash));
  const auto last = number_of<int>(dash == std::string::npos ? text : text.substr(dash + 1));
  if (first && last && *last >= *first && std::abs(*last) <= last_possible &&
      (dash == std::string::npos || std::abs(*first) <= last_possible))
    return {*first, *last};
  refuse_value(flag, text, joined(two_numbers(text), "-"),
               "expected A-B with A <= B <= 2000000, or N for all frames up to N");
}

scene::PictureSize read_size(const std::string& flag, const std::string& text) {
  constexpr int smallest = scene::min_side, largest = 1000000;
  const std::size_t cross = std::min(text.find('x'), text.size());
  const auto width = number_of<int>(text.substr(0, cross)),
             height = number_of<int>(text.substr(std::min(cross + 1, text.size())));
  const auto is_possible = [](const std::optional<int>& side) {
    return side && *side >= smallest && *side <= largest;
  };
  if (is_possible(width) && is_possible(height)) return {*width, *height};
  refuse_value(
      flag, text, size_meant(text),
      fmt::format("expected WIDTHxHEIGHT, each {} to {}, as in 1280x720", smallest, largest));
}

double read_time(const std::string& flag, const std::string& text) {
  constexpr double longest = 1e6;
  const bool has_unit = text.size() > 1 && text.back() == 's';
  const auto value = finite_number(has_unit ? text.substr(0, text.size() - 1) : text);
  if (!value || *value < 0 || *value > longest)
    refuse_value(flag, text, "", "expected seconds from 0 to 1000000, as in " + flag + " 0.25s");
  return *value;
}

std::vector<double> read_times(const std::string& flag, const std::string& text) {
  std::vector<double> times;
  for (const std::string& word : comma_separated(text)) {
    const double time = read_time(flag, word);
    if (!times.empty() && !(time > times.back()))
      throw UsageError(flag, "\"" + word + "\" is not after the time before it",
                       "expected times that increase, as in " + flag + " 0.1,0.2,0.5");
    times.push_back(time);
  }
  if (times.empty()) read_time(flag, text);
  return times;
}

/// A folder with the name of a file is found by nobody.
void check_folder(const std::string& flag, const std::string& text, const std::string& example) {
  if (text.empty()) throw UsageError(flag, "names no folder", "expected the path of a folder");
  if (text == "~" || text.starts_with("~/"))
    throw UsageError(flag, "\"" + text + "\" would be a folder with the name ~",
                     "the shell puts your home folder there in " + flag + " " + text +
                         ", with a blank and without quotes");
  const std::string suffix = lower_text(fs::path(text).extension().string());
  std::error_code error;
  for (const char* of_file : {".png", ".exr", ".jpg", ".mp4", ".mov", ".webm", ".gif", ".ply",
                              ".vtp", ".vti", ".vdb", ".bgeo", ".usda", ".npz", ".csv", ".obj"})
    if (!example.empty() && suffix == of_file && !fs::is_directory(text, error))
      throw UsageError(flag, "\"" + text + "\" looks like a file",
                       "expected a folder: files are DIR/" + example + "; omit " + suffix);
}

}  // namespace

Language<std::string> text(const std::string& type, const std::string& example,
                           const Check& check) {
  return {type, example,
          [check](const std::string& flag, const std::string& text) {
            if (check) check(flag, text);
            return text;
          },
          [](const std::string& text) { return text; }};
}

Language<std::string> folder(const std::string& example) {
  return text("DIR", "results", [example](const std::string& flag, const std::string& text) {
    check_folder(flag, text, example);
  });
}

Language<std::string> existing_folder(const std::string& content) {
  return text("DIR", ".", [content](const std::string& flag, const std::string& text) {
    if (!fs::is_directory(text)) refuse_value(flag, text, "", "expected a folder with " + content);
  });
}

Language<std::string> scene_file() {
  return language("", "scene.toml", scene::path_of_scene,
                  [](const std::string& file) { return file; });
}

Language<setup::FrameRange> frames() {
  return {"A-B", "1-48", read_frames, [](const setup::FrameRange& range) {
            const std::string last = std::to_string(range.last);
            return range.first == setup::FrameRange::from_start
                       ? last
                       : std::to_string(range.first) + "-" + last;
          }};
}

Language<scene::PictureSize> size() {
  return {"WxH", "1280x720", read_size, [](const scene::PictureSize& size) {
            return std::to_string(size.width) + "x" + std::to_string(size.height);
          }};
}

Language<double> time() {
  return {"TIME", "0.25s", read_time, scene::toml::number_text};
}

Language<std::vector<double>> times() {
  return {"T,T", "0.1,0.2", read_times, [](const std::vector<double>& times) {
            std::vector<std::string> words;
            for (const double time : times) words.push_back(scene::toml::number_text(time));
            return joined(words, ",");
          }};
}

Language<double> coarsening() {
  return number<double>("N", 1, std::numeric_limits<double>::max(),
                        "a number of at least 1, as in --coarsen 2");
}

}  // namespace neve::app::options
