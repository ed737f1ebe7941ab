/// Notes and patches: words and rectangles at places of the finished picture; smaller pictures.

#include "gl_test.h"
#include "render/frame/compose.h"

namespace neve::render {
namespace {

Image gray(int width, int height) {
  return {width, height, 3, std::vector<std::uint8_t>(3u * width * height, 90)};
}

struct Box {
  int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;
};

Box changed_box(const Image& image) {
  Box box;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Pixel p = pixel(image, x, y);
      if (p.r == 90 && p.g == 90 && p.b == 90) continue;
      box = {std::min(box.left, x), std::max(box.right, x), std::min(box.top, y),
             std::max(box.bottom, y)};
    }
  return box;
}

Box drawn(Renderer& renderer, const Note& note) {
  Frame frame;
  frame.width = 400;
  frame.height = 200;
  frame.font_size = 16;
  frame.notes = {note};
  return changed_box(renderer.draw_over(gray(400, 200), frame));
}

TEST(Notes, StandWhereTheyAreAnchored) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Note note{200, 80, "HHHH", Note::Anchor::left, 0, false, {240, 244, 250}};
  const Box left = drawn(renderer, note);
  EXPECT_NEAR(left.left, 200, 3);
  EXPECT_GE(left.top, 80);
  EXPECT_LE(left.bottom, 80 + 18);
  note.anchor = Note::Anchor::right;
  EXPECT_NEAR(drawn(renderer, note).right, 200, 3);
  note.anchor = Note::Anchor::middle;
  const Box middle = drawn(renderer, note);
  EXPECT_NEAR(0.5 * (middle.left + middle.right), 200, 2);
  note.text = std::string(100, 'H');
  note.room = 90;
  const Box elided = drawn(renderer, note);
  EXPECT_LE(elided.right - elided.left, 92);
  EXPECT_GT(elided.right - elided.left, 60);
}

TEST(Notes, PatchesLieBelowThem) {
  OPEN_OR_SKIP(context, "auto");
  Renderer renderer(*context);
  Frame frame;
  frame.width = 400;
  frame.height = 200;
  frame.patches = {{40, 20, 100, 50, {255, 0, 0, 255}}};
  const Image image = renderer.draw_over(gray(400, 200), frame);
  EXPECT_EQ(pixel(image, 41, 21).r, 255);
  EXPECT_EQ(pixel(image, 138, 68).g, 0);
  EXPECT_EQ(pixel(image, 142, 68).g, 90);
  EXPECT_EQ(pixel(image, 41, 18).g, 90);
}

TEST(Shrink, ShrunkPixelIsTheMeanOfWhatAPixelCovers) {
  Image image{4, 2, 3, {}};
  for (int k = 0; k < 8; ++k)
    for (int c = 0; c < 3; ++c) image.pixels.push_back(static_cast<std::uint8_t>(10 * k + c));
  const Image half = shrink(image, 2, 1);
  EXPECT_EQ(half.pixels, (std::vector<std::uint8_t>{25, 26, 27, 45, 46, 47}));
  EXPECT_EQ(shrink(image, 4, 2).pixels, image.pixels);
  // The first of three covers a pixel and a third of the next, of both rows.
  const Image thirds = shrink(image, 3, 1);
  EXPECT_NEAR(thirds.pixels[0], 20 + (0 * 1.0 + 10 / 3.0) / (4 / 3.0), 1);
}

}  // namespace
}  // namespace neve::render
