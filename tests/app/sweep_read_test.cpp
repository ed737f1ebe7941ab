/// Sweep files: what they mean, and where their mistakes are.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "app/cli/commands.h"
#include "app/scene/toml/error.h"
#include "app/support/errors.h"
#include "app/sweep/plan/expand.h"
#include "app/sweep/plan/labels.h"
#include "app/sweep/plan/sweep_plan.h"
#include "app/sweep/read/read_sweep.h"
#include "app/sweep/read/sweep_leaf.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

const char* const swept_scene = R"(
[solver]
cell_size = 0.04
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.12, 0], radius = 0.08 } }
)";

class SweepFileTest : public testing::Test {
 protected:
  SweepFileTest() { folder_.write("scene.toml", swept_scene); }

  app::sweep::read::Sweep read(const std::string& text,
                               const app::sweep::read::SweepChanges& changes = {}) {
    folder_.write("sweep.toml", text);
    return app::sweep::read::read_sweep((folder_ / "sweep.toml").string(), changes);
  }

  std::vector<app::sweep::Run> runs(const std::string& text) {
    return app::sweep::plan::expand(read(text));
  }

  /// "LINE:COLUMN MESSAGE; HINT" of the complaint about a sweep file and its scenes.
  std::string complaint(const std::string& text) {
    folder_.write("sweep.toml", text);
    app::sweep::plan::SweepOptions options;
    options.file = (folder_ / "sweep.toml").string();
    try {
      app::sweep::plan::plan_sweep(options);
    } catch (const app::scene::toml::SceneError& error) {
      EXPECT_EQ(error.file, options.file);
      return std::to_string(error.line) + ":" + std::to_string(error.column) + " " + error.message +
             (error.hint.empty() ? "" : "; " + error.hint);
    }
    return "";
  }

  test::TemporaryFolder folder_;
};

const std::string head = "[sweep]\nscene = \"scene.toml\"\n";

std::vector<std::string> values(const app::sweep::Run& run) {
  std::vector<std::string> list;
  for (const app::scene::Override& setting : run.settings) list.push_back(setting.value);
  return list;
}

using Strings = std::vector<std::string>;

TEST_F(SweepFileTest, GridsCombineAllAxesAndTheLastVariesFastest) {
  const auto list = runs(head + "[axis]\n\"seed\" = [1, 2]\n\"fps\" = [24, 30, 60]\n");
  ASSERT_EQ(list.size(), 6u);
  EXPECT_EQ(values(list[0]), (Strings{"1", "24"}));
  EXPECT_EQ(values(list[1]), (Strings{"1", "30"}));
  EXPECT_EQ(values(list[5]), (Strings{"2", "60"}));
  EXPECT_EQ(list[4].coordinates, (std::vector<int>{1, 1}));
}

TEST_F(SweepFileTest, NoValueOfTheCommandLineIsLost) {
  const app::sweep::read::SweepChanges twice{{"seed=1,2", "fps=24,30", "seed=3"}, {}};
  EXPECT_THROW(read(head + "[axis]\n\"seed\" = [1]\n", twice), app::UsageError);
  const app::sweep::read::Sweep sweep =
      read(head + "[axis]\n\"fps\" = [24, 30, 24]\n", {{"seed=1,2,1"}, {}});
  EXPECT_EQ(app::sweep::read::repeated_values(sweep), (Strings{"fps = 24", "seed = 1"}));
}

TEST_F(SweepFileTest, ZipGoesAlongAllAxesAtOnce) {
  const auto list =
      runs(head + "method = \"zip\"\n[axis]\n\"seed\" = [1, 2]\n\"fps\" = [24, 30]\n");
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(values(list[1]), (Strings{"2", "30"}));
}

TEST_F(SweepFileTest, LinkedAxesCountAsOne) {
  const auto list = runs(head +
                         "[axis]\n\"seed\" = [1, 2]\n[[link]]\nlabels = [\"soft\", \"hard\"]\n"
                         "\"material.snow.critical_compression\" = [0.019, 0.025]\n"
                         "\"material.snow.critical_stretch\" = [0.005, 0.0075]\n");
  ASSERT_EQ(list.size(), 4u);
  EXPECT_EQ(values(list[1]), (Strings{"1", "0.025", "0.0075"}));
  EXPECT_EQ(list[1].label, "hard");
}

