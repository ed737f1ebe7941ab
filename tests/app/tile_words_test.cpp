/// Words on the tiles of a contact sheet.

#include <gtest/gtest.h>

#include "app/sweep/sheet/sheet_layout.h"
#include "app/sweep/sheet/tile_words.h"

namespace neve::app::sweep::sheet {
namespace {

using Words = std::vector<std::string>;

/// A sweep of three parameters.
store::Manifest sweep_of(const std::vector<std::vector<const char*>>& values) {
  store::Manifest m;
  m.tile_label = "differences";
  m.parameters = {{"m.hardening", "hardening", "", "number"},
                  {"m.E", "E", "Pa", "number"},
                  {"c.friction", "friction", "", "number"}};
  for (const auto& own : values) {
    Run& run = m.runs.emplace_back();
    run.index = static_cast<int>(m.runs.size()) - 1;
    for (std::size_t k = 0; k < own.size(); ++k)
      run.settings.push_back({m.parameters[k].address, own[k]});
  }
  return m;
}

store::Manifest screening() {
  store::Manifest m = sweep_of({{"5", "140000.123", "0.3"},
                                {"8.33333333", "140000.123", "0.3"},
                                {"8.33333333", "68560.2", "0.3"},
                                {"8.33333333", "68560.2", "0.5"},
                                {"5", "68560.2", "0.5"}});
  const std::vector<std::vector<int>> levels{{0, 3, 1}, {2, 3, 1}, {2, 1, 1}, {2, 1, 3}, {0, 1, 3}};
  for (std::size_t k = 0; k < levels.size(); ++k) m.runs[k].coordinates = levels[k];
  for (const Parameter& p : m.parameters) m.screened.push_back({p.name, {}, {p.address}});
  return m;
}

TEST(TileWords, OfAScreeningNameTheParameterThatChanged) {
  const store::Manifest m = screening();
  const auto words = [&](std::size_t run) { return tile_words(m, m.runs[run], false, {40, 6}); };
  EXPECT_EQ(words(0), (Words{"hardening = 5, E = 1.4e5 Pa", "friction = 0.3"}));
  EXPECT_EQ(words(1), Words{"hardening = 8.333, was 5"});
  EXPECT_EQ(words(2), Words{"E = 68560 Pa, was 1.4e5"});
  EXPECT_EQ(words(3), Words{"friction = 0.5, was 0.3"});
  // The next trajectory starts one step from the end of this one, by chance.
  EXPECT_EQ(words(4).size(), 2u);
}

TEST(TileWords, TakeAsManyLinesAsThereAreAndSayWhatIsLeftOut) {
  const store::Manifest m = sweep_of({{"5", "48000", "0.3"}});
  const auto words = [&](const WordRoom& room) { return tile_words(m, m.runs[0], false, room); };
  EXPECT_EQ(words({80, 1}), Words{"hardening = 5, E = 48000 Pa, friction = 0.3"});
  EXPECT_EQ(words({20, 3}), (Words{"hardening = 5", "E = 48000 Pa", "friction = 0.3"}));
  EXPECT_EQ(words({20, 2}), (Words{"hardening = 5", "and 2 more"}));
  EXPECT_EQ(words({28, 1}), Words{"hardening = 5, and 2 more"});
}

TEST(TileWords, AreTheNameOrNothingWhereThatIsAskedFor) {
  store::Manifest m = sweep_of({{"5", "48000", "0.3"}});
  m.tile_label = "none";
  EXPECT_TRUE(tile_words(m, m.runs[0], false, {}).empty());
  m.tile_label = "name";
  m.runs[0].folder = "0000";
  EXPECT_EQ(tile_words(m, m.runs[0], false, {}), Words{"run 0"});
}

TEST(SheetLayout, TheRowsOfAScreeningAreWholeTrajectories) {
  store::Manifest m = screening();
  m.runs.resize(4);
  for (int k = 4; k < 40; ++k) {
    m.runs.push_back(m.runs[static_cast<std::size_t>(k % 4)]);
    m.runs.back().index = k;
  }
  const SheetLayout layout = layout_sheet(m, false, 8192);
  for (std::size_t k = 0; k < 40; k += 4) {
    EXPECT_EQ(layout.tiles[k].y, layout.tiles[k + 3].y) << k;
    EXPECT_EQ(layout.tiles[k].x, layout.tiles[k % 8].x) << k;
  }
}

/// Several lines would hide the snow: they are above the picture, one is on it.
TEST(TileWords, OfSeveralLinesAreAboveThePicture) {
  store::Manifest m = sweep_of({{"5", "48000", "0.3"}, {"7", "48000", "0.4"}});
  m.tile_width = 240;
  m.tile_height = 135;
  const SheetLayout many = layout_sheet(m, false, 8192);
  for (auto& run : m.runs) run.settings.resize(1);
  const SheetLayout one = layout_sheet(m, false, 8192);
  EXPECT_EQ(one.label_height, 0);
  EXPECT_GE(many.label_height, 2 * many.font_size);
  EXPECT_EQ(many.tiles[0].y, one.tiles[0].y + many.label_height);
  EXPECT_EQ(many.tile_height, one.tile_height);
  EXPECT_GE(many.height, one.height + many.label_height);
  m.tile_label = "none";
  EXPECT_EQ(layout_sheet(m, false, 8192).label_height, 0);
}

}  // namespace
}  // namespace neve::app::sweep::sheet
