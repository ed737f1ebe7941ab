/// The settings of --fast.

#include "app/forecast/fast.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "app/run/render_job.h"
#include "app/scene/read.h"
#include "app/setup/seed_scene.h"
#include "app/sweep/plan/sweep_options.h"
#include "app/sweep/plan/sweep_plan.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

using Lines = std::vector<std::string>;

/// A ball that meets the floor in the second frame.
std::string falling_ball(const std::string& solver, const std::string& material = "",
                         double speed = 4) {
  return fmt::format(R"(
frames = 6
[solver]
cell_size = 0.03
{}
[material.snow]
{}
[[body]]
shape    = {{ sphere = {{ center = [0, 0.4, 0], radius = 0.2 }} }}
velocity = [0, {}, 0]
[[collider]]
shape = {{ plane = {{}} }}
)",
                     solver, material, -speed);
}

forecast::FastLook look_at(const std::string& text, const Lines& chosen = {}, int last = 6) {
  return forecast::fast_look(scene::read_scene_text(text, "scene.toml"), last, chosen);
}

TEST(Fast, StepsGrowAndHardeningGetsACeiling) {
  const forecast::FastLook look = look_at(falling_ball(""));
  EXPECT_EQ(look.overrides, Lines({"solver.acoustic_cfl=0.85", "material.snow.max_hardening=20"}));
  EXPECT_FALSE(look.is_implicit);
  // 0.85 / 0.5 at the most, where nothing hardens.
  EXPECT_LT(*look.work, 0.75 * *look.work_before);
  EXPECT_GT(*look.work, 0.25 * *look.work_before);
  EXPECT_NE(look.sentence().find("solver.acoustic_cfl=0.85, material.snow.max_hardening=20"),
            std::string::npos)
      << look.sentence();
}

TEST(Fast, SnowThatNobodyUsesIsLeftAlone) {
  std::string rubber = falling_ball("", "") + "[material.rubber]\nmodel = \"neo_hookean\"\n";
  rubber.replace(rubber.find("velocity ="), 0, "material = \"rubber\"\n");
  for (const std::string& line : look_at(rubber).overrides)
    EXPECT_EQ(line.find("hardening"), std::string::npos) << line;
}

TEST(Fast, TransfersThatDampByTheStepTakeShorterOnesBecauseTheyDriftMore) {
  for (const char* transfer : {"apic", "mls"}) {
    const forecast::FastLook look =
        look_at(falling_ball(fmt::format("transfer = \"{}\"", transfer)));
    ASSERT_FALSE(look.overrides.empty());
    EXPECT_EQ(look.overrides[0], "solver.acoustic_cfl=0.7");
  }
}

/// Elastic bodies, snow that is stiff against a change of volume, and quadratic weights are stable
/// in no longer steps.
TEST(Fast, OnlySnowOnCubicWeightsWithFlipTakesTheLongestSteps) {
  const std::string flip = "transfer = \"flip\"\n";
  EXPECT_EQ(look_at(falling_ball(flip)).overrides.at(0), "solver.acoustic_cfl=1.2");
  for (const auto& [solver, material] :
       {std::pair("kernel = \"quadratic\"", ""), std::pair("", "model = \"corotated\""),
        std::pair("", "poisson_ratio = 0.4")}) {
    const forecast::FastLook look = look_at(falling_ball(flip + solver, material));
    ASSERT_FALSE(look.overrides.empty()) << solver << material;
    EXPECT_EQ(look.overrides[0], "solver.acoustic_cfl=0.85") << solver << material;
  }
}

TEST(Fast, SettingsOfTheUserStay) {
  const forecast::FastLook look = look_at(falling_ball(""), {"solver.acoustic_cfl", "solver.beta"});
  EXPECT_EQ(look.overrides, Lines({"material.snow.max_hardening=20"}));
  // Values that go further than those of --fast stay as well.
  EXPECT_EQ(look_at(falling_ball("acoustic_cfl = 1.3", "max_hardening = 5")).overrides, Lines());
}

TEST(Fast, NothingIsSetWhereNothingIsGained) {
  const forecast::FastLook look =
      look_at(falling_ball("time_step = \"fixed\"\ndt = 1e-4", "hardening = 0"));
  EXPECT_TRUE(look.overrides.empty());
  EXPECT_EQ(look.sentence(), "--fast finds no longer steps for this scene");
}

