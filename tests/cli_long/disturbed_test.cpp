/// Every command with every allocation and every file operation that fails, and killed.

#include <iostream>

#include "tests/support/disturbed_cli.h"
#include "tests/support/whole_counts.h"

namespace neve::test {
namespace {

class EveryAllocation : public DisturbedMemoryCli {};
class EveryOperation : public DisturbedCli {};
class EveryCommand : public DisturbedCli {};

TEST_P(EveryAllocation, FailsOnceAndTheSameCommandContinues) {
  const int places = disturb(failing_allocation(), count_or_whole(25, 1'000'000));
  std::cout << GetParam().name << ": " << places << " places\n";
  EXPECT_GT(places, 0);
}

TEST_P(EveryOperation, FailsOnceAndForEverAndTheSameCommandContinues) {
  int all = 0;
  for (const char* operation : {"open", "write", "short", "truncate", "fsync", "rename", "remove",
                                "mkdir", "close", "flock", "look", "read"}) {
    const int tries = disturb(failing_operation(operation), count_or_whole(4, 1'000'000));
    std::cout << GetParam().name << ", " << operation << ": " << tries << " tries" << std::endl;
    all += tries;
  }
  std::cout << GetParam().name << ": " << all << " tries\n";
  EXPECT_GT(all, 0);
}

TEST_P(EveryCommand, RemovesWhatKilledOnesLeft) {
  expect_to_tidy();
}

/// No process exists after a second, and the same command ends as if nothing had been.
TEST_P(EveryCommand, KilledAtAnyMomentContinues) {
  kill_at_any_moment(count_or_whole(3, 25));
}

/// A command that is interrupted once ends within a second, and the same command continues.
TEST_P(EveryCommand, InterruptedAtAnyMomentContinues) {
  interrupt_at_any_moment(count_or_whole(3, 25));
}

class CardFaults : public FaultyCli {};

/// A card takes seconds: its few files fail at a place each.
TEST_F(CardFaults, ACardThatCannotBeWrittenIsSaidAndMadeByTheSameCommand) {
  const std::string card = "card scene.toml --out card/c.png";
  for (const char* place : {"write:28:card/:0", "rename:5:card/:1", "open:28:card/:0"}) {
    const auto failed = failing(place, card);
    EXPECT_EQ(failed.exit_code, 6) << place << failed.errors;
    expect_nothing_unfinished(folder.path(), place);
  }
  EXPECT_EQ(failing("", card).exit_code, 0);
  EXPECT_TRUE(exists("card/c.png") && exists("card/c.json"));
}

// Memory of the viewer's panels is ImGui's; manual and promote allocate little; of cards see above.
INSTANTIATE_TEST_SUITE_P(
    Commands, EveryAllocation,
    testing::ValuesIn(disturbed_commands({"view", "emit", "manual", "promote", "card"})), name_of);
// The others write nothing.
INSTANTIATE_TEST_SUITE_P(Commands, EveryOperation,
                         testing::ValuesIn(disturbed_commands({"verify", "check", "card"})),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Commands, EveryCommand,
                         testing::ValuesIn(disturbed_commands({"verify", "check"})), name_of);

}  // namespace
}  // namespace neve::test
