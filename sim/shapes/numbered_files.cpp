#include "sim/shapes/numbered_files.h"

#include <algorithm>
#include <optional>

#include "sim/shapes/shape.h"

namespace neve::sim::shapes {
namespace {

/// The place of a number in a path.
struct Blank {
  std::size_t begin, end;
  std::size_t digits;  ///< at least so many
};

/// The blank that begins at a place, which has one of the signs.
std::optional<Blank> blank_at(const std::string& pattern, std::size_t begin) {
  const auto digit = [&](std::size_t at) -> std::size_t {
    const char c = at < pattern.size() ? pattern[at] : 'x';
    return c >= '1' && c <= '9' ? static_cast<std::size_t>(c - '0') : 0;
  };
  if (pattern[begin] == '#') {
    const std::size_t end = std::min(pattern.find_first_not_of('#', begin), pattern.size());
    return Blank{begin, end, end - begin};
  }
  if (pattern.compare(begin, 2, "$F") == 0)
    return digit(begin + 2) > 0 ? Blank{begin, begin + 3, digit(begin + 2)}
                                : Blank{begin, begin + 2, 1};
  if (pattern.compare(begin, 2, "%d") == 0) return Blank{begin, begin + 2, 1};
  const bool has_width = pattern.compare(begin, 2, "%0") == 0 && digit(begin + 2) > 0 &&
                         pattern.compare(begin + 3, 1, "d") == 0;
  if (!has_width) return {};
  return Blank{begin, begin + 4, digit(begin + 2)};
}

std::optional<Blank> find_blank(const std::string& pattern) {
  constexpr const char* signs = "%#$";
  const std::size_t name = pattern.rfind('/') == std::string::npos ? 0 : pattern.rfind('/') + 1;
  const std::size_t begin = pattern.find_first_of(signs, name);
  if (begin == std::string::npos) return {};
  const std::optional<Blank> blank = blank_at(pattern, begin);
  if (!blank || pattern.find_first_of(signs, blank->end) != std::string::npos) return {};
  return blank;
}

}  // namespace

bool is_file_pattern(const std::string& pattern) {
  return find_blank(pattern).has_value();
}

std::string numbered_file(const std::string& pattern, int number) {
  const std::optional<Blank> blank = find_blank(pattern);
  if (!blank) return pattern;
  // The sign counts as a digit, as for printf.
  const std::size_t signs = number < 0 ? 1 : 0;
  std::string digits = std::to_string(number);
  if (digits.size() < blank->digits) digits.insert(signs, blank->digits - digits.size(), '0');
  return pattern.substr(0, blank->begin) + digits + pattern.substr(blank->end);
}

std::vector<std::string> files_of(const MeshSequence& sequence) {
  const double count = static_cast<double>(sequence.last) - sequence.first + 1;
  if (!is_file_pattern(sequence.files))
    throw ShapeError(
        sequence.files +
        ": expected one %d, %04d, #### or $F4 in the name of the files, where their number goes");
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
