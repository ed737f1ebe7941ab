/// Predictions of the full run by its coarse copies.

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <set>
#include <thread>

#include "app/predict/predict.h"
#include "app/scene/read.h"
#include "app/support/errors.h"
#include "tests/cli/run_neve.h"
#include "tests/support/child.h"
#include "tests/support/cinema.h"

namespace neve::test {
namespace {

class Prediction : public Cli {
 protected:
  /// The run.json of snowball_wedge.toml, as docs/prediction.md has it.
  app::Json wedge(std::vector<std::string> further) {
    std::vector<std::string> words{"render",     NEVE_SOURCE_DIR "/scenes/snowball_wedge.toml",
                                   "--frames",   "20",
                                   "--size",     "64x40",
                                   "--out",      "wedge",
                                   "--set",      "solver.acoustic_cfl=0.85",
                                   "--no-movie", "--replace"};
    words.insert(words.end(), further.begin(), further.end());
    const app::output::ProcessResult made = neve(words);
    EXPECT_EQ(made.exit_code, 0) << made.errors;
    return json_of("wedge/run.json");
  }

  static double largest_piece(const app::Json& run) {
    return run["frames"].back()["largest_fragment"].get<double>();
  }
};

/// Copies as run_copies() makes them, with these largest pieces and this mean J_P.
std::vector<app::predict::Copy> copies_of(std::vector<double> pieces, double mean_J_P) {
  std::vector<app::predict::Copy> copies;
  for (const double piece : pieces) {
    app::predict::Copy copy;
    copy.coarsening = copies.empty() ? 1.5 : 2;
    copy.whole = piece;
    copy.has_broken = piece < 0.99;
    copy.values[0] = copies.empty() ? 0.5 : 0.4;  // spread
    copy.values[static_cast<int>(app::predict::Quantity::mean_J_P)] = mean_J_P;
    copies.push_back(copy);
  }
  return copies;
}

app::scene::Scene ball(const std::string& model = "snow") {
  return app::scene::read_scene_text("[material.snow]\nmodel = \"" + model +
                                         "\"\n[[body]]\nshape = { sphere = { radius = 0.1 } }\n",
                                     "ball.toml");
}

TEST(Predict, VerdictsAreThoseOfAllCopiesOrNone) {
  using app::predict::judge;
  using app::predict::Verdict;
  EXPECT_EQ(judge(copies_of({0.6, 0.7, 0.8}, 2)).verdict, Verdict::breaks);
  EXPECT_EQ(judge(copies_of({1, 1, 1}, 0.9)).verdict, Verdict::holds);
  EXPECT_EQ(judge(copies_of({0.6, 1, 0.8}, 2)).verdict, Verdict::undecided);
  EXPECT_EQ(judge(copies_of({0.988, 0.9, 0.9}, 2)).verdict, Verdict::undecided)
      << "the finest is at the edge";
  EXPECT_EQ(judge(copies_of({1, 1, 1}, 1.5)).verdict, Verdict::undecided)
      << "snow that loosens may lose dust";
}

TEST(Predict, CopiesThatCannotSayGiveNoNumbers) {
  using app::predict::Verdict;
  EXPECT_EQ(app::predict::why_not(ball("neo_hookean")), "no material of the scene breaks");
  EXPECT_EQ(app::predict::why_not(ball()), "");
  std::vector<app::predict::Copy> copies = copies_of({1, 1, 1}, 1);
  copies[1].failure = "it diverged";
  const app::predict::Prediction diverged = app::predict::judge(copies);
  EXPECT_EQ(diverged.verdict, Verdict::cannot_say);
  EXPECT_TRUE(diverged.estimates.empty());
  EXPECT_TRUE(contains(diverged.reason, "--coarsen 2")) << diverged.reason;
}

TEST(Predict, IntervalsHoldHalfOfTheDifferenceOfTheCopies) {
  const app::predict::Prediction made = app::predict::judge(copies_of({1, 1, 1}, 1));
  const app::predict::Estimate& spread = made.estimates.front();
  EXPECT_DOUBLE_EQ(spread.expected, 0.55);  // 0.5 and half of 0.1
  EXPECT_LT(spread.low, 0.55 - 0.05 - 0.01);
  EXPECT_GT(spread.high, 0.55 + 0.05 + 0.01);
  EXPECT_NEAR(spread.high - spread.expected, spread.expected - spread.low, 1e-12);
}

constexpr double whole = 0.99;  // record::whole_share

TEST_F(Prediction, SnowThatBreaksBreaksInCellsThreeTimesAsLarge) {
  EXPECT_LT(largest_piece(wedge({"--coarsen", "3"})), 0.7);
  EXPECT_GT(largest_piece(wedge({"--coarsen", "3", "--set", "solver.threshold_cell=0.06"})), whole)
      << "thresholds of the full run in coarse cells are those of tougher snow";
}

TEST_F(Prediction, CoarseRunsSayByWhatTheyScaleThresholds) {
  neve({"render", "scene.toml", "--coarsen", "2", "--frames", "0", "--out", "coarse"});
  const app::Json run = json_of("coarse/run.json");
  EXPECT_EQ(run["coarsen"], 2);
  EXPECT_EQ(run["overrides"], app::Json::array({"solver.threshold_cell=0.04"}));
  EXPECT_TRUE(contains(run["scene"].get<std::string>(), "threshold_cell = 0.04"));
  const app::output::ProcessResult check = neve({"check", "scene.toml", "--coarsen", "2"});
  EXPECT_TRUE(contains(check.output, "coarsened 2x, thresholds for cells of 0.04 m"))
      << check.output;
  neve({"render", "scene.toml", "--frames", "0", "--out", "full"});
  const app::Json full = json_of("full/run.json");
  EXPECT_EQ(full["overrides"], app::Json::array());
  EXPECT_TRUE(contains(full["scene"].get<std::string>(), "threshold_cell = 0\n"));
}

TEST_F(Prediction, CheckSaysWhatCopiesCostAndWhatTheyForesee) {
  const app::output::ProcessResult check = neve({"check", "scene.toml", "--predict", "--json"});
  EXPECT_EQ(check.exit_code, 0) << check.errors;
  EXPECT_TRUE(contains(check.errors, "runs 3 coarse copies")) << check.errors;
  const app::Json prediction = app::parse_json(check.output).at("prediction");
  EXPECT_EQ(prediction.at("copies").size(), 3u);
  EXPECT_EQ(prediction.at("copies")[2].at("seed"), 2);
  for (const char* quantity : {"spread", "height", "mean_J_P", "largest_fragment", "max_force"}) {
    const app::Json& estimate = prediction.at("estimates").at(quantity);
    EXPECT_LE(estimate.at("low"), estimate.at("expected")) << quantity;
    EXPECT_LT(estimate.at("low"), estimate.at("high")) << quantity;
  }
  EXPECT_FALSE(
      app::parse_json(neve({"check", "scene.toml", "--json"}).output).contains("prediction"));
}

TEST_F(Prediction, PicturesAndRunJsonSayWhatTheFullRunDoes) {
  const std::vector<std::string> words{"render", "scene.toml", "--coarsen", "1.5", "--predict",
                                       "--size", "64x40",      "--out",     "run", "--no-movie"};
  const auto made = neve(words);
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_TRUE(contains(made.errors, "runs 3 coarse copies")) << "the cost is said before";
  const app::Json prediction = json_of("run/run.json").at("prediction");
  EXPECT_EQ(prediction.at("copies").size(), 3u);
  const app::Json check =
      app::parse_json(neve({"check", "scene.toml", "--predict", "--json"}).output).at("prediction");
  EXPECT_EQ(prediction.at("estimates"), check.at("estimates"))
      << "that of the scene, not of copies";
  const app::Json info = app::parse_json(neve({"info", "run/particles/0002.png", "--json"}).output);
  EXPECT_EQ(info.at("prediction"), prediction.at("text"));
  EXPECT_TRUE(contains(prediction.at("text")[0], "at full resolution, frame "));
  EXPECT_EQ(neve({"render", "run/particles/0002.png", "--out", "again"}).exit_code, 0);
  EXPECT_EQ(read_text(folder / "again/particles/0002.png"),
            read_text(folder / "run/particles/0002.png"))
      << "made again, it has the same caption";
  std::vector<std::string> resumed = words;
  resumed.push_back("--resume");
  const auto again = neve(resumed);
  EXPECT_FALSE(contains(again.errors, "coarse copies")) << "a run that is resumed knows it";
  EXPECT_EQ(json_of("run/run.json").at("prediction"), prediction);
  // A run that is named by its folder knows it too, with any drawing of it, longer or not.
  const auto longer = neve({"render", "run", "--frames", "6", "--no-movie"});
  EXPECT_EQ(longer.exit_code, 0) << longer.errors;
  EXPECT_FALSE(contains(longer.errors, "coarse copies")) << longer.errors;
  const auto flagged = neve({"render", "run", "--resume", "--predict", "--no-movie"});
  EXPECT_EQ(flagged.exit_code, 0) << flagged.errors;
  EXPECT_EQ(json_of("run/run.json").at("prediction"), prediction);
  const app::Json last = app::parse_json(neve({"info", "run/particles/0006.png", "--json"}).output);
  EXPECT_EQ(last.at("prediction"), prediction.at("text"));
}

TEST_F(Prediction, OnlyCoarseRunsOfScenesArePredicted) {
  const auto without = neve({"render", "scene.toml", "--predict"});
  EXPECT_EQ(without.exit_code, app::exit_usage);
  EXPECT_TRUE(contains(without.errors, "--coarsen 2")) << without.errors;
  EXPECT_EQ(neve({"sweep", "scene.toml", "-p", "seed=1,2", "--predict"}).exit_code,
            app::exit_usage);
  ASSERT_EQ(neve({"render", "scene.toml", "--frames", "0", "--out", "run", "--no-movie"}).exit_code,
            0);
  const auto of_run = neve({"render", "run", "--frames", "1", "--predict", "--no-movie"});
  EXPECT_EQ(of_run.exit_code, app::exit_usage);
  EXPECT_TRUE(contains(of_run.errors, "was made without a prediction")) << of_run.errors;
  const auto forked = neve({"sweep", "scene.toml", "-p", "solver.gravity=[0,-9,0],[0,-8,0]",
                            "--predict", "--coarsen", "2", "--fork", "0.05"});
  EXPECT_EQ(forked.exit_code, app::exit_usage);
  EXPECT_TRUE(contains(forked.errors, "from the start")) << forked.errors;
  folder.write("forks.toml",
               "[sweep]\nscene = \"scene.toml\"\nfork = \"0.05s\"\n[axis]\n"
               "\"material.snow.hardening\" = [5, 10, 20]\n");
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--predict"}, {"--refine", "2"}, {"--refine-runs", "0"}}) {
    std::vector<std::string> words{"sweep", "forks.toml", "--coarsen", "2", "--dry-run"};
    words.insert(words.end(), more.begin(), more.end());
    const auto in_file = neve(words);
    EXPECT_EQ(in_file.exit_code, app::exit_invalid_scene);
    EXPECT_TRUE(contains(in_file.errors, "sweep.fork cannot be combined with " + more[0]))
        << in_file.errors;
  }
}

TEST_F(Prediction, ASweepRunsTheCopiesOfItsPointsAmongItsRuns) {
  const auto made =
      neve({"sweep", "scene.toml", "-p", "body.ball.velocity=[0,-1,0],[0,-6,0]", "--coarsen", "2",
            "--seeds", "2", "--predict", "--size", "96x54", "--out", "study", "--movie", "none"});
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_TRUE(contains(made.errors, "the prediction runs 2 further copies")) << made.errors;
  const app::Json manifest = json_of("study/manifest.json");
  ASSERT_EQ(manifest.at("variants").size(), 6u);
  std::set<std::string> folders;
  for (const app::Json& run : manifest.at("runs")) folders.insert(run.at("folder"));
  for (const app::Json& variant : manifest.at("variants")) {
    EXPECT_EQ(folders.contains(variant.at("run").at("folder")), variant.at("coarsen") == 2)
        << "both seeds at --coarsen 2 are runs of the sweep";
  }
  EXPECT_TRUE(contains(manifest.at("coarsened"), "coarsened 2x"));
  const std::string csv = read_text(folder / "study/data.csv");
  EXPECT_TRUE(contains(csv, ",full_verdict,full_spread,full_spread_low,")) << csv;
  EXPECT_TRUE(contains(read_text(folder / "study/report.html"), "\"full_spread\""));
  const auto check =
      neve({"check", "scene.toml", "--set", "body.ball.velocity=[0,-6,0]", "--predict", "--json"});
  const app::Json full = app::parse_json(check.output).at("prediction");
  EXPECT_TRUE(contains(
      csv,
      "," + full.at("verdict").get<std::string>() + "," +
          fmt::format("{:.9g}", full.at("estimates").at("spread").at("expected").get<double>())))
      << "the same as of neve check\n"
      << csv << check.output;
  EXPECT_EQ(neve({"verify", "study"}).exit_code, 0);
}

TEST_F(Prediction, ASweepMakesItsBestPointsAtFullResolutionInTheSameFolder) {
  std::vector<std::string> words{
      "sweep",     "scene.toml", "-p",      "body.ball.velocity=[0,-1,0],[0,-3,0],[0,-6,0]",
      "--coarsen", "1.5",        "--size",  "96x54",
      "--out",     "study",      "--movie", "none"};
  std::vector<std::string> refined = words;
  refined.insert(refined.end(), {"--refine", "1", "--refine-runs", "0", "--best", "max_speed"});
  const auto made = neve(refined);
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_TRUE(contains(made.errors, "at full resolution: runs 0, 2")) << made.errors;
  EXPECT_TRUE(contains(made.errors, "by runs of 2 points: ")) << made.errors;
  const app::Json manifest = json_of("study/manifest.json");
  ASSERT_EQ(manifest.at("variants").size(), 2u);
  const std::string of_best = manifest.at("variants")[1].at("run").at("folder");
  neve({"render", "scene.toml", "--set", "body.ball.velocity=[0,-6,0]", "--size", "96x54", "--out",
        "alone", "--no-movie"});
  EXPECT_EQ(hashes("study/runs/" + of_best), hashes("alone")) << "the same as of neve render";
  EXPECT_TRUE(
      contains(read_text(this->folder / "study/report.html"), "runs/" + of_best + "/particles/"))
      << "the page shows its pictures";
  std::replace(refined.begin(), refined.end(), std::string("0"), std::string("0-1"));
  const auto more = neve(refined);
  EXPECT_TRUE(contains(more.errors, "rank correlation of coarse and full: ")) << more.errors;
  const app::Json result = app::parse_json(neve([&] {
                                             std::vector<std::string> json = refined;
                                             json.push_back("--json");
                                             return json;
                                           }())
                                               .output);
  EXPECT_EQ(result.at("started"), 0) << "what has been made is kept";
  EXPECT_EQ(result.at("ok"), 3) << "runs at full resolution are no further ones";
}

TEST_F(Prediction, DamagedRunsAtFullResolutionAreToldByCollect) {
  const std::vector<std::string> words{
      "sweep",     "scene.toml", "-p",      "material.snow.hardening=5,10",
      "--coarsen", "1.5",        "--size",  "96x54",
      "--out",     "study",      "--movie", "none"};
  std::vector<std::string> refined = words;
  refined.insert(refined.end(), {"--refine-runs", "0"});
  ASSERT_EQ(neve(refined).exit_code, 0);
  const std::string run = json_of("study/manifest.json").at("variants")[0].at("run").at("folder");
  folder.write("study/runs/" + run + "/particles/0002.png", "broken");
  const auto collected = neve({"sweep", "collect", "study", "--movie", "none"});
  EXPECT_EQ(collected.exit_code, app::exit_check_failed) << collected.errors;
  EXPECT_TRUE(contains(collected.errors, "0002.png")) << collected.errors;
  EXPECT_FALSE(contains(collected.errors, "by runs of 1 point")) << "it tells nothing";
  EXPECT_EQ(neve({"verify", "study"}).exit_code, app::exit_check_failed);
  // A metric that no point has chooses nothing, and that is said.
  std::vector<std::string> by_bodies = words;
  by_bodies.insert(by_bodies.end(), {"--refine", "1", "--best", "body_fall"});
  const auto none = neve(by_bodies);
  EXPECT_EQ(none.exit_code, 0) << none.errors;
  EXPECT_TRUE(contains(none.errors, "none has body_fall to choose by")) << none.errors;
}

class RefinedSeeds : public Prediction {
 protected:
  static std::vector<std::string> words(const std::string& out) {
    return {"sweep",     "scene.toml", "-p",      "body.ball.velocity=[0,-1,0],[0,-6,0]",
            "--coarsen", "1.5",        "--seeds", "2",
            "--refine",  "1",          "--best",  "max_speed",
            "--size",    "96x54",      "--movie", "none",
            "--out",     out};
  }

