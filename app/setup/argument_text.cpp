#include "app/setup/argument_text.h"

#include <algorithm>
#include <cmath>
#include <regex>
#include <utility>

#include "app/support/errors.h"
#include "app/support/lower_text.h"
#include "app/support/text.h"

namespace neve::app::setup {

std::optional<double> finite_number(const std::string& text) {
  const std::optional<double> value = number_of(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

namespace {

/// The two whole numbers of a text with other signs between them; empty: it has not two.
std::vector<std::string> two_numbers(const std::string& text) {
  static const std::regex pair(R"(^\s*([0-9]{1,7})\s*(?:\.\.|:|,|;|\*|X|by| )\s*([0-9]{1,7})\s*$)");
  std::smatch found;
  if (!std::regex_match(text, found, pair)) return {};
  return {found[1], found[2]};
}

/// "1920x1080" of "1920*1080", "hd" and the like; empty: nothing known.
std::string size_meant(const std::string& text) {
  constexpr std::pair<const char*, const char*> names[] = {
      {"hd", "1280x720"},   {"720p", "1280x720"},   {"fullhd", "1920x1080"}, {"1080p", "1920x1080"},
      {"2k", "1920x1080"},  {"1440p", "2560x1440"}, {"4k", "3840x2160"},     {"2160p", "3840x2160"},
      {"uhd", "3840x2160"}, {"vga", "640x480"}};
  for (const auto& [name, size] : names)
    if (lower_text(text) == name) return size;
  const std::vector<std::string> numbers = two_numbers(text);
  return numbers.empty() ? "" : numbers[0] + "x" + numbers[1];
}

/// "did you mean 1-24? " of "1..24".
std::string range_meant(const std::string& text) {
  const std::vector<std::string> numbers = two_numbers(text);
  return numbers.empty() ? "" : "did you mean " + numbers[0] + "-" + numbers[1] + "? ";
}

}  // namespace

FrameRange parse_frames(const std::string& text) {
  constexpr int last_possible = 100'000;
  const std::size_t dash = text.find('-');
  const auto first = dash == std::string::npos ? 0 : number_of<int>(text.substr(0, dash));
  const auto last = number_of<int>(dash == std::string::npos ? text : text.substr(dash + 1));
  if (!first || !last || *first < 0 || *last < *first || *last > last_possible)
    throw UsageError("--frames", "cannot use \"" + text + "\"",
                     range_meant(text) + "expected A-B with 0 <= A <= B <= 100000, or N for 0-N");
  return {*first, *last};
}

double parse_coarsening(const std::string& text) {
  const auto value = finite_number(text);
  if (!value)
    throw UsageError("--coarsen", "cannot use \"" + text + "\"",
                     "expected a number of at least 1, as in --coarsen 2");
  return *value;
}

scene::PictureSize parse_size(const std::string& text) {
  constexpr int smallest = 16, largest = 1000000;
  const std::size_t cross = text.find('x');
  const auto width =
      cross == std::string::npos ? std::nullopt : number_of<int>(text.substr(0, cross));
  const auto height =
      cross == std::string::npos ? std::nullopt : number_of<int>(text.substr(cross + 1));
  if (!width || !height || *width < smallest || *height < smallest || *width > largest ||
      *height > largest) {
    const std::string meant = size_meant(text);
    throw UsageError("--size", "cannot use \"" + text + "\"",
                     (meant.empty() ? "" : "did you mean " + meant + "? ") +
                         "expected WIDTHxHEIGHT, each 16 to 1000000, as in 1280x720");
  }
  return {*width, *height};
}

double parse_time(const std::string& text, const char* flag) {
  constexpr double longest = 1e6;
  const bool has_unit = text.size() > 1 && text.back() == 's';
  const auto value = finite_number(has_unit ? text.substr(0, text.size() - 1) : text);
  if (!value || *value < 0 || *value > longest)
    throw UsageError(flag, "cannot use \"" + text + "\"",
                     std::string("expected seconds from 0 to 1000000, as in ") + flag + " 0.25s");
  return *value;
}

std::vector<double> parse_times(const std::string& text) {
  std::vector<double> times;
  for (const std::string& word : comma_separated(text)) {
    const double time = parse_time(word);
    if (!times.empty() && !(time > times.back()))
      throw UsageError("--at", "\"" + word + "\" is not after the time before it",
                       "expected times that increase, as in --at 0.1,0.2,0.5");
    times.push_back(time);
  }
  if (times.empty()) parse_time(text);
  return times;
}

std::vector<std::string> comma_separated(const std::string& text) {
  std::vector<std::string> words;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    if (end > begin) words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

}  // namespace neve::app::setup
