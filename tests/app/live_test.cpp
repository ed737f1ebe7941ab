/// neve view --live: cells that keep up with the clock.
#include "app/predict/live.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/scene/read.h"

namespace neve::app::predict {
namespace {

/// A ball of about 3500 particles.
scene::Scene ball() {
  return scene::read_scene_text(
      "frames = 2\n[solver]\ncell_size = 0.02\n"
      "[[body]]\nshape = { sphere = { center = [0, 0.1, 0], radius = 0.1 } }\n"
      "[[collider]]\nshape = { plane = { normal = [0, 1, 0] } }\n",
      "ball.toml");
}

/// A machine on which a second of the scene as it is takes so many, and the law of the fourth power
/// holds down to what a step costs at least.
Pace machine(double seconds, double least = 0) {
  return [=](const scene::Scene& scene) {
    return std::max(least, seconds * std::pow(0.02 / scene.solver.cell_size, 4));
  };
}

TEST(Live, ASceneThatKeepsUpStaysAsItIs) {
  const LiveChoice choice = choose_live(ball(), 2, {}, machine(0.2));
  EXPECT_EQ(choice.coarsening, 1);
  EXPECT_FALSE(choice.fast);
  EXPECT_EQ(choice.sentence(),
            "the scene as it is: a second of the film takes about 0.2 s on this machine");
}

TEST(Live, CellsGrowUntilTheClockIsMetAndNoFurther) {
  const LiveChoice choice = choose_live(ball(), 2, {}, machine(20));
  EXPECT_TRUE(choice.keeps_up());
  EXPECT_LE(choice.pace, LiveChoice::room);
  EXPECT_GT(choice.coarsening, 1);
  EXPECT_GT(machine(20)(ball()) * std::pow(choice.coarsening - 0.25, -4), LiveChoice::room)
      << "a quarter finer would not do";
  EXPECT_NE(choice.sentence().find("--coarsen "), std::string::npos) << choice.sentence();
}

TEST(Live, AFirstMeasureThatWasTooSlowMakesNoCoarserSnow) {
  int looks = 0;
  const Pace busy_at_first = [&](const scene::Scene& scene) {
    return (looks++ == 0 ? 20 : 1) * machine(20)(scene);
  };
  EXPECT_EQ(choose_live(ball(), 2, {}, busy_at_first).coarsening,
            choose_live(ball(), 2, {}, machine(20)).coarsening);
}

TEST(Live, WhatCannotKeepUpIsSaid) {
  const LiveChoice slow = choose_live(ball(), 2, {}, machine(1e6, 3));
  EXPECT_FALSE(slow.keeps_up());
  EXPECT_LE(slow.coarsening, 6);
  EXPECT_NE(slow.sentence().find("does not keep up"), std::string::npos) << slow.sentence();
}

}  // namespace
}  // namespace neve::app::predict
