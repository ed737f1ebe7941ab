/// Runs that are drawn again from kept states.

#include <fstream>
#include <map>

#include "app/output/atomic_file.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

class KeptStates : public Cli {
 protected:
  app::output::ProcessResult sweep(const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> words{"sweep", "scene.toml", "-p", "material.snow.hardening=4,20",
                                   "--out", out};
    words.insert(words.end(), more.begin(), more.end());
    const auto done = neve(words);
    EXPECT_EQ(done.exit_code, 0) << done.errors;
    return done;
  }

  /// Pictures of a folder and below, by their path in it.
  std::map<std::string, std::vector<std::uint8_t>> pictures(const std::string& out) {
    std::map<std::string, std::vector<std::uint8_t>> all;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / out))
      if (entry.path().extension() == ".png")
        all[entry.path().lexically_relative(folder / out).string()] =
            app::output::read_file(entry.path());
    return all;
  }

  int from_states(const std::string& run) {
    return json_of(run + "/run.json").value("frames_from_states", 0);
  }

  /// Records of all frames but the times that they took.
  app::Json frames(const std::string& run) {
    app::Json list = json_of(run + "/run.json")["frames"];
    for (app::Json& frame : list) {
      frame.erase("seconds_sim");
      frame.erase("seconds_render");
    }
    return list;
  }

  void damage(const std::string& file) {
    std::fstream out(folder / file, std::ios::in | std::ios::out | std::ios::binary);
    out.seekp(200);
    out.put('?');
    ASSERT_TRUE(out.good()) << file;
  }
};

/// Another drawing, and the words that make it.
const std::vector<std::vector<std::string>> drawings{
    {"--size", "96x54"},
    {"--size", "160x160"},
    {"--set", "view.particles.particles.color_by=speed"},
    {"--set", "camera.eye=[0, 1, 2]", "--set", "camera.target=[0, 0, 0]"},
    {"--set", "light.intensity=2"}};

TEST_F(KeptStates, AnotherDrawingSimulatesNothingAndEqualsAFreshSweep) {
  sweep("s.cdb", {"--keep-states"});
  for (const auto& drawing : drawings) {
    const auto done = sweep("s.cdb", drawing);
    EXPECT_TRUE(contains(done.errors, "2 runs are drawn from kept states")) << done.errors;
    std::filesystem::remove_all(folder / "fresh.cdb");
    sweep("fresh.cdb", drawing);
    for (const char* run : {"runs/0000", "runs/0001"}) {
      EXPECT_EQ(from_states(std::string("s.cdb/") + run), 4);
      EXPECT_EQ(frames(std::string("s.cdb/") + run), frames(std::string("fresh.cdb/") + run));
    }
    EXPECT_TRUE(pictures("s.cdb") == pictures("fresh.cdb")) << drawing[1];
    EXPECT_EQ(neve({"verify", "s.cdb"}).exit_code, 0);
  }
}

TEST_F(KeptStates, WithoutThemTheRunsAreMadeAgainAndItIsSaid) {
  sweep("s.cdb", {});
  const auto done = sweep("s.cdb", {"--size", "96x54"});
  EXPECT_TRUE(contains(done.errors, "2 runs are made again, although this folder has"))
      << done.errors;
  EXPECT_TRUE(contains(done.errors, "--keep-states keeps them, in about")) << done.errors;
  EXPECT_FALSE(exists("s.cdb/runs/0000/states"));
  const auto one = sweep("s.cdb", {"--size", "64x36", "--only", "0"});
  EXPECT_TRUE(contains(one.errors, "1 run is made again")) << one.errors;
  const auto plan = neve({"sweep", "scene.toml", "-p", "seed=1,2", "--keep-states", "--dry-run"});
  EXPECT_TRUE(contains(plan.output, "kept states take about")) << plan.output;
  const auto bytes = [&](std::vector<std::string> words) {
    words.insert(words.end(),
                 {"-p", "seed=1,2", "--coarsen", "1.5", "--keep-states", "--dry-run", "--json"});
    return app::parse_json(neve(words).output).at("state_bytes").get<double>();
  };
  EXPECT_GT(bytes({"sweep", "scene.toml", "--refine-runs", "0"}),
            2 * bytes({"sweep", "scene.toml"}))
      << "of one run at full resolution too";
}

