/// What coarse copies say of the full run.

#include "app/predict/predict.h"
#include "app/scene/read.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

class Prediction : public Cli {
 protected:
  /// The run.json of snowball_wedge.toml, as docs/prediction.md has it.
  app::Json wedge(std::vector<std::string> further) {
    std::vector<std::string> words{"render",    NEVE_SOURCE_DIR "/scenes/snowball_wedge.toml",
                                   "--frames",  "20",
                                   "--size",    "64x40",
                                   "--out",     "wedge",
                                   "--set",     "solver.acoustic_cfl=0.85",
                                   "--no-movie"};
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
  EXPECT_EQ(judge(copies_of({0.6, 0.7, 0.8}, 2), ball()).verdict, Verdict::breaks);
  EXPECT_EQ(judge(copies_of({1, 1, 1}, 0.9), ball()).verdict, Verdict::holds);
  EXPECT_EQ(judge(copies_of({0.6, 1, 0.8}, 2), ball()).verdict, Verdict::undecided);
  EXPECT_EQ(judge(copies_of({0.988, 0.9, 0.9}, 2), ball()).verdict, Verdict::undecided)
      << "the finest is at the edge";
  EXPECT_EQ(judge(copies_of({1, 1, 1}, 1.5), ball()).verdict, Verdict::undecided)
      << "snow that loosens may lose dust";
}

TEST(Predict, CopiesThatCannotSayGiveNoNumbers) {
  using app::predict::Verdict;
  std::vector<app::predict::Copy> copies = copies_of({1, 1, 1}, 1);
  const app::predict::Prediction elastic = app::predict::judge(copies, ball("neo_hookean"));
  EXPECT_EQ(elastic.verdict, Verdict::cannot_say);
  EXPECT_TRUE(elastic.estimates.empty());
  copies[1].failure = "it diverged";
  const app::predict::Prediction diverged = app::predict::judge(copies, ball());
  EXPECT_EQ(diverged.verdict, Verdict::cannot_say);
  EXPECT_TRUE(contains(diverged.reason, "--coarsen 2")) << diverged.reason;
}

TEST(Predict, IntervalsHoldHalfOfTheDifferenceOfTheCopies) {
  const app::predict::Prediction made = app::predict::judge(copies_of({1, 1, 1}, 1), ball());
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
