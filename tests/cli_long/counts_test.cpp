/// What goes wrong by chance, often. NEVE_WHOLE=1 repeats it as often as docs/developers.md says.

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <set>
#include <thread>

#include "tests/support/costly_cli.h"
#include "tests/support/faulty_cli.h"
#include "tests/support/folder_contents.h"
#include "tests/support/whole_counts.h"

namespace neve::test {
namespace {

class Counts : public FaultyCli {
 protected:
  /// Nothing of a killed run is left: no process, no file that it had not finished.
  void expect_nothing_left(const std::filesystem::path& out) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(out))
      EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
  }

  /// Processes other than this one whose folder is `path` or below it.
  static std::set<std::string> processes_in(const std::filesystem::path& path) {
    std::set<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      std::error_code error;
      const auto where = std::filesystem::read_symlink(entry.path() / "cwd", error);
      if (!error && where.string().starts_with(path.string()))
        found.insert(entry.path().filename().string() + " " + read_text(entry.path() / "comm"));
    }
    return found;
  }
};

/// Of a run with pictures and a movie, at any instant; then that of a sweep with runs side by side.
TEST_F(Counts, KilledAtAnyInstantItEndsWithTheSameBits) {
  // Frames enough that the kills do not run out of them.
  std::string text(tiny_scene);
  text.replace(text.find("frames = 4"), 10, "frames = 60\nfps = 96");
  folder.write("scene.toml", text);
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "whole"}).exit_code, 0);
  const RunFiles whole = files_of(folder / "whole");
  const int kills = count_or_whole(100, 500),
            met = kill_and_resume(folder / "scene.toml", folder / "parts", kills, 0.4, 2);
  EXPECT_EQ(met, kills);
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "parts", "--resume"}).exit_code, 0);
  const RunFiles found = files_of(folder / "parts");
  EXPECT_EQ(found.hashes, whole.hashes);
  EXPECT_EQ(found.pictures, whole.pictures);
  expect_nothing_left(folder / "parts");
  EXPECT_EQ(neve({"verify", "parts"}).exit_code, 0);
}

TEST_F(Counts, ADriverThatIsKilledLeavesNoProcess) {
  std::mt19937 random(5);
  const std::string sweep = "sweep scene.toml -p seed=1,2,3,4 --out s --jobs 2 --quiet";
  ASSERT_EQ(failing("", "sweep scene.toml -p seed=1,2,3,4 --out whole --jobs 2").exit_code, 0);
  for (int k = 0; k < count_or_whole(10, 100); ++k) {
    const double seconds = std::uniform_real_distribution<>(0.05, 2.0)(random);
    app::output::run_process("/bin/bash",
                             {"-c",
                              "\"$0\" " + sweep + " & pid=$!; sleep " + std::to_string(seconds) +
                                  "; kill -KILL $pid; wait $pid; true",
                              NEVE_BINARY},
                             folder.path());
    std::this_thread::sleep_for(std::chrono::seconds(1));
    EXPECT_EQ(processes_in(folder.path()), std::set<std::string>{}) << k;
  }
  ASSERT_EQ(failing("", sweep).exit_code, 0);
  expect_nothing_left(folder / "s");
  EXPECT_EQ(neve({"verify", "s"}).exit_code, 0);
  for (const char* run : {"0000", "0001", "0002", "0003"}) {
    const std::string place = std::string("/runs/") + run;
    EXPECT_EQ(files_of(folder / ("s" + place)).hashes, files_of(folder / ("whole" + place)).hashes);
  }
}

TEST_F(Counts, AfterPowerCutsItEndsWithTheSameBits) {
  EXPECT_EQ(cut_power(200, 2), 200);
}

