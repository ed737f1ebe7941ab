#include "sim/shapes/numbered_files.h"

#include <optional>

#include "sim/shapes/shape.h"

namespace neve::sim::shapes {
namespace {

/// The place of a number in a path.
struct Blank {
  std::size_t begin, end;
  std::size_t digits;  ///< at least so many
};

std::optional<Blank> find_blank(const std::string& pattern) {
  const std::size_t name = pattern.rfind('/') == std::string::npos ? 0 : pattern.rfind('/') + 1;
  const std::size_t begin = pattern.find('%', name);
  if (begin == std::string::npos || pattern.find('%', begin + 1) != std::string::npos) return {};
  const std::string after = pattern.substr(begin + 1, 3);
  if (after.starts_with('d')) return Blank{begin, begin + 2, 1};
  const bool has_width =
      after.size() == 3 && after[0] == '0' && after[1] >= '1' && after[1] <= '9' && after[2] == 'd';
  if (!has_width) return {};
  return Blank{begin, begin + 4, static_cast<std::size_t>(after[1] - '0')};
}

}  // namespace

bool is_file_pattern(const std::string& pattern) {
  return find_blank(pattern).has_value();
}

std::string numbered_file(const std::string& pattern, int number) {
  const std::optional<Blank> blank = find_blank(pattern);
  if (!blank) return pattern;
  std::string digits = std::to_string(number);
  if (digits.size() < blank->digits) digits.insert(0, blank->digits - digits.size(), '0');
  return pattern.substr(0, blank->begin) + digits + pattern.substr(blank->end);
}

std::vector<std::string> files_of(const MeshSequence& sequence) {
  const double count = static_cast<double>(sequence.last) - sequence.first + 1;
  if (!is_file_pattern(sequence.files))
    throw ShapeError(sequence.files +
                     ": expected one %d or %04d in the name of the files, where their number goes");
  if (!(count >= 2) || count > max_numbered_files || sequence.first < 0)
    throw ShapeError(sequence.files + ": numbers " + std::to_string(sequence.first) + " to " +
                     std::to_string(sequence.last) + "; expected 2 to " +
                     std::to_string(max_numbered_files) + " files, from 0 or more");
  std::vector<std::string> paths;
  for (int number = sequence.first; number <= sequence.last; ++number)
    paths.push_back(numbered_file(sequence.files, number));
  return paths;
}

}  // namespace neve::sim::shapes
