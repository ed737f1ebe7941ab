/// Rounds of nine tiles: what clicks say, and which tiles follow.

#include "app/pick/search/rounds.h"

#include <gtest/gtest.h>

#include "tests/support/robot.h"

namespace neve::test {
namespace {

using namespace app::pick::search;

/// Rounds with the tile nearest to a place clicked each time.
std::vector<Round> played(const Point& wanted, int count, std::uint64_t seed) {
  std::vector<Round> rounds;
  for (int k = 0; k < count; ++k) {
    Round round{next_tiles(rounds, int(wanted.size()), seed), {0}};
    for (int t = 1; t < tiles_in_round; ++t)
      if ((round.tiles[t] - wanted).norm() < (round.tiles[round.chosen[0]] - wanted).norm())
        round.chosen[0] = t;
    rounds.push_back(round);
  }
  return rounds;
}

double nearest_after(int count) {
  Point wanted(3);
  wanted << 0.2, 0.8, 0.55;
  const std::vector<Round> rounds = played(wanted, count, 1);
  return (rounds.back().tiles[rounds.back().chosen[0]] - wanted).norm();
}

TEST(Rounds, ClicksLeadToTheWantedPlace) {
  EXPECT_GT(nearest_after(1), 0.15) << "the first round should not be lucky";
  // Nine random places a round would come within 0.13 in eight rounds.
  EXPECT_LT(nearest_after(8), 0.08);
}

TEST(Rounds, RoundsReplayToTheBit) {
  const Point wanted = random_place(4, 5, 1);
  const std::vector<Round> a = played(wanted, 4, 9), b = played(wanted, 4, 9);
  const std::vector<Round> other = played(wanted, 1, 10);
  for (std::size_t k = 0; k < a.size(); ++k)
    for (int t = 0; t < tiles_in_round; ++t)
      EXPECT_TRUE((a[k].tiles[t].array() == b[k].tiles[t].array()).all());
  EXPECT_FALSE(a[0].tiles[0] == other[0].tiles[0]) << "another seed shows other tiles";
}

TEST(Rounds, TilesAreDistinctAndInsideTheCube) {
  for (const Round& round : played(Point::Zero(2), 6, 2))
    for (int t = 0; t < tiles_in_round; ++t) {
      EXPECT_TRUE((round.tiles[t].array() >= 0).all() && (round.tiles[t].array() <= 1).all());
      for (int u = 0; u < t; ++u) EXPECT_FALSE(round.tiles[t] == round.tiles[u]);
    }
}

TEST(Rounds, TwoBeatTheSevenOthers) {
  const Round round{next_tiles({}, 2, 1), {2, 5}};
  const Evidence evidence = evidence_of({round});
  ASSERT_EQ(evidence.choices.size(), 2u);
  for (const Choice& choice : evidence.choices) EXPECT_EQ(choice.among.size(), 8u);
  EXPECT_EQ(evidence.choices[0].best, 2);
  EXPECT_EQ(evidence.choices[1].best, 5);
}

TEST(Rounds, NoneSaysThatTheEarlierOneIsBetter) {
  Round first{next_tiles({}, 2, 1), {}};
  EXPECT_TRUE(evidence_of({first}).choices.empty());
  const std::vector<Point> second = next_tiles({first}, 2, 1);
  for (const Point& x : second)
    for (const Point& y : first.tiles) EXPECT_FALSE(x == y) << "nine others are shown";
  first.chosen = {4};
  const Evidence evidence = evidence_of({first, {second, {}}});
  ASSERT_EQ(evidence.choices.size(), 2u);
  EXPECT_EQ(evidence.choices[1].best, 4);
  EXPECT_EQ(evidence.choices[1].among.size(), 10u);
}

TEST(Rounds, TheFavouriteIsShownAgainAndTheLastClickIsTheResult) {
  const std::vector<Round> rounds = played(random_place(3, 5, 2), 3, 4);
  const Preference taste = learn(rounds, 3);
  EXPECT_TRUE(next_tiles(rounds, 3, 4).front() == favourite(rounds, taste));
  EXPECT_TRUE(result_of(rounds, taste) == rounds.back().tiles[rounds.back().chosen[0]]);
}

}  // namespace
}  // namespace neve::test
