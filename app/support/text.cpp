#include "app/support/text.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace neve::app {

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

std::string filled(std::string_view text, const std::vector<double>& numbers) {
  std::string out;
  for (const double number : numbers) {
    const std::size_t at = text.find("{}");
    if (at == text.npos) break;
    out.append(text.substr(0, at)).append(rough_text(number));
    text.remove_prefix(at + 2);
  }
  return out.append(text);
}

std::string about_count_text(double value) {
  const double unit = value < 1000 ? 1 : std::pow(10, std::floor(std::log10(value)) - 2);
  return fixed_text(unit * std::round(value / unit), 0);
}

std::string count_text(std::size_t count, const char* one) {
  return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
}

std::string bytes_text(std::uint64_t bytes) {
  static const char* const units[] = {"B", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 1024 && unit + 1 < std::size(units); ++unit) value /= 1024;
  return fixed_text(value, unit == 0 || value >= 100 ? 0 : 1) + " " + units[unit];
}

std::optional<double> bytes_of(std::string_view text) {
  struct Suffix {
    std::string_view name;
    double factor;
  };
  // K, M, G and T alone as for Slurm, Docker and systemd: powers of 1024.
  constexpr Suffix suffixes[] = {{"KiB", 0x1p10}, {"MiB", 0x1p20}, {"GiB", 0x1p30}, {"TiB", 0x1p40},
                                 {"kB", 1e3},     {"KB", 1e3},     {"MB", 1e6},     {"GB", 1e9},
                                 {"TB", 1e12},    {"B", 1},        {"K", 0x1p10},   {"M", 0x1p20},
                                 {"G", 0x1p30},   {"T", 0x1p40}};
  double count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  while (text.starts_with(' ')) text.remove_prefix(1);
  for (const Suffix& suffix : suffixes) {
    if (text == suffix.name) return std::trunc(count * suffix.factor);
  }
  return std::nullopt;
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

std::string line_text(const std::string& text) {
  std::string line;
  for (const char c : printable_text(text))
    line += c == '\n' ? "\\x0a" : c == '\t' ? "\\x09" : std::string(1, c);
  return line;
}

std::optional<double> finite_number(std::string_view text) {
  const std::optional<double> value = number_of(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::string lower_text(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::string trimmed(std::string_view text, std::string_view blanks) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(blanks) - first + 1));
}

std::vector<std::string> broken_lines(const std::string& text, std::size_t most) {
  std::vector<std::string> lines;
  std::istringstream words(text);
  for (std::string word; words >> word;)
    if (lines.empty() || lines.back().size() + 1 + word.size() > most)
      lines.push_back(word);
    else
      lines.back() += " " + word;
  return lines;
}

std::string last_line(std::string_view text) {
  const std::string whole = trimmed(text, " \t\r\n");
  return whole.substr(whole.find_last_of("\r\n") + 1);
}

std::vector<std::string> comma_separated(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t begin = 0, end; begin < text.size(); begin = end + 1) {
    end = std::min(text.find(',', begin), text.size());
    if (end > begin) words.emplace_back(text.substr(begin, end - begin));
  }
  return words;
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::string first_joined(std::vector<std::string> words) {
  constexpr std::size_t most = 5;
  if (words.size() <= most) return joined(words, ", ");
  const std::size_t left = words.size() - most;
  words.resize(most);
  return joined(words, ", ") + " and " + std::to_string(left) + " more";
}

std::string shell_word(const std::string& text) {
  const std::string plain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-./,=+:@%";
  if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string shell_path(const std::string& path) {
  return shell_word(path.starts_with('-') ? "./" + path : path);
}

}  // namespace neve::app
