/// Random valid scenes, rendered in several ways: nothing found by chance.

#include <iostream>

#include "tests/cli/run_neve.h"
#include "tests/support/needs.h"
#include "tests/support/whole_counts.h"

namespace neve::test {
namespace {

class Soak : public Cli {};

/// The generator knows the parameters from `neve params --json`; see tests/soak/soak.
TEST_F(Soak, RandomScenesEndWellWithTheSameBitsAndWithoutGaps) {
  if (!app::output::find_program("python3")) SKIP_OR_FAIL("no python3 in PATH; install python3");
  const int scenes = count_or_whole(200, 5000);
  const auto result = app::output::run_process(
      "/usr/bin/env",
      {"python3", std::string(NEVE_SOURCE_DIR) + "/tests/soak/soak", NEVE_BINARY, "soak", "--jobs",
       "2", "--seeds", "0-" + std::to_string(scenes - 1)},
      folder.path());
  std::cout << result.output;
  EXPECT_EQ(result.exit_code, 0) << result.errors;
}

}  // namespace
}  // namespace neve::test