/// Snow a thousand times as stiff that hardly moves: explicit steps resolve sound that nobody sees.
TEST(Fast, StiffSlowSnowTakesSemiImplicitSteps) {
  const std::string stiff = "youngs_modulus = 1.4e8";
  const forecast::FastLook look = look_at(falling_ball("", stiff, 0.1), {}, 2);
  EXPECT_TRUE(look.is_implicit) << look.sentence();
  EXPECT_EQ(look.overrides[0], "solver.beta=0.5");
  EXPECT_LT(*look.work, 0.3 * *look.work_before);
  const forecast::FastLook kept =
      look_at(falling_ball("beta = 1\nmax_dt = 2e-3", stiff, 0.1), {}, 2);
  EXPECT_TRUE(std::none_of(kept.overrides.begin(), kept.overrides.end(), [](const auto& change) {
    return change.starts_with("solver.");
  })) << kept.sentence();
}

/// A setting is measured with cells four times as large, and told for those of the scene.
TEST(Fast, SettingsThatGrowWithTheCellsAreGivenForThoseOfTheScene) {
  const std::string stiff = "youngs_modulus = 1.4e8";
  const forecast::FastLook look = forecast::fast_look(
      scene::read_scene_text(falling_ball("max_dt = 4e-4", stiff, 0.1), "s.toml"), 2, {}, 4);
  EXPECT_NE(look.sentence().find("solver.max_dt=0.00025"), std::string::npos) << look.sentence();
}

TEST(Fast, WhatFollowsACurveStays) {
  const std::string curve = R"(
[[curve]]
parameter = "material.snow.max_hardening"
keyframes = [{ time = 0, value = 5000 }]
)";
  EXPECT_EQ(look_at(falling_ball("") + curve).overrides, Lines({"solver.acoustic_cfl=0.85"}));
}

/// Snow too soft for its impact: the coarse copy diverges, and a forecast from them would say that
/// nothing is to be done.
TEST(Fast, CopiesThatDivergeForetellNothing) {
  const forecast::FastLook look = look_at(falling_ball("", "", 14));
  EXPECT_FALSE(look.work_before) << *look.work_before;
  EXPECT_EQ(look.sentence().find('%'), std::string::npos) << look.sentence();
}

/// A block between two plates that close.
const std::string closing_plates = R"(
frames = 12
[solver]
cell_size = 0.02
[[body]]
shape = { box = { center = [0, 0.1, 0], size = [0.2, 0.2, 0.2] } }
[[collider]]
shape = { plane = {} }
[[collider]]
shape = { box = { center = [0, 0.25, 0], size = [0.4, 0.1, 0.4] } }
velocity = [0, -0.25, 0]
)";

/// Packed snow carries its load by what it hardens: bounded, a press has a part of its force.
TEST(Fast, TheCeilingOnHardeningIsNotTakenWhereItChangesForces) {
  const forecast::FastLook look = look_at(closing_plates, {}, 12);
  EXPECT_EQ(look.overrides, Lines({"solver.acoustic_cfl=0.85"})) << look.sentence();
  ASSERT_TRUE(look.force_under_cap);
  EXPECT_LT(*look.force_under_cap, -0.1);
  EXPECT_LT(std::abs(look.force_change), 0.1);
  EXPECT_NE(look.sentence().find("max_hardening stays: a ceiling of 20 leaves"), std::string::npos)
      << look.sentence();
}

/// Plates that meet snow at rest: the limits look ahead by the speed of the plate.
TEST(Fast, PlatesOfAnySpeedRun) {
  for (const double speed : {2.0, 10.0, 30.0, 60.0, 80.0}) {
    const std::string text = fmt::format(R"(
frames = 4
fps = {}
[solver]
cell_size = 0.03
[[body]]
shape = {{ box = {{ center = [0, 0.15, 0], size = [0.3, 0.3, 0.3] }} }}
[[collider]]
shape = {{ plane = {{}} }}
[[collider]]
shape = {{ box = {{ center = [-0.3, 0.3, 0], size = [0.2, 0.6, 0.6] }} }}
velocity = [{}, 0, 0]
)",
                                         20 * speed, speed);
    scene::Scene scene = scene::read_scene_text(text, "plate.toml");
    std::vector<scene::Override> changes;
    for (const std::string& change : look_at(text, {}, 4).overrides)
      changes.push_back(scene::parse_override(change));
    scene = scene::read_scene_text(text, "plate.toml", "", changes);
    sim::Simulation simulation =
        setup::make_simulation(scene, setup::seed_scene(scene).particles, 1);
    simulation.advance_to(4 / scene.fps);
    EXPECT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
    EXPECT_GT(simulation.summary().centre_of_mass[0], 0);
  }
}

