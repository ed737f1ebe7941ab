/// `neve render --validate` and the self-tests of `neve doctor`.

#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

TEST_F(Cli, ARightRunIsValidatedInSilenceAndWithTheSameBits) {
  const auto watched =
      neve({"render", "scene.toml", "--validate", "--frames", "2", "--out", "watched"});
  EXPECT_EQ(watched.exit_code, 0) << watched.errors;
  EXPECT_FALSE(contains(watched.errors, "warning")) << watched.errors;
  EXPECT_TRUE(contains(watched.errors, "validation: 19 checks at ")) << watched.errors;
  EXPECT_TRUE(contains(watched.errors, " steps, all held")) << watched.errors;
  ASSERT_EQ(neve({"render", "scene.toml", "--frames", "2", "--out", "alone"}).exit_code, 0);
  const app::Json with = json_of("watched/run.json"), without = json_of("alone/run.json");
  for (int frame = 0; frame <= 2; ++frame)
    EXPECT_EQ(with["frames"][frame]["state_hash"], without["frames"][frame]["state_hash"]);
  EXPECT_FALSE(without.contains("validation"));
  ASSERT_EQ(with["validation"].size(), 19u);
  for (const app::Json& check : with["validation"]) {
    EXPECT_TRUE(check["worst"].is_number()) << check;
    EXPECT_TRUE(check["threshold"].is_number()) << check;
    EXPECT_EQ(check["times"], 0) << check;
    EXPECT_TRUE(check["first_step"].is_null()) << check;
  }
}

TEST_F(Cli, ValidationWarnsOfStepsThatAreLongAndFailsForStepsThatAreTooLong) {
  // The volumes of so small a ball are overestimated: sound of 36 m/s crosses 0.7 of a cell in a
  // step, then 1.2.
  const auto warned = neve({"render", "scene.toml", "--validate", "--frames", "0", "--set",
                            "solver.time_step=fixed", "--set", "solver.dt=8e-4", "--out", "long"});
  EXPECT_EQ(warned.exit_code, 0) << warned.errors;
  EXPECT_TRUE(contains(warned.errors, "step 0: the acoustic CFL c dt/h is 0.7")) << warned.errors;
  EXPECT_TRUE(contains(warned.errors, "; use dt = ")) << warned.errors;
  EXPECT_TRUE(contains(warned.errors, "acoustic_cfl broken at 1, first at step 0"))
      << warned.errors;

  const auto failed =
      neve({"render", "scene.toml", "--validate", "--frames", "0", "--set",
            "solver.time_step=fixed", "--set", "solver.dt=1.3e-3", "--out", "too_long"});
  EXPECT_EQ(failed.exit_code, 9) << failed.errors;
  EXPECT_TRUE(exists("too_long/particles/0000.png"));
  const app::Json check = json_of("too_long/run.json")["validation"][0];
  EXPECT_EQ(check["check"], "acoustic_cfl");
  EXPECT_EQ(check["first_step"], 0);
  EXPECT_EQ(check["times"], 1);
  EXPECT_GT(check["worst"].get<double>(), 1.0);
  EXPECT_EQ(check["threshold"], 0.5);
}

TEST_F(Cli, DoctorTestsThePhysics) {
  const auto doctor = neve({"doctor", "--json"});
  EXPECT_EQ(doctor.exit_code, 0) << doctor.output;
  const app::Json physics = app::parse_json(std::string_view(doctor.output))["physics"];
  ASSERT_EQ(physics.size(), 19u);
  for (const app::Json& test : physics) {
    EXPECT_TRUE(test["check"].is_string());
    EXPECT_EQ(test["passed"], true) << test;
    EXPECT_TRUE(contains(test["detail"], "allowed")) << test;
  }
  EXPECT_TRUE(contains(neve({"doctor"}).output, "physics: weights            right"));
}

TEST_F(Cli, DoctorFailsWhenThePhysicsCannotBeTested) {
  ::setenv("NEVE_SIMD", "abacus", 1);
  const auto doctor = neve({"doctor", "--json"});
  ::unsetenv("NEVE_SIMD");
  EXPECT_EQ(doctor.exit_code, 9);
  const app::Json physics = app::parse_json(std::string_view(doctor.output))["physics"];
  EXPECT_EQ(physics[0]["passed"], false);
  EXPECT_TRUE(contains(physics[0]["detail"], "abacus")) << physics[0];
}

}  // namespace
}  // namespace neve::test
