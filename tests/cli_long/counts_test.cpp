/// Tests of what goes wrong by chance. NEVE_WHOLE=1 repeats as often as docs/developers.md says.

#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <iostream>
#include <thread>

#include "tests/support/costly_cli.h"
#include "tests/support/faulty_cli.h"
#include "tests/support/folder_contents.h"
#include "tests/support/killed.h"
#include "tests/support/whole_counts.h"

namespace neve::test {
namespace {

class Counts : public FaultyCli {
 protected:
  /// Two commands at once, whose messages go to the files `first` and `second`. @return exit codes
  std::string at_once(const std::string& first, const std::string& second) {
    return app::output::run_process(
               "/bin/bash",
               {"-c",
                "\"$0\" " + first + " 2>first & one=$!; \"$0\" " + second +
                    " 2>second & two=$!; wait $one; a=$?; wait $two; echo $a $?",
                NEVE_BINARY},
               folder.path())
        .output;
  }

  /// True where the folder `out` has what a command makes of it alone.
  bool is_what_it_makes_alone(const std::string& command) {
    std::filesystem::remove_all(folder / "found");
    std::filesystem::rename(folder / "out", folder / "found");
    EXPECT_EQ(failing("", command).exit_code, 0) << command;
    const auto found = folder_contents(folder / "found"), alone = folder_contents(folder / "out");
    for (const auto& [name, bytes] : alone)
      EXPECT_TRUE(found.contains(name) && found.at(name) == bytes) << name << " of " << command;
    for (const auto& [name, bytes] : found)
      EXPECT_TRUE(alone.contains(name)) << name << " of " << command;
    return found == alone;
  }
};

/// A run with pictures and a movie is killed at any instant; then it is asked to end.
TEST_F(Counts, KilledAtAnyInstantItEndsWithTheSameBits) {
  // Frames enough that the kills do not run out of them.
  std::string text(tiny_scene);
  text.replace(text.find("frames = 4"), 10, "frames = 60\nfps = 96");
  folder.write("scene.toml", text);
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "whole"}).exit_code, 0);
  const RunFiles whole = files_of(folder / "whole");
  for (const auto& [signal, count] :
       {std::pair(SIGKILL, count_or_whole(50, 500)), std::pair(SIGTERM, count_or_whole(10, 100))}) {
    const std::string place = "signal " + std::to_string(signal);
    const auto look = [&] { expect_no_process(folder.path(), place); };
    EXPECT_EQ(
        kill_and_resume(folder / "scene.toml", folder / "parts", {count, 0.4, 2, signal, look}),
        count);
    ASSERT_EQ(neve({"render", "scene.toml", "--out", "parts", "--resume"}).exit_code, 0);
    const RunFiles found = files_of(folder / "parts");
    EXPECT_EQ(found.hashes, whole.hashes);
    EXPECT_EQ(found.pictures, whole.pictures);
    expect_nothing_unfinished(folder.path(), place);
    EXPECT_EQ(neve({"verify", "parts"}).exit_code, 0);
    std::filesystem::remove_all(folder / "parts");
  }
}

/// ffmpeg runs for a part of a second only: the kill waits for it.
TEST_F(Counts, KilledWhileItMakesAMovieItLeavesNoProcess) {
  const std::string render = "render scene.toml --out out --quiet";
  const auto is_encoding = [&] {
    for (const std::string& process : processes_of(folder.path()))
      if (contains(process, "ffmpeg")) return true;
    return false;
  };
  std::mt19937 random(3);
  const int count = count_or_whole(10, 100);
  int met = 0;
  for (int k = 0; met < count && k < 5 * count; ++k) {
    std::filesystem::remove_all(folder / "out");
    const pid_t child = start_in(folder.path(), render);
    bool has_begun = false;
    for (int look = 0; look < 5000 && !has_begun && ::kill(child, 0) == 0; ++look) {
      has_begun = is_encoding();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 50));
    ::kill(child, SIGKILL);
    met += wait_for(child) == 128 + SIGKILL && has_begun;
    expect_no_process(folder.path(), "kill " + std::to_string(k));
  }
  EXPECT_EQ(met, count);
  EXPECT_EQ(failing("", render + " --resume").exit_code, 0);
  EXPECT_TRUE(exists("out/particles.mp4"));
  expect_nothing_unfinished(folder.path(), "the kills");
}

TEST_F(Counts, ADriverThatIsKilledLeavesNoProcess) {
  std::mt19937 random(5);
  const std::string sweep = "sweep scene.toml -p seed=1,2,3,4 --out s --jobs 2 --quiet";
  ASSERT_EQ(failing("", "sweep scene.toml -p seed=1,2,3,4 --out whole --jobs 2").exit_code, 0);
  for (int k = 0; k < count_or_whole(10, 100); ++k) {
    kill_after(folder.path(), sweep, std::uniform_real_distribution<>(0.05, 2.0)(random));
    expect_no_process(folder.path(), "kill " + std::to_string(k));
  }
  ASSERT_EQ(failing("", sweep).exit_code, 0);
  expect_nothing_unfinished(folder.path(), "the kills");
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
    const std::string codes = at_once(first, second);
    const bool is_first = codes == "0 6\n";
    EXPECT_TRUE(is_first || codes == "6 0\n") << first << ": " << codes;
    const std::string loser = read_text(folder / (is_first ? "second" : "first"));
    EXPECT_TRUE(contains(loser, "is in use by neve ")) << loser;
    won += is_what_it_makes_alone(is_first ? first : second);
  }
  EXPECT_EQ(won, count);
}

