/// Progress lines, and the small texts around them.

#include "app/advice/suggest.h"
#include "app/support/progress.h"

#include <gtest/gtest.h>

#include <chrono>
#include <sstream>
#include <string>
#include <thread>

#include "app/options/languages.h"
#include "app/scene/burn_in.h"
#include "app/support/errors.h"
#include "app/support/round_number.h"
#include "app/support/text.h"

namespace neve::app {
namespace {

TEST(Progress, LineSaysFrameTimeStepsAndWhatIsLeft) {
  EXPECT_EQ(progress_text({12, 48, 0.5, 320, 0.42}),
            "frame 12/48  t = 0.500 s  320 steps  0.42 s/frame  15 s left");
  EXPECT_EQ(progress_text({0, 48, 0, 7, -1}), "frame 0/48  t = 0.000 s  7 steps");
}

TEST(Progress, LineTellsTheTimesOfShortFramesApart) {
  EXPECT_EQ(progress_text({1, 48, 1 / 24000.0, 7, -1}), "frame 1/48  t = 0.00004 s  7 steps");
  EXPECT_EQ(progress_text({2, 48, 2 / 24000.0, 9, -1}), "frame 2/48  t = 0.00008 s  9 steps");
}

TEST(Progress, DurationsUseTwoUnits) {
  EXPECT_EQ(duration_text(7.6), "8 s");
  EXPECT_EQ(duration_text(200), "3 min 20 s");
  EXPECT_EQ(duration_text(7500), "2 h 05 min");
}

TEST(Progress, ProgressRewritesItsLineOnlyOnATerminal) {
  for (const bool updates : {true, false}) {
    std::ostringstream out;
    {
      Progress progress(out, Verbosity::normal, updates);
      progress.start(4, 0);
      progress.frame(1, 0.1);
      progress.note("hello");
    }
    EXPECT_EQ(out.str().find('\r') != std::string::npos, updates);
    EXPECT_NE(out.str().find("hello\n"), std::string::npos);
  }
}

/// It took the time of frame 0, which has no steps, for that of all others: "0 s left" for minutes.
TEST(Progress, ALongFrameTellsItsTimeAndNoRestBeforeOneIsKnown) {
  EXPECT_EQ(progress_text({0, 1, 41.25, 63706, -1}), "frame 0/1  t = 41.250 s  63706 steps");
  std::ostringstream out;
  Progress progress(out, Verbosity::normal, true);
  progress.start(2, 0);
  progress.frame(0, 0);
  progress.step(0.125);
  std::this_thread::sleep_for(std::chrono::milliseconds(250));
  out.str("");
  progress.step(0.25);
  EXPECT_NE(out.str().find("frame 0/2  t = 0.250 s  2 steps"), std::string::npos) << out.str();
  EXPECT_EQ(out.str().find("left"), std::string::npos) << out.str();
  progress.frame(1, 10);
  EXPECT_NE(out.str().find("left"), std::string::npos) << out.str();
}

TEST(Progress, QuietRunsPrintOnlyWarnings) {
  std::ostringstream out;
  Progress progress(out, Verbosity::quiet, true);
  progress.start(4, 0);
  progress.frame(1, 0.1);
  progress.note("note");
  progress.detail("detail");
  EXPECT_EQ(out.str(), "");
  progress.warning("careful");
  EXPECT_EQ(out.str(), "neve: warning: careful\n");
}

TEST(RoundNumber, RoundNumbersHaveFewDigits) {
  EXPECT_EQ(round_up(4.4), 5);
  EXPECT_EQ(round_up(3), 3);
  EXPECT_EQ(round_up(8.1), 10);
  EXPECT_EQ(round_up(0), 0);
  EXPECT_EQ(round_down(0.13), 0.1);
  EXPECT_EQ(round_down(199), 100);
  EXPECT_EQ(round_to(1.23456, 1, 3), 1.23);
  EXPECT_EQ(round_to(12345, 12345, 2), 12000);
}

TEST(FrameArguments, FrameArgumentsAreRangesOrALastFrame) {
  EXPECT_EQ(app::options::frames().read("--frames", "3-7").first, 3);
  EXPECT_EQ(app::options::frames().read("--frames", "3-7").last, 7);
  EXPECT_EQ(app::options::frames().read("--frames", "48").first,
            app::setup::FrameRange::from_start);
  EXPECT_EQ(app::options::frames().read("--frames", "48").last, 48);
  for (const char* wrong : {"", "-", "5-", "-5-", "7-3", "a", "1-b", "1 - 2", "99999999999"})
    EXPECT_THROW(app::options::frames().read("--frames", wrong), app::UsageError) << wrong;
}

TEST(SizeArguments, SizeArgumentsAreTwoSides) {
  EXPECT_EQ(app::options::size().read("--size", "1280x720").width, 1280);
  EXPECT_EQ(app::options::size().read("--size", "1280x720").height, 720);
  for (const char* wrong : {"", "x", "1280", "1280x", "0x720", "-5x9", "1280X720", "99999999x9"})
    EXPECT_THROW(app::options::size().read("--size", wrong), app::UsageError) << wrong;
}

TEST(Caption, CaptionNamesOverridesOfTheSnowShortly) {
  const std::vector<std::string> lines = app::scene::override_lines(
      {"material.snow.hardening=5", "body.a.velocity=[0,1,0]", "body.b.velocity=[0,2,0]",
       "camera.fov=20", "material.snow.hardening=6", "view.particles.layers=[\"particles\"]"});
  const std::vector<std::string> expected{"hardening = 6", "a velocity = [0,1,0]",
                                          "b velocity = [0,2,0]"};
  EXPECT_EQ(lines, expected);
}

TEST(Caption, CaptionNamesWhatHoldsAtTheEnd) {
  const auto lines = [](const std::vector<std::string>& overrides) {
    return joined(app::scene::override_lines(overrides), "; ");
  };
  EXPECT_EQ(lines({"solver.cfl=0.1", "solver={cell_size=0.05}"}), "solver = {cell_size=0.05}");
  EXPECT_EQ(lines({"solver={cell_size=0.05}", "solver.cfl=0.1"}),
            "solver = {cell_size=0.05}; cfl = 0.1");
  EXPECT_EQ(lines({"body.ball.velocity=[0,-1,0]", "body.a.velocity=[0,2,0]",
                   "body.ball={shape={sphere={}}}"}),
            "a velocity = [0,2,0]; set body.ball");
  EXPECT_EQ(lines({"collider.floor.friction=0.9", "collider.floor=none"}),
            "removed collider.floor");
  EXPECT_EQ(lines({"material.snow.hardening=5", "material.snow.preset=wet"}), "preset = wet");
}

TEST(NearestName, NearestNameIsFoundForTypingErrorsOnly) {
  EXPECT_EQ(advice::nearest_name("rendr", {"render", "doctor"}), "render");
  EXPECT_EQ(advice::nearest_name("banana", {"render", "doctor"}), "");
  EXPECT_EQ(advice::nearest_name("hardneing", {"hardness", "hardening", "density"}), "hardening");
  EXPECT_EQ(advice::nearest_name("ab", {"b", "ba", "abcd"}), "b");
  EXPECT_EQ(advice::nearest_name("velocty", {"velocity_of_all", "velocity"}), "velocity");
  EXPECT_EQ(advice::nearest_name("", {"a", "ab"}), "") << "nothing typed resembles nothing";
  EXPECT_EQ(advice::nearest_name("Z", {"y", "z"}), "z");
  EXPECT_EQ(advice::nearest_name("VELOCITY", {"v", "velocity"}), "velocity");
}

}  // namespace
}  // namespace neve::app
