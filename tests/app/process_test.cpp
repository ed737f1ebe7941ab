/// Other programs: their streams, limits and signals, and their end with that of their parent.

#include "app/output/process.h"

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <system_error>

#include "tests/support/child.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

using output::run_process;

TEST(Process, PrintsIntoTwoTextsAndTellsItsExitCode) {
  const test::TemporaryFolder folder;
  const auto result =
      run_process("/bin/bash", {"-c", "pwd; echo bad >&2; cat; exit 5"}, folder.path());
  EXPECT_TRUE(result.has_started);
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_EQ(result.output, std::filesystem::canonical(folder.path()).string() + "\n");
  EXPECT_EQ(result.errors, "bad\n");
  EXPECT_EQ(run_process("/bin/bash", {"-c", "kill -SEGV $$"}, "/").exit_code, 128 + SIGSEGV);
}

TEST(Process, ItsGroupIsStoppedWhenItTakesTooLong) {
  const test::TemporaryFolder folder;
  const auto start = std::chrono::steady_clock::now();
  const auto result = run_process(
      "/bin/bash", {"-c", "sleep 60 & echo $! > child; echo said; wait"}, folder.path(), 0.5);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  EXPECT_TRUE(result.is_too_slow);
  EXPECT_EQ(result.exit_code, 128 + SIGKILL);
  EXPECT_EQ(result.output, "said\n");
  EXPECT_TRUE(test::is_gone_soon(std::stoi(test::read_text(folder / "child"))));
  EXPECT_FALSE(run_process("/bin/true", {}, "/", 60).is_too_slow);
}

TEST(Process, SaysWhyItCannotStart) {
  const auto result = run_process("/no/such/program", {}, "/");
  EXPECT_FALSE(result.has_started);
  EXPECT_EQ(result.errors, "No such file or directory");
  EXPECT_EQ(run_process("/", {}, "/").errors, "Permission denied");
  EXPECT_FALSE(run_process("/bin/true", {}, "/no/such/folder").has_started);
  try {
    output::start_process({"/no/such/program", {}, "/"}, {});
    FAIL() << "a program that does not exist was started";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code().value(), ENOENT);
  }
}

TEST(Process, KeepsItsLimitsAndLeadsItsProcessGroup) {
  const test::TemporaryFolder folder;
  // ulimit counts KiB, and the fifth field of stat is the process group.
  const std::string script =
      "exec > out; ulimit -d; ulimit -c; cut -d' ' -f5 /proc/$$/stat; echo $$";
  const pid_t child = output::start_process(
      {"/bin/bash", {"-c", script}, folder.path()},
      {-1, -1, -1, {{RLIMIT_DATA, std::uint64_t{1} << 30}, {RLIMIT_CORE, 0}}});
  EXPECT_EQ(test::wait_for(child), 0);
  const std::string id = std::to_string(child) + "\n";
  EXPECT_EQ(test::read_text(folder / "out"), "1048576\n0\n" + id + id);
}

TEST(Process, HasTheDefaultActionsOfSignals) {
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  const auto result = run_process("/bin/bash", {"-c", "kill -PIPE $$; exit 3"}, "/");
  std::signal(SIGPIPE, before);
  EXPECT_EQ(result.exit_code, 128 + SIGPIPE);
}

TEST(Process, DiesWhenItsParentIsKilled) {
  const test::TemporaryFolder folder;
  const pid_t parent = ::fork();
  if (parent == 0) {
    run_process("/bin/bash", {"-c", "echo $$ > pid; exec sleep 600"}, folder.path());
    ::_exit(0);
  }
  ASSERT_TRUE(test::wait_for_text(folder / "pid"));
  ::kill(parent, SIGKILL);
  EXPECT_EQ(test::wait_for(parent), 128 + SIGKILL);
  EXPECT_TRUE(test::is_gone_soon(std::stoi(test::read_text(folder / "pid"))));
}

}  // namespace
}  // namespace neve::app
