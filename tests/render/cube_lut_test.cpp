#include "render/image/cube_lut.h"

#include <gtest/gtest.h>

namespace neve::render {
namespace {

Image pixel(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  return {1, 1, 3, {r, g, b}};
}

std::vector<std::uint8_t> through(const std::string& text, Image image) {
  apply(parse_cube(text, "look.cube"), image);
  return image.pixels;
}

/// Red and blue change places; red changes fastest in the file.
const std::string swapped =
    "\xEF\xBB\xBF# made by a grading program\r\nTITLE \"swap\"\r\nLUT_3D_SIZE 2\r\n"
    "DOMAIN_MIN 0 0 0\nDOMAIN_MAX 1.0 1.0 1.0\n\n"
    "0 0 0\n0 0 1\n0 1 0\n0 1 1\n1 0 0\n1 0 1\n1 1 0\n1 1 1\n";

TEST(CubeLut, ATableOfColoursIsInterpolated) {
  EXPECT_EQ(through(swapped, pixel(10, 100, 250)), (std::vector<std::uint8_t>{250, 100, 10}));
  EXPECT_EQ(through(swapped, pixel(255, 0, 0)), (std::vector<std::uint8_t>{0, 0, 255}));
}

TEST(CubeLut, CurvesActOnEachChannelAndAlphaStays) {
  Image image{1, 1, 4, {0, 51, 255, 77}};
  EXPECT_EQ(through("LUT_1D_SIZE 3\n0 0 0\n0.25 0.5 0.75\n1 1 1\n", image),
            (std::vector<std::uint8_t>{0, 51, 255, 77}));
  EXPECT_EQ(through("LUT_1D_SIZE 2\n1 1 1\n0 0 0\n", image),
            (std::vector<std::uint8_t>{255, 204, 0, 77}));
  // A value outside the domain is as its end.
  EXPECT_EQ(through("LUT_1D_SIZE 2\nDOMAIN_MAX 0.5 0.5 0.5\n0 0 0\n1 1 1\n", image),
            (std::vector<std::uint8_t>{0, 102, 255, 77}));
}

TEST(CubeLut, MistakesAreNamedWithTheirLine) {
  const auto said = [](const std::string& text) -> std::string {
    try {
      parse_cube(text, "l");
    } catch (const ImageError& error) {
      return error.what();
    }
    return "no error";
  };
  const auto expect = [&](const std::string& text, const std::string& part) {
    EXPECT_NE(said(text).find(part), std::string::npos) << said(text);
  };
  expect("", "expected a .cube file");
  expect("LUT_3D_SIZE 2\n0 0 0\n", "l:2: it has 1 entries; expected 8");
  expect("LUT_1D_SIZE 2\n0 0 0\n1 1 1\n1 1 1\n", "l:4: more entries than the 2");
  expect("LUT_3D_SIZE 1000\n", "l:1: LUT_3D_SIZE 1000; expected 2 to 256");
  expect("LUT_1D_SIZE 2\n0 0 red\n", "l:2: \"red\" is not a number");
  expect("LUT_1D_SIZE 2\n0 0 nan\n", "l:2: \"nan\" is not a number");
  expect("LUT_1D_SIZE 2\n0 0\n", "l:2: \"\" is not a number");
  expect("0 0 0\n", "l:1: an entry before");
}

}  // namespace
}  // namespace neve::render
