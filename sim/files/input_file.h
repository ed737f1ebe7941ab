#pragma once
/// Text and tables that users bring along: how they are read, and how their parts are shown.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace neve::sim::files {

/// The bytes of a regular file, not allocated before its size is known to be allowed.
/// @param max_mebibytes  larger files are refused
/// @param whats  name of files of this kind in messages: "meshes"
/// @throws ShapeError with the path in front
std::string read_input_file(const std::string& path, std::uintmax_t max_mebibytes,
                            const std::string& whats);

/// A text without a byte order mark. @throws ShapeError for a text of UTF-16
std::string_view plain_text(std::string_view text, const std::string& name);

/// @throws ShapeError WHERE: WHAT
[[noreturn]] void refuse_input(const std::string& where, const std::string& what);

/// Text from a file as it may be shown in a message: short and printable.
std::string quoted_input(std::string_view word);

/// Blank, but not the end of a line.
inline bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

/// Returns a text without blanks at both ends.
std::string_view trimmed(std::string_view text);

/// All of a word, blanks around it aside, as a number, which may be infinite or not a number;
/// nothing for other text. Independent of the locale.
std::optional<double> number_in(std::string_view word);

}  // namespace neve::sim::files
