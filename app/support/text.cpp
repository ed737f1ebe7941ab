#include "app/support/text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace neve::app {

namespace {

/// Letters inserted, dropped, replaced, or swapped with their neighbour; `most` if they are more.
std::size_t edit_distance(const std::string& a, const std::string& b, std::size_t most) {
  std::vector<std::size_t> row(b.size() + 1), above(row.size()), above2(row.size());
  std::iota(row.begin(), row.end(), std::size_t{0});
  std::size_t least_above = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    above2.swap(above);
    above.swap(row);
    row[0] = i + 1;
    std::size_t least = row[0];
    for (std::size_t j = 0; j < b.size(); ++j) {
      std::size_t distance = std::min(above[j] + (a[i] != b[j]), row[j] + 1);
      distance = std::min(distance, above[j + 1] + 1);
      const bool is_swap = i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j];
      if (is_swap) distance = std::min(distance, above2[j - 1] + 1);
      row[j + 1] = distance;
      least = std::min(least, distance);
    }
    // Rows to come are made from these two.
    if (std::min(least, least_above) >= most) return most;
    least_above = least;
  }
  return std::min(row[b.size()], most);
}

using Letters = std::array<int, 256>;

Letters letters_of(const std::string& text) {
  Letters letters{};
  for (const char c : text) ++letters[static_cast<unsigned char>(c)];
  return letters;
}

/// Letters that only one of two words has: no fewer changes make one of the other.
std::size_t least_distance(Letters letters, std::size_t size, const std::string& other) {
  std::size_t more = 0;
  for (const char c : other) more += --letters[static_cast<unsigned char>(c)] < 0;
  return std::max(more, size - (other.size() - more));
}

}  // namespace

std::string fixed_text(double value, int digits) {
  char buffer[400];
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, digits);
  return {buffer, end.ptr};
}

std::string rough_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string about_count_text(double value) {
  const double unit = value < 1000 ? 1 : std::pow(10, std::floor(std::log10(value)) - 2);
  return fixed_text(unit * std::round(value / unit), 0);
}

std::string bytes_text(std::uint64_t bytes) {
  static const char* const units[] = {"B", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 1024 && unit + 1 < std::size(units); ++unit) value /= 1024;
  return fixed_text(value, unit == 0 || value >= 100 ? 0 : 1) + " " + units[unit];
}

std::string nearest_name(const std::string& wrong, const std::vector<std::string>& names) {
  const auto is_same = [&](const std::string& name) {
    return std::equal(wrong.begin(), wrong.end(), name.begin(), name.end(), [](char a, char b) {
      return std::tolower(static_cast<unsigned char>(a)) ==
             std::tolower(static_cast<unsigned char>(b));
    });
  };
  if (const auto same = std::find_if(names.begin(), names.end(), is_same); same != names.end())
    return *same;
  std::string nearest;
  // A third of the letters wrong is still a typing error; more is another word.
  std::size_t best = std::max<std::size_t>(1, wrong.size() / 3) + 1;
  // Each letter is as near to any other.
  if (wrong.size() < 2 || wrong.size() > 64) return nearest;
  const Letters letters = letters_of(wrong);
  for (const std::string& name : names) {
    if (least_distance(letters, wrong.size(), name) >= best) continue;
    const std::size_t distance = edit_distance(wrong, name, best);
    if (distance < best) best = distance, nearest = name;
  }
  return nearest;
}

std::string printable_text(const std::string& text) {
  std::string printable;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto c = static_cast<unsigned char>(text[k]);
    // U+0080 to U+009F, which terminals obey too, are c2 80 to c2 9f in UTF-8.
    const auto next = k + 1 < text.size() ? static_cast<unsigned char>(text[k + 1]) : 0;
    const bool is_long_control = c == 0xc2 && next >= 0x80 && next < 0xa0;
    const bool is_control = (c < ' ' && c != '\n' && c != '\t') || c == 0x7f || is_long_control;
    char code[8];
    std::snprintf(code, sizeof code, "\\x%02x", is_long_control ? next : c);
    printable += is_control ? std::string(code) : std::string(1, text[k]);
    k += is_long_control;
  }
  return printable;
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::string names_advice(const std::string& wrong, const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(wrong, names);
  return (nearest.empty() ? "" : "did you mean " + nearest + "? ") + "expected " +
         joined(names, ", ");
}

}  // namespace neve::app
