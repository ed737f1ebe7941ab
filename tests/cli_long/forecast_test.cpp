/// Forecasts of snow that packs only where it is fine enough.

#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

/// A ball of 1500 particles bounces where one of 7000 keeps a packed layer, which rules dt for the
/// rest of the run: such a copy alone foretold 2690 of 6230 steps.
TEST_F(Cli, CheckForeseesSnowThatPacksWhereItIsFine) {
  const std::string file = std::string(NEVE_SOURCE_DIR) + "/scenes/snowball_drop.toml";
  const auto check = neve({"check", file, "--coarsen", "1.4", "--json"});
  ASSERT_EQ(check.exit_code, 0) << check.errors;
  const app::Json json = app::parse_json(std::string_view(check.output));
  const auto run =
      neve({"render", file, "--coarsen", "1.4", "--size", "64x36", "--no-movie", "--out", "out"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  double steps = 0;
  const app::Json record = json_of("out/run.json");
  for (const app::Json& frame : record["frames"]) steps += frame["steps"].get<double>();
  // The factor that is promised; the truth is in the range as well.
  EXPECT_GT(json["steps"].get<double>(), 0.5 * steps);
  EXPECT_LT(json["steps"].get<double>(), 2 * steps);
  EXPECT_GT(json["steps_range"][1].get<double>(), steps);
  EXPECT_LT(json["steps_range"][0].get<double>(), steps);
}

}  // namespace
}  // namespace neve::test