  /// Returns the hashes of the runs at full resolution, by the run that each is of.
  std::map<int, std::map<int, std::string>> full_hashes(const std::string& out) {
    std::map<int, std::map<int, std::string>> all;
    const app::Json manifest = json_of(out + "/manifest.json");
    for (const app::Json& variant : manifest.at("variants"))
      all[variant.at("of").get<int>()] =
          hashes(out + "/runs/" + variant.at("run").at("folder").get<std::string>());
    return all;
  }
};

TEST_F(RefinedSeeds, AllSeedsOfAPointAreMadeAtFullResolution) {
  const auto made = neve(words("study"));
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_TRUE(contains(made.errors, "then 1 point at full resolution, 2 runs with their seeds"))
      << made.errors;
  EXPECT_TRUE(contains(made.errors, "at full resolution: runs 2, 3")) << made.errors;
  const auto full = full_hashes("study");
  ASSERT_EQ(full.size(), 2u);
  for (const int seed : {1, 2}) {
    neve({"render", "scene.toml", "--set", "body.ball.velocity=[0,-6,0]", "--set",
          "seed=" + std::to_string(seed), "--size", "96x54", "--out", "alone", "--no-movie",
          "--replace"});
    EXPECT_EQ(full.at(seed + 1), hashes("alone")) << "seed " << seed;
  }
  const std::vector<CsvRow> points = parse_csv(read_text(folder / "study/points.csv"));
  const auto cell = [&](std::size_t row, const std::string& name) {
    const auto found = std::find(points[0].begin(), points[0].end(), name);
    return found == points[0].end()
               ? "no column"
               : points[row][static_cast<std::size_t>(found - points[0].begin())];
  };
  EXPECT_EQ(cell(1, "full_runs"), "");
  EXPECT_EQ(cell(2, "full_by"), "run");
  EXPECT_EQ(cell(2, "full_runs"), "2");
  EXPECT_LT(std::stod(cell(2, "full_spread_low")), std::stod(cell(2, "full_spread_high")));
  EXPECT_GT(std::stod(cell(2, "full_spread")), std::stod(cell(2, "full_spread_low")));
  EXPECT_EQ(cinema_problem(read_text(folder / "study/data.csv"), folder / "study"), "");
  const std::string page = read_text(folder / "study/report.html");
  const app::Json manifest = json_of("study/manifest.json");
  for (const app::Json& variant : manifest.at("variants"))
    EXPECT_TRUE(
        contains(page, "runs/" + variant.at("run").at("folder").get<std::string>() + "/particles/"))
        << "the page flips through the seeds at full resolution";
  EXPECT_EQ(neve({"verify", "study"}).exit_code, 0);
  const auto again = neve(words("study"));
  EXPECT_TRUE(contains(again.errors, "at full resolution: runs 2, 3")) << again.errors;
  EXPECT_FALSE(contains(again.errors, "out of the table")) << again.errors;
}

TEST_F(RefinedSeeds, AKilledRefinementContinuesBitForBit) {
  ASSERT_EQ(neve(words("study")).exit_code, 0);
  for (int k = 0; k < 5; ++k) {
    std::vector<std::string> program = words((folder / "killed").string());
    program.insert(program.begin(), NEVE_BINARY);
    program[2] = (folder / "scene.toml").string();
    const pid_t child = start_program(program);
    std::this_thread::sleep_for(std::chrono::milliseconds(150 + 250 * k));
    ::kill(child, SIGKILL);
    wait_for(child);
  }
  const auto rest = neve(words("killed"));
  ASSERT_EQ(rest.exit_code, 0) << rest.errors;
  EXPECT_EQ(full_hashes("study").size(), 2u);
  EXPECT_EQ(full_hashes("killed"), full_hashes("study"));
  EXPECT_EQ(read_text(folder / "killed/points.csv").substr(0, 6), "point,");
}

TEST_F(RefinedSeeds, TheCostOfAllSeedsIsSaidBefore) {
  std::vector<std::string> plan = words("study");
  plan.push_back("--dry-run");
  const auto said = neve(plan);
  EXPECT_TRUE(contains(said.output, "then 1 point at full resolution, 2 runs with their seeds"))
      << said.output << said.errors;
  EXPECT_FALSE(exists("study"));
}

TEST_F(RefinedSeeds, RunsAtFullResolutionAreCountedApartFromTheOthers) {
  const auto plan_of = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{
        "sweep",     "scene.toml", "-p",        "body.ball.velocity=[0,-1,0],[0,-3,0],[0,-6,0]",
        "--coarsen", "2",          "--dry-run", "--out",
        "study"};
    words.insert(words.end(), more.begin(), more.end());
    const auto said = neve(words);
    EXPECT_EQ(said.exit_code, 0) << said.errors;
    return said.output;
  };
  const std::string text = plan_of({"--refine-runs", "0,2"});
  EXPECT_TRUE(contains(text, "then 2 points at full resolution, of runs 0, 2, about ")) << text;
  EXPECT_TRUE(contains(text, "\nin all about ")) << text;
  EXPECT_TRUE(contains(plan_of({"--refine", "1", "--refine-runs", "0"}),
                       "then at most 2 points at full resolution, with run 0, about "));
  EXPECT_TRUE(contains(plan_of({"--refine", "50"}), "then 3 points at full resolution, about "))
      << "there are no more";
  EXPECT_FALSE(contains(plan_of({}), "in all about"));

