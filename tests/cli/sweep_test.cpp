/// `neve sweep`: plans, runs, what is left of runs that go wrong, and continuing.

#include <signal.h>

#include "app/record/run_json.h"
#include "tests/cli/run_neve.h"
#include "tests/support/saboteur.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

const char* const small_sweep = R"(
[sweep]
scene = "scene.toml"
frames = "0-2"
[axis]
"material.snow.hardening" = [5, 10]
"body.ball.velocity" = [[0, -1, 0], [0, -3, 0]]
)";

/// Six runs: two that are well, one that explodes, one that wants too much memory, and two long
/// ones for tests that interrupt them.
const std::string troubled_sweep = std::string(R"(
[sweep]
scene = "scene.toml"
method = "list"
[limits]
timeout = "15s"
memory = "600MB"
[[run]]
label = "good"
seed = 1
[[run]]
label = "also good"
seed = 2
)") + exploding_run + R"([[run]]
label = "too large"
"solver.cell_size" = 0.002
[[run]]
label = "crashes"
"solver.max_dt" = 1e-6
[[run]]
label = "hangs"
"solver.max_dt" = 1.1e-6
)";

class SweepCli : public Cli {
 protected:
  SweepCli() { folder.write("sweep.toml", small_sweep); }

  app::Json status(const std::string& run, const std::string& out = "out/sweep.cdb") {
    return json_of(out + "/runs/" + run + "/status.json");
  }
};

/// The times of a dry run come from a coarse copy of each run: stiff snow takes more steps.
TEST_F(SweepCli, DryRunsForeseeTheCostOfEachRun) {
  const auto result = neve({"sweep", "scene.toml", "-p", "material.snow.youngs_modulus=2e4,5e6",
                            "--frames", "4", "--dry-run", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const app::Json plan = app::parse_json(std::string_view(result.output));
  constexpr double drawn = 0.1 + 5 * 0.02;  // the start of a process, and tiles
  const double soft = plan["runs"][0]["seconds"].get<double>() - drawn,
               stiff = plan["runs"][1]["seconds"].get<double>() - drawn;
  EXPECT_GT(stiff, 2 * soft) << result.output;
  EXPECT_GE(plan["seconds"].get<double>(), stiff);
}

TEST_F(SweepCli, RunsThatAreNotThereAreRefusedBeforeAnythingStarts) {
  const std::vector<std::string> sweep{"sweep", "sweep.toml", "--only", "99"};
  std::vector<std::string> dry = sweep;
  dry.emplace_back("--dry-run");
  for (const std::vector<std::string>& words : {sweep, dry}) {
    const auto result = neve(words);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_TRUE(contains(result.errors, "--only: there is no run 99; expected numbers from 0 to 3"))
        << result.errors;
    EXPECT_FALSE(exists("out"));
  }
  const auto one = neve({"sweep", "sweep.toml", "--only", "3", "--dry-run", "--json"});
  const app::Json plan = app::parse_json(std::string_view(one.output));
  ASSERT_EQ(plan["runs"].size(), 1u);
  EXPECT_EQ(plan["runs"][0]["run"], 3);
  EXPECT_TRUE(contains(neve({"sweep", "sweep.toml", "--shard", "7/8", "--dry-run"}).errors,
                       "share 7/8 of 4 runs is empty"));
}

TEST_F(SweepCli, AnEmptyListOfRunsIsNotAllOfThem) {
  const auto result = neve({"sweep", "sweep.toml", "--only", ""});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.errors, "is a variable of the shell not set?")) << result.errors;
  EXPECT_FALSE(exists("out"));
}

/// The paper's snow has no cohesion of its own: the sheet would say that it makes no difference.
TEST_F(SweepCli, ParametersThatTheSceneDoesNotUseAreNamed) {
  const auto result =
      neve({"sweep", "scene.toml", "-p", "material.snow.cohesion=0.1,1", "-p",
            "material.snow.hardening=5,10", "--size", "64x64", "--frames", "4", "--out", "s.cdb"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const std::string idle = "material.snow.cohesion changes no bit of the snow";
  EXPECT_TRUE(contains(result.errors, idle)) << result.errors;
  EXPECT_FALSE(contains(result.errors, "hardening changes no")) << result.errors;
  EXPECT_TRUE(contains(read_text(folder / "s.cdb/report.html"), idle));
  const std::string why = "material snow has model = \"snow\", which does not use it";
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"sweep", "scene.toml", "-p", "material.snow.cohesion=0.1,1",
                                 "--dry-run"},
        {"check", "scene.toml", "--set", "material.snow.cohesion=1"},
        {"render", "scene.toml", "--frames", "0", "--no-movie", "--set",
         "material.snow.cohesion=1"}}) {
    const auto told = neve(words);
    EXPECT_TRUE(contains(told.errors + told.output, why)) << told.errors << told.output;
  }
  const auto both = neve({"sweep", "scene.toml", "-p", "material.snow.cohesion=0.1,1", "-p",
                          "material.snow.model=snow,cam_clay", "--dry-run"});
  EXPECT_FALSE(contains(both.errors, "changes nothing")) << both.errors;
}

/// A remedy in a sweep with --coarsen has the number that the next sweep is given.
TEST_F(SweepCli, RemediesOfCoarseRunsHaveTheNumbersToType) {
  const auto result =
      neve({"sweep", "scene.toml", "--coarsen", "2", "--set", "solver.time_step=fixed", "-p",
            "solver.dt=2e-4,2e-2", "--size", "64x64", "--out", "s.cdb"});
  EXPECT_TRUE(contains(status("0001", "s.cdb").value("reason", ""), "(--coarsen 2 makes it "))
      << status("0001", "s.cdb") << result.errors;
  EXPECT_EQ(json_of("s.cdb/runs/0000/run.json").value("coarsen", 1.0), 2);
}

