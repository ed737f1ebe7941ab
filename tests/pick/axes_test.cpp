/// The ends between which a search looks, as they are written.

#include <gtest/gtest.h>

#include "app/pick/axes.h"
#include "app/pick/game.h"
#include "app/pick/round_runs.h"
#include "app/support/errors.h"
#include "tests/support/temporary_folder.h"

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

/// The refusal names the flag and not a place in a file of the search, which nobody has written.
TEST(PickAxes, AParameterThatFollowsACurveIsRefusedByItsFlag) {
  test::TemporaryFolder folder;
  folder.write("scene.toml", R"(
[[body]]
shape = { sphere = { center = [0, 0.5, 0], radius = 0.15 } }
[[collider]]
name = "ground"
shape = { plane = {} }
[[curve]]
parameter = "collider.ground.friction"
keyframes = [{ time = 0, value = 0.1 }, { time = 0.1, value = 0.5 }]
)");
  PickOptions options;
  options.runs.file = (folder / "scene.toml").string();
  options.runs.axes = {"collider.ground.friction=0.1,0.5"};
  try {
    Game game(options);
    FAIL() << "not refused";
  } catch (const UsageError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("-p collider.ground.friction=0.1"))
        << error.what();
  }
}

TEST(RoundRuns, HaveEndedWhenNoneIsLeft) {
  using sweep::store::RunState;
  sweep::jobs::SweepProgress runs;
  EXPECT_FALSE(runs.have_all_ended());
  runs.runs.resize(2);
  runs.runs[0].state = RunState::ok;
  runs.runs[1].state = RunState::running;
  EXPECT_FALSE(runs.have_all_ended());
  runs.runs[1].state = RunState::timeout;
  EXPECT_TRUE(runs.have_all_ended());
}

}  // namespace
}  // namespace neve::app::pick
