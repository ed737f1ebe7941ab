/// Children that are watched, what is remembered of them, and which of them start first.

#include <gtest/gtest.h>

#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <sstream>
#include <string>
#include <thread>

#include "app/support/errors.h"
#include "app/support/progress.h"
#include "app/sweep/jobs/child.h"
#include "app/sweep/jobs/local.h"
#include "app/sweep/jobs/outcome.h"
#include "app/sweep/plan/order.h"
#include "app/sweep/store/store.h"
#include "tests/support/child.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

class ChildTest : public testing::Test {
 protected:
  app::sweep::jobs::ChildResult run(const std::string& script,
                                    const app::sweep::jobs::ChildLimits& limits) {
    app::sweep::jobs::Child child({"/bin/bash", {"-c", script}, folder_.path()}, folder_ / "log",
                                  limits);
    while (true) {
      if (const auto result = child.poll()) return *result;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  test::TemporaryFolder folder_;
};

TEST_F(ChildTest, ChildTellsHowItEnded) {
  const app::sweep::jobs::ChildResult good = run("echo hello; echo bad >&2; exit 5", {});
  EXPECT_EQ(good.ending, app::sweep::jobs::Ending::exited);
  EXPECT_EQ(good.code, 5);
  EXPECT_EQ(test::read_text(folder_ / "log"), "hello\nbad\n");
  const app::sweep::jobs::ChildResult crashed = run("kill -SEGV $$", {});
  EXPECT_EQ(crashed.ending, app::sweep::jobs::Ending::signaled);
  EXPECT_EQ(crashed.signal, SIGSEGV);
}

TEST_F(ChildTest, ChildIsAskedToEndAfterItsTimeAndThenEnded) {
  EXPECT_EQ(run("sleep 60", {.timeout = 0.1}).ending, app::sweep::jobs::Ending::timeout);
  // One that does not listen.
  const app::sweep::jobs::ChildResult deaf = run("trap '' TERM; while true; do sleep 0.1; done",
                                                 {.timeout = 0.1, .memory = 0, .grace = 0.2});
  EXPECT_EQ(deaf.ending, app::sweep::jobs::Ending::timeout);
  EXPECT_EQ(deaf.signal, SIGKILL);
  EXPECT_LT(deaf.seconds, 20);
}

TEST_F(ChildTest, ChildIsEndedWhenItTakesTooMuchMemory) {
  // Keeps the last 400 MB of an endless stream.
  const app::sweep::jobs::ChildResult result =
      run("exec tail -c 400000000 < <(cat /dev/zero)", {.timeout = 60, .memory = 100'000'000});
  EXPECT_EQ(result.ending, app::sweep::jobs::Ending::out_of_memory);
  EXPECT_GE(result.peak_memory, 100'000'000u);
}

TEST_F(ChildTest, ChildDiesWithItsParent) {
  const pid_t parent = ::fork();
  if (parent == 0) {
    app::sweep::jobs::Child child(
        {"/bin/bash", {"-c", "echo $$ > pid; exec sleep 600"}, folder_.path()}, folder_ / "log",
        {});
    test::wait_for_text(folder_ / "pid");
    ::raise(SIGKILL);
  }
  EXPECT_EQ(test::wait_for(parent), 128 + SIGKILL);
  EXPECT_TRUE(test::is_gone_soon(std::stoi(test::read_text(folder_ / "pid"))));
}

TEST(SweepStore, TheStoreRemembersReportsAndSurvivesBrokenOnes) {
  test::TemporaryFolder folder;
  app::sweep::store::RunStatus status;
  status.state = app::sweep::store::RunState::out_of_memory;
  status.key = "0123";
  status.reason = "too \"much\"";
  status.attempts = 2;
  status.seconds = 1.5;
  app::sweep::store::write_status(folder.path(), status);
  const app::sweep::store::RunStatus same = app::sweep::store::read_status(folder.path());
  EXPECT_EQ(same.state, status.state);
  EXPECT_EQ(same.key, status.key);
  EXPECT_EQ(same.reason, status.reason);
  EXPECT_EQ(same.attempts, 2);
  for (const char* broken : {"", "{", "[]", "{\"state\": 3}", "{\"state\": \"ok\"}"}) {
    folder.write("status.json", broken);
    EXPECT_EQ(app::sweep::store::read_status(folder.path()).state,
              app::sweep::store::RunState::pending)
        << broken;
  }
}

TEST(SweepStore, FailedRunsAreRepeatedByTheirState) {
  using app::sweep::store::parse_retry;
  using app::sweep::store::RunState;
  EXPECT_EQ(parse_retry("timeout,crashed"),
            (app::sweep::store::Retry{RunState::timeout, RunState::crashed}));
  EXPECT_EQ(parse_retry("all").size(), 6u);
  EXPECT_FALSE(parse_retry("all").contains(RunState::ok));
  for (const char* wrong : {"", "ok", ",crashed", "timeout;crashed", "pending"})
    EXPECT_THROW(parse_retry(wrong), app::UsageError) << wrong;
}

/// Two runs, whose "program" is a script.
class ScriptedRuns : public testing::Test {
 protected:
  ScriptedRuns() {
    for (int k = 0; k < 2; ++k) {
      app::sweep::Run& run = manifest_.runs.emplace_back();
      run.index = k;
      run.key = std::to_string(k);
      run.folder = app::sweep::store::run_folder_name(k);
      std::filesystem::create_directories(folder_of(k));
    }
    options_.jobs = 1;
    options_.program = folder_ / "program";
  }
  std::filesystem::path folder_of(int k) const {
    return folder_.path() / "runs" / manifest_.runs[static_cast<std::size_t>(k)].folder;
  }
  app::sweep::jobs::JobsResult run(const std::string& script, const std::vector<int>& indices) {
    folder_.write("program", "#!/bin/bash\n" + script);
    std::filesystem::permissions(folder_ / "program", std::filesystem::perms::owner_all);
    Progress progress(log_, Verbosity::quiet, false);
    return app::sweep::jobs::run_local(folder_.path(), manifest_, indices, options_, progress);
  }

  test::TemporaryFolder folder_;
  app::sweep::store::Manifest manifest_;
  app::sweep::jobs::LocalOptions options_;
  std::ostringstream log_;
};

TEST_F(ScriptedRuns, ARunThatAnotherProcessHasMadeMeanwhileIsNotMadeAgain) {
  app::sweep::store::RunStatus status;
  status.state = app::sweep::store::RunState::failed;
  app::sweep::store::write_status(folder_.path(), status);
  const auto result = run("cp ../../status.json ../0001\necho x >> ../../made\nexit 3\n", {0, 1});
  EXPECT_EQ(result.started, 1);
  EXPECT_EQ(result.failed, 2) << log_.str();
  EXPECT_EQ(test::read_text(folder_ / "made"), "x\n");
}

TEST_F(ScriptedRuns, ARunCostsWhatItsResultHasTaken) {
  app::sweep::store::RunStatus status;
  status.state = app::sweep::store::RunState::failed;
  status.seconds = 1000;
  status.peak_memory = std::uint64_t{1} << 50;
  status.attempts = 1;
  app::sweep::store::write_status(folder_of(0), status);
  options_.retry_failed = {app::sweep::store::RunState::failed};
  // A command that reads the status while the run is made finds no result.
  run("grep -q '\"running\"' status.json || sleep 0.2\ncp status.json seen\nexit 3\n", {0});
  status = app::sweep::store::read_status(folder_of(0));
  EXPECT_EQ(status.attempts, 2);
  EXPECT_LT(status.seconds, 100);
  EXPECT_LT(status.peak_memory, std::uint64_t{1} << 50);
  EXPECT_EQ(app::parse_json(std::string_view(test::read_text(folder_of(0) / "seen")))["state"],
            "running");
}

TEST(SweepOrder, CornersRunFirstThenMiddles) {
  std::vector<std::vector<int>> grid;
  for (int a = 0; a < 5; ++a)
    for (int b = 0; b < 5; ++b) grid.push_back({a, b});
  const std::vector<std::size_t> order = app::sweep::plan::coarse_first(grid, {5, 5});
  EXPECT_EQ(std::vector(order.begin(), order.begin() + 4),
            (std::vector<std::size_t>{0, 4, 20, 24}));
  const std::vector<std::size_t> middles(order.begin() + 4, order.begin() + 9);
  EXPECT_EQ(middles, (std::vector<std::size_t>{2, 10, 12, 14, 22}));
  const std::vector<std::vector<int>> row(5);
  EXPECT_EQ(app::sweep::plan::coarse_first(row, {}), (std::vector<std::size_t>{0, 4, 2, 1, 3}));
}

TEST(SweepThreads, ThreadsFillTheCoresAndFitIntoMemory) {
  app::sweep::Run small, large;
  small.particles = 5000;
  small.memory = 5e7;
  large.particles = 1e6;
  large.memory = 4e9;
  EXPECT_EQ(app::sweep::jobs::threads_for(small, {64}, 8, 16e9),
            1);  // many small ones side by side
  EXPECT_EQ(app::sweep::jobs::threads_for(large, {64}, 8, 16e9), 2);  // four fit into memory
  EXPECT_EQ(app::sweep::jobs::threads_for(large, {64}, 8, 1e9), 8);   // none does: one at a time
  EXPECT_EQ(app::sweep::jobs::threads_for(large, {2}, 8, 64e9), 4);   // only two are left
  EXPECT_EQ(app::sweep::jobs::threads_for(small, {1}, 8, 64e9), 1);   // too small to share
}

TEST(SweepProgress, RemainingTimeIsEstimatedOverATrailingWindow) {
  using namespace std::chrono_literals;
  WorkClock clock;
  const WorkClock::Clock::time_point start{};
  EXPECT_LT(clock.seconds_for(1), 0);
  // Ten minutes at a hundredth of the speed are forgotten.
  for (int k = 0; k <= 600; k += 10) clock.note(0.01 * k, start + k * 1s);
  for (int k = 0; k <= 300; k += 10) clock.note(6 + k, start + (600 + k) * 1s);
  EXPECT_NEAR(clock.seconds_for(50), 50, 0.5);
  EXPECT_EQ(runs_text(RunCounts{12, 2, 2, 64, 200}),
            "12/64 runs  2 failed  2 running  3 min 20 s left");
}

}  // namespace
}  // namespace neve::app
