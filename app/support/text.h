#pragma once
/// Numbers as text, the same in every locale.

#include <charconv>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace neve::app {

/// A word for a POSIX shell, quoted where it has to be.
std::string shell_word(const std::string& text);
/// The same of a path, which is no option whatever it begins with.
std::string shell_path(const std::string& path);

/// Writes a number with so many digits after the point.
std::string fixed_text(double value, int digits);
/// Writes a number with three significant digits.
std::string rough_text(double value);
/// Three digits, written out: a count.
std::string about_count_text(double value);
/// "1 frame", "7 frames"
std::string count_text(std::size_t count, const char* one);
/// "1.2 GiB"
std::string bytes_text(std::uint64_t bytes);
/// "8GiB" or "1.5 MB" in bytes.
std::optional<double> bytes_of(std::string_view text);
/// Writes control characters as \x1b and the like: those of a stranger's file do nothing to a
/// terminal. Line feeds and tabs stay.
std::string printable_text(const std::string& text);
/// The same on one line: line feeds and tabs are written out too.
std::string line_text(const std::string& text);
/// Lets a stream pass its text through printable_text(), to the end of the program.
void make_printable(std::ostream& out);
/// The number that a text is, and nothing else, not even blanks.
template <class Number = double>
std::optional<Number> number_of(std::string_view text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, number);
  return error == std::errc{} && last == end ? std::optional(number) : std::nullopt;
}
/// A finite number that is all of the text.
std::optional<double> finite_number(std::string_view text);
/// Returns the text with A to Z as a to z, whatever the locale; other bytes stay.
std::string lower_text(std::string_view text);
/// Returns the text without the blanks around it.
std::string trimmed(std::string_view text, std::string_view blanks = " \t");
/// Breaks a text into lines of at most so many bytes, but for longer words; none without words.
std::vector<std::string> broken_lines(const std::string& text, std::size_t most);
/// The last line that has more than blanks; "" if none has.
std::string last_line(std::string_view text);
/// "a,b" without empty words.
std::vector<std::string> comma_separated(std::string_view text);
/// A text with its numbers, roughly, in place of {}.
std::string filled(std::string_view text, const std::vector<double>& numbers);
std::string joined(const std::vector<std::string>& words, const std::string& between);
/// "a, b, c, d, e and 12 more"; all where there are few.
std::string first_joined(std::vector<std::string> words);

}  // namespace neve::app
