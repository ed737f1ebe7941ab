/// Sweeps whose runs part at a time: their beginning is computed once.

#include <regex>
#include <thread>

#include "app/output/checkpoint.h"
#include "app/record/picture_record.h"
#include "app/scene/read.h"
#include "app/sweep/store/manifest.h"
#include "app/sweep/store/results.h"
#include "tests/cli/run_neve.h"
#include "tests/support/child.h"
#include "tests/support/meshes.h"

namespace neve::test {
namespace {

class ForkSweep : public Cli {
 protected:
  app::output::ProcessResult sweep(const std::vector<std::string>& more) {
    std::vector<std::string> words{
        "sweep",  "scene.toml", "-p",       "material.snow.hardening=4,10,20",
        "--fork", "0.125s",     "--frames", "8",
        "--size", "96x54",      "--json",   "--out",
        "f.cdb"};
    words.insert(words.end(), more.begin(), more.end());
    return neve(words);
  }

  std::vector<std::map<int, std::string>> all_hashes(const std::string& out = "f.cdb") {
    std::vector<std::map<int, std::string>> all;
    for (const char* run : {"0000", "0001", "0002"}) all.push_back(hashes(out + "/runs/" + run));
    return all;
  }

  std::vector<app::sweep::store::RunResult> results_of_sweep(const std::string& scene,
                                                             const std::string& axis,
                                                             const std::string& out,
                                                             const std::vector<std::string>& more) {
    std::vector<std::string> words{"sweep", scene, "-p", axis, "--size", "64x64", "--out", out};
    words.insert(words.end(), more.begin(), more.end());
    const auto done = neve(words);
    EXPECT_EQ(done.exit_code, 0) << done.errors;
    return app::sweep::store::read_results(folder / out,
                                           app::sweep::store::read_manifest(folder / out));
  }

