#pragma once
/// Small letters, whatever the locale.

#include <string>
#include <string_view>

namespace neve::app {

/// With A to Z as a to z; other bytes stay.
inline std::string lower_text(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

}  // namespace neve::app
