/// run.json: the names that scripts depend on.

#include "app/record/run_json.h"

#include <gtest/gtest.h>

#include <limits>

namespace neve::app {
namespace {

std::vector<std::string> keys(const Json& json) {
  std::vector<std::string> result;
  for (const auto& item : json.items()) result.push_back(item.key());
  return result;
}

TEST(RunJson, RunJsonHasTheFieldsOfTheContract) {
  app::record::RunRecord run;
  run.frames.emplace_back();
  const Json json = app::record::to_json(run);
  for (const char* key : {"version", "scene", "overrides", "backend", "gl_renderer", "threads",
                          "simd", "status", "warnings", "frames"})
    EXPECT_TRUE(json.contains(key)) << key;
  const std::vector<std::string> expected{"frame",
                                          "time",
                                          "steps",
                                          "dt_min",
                                          "dt_max",
                                          "dt_limit",
                                          "solve_iterations",
                                          "solve_residual",
                                          "solves_cut_short",
                                          "solves_given_up",
                                          "seconds_sim",
                                          "seconds_render",
                                          "particles",
                                          "emitted",
                                          "removed",
                                          "withheld",
                                          "grid_blocks",
                                          "mass",
                                          "kinetic_energy",
                                          "elastic_energy",
                                          "momentum",
                                          "centre_of_mass",
                                          "max_speed",
                                          "min_J_P",
                                          "max_J_P",
                                          "denser_than_ice",
                                          "max_depth",
                                          "max_depth_cells",
                                          "spread",
                                          "height",
                                          "mean_J_P",
                                          "fragments",
                                          "largest_fragment",
                                          "powder",
                                          "crumbs",
                                          "forces",
                                          "bodies",
                                          "state_hash"};
  EXPECT_EQ(keys(json["frames"][0]), expected);
}

TEST(RunJson, FrameZeroHasNoSteps) {
  const Json json = app::record::to_json(app::record::FrameRecord{});
  EXPECT_EQ(json["steps"], 0);
  EXPECT_TRUE(json["dt_min"].is_null());
  EXPECT_TRUE(json["dt_max"].is_null());
  EXPECT_TRUE(json["dt_limit"].is_null());
}

TEST(RunJson, RunJsonNamesTheLimitThatRuledMostSteps) {
  app::record::FrameRecord frame;
  frame.advance.steps = 5;
  frame.advance.ruled[static_cast<std::size_t>(sim::DtLimit::cfl)] = 4;
  frame.advance.ruled[static_cast<std::size_t>(sim::DtLimit::frame_end)] = 1;
  EXPECT_EQ(app::record::to_json(frame)["dt_limit"], "cfl");
}

TEST(RunJson, RunJsonWritesNanAsNullAndHashesWithAllDigits) {
  app::record::FrameRecord frame;
  frame.summary.max_speed = std::numeric_limits<double>::quiet_NaN();
  frame.summary.momentum.x() = std::numeric_limits<double>::infinity();
  frame.state_hash = 0xabc;
  const Json json = app::record::to_json(frame);
  EXPECT_TRUE(json["max_speed"].is_null());
  EXPECT_TRUE(json["momentum"][0].is_null());
  EXPECT_EQ(json["state_hash"], "0000000000000abc");
}

/// Slow frames are told, and are no warnings: these mark tiles of sheets, which must not depend on
/// what else the machine does.
TEST(RunJson, SlowFramesAreToldBesideTheWarnings) {
  app::record::RunRecord run;
  EXPECT_TRUE(app::record::to_json(run)["slowdown"].is_null());
  run.slowdown = "frame 5 took 20 s";
  EXPECT_EQ(app::record::to_json(run)["slowdown"], "frame 5 took 20 s");
  EXPECT_TRUE(app::record::to_json(run)["warnings"].empty());
}

TEST(RunJson, RunJsonSurvivesTextThatIsNoUtf8) {
  app::record::RunRecord run;
  run.scene_file = "caf\xe9.toml";
  EXPECT_NO_THROW(to_text(app::record::to_json(run)));
}

/// A resumed run starts from the records of the run before it.
TEST(RunJson, FramesComeBackAsTheyWereWritten) {
  app::record::FrameRecord frame;
  frame.frame = 7;
  frame.time = 7.0 / 24;
  frame.advance.steps = 12;
  frame.advance.dt_min = 1.0 / 3e4;
  frame.advance.dt_max = 2.0 / 3e4;
  frame.advance.ruled[static_cast<std::size_t>(sim::DtLimit::strain)] = 12;
  frame.advance.solve = {50, 0.01, 4, 3, 2};
  frame.seconds_sim = 0.123456789;
  frame.summary.particles = 99;
  frame.summary.kinetic_energy = std::numeric_limits<double>::quiet_NaN();
  frame.summary.momentum = {0.1, 0.2, 0.3};
  frame.state_hash = 0xfedcba9876543210ull;
  const Json json = app::record::to_json(frame);
  EXPECT_EQ(app::record::to_json(app::record::frame_record(parse_json(to_text(json)))), json);
  EXPECT_EQ(app::record::to_json(
                app::record::frame_record(app::record::to_json(app::record::FrameRecord{}))),
            app::record::to_json(app::record::FrameRecord{}));
  const Json advance = app::output::to_json(frame.advance);
  EXPECT_EQ(app::output::to_json(app::output::advance_report(parse_json(to_text(advance)))),
            advance);
  EXPECT_TRUE(app::record::read_frame_records("/nowhere").empty());
}

}  // namespace
}  // namespace neve::app
