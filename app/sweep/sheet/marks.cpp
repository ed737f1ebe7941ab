#include "app/sweep/sheet/marks.h"

#include <algorithm>

namespace neve::app::sweep::sheet {

namespace {

constexpr std::array<std::uint8_t, 4> rail{96, 106, 122, 255};

}  // namespace

void draw_whisker_mark(const WhiskerSpan& span, float left, float length, float y, float size,
                       const std::array<std::uint8_t, 4>& color, render::Frame& words) {
  const float middle = y + 0.55f * size;
  const auto at = [&](double share) { return left + static_cast<float>(share) * length; };
  const float thin = std::max(1.0f, 0.1f * size), thick = std::max(2.0f, 0.22f * size),
              dot = 0.6f * size;
  words.patches.push_back({left, middle - 0.5f * thin, length, thin, rail});
  words.patches.push_back({at(span.min) - 0.5f * thick, middle - 0.5f * thick,
                           at(span.max) - at(span.min) + thick, thick, color});
  words.patches.push_back({at(span.mean) - 0.5f * dot, middle - 0.5f * dot, dot, dot, color});
}

void draw_square(const std::string& letters, int group, float left, float y, float width,
                 float size, render::Frame& words) {
  const auto& c = group_colours[static_cast<std::size_t>(group) % group_colours.size()];
  words.patches.push_back(
      {left, y - 0.1f * size, width - 0.1f * size, 1.3f * size, {c[0], c[1], c[2], 255}});
  words.notes.push_back(
      {left + 0.5f * width, y, letters, render::Note::Anchor::middle, width, false, seal_ink});
}

}  // namespace neve::app::sweep::sheet
