#include "app/sweep/sheet/key.h"

#include <algorithm>
#include <cmath>

#include "app/support/text.h"
#include "app/sweep/sheet/marks.h"
#include "app/sweep/sheet/sheet_layout.h"

namespace neve::app::sweep::sheet {

namespace {

using Mark = KeyLine::Mark;

// Lengths in sizes of the font.
constexpr float edge = 1, mark_width = 4.4f, line_height = 1.5f, space_above = 0.5f;

void draw_mark(Mark mark, float left, float y, float size, render::Frame& words) {
  const float width = mark_width * size;
  const auto whisker = [&](const std::array<std::uint8_t, 4>& color) {
    draw_whisker_mark({0.25, 0.5, 0.8}, left, width - size, y, size, color, words);
  };
  switch (mark) {
    case Mark::none:
      return;
    case Mark::apart:
    case Mark::together: {
      const int second = mark == Mark::apart ? 1 : 0;
      draw_square("a", 0, left, y, square_width * size, size, words);
      draw_square(second == 1 ? "b" : "a", second, left + (square_width + 0.3f) * size, y,
                  square_width * size, size, words);
      return;
    }
    case Mark::whisker:
      return whisker(white_whisker);
    case Mark::grey_whisker:
      return whisker(grey_whisker);
    case Mark::coarse:
      return whisker(coarse_whisker);
    case Mark::full:
      return draw_square("full", 0, left, y, width - size, size, words);
    case Mark::doubt:
      words.notes.push_back({left, y, "yellow", render::Note::Anchor::left, width - 0.5f * size,
                             false, seal_caution});
  }
}

}  // namespace

std::vector<KeyLine> wrapped_key(const std::vector<KeyLine>& key, int width, int size) {
  const double room = static_cast<double>(width) / size - 2 * edge - mark_width;
  const auto letters = static_cast<std::size_t>(std::max(10.0, room / letter_width));
  std::vector<KeyLine> lines;
  for (const KeyLine& entry : key) {
    const std::size_t first = lines.size();
    for (std::string& text : broken_lines(entry.text, letters))
      lines.push_back({Mark::none, std::move(text)});
    if (lines.size() == first) lines.push_back({});
    lines[first].mark = entry.mark;
  }
  return lines;
}

int key_height(std::size_t lines, int size) {
  if (lines == 0) return 0;
  return static_cast<int>(
      std::lround(size * (space_above + line_height * static_cast<double>(lines))));
}

void draw_key(const std::vector<KeyLine>& lines, float top, float width, float size,
              render::Frame& words) {
  float y = top + space_above * size;
  const float left = edge * size, text = left + mark_width * size;
  for (const KeyLine& line : lines) {
    draw_mark(line.mark, left, y, size, words);
    words.notes.push_back({text, y, line.text, render::Note::Anchor::left,
                           width - text - edge * size, false, seal_grey});
    y += line_height * size;
  }
}

}  // namespace neve::app::sweep::sheet
