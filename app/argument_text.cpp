#include "app/argument_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include "app/scene/error.h"
#include "app/scene/names.h"
#include "app/text.h"

namespace neve::app {

namespace {

std::optional<int> whole_number(const std::string& text) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (text.empty() || result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return value;
}

/// Finite, and nothing after it.
std::optional<double> finite_number(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (text.empty() || result.ec != std::errc() || result.ptr != end || !std::isfinite(value))
    return std::nullopt;
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
  const auto value = finite_number(text);
  if (!value)
    throw UsageError("--coarsen", "cannot use \"" + text + "\"",
                     "expected a number of at least 1, as in --coarsen 2");
  return *value;
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

double parse_time(const std::string& text) {
  constexpr double longest = 1e6;
  const bool has_unit = text.size() > 1 && text.back() == 's';
  const auto value = finite_number(has_unit ? text.substr(0, text.size() - 1) : text);
  if (!value || *value < 0 || *value > longest)
    throw UsageError("--at", "cannot use \"" + text + "\"",
                     "expected seconds from 0 to 1000000, as in --at 0.25s");
  return *value;
}

sim::Stage parse_stage(const std::string& text) {
  if (const auto stage = value_named<sim::Stage>(text)) return *stage;
  throw UsageError("--stage", "there is no stage \"" + text + "\"",
                   names_advice(text, {sim::stage_names.begin(), sim::stage_names.end()}));
}

Probe parse_probe(const std::string& text) {
  if (const auto id = whole_number(text); id && *id >= 0) return static_cast<std::size_t>(*id);
  std::vector<double> numbers;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const auto value = finite_number(text.substr(begin, comma - begin));
    if (!value) break;
    numbers.push_back(*value);
    begin = comma + 1;
  }
  if (begin <= text.size() || numbers.size() != 3)
    throw UsageError("--probe", "cannot use \"" + text + "\"",
                     "expected the id of a particle, or a place as in --probe 0,0.5,0");
  return sim::Vec3d(numbers[0], numbers[1], numbers[2]);
}

DumpFormat parse_format(const std::string& text) {
  if (text == "table") return DumpFormat::table;
  if (text == "vtk") return DumpFormat::vtk;
  throw UsageError("--format", "cannot use \"" + text + "\"", "expected table or vtk");
}

}  // namespace neve::app