  const app::Json plain = app::parse_json(plan_of({"--json"}));
  EXPECT_FALSE(plain.contains("refinement"));
  EXPECT_EQ(plain.at("seconds_in_all"), plain.at("seconds"));
  const app::Json json =
      app::parse_json(plan_of({"--json", "--seeds", "2", "--refine", "1", "--refine-runs", "3"}));
  const app::Json& full = json.at("refinement");
  EXPECT_EQ(full.at("named"), app::Json::array({2})) << "the point that run 3 is of";
  EXPECT_EQ(full.at("points"), 2);
  EXPECT_EQ(full.at("runs"), 4);
  double coarse = 0, largest = 0;
  for (const app::Json& run : json.at("runs")) {
    coarse += run.at("seconds").get<double>();
    largest = std::max(largest, run.at("memory_bytes").get<double>());
  }
  // Four of six runs, with 16 times the work.
  EXPECT_GT(full.at("seconds").get<double>(), 0.5 * 16 * 4 / 6 * coarse);
  EXPECT_LT(full.at("seconds").get<double>(), 2.0 * 16 * 4 / 6 * coarse);
  EXPECT_GT(full.at("memory_bytes").get<double>(), largest);
  EXPECT_GT(json.at("seconds_in_all"), json.at("seconds"));

