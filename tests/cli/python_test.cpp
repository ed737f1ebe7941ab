/// python/neve.py: a program of its own that drives the real one.

#include "tests/support/python.h"
#include "app/support/version.h"
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

TEST_F(Python, ControlCLeavesTheRunItsMovieAndACheckpoint) {
  const auto python = python_with("numpy");
  if (!python) SKIP_OR_FAIL("no Python with numpy; install python3-numpy");
  const auto result = run_script_with(*python, {"NEVE=" NEVE_BINARY}, "check_interrupt.py",
                                      {NEVE_SOURCE_DIR "/python"}, folder.path());
  EXPECT_EQ(result.output, "same\n") << result.errors;
}

TEST_F(Python, PackageIsAWheelThatFindsTheProgram) {
  const auto python = python_with("numpy, setuptools, wheel");
  if (!python) SKIP_OR_FAIL("no Python with setuptools; install python3-setuptools python3-wheel");
  const auto result = run_script_with(*python, {"NEVE=" NEVE_BINARY}, "check_wheel.py",
                                      {NEVE_SOURCE_DIR "/python", app::version}, folder.path());
  EXPECT_EQ(result.output, "same\n") << result.errors;
}

}  // namespace
}  // namespace neve::test
