#include "render/overlay/text_layout.h"

#include <cfloat>

namespace neve::render::overlay {
namespace {

/// Steps to the start of the next or previous UTF-8 character.
bool is_continuation(char c) {
  return (static_cast<unsigned char>(c) & 0xc0) == 0x80;
}

std::size_t next_character(const std::string& text, std::size_t at) {
  do ++at;
  while (at < text.size() && is_continuation(text[at]));
  return at;
}

/// End of the longest beginning of text that is no wider than width; at least one character.
std::size_t fitting(const ImFont& font, const std::string& text, float width) {
  std::size_t end = next_character(text, 0);
  while (end < text.size()) {
    const std::size_t next = next_character(text, end);
    if (text_width(font, text.substr(0, next)) > width) break;
    end = next;
  }
  return end;
}

/// Returns the end of a line that may be as long as `longest`: its last space, or its last comma or
/// gap between groups of words (three spaces) if that leaves it long enough.
std::size_t end_of_line(const std::string& text, std::size_t longest) {
  const std::size_t last = text.rfind(' ', longest);
  if (last == std::string::npos || last == 0) return longest;
  std::size_t end = last;
  while (end > 0 && !(text[end] == ' ' && (text[end - 1] == ',' || text[end - 1] == ' '))) --end;
  end = 5 * end < 2 * longest ? last : end;
  return text.find_last_not_of(' ', end) + 1;
}

/// The text is too wide: as many of its words or groups of words as fit, with an ellipsis. A word
/// as long as a third of the line is cut.
std::string elide_words(const ImFont& font, const std::string& text, float width) {
  const std::string ellipsis = "\u2026";
  const std::size_t most = fitting(font, text, width - text_width(font, ellipsis));
  const std::size_t end = end_of_line(text, most);
  const std::size_t word = std::min(text.find_first_not_of(' ', end), most);
  const std::size_t word_end = std::min(text.find(' ', word), text.size());
  if (3 * (word_end - word) > most) return text.substr(0, most) + ellipsis;
  const std::size_t last = text.find_last_not_of(", ", end - 1);
  return text.substr(0, last == std::string::npos ? end : last + 1) + ellipsis;
}

}  // namespace

float text_width(const ImFont& font, const std::string& text) {
  return font.CalcTextSizeA(font.FontSize, FLT_MAX, 0, text.c_str(), text.c_str() + text.size()).x;
}

std::string elide(const ImFont& font, const std::string& text, float width) {
  if (text.empty() || text_width(font, text) <= width) return text;
  const std::string ellipsis = "\u2026";
  return text.substr(0, fitting(font, text, width - text_width(font, ellipsis))) + ellipsis;
}

std::vector<std::string> wrap(const ImFont& font, const std::string& text, float width,
                              std::size_t max_lines) {
  std::vector<std::string> lines;
  std::string rest = text;
  while (!rest.empty() && lines.size() < max_lines) {
    if (text_width(font, rest) <= width) {
      lines.push_back(rest);
      break;
    }
    if (lines.size() + 1 == max_lines) {
      lines.push_back(elide_words(font, rest, width));
      break;
    }
    const std::size_t end = end_of_line(rest, fitting(font, rest, width));
    lines.push_back(rest.substr(0, end));
    rest.erase(0, rest.find_first_not_of(' ', end));
  }
  return lines;
}

}  // namespace neve::render::overlay