/// Each at once with another that wants other results there: one wins, the other touches nothing.
TEST_F(Counts, OfTwoOfAnythingInAFolderOneWins) {
  const std::string set = " --set material.snow.hardening=5";
  const std::string render = "render scene.toml --out out --frames 0-40 --no-movie --quiet",
                    exports = "export scene.toml --out out --format csv --frames 0-40 --quiet",
                    sweep = "sweep scene.toml --out out --frames 0-20 --quiet -p seed=";
  const std::pair<std::string, std::string> pairs[] = {{render, render + set},
                                                       {render, render + " --resume" + set},
                                                       {exports, exports + set},
                                                       {sweep + "1,2", sweep + "3,4"}};
  int won = 0;
  const int count = count_or_whole(20, 100);
  for (int k = 0; k < count; ++k) {
    const auto& [first, second] = pairs[k % std::size(pairs)];
    std::filesystem::remove_all(folder / "out");
    const auto both =
        app::output::run_process("/bin/bash",
                                 {"-c",
                                  "\"$0\" " + first + " 2>first & one=$!; \"$0\" " + second +
                                      " 2>second & two=$!; wait $one; a=$?; wait $two; echo $a $?",
                                  NEVE_BINARY},
                                 folder.path());
    const bool is_first = both.output == "0 6\n";
    EXPECT_TRUE(is_first || both.output == "6 0\n") << first << ": " << both.output;
    const std::string loser = read_text(folder / (is_first ? "second" : "first"));
    EXPECT_TRUE(contains(loser, "is in use by neve ")) << loser;
    // What is there is what the winner alone makes.
    std::filesystem::rename(folder / "out", folder / "found");
    EXPECT_EQ(failing("", is_first ? first : second).exit_code, 0);
    const bool is_same = folder_contents(folder / "found") == folder_contents(folder / "out");
    EXPECT_TRUE(is_same) << first;
    won += is_same;
    std::filesystem::remove_all(folder / "found");
  }
  EXPECT_EQ(won, count);
}

/// The same command, again and again while there is no room and once more when there is.
TEST_F(Counts, ASweepOf64EndsWellAfterAFullDisk) {
  std::string values = "1";
  for (int k = 2; k <= 64; ++k) values += "," + std::to_string(k);
  const std::string sweep = "sweep scene.toml --frames 0-1 --out s --quiet -p seed=" + values,
                    fault = "write:" + std::to_string(ENOSPC) + ":/s/",
                    variables = "NEVE_FAULT_WHILE=$PWD/full";
  std::thread disk([&] {
    wait_for_file(folder / "s/runs/0005/run.json");
    folder.write("full", "");
    std::this_thread::sleep_for(std::chrono::seconds(10));
    std::filesystem::remove(folder / "full");
  });
  const auto stopped = failing(fault, sweep, variables);
  EXPECT_EQ(stopped.exit_code, 6) << stopped.errors;
  EXPECT_TRUE(contains(stopped.errors, "No space left on device")) << stopped.errors;
  int tries = 0;
  while (exists("full")) {
    const int code = failing(fault, sweep, variables).exit_code;
    EXPECT_TRUE(code == 6 || !exists("full")) << code;
    ++tries;
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
  disk.join();
  EXPECT_GT(tries, 0);
  const auto last = failing("", sweep);
  EXPECT_EQ(last.exit_code, 0) << last.errors;
  int good = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "s/runs"))
    good +=
        app::parse_json(std::string_view(read_text(entry.path() / "status.json")))["state"] == "ok";
  EXPECT_EQ(good, 64);
  EXPECT_EQ(neve({"verify", "s"}).exit_code, 0);
}

/// Of many views, of large pictures and of much snow. The program itself takes what it takes for
/// the least of scenes.
TEST_F(CostlyCli, EstimatesAreTheMemoryThatIsTaken) {
  const auto estimate_of = [&](const std::string& arguments) {
    cost_of("render " + arguments + " --dry-run --json");
    return json_of("told")["memory_bytes"].get<double>();
  };
  const auto peak_of = [&](const std::string& arguments) {
    const Cost cost = cost_of("render " + arguments + " --out out --no-movie --frames 0-2");
    EXPECT_EQ(cost.exit_code, 0) << read_text(folder / "said");
    return cost.memory;
  };
  const double program = peak_of("scene.toml") - estimate_of("scene.toml");
  folder.write("views.toml", with_views(100, "[1280, 720]"));
  for (const char* arguments :
       {"views.toml", "scene.toml --set output.size='[4000, 4000]'",
        "scene.toml --set output.size='[3000, 3000]' --quality final --set limits.pixels=1e9",
        "scene.toml --set solver.cell_size=0.006"}) {
    const double ratio = (estimate_of(arguments) + program) / peak_of(arguments);
    EXPECT_LT(ratio, 1.5) << arguments;
    EXPECT_GT(ratio, 1 / 1.5) << arguments;
  }
}

}  // namespace
}  // namespace neve::test
