/// Lines of captions.

#include "render/overlay/text_layout.h"

#include <gtest/gtest.h>

namespace neve::render::overlay {
namespace {

class TextLayout : public testing::Test {
 protected:
  TextLayout() {
    font = atlas.AddFontDefault();
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    atlas.GetTexDataAsAlpha8(&pixels, &width, &height);
  }
  /// Returns the lines of a text, each as wide as so many letters: all of this font are as wide.
  std::vector<std::string> wrapped(const std::string& text, int letters) {
    return wrap(*font, text, static_cast<float>(letters) * text_width(*font, "x"), 9);
  }

  ImFontAtlas atlas;
  ImFont* font = nullptr;
};

using Lines = std::vector<std::string>;

TEST_F(TextLayout, ALineEndsBehindACommaBeforeANumberLosesItsName) {
  EXPECT_EQ(wrapped("2 430 particles, coarsened 2x   7 steps, dt 0.00117 s (acoustic)", 44),
            (Lines{"2 430 particles, coarsened 2x   7 steps,", "dt 0.00117 s (acoustic)"}));
  EXPECT_EQ(wrapped("2 430 particles, coarsened 2x   7 steps, dt 0.00117 s (acoustic)", 36),
            (Lines{"2 430 particles, coarsened 2x", "7 steps, dt 0.00117 s (acoustic)"}));
}

TEST_F(TextLayout, ACommaNearTheBeginningOfALineDoesNotEndIt) {
  EXPECT_EQ(wrapped("yes, a sentence of some words that goes on", 24),
            (Lines{"yes, a sentence of some", "words that goes on"}));
  EXPECT_EQ(wrapped("no-space-at-all", 8), (Lines{"no-space", "-at-all"}));
}

}  // namespace
}  // namespace neve::render::overlay
