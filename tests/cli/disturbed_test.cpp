/// A sample of what tests/cli_long/disturbed_test.cpp tries at every place.

#include "tests/support/disturbed_cli.h"

namespace neve::test {
namespace {

class DisturbedSample : public DisturbedMemoryCli {};

TEST_P(DisturbedSample, AnAllocationThatFailsIsSaidAndTheSameCommandContinues) {
  EXPECT_GT(disturb(failing_allocation(), 3), 0);
}

INSTANTIATE_TEST_SUITE_P(Commands, DisturbedSample,
                         testing::ValuesIn(disturbed_commands(
                             {"view", "emit", "check", "scene_exports", "strip", "compare", "fork",
                              "pick", "manual", "card", "replace", "dust", "dust_export", "promote",
                              "refine", "pick_refine"})),
                         name_of);

}  // namespace
}  // namespace neve::test
