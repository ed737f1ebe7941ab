/// The ends between which a search looks, as they are written.

#include <gtest/gtest.h>

#include "app/pick/axes.h"
#include "app/pick/round_runs.h"

namespace neve::app::pick {
namespace {

TEST(PickAxes, ARangeIsItsTwoEnds) {
  for (const char* written : {"a.b=5..20", "a.b=5:20", "a.b=5-20", "a.b=5,20"})
    EXPECT_EQ(with_two_ends(written), "a.b=5,20") << written;
  EXPECT_EQ(with_two_ends("a.b=1e-3-2e-2"), "a.b=1e-3,2e-2");
  EXPECT_EQ(with_two_ends("a.b=-5--2"), "a.b=-5,-2");
  for (const char* other :
       {"a.b=1e-3", "a.b=-5", "a.b=5:10:3", "a.b={ uniform = [2, 40] }", "a.b", "a-b=2,3"})
    EXPECT_EQ(with_two_ends(other), other);
}

TEST(RoundRuns, HaveEndedWhenNoneIsLeft) {
  RoundRuns runs;
  EXPECT_FALSE(have_all_ended(runs));
  runs.tiles.resize(2);
  runs.tiles[0].state = TileRun::State::done;
  runs.tiles[1].state = TileRun::State::running;
  EXPECT_FALSE(have_all_ended(runs));
  runs.tiles[1].state = TileRun::State::failed;
  EXPECT_TRUE(have_all_ended(runs));
}

}  // namespace
}  // namespace neve::app::pick
