#include "app/view/picker/layout.h"

#include <algorithm>
#include <cmath>

namespace neve::app::view::picker {

namespace {

constexpr float narrow = 64;  // text sizes; in less there is room for one column

/// Places nine tiles as large as they can be, in the middle of the width.
Grid grid_in(const Box& box, float gap, int tile_width, int tile_height) {
  const float shape = static_cast<float>(tile_height) / static_cast<float>(tile_width);
  const float across = (box.width - 2 * gap) / 3, down = (box.height - 2 * gap) / 3;
  const float width = std::max(8.0f, std::min(across, down / shape));
  Grid grid;
  grid.gap = std::max(1, static_cast<int>(gap));
  grid.tile_width = static_cast<int>(width);
  grid.tile_height = std::max(4, static_cast<int>(std::lround(width * shape)));
  grid.x = static_cast<int>(box.x + 0.5f * (box.width - static_cast<float>(grid.width())));
  grid.y = static_cast<int>(std::ceil(box.y));
  return grid;
}

}  // namespace

Layout lay_out(int width, int height, float em, int axes, int tile_width, int tile_height) {
  const auto w = static_cast<float>(width), h = static_cast<float>(height);
  const float margin = 0.6f * em;
  const float axes_height = (1.75f * static_cast<float>(axes) + 2.2f) * em;
  Layout out;
  out.is_stacked = w < narrow * em;
  if (out.is_stacked) {
    out.bar = {0, 0, w, 4.2f * em};
    out.buttons.height = 6.2f * em;
    // The tiles take what the words and the buttons leave of a low screen.
    const float most = h - out.bar.height - out.buttons.height - 8 * em;
    out.grid = grid_in({margin, out.bar.height, w - 2 * margin, std::max(6 * em, most)}, 0.25f * em,
                       tile_width, tile_height);
    const float below = static_cast<float>(out.grid.y + out.grid.height()) + 0.4f * em;
    out.buttons = {0, below, w, out.buttons.height};
    const float words = below + out.buttons.height;
    out.words = {0, words, w, std::max(0.0f, h - words)};
    return out;
  }
  out.bar = {0, 0, w, 2.8f * em};
  const float side = std::clamp(0.28f * w, 23 * em, 30 * em);
  const float left = w - side;
  const float wanted = std::min(axes_height, 0.35f * (h - out.bar.height));
  out.grid =
      grid_in({margin, out.bar.height, left - 2 * margin, h - out.bar.height - wanted - margin},
              0.3f * em, tile_width, tile_height);
  const float below = static_cast<float>(out.grid.y + out.grid.height()) + 0.3f * em;
  out.axes = {0, below, left, std::max(0.0f, h - below)};
  out.words = {left, out.bar.height, side, h - out.bar.height};
  return out;
}

}  // namespace neve::app::view::picker
