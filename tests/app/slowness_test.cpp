/// What a check says of scenes that take long for a reason.

#include "app/health/slowness.h"

#include <gtest/gtest.h>

#include "app/scene/read.h"
#include "app/support/clock.h"

namespace neve::app {
namespace {

constexpr const char* slow_ball =
    "[[body]]\nname = \"ball\"\nshape = { sphere = { radius = 0.1 } }\n";

/// The note on a ball of 10 000 particles whose run takes so many steps, all of one limit.
std::string note_on(const std::string& more, sim::DtLimit limit, double steps = 1e5,
                    std::vector<health::Finding> findings = {}) {
  const scene::Scene scene = scene::read_scene_text(slow_ball + more, "slow.toml");
  health::Check check;
  check.plan.particles = 1e4;
  check.start.dt.fill(1e-4);
  forecast::FrameForecast frame;
  frame.steps = frame.min_steps = frame.max_steps = steps;
  frame.frame = 1;
  frame.limit = limit;
  frame.iterations = 400;
  check.foreseen.frames = {frame};
  const std::size_t before = findings.size();
  health::check_slowness(scene, check, findings);
  return findings.size() > before ? sentence(findings.back()) : "";
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
  EXPECT_EQ(note_on("[solver]\nbeta = 1\nsolve_tolerance = 1e-9\n", max_dt),
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

}  // namespace
}  // namespace neve::app