  app::Json json_in(const app::output::ProcessResult& done) {
    return app::parse_json(std::string_view(done.output));
  }
};

TEST_F(ForkSweep, AVariedParameterMayHaveAValueUntilTheRunsPart) {
  ASSERT_EQ(sweep({"--set", "material.snow.hardening=30"}).exit_code, 0);
  const std::string beginning = read_text(folder / "f.cdb/beginning/scene.toml");
  EXPECT_TRUE(contains(beginning, "hardening = 30")) << beginning;
  const auto set = all_hashes();
  EXPECT_NE(set[0], set[2]);
  std::filesystem::remove_all(folder / "f.cdb");
  ASSERT_EQ(sweep({}).exit_code, 0);
  EXPECT_NE(set[0], all_hashes()[0]) << "the beginning is another one";
  const auto whole = neve({"sweep", "scene.toml", "-p", "seed=1,2", "--set", "seed=3"});
  EXPECT_EQ(whole.exit_code, 2);
  EXPECT_TRUE(contains(whole.errors, "varied by the sweep")) << whole.errors;
}

TEST_F(ForkSweep, RetriesBetweenFramesAreRefusedBeforeAnyRun) {
  const auto between = neve({"sweep", "scene.toml", "-p", "seed=1,2", "--out", "f.cdb", "--fork",
                             "0.13s", "--set", "solver.on_divergence=retry"});
  EXPECT_EQ(between.exit_code, 2);
  EXPECT_TRUE(contains(between.errors, "--fork: 0.13 s is between two frames")) << between.errors;
  EXPECT_FALSE(exists("f.cdb"));
  EXPECT_EQ(sweep({"--set", "solver.on_divergence=retry", "--dry-run"}).exit_code, 0);
}

TEST_F(ForkSweep, EveryBranchEqualsTheWholeRunWithItsChange) {
  const auto done = sweep({});
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  EXPECT_TRUE(contains(done.errors, "the common beginning of all runs, to frame 3"));
  const auto branches = all_hashes();
  EXPECT_EQ(branches[0].begin()->first, 4);
  EXPECT_NE(branches[0], branches[2]);
  // The whole run, from its start, by the picture of the branch alone.
  std::filesystem::remove_all(folder / "f.cdb/beginning");
  for (const std::size_t run : {0u, 2u}) {
    const std::string picture = "f.cdb/runs/000" + std::to_string(run) + "/particles/0008.png";
    const auto record = app::record::read_picture_record(folder / picture);
    ASSERT_EQ(record.changes.size(), 1u);
    EXPECT_EQ(record.changes[0].address, "material.snow.hardening");
    ASSERT_EQ(neve({"render", picture, "--frames", "0-8", "--out", "whole", "--replace"}).exit_code,
              0);
    const auto whole = hashes("whole");
    for (const auto& [frame, hash] : branches[run]) EXPECT_EQ(whole.at(frame), hash) << frame;
  }
  // The one whose value is that of the scene is the plain run.
  ASSERT_EQ(neve({"render", "scene.toml", "--frames", "8", "--out", "plain"}).exit_code, 0);
  EXPECT_EQ(hashes("plain").at(8), branches[1].at(8));
}

/// Settings are those of the full run, and of a scene in which [set] holds for all runs: branches
/// are told what was planned.
TEST_F(ForkSweep, BranchesAreToldTheValuesThatWerePlanned) {
  const auto changes = [&](const std::string& out) {
    const app::Json manifest = json_of(out + "/manifest.json");
    app::Json told = app::Json::array();
    for (const app::Json& run : manifest["runs"]) told.push_back(run["changes"]);
    return told;
  };
  const std::vector<std::string> more{"--fork", "0.125s", "--frames", "5",
                                      "--size", "64x36",  "--emit",   "commands.txt"};
  std::vector<std::string> coarse{
      "sweep", "scene.toml", "--coarsen", "2", "-p", "solver.max_dt=1e-4,2e-4", "--out", "c.cdb"};
  coarse.insert(coarse.end(), more.begin(), more.end());
  const auto made = neve(coarse);
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_EQ(changes("c.cdb"), app::parse_json(R"([[["solver.max_dt", "2e-4"]],
                                                   [["solver.max_dt", "4e-4"]]])"));
  folder.write("p.toml", R"([sweep]
scene = "scene.toml"
[set]
"material.snow.hardening" = 7
[axis]
"material.snow.preset" = ["paper", "lower_youngs_modulus"]
)");
  std::vector<std::string> preset{"sweep", "p.toml", "--out", "p.cdb"};
  preset.insert(preset.end(), more.begin(), more.end());
  const auto emitted = neve(preset);
  ASSERT_EQ(emitted.exit_code, 0) << emitted.errors;
  const app::Json told = changes("p.cdb");
  EXPECT_TRUE(told[0].empty()) << told;
  EXPECT_TRUE(contains(told[1].dump(), "material.snow.youngs_modulus")) << told;
  EXPECT_FALSE(contains(told[1].dump(), "material.snow.hardening")) << told;
}

TEST_F(ForkSweep, TheReportHasTheCommandThatMakesABranchAgain) {
  ASSERT_EQ(sweep({}).exit_code, 0);
  const std::string page = read_text(folder / "f.cdb/report.html");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(
      page, found, std::regex("\"neve (render f[.]cdb/beginning [^\"]*again/0002[^\"]*)\"")));
  const auto again = app::output::run_process(
      "/bin/sh", {"-c", "exec '" NEVE_BINARY "' " + found.str(1)}, folder.path());
  ASSERT_EQ(again.exit_code, 0) << found.str(1) << "\n" << again.errors;
  EXPECT_EQ(hashes("again/0002"), all_hashes()[2]);
}

TEST_F(ForkSweep, BranchesAreSeenByTheCamerasOfTheSheet) {
  const auto cameras = [&](const std::string& name, const std::string& rest) {
    folder.write(name + ".toml",
                 "[sweep]\nscene = \"scene.toml\"\nfork = \"0.125s\"\nframes = \"0-5\"\n" + rest);
    const auto done = neve({"sweep", name + ".toml", "--size", "64x36", "--movie", "none"});
    EXPECT_EQ(done.exit_code, 0) << done.errors;
    std::vector<app::scene::CameraSettings> found;
    for (const char* run : {"0000", "0001"}) {
      const auto record = app::record::read_picture_record(
          folder / ("out/" + name + ".cdb/runs/" + run + "/particles/0005.png"));
      std::vector<std::string> changes;
      for (const app::scene::LiveChange& change : record.changes)
        changes.push_back(change.address + "=" + change.value);
      const app::scene::Scene beginning = app::scene::read_scene_text(record.scene, "scene.toml");
      found.push_back(
          *app::scene::apply(beginning, app::scene::parse_overrides(changes), "scene.toml").camera);
    }
    return found;
  };
  const auto turned = cameras("turned", "[axis]\n\"camera.orbit\" = [0, 90]\n");
  EXPECT_EQ(turned[0].eye, turned[1].eye);
  EXPECT_EQ(turned[1].orbit, 90);
  const auto each = cameras("each",
                            "[axis]\n\"solver.gravity\" = [[0, -9.8, 0], [30, -9.8, 0]]\n"
                            "[sheet]\nframing = \"each\"\n");
  EXPECT_NE(each[0].eye, each[1].eye);
}

TEST_F(ForkSweep, TheBeginningIsComputedOnce) {
  ASSERT_EQ(sweep({"--jobs", "2"}).exit_code, 0);
  const app::Json status = json_of("f.cdb/beginning/status.json");
  EXPECT_EQ(status["state"], "ok");
  EXPECT_EQ(status["attempts"], 1);
  for (const char* run : {"0000", "0001", "0002"})
    EXPECT_TRUE(contains(read_text(folder / "f.cdb/runs" / run / "scene.toml"),
                         "# neve render ../../beginning --"));
  EXPECT_EQ(json_in(sweep({}))["started"], 0);
  // One more value: the beginning is that of before.
  const auto more =
      neve({"sweep", "scene.toml", "-p", "material.snow.hardening=4,10,20,30", "--fork", "0.125s",
            "--frames", "8", "--size", "96x54", "--json", "--out", "f.cdb"});
  EXPECT_EQ(json_in(more)["started"], 1);
  EXPECT_EQ(json_of("f.cdb/beginning/status.json")["attempts"], 1);
  // At another time all runs fork anew.
  const auto later = neve({"sweep", "scene.toml", "-p", "material.snow.hardening=4,10", "--fork",
                           "0.2", "--frames", "8", "--size", "96x54", "--json", "--out", "f.cdb"});
  EXPECT_EQ(json_in(later)["started"], 2);
  EXPECT_EQ(json_of("f.cdb/beginning/run.json")["frames"].back()["frame"], 4);
}

TEST_F(ForkSweep, AKilledSweepContinuesBitForBit) {
  ASSERT_EQ(sweep({}).exit_code, 0);
  const auto whole = all_hashes();
  for (int k = 0; k < 5; ++k) {
    const pid_t child =
        start_program({NEVE_BINARY, "sweep", folder / "scene.toml", "-p",
                       "material.snow.hardening=4,10,20", "--fork", "0.125s", "--frames", "8",
                       "--size", "96x54", "--quiet", "--out", folder / "k.cdb"});
    std::this_thread::sleep_for(std::chrono::milliseconds(60 + 90 * k));
    ::kill(child, SIGKILL);
    wait_for(child);
  }
  const auto rest =
      neve({"sweep", (folder / "scene.toml").string(), "-p", "material.snow.hardening=4,10,20",
            "--fork", "0.125s", "--frames", "8", "--size", "96x54", "--out", "k.cdb"});
  ASSERT_EQ(rest.exit_code, 0) << rest.errors;
  EXPECT_EQ(all_hashes("k.cdb"), whole);
}

TEST_F(ForkSweep, SingleRunsAndSharesFindOrMakeTheBeginning) {
  ASSERT_EQ(sweep({}).exit_code, 0);
  const auto whole = all_hashes();
  std::filesystem::remove_all(folder / "f.cdb");
  ASSERT_EQ(sweep({"--emit", "commands.txt"}).exit_code, 0);
  EXPECT_FALSE(exists("f.cdb/beginning/run.json"));
  // Two at once: one makes the beginning, the other waits for it.
  std::vector<pid_t> children;
  for (const char* index : {"0", "1"})
    children.push_back(start_program({NEVE_BINARY, "sweep", "run", folder / "f.cdb", "--index",
                                      index, "--threads", "1", "--quiet"}));
  for (const pid_t child : children) EXPECT_EQ(wait_for(child), 0);
  EXPECT_EQ(json_of("f.cdb/beginning/status.json")["attempts"], 1);
  ASSERT_EQ(sweep({"--shard", "3/3"}).exit_code, 0);
  EXPECT_EQ(all_hashes(), whole);
  // A job before an array makes the beginning alone in this way.
  std::filesystem::remove_all(folder / "f.cdb/beginning/checkpoint");
  const auto alone = neve({"sweep", "run", "f.cdb", "--beginning"});
  EXPECT_EQ(alone.exit_code, 0) << alone.errors;
  EXPECT_TRUE(app::output::find_checkpoint(folder / "f.cdb/beginning").checkpoint.has_value());
  EXPECT_EQ(neve({"sweep", "run", "f.cdb"}).exit_code, 2);
}

TEST_F(ForkSweep, ForecastsCountTheBeginningOnce) {
  const auto seconds = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{
        "sweep",    "scene.toml", "-p",        "material.snow.hardening=4,8,10,20",
        "--frames", "24",         "--dry-run", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const app::Json json = json_in(neve(words));
    double sum = json.value("beginning", app::Json::object()).value("seconds", 0.0);
    for (const app::Json& run : json["runs"]) sum += run["seconds"].get<double>();
    return sum;
  };
  const double plain = seconds({}), forked = seconds({"--fork", "0.9s"});
  EXPECT_LT(forked, 0.8 * plain);
  EXPECT_GT(forked, 0.1 * plain);
  EXPECT_FALSE(exists("out"));
}

/// A body in free fall that tears snow on its way: the table tells what happened since the start of
/// the run, whether or not the runs share their beginning.
TEST_F(ForkSweep, TheTableMeasuresFromTheStartOfTheRun) {
  folder.write("fall.toml", R"(
frames = 8
[solver]
cell_size = 0.1
[[body]]
shape = { sphere = { center = [5, 1, 0], radius = 0.3 } }
[[collider]]
name = "b"
shape = { sphere = { center = [0, 2, 0], radius = 0.1 } }
mass = 1
)");
  const auto results_of = [&](const std::string& out, const std::vector<std::string>& more) {
    return results_of_sweep("fall.toml", "solver.flip_ratio=0.9,0.95", out, more);
  };
  const auto whole = results_of("whole.cdb", {}), forked = results_of("f.cdb", {"--fork", "0.25s"}),
             late = results_of("late.cdb", {"--frames", "6-8"});
  const auto& infos = app::sweep::store::metric_infos();
  int compared = 0;
  for (std::size_t k = 0; k < infos.size(); ++k) {
    const std::string name = infos[k].name;
    if (name == "steps" || name.starts_with("max_")) {
      EXPECT_EQ(late[0].metrics[k], whole[0].metrics[k]) << name;
      EXPECT_NEAR(forked[0].metrics[k].value(), whole[0].metrics[k].value(), 1e-5) << name;
      ++compared;
    }
    if (name != "body_fall" && name != "body_way") continue;
    ++compared;
    const double fall = whole[0].metrics[k].value();
    EXPECT_NEAR(fall, 0.5 * 9.81 / 9, 0.02) << "1/3 s of free fall";
    EXPECT_EQ(forked[0].metrics[k], fall) << name;
    EXPECT_EQ(late[0].metrics[k], fall) << name;
  }
  EXPECT_EQ(compared, 8);
  EXPECT_EQ(forked[0].whole, whole[0].whole);
  EXPECT_EQ(late[0].whole, whole[0].whole);
}

/// The ball hits the floor before the first frame that is drawn.
TEST_F(ForkSweep, TheTableKnowsTheImpactBeforeItsFirstFrame) {
  folder.write("hit.toml", R"(
frames = 6
[solver]
cell_size = 0.04
[[body]]
shape = { sphere = { center = [0, 0.13, 0], radius = 0.12 } }
velocity = [0, -4, 0]
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
)");
  const auto results_of = [&](const std::string& out, const std::vector<std::string>& more) {
    return results_of_sweep("hit.toml", "material.snow.hardening=5,10", out, more);
  };
  const auto whole = results_of("whole.cdb", {}),
             late = results_of("late.cdb", {"--frames", "4-6"});
  const auto& infos = app::sweep::store::metric_infos();
  int compared = 0;
  for (std::size_t k = 0; k < infos.size(); ++k) {
    const std::string name = infos[k].name;
    if (name != "steps" && name != "max_speed" && name != "max_force" && name != "max_pressure")
      continue;
    ++compared;
    EXPECT_GT(whole[1].metrics[k].value(), 0) << name;
    EXPECT_EQ(late[1].metrics[k], whole[1].metrics[k]) << name;
  }
  EXPECT_EQ(compared, 4);
  // A run without a record of what was before tells nothing of it.
  app::Json run = json_of("late.cdb/runs/0001/run.json");
  run["start"].erase("before");
  run.erase("hash");
  folder.write("late.cdb/runs/0001/run.json", app::to_text(run));
  const auto manifest = app::sweep::store::read_manifest(folder / "late.cdb");
  const auto unknown =
      app::sweep::store::read_result(folder / "late.cdb", manifest.runs[1], manifest.view);
  for (std::size_t k = 0; k < infos.size(); ++k)
    if (infos[k].name == std::string("max_force")) {
      EXPECT_FALSE(unknown.metrics[k].has_value());
    }
}

TEST_F(ForkSweep, AxesThatNeedARestartAreRefusedWithThoseThatDoNot) {
  const auto refused = [&](const std::vector<std::string>& words, const char* why) {
    std::vector<std::string> all{"sweep", "scene.toml", "--fork"};
    all.insert(all.end(), words.begin(), words.end());
    const auto done = neve(all);
    EXPECT_EQ(done.exit_code, 2) << done.errors;
    EXPECT_TRUE(contains(done.errors, why)) << done.errors;
  };
  refused({"0.1s", "-p", "body.ball.velocity=[0,-1,0],[0,-3,0]"},
          "--fork: body.ball.velocity cannot change while a simulation runs; parameters that can: "
          "solver.threshold_cell, solver.kernel");
  refused({"0.1s", "-p", "solver.cell_size=0.04,0.05"}, "material.NAME.hardening");
  refused({"9s", "-p", "material.snow.hardening=4,5"}, "their last frame is 4");
  refused({"soon", "-p", "material.snow.hardening=4,5"}, "as in --fork 0.25s");
  EXPECT_FALSE(exists("out"));
  folder.write("sweep.toml", R"([sweep]
scene = "scene.toml"
fork = "late"
[axis]
"material.snow.hardening" = [4, 5]
)");
  const auto file = neve({"sweep", "sweep.toml"});
  EXPECT_EQ(file.exit_code, 3);
  EXPECT_TRUE(contains(file.errors, "sweep.toml:3:")) << file.errors;
}

TEST_F(ForkSweep, RunsOfABeginningThatFailsFailWithItsReason) {
  folder.write("bad.toml", exploding_scene);
  const std::vector<std::string> words{
      "sweep",  "bad.toml", "-p",    "solver.gravity=[0,-9,0],[0,-8,0]",
      "--fork", "0.25s",    "--out", "bad.cdb"};
  const auto done = neve(words);
  EXPECT_EQ(done.exit_code, 7);
  EXPECT_TRUE(contains(done.errors, "the common beginning ended as diverged")) << done.errors;
  EXPECT_TRUE(contains(done.errors, "2 runs that fork from it fail with it")) << done.errors;
  EXPECT_TRUE(contains(read_text(folder / "bad.cdb/data.csv"),
                       ",diverged,\"the common beginning ended as diverged: "));
  EXPECT_TRUE(contains(read_text(folder / "bad.cdb/report.html"), "the common beginning ended as"));
  EXPECT_EQ(neve(words).exit_code, 7);
  EXPECT_EQ(json_of("bad.cdb/beginning/status.json")["attempts"], 1);
}

/// A branch runs in a folder of its own, and was told the path as it was typed.
TEST_F(ForkSweep, FilesOfAnAxisAreThoseBesideTheScene) {
  folder.write("shots/low.obj", box_obj({1, 0.02, 1}));
  folder.write("shots/high.obj", box_obj({1, 0.06, 1}));
  folder.write("shots/scene.toml",
               std::string(tiny_scene) +
                   "[[collider]]\nname = \"wall\"\nshape = { mesh = { file = \"low.obj\" } }\n");
  const auto done =
      neve({"sweep", "shots/scene.toml", "-p", "collider.wall.shape.mesh.file=low.obj,high.obj",
            "--fork", "0.05s", "--frames", "2", "--size", "96x54", "--out", "f.cdb"});
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  EXPECT_NE(hashes("f.cdb/runs/0000")[2], hashes("f.cdb/runs/0001")[2]);
}

TEST_F(ForkSweep, RunsOfABeginningThatIsRefusedAreRefused) {
  const auto done = sweep({"--set", "limits.particles=50"});
  EXPECT_EQ(done.exit_code, 7);
  EXPECT_TRUE(contains(done.errors, "the common beginning ended as refused: about "))
      << done.errors;
  EXPECT_EQ(json_in(done)["failed"], 3);
  for (const char* run : {"0000", "0001", "0002"})
    EXPECT_EQ(json_of(std::string("f.cdb/runs/") + run + "/status.json")["state"], "refused");
  EXPECT_EQ(neve({"verify", "f.cdb"}).exit_code, 0) << "nothing is missing that was made";
}

}  // namespace
}  // namespace neve::test
