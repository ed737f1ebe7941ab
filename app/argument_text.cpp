#include "app/argument_text.h"

#include <charconv>
#include <optional>

#include "app/scene/error.h"

namespace neve::app {

namespace {

std::optional<int> whole_number(const std::string& text) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (text.empty() || result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return value;
}

}  // namespace

FrameRange parse_frames(const std::string& text) {
  constexpr int last_possible = 100'000;
  const std::size_t dash = text.find('-');
  const auto first = dash == std::string::npos ? 0 : whole_number(text.substr(0, dash));
  const auto last = whole_number(dash == std::string::npos ? text : text.substr(dash + 1));
  if (!first || !last || *first < 0 || *last < *first || *last > last_possible)
    throw UsageError("--frames", "cannot use \"" + text + "\"",
                     "expected A-B with 0 <= A <= B <= 100000, or N for 0-N");
  return {*first, *last};
}

double parse_coarsening(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (text.empty() || result.ec != std::errc() || result.ptr != end)
    throw UsageError("--coarsen", "cannot use \"" + text + "\"",
                     "expected a number of at least 1, as in --coarsen 2");
  return value;
}

PictureSize parse_size(const std::string& text) {
  constexpr int smallest = 16, largest = 1000000;
  const std::size_t cross = text.find('x');
  const auto width =
      cross == std::string::npos ? std::nullopt : whole_number(text.substr(0, cross));
  const auto height =
      cross == std::string::npos ? std::nullopt : whole_number(text.substr(cross + 1));
  if (!width || !height || *width < smallest || *height < smallest || *width > largest ||
      *height > largest)
    throw UsageError("--size", "cannot use \"" + text + "\"",
                     "expected WIDTHxHEIGHT, each 16 to 1000000, as in 1280x720");
  return {*width, *height};
}

}  // namespace neve::app