TEST_F(SweepCli, AnAxisOfOneValueIsAWarning) {
  const auto result = neve({"sweep", "scene.toml", "-p", "material.snow.hardening=5", "--dry-run"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(
      contains(result.errors, "material.snow.hardening has one value: no run differs in it"))
      << result.errors;
}

TEST_F(SweepCli, DryRunsListRunsCostAndMemoryAndStartNothing) {
  const auto result = neve({"sweep", "sweep.toml", "--dry-run"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(contains(result.output, "hardening = 10, velocity = [0, -3, 0] m/s"))
      << result.output;
  EXPECT_TRUE(contains(result.output, "4 runs of scene.toml, frames 0 to 2")) << result.output;
  EXPECT_TRUE(contains(result.output, "of memory a run")) << result.output;
  EXPECT_FALSE(exists("out"));
  const auto as_json = neve({"sweep", "sweep.toml", "--dry-run", "--json"});
  const app::Json plan = app::parse_json(std::string_view(as_json.output));
  ASSERT_EQ(plan["runs"].size(), 4u);
  EXPECT_EQ(plan["runs"][3]["settings"]["material.snow.hardening"], "10");
  EXPECT_GT(plan["runs"][3]["seconds"].get<double>(), 0);
  // The program itself takes 80 MiB.
  EXPECT_GT(plan["memory_bytes"].get<double>(), 80e6);
  EXPECT_EQ(plan["runs"][3]["over_memory_limit"], false);
}

TEST_F(SweepCli, DryRunsNameTheRunsThatTakeMuchLonger) {
  const auto result = neve({"sweep", "scene.toml", "-p", "frames=4,5,80", "--dry-run"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(contains(result.output, "the longest: run 2, ")) << result.output;
  const auto equal = neve({"sweep", "scene.toml", "-p", "seed=1,2,3", "--dry-run"});
  EXPECT_FALSE(contains(equal.output, "the longest")) << equal.output;
}

/// Results are the same whichever run starts first.
TEST_F(SweepCli, AStartForeseesItsRunsAndBeginsWithTheLongest) {
  const auto sweep = [&](const char* jobs) {
    return neve({"sweep", "scene.toml", "-p", "frames=4,5,6,80", "--threads", "2", "--jobs", jobs,
                 "--verbose", "--json", "--out", std::string("jobs_") + jobs});
  };
  const auto together = sweep("2");
  ASSERT_EQ(together.exit_code, 0) << together.errors;
  EXPECT_TRUE(contains(together.errors, "forecast: 4 runs, about ")) << together.errors;
  EXPECT_TRUE(contains(together.errors, "\nthe longest: run 3, ")) << together.errors;
  const auto place = [](const app::output::ProcessResult& done, const char* run) {
    return done.errors.find(std::string("run ") + run + " starts on");
  };
  EXPECT_LT(place(together, "3"), place(together, "0"));
  const app::Json result = app::parse_json(std::string_view(together.output));
  EXPECT_GT(result["foreseen_seconds"].get<double>(), 0);
  // One after the other, nothing waits for a long one: the ends of the axis come first.
  const auto alone = sweep("1");
  EXPECT_LT(place(alone, "0"), place(alone, "3"));
  for (const char* run : {"0000", "0001", "0002", "0003"})
    EXPECT_EQ(hashes(std::string("jobs_1/runs/") + run), hashes(std::string("jobs_2/runs/") + run));
  const auto again = sweep("2");
  EXPECT_FALSE(contains(again.errors, "forecast: ")) << "nothing is left to do";
  EXPECT_EQ(app::parse_json(std::string_view(again.output))["started"], 0);
  // One more run: it alone is foreseen.
  const auto more = neve({"sweep", "scene.toml", "-p", "frames=4,5,6,80,7", "--out", "jobs_2"});
  EXPECT_TRUE(contains(more.errors, "forecast: 1 run, about ")) << more.errors;
}

TEST_F(SweepCli, ASheetOfAnAxisThatIsNotThereIsRefusedBeforeAnythingStarts) {
  folder.write("sheet.toml", std::string(small_sweep) + "[sheet]\ncolumns = \"hardness\"\n");
  for (const char* flag : {"--dry-run", "--json"}) {
    const auto result = neve({"sweep", "sheet.toml", flag});
    EXPECT_EQ(result.exit_code, 3) << flag;
    EXPECT_TRUE(contains(result.errors, "sheet.columns = \"hardness\": no such axis"))
        << result.errors;
    EXPECT_FALSE(exists("out"));
  }
}

TEST_F(SweepCli, CollectSaysWhatTheFolderOfASweepIs) {
  ASSERT_EQ(neve({"render", "scene.toml", "--frames", "0", "--out", "run"}).exit_code, 0);
  const auto refused = [&](const char* folder, const char* why) {
    const auto result = neve({"sweep", "collect", folder});
    EXPECT_EQ(result.exit_code, 6);
    EXPECT_TRUE(contains(result.errors, why)) << result.errors;
    EXPECT_TRUE(contains(result.errors, "expected the folder that neve sweep wrote"));
  };
  refused("nowhere", "nowhere: there is no such folder");
  refused("run", "run: is the folder of one run, not of a sweep");
  refused("run/particles", "run/particles: is a folder without a sweep in it");
  refused("scene.toml", "scene.toml: is a file, not the folder of a sweep");
}

TEST_F(SweepCli, DryRunsMarkRunsOverTheLimitAndShowCommonFrames) {
  folder.write("tight.toml",
               "[sweep]\nscene = \"scene.toml\"\n[limits]\nmemory = \"60MiB\"\n[axis]\nframes = "
               "[1, 2]\n");
  const auto result = neve({"sweep", "tight.toml", "--dry-run"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(contains(result.output, "over [limits] memory")) << result.output;
  EXPECT_TRUE(contains(result.output, "2 runs need more than [limits] memory = 60.0 MiB"))
      << result.output;
  EXPECT_TRUE(contains(result.output, ", up to frame 2, view")) << result.output;
  // Runs that need more memory are not started.
  const auto made = neve({"sweep", "tight.toml"});
  EXPECT_EQ(made.exit_code, 7);
  EXPECT_TRUE(contains(made.errors, "OUT OF MEMORY needs")) << made.errors;
}

TEST_F(SweepCli, MistakesExitWithTheirCodesAndSuggestions) {
  EXPECT_EQ(neve({"sweep"}).exit_code, 2);
  EXPECT_EQ(neve({"sweep", "scene.toml"}).exit_code, 2);
  EXPECT_EQ(neve({"sweep", "scene.toml", "-p", "seed=1,2", "--jobs", "-1"}).exit_code, 2);
  const auto wrong = neve({"sweep", "scene.toml", "-p", "material.snow.hardning=1,2"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_TRUE(contains(wrong.errors, "did you mean \"material.snow.hardening\"?")) << wrong.errors;
  folder.write("bad.toml", "[sweep]\nscene = \"scene.toml\"\n[axis]\nseed = [1, -1]\n");
  const auto bad = neve({"sweep", "bad.toml"});
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_TRUE(contains(bad.errors, "bad.toml:4:12: error: seed = -1; expected")) << bad.errors;
  folder.write(
      "many.toml",
      "[sweep]\nscene = \"scene.toml\"\n[limits]\nruns = 3\n[axis]\nseed = [1, 2, 3, 4]\n");
  EXPECT_EQ(neve({"sweep", "many.toml"}).exit_code, 8);
}

TEST_F(SweepCli, RepeatedSweepsMakeOnlyNewRuns) {
  const auto first = neve({"sweep", "sweep.toml"});
  ASSERT_EQ(first.exit_code, 0) << first.errors;
  for (const char* run : {"0000", "0001", "0002", "0003"}) {
    EXPECT_EQ(status(run)["state"], "ok");
    EXPECT_TRUE(exists("out/sweep.cdb/runs/" + std::string(run) + "/particles/0002.png"));
  }
  const auto made = fs::last_write_time(folder / "out/sweep.cdb/runs/0000/run.json");
  // The new values come in between; what was done keeps its folder.
  std::string longer = small_sweep;
  longer.replace(longer.find("[5, 10]"), 7, "[5, 7, 10]");
  folder.write("sweep.toml", longer);
  const auto second = neve({"sweep", "sweep.toml", "--json"});
  ASSERT_EQ(second.exit_code, 0) << second.errors;
  const app::Json result = app::parse_json(std::string_view(second.output));
  EXPECT_EQ(result["started"], 2);
  EXPECT_EQ(result["ok"], 6);
  EXPECT_EQ(fs::last_write_time(folder / "out/sweep.cdb/runs/0000/run.json"), made);
  for (const char* run : {"0000", "0001", "0002", "0003", "0004", "0005"})
    EXPECT_EQ(status(run)["attempts"], 1) << run;
  const auto third = neve({"sweep", "sweep.toml", "--json"});
  EXPECT_EQ(app::parse_json(std::string_view(third.output))["started"], 0);
}

TEST_F(SweepCli, RunsThatAreTheSameAreNamed) {
  const auto result =
      neve({"sweep", "scene.toml", "-p", "output.size=[320,180],[640,360]", "--dry-run"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(contains(result.errors, "runs 0 and 1 are the same: the sweep sets output.size"))
      << result.errors;
}

/// The runs have "1.10", "1.1" and "007", and so have the table and the manifest.
TEST_F(SweepCli, TextsThatLookLikeNumbersAreNoNumbers) {
  const auto result =
      neve({"sweep", "scene.toml", "-p", "shot.version=1.10,1.1,007", "--frames", "0"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_FALSE(contains(result.errors, "twice")) << result.errors;
  const std::string table = read_text(folder / "out/scene.cdb/data.csv");
  for (const char* version : {",'1.10',", ",'1.1',", ",'007',"})
    EXPECT_TRUE(contains(table, version)) << version << " in " << table;
  EXPECT_EQ(json_of("out/scene.cdb/manifest.json")["axes"][0]["values"],
            (app::Json{"1.10", "1.1", "007"}));
}

TEST_F(SweepCli, AnotherSweepDoesNotReplaceTheFirst) {
  const auto first = neve({"sweep", "scene.toml", "-p", "seed=1,2", "--frames", "0"});
  ASSERT_EQ(first.exit_code, 0) << first.errors;
  const std::string table = read_text(folder / "out/scene.cdb/data.csv");
  const auto other =
      neve({"sweep", "scene.toml", "-p", "material.snow.hardening=5,10", "--frames", "0"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_TRUE(contains(other.errors,
                       "out/scene.cdb: has a sweep of seed; this one varies "
                       "material.snow.hardening; choose another folder with --out"))
      << other.errors;
  EXPECT_EQ(read_text(folder / "out/scene.cdb/data.csv"), table);
  const auto finer = neve({"sweep", "scene.toml", "-p", "seed=1,2,3", "--frames", "0", "--json"});
  ASSERT_EQ(finer.exit_code, 0) << finer.errors;
  EXPECT_EQ(app::parse_json(std::string_view(finer.output))["started"], 1);
}

TEST_F(SweepCli, MoreSamplesMakeOnlyNewRuns) {
  const auto started = [&](int samples) {
    folder.write("spread.toml",
                 "[sweep]\nscene = \"scene.toml\"\nmethod = \"sobol\"\nframes = \"0\"\nsamples = " +
                     std::to_string(samples) +
                     "\n[axis]\n\"material.snow.hardening\" = { uniform = [5, 15] }\n"
                     "\"material.snow.youngs_modulus\" = { log_uniform = [5e4, 5e5] }\n");
    const auto result = neve({"sweep", "spread.toml", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return app::parse_json(std::string_view(result.output))["started"].get<int>();
  };
  EXPECT_EQ(started(8), 8);
  EXPECT_EQ(started(16), 8);
  EXPECT_EQ(started(16), 0);
}

TEST_F(SweepCli, AScreeningTellsWhatEachParameterDoes) {
  folder.write("screen.toml",
               "[sweep]\nscene = \"scene.toml\"\nmethod = \"morris\"\nframes = \"2\"\nsamples = 2\n"
               "[axis]\n\"body.ball.velocity\" = [[0, -1, 0], [0, -2, 0], [0, -3, 0], [0, -4, 0]]\n"
               "\"material.snow.density\" = { uniform = [300, 500] }\n");
  const auto result = neve({"sweep", "screen.toml"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(contains(result.errors, "top speed (m/s): velocity ")) << result.errors;
  const std::string csv = read_text(folder / "out/screen.cdb/effects.csv");
  EXPECT_TRUE(contains(csv, "kinetic_energy,J,\"body.ball.velocity\",2,")) << csv;
  EXPECT_TRUE(exists("out/screen.cdb/effects.svg"));
  EXPECT_TRUE(contains(read_text(folder / "out/screen.cdb/report.html"),
                       "<h2>What each parameter does to each metric</h2>"));
}

TEST_F(SweepCli, RunsAreRepeatedByTheirSceneFileBitForBit) {
  ASSERT_EQ(neve({"sweep", "sweep.toml"}).exit_code, 0);
  const std::string run = "out/sweep.cdb/runs/0003";
  ASSERT_EQ(neve({"render", run + "/scene.toml", "--frames", "0-2", "--out", "again"}).exit_code,
            0);
  EXPECT_EQ(read_text(folder / (run + "/particles/0002.png")),
            read_text(folder / "again/particles/0002.png"));
  const app::Json a = json_of(run + "/run.json"), b = json_of("again/run.json");
  EXPECT_EQ(a["frames"][2]["state_hash"], b["frames"][2]["state_hash"]);
}

TEST_F(SweepCli, TilesShowTheViewAndTheQualityThatAreAskedFor) {
  const auto sweep = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"sweep", "scene.toml", "-p",     "seed=1,2", "--frames", "0",
                                   "--out", "s",          "--size", "160x90",   "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return neve(words);
  };
  const auto plain = sweep({"--view", "smoke"});
  ASSERT_EQ(plain.exit_code, 0) << plain.errors;
  const std::string quick = read_text(folder / "s/runs/0000/smoke/0000.png");
  ASSERT_EQ(sweep({"--view", "smoke", "--quality", "final"}).exit_code, 0);
  const app::Json manifest = json_of("s/manifest.json");
  EXPECT_EQ(manifest["quality"], "final");
  const std::string run = manifest["runs"][0]["folder"].get<std::string>();
  EXPECT_NE(read_text(folder / "s/runs" / run / "smoke/0000.png"), quick) << "four samples a pixel";
  EXPECT_TRUE(contains(sweep({"--quality", "draft"}).errors, "give --size"));
  EXPECT_EQ(sweep({"--view", "smok"}).exit_code, 2);
}

/// A coarse, fast tile leads to the scene that makes it in its own resolution, with its comments.
TEST_F(SweepCli, ATileBecomesASceneOfItsOwn) {
  folder.write("scene.toml", "# mine\n" + std::string(tiny_scene) +
                                 "[material.snow]\nhardening = 10  # first guess\n");
  ASSERT_EQ(neve({"sweep", "scene.toml", "-p", "material.snow.hardening=5,7", "--set", "seed=3",
                  "--coarsen", "1.5", "--fast", "--frames", "1", "--quiet"})
                .exit_code,
            0);
  const auto made = neve({"sweep", "promote", "out/scene.cdb", "1"});
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_TRUE(contains(made.output, "neve render scene_1.toml")) << made.output;
  const std::string text = read_text(folder / "scene_1.toml");
  EXPECT_TRUE(text.starts_with("# Run 1 of out/scene.cdb: material.snow.hardening = 7.\n# mine\n"))
      << text;
  EXPECT_TRUE(contains(text, "hardening = 7  # first guess")) << text;
  EXPECT_FALSE(contains(text, "acoustic_cfl")) << "that was --fast";
  ASSERT_EQ(neve({"render", "scene_1.toml", "--frames", "1", "--out", "a", "--quiet"}).exit_code,
            0);
  ASSERT_EQ(neve({"render", "scene.toml", "--set", "material.snow.hardening=7", "--set", "seed=3",
                  "--frames", "1", "--out", "b", "--quiet"})
                .exit_code,
            0);
  EXPECT_EQ(neve({"compare", "a", "b"}).exit_code, 0) << "the same run to the bit";
  // Nothing that a person wrote since is lost, and a scene that changed is told.
  EXPECT_EQ(neve({"sweep", "promote", "out/scene.cdb", "1"}).exit_code, 0) << "the same again";
  folder.write("scene_1.toml", "mine");
  EXPECT_EQ(neve({"sweep", "promote", "out/scene.cdb", "1"}).exit_code, 2);
  folder.write("scene.toml", "# other\n" + std::string(tiny_scene));
  fs::create_directory(folder / "shots");
  const auto later = neve({"sweep", "promote", "out/scene.cdb", "0", "--out", "shots/shot.toml"});
  EXPECT_EQ(later.exit_code, 0) << later.errors;
  EXPECT_TRUE(contains(later.errors, "has changed since the sweep")) << later.errors;
  EXPECT_EQ(neve({"sweep", "promote", "out/scene.cdb", "2"}).exit_code, 2);
}

TEST_F(SweepCli, AFileThatASceneNamesAndThatChangedSinceIsTold) {
  const auto write_mesh = [&](const char* height) {
    folder.write("shots/mesh.obj", std::string("v 0 0 0\nv 0.1 0 0\nv 0 0 0.1\nv 0 ") + height +
                                       " 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n");
  };
  write_mesh("0.1");
  folder.write("shots/scene.toml",
               std::string(tiny_scene) +
                   "[[collider]]\nname = \"rock\"\nshape = { mesh = { file = \"mesh.obj\" } }\n");
  const auto made = neve({"sweep", "shots/scene.toml", "-p", "material.snow.hardening=5,7",
                          "--frames", "1", "--quiet", "--out", "s"});
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_FALSE(contains(neve({"sweep", "promote", "s", "1"}).errors, "changed since"));
  write_mesh("0.12");
  const auto later = neve({"sweep", "promote", "s", "1"});
  EXPECT_EQ(later.exit_code, 0) << later.errors;
  EXPECT_TRUE(contains(later.errors, "mesh.obj has changed since the sweep")) << later.errors;
  // Runs of a larger rock are not seen by the camera of the smaller one.
  const std::string before = read_text(folder / "s/look.toml");
  write_mesh("1.5");
  const auto again = neve({"sweep", "shots/scene.toml", "-p", "material.snow.hardening=5,7",
                           "--frames", "1", "--quiet", "--out", "s"});
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_NE(read_text(folder / "s/look.toml"), before);
}

TEST_F(SweepCli, StarsAndNotesStayWithTheSweep) {
  folder.write("scene.toml", tiny_scene);
  ASSERT_EQ(neve({"sweep", "scene.toml", "-p", "material.snow.hardening=5,7,9", "--frames", "1",
                  "--quiet", "--out", "s.cdb"})
                .exit_code,
            0);
  EXPECT_TRUE(contains(neve({"sweep", "star", "s.cdb"}).output, "no run has a star"));
  EXPECT_FALSE(contains(read_text(folder / "s.cdb/data.csv"), "star,note"));
  EXPECT_EQ(neve({"sweep", "star", "s.cdb", "0"}).exit_code, 0);
  const auto no_run = neve({"sweep", "star", "s.cdb", "7"});
  EXPECT_EQ(no_run.exit_code, 2);
  EXPECT_TRUE(contains(no_run.errors, "RUNS: there is no run 7")) << no_run.errors;
  const auto given = neve({"sweep", "star", "s.cdb", "2", "--note", "the edge, </script>"});
  ASSERT_EQ(given.exit_code, 0) << given.errors;
  EXPECT_TRUE(contains(given.output, "the edge")) << given.output;
  const auto has_them = [&] {
    const std::string csv = read_text(folder / "s.cdb/data.csv");
    EXPECT_TRUE(contains(csv, ",star,note,")) << csv;
    EXPECT_TRUE(contains(csv, "1,\"the edge, </script>\"")) << csv;
    EXPECT_TRUE(contains(csv, ",0,-,")) << csv;
    const std::string page = read_text(folder / "s.cdb/report.html");
    EXPECT_TRUE(contains(page, "\"note\":\"the edge, \\u003c/script>\"")) << "ends no script";
    EXPECT_TRUE(fs::exists(folder / "s.cdb/starred.png"));
  };
  has_them();
  // Sheets have them with the next collect, which keeps them.
  const std::string sheet = read_text(folder / "s.cdb/sheet.png");
  ASSERT_EQ(neve({"sweep", "collect", "s.cdb", "--quiet"}).exit_code, 0);
  has_them();
  EXPECT_NE(read_text(folder / "s.cdb/sheet.png"), sheet);
  // It grows, and shrinks: the star stays with its run, and is kept where there is none.
  const auto grown = neve({"sweep", "scene.toml", "-p", "material.snow.hardening=5,6,7,9",
                           "--frames", "1", "--quiet", "--out", "s.cdb"});
  ASSERT_EQ(grown.exit_code, 0) << grown.errors;
  EXPECT_TRUE(contains(neve({"sweep", "star", "s.cdb"}).output, "* run 3 (runs/0002): the edge"));
  const auto shrunk = neve({"sweep", "scene.toml", "-p", "material.snow.hardening=5,6", "--frames",
                            "1", "--quiet", "--out", "s.cdb"});
  EXPECT_TRUE(contains(shrunk.errors, "material.snow.hardening = 9")) << shrunk.errors;
  const auto listed = neve({"sweep", "star", "s.cdb"});
  EXPECT_EQ(listed.exit_code, 0) << listed.errors;
  EXPECT_FALSE(contains(listed.output, "the edge")) << listed.output;
  ASSERT_EQ(neve({"sweep", "scene.toml", "-p", "material.snow.hardening=5,7,9", "--frames", "1",
                  "--quiet", "--out", "s.cdb"})
                .exit_code,
            0);
  has_them();
  // A list that the page has made.
  folder.write("stars.json",
               R"({"format": "neve stars 1", "runs": [{"run": 1, "star": true, "note": "wet"}]})");
  EXPECT_TRUE(contains(neve({"sweep", "star", "s.cdb", "--read", "stars.json"}).output, "wet"));
  ASSERT_EQ(neve({"sweep", "star", "s.cdb", "0-2", "--remove"}).exit_code, 0);
  EXPECT_FALSE(fs::exists(folder / "s.cdb/stars.json"));
  EXPECT_FALSE(fs::exists(folder / "s.cdb/starred.png"));
  EXPECT_EQ(neve({"sweep", "star", "s.cdb", "3"}).exit_code, 2);
  EXPECT_EQ(neve({"sweep", "star", "s.cdb", "--note", "x"}).exit_code, 2);
  // A note can be taken away alone, and one that no list may have is refused where it is given.
  neve({"sweep", "star", "s.cdb", "1", "--note", "wet"});
  EXPECT_EQ(neve({"sweep", "star", "s.cdb", "1", "--note", ""}).output, "* run 1\n");
  const auto long_note = neve({"sweep", "star", "s.cdb", "1", "--note", std::string(2001, 'x')});
  EXPECT_EQ(long_note.exit_code, 2);
  EXPECT_TRUE(contains(long_note.errors, "this note has 2001 bytes")) << long_note.errors;
  EXPECT_EQ(neve({"sweep", "star", "s.cdb", "1", "--remove"}).exit_code, 0);
  folder.write("stars.json", R"({"format": "neve stars 1", "runs": [{"run": 7, "star": true}]})");
  const auto beyond = neve({"sweep", "star", "s.cdb", "--read", "stars.json"});
  for (const auto& [text, said] :
       {std::pair{"{\"format\": \"neve stars 1\", \"runs\": [", "byte 37 is not JSON"},
        {"{\"format\": \"neve stars 1\", \"runs\": [7]}", "expected a \"run\", a \"star\""}}) {
    folder.write("broken.json", text);
    const auto broken = neve({"sweep", "star", "s.cdb", "--read", "broken.json"});
    EXPECT_EQ(broken.exit_code, 3);
    EXPECT_TRUE(contains(broken.errors, said)) << broken.errors;
    EXPECT_FALSE(contains(broken.errors, "json.exception")) << broken.errors;
  }
  EXPECT_EQ(beyond.exit_code, 3) << beyond.errors;
  EXPECT_TRUE(contains(beyond.errors, "the runs of this sweep are 0 to 2")) << beyond.errors;
  folder.write("s.cdb/stars.json", "{");
  EXPECT_EQ(neve({"sweep", "star", "s.cdb"}).exit_code, 3);
}

TEST_F(SweepCli, NothingOfAnEarlierSweepStaysAsIfItWereOfThisOne) {
  folder.write("scene.toml", tiny_scene);
  std::vector<std::string> words{"sweep",    "scene.toml", "-p",      "material.snow.hardening=5,7",
                                 "--frames", "3",          "--quiet", "--out",
                                 "s.cdb"};
  words.emplace_back("--review");
  ASSERT_EQ(neve(words).exit_code, 0);
  for (const char* file :
       {"strips.png", "sheet/0000.png", "sheet/0003.png", "plots.svg", "review/run_0000.0000.png"})
    EXPECT_TRUE(exists(std::string("s.cdb/") + file)) << file;
  // The folder has files of earlier sweeps of other methods and sizes, and files not of neve.
  const std::vector<std::string> old{"effects.csv",     "effects.svg",  "points.csv",
                                     "sheet_2.png",     "strips_2.png", "sheet.mp4",
                                     "sheet_2/0000.png"},
      others{"sheet_final.png", "sheet/notes.txt", "strips.txt", "review/mine.png"};
  for (const std::vector<std::string>* list : {&old, &others})
    for (const std::string& file : *list) folder.write("s.cdb/" + file, "x");
  words[5] = "3-3";
  words.pop_back();
  ASSERT_EQ(neve(words).exit_code, 0);
  for (const std::string& file : old) EXPECT_FALSE(exists("s.cdb/" + file)) << file;
  for (const std::string& file : others) EXPECT_TRUE(exists("s.cdb/" + file)) << file;
  for (const char* file : {"strips.png", "sheet/0000.png", "review/run_0000.0000.png", "sheet_2"})
    EXPECT_FALSE(exists(std::string("s.cdb/") + file)) << file;
  EXPECT_TRUE(exists("s.cdb/sheet/0003.png"));
  EXPECT_TRUE(exists("s.cdb/sheet.png"));
  EXPECT_TRUE(exists("s.cdb/review/run_0000.0003.png")) << "links are kept up to date";
}

/// A task of Slurm on a node with another program would write under the keys of this one.
TEST_F(SweepCli, ARunOfASweepThatAnotherBuildHasPlannedIsRefused) {
  folder.write("scene.toml", tiny_scene);
  ASSERT_EQ(neve({"sweep", "scene.toml", "-p", "material.snow.hardening=5,7", "--frames", "1",
                  "--quiet", "--out", "s.cdb"})
                .exit_code,
            0);
  EXPECT_EQ(neve({"sweep", "run", "s.cdb", "--index", "1"}).exit_code, 0);
  app::Json manifest = json_of("s.cdb/manifest.json");
  manifest["sources"] = "0123456789abcdef";
  manifest.erase("hash");
  folder.write("s.cdb/manifest.json", app::record::with_own_hash(manifest));
  const auto refused = neve({"sweep", "run", "s.cdb", "--index", "1"});
  EXPECT_EQ(refused.exit_code, 8) << refused.errors;
  EXPECT_TRUE(contains(refused.errors, "another build of neve has planned this sweep"))
      << refused.errors;
}

TEST_F(SweepCli, AllRunsAreSeenAlike) {
  folder.write("scene.toml", std::string(tiny_scene) +
                                 "[[view]]\nname = \"cut\"\nlayers = [\"heatmap\"]\n"
                                 "slice = { normal = [1, 0, 0] }\n");
  folder.write("look.toml", std::string(small_sweep) +
                                "[set]\n\"view.particles.particles.color_by\" = \"speed\"\n");
  ASSERT_EQ(neve({"sweep", "look.toml", "--frames", "0"}).exit_code, 0);
  const auto line = [&](const std::string& run, const std::string& start) {
    const std::string text = read_text(folder / ("out/look.cdb/runs/" + run + "/scene.toml"));
    const auto from = text.find(start);
    return text.substr(from, text.find('\n', from) - from);
  };
  EXPECT_TRUE(contains(line("0000", "eye = "), "[")) << "no camera";
  for (const char* run : {"0001", "0002", "0003"})
    for (const char* start : {"eye = ", "target = ", "particles = "})
      EXPECT_EQ(line("0000", start), line(run, start)) << run;
  EXPECT_FALSE(contains(line("0000", "particles = "), "auto"));
  const app::Json run = json_of("out/look.cdb/runs/0000/run.json");
  EXPECT_TRUE(contains(run.value("undrawn", ""), "name = \"cut\"")) << "views are known by name";
  EXPECT_FALSE(exists("out/look.cdb/runs/0000/cut"));
}

TEST_F(SweepCli, FailuresBecomeAStateAndAReason) {
  folder.write("troubled.toml", troubled_sweep);
  app::output::ProcessResult result;
  {
    const Saboteur saboteur(folder / "out/troubled.cdb/runs",
                            {{"0004", SIGSEGV}, {"0005", SIGSTOP}});
    result = neve({"sweep", "troubled.toml", "--jobs", "3"});
  }
  EXPECT_EQ(result.exit_code, 7) << result.errors;
  const char* const expected[] = {"ok", "ok", "diverged", "out_of_memory", "crashed", "timeout"};
  for (int k = 0; k < 6; ++k)
    EXPECT_EQ(status("000" + std::to_string(k), "out/troubled.cdb")["state"], expected[k]) << k;
  EXPECT_EQ(status("0004", "out/troubled.cdb")["signal"], SIGSEGV);
  EXPECT_TRUE(contains(result.errors, "DIVERGED frame 0: ")) << result.errors;
  EXPECT_TRUE(contains(result.errors, "CRASHED signal 11")) << result.errors;
  EXPECT_TRUE(contains(result.errors, "TIMEOUT after 15 s")) << result.errors;
  EXPECT_TRUE(contains(result.errors, "OUT OF MEMORY needs")) << result.errors;
  // The same again: they stay as they are.
  const auto again = neve({"sweep", "troubled.toml", "--json"});
  EXPECT_EQ(again.exit_code, 7);
  const app::Json counts = app::parse_json(std::string_view(again.output));
  EXPECT_EQ(counts["started"], 0);
  EXPECT_EQ(counts["failed"], 4);
}

TEST_F(SweepCli, ShardsAndSelectionsShareTheWork) {
  const auto started = [&](const std::vector<std::string>& which) {
    std::vector<std::string> words{"sweep", "sweep.toml", "--json"};
    words.insert(words.end(), which.begin(), which.end());
    const auto result = neve(words);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return app::parse_json(std::string_view(result.output))["started"].get<int>();
  };
  EXPECT_EQ(started({"--only", "0,2-3", "--shard", "1/2"}), 2);
  EXPECT_EQ(status("0000")["state"], "ok");
  EXPECT_EQ(status("0001")["state"], "pending");
  EXPECT_EQ(status("0002")["state"], "ok");
  EXPECT_TRUE(contains(read_text(folder / "out/sweep.cdb/report.html"), "2 not finished"));
  EXPECT_EQ(started({"--shard", "2/2"}), 2);
  EXPECT_EQ(started({}), 0);
  EXPECT_EQ(neve({"sweep", "sweep.toml", "--shard", "3/2"}).exit_code, 2);
  EXPECT_EQ(neve({"sweep", "sweep.toml", "--only", "4"}).exit_code, 2);
  EXPECT_EQ(neve({"sweep", "sweep.toml", "--engine", "pbs"}).exit_code, 2);
}

TEST_F(SweepCli, EmittedCommandsMakeTheSweepAnywhere) {
  const auto emitted = neve({"sweep", "sweep.toml", "--emit", "commands.txt"});
  ASSERT_EQ(emitted.exit_code, 0) << emitted.errors;
  EXPECT_TRUE(contains(emitted.errors, "4 commands in commands.txt")) << emitted.errors;
  EXPECT_EQ(status("0003")["state"], "pending");
  // The commands run in another folder: nothing in them is relative.
  const auto made = app::output::run_process(
      "/bin/sh", {"-c", "cd / && sh -e \"$0\"", (folder / "commands.txt").string()}, folder.path());
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  for (const char* run : {"0000", "0001", "0002", "0003"}) EXPECT_EQ(status(run)["state"], "ok");
  ASSERT_EQ(neve({"sweep", "collect", "out/sweep.cdb"}).exit_code, 0);
  EXPECT_TRUE(exists("out/sweep.cdb/report.html"));
  ASSERT_EQ(neve({"sweep", "sweep.toml", "--emit", "commands.txt"}).exit_code, 0);
  EXPECT_EQ(read_text(folder / "commands.txt"), "") << "nothing is left to do";
  // A damaged run is to be made again, here as by Slurm.
  std::filesystem::resize_file(folder / "out/sweep.cdb/runs/0001/run.json", 100);
  ASSERT_EQ(neve({"sweep", "sweep.toml", "--emit", "commands.txt"}).exit_code, 0);
  EXPECT_TRUE(contains(read_text(folder / "commands.txt"), "--index 1"));
}

TEST_F(SweepCli, EmittedCommandsDrawAsTheSweepWasAskedTo) {
  const auto emitted =
      neve({"sweep", "sweep.toml", "--emit", "commands.txt", "--backend", "osmesa"});
  ASSERT_EQ(emitted.exit_code, 0) << emitted.errors;
  EXPECT_TRUE(contains(read_text(folder / "commands.txt"), " --backend osmesa"));
}

TEST_F(SweepCli, ABudgetStopsTheSweepResumable) {
  // The first two values are at rest after a moment, the others take a million steps.
  folder.write("long.toml",
               "[sweep]\nscene = \"scene.toml\"\nframes = \"0-2\"\n[axis]\n"
               "\"solver.max_dt\" = [1e-3, 1e-7, 1.1e-7, 1.2e-7]\n");
  const auto result = neve({"sweep", "long.toml", "--budget", "4s", "--jobs", "1", "--json"});
  EXPECT_EQ(result.exit_code, 75) << result.errors;
  const app::Json counts = app::parse_json(std::string_view(result.output));
  EXPECT_EQ(counts["ok"], 1);
  EXPECT_EQ(counts["failed"], 0);
  EXPECT_EQ(counts["out_of_time"], 3);
  EXPECT_LT(counts["seconds"].get<double>(), 20) << "a run that is asked to end has 20 s for it";
  EXPECT_TRUE(contains(result.errors, "the budget of 4 s was too short for 3 runs"))
      << result.errors;
  EXPECT_TRUE(exists("out/long.cdb/sheet.png")) << "what there is can be looked at";
  EXPECT_NE(status("0001", "out/long.cdb")["state"], "failed");
  for (const char* wrong : {"0", "-5", "soon", "1e400"}) {
    const auto refused = neve({"sweep", "long.toml", "--budget", wrong});
    EXPECT_EQ(refused.exit_code, 2) << wrong;
    EXPECT_TRUE(contains(refused.errors, "expected a time as in 90s, 20m or 1h30m"));
  }
  EXPECT_EQ(neve({"sweep", "long.toml", "--budget", "9m", "--engine", "slurm"}).exit_code, 2);
}

TEST_F(SweepCli, SweepsAndRunsAreKeptOutOfEachOthersFolders) {
  ASSERT_EQ(neve({"sweep", "sweep.toml", "--frames", "0", "--out", "s"}).exit_code, 0);
  ASSERT_EQ(neve({"render", "scene.toml", "--frames", "0", "--out", "r"}).exit_code, 0);
  const auto run = neve({"render", "scene.toml", "--frames", "0", "--out", "s"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(contains(run.errors, "is the folder of a sweep")) << run.errors;
  EXPECT_FALSE(exists("s/run.json"));
  const auto sweep = neve({"sweep", "sweep.toml", "--frames", "0", "--out", "r"});
  EXPECT_EQ(sweep.exit_code, 2);
  EXPECT_TRUE(contains(sweep.errors, "is the folder of a run")) << sweep.errors;
  EXPECT_FALSE(exists("r/manifest.json"));
}

TEST_F(SweepCli, InterruptedSweepsContinue) {
  // A million steps: nobody waits for them.
  const char* const endless = R"(
[sweep]
scene = "scene.toml"
[axis]
"solver.max_dt" = [1e-6, 1.1e-6, 1.2e-6]
)";
  folder.write("endless.toml", endless);
  const std::string script =
      "\"$0\" sweep endless.toml & pid=$!\n"
      "for run in 0000 0002; do until [ -e out/endless.cdb/runs/$run/particles/0000.png ]; do "
      "sleep 0.05; done; done\n"
      "kill -INT $pid; wait $pid; echo code $?\n";
  const auto result =
      app::output::run_process("/bin/bash", {"-c", script, NEVE_BINARY}, folder.path());
  EXPECT_TRUE(contains(result.output, "code 75")) << result.output << result.errors;
  EXPECT_TRUE(contains(result.errors, "the same command continues")) << result.errors;
  for (const char* run : {"0000", "0002"}) {
    EXPECT_EQ(status(run, "out/endless.cdb")["state"], "interrupted");
    EXPECT_TRUE(exists("out/endless.cdb/runs/" + std::string(run) + "/checkpoint")) << run;
  }
}

}  // namespace
}  // namespace neve::test
