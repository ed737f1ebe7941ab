/// Readers of height fields: ESRI ASCII grids and PNG pictures of 16 bits.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "sim/files/height_reader.h"
#include "sim/types/errors.h"
#include "tests/support/height_files.h"

namespace neve::test {
namespace {

using sim::files::HeightGrid;
using sim::files::parse_ascii_grid;
using sim::files::parse_heights;

const std::string grid_header = "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 10\n";

std::string refusal_of_heights(const std::string& bytes,
                               const sim::files::HeightScale& scale = {}) {
  try {
    parse_heights(bytes, "grid.asc", scale);
  } catch (const sim::ShapeError& error) {
    return error.what();
  }
  return "read";
}

double height_of(const HeightGrid& grid, std::size_t column, std::size_t row) {
  return grid.datum + static_cast<double>(grid.at(column, row));
}

TEST(HeightReader, RowsRunFromNorthToSouthAndPostsLieInTheMiddleOfCells) {
  const HeightGrid grid = parse_ascii_grid(grid_header + "1 2 3\n4 5 6.5\n", "grid.asc");
  EXPECT_EQ(grid.columns, 3u);
  EXPECT_EQ(grid.rows, 2u);
  EXPECT_DOUBLE_EQ(grid.west, 105);
  EXPECT_DOUBLE_EQ(grid.north, 215);
  EXPECT_DOUBLE_EQ(height_of(grid, 0, 0), 1);
  EXPECT_DOUBLE_EQ(height_of(grid, 2, 1), 6.5);
}

TEST(HeightReader, ACenterIsThePlaceOfAPost) {
  const HeightGrid grid = parse_ascii_grid(
      "NCOLS 3\r\nNROWS 2\r\nXLLCENTER 100\r\nYLLCENTER 200\r\nCELLSIZE 10\r\n1 2 3 4 5 6", "g");
  EXPECT_DOUBLE_EQ(grid.west, 100);
  EXPECT_DOUBLE_EQ(grid.north, 210);
}

TEST(HeightReader, LinesAndOrderOfTheHeaderDoNotMatter) {
  const HeightGrid grid = parse_ascii_grid(
      "\xEF\xBB\xBF"
      "cellsize 10\nNODATA_value -1\n nrows 2\nxllcorner 100\nyllcorner 200\nncols 3\n1\n2 3 4\n5 "
      "-1\n\n",
      "g");
  EXPECT_DOUBLE_EQ(height_of(grid, 1, 0), 2);
  EXPECT_DOUBLE_EQ(height_of(grid, 1, 1), 5);
  EXPECT_TRUE(std::isnan(grid.at(2, 1)));
}

TEST(HeightReader, PostsWithoutDataAreThoseThatTheHeaderNames) {
  EXPECT_TRUE(std::isnan(parse_ascii_grid(grid_header + "1 2 3 4 5 -9999", "g").at(2, 1)));
  const HeightGrid grid =
      parse_ascii_grid(grid_header + "nodata_value nan\n1 2 3 4 -9999 NaN", "g");
  EXPECT_TRUE(std::isnan(grid.at(2, 1)));
  EXPECT_DOUBLE_EQ(height_of(grid, 1, 1), -9999);
}

/// On high mountains, single precision of a height above the sea would be 0.2 mm apart.
TEST(HeightReader, HeightsKeepTenthsOfAMillimetreOnHighMountains) {
  const HeightGrid grid =
      parse_ascii_grid(grid_header + "4810.0001 4810 4809 4808 4807 4806.9999", "g");
  EXPECT_NEAR(height_of(grid, 0, 0), 4810.0001, 1e-6);
}

struct HostileGrid {
  std::string text, says;
};

TEST(HeightReader, HostileGridsEndAtTheirLine) {
  const auto with = [](const std::string& key, const std::string& value) {
    std::string text;
    for (const auto& [name, usual] :
         std::vector<std::pair<std::string, std::string>>{{"ncols", "3"},
                                                          {"nrows", "2"},
                                                          {"xllcorner", "0"},
                                                          {"yllcorner", "0"},
                                                          {"cellsize", "10"}})
      text += name + " " + (name == key ? value : usual) + "\n";
    return text + "1 2 3 4 5 6\n";
  };
  const std::vector<HostileGrid> cases{
      {"", "grid.asc:1: the header has no ncols"},
      {"hello\n", "grid.asc:1: \"hello\": not a height field"},
      {with("ncols", "99999"), "grid.asc:1: the header names 99999 x 2 posts"},
      {with("ncols", "1e300"), "grid.asc:1: ncols = 1e+300; expected a whole number from 2 to"},
      {with("ncols", "99999999999999999999"), "grid.asc:1: ncols = 1e+20"},
      {with("ncols", "2.5"), "grid.asc:1: ncols = 2.5; expected a whole number"},
      {with("ncols", "1"), "expected a whole number from 2"},
      {with("nrows", "-2"), "grid.asc:2: nrows = -2"},
      {with("nrows", "nan"), "grid.asc:2: nrows = \"nan\"; expected a finite number"},
      {with("xllcorner", "inf"), "grid.asc:3: xllcorner = \"inf\""},
      {with("xllcorner", "1e9"), "grid.asc:3: xllcorner = 1e+09; expected at most 1e8 m"},
      {with("cellsize", "-10"), "grid.asc:5: cellsize = -10; expected metres, above 0"},
      {with("cellsize", "0"), "grid.asc:5: cellsize = 0"},
      {with("cellsize", "nan"), "grid.asc:5: cellsize = \"nan\""},
      {with("cellsize", ""), "grid.asc:5: cellsize = \"\"; expected a finite number"},
      {"ncols 3\nncols 3\n", "grid.asc:2: ncols is given twice"},
      {grid_header + "depth 3\n",
       "grid.asc:6: \"depth\" is neither a key of the header nor a number"},
      {"ncols 3\nnrows 2\nyllcorner 0\ncellsize 1\n1", "the header has no xllcorner"},
      {grid_header + "xllcenter 3\n1", "grid.asc:6: xllcorner and xllcenter are both given"},
      {grid_header + "1 2 3\n4 5      \n \n",
       "grid.asc:9: the file ends after 5 heights; expected 6"},
      {grid_header + "1 2 3\n4 5 6\n7\n", "grid.asc:8: \"7\" comes after all 6 heights"},
      {grid_header + "1 2 3\n4 5 6 # end\n", "grid.asc:7: \"#\" comes after all 6 heights"},
      {grid_header + "1 2 3\n4 inf 6\n", "grid.asc:7: \"inf\"; expected a height"},
      {grid_header + "1 2 3\n4 nan 6\n", "grid.asc:7: \"nan\"; expected a height"},
      {grid_header + "1 2 3\n4 1e7 6\n", "grid.asc:7: \"1e7\"; expected a height"},
      {grid_header + "1 2 3\n4 5,5 6\n", "grid.asc:7: \"5,5\"; expected a height"},
      {grid_header + "-9999 -9999 -9999 -9999 -9999 -9999", "no post of the height field has data"},
      {std::string("\xFF\xFEn\0c\0", 6), "UTF-16"}};
  for (const HostileGrid& c : cases)
    EXPECT_NE(refusal_of_heights(c.text).find(c.says), std::string::npos)
        << c.says << "\n"
        << refusal_of_heights(c.text);
}

TEST(HeightReader, ATiffIsRefusedWithTheCommandThatConverts) {
  for (const std::string& start : {std::string("II*\0\x08", 5), std::string("MM\0*\0", 5)})
    EXPECT_NE(refusal_of_heights(start).find("gdal_translate -of AAIGrid"), std::string::npos);
}

TEST(HeightReader, APngHasTheHeightsOfItsSceneWithEveryFilter) {
  // 5 rows, each with another filter.
  const auto value = [](int column, int row) { return (9000 * column + 4100 * row * row) % 65536; };
  const HeightGrid grid = parse_heights(height_png(4, 5, value), "g.png", {2.5, 100, 300});
  EXPECT_DOUBLE_EQ(grid.spacing, 2.5);
  EXPECT_DOUBLE_EQ(grid.west, -3.75);
  EXPECT_DOUBLE_EQ(grid.north, 5);
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 4; ++column)
      // Heights are kept in single precision, within 100 m of the middle.
      EXPECT_NEAR(height_of(grid, static_cast<std::size_t>(column), static_cast<std::size_t>(row)),
                  100 + 200.0 * value(column, row) / 65535, 1e-5);
}

TEST(HeightReader, PngsThatAreNoHeightsAreRefused) {
  const std::string png = height_png(4, 4, [](int, int) { return 7; });
  const sim::files::HeightScale scale{1, 0, 10};
  EXPECT_EQ(refusal_of_heights(png, scale), "read");
  EXPECT_NE(refusal_of_heights(png, {0, 0, 10}).find("give spacing"), std::string::npos);
  EXPECT_NE(refusal_of_heights(png, {1, 5, 5}).find("give low and high"), std::string::npos);
  const auto changed = [&](std::size_t at, char byte) {
    std::string other = png;
    other[at] = byte;
    return refusal_of_heights(other, scale);
  };
  EXPECT_NE(changed(24, 8).find("a PNG of 8 bits"), std::string::npos);
  EXPECT_NE(changed(25, 2).find("not grey"), std::string::npos);
  EXPECT_NE(changed(28, 1).find("interlaced"), std::string::npos);
  EXPECT_NE(changed(16, 0x7f).find("pixels; expected"), std::string::npos);
  EXPECT_NE(changed(18, 0x7f).find("end before the last pixel"), std::string::npos);
  EXPECT_NE(refusal_of_heights(png.substr(0, 20), scale).find("damaged"), std::string::npos);
  EXPECT_NE(refusal_of_heights(png.substr(0, png.size() - 20), scale).find("damaged"),
            std::string::npos);
}

}  // namespace
}  // namespace neve::test
