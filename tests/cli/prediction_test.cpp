/// What coarse copies say of the full run.

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
