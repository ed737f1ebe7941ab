/// Sentences on what a search has learned.

#include "app/pick/learned.h"

#include <gtest/gtest.h>

namespace neve::test {
namespace {

using namespace app::pick;

const std::vector<PickAxis> two_axes = {{"material.snow.hardening", "hardening", "", 2, 20, false},
                                        {"solver.flip_ratio", "flip_ratio", "", 0, 1, false}};

/// The tile furthest along the first axis is chosen in every round.
std::vector<search::Round> rounds_of_more_hardening() {
  std::vector<search::Round> rounds;
  for (int k = 0; k < 6; ++k) {
    search::Round round{search::next_tiles(rounds, 2, 3), {0}};
    for (int t = 1; t < search::tiles_in_round; ++t)
      if (round.tiles[t][0] > round.tiles[round.chosen[0]][0]) round.chosen[0] = t;
    rounds.push_back(round);
  }
  return rounds;
}

TEST(Learned, TheAxisThatWasChosenByTellsMost) {
  const auto rounds = rounds_of_more_hardening();
  const search::Preference taste = search::learn(rounds, 2);
  const search::Point best = search::favourite(rounds, taste);
  const std::vector<AxisTaste> tastes = axis_tastes(two_axes, taste, best);
  ASSERT_EQ(tastes.size(), 2u);
  EXPECT_EQ(tastes[0].axis, 0u);
  // No factor between the effects: whoever always chooses by the smallest difference gives the
  // search reasons to see a taste in the other axis too, since tiles crowd around the favourite.
  EXPECT_GT(tastes[0].effect, 3);
  EXPECT_GT(tastes[0].low, 0.2) << "little hardening was never chosen";
  const std::vector<std::string> lines = taste_lines(two_axes, tastes, best);
  EXPECT_TRUE(lines[0].starts_with("hardening: ")) << lines[0];
  EXPECT_NE(lines[0].find("liked between"), std::string::npos) << lines[0];
}

TEST(Learned, APickAtTheEndOfItsRangeSaysSo) {
  const auto rounds = rounds_of_more_hardening();
  const search::Preference taste = search::learn(rounds, 2);
  search::Point place = search::favourite(rounds, taste);
  const std::vector<AxisTaste> tastes = axis_tastes(two_axes, taste, place);
  const auto line_at = [&](double u) {
    place[0] = u;
    return taste_lines(two_axes, tastes, place)[0];
  };
  EXPECT_NE(line_at(0.99).find("at the upper end of its range"), std::string::npos) << line_at(1);
  EXPECT_NE(line_at(0.01).find("at the lower end of its range"), std::string::npos) << line_at(0);
  EXPECT_EQ(line_at(0.5).find("end of its range"), std::string::npos) << line_at(0.5);
}

TEST(Learned, TheMapHasEveryTileAndTheFavourite) {
  const auto rounds = rounds_of_more_hardening();
  const search::Preference taste = search::learn(rounds, 2);
  const search::Point best = search::favourite(rounds, taste);
  const std::string svg =
      map_svg(taste_map(two_axes, taste, rounds, axis_tastes(two_axes, taste, best), best));
  std::size_t circles = 0;
  for (std::size_t at = 0; (at = svg.find("<circle", at)) != std::string::npos; ++at) ++circles;
  EXPECT_EQ(circles, rounds.size() * search::tiles_in_round + 1);
  EXPECT_NE(svg.find(">hardening<"), std::string::npos);
}

TEST(Learned, ValuesOfAnAxisReachItsEnds) {
  const PickAxis stiffness{"a", "a", "Pa", 2e4, 2e6, true};
  EXPECT_EQ(stiffness.text(0), "20000");
  EXPECT_EQ(stiffness.text(0.5), "200000");
  EXPECT_EQ(stiffness.text(1), "2000000");
}

}  // namespace
}  // namespace neve::test
