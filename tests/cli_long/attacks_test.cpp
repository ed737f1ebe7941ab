/// Inputs that nobody means, made from the table of kinds in docs/reports/strangers.md:
/// tests/attacks.

#include <iostream>

#include "tests/cli/run_neve.h"
#include "tests/support/needs.h"
#include "tests/support/python.h"

namespace neve::test {
namespace {

class Attacks : public Cli, public testing::WithParamInterface<const char*> {};

/// Attacks end within 30 s of processors (cards 120 s) and 500 MB each, and not with exit code 1 or
/// a signal.
TEST_P(Attacks, EndWithinTheirLimits) {
  const auto python = python_with("json");
  if (!python) SKIP_OR_FAIL("no python3; install python3");
  const auto result = app::output::run_process(
      *python, {"-B", NEVE_SOURCE_DIR "/tests/attacks/run", NEVE_BINARY, GetParam()},
      folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  std::cout << result.output;
}

INSTANTIATE_TEST_SUITE_P(Kinds, Attacks, testing::Values("meshes", "points", "scenes", "commands"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace neve::test
