#pragma once
/// The byte order mark that some programs put in front of a text.

#include <string_view>

namespace neve {

/// A text as its reader wants it. All readers of text from others begin here.
inline std::string_view without_mark(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return text;
}

}  // namespace neve