TEST_F(SweepFileTest, ExplicitRunsFollowTheAxes) {
  const auto list =
      runs(head + "[axis]\n\"seed\" = [1, 2]\n[[run]]\nlabel = \"other\"\nfps = 12\n");
  ASSERT_EQ(list.size(), 3u);
  EXPECT_EQ(list[2].label, "other");
  EXPECT_EQ(values(list[2]), (Strings{"12"}));
  EXPECT_TRUE(list[2].coordinates.empty());
}

TEST_F(SweepFileTest, RulesMakeRoundValuesWithBothEnds) {
  const auto list = runs(head +
                         "method = \"zip\"\n[axis]\n"
                         "\"solver.cfl\" = { linspace = [0.1, 0.4], num = 4 }\n"
                         "\"material.snow.youngs_modulus\" = { logspace = [1e3, 1e6], num = 4 }\n"
                         "\"seed\" = { range = [1, 10, 3] }\n");
  ASSERT_EQ(list.size(), 4u);
  EXPECT_EQ(values(list[2]), (Strings{"0.3", "100000", "7"}));
  EXPECT_EQ(values(list[3]), (Strings{"0.4", "1000000", "10"}));
}

TEST_F(SweepFileTest, KeysNeedNoQuotes) {
  const auto list = runs(head +
                         "[axis]\nmaterial.snow.hardening = [5, 10]\n"
                         "body.ball.velocity = [[0, -1, 0], [0, -2, 0], [0, -3, 0]]\n");
  ASSERT_EQ(list.size(), 6u);
  EXPECT_EQ(list[0].settings[1].address, "body.ball.velocity");
  EXPECT_EQ(list[5].settings[1].value, "[0, -3, 0]");
  // Parameters and things with the name of a rule.
  const auto slices =
      read(head +
           "[set]\nview.cut.particles.range = [0, 2]\nmaterial.normal.hardening = 7\n"
           "[axis]\nview.cut.slice.normal = [[1, 0, 0], [0, 1, 0]]\n"
           "material.label.hardening = { linspace = [1, 2], num = 3 }\n"
           "[[run]]\nview.cut.slice.normal = [0, 0, 1]\n");
  ASSERT_EQ(slices.fixed.size(), 2u);
  EXPECT_EQ(slices.fixed[0].address, "view.cut.particles.range");
  EXPECT_EQ(slices.fixed[1].address, "material.normal.hardening");
  ASSERT_EQ(slices.axes.size(), 2u);
  EXPECT_EQ(slices.axes[0].parameters[0].address, "view.cut.slice.normal");
  EXPECT_EQ(slices.axes[0].size(), 2u);
  EXPECT_EQ(slices.axes[1].parameters[0].address, "material.label.hardening");
  EXPECT_EQ(slices.axes[1].size(), 3u);
  EXPECT_EQ(slices.rows[0].settings[0].address, "view.cut.slice.normal");
}

TEST_F(SweepFileTest, LatinHypercubesMeetEveryPartOfEveryAxisOnce) {
  const auto list = runs(head +
                         "method = \"lhs\"\nsamples = 20\nseed = 3\n[axis]\n"
                         "\"solver.cfl\" = { uniform = [0, 2] }\n"
                         "\"solver.flip_ratio\" = { uniform = [0, 1] }\n"
                         "\"solver.transfer\" = [\"flip\", \"apic\"]\n");
  ASSERT_EQ(list.size(), 20u);
  std::set<int> first, second;
  int flips = 0;
  for (const app::sweep::Run& run : list) {
    first.insert(static_cast<int>(std::stod(run.settings[0].value) * 10));
    second.insert(static_cast<int>(std::stod(run.settings[1].value) * 20));
    flips += run.settings[2].value == "\"flip\"";
  }
  EXPECT_EQ(first.size(), 20u);
  EXPECT_EQ(second.size(), 20u);
  EXPECT_EQ(flips, 10);
}

