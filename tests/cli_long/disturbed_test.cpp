/// Every command with every allocation and every file operation that fails.

#include <iostream>

#include "tests/support/disturbed_cli.h"
#include "tests/support/whole_counts.h"

namespace neve::test {
namespace {

class EveryAllocation : public DisturbedCli {};
class EveryOperation : public DisturbedCli {};

TEST_P(EveryAllocation, FailsOnceAndTheSameCommandGoesOn) {
  const int places = disturb(failing_allocation(), count_or_whole(25, 1'000'000));
  std::cout << GetParam().name << ": " << places << " places\n";
  EXPECT_GT(places, 0);
}

TEST_P(EveryOperation, FailsOnceAndForEverAndTheSameCommandGoesOn) {
  for (const char* operation :
       {"open", "write", "short", "fsync", "rename", "mkdir", "close", "flock"}) {
    const int places = disturb(failing_operation(operation), count_or_whole(6, 1'000'000));
    std::cout << GetParam().name << ", " << operation << ": " << places << " places\n";
  }
}

// Memory of the viewer's panels is ImGui's.
INSTANTIATE_TEST_SUITE_P(Commands, EveryAllocation,
                         testing::ValuesIn(disturbed_commands({"view", "emit"})), name_of);
// The others write nothing.
INSTANTIATE_TEST_SUITE_P(Commands, EveryOperation,
                         testing::ValuesIn(disturbed_commands({"verify", "check"})), name_of);

}  // namespace
}  // namespace neve::test