TEST_F(KeptStates, ADamagedStateCostsItsFrameAloneAndIsMended) {
  sweep("s.cdb", {"--keep-states"});
  sweep("fresh.cdb", {"--size", "96x54"});
  damage("s.cdb/runs/0001/states/000002.ckpt");
  std::filesystem::resize_file(folder / "s.cdb/runs/0001/states/000004.ckpt", 100);
  sweep("s.cdb", {"--size", "96x54"});
  EXPECT_EQ(from_states("s.cdb/runs/0000"), 4);
  EXPECT_EQ(from_states("s.cdb/runs/0001"), 2);
  EXPECT_TRUE(contains(read_text(folder / "s.cdb/runs/0001/log"),
                       "000002.ckpt: is damaged: its checksum is wrong; the frame is simulated"))
      << read_text(folder / "s.cdb/runs/0001/log");
  EXPECT_TRUE(pictures("s.cdb") == pictures("fresh.cdb"));
  sweep("s.cdb", {"--size", "64x36"});
  EXPECT_EQ(from_states("s.cdb/runs/0001"), 4);
  // Without kept states the run is simulated.
  std::filesystem::remove_all(folder / "s.cdb/runs/0001/states");
  sweep("s.cdb", {"--size", "96x54"});
  EXPECT_EQ(from_states("s.cdb/runs/0000"), 4);
  EXPECT_TRUE(pictures("s.cdb/runs/0000") == pictures("fresh.cdb/runs/0000"));
}

TEST_F(KeptStates, AnotherSimulationTakesNone) {
  sweep("s.cdb", {"--keep-states"});
  const auto done = sweep("s.cdb", {"--set", "solver.gravity=[0, -5, 0]"});
  EXPECT_FALSE(contains(done.errors, "kept states")) << done.errors;
  EXPECT_EQ(from_states("s.cdb/runs/0002"), 0);
  EXPECT_FALSE(exists("s.cdb/runs/0002/states"));
}

TEST_F(KeptStates, ForkedRunsAndTheirBeginningAreDrawnAgainToo) {
  const std::vector<std::string> fork{"--fork", "0.1s", "--frames", "5"};
  auto kept = fork, small = fork;
  kept.push_back("--keep-states");
  small.insert(small.end(), {"--size", "96x54"});
  sweep("s.cdb", kept);
  sweep("s.cdb", small);
  sweep("fresh.cdb", small);
  EXPECT_EQ(from_states("s.cdb/beginning"), 1);
  EXPECT_EQ(from_states("s.cdb/runs/0000"), 3);
  EXPECT_TRUE(pictures("s.cdb") == pictures("fresh.cdb"));
}

TEST_F(KeptStates, ARunIsForkedFromItsStatesAndThoseOfAnotherSimulationGo) {
  const auto render = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"render", "scene.toml", "--no-movie"};
    words.insert(words.end(), more.begin(), more.end());
    const auto done = neve(words);
    EXPECT_EQ(done.exit_code, 0) << done.errors;
    return done;
  };
  render({"--out", "a", "--threads", "4"});
  std::filesystem::remove_all(folder / "a/checkpoint");
  const auto fork = neve({"render", "a", "--from", "0.125s", "--no-movie", "--out", "c"});
  EXPECT_TRUE(contains(fork.errors, "continues from the checkpoint of frame 3")) << fork.errors;
  render({"--out", "a", "--set", "seed=2", "--replace", "--no-keep-states"});
  EXPECT_FALSE(exists("a/states"));
}

TEST_F(KeptStates, ADivergedRunIsDrawnAgainAsItWas) {
  folder.write("scene.toml", exploding_scene);
  const std::vector<std::string> render{"render", "scene.toml", "--no-movie", "--out"};
  const auto made = [&](const std::string& out, const std::vector<std::string>& more) {
    auto words = render;
    words.push_back(out);
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(neve(words).exit_code, 5);
  };
  made("a", {"--keep-states"});
  made("a", {"--size", "96x54", "--replace"});
  made("b", {"--size", "96x54"});
  EXPECT_TRUE(pictures("a") == pictures("b"));
}

}  // namespace
}  // namespace neve::test
