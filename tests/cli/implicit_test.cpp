/// Semi-implicit steps from the outside: what a run, its resumption, check, dump and validate say.

#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

TEST_F(Cli, SemiImplicitRunsSayHowWellTheyWereSolved) {
  const auto run = neve({"render", "scene.toml", "--frames", "2", "--set", "solver.beta=1", "--out",
                         "implicit", "--validate"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_FALSE(contains(run.errors, "warning")) << run.errors;
  const app::Json json = json_of("implicit/run.json");
  for (int frame = 1; frame <= 2; ++frame) {
    const app::Json& record = json["frames"][frame];
    EXPECT_GT(record["solve_iterations"], 0);
    EXPECT_LE(record["solve_residual"].get<double>(), 1e-2) << "the default of solve_tolerance";
    EXPECT_NE(record["dt_limit"], "acoustic");
  }
  EXPECT_TRUE(json["frames"][0]["solve_iterations"].is_null());
  ASSERT_EQ(neve({"render", "scene.toml", "--frames", "2", "--out", "explicit"}).exit_code, 0);
  const app::Json by_force = json_of("explicit/run.json");
  EXPECT_TRUE(by_force["frames"][2]["solve_iterations"].is_null());
  EXPECT_TRUE(by_force["frames"][2]["solve_residual"].is_null());
  EXPECT_GT(by_force["frames"][2]["steps"], json["frames"][2]["steps"]);
}

TEST_F(Cli, SemiImplicitRunsContinueBitForBit) {
  const std::vector<std::string> common{"render", "scene.toml", "--set", "solver.beta=0.7"};
  const auto render = [&](std::vector<std::string> more) {
    more.insert(more.begin(), common.begin(), common.end());
    const auto result = neve(more);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
  };
  render({"--frames", "3", "--out", "whole"});
  render({"--frames", "1", "--checkpoint-every", "1", "--out", "parts"});
  render({"--frames", "3", "--resume", "--out", "parts"});
  const app::Json whole = json_of("whole/run.json"), parts = json_of("parts/run.json");
  for (const char* key : {"state_hash", "solve_iterations", "solve_residual", "steps"})
    EXPECT_EQ(whole["frames"][3][key], parts["frames"][3][key]) << key;
}

TEST_F(Cli, ASolveThatIsCutShortIsAWarning) {
  const auto run = neve({"render", "scene.toml", "--frames", "1", "--set", "solver.beta=1", "--set",
                         "solver.solve_iterations=2", "--set", "solver.solve_tolerance=1e-6"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_TRUE(contains(run.errors, "solver.solve_iterations = 2")) << run.errors;
}

TEST_F(Cli, CheckAndDumpKnowTheSolve) {
  const auto check = neve({"check", "scene.toml", "--json", "--set", "solver.beta=1"});
  EXPECT_EQ(check.exit_code, 0) << check.errors;
  const app::Json json = app::parse_json(std::string_view(check.output));
  EXPECT_GT(json["solve_iterations"], 0);
  EXPECT_FALSE(json["dt_limits"].contains("acoustic"));
  EXPECT_TRUE(contains(json["findings"].dump(), "solver.beta"));
  const auto dump = neve({"dump", "scene.toml", "--at", "0.02s", "--stage", "implicit_solve",
                          "--field", "dv_solve", "--set", "solver.beta=1"});
  EXPECT_EQ(dump.exit_code, 0) << dump.errors;
  EXPECT_TRUE(contains(dump.output, "dv_solve")) << dump.output.substr(0, 500);
}

TEST_F(Cli, BetaIsHeldToItsRange) {
  const auto run = neve({"render", "scene.toml", "--set", "solver.beta=1.5"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(contains(run.errors, "solver.beta=1.5")) << run.errors;
}

}  // namespace
}  // namespace neve::test
