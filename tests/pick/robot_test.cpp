/// A robot with hidden wishes, on an emulator of real runs: rounds until a clicked tile has every
/// metric within 5 % of those wanted, against random tiles and a grid. docs/pick.md has the table;
/// NEVE_ROBOT_TARGETS says how many.

#include "tests/support/robot.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <iostream>
#include <numeric>

#include "app/pick/search/rounds.h"

namespace neve::test {
namespace {

using namespace app::pick::search;

constexpr double near_enough = 0.05;
constexpr int max_rounds = 10;

/// The next nine tiles after some rounds.
using Shower = std::function<std::vector<Point>(const std::vector<Round>&)>;

/// Rounds until the robot is content; last + 1 if it never is.
int rounds_until_content(Robot robot, const Shower& show, int last) {
  std::vector<Round> rounds;
  for (int k = 1; k <= last; ++k) {
    Round round{show(rounds), {}};
    round.chosen = {robot.click(round.tiles)};
    if (robot.is_content(round.tiles[round.chosen[0]], near_enough)) return k;
    rounds.push_back(round);
  }
  return last + 1;
}

Shower random_tiles(int axes, std::uint64_t seed) {
  return [=](const std::vector<Round>& rounds) {
    std::vector<Point> tiles;
    for (std::uint64_t k = 0; k < tiles_in_round; ++k)
      tiles.push_back(random_place(axes, seed, rounds.size() * tiles_in_round + k));
    return tiles;
  };
}

/// Four values of each of four axes, in an order of their own for each seed.
Shower grid_tiles(int axes, std::uint64_t seed) {
  constexpr int values = 4;
  std::vector<int> order(std::size_t(std::pow(values, axes)));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return mix64(seed, std::uint64_t(a)) < mix64(seed, std::uint64_t(b));
  });
  return [=](const std::vector<Round>& rounds) {
    std::vector<Point> tiles;
    for (int k = 0; k < tiles_in_round; ++k) {
      int cell = order[(rounds.size() * tiles_in_round + std::size_t(k)) % order.size()];
      Point x(axes);
      for (int a = 0; a < axes; ++a, cell /= values) x[a] = (cell % values + 0.5) / values;
      tiles.push_back(x);
    }
    return tiles;
  };
}

struct Score {
  int content = 0;  ///< targets, within max_rounds
  int median = 0;   ///< rounds
};

Score score_of(std::vector<int> rounds) {
  std::sort(rounds.begin(), rounds.end());
  return {int(std::count_if(rounds.begin(), rounds.end(), [](int k) { return k <= max_rounds; })),
          rounds[rounds.size() / 2]};
}

class RobotPicks : public testing::Test {
 protected:
  RobotPicks() {
    if (const char* given = std::getenv("NEVE_ROBOT_TARGETS")) targets_ = std::atoi(given);
  }

  enum class Way { pick, random, grid };

  Score measure(Way way, double wrong_share) {
    std::vector<int> rounds;
    for (int k = 0; k < targets_; ++k) {
      const auto seed = std::uint64_t(k) + 1;
      const Robot robot(emulator_, random_place(table_.axes, 2013, seed), wrong_share, seed);
      const Shower pick = [&](const std::vector<Round>& earlier) {
        return next_tiles(earlier, table_.axes, seed);
      };
      const Shower show = way == Way::pick     ? pick
                          : way == Way::random ? random_tiles(table_.axes, seed)
                                               : grid_tiles(table_.axes, seed);
      rounds.push_back(rounds_until_content(robot, show, way == Way::pick ? max_rounds : 40));
    }
    const Score score = score_of(rounds);
    std::cout << (way == Way::pick     ? "pick"
                  : way == Way::random ? "random"
                                       : "grid")
              << ", " << wrong_share << " wrong: " << score.content << " of " << targets_
              << " targets in 10 rounds, median " << score.median << " rounds\n";
    return score;
  }

  int targets_ = 50;
  RunTable table_ = read_run_table(NEVE_SOURCE_DIR "/docs/pick/runs.csv");
  Emulator emulator_{table_};
};

TEST_F(RobotPicks, RobotsFindMostTargetsInTenRounds) {
  EXPECT_GE(measure(Way::pick, 0).content, 0.7 * targets_);
}

TEST_F(RobotPicks, RobotsThatMisclickFindTheMajority) {
  EXPECT_GE(measure(Way::pick, 0.2).content, 0.5 * targets_);
}

TEST_F(RobotPicks, RandomTilesAndGridsTakeTwiceAsLong) {
  const int pick = measure(Way::pick, 0).median;
  EXPECT_GE(measure(Way::random, 0).median, 2 * pick);
  EXPECT_GE(measure(Way::grid, 0).median, 2 * pick);
}

/// The emulator is no better than this: it is part of the measurement.
TEST_F(RobotPicks, TheEmulatorKnowsRunsThatItHasNotSeen) {
  EXPECT_GE(table_.places.size(), 250u);
  std::cout << "error of the emulator " << emulator_.error() << "\n";
  EXPECT_LT(emulator_.error(), 0.25);
}

}  // namespace
}  // namespace neve::test