/// With four samples of three entries, places at random left one of them out for every ninth seed.
TEST_F(SweepFileTest, LatinHypercubesMeetEveryEntryOfAListEquallyOften) {
  for (int seed = 1; seed <= 20; ++seed) {
    std::map<std::string, int> counts;
    for (const app::sweep::Run& run :
         runs(head + "method = \"lhs\"\nsamples = 4\nseed = " + std::to_string(seed) +
              "\n[axis]\n\"solver.transfer\" = [\"flip\", \"apic\", \"mls\"]\n"))
      ++counts[run.settings[0].value];
    EXPECT_EQ(counts.size(), 3u) << "seed " << seed;
  }
}

TEST_F(SweepFileTest, DrawnValuesDependOnTheSeedAlone) {
  const std::string text =
      "method = \"random\"\nsamples = 4\n[axis]\n\"solver.cfl\" = { normal = [0.4, 0.01] }\n";
  const auto a = runs(head + "seed = 1\n" + text), b = runs(head + "seed = 1\n" + text),
             c = runs(head + "seed = 2\n" + text);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(values(a[k]), values(b[k]));
    EXPECT_NE(values(a[k]), values(c[k]));
    // Seven standard deviations: never.
    EXPECT_NEAR(std::stod(values(a[k])[0]), 0.4, 0.07);
  }
}

TEST(SweepQuantile, QuantilesInvertTheNormalDistribution) {
  // Tables of the normal distribution, five digits.
  EXPECT_NEAR(app::sweep::plan::normal_quantile(0.5), 0, 1e-12);
  EXPECT_NEAR(app::sweep::plan::normal_quantile(0.975), 1.95996, 1e-5);
  EXPECT_NEAR(app::sweep::plan::normal_quantile(0.00135), -2.99998, 1e-4);
}

TEST_F(SweepFileTest, WholeNumbersAreDrawnWhole) {
  for (const app::sweep::Run& run :
       runs(head + "method = \"lhs\"\nsamples = 5\n[axis]\n\"seed\" = { uniform = [1, 99] }\n"))
    EXPECT_EQ(run.settings[0].value.find('.'), std::string::npos) << run.settings[0].value;
}

TEST_F(SweepFileTest, CommandLineAxesReplaceThoseOfTheFile) {
  const app::sweep::read::SweepChanges changes{
      {"seed=5,6,7", "fps={ linspace = [10, 20], num = 2 }"}, {}};
  const auto list = app::sweep::plan::expand(read(head + "[axis]\n\"seed\" = [1, 2]\n", changes));
  ASSERT_EQ(list.size(), 6u);
  EXPECT_EQ(values(list[5]), (Strings{"7", "20"}));
}

