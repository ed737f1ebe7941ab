/// The warning about runs that become slow.

#include "app/run/step_warnings.h"

#include <gtest/gtest.h>

namespace {

using namespace neve;
using namespace neve::app;

record::FrameRecord frame(int number, double seconds, std::size_t steps, std::size_t particles,
                          std::size_t grid_blocks = 100) {
  record::FrameRecord record;
  record.frame = number;
  record.seconds_sim = seconds;
  record.advance.steps = steps;
  if (steps > 0) record.advance.ruled[static_cast<std::size_t>(sim::DtLimit::acoustic)] = steps;
  record.summary.particles = particles;
  record.summary.grid_blocks = grid_blocks;
  record.summary.min_J_P = 0.55;
  return record;
}

TEST(Slowdown, SaysHowMuchAndWhy) {
  const auto text = run::slowdown_warning(
      {frame(0, 0, 0, 1000), frame(1, 0.5, 100, 1000), frame(2, 20, 800, 1000)});
  ASSERT_TRUE(text);
  EXPECT_NE(text->find("frame 2 took 20 s, 40 times as long as frame 1"), std::string::npos)
      << *text;
  EXPECT_NE(text->find("8 times as many steps (acoustic"), std::string::npos) << *text;
  EXPECT_NE(text->find("J_P = 0.55"), std::string::npos) << *text;
  EXPECT_NE(text->find("costs 5 times as much"), std::string::npos) << *text;
  EXPECT_EQ(text->find("as many particles"), std::string::npos) << *text;
}

TEST(Slowdown, SnowThatIsNotSpreadIsNotBlamed) {
  const auto spread =
      run::slowdown_warning({frame(1, 0.5, 100, 1000), frame(2, 20, 100, 1000, 900)});
  ASSERT_TRUE(spread);
  EXPECT_NE(spread->find("spread over more of the grid"), std::string::npos) << *spread;
  const auto starved = run::slowdown_warning({frame(1, 0.5, 100, 1000), frame(2, 20, 100, 1000)});
  ASSERT_TRUE(starved);
  EXPECT_EQ(starved->find("spread over more"), std::string::npos) << *starved;
  EXPECT_NE(starved->find("other programs"), std::string::npos) << *starved;
}

TEST(Slowdown, MoreSnowIsACauseOfItsOwn) {
  const auto text = run::slowdown_warning({frame(1, 0.5, 100, 1000), frame(9, 10, 100, 20000)});
  ASSERT_TRUE(text);
  EXPECT_NE(text->find("20 times as many particles"), std::string::npos) << *text;
  EXPECT_EQ(text->find("steps"), std::string::npos) << *text;
  EXPECT_EQ(text->find("costs"), std::string::npos) << *text;
}

TEST(Slowdown, SaysNothingOfRunsThatAreShortOrEven) {
  EXPECT_FALSE(run::slowdown_warning({}));
  EXPECT_FALSE(run::slowdown_warning({frame(0, 0, 0, 10)}));
  EXPECT_FALSE(run::slowdown_warning({frame(1, 0.01, 10, 10), frame(2, 1.9, 100, 10)}));
  EXPECT_FALSE(run::slowdown_warning({frame(1, 1, 10, 10), frame(2, 9, 100, 10)}));
}

}  // namespace
