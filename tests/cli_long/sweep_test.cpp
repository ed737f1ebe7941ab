/// A large sweep in which much goes wrong, and one whose driver is killed again and again.

#include <signal.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>
#include <set>
#include <thread>

#include "tests/cli/run_neve.h"
#include "tests/support/cinema.h"
#include "tests/support/needs.h"
#include "tests/support/python.h"
#include "tests/support/saboteur.h"

namespace neve::test {
namespace {

app::Json status_of(const TemporaryFolder& folder, const std::string& sweep, int run) {
  char name[16];
  std::snprintf(name, sizeof name, "%04d", run);
  return app::parse_json(
      std::string_view(read_text(folder / ("out/" + sweep + "/runs/" + name + "/status.json"))));
}

/// 64 runs: 50 are well, 8 diverge, 2 want too much memory, 2 are made to crash and 2 to hang.
std::string troubled_sweep() {
  std::string text =
      "[sweep]\nscene = \"scene.toml\"\nmethod = \"list\"\nframes = \"0-2\"\n"
      "[limits]\ntimeout = \"60s\"\nmemory = \"600MB\"\n[sheet]\ntile = [160, 90]\n";
  for (int k = 0; k < 64; ++k) {
    text += "[[run]]\nseed = " + std::to_string(k) + "\n";
    if (k >= 50 && k < 58)
      text +=
          "\"solver.time_step\" = \"fixed\"\n\"solver.dt\" = 2e-3\n"
          "\"material.snow.youngs_modulus\" = 5e7\n\"material.snow.model\" = \"corotated\"\n"
          "\"body.ball.velocity\" = [0, -8, 0]\n";
    if (k >= 58 && k < 60) text += "\"solver.cell_size\" = 0.002\n";
    // Long enough to be interrupted.
    if (k >= 60) text += "\"solver.max_dt\" = 1e-6\n";
  }
  return text;
}

TEST_F(Cli, ASweepOf64RunsEndsWithFiftyGoodAndFourteenMarkedTiles) {
  folder.write("troubled.toml", troubled_sweep());
  app::output::ProcessResult result;
  {
    const Saboteur saboteur(
        folder / "out/troubled.cdb/runs",
        {{"0060", SIGSEGV}, {"0061", SIGABRT}, {"0062", SIGSTOP}, {"0063", SIGSTOP}});
    result = neve({"sweep", "troubled.toml", "--jobs", "4"});
  }
  EXPECT_EQ(result.exit_code, 7) << result.errors;
  std::map<std::string, int> states;
  for (int k = 0; k < 64; ++k) ++states[status_of(folder, "troubled.cdb", k)["state"]];
  EXPECT_EQ(states["ok"], 50);
  EXPECT_EQ(states["diverged"], 8);
  EXPECT_EQ(states["out_of_memory"], 2);
  EXPECT_EQ(states["crashed"], 2);
  EXPECT_EQ(states["timeout"], 2);
  EXPECT_EQ(
      cinema_problem(read_text(folder / "out/troubled.cdb/data.csv"), folder / "out/troubled.cdb"),
      "");
  EXPECT_TRUE(exists("out/troubled.cdb/sheet.png"));
  EXPECT_TRUE(contains(read_text(folder / "out/troubled.cdb/report.html"), "50 ok, 14 failed"));
}

TEST_F(Cli, ADriverKilledTwentyTimesRunsNothingTwice) {
  folder.write("killed.toml",
               "[sweep]\nscene = \"scene.toml\"\n[axis]\nseed = { range = [1, 24] }\n"
               "[sheet]\ntile = [160, 90]\n");
  std::mt19937 random(7);
  std::map<int, std::filesystem::file_time_type> finished;
  const auto look = [&] {
    for (int k = 0; k < 24; ++k) {
      char name[16];
      std::snprintf(name, sizeof name, "%04d", k);
      const std::filesystem::path run = folder / ("out/killed.cdb/runs/" + std::string(name));
      if (!std::filesystem::exists(run / "status.json")) continue;
      if (status_of(folder, "killed.cdb", k)["state"] != "ok") continue;
      const auto time = std::filesystem::last_write_time(run / "run.json");
      const auto [known, is_new] = finished.emplace(k, time);
      EXPECT_EQ(known->second, time) << "run " << k << " was made again";
    }
  };
  for (int kill = 0; kill < 20; ++kill) {
    const double seconds = std::uniform_real_distribution<>(0.2, 2.0)(random);
    // SIGKILL: the driver has no chance to say good-bye to its children.
    const std::string script = "\"$0\" sweep killed.toml --quiet & pid=$!; sleep " +
                               std::to_string(seconds) + "; kill -KILL $pid; wait $pid; true";
    ASSERT_EQ(
        app::output::run_process("/bin/bash", {"-c", script, NEVE_BINARY}, folder.path()).exit_code,
        0);
    look();
  }
  const auto last = neve({"sweep", "killed.toml", "--json"});
  ASSERT_EQ(last.exit_code, 0) << last.errors;
  look();
  EXPECT_EQ(finished.size(), 24u);
  // An uninterrupted sweep has the same states.
  ASSERT_EQ(neve({"sweep", "killed.toml", "--out", "whole"}).exit_code, 0);
  for (int k = 0; k < 24; ++k) {
    char name[16];
    std::snprintf(name, sizeof name, "%04d", k);
    const app::Json a = json_of("out/killed.cdb/runs/" + std::string(name) + "/run.json"),
                    b = json_of("whole/runs/" + std::string(name) + "/run.json");
    EXPECT_EQ(a["frames"].back()["state_hash"], b["frames"].back()["state_hash"]) << k;
  }
}

/// ./neve test --all installs it and says where.
TEST_F(Cli, OpenTimelineIOReadsTheTimelineOfASweep) {
  const auto python = python_with("json");
  const char* const otio = std::getenv("NEVE_OPENTIMELINEIO");
  if (!python || !otio || !std::filesystem::exists(std::filesystem::path(otio) / "opentimelineio"))
    SKIP_OR_FAIL(
        "no OpenTimelineIO: pip install --target DIR opentimelineio, and NEVE_OPENTIMELINEIO=DIR");
  const auto made = neve({"sweep", "scene.toml", "-p", "material.snow.hardening=5,10", "--set",
                          "first_frame=1000", "--frames", "1002", "--movie", "none", "--review",
                          "--out", "s.cdb"});
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  const auto same = run_script_with(*python, {std::string("PYTHONPATH=") + otio}, "check_otio.py",
                                    {"s.cdb"}, folder.path());
  EXPECT_EQ(same.output, "same\n") << same.errors;
}

}  // namespace
}  // namespace neve::test
