/// python/neve.py: a program of its own that drives the real one.

#include "tests/support/python.h"
#include "tests/cli/run_neve.h"
#include "tests/support/needs.h"

namespace neve::test {
namespace {

class Python : public Cli {};

TEST_F(Python, ModuleReadsRunsStatesSweepsAndErrors) {
  const auto python = python_with("numpy");
  if (!python) SKIP_OR_FAIL("no Python with numpy; install python3-numpy");
  const auto result = run_script_with(*python, {"NEVE=" NEVE_BINARY}, "check_module.py",
                                      {NEVE_SOURCE_DIR "/python"}, folder.path());
  EXPECT_EQ(result.output, "same\n") << result.errors;
}

}  // namespace
}  // namespace neve::test