/// One that records frames needs the folder as neve render does. It has it when the other one
/// comes, or it comes while the other one has it.
TEST_F(Counts, OfAViewThatRecordsAndARenderOneWins) {
  folder.write("record.json", R"([{"click": "Save ..."}, {"wait": 3},
      {"click": "Record every frame"}, {"wait": 3}, {"key": "escape"}, {"wait": 3},
      {"click": "Run"}, {"wait_for": "simulation frame 4"}, {"wait_for": "simulation paused"},
      {"wait": 5}, {"quit": true}])");
  const std::string view = "view scene.toml --replay record.json --out out --size 640x400",
                    render = "render scene.toml --out out --no-movie --quiet";
  int won = 0;
  const int count = count_or_whole(6, 100);
  for (int k = 0; k < count; ++k) {
    const auto& [winner, loser] = k % 2 == 0 ? std::pair(view, render) : std::pair(render, view);
    std::filesystem::remove_all(folder / "out");
    const pid_t first = start_in(folder.path(), winner);
    wait_for_text(folder / "out/.lock");
    ::kill(first, SIGSTOP);
    // It stops a moment later.
    int state = 0;
    ASSERT_EQ(::waitpid(first, &state, WUNTRACED), first);
    const auto before = folder_contents(folder / "out");
    const auto second = failing("", loser);
    EXPECT_EQ(second.exit_code, 6) << loser;
    EXPECT_TRUE(contains(second.errors, "is in use by neve ")) << loser << second.errors;
    EXPECT_EQ(folder_contents(folder / "out"), before) << loser;
    ::kill(first, SIGCONT);
    EXPECT_EQ(wait_for(first), 0) << winner;
    won += is_what_it_makes_alone(winner);
  }
  EXPECT_EQ(won, count);
}

/// A collect may run meanwhile: the sweep ends with all of its runs collected.
TEST_F(Counts, ACollectBesideASweepTakesNothingFromIt) {
  const std::string sweep = "sweep scene.toml --out out --frames 0-3 --quiet -p seed=1,2,3",
                    collect = "sweep collect out --quiet";
  int whole = 0, collected = 0;
  const int count = count_or_whole(5, 100);
  for (int k = 0; k < count; ++k) {
    std::filesystem::remove_all(folder / "out");
    const pid_t child = start_in(folder.path(), sweep);
    wait_for_file(folder / "out/manifest.json");
    int status = 0;
    while (::waitpid(child, &status, WNOHANG) == 0) {
      const auto result = failing("", collect);
      EXPECT_EQ(result.exit_code, 0) << result.errors;
      ++collected;
    }
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    EXPECT_EQ(neve({"verify", "out"}).exit_code, 0);
    whole += is_what_it_makes_alone(sweep);
    // One that collects what already exists makes nothing else of it.
    EXPECT_EQ(at_once(collect, collect), "0 0\n");
    EXPECT_EQ(neve({"verify", "out"}).exit_code, 0);
  }
  std::cout << collected << " times collected beside " << count << " sweeps\n";
  EXPECT_EQ(whole, count);
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

/// Scenes have many views, large pictures or much snow. The program itself takes what it takes for
/// the least of scenes.
/// Estimates of final pictures are those of a frame in which nothing moves, which has all samples
/// at once: the moments of a shutter share them, but any run may come to rest.
TEST_F(CostlyCli, EstimatesAreTheMemoryThatIsTaken) {
  const auto estimate_of = [&](const std::string& arguments) {
    cost_of("render " + arguments + " --dry-run --json");
    return json_of("told")["memory_bytes"].get<double>();
  };
  const auto peak_of = [&](const std::string& arguments) {
    const Cost cost =
        cost_of("render " + arguments + " --out out --replace --no-movie --frames 0-2");
    EXPECT_EQ(cost.exit_code, 0) << read_text(folder / "said");
    return cost.memory;
  };
  const double program = peak_of("scene.toml") - estimate_of("scene.toml");
  folder.write("views.toml", with_views(100, "[1280, 720]"));
  for (const char* arguments :
       {"views.toml", "scene.toml --set output.size='[4000, 4000]'",
        "scene.toml --set output.size='[3000, 3000]' --quality final --shutter 0 --set "
        "limits.pixels=1e9",
        "scene.toml --set solver.cell_size=0.006"}) {
    const double ratio = (estimate_of(arguments) + program) / peak_of(arguments);
    EXPECT_LT(ratio, 1.5) << arguments;
    EXPECT_GT(ratio, 1 / 1.5) << arguments;
  }
}

}  // namespace
}  // namespace neve::test
