/// Findings on scenes that take long for a reason.

#include "app/health/slowness.h"

#include <gtest/gtest.h>

#include <utility>

#include "app/forecast/step_cost.h"
#include "app/scene/read.h"
#include "app/setup/seed_scene.h"
#include "app/support/clock.h"

namespace neve::app {
namespace {

constexpr const char* slow_ball =
    "[[body]]\nname = \"ball\"\nshape = { sphere = { radius = 0.1 } }\n";

/// Returns a check of a ball of 10 000 particles whose first frame takes so many steps, all of one
/// limit, where sound asks for 417 of 1e-4 s.
health::Check check_of(sim::DtLimit limit, double steps) {
  health::Check check;
  check.plan.particles = 1e4;
  check.start.dt.fill(1e-4);
  forecast::FrameForecast frame;
  frame.steps = frame.min_steps = frame.max_steps = steps;
  frame.frame = 1;
  frame.limit = limit;
  check.foreseen.frames = {frame};
  return check;
}

std::string note_on(const std::string& more, const health::Check& check,
                    std::vector<health::Finding> findings = {}) {
  const scene::Scene scene = scene::read_scene_text(slow_ball + more, "slow.toml");
  const std::size_t before = findings.size();
  health::check_slowness(scene, check, findings);
  return findings.size() > before ? sentence(findings.back()) : "";
}

std::string note_on(const std::string& more, sim::DtLimit limit, double steps = 1e5,
                    std::vector<health::Finding> findings = {}) {
  return note_on(more, check_of(limit, steps), std::move(findings));
}

TEST(Slowness, TheParameterThatShortensTheStepsIsNamedWithAValueThatDoesNot) {
  using enum sim::DtLimit;
  EXPECT_EQ(
      note_on("[solver]\nacoustic_cfl = 0.002\n", acoustic),
      "solver.acoustic_cfl: 0.002 makes 250 times the steps of 0.5; solver.acoustic_cfl = 0.5");
  EXPECT_EQ(note_on("[solver]\nmax_dt = 1e-5\n", max_dt),
            "solver.max_dt: 1e-05 makes 100 times the steps of 0.001; solver.max_dt = 0.001");
  EXPECT_EQ(note_on("[solver]\ncfl = 0.01\n", collider),
            "solver.cfl: 0.01 makes 40 times the steps of 0.4; solver.cfl = 0.4");
  EXPECT_EQ(note_on("[solver]\nstrain_limit = 0.03\n", strain),
            "solver.strain_limit: 0.03 makes 10 times the steps of 0.3; solver.strain_limit = 0.3");
  EXPECT_EQ(note_on("[solver]\ntime_step = \"fixed\"\ndt = 1e-6\n", fixed),
            "solver.dt: fixed steps of 1e-06 s are 100 times as many as the limits allow now; "
            "solver.time_step = \"adaptive\"");
  EXPECT_EQ(note_on("[material.snow]\nyoungs_modulus = 1.4e9\n", acoustic),
            "material.snow.youngs_modulus: 1.4e+09 makes sound 100 times as fast as 140000 would, "
            "and steps as much shorter; material.snow.youngs_modulus = 140000");
  EXPECT_EQ(
      note_on("J_P = 0.5\n", acoustic),
      "body.ball.J_P: snow packed to 0.5 makes sound 12.2 times as fast as 1 would, and steps "
      "as much shorter; body.ball.J_P = 1");
  health::Check solved = check_of(max_dt, 1e5);
  solved.foreseen.frames[0].iterations = 400;
  EXPECT_EQ(note_on("[solver]\nbeta = 1\nsolve_tolerance = 1e-9\n", solved),
            "solver.solve_tolerance: solves take 400 iterations to 1e-09; solver.solve_tolerance = "
            "0.01");
  EXPECT_EQ(note_on("particles_per_cell = 80\n", max_dt),
            "body.ball.particles_per_cell: 80 particles per cell take 10 times the work of 8; "
            "body.ball.particles_per_cell = 8");
}

TEST(Slowness, WhatIsShortOrUsualOrNamedAlreadyGetsNoNote) {
  using enum sim::DtLimit;
  const std::string small = "[solver]\nacoustic_cfl = 0.002\n";
  EXPECT_EQ(note_on(small, acoustic, 100), "");
  // It is not what sets the steps.
  EXPECT_EQ(note_on(small, max_dt), "");
  EXPECT_EQ(note_on("[solver]\nacoustic_cfl = 0.25\n", acoustic), "");
  EXPECT_EQ(note_on(small, acoustic, 1e5,
                    {{health::Severity::warning, "solver.acoustic_cfl", "is odd", ""}}),
            "");
}

TEST(Slowness, AVeryLongRunWithoutSuchAParameterIsTold) {
  EXPECT_EQ(note_on("", sim::DtLimit::acoustic, 4e6),
            "solver.cell_size: about 4000000 steps of 10000 particles are a long run; --coarsen 2 "
            "takes about a sixteenth of the work, and is a first look");
}

/// A step of a few particles takes as long as one of some hundred.
TEST(Slowness, ARunOfFewParticlesIsLongByItsSteps) {
  health::Check few = check_of(sim::DtLimit::acoustic, 3e5);
  few.plan.particles = 29;
  EXPECT_EQ(note_on("[solver]\nacoustic_cfl = 0.002\n", few),
            "solver.acoustic_cfl: 0.002 makes 250 times the steps of 0.5; solver.acoustic_cfl = "
            "0.5");
  EXPECT_EQ(note_on("", few), "") << "no reason, and some seconds";
  few.foreseen.frames[0].steps = 2e6;
  EXPECT_EQ(note_on("", few),
            "fps: about 2000000 steps, because 0.0417 s are long for cells of 0.02 m; fps = 240 "
            "shows as many frames of slower motion, in a tenth of the time");
}

TEST(Slowness, WhatMovesSoFastThatItSetsTheStepsIsNamed) {
  using enum sim::DtLimit;
  // 1e5 steps in a 24th of a second are 240 times those of sound; 0.4 of 0.02 m in each is 2e4 m/s.
  const std::string end = " times the steps that sound asks for; at ";
  EXPECT_EQ(note_on("velocity = [0, -20000, 0]\n", cfl),
            "body.ball.velocity: at 2e+04 m/s it crosses a cell in 1e-06 s: 240" + end +
                "83.3 m/s sound sets the steps");
  EXPECT_EQ(note_on("angular_velocity = [0, 200000, 0]\n", strain).substr(0, 21),
            "body.ball.angular_vel");
  const std::string plate =
      "[[collider]]\nname = \"plate\"\nvelocity = [20000, 0, 0]\n"
      "shape = { box = { size = [1, 0.1, 1] } }\n";
  EXPECT_EQ(note_on(plate, collider),
            "collider.plate.velocity: at 2e+04 m/s it crosses a cell in 1e-06 s: 240" + end +
                "83.3 m/s sound sets the steps");
  EXPECT_EQ(note_on("", cfl), "") << "nothing in the scene is as fast";
  EXPECT_EQ(note_on("velocity = [0, -20000, 0]\n", acoustic), "") << "sound sets the steps";
}

/// Snow that bursts, and is not stopped, moves at any speed: what breaks it is the reason.
TEST(Slowness, ACopyThatBreaksARuleAndGoesOnIsNoneOfTheScenesSpeed) {
  health::Check check = check_of(sim::DtLimit::strain, 4e6);
  check.foreseen.ignored = "a copy breaks a rule";
  EXPECT_EQ(note_on("", check), "");
}

/// A copy of a scene that ignores its rules tells which it broke.
TEST(Slowness, ARuleThatACopyIgnoresIsTold) {
  const scene::Scene scene = scene::read_scene_text(
      std::string(slow_ball) +
          "[solver]\nacoustic_cfl = 200\nmax_dt = 0.004\non_divergence = \"ignore\"\n",
      "");
  const forecast::Forecast forecast = forecast::foresee(scene, 500, 1, {5, 1e5, 500});
  EXPECT_EQ(forecast.divergence, "");
  EXPECT_NE(forecast.ignored.find(" m breaks the rule "), std::string::npos) << forecast.ignored;
}

/// A single frame may have more steps than there is time for: its beginning tells them.
TEST(Slowness, AFrameOfManyStepsIsForetoldInTheSecondsThatThereAre) {
  const scene::Scene scene = scene::read_scene_text(
      std::string(slow_ball) + "[material.snow]\nyoungs_modulus = 1e12\n", "");
  const auto start = Clock::now();
  const forecast::Forecast forecast = forecast::foresee(scene, 4000, 1, {0.3, 1e12, 500});
  EXPECT_LT(seconds_since(start), 10) << "of some hours, on a machine that does other work";
  // Sound crosses half a cell of 2 cm in 2e-7 s at 5e4 m/s.
  EXPECT_GT(forecast.steps().expected, 1e5);
}

/// A solve that is given up is followed by up to a thousand explicit steps, and the forecast counts
/// each of them.
TEST(Slowness, AStepOfManyPartsTakesTheTimeOfOnePartEach) {
  const scene::Scene scene = scene::read_scene_text(
      std::string(slow_ball) +
          "velocity = [3, 0, 0]\nangular_velocity = [50, 0, 0]\n[solver]\nbeta = 1\ncell_size = "
          "0.05\n"
          "solve_iterations = 1\nsolve_tolerance = 1e-12\n[material.snow]\nyoungs_modulus = 1e12\n",
      "");
  sim::Simulation simulation = setup::make_simulation(scene, setup::seed_scene(scene).particles, 1);
  const auto start = Clock::now();
  const forecast::StepTime time = forecast::measure_steps(simulation, 1 / scene.fps, {4, 20});
  const double all = seconds_since(start), asked = time.steps;
  ASSERT_GT(static_cast<double>(simulation.steps()), 10 * asked) << "the solves hold";
  // Generous for a noisy clock: without it a step would take ten to a thousand times as long.
  EXPECT_LT(time.seconds * static_cast<double>(simulation.steps()), 3 * all);
}

/// Steps of which a second has room for one or two tell their time, too.
TEST(Slowness, AFewStepsTellTheirTime) {
  const scene::Scene scene = scene::read_scene_text(slow_ball, "");
  for (const int steps : {1, 2, 3}) {
    sim::Simulation simulation =
        setup::make_simulation(scene, setup::seed_scene(scene).particles, 1);
    EXPECT_GT(forecast::measure_steps(simulation, 1 / scene.fps, {steps, 20}).seconds, 0) << steps;
  }
}

/// Spray takes explicit steps off the grid. A solve has all snow on it, with a block for each
/// particle here, so its steps cost many times as much, and a forecast that does not know so takes
/// semi-implicit steps for the faster ones, as it did at impacts of 200 m/s.
TEST(Slowness, SprayIsDearInSemiImplicitStepsAlone) {
  const auto cost = [](const std::string& solver) {
    const scene::Scene scene = scene::read_scene_text(slow_ball + solver, "");
    sim::ParticleArrays spray = setup::seed_scene(scene).particles;
    for (sim::Vec3d& x : spray.x) x *= 1000;
    const sim::Simulation simulation = setup::make_simulation(scene, spray, 1);
    const forecast::Spread spread = forecast::spread_of(simulation, scene.solver);
    EXPECT_NEAR(spread.blocks, 1, 0.01);
    return forecast::cost_of_step(spread);
  };
  // cost_alone and cost_on_grid of step_cost.cpp, beside the particle itself.
  EXPECT_NEAR(cost(""), 4, 0.1);
  EXPECT_NEAR(cost("[solver]\nbeta = 0.5\n"), 61, 1);
}

/// A copy is ended within the frame in which it becomes dearer than it may be.
TEST(Slowness, ACopyThatIsTooDearEndsWithinItsFrame) {
  const scene::Scene scene =
      scene::read_scene_text(std::string(slow_ball) + "[solver]\nbeta = 1\nmax_dt = 1e-5\n", "");
  forecast::ForecastBudget budget{60, 1e12, 500};
  budget.work = 200;
  const auto start = Clock::now();
  const forecast::Forecast forecast = forecast::foresee(scene, 500, 1, budget);
  EXPECT_GT(forecast.work(0, 1).expected, budget.work) << "and it says so";
  EXPECT_GT(forecast.steps().expected, 1000);
  EXPECT_LT(seconds_since(start), 10);
}

}  // namespace
}  // namespace neve::app
