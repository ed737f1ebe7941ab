/// Places on the screen of `neve pick`.

#include "app/view/picker/layout.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace neve::app::view::picker {
namespace {

struct Screen {
  int width, height;
  float em;
};

bool is_apart(const Box& a, const Box& b) {
  if (a.width * a.height == 0 || b.width * b.height == 0) return true;
  return a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y ||
         b.y + b.height <= a.y;
}

std::vector<Box> boxes_of(const Layout& layout) {
  const Grid& g = layout.grid;
  return {layout.bar,
          {float(g.x), float(g.y), float(g.width()), float(g.height())},
          layout.buttons,
          layout.axes,
          layout.words};
}

void expect_apart_and_inside(const Screen& screen, int axes) {
  SCOPED_TRACE(std::to_string(screen.width) + "x" + std::to_string(screen.height));
  const std::vector<Box> boxes =
      boxes_of(lay_out(screen.width, screen.height, screen.em, axes, 480, 270));
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    EXPECT_GE(boxes[k].x, 0);
    EXPECT_LE(boxes[k].x + boxes[k].width, float(screen.width));
    EXPECT_LE(boxes[k].y + boxes[k].height, float(screen.height));
    for (std::size_t j = k + 1; j < boxes.size(); ++j)
      EXPECT_TRUE(is_apart(boxes[k], boxes[j])) << k << " and " << j;
  }
}

/// A desk, a laptop, a phone held upright with one and three pixels per point, one on its side.
TEST(PickLayout, NothingOverlapsOnDeskAndPhone) {
  for (const int axes : {1, 4, 8})
    for (const Screen& screen :
         {Screen{1280, 800, 14}, Screen{1440, 860, 14}, Screen{1920, 1080, 14},
          Screen{1280, 600, 14}, Screen{390, 844, 14}, Screen{1170, 2532, 42},
          Screen{844, 390, 14}})
      expect_apart_and_inside(screen, axes);
}

TEST(PickLayout, APhoneHasThreeTilesAcrossAndWordsBelow) {
  const Layout layout = lay_out(390, 844, 14, 4, 480, 270);
  EXPECT_TRUE(layout.is_stacked);
  EXPECT_GT(layout.grid.width(), 360);
  EXPECT_GT(layout.grid.tile_x(2), 240);
  EXPECT_GT(layout.words.y, float(layout.grid.y + layout.grid.height()));
  EXPECT_GT(layout.words.height, 300);
}

TEST(PickLayout, ADeskHasWordsBesideTheTiles) {
  const Layout layout = lay_out(1280, 800, 14, 4, 480, 270);
  EXPECT_FALSE(layout.is_stacked);
  EXPECT_GT(layout.grid.tile_width, 280);
  EXPECT_GE(layout.words.x, float(layout.grid.x + layout.grid.width()));
  EXPECT_GT(layout.axes.height, 8 * 14);
}

}  // namespace
}  // namespace neve::app::view::picker