  const auto refused = neve({"sweep", "scene.toml", "-p", "seed=1,2", "--coarsen", "2", "--dry-run",
                             "--refine-runs", "5"});
  EXPECT_EQ(refused.exit_code, app::exit_usage);
  EXPECT_TRUE(contains(refused.errors, "--refine-runs: there is no run 5")) << refused.errors;
  EXPECT_FALSE(exists("study"));
}

TEST_F(Prediction, OnlySomeRunsHaveTheCopiesOfTheirPoints) {
  const auto said =
      neve({"sweep", "scene.toml", "-p", "body.ball.velocity=[0,-1,0],[0,-3,0],[0,-6,0]",
            "--coarsen", "2", "--predict", "--only", "2", "--dry-run", "--out", "study"});
  EXPECT_EQ(said.exit_code, 0) << said.errors;
  EXPECT_TRUE(contains(said.output, "the prediction takes 3 coarse copies")) << said.output;
}

TEST_F(Prediction, TheFullRunBreaksAsItsCopiesDo) {
  for (const char* preset : {"paper", "lower_hardening"}) {
    const std::string snow = std::string("material.snow.preset=") + preset;
    EXPECT_LT(largest_piece(wedge({"--set", snow})), whole) << preset;
    for (const char* factor : {"1.5", "2"})
      EXPECT_LT(largest_piece(wedge({"--set", snow, "--coarsen", factor})), whole)
          << preset << " " << factor;
  }
}

}  // namespace
}  // namespace neve::test
