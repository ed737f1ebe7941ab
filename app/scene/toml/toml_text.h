#pragma once
/// Untrusted TOML made harmless for the parser: valid, bounded in size and depth, and ASCII only.
///
/// toml++ 3.3.0 runs into undefined behaviour on non-ASCII characters on its error paths and
/// overflows the stack on deep input. So code points in comments become '?', those in basic
/// strings become escapes (columns are mapped back), and anywhere else they are errors.

#include <string>
#include <string_view>
#include <vector>

#include "app/scene/toml/value.h"

namespace neve::app::scene::toml {

/// Limits on a file and, larger, on any text: neve writes out what people leave to defaults.
inline constexpr std::size_t max_toml_bytes = 1 << 20, max_text_bytes = 16 << 20;

struct AsciiToml {
  std::string text;

  /// Location in the user's text of this line and column of `text`.
  Location original(int line, int column) const;

  /// A code point written as an escape of `length` columns, from `column` of `text`.
  struct Escape {
    int line, column, length;
    int before;  ///< columns that the escapes before it in its line are longer
  };
  std::vector<Escape> escapes;  ///< in the order of the text
};

/// @param file only named in errors
/// @throws SceneError located in the user's text
AsciiToml to_ascii_toml(std::string_view text, const std::string& file);

bool is_utf8(std::string_view text);

/// True if `text` is valid UTF-8 without control bytes other than tab, LF and CR.
bool is_clean_text(std::string_view text);

}  // namespace neve::app::scene::toml