TEST(Fast, TheChoiceDependsOnTheSceneAlone) {
  const forecast::FastLook a = look_at(falling_ball("")), b = look_at(falling_ball(""));
  EXPECT_EQ(a.overrides, b.overrides);
  EXPECT_EQ(a.work, b.work);
  EXPECT_EQ(a.work_before, b.work_before);
}

TEST(Fast, AJobRecordsTheSettingsLikeThoseOfTheUserWhichWin) {
  const test::TemporaryFolder folder;
  folder.write("ball.toml", falling_ball(""));
  run::RenderOptions options;
  options.scene = (folder / "ball.toml").string();
  options.is_fast = true;
  options.overrides = {"material.snow.max_hardening=7"};
  const run::RenderJob job = run::make_job(options);
  EXPECT_EQ(job.overrides, Lines({"material.snow.max_hardening=7", "solver.acoustic_cfl=0.85"}));
  EXPECT_EQ(job.scene.solver.acoustic_cfl, 0.85);
  EXPECT_EQ(job.scene.materials[0].max_hardening, 7);
  // Settings of the user in a table win too.
  options.overrides = {"solver={ cell_size = 0.03, acoustic_cfl = 0.3 }"};
  EXPECT_EQ(run::make_job(options).scene.solver.acoustic_cfl, 0.3);
}

TEST(Fast, ASweepKeepsWhatItVaries) {
  const test::TemporaryFolder folder;
  folder.write("ball.toml", falling_ball(""));
  sweep::plan::SweepOptions options;
  options.file = (folder / "ball.toml").string();
  options.out = (folder / "out").string();
  options.axes = {"solver.acoustic_cfl=0.3,0.6"};
  options.overrides = {"solver.beta=0"};
  options.is_fast = true;
  const sweep::plan::SweepPlan plan = sweep::plan::plan_sweep(options);
  ASSERT_TRUE(plan.fast);
  EXPECT_EQ(plan.fast->overrides, Lines({"material.snow.max_hardening=20"}));
  ASSERT_EQ(plan.runs.size(), 2u);
  EXPECT_EQ(plan.runs[0].scene.solver.acoustic_cfl, 0.3);
  EXPECT_EQ(plan.runs[1].scene.solver.acoustic_cfl, 0.6);
  for (const sweep::plan::PlannedRun& run : plan.runs)
    EXPECT_EQ(run.scene.materials[0].max_hardening, 20);
  // Transfers are compared in steps that are right for each of them.
  options.axes = {"solver.transfer=flip,apic,asflip"};
  for (const sweep::plan::PlannedRun& run : sweep::plan::plan_sweep(options).runs)
    EXPECT_EQ(run.scene.solver.acoustic_cfl, 0.7);
}

/// The base of this sweep hardens too little for a ceiling to change its force.
TEST(Fast, ASweepTakesNoCeilingThatOneOfItsRunsDoesNotBear) {
  const test::TemporaryFolder folder;
  folder.write("press.toml", closing_plates + "[material.snow]\nhardening = 1\n");
  sweep::plan::SweepOptions options;
  options.file = (folder / "press.toml").string();
  options.out = (folder / "out").string();
  options.axes = {"material.snow.hardening=1,10"};
  options.is_fast = true;
  const sweep::plan::SweepPlan plan = sweep::plan::plan_sweep(options);
  EXPECT_EQ(plan.fast->overrides, Lines({"solver.acoustic_cfl=0.85"}));
  EXPECT_NE(plan.fast->sentence().find("material.snow.max_hardening stays: with "
                                       "material.snow.hardening=10 it would make other snow"),
            std::string::npos)
      << plan.fast->sentence();
}

}  // namespace
}  // namespace neve::app