TEST_F(SweepFileTest, ScenesAreVariedFromTheCommandLine) {
  const auto file = (folder_ / "scene.toml").string();
  const auto list = app::sweep::plan::expand(app::sweep::read::read_sweep(
      file, {{"body.ball.velocity=[0,-1,0],[0,-2,0]", "solver.transfer=flip,apic"}, {}}));
  ASSERT_EQ(list.size(), 4u);
  EXPECT_EQ(values(list[3]), (Strings{"[0, -2, 0]", "apic"}));
  const auto titled = app::sweep::plan::expand(
      app::sweep::read::read_sweep(file, {{R"(title="a \"b, c\" d",'e\',plain)"}, {}}));
  ASSERT_EQ(titled.size(), 3u);
  EXPECT_EQ(values(titled[0]), (Strings{R"("a \"b, c\" d")"}));
  EXPECT_THROW(app::sweep::read::read_sweep(file, {}), app::UsageError);
  EXPECT_THROW(app::sweep::read::read_sweep(file, {{"seed"}, {}}), app::UsageError);
  EXPECT_THROW(app::sweep::read::read_sweep(file, {{"seed=1,,2"}, {}}), app::UsageError);
  EXPECT_THROW(app::sweep::read::read_sweep(file, {{"seed={ linspce = [1, 2] }"}, {}}),
               app::UsageError);
  EXPECT_THROW(app::sweep::read::read_sweep(file, {{"seed=1,2"}, {"seed=3"}}), app::UsageError);
}

TEST_F(SweepFileTest, MistakesAreLocatedAndNearestNamesGiven) {
  const struct {
    const char *text, *complaint;
  } cases[] = {
      {"[axis]\n\"material.snow.poisson_ratio\" = [0.2, 0.62]\n",
       "4:39 material.snow.poisson_ratio = 0.62; expected 0 <= value < 0.5"},
      {"[axis]\n\"material.snow.hardning\" = [1]\n",
       "4:1 unknown parameter \"material.snow.hardning\"; did you mean "
       "\"material.snow.hardening\"?"},
      {"[axis]\n\"body.bull.velocity\" = [[0, 0, 0]]\n",
       "4:1 there is no body \"bull\"; did you mean \"ball\"?"},
      {"[axis]\n\"solver.transfer\" = [\"flip\", \"apix\"]\n",
       "4:30 solver.transfer = \"apix\"; expected \"flip\", \"apic\", \"mls\", \"aflip\" or "
       "\"asflip\"; did you mean \"apic\"?"},
      {"[axis]\n\"seed\" = { linspce = [1, 2], num = 2 }\n",
       "4:12 unknown key \"linspce\" in [seed]; did you mean \"linspace\"?"},
      {"method = \"zip\"\n[axis]\n\"fps\" = [24, 25]\n[sheet]\ncolumns = \"fps\"\n",
       "7:11 sheet.columns is not for method \"zip\", whose runs lie along no axis; remove it; "
       "only "
       "a grid has columns and rows"},
      {"[axis]\n\"fps\" = { linspace = [1, 2] }\n",
       "4:9 num is missing; linspace and logspace need the number of values, as num = 4"},
      {"[axis]\n\"seed\" = 3\n",
       "4:10 seed = 3; expected a list of values, as in [5, 10], or a table such as { linspace = "
       "[1, 2], num = 3 }; put constant values into [set]"},
      {"[axis]\n\"fps\" = []\n", "4:9 fps has no values"},
      {"[axis]\n\"seed\" = { range = [1, 100001] }\n",
       "4:10 seed has too many values; at most 100000"},
      {"method = \"gird\"\n",
       "3:10 sweep.method = \"gird\"; expected \"grid\", \"zip\", \"random\", \"lhs\", \"sobol\", "
       "\"morris\" or \"list\"; "
       "did you mean \"grid\"?"},
      {"sample = 3\n", "3:1 unknown key \"sample\" in [sweep]; did you mean \"samples\"?"},
      {"frames = \"9-1\"\n",
       "3:10 sweep.frames: cannot use \"9-1\"; expected A-B with A <= B <= 2000000, or N for "
       "all frames up to N"},
      {"method = \"lhs\"\n[axis]\n\"fps\" = [1]\n",
       "3:10 method \"lhs\" needs samples; give the number of runs to draw"},
      {"[axis]\n\"fps\" = { uniform = [1, 2] }\n",
       "4:9 fps is drawn; that needs method \"random\", \"lhs\", \"sobol\" or \"morris\""},
      {"method = \"zip\"\n[axis]\n\"fps\" = [1, 2]\n\"seed\" = [1]\n",
       "6:11 seed has 1 values, and fps has 2; method \"zip\" needs the same number on all axes, "
       "\"grid\" makes all combinations"},
      {"[[link]]\n\"fps\" = [1, 2]\n\"seed\" = [1]\n",
       "5:10 seed has 1 values, and fps of the same [[link]] has 2; linked axes must have the same "
       "number"},
      {"[set]\n\"fps\" = 12\n[axis]\n\"fps\" = [1, 2]\n",
       "4:1 fps is varied by the sweep; remove it from the axes, or change the axis with -p"},
      {"[limits]\ntimeout = \"20 fortnights\"\n",
       "4:11 limits.timeout = \"20 fortnights\"; expected seconds, or a time such as \"90s\", "
       "\"20m\" or \"1h30m\""},
      {"[sheet]\nview = \"smok\"\n[axis]\n\"fps\" = [1]\n",
       "4:8 sheet.view = \"smok\": the scene has no such view; expected \"snow\", "
       "\"particles\", \"smoke\" or \"slice\"; did you mean \"smoke\"?"},
      {"[set]\n\"solver.cell_size\" = -1\n[axis]\n\"fps\" = [1]\n",
       "4:22 solver.cell_size = -1; expected 1e-9 <= value <= 1000000"}};
  for (const auto& c : cases) EXPECT_EQ(complaint(head + c.text), c.complaint) << c.text;
}

TEST_F(SweepFileTest, TheCameraOfASheetIsExplainedAsThatOfAScene) {
  const std::string sheet_camera =
      "framing = \"sheet\", \"fall\" or \"each\" says what the camera holds; a place is of the "
      "scene: \"camera.eye\" = [0, 1, 3], \"camera.target\" = [0, 0, 0] or \"camera.orbit\" = 30 "
      "in [set]";
  const std::pair<std::string, std::string> cases[] = {
      {"[sheet]\nframing = \"eech\"\n[axis]\n\"fps\" = [1]\n",
       "4:11 sheet.framing = \"eech\"; expected \"sheet\", \"fall\" or \"each\"; did you mean "
       "\"each\"?"},
      {"[sheet]\ncamera = { eye = [0, 1] }\n",
       "4:1 unknown key \"camera\" in [sheet]; " + sheet_camera},
      {"[sheet.camra]\norbit = 3\n", "3:8 unknown key \"camra\" in [sheet]; " + sheet_camera},
      {"[sheet]\norbit = 3\n", "4:1 unknown key \"orbit\" in [sheet]; " + sheet_camera},
      {"[set]\ncamera = { orbit = \"left\" }\n[axis]\n\"fps\" = [1]\n",
       "4:20 camera.orbit = \"left\"; expected a number"},
      {"[set.camera]\nobrit = 30\n[axis]\n\"fps\" = [1]\n",
       "4:1 unknown parameter \"camera.obrit\"; did you mean \"camera.orbit\"?"},
      {"[camera]\norbit = 3\n",
       "3:2 unknown key \"camera\"; parameters of the scene belong in "
       "[set], as in \"camera.eye\" = ..."},
      {"[sheet]\nhardening = 3\n",
       "4:1 unknown key \"hardening\" in [sheet]; parameters of the "
       "scene belong in [set], as in \"material.NAME.hardening\" = ..."}};
  for (const auto& [text, wanted] : cases) EXPECT_EQ(complaint(head + text), wanted) << text;
}

TEST_F(SweepFileTest, FramesAreGivenForAllRunsOrVaried) {
  EXPECT_EQ(complaint(head + "frames = \"0-2\"\n[axis]\n\"frames\" = [1, 2]\n"),
            "3:10 sweep.frames is for all runs, and the sweep varies frames; remove one of them");
  EXPECT_EQ(complaint(head + "frames = \"0-2\"\n[[run]]\nframes = 1\n"),
            "3:10 sweep.frames is for all runs, and the sweep varies frames; remove one of them");
  app::sweep::plan::SweepOptions options;
  options.file = (folder_ / "scene.toml").string();
  options.axes = {"frames=1,2"};
  const app::sweep::plan::SweepPlan plan = app::sweep::plan::plan_sweep(options);
  EXPECT_EQ(plan.runs[1].run.frames.last, 2);
  options.frames = app::setup::FrameRange{0, 3};
  EXPECT_THROW(app::sweep::plan::plan_sweep(options), app::UsageError);
}

TEST_F(SweepFileTest, RunsNeedTheMemoryOfTheirProcess) {
  app::sweep::plan::SweepOptions options;
  options.file = (folder_ / "scene.toml").string();
  options.axes = {"seed=1"};
  const app::sweep::plan::PlannedRun run = app::sweep::plan::plan_sweep(options).runs[0];
  EXPECT_EQ(run.run.memory,
            static_cast<double>(run.plan.memory + app::sweep::plan::program_memory));
  EXPECT_GT(run.run.memory, 80e6);
}

TEST_F(SweepFileTest, NumbersOfTheCommandLineAreWrittenAsThoseOfFiles) {
  const auto values_of = [&](const std::string& axis) {
    std::vector<std::string> list;
    for (const app::sweep::Run& run : app::sweep::plan::expand(
             app::sweep::read::read_sweep((folder_ / "scene.toml").string(), {{axis}, {}})))
      list.push_back(values(run).front());
    return list;
  };
  EXPECT_EQ(values_of("material.snow.youngs_modulus=48_000, 1e5"), (Strings{"48000", "100000"}));
  EXPECT_EQ(values_of("seed=5, 10 ,+7"), (Strings{"5", "10", "7"}));
  EXPECT_EQ(values_of("body.ball.velocity=[0,-1_0,0], [0, -2.50, 0]"),
            (Strings{"[0, -10, 0]", "[0, -2.5, 0]"}));
  EXPECT_EQ(values_of("solver.transfer=flip, apic"), (Strings{"flip", "apic"}));
  EXPECT_EQ(values_of("title=1.10, b"), (Strings{"\"1.10\"", "b"})) << "texts stay as they are";
}

TEST_F(SweepFileTest, RangesOfOtherProgramsAndComponentsAreExplained) {
  const auto hint = [&](const std::string& axis) -> std::string {
    try {
      app::sweep::read::read_sweep((folder_ / "scene.toml").string(), {{axis}, {}});
    } catch (const app::UsageError& error) {
      return error.hint;
    }
    return "";
  };
  // The hint repeats the ends that were typed.
  for (const char* range : {"2.5:1e2:3", "linspace(2.5,1e2,3)", "range(2.5,1e2)", "2.5..1e2"})
    EXPECT_TRUE(hint("material.snow.hardening=" + std::string(range))
                    .starts_with("for a range write { linspace = [2.5, 1e2], num = 3 }"))
        << range << ": " << hint("material.snow.hardening=" + std::string(range));
  EXPECT_TRUE(hint("seed=3..9").starts_with("for a range write { range = [3, 9] }"));
  for (const char* component : {".y", ".1", "[1]"})
    EXPECT_EQ(hint("body.ball.velocity" + std::string(component) + "=1,2"),
              "write whole vectors, as in -p body.ball.velocity=[0,-1,0],[0,-2,0]")
        << component;
  EXPECT_EQ(hint("title=1:2,3"), "");
}

TEST_F(SweepFileTest, MissingScenesAreNamedWithThePlaceLookedAt) {
  const std::string text = complaint("[sweep]\nscene = \"no.toml\"\n");
  EXPECT_TRUE(text.starts_with("2:9 sweep.scene = \"no.toml\"; no such file; looked for /"))
      << text;
}

TEST_F(SweepFileTest, TooManyRunsAreRefusedBeforeTheyAreMade) {
  std::string text = head + "[axis]\n";
  for (const char* address : {"seed", "fps", "solver.cfl", "solver.max_dt", "solver.dt"})
    text += "\"" + std::string(address) + "\" = { linspace = [0.1, 0.2], num = 9999 }\n";
  try {
    runs(text);
    ADD_FAILURE() << "not refused";
  } catch (const LimitError& error) {
    // A larger limits.runs would be refused, too.
    EXPECT_NE(std::string(error.what()).find("more than the 100000 of the largest sweep; use"),
              std::string::npos)
        << error.what();
  }
}

TEST(SweepDuration, DurationsAreReadWithUnits) {
  EXPECT_EQ(app::sweep::read::seconds_of("90"), 90);
  EXPECT_EQ(app::sweep::read::seconds_of("20m"), 1200);
  EXPECT_EQ(app::sweep::read::seconds_of("1h30m"), 5400);
  EXPECT_EQ(app::sweep::read::seconds_of("1.5s"), 1.5);
  for (const char* wrong : {"", "m", "20 m", "-3s", "1x", "nan", "inf"})
    EXPECT_FALSE(app::sweep::read::seconds_of(wrong)) << wrong;
}

TEST(SweepLabels, LabelsHaveTheFewestWordsThatDiffer) {
  EXPECT_EQ(app::sweep::plan::short_names({"material.snow.hardening", "seed"}),
            (Strings{"hardening", "seed"}));
  EXPECT_EQ(app::sweep::plan::short_names({"material.snow.hardening", "material.ice.hardening"}),
            (Strings{"snow.hardening", "ice.hardening"}));
  EXPECT_EQ(app::sweep::plan::value_text("0.10000000000000001"), "0.1");
  EXPECT_EQ(app::sweep::plan::value_text("48000"), "48000");
  EXPECT_EQ(app::sweep::plan::value_text("140000"), "1.4e5");
  EXPECT_EQ(app::sweep::plan::value_text("-1000000"), "-1e6");
  // These values stay in full, so that runs that differ have different names.
  EXPECT_EQ(app::sweep::plan::value_text("20240101"), "20240101");
  EXPECT_EQ(app::sweep::plan::value_text("1400001"), "1400001");
  EXPECT_EQ(app::sweep::plan::value_text("400.0001"), "400.0001");
  EXPECT_EQ(app::sweep::plan::value_text("0.31622776601683794"), "0.316228");
  EXPECT_EQ(app::sweep::plan::value_text("\"flip\""), "flip");
  EXPECT_EQ(app::sweep::plan::value_text(R"("a \"b, c\" d")"), R"(a "b, c" d)");
  EXPECT_EQ(app::sweep::plan::value_text("'it is'"), "it is");
  EXPECT_EQ(app::sweep::plan::value_text("\"open"), "\"open");
  EXPECT_EQ(app::sweep::plan::value_text("[0, -5, 0]"), "[0, -5, 0]");
}

TEST_F(SweepFileTest, SeedsMakeSeveralRunsOfEachPointFromTheSeedOfTheScene) {
  folder_.write("sweep.toml",
                "[sweep]\nscene = \"scene.toml\"\nseeds = 3\n[set]\nseed = 7\n[axis]\n"
                "\"material.snow.hardening\" = [5, 10]\n");
  app::sweep::plan::SweepOptions options;
  options.file = (folder_ / "sweep.toml").string();
  const auto seeds_of = [&] {
    std::string text;
    for (const auto& item : app::sweep::plan::plan_sweep(options).runs)
      text +=
          item.run.setting("material.snow.hardening") + ":" + std::to_string(item.scene.seed) + " ";
    return text;
  };
  EXPECT_EQ(seeds_of(), "5:7 5:8 5:9 10:7 10:8 10:9 ");
  options.seeds = 2;  // the command line rules
  EXPECT_EQ(seeds_of(), "5:7 5:8 10:7 10:8 ");
}

TEST_F(SweepFileTest, SeedsThatSayNothingOrSaySomethingTwiceAreRefused) {
  const std::string head = "[sweep]\nscene = \"scene.toml\"\n";
  const std::string axis = "[axis]\n\"material.snow.hardening\" = [5, 10]\n";
  for (const char* number : {"0", "1", "101", "-4", "2.5"})
    EXPECT_NE(complaint(head + "seeds = " + number + "\n" + axis).find("sweep.seeds"),
              std::string::npos)
        << number;
  EXPECT_EQ(
      complaint(head + "seeds = 4\n[axis]\nseed = [1, 2]\n"),
      "5:1 the sweep varies seed, and seeds = 4 does so too; remove the axis: each point has 4 "
      "seeds without it");
  EXPECT_NE(complaint(head + "seeds = 4\nmethod = \"list\"\n[[run]]\nseed = 3\n")
                .find("a run has a seed of its own"),
            std::string::npos);
  const std::string many = "[axis]\n\"solver.cfl\" = { linspace = [0.1, 0.4], num = 300 }\n";
  try {
    runs(head + "seeds = 4\n" + many);
    ADD_FAILURE();
  } catch (const LimitError& error) {
    EXPECT_NE(std::string(error.what()).find("1200 runs, 4 of each point"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace neve::app
