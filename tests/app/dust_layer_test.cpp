/// Dust in scenes, pictures, exports and run.json.

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "app/exports/columns.h"
#include "app/exports/encode.h"
#include "app/health/check.h"
#include "app/health/findings.h"
#include "app/picture/frame_builder.h"
#include "app/record/run_json.h"
#include "app/scene/coarsen.h"
#include "app/scene/read.h"
#include "app/scene/toml/error.h"
#include "app/setup/plan.h"
#include "app/setup/resolve.h"
#include "app/setup/seed_scene.h"

namespace neve::app {
namespace {

constexpr const char* dusty_ball = R"([camera]
eye = [0, 0.5, 2]
target = [0, 0.2, 0]
[material.snow]
preset = "powder"
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.11, 0], radius = 0.1 } }
velocity = [2, -6, 0]
[[collider]]
name = "floor"
shape = { plane = { normal = [0, 1, 0] } }
)";

scene::Scene read_dusty(const std::string& more,
                        const std::vector<scene::Override>& overrides = {}) {
  return scene::read_scene_text(dusty_ball + more, "ball.toml", {}, overrides);
}

std::string dust_error(const std::string& more) {
  try {
    read_dusty(more);
  } catch (const scene::toml::SceneError& error) {
    return error.what();
  }
  return "no error";
}

struct DustyMoment {
  scene::Scene scene;
  setup::SeededScene seeded;
  std::unique_ptr<sim::Simulation> simulation;
};

/// Returns the scene at 1/24 s, after the impact.
DustyMoment after_dusty_impact(scene::Scene scene) {
  DustyMoment moment{std::move(scene), {}, nullptr};
  moment.seeded = setup::seed_scene(moment.scene);
  setup::resolve(moment.scene, moment.seeded.particles.x.size());
  moment.simulation = std::make_unique<sim::Simulation>(moment.scene.solver, moment.scene.materials,
                                                        scene::sim_colliders(moment.scene),
                                                        moment.seeded.particles, 2);
  moment.simulation->advance_to(1.0 / 24);
  return moment;
}

render::Frame dusty_frame(const DustyMoment& moment) {
  const picture::FrameBuilder builder(moment.scene, moment.seeded);
  return builder.build(
      moment.scene.views.front(),
      picture::take_snapshot(moment.scene, moment.scene.views, *moment.simulation, 1));
}

TEST(DustScene, PowderAloneShedsItAndItsSnowIsTheSame) {
  EXPECT_GT(read_dusty("").materials.front().dust, 0);
  EXPECT_EQ(read_dusty("", {{"material.snow.preset", "wet"}}).materials.front().dust, 0);
  EXPECT_EQ(sim::Material{}.dust, 0);
  EXPECT_EQ(read_dusty("", {{"material.snow.dust", "0"}}).materials.front().dust, 0);
  EXPECT_EQ(read_dusty("", {{"material.snow.dust", "0"}}).materials.front().density, 150);
}

TEST(DustScene, TableIsReadAndWrittenAndMistakesAreLocated) {
  const scene::Scene scene = read_dusty("[dust]\nsettling_speed = 0.2\nwind = [1, 0, 2]\n");
  EXPECT_EQ(scene.solver.dust.settling_speed, 0.2);
  EXPECT_EQ(scene.solver.dust.wind, sim::Vec3d(1, 0, 2));
  const scene::Scene again = scene::read_scene_text(scene::write_scene(scene), "again.toml");
  EXPECT_EQ(again.solver.dust.settling_speed, 0.2);
  EXPECT_EQ(again.solver.dust.wind, sim::Vec3d(1, 0, 2));
  EXPECT_EQ(dust_error("[dust]\nlife = -1\n").substr(0, 26), "ball.toml:14:8: error: dus");
  EXPECT_NE(dust_error("[dust]\nlive = 1\n").find("did you mean \"life\"?"), std::string::npos);
  EXPECT_NE(dust_error("[dust]\nparticles = 0\n").find("expected 1 <= value"), std::string::npos)
      << dust_error("[dust]\nparticles = 0\n");
  EXPECT_NE(dust_error("[[view]]\nlayers = [\"smoke\", \"dust\"]\n").find("give each a view"),
            std::string::npos);
}

TEST(DustScene, FindingsSayWhatNobodyWillSee) {
  const auto findings = [](const scene::Scene& scene, double speed) {
    std::vector<health::Finding> found;
    health::check_dust(scene, speed, found);
    std::string text;
    for (const health::Finding& finding : found) text += health::sentence(finding) + "\n";
    return text;
  };
  const scene::Scene shown = read_dusty("[[view]]\nlayers = [\"snow\", \"dust\"]\n");
  EXPECT_EQ(findings(shown, 6).find("no view"), std::string::npos);
  EXPECT_NE(findings(shown, 6).find("100000 particles of dust"), std::string::npos)
      << findings(shown, 6);
  EXPECT_NE(findings(shown, 0.5).find("dust.speed"), std::string::npos);
  EXPECT_NE(findings(read_dusty("[[view]]\nlayers = [\"snow\"]\n"), 6).find("no view"),
            std::string::npos);
  scene::Scene none = shown;
  none.materials.front().dust = 0;
  EXPECT_EQ(findings(none, 6), "");
  scene::Export exported;
  exported.name = "1";
  exported.dust = true;
  none.exports = {exported};
  EXPECT_TRUE(findings(none, 6).starts_with("export.1.dust: its files are empty"))
      << findings(none, 6);
  none.exports.clear();
  none.solver.dust.life = 3;
  EXPECT_NE(findings(none, 6).find("it has no effect"), std::string::npos);
}

/// Keyframes of the dust of snow, for scenes of the tests.
std::string curve_of_dust(double from, double to) {
  return fmt::format(
      "[[curve]]\nparameter = \"material.snow.dust\"\n"
      "keyframes = [{{ time = 0, value = {} }}, {{ time = 0.1, value = {} }}]\n",
      from, to);
}

TEST(DustScene, CurvesMakeAndEndIt) {
  const scene::Override none{"material.snow.dust", "0"};
  const scene::Scene risen = read_dusty(curve_of_dust(0, 0.05), {none}),
                     ended = read_dusty(curve_of_dust(0, 0));
  ASSERT_NE(scene::dusty_material(risen), nullptr);
  EXPECT_EQ(scene::dusty_material(risen)->name, "snow");
  EXPECT_EQ(scene::dusty_material(ended), nullptr) << "what the scene sets is not used";
  EXPECT_EQ(scene::dusty_material(scene::without_dust(risen)), nullptr);
  const auto memory_of = [](const scene::Scene& scene) {
    return setup::make_plan(scene, {0, 12}, setup::Quality::preview, 1).memory;
  };
  EXPECT_EQ(memory_of(risen), memory_of(read_dusty("")));
  EXPECT_EQ(memory_of(ended), memory_of(read_dusty("", {none})));
}

TEST(DustScene, DragOfSprayActsWithoutDust) {
  const std::vector<scene::Override> none{{"material.snow.dust", "0"},
                                          {"solver.cell_size", "0.05"}};
  const scene::Scene dragged =
      read_dusty("[dust]\nspray_drag = 0.15\nwind = [1, 0, 0]\nlife = 3\n", none);
  for (const char* const acts : {"dust.spray_drag", "dust.wind", "dust.air_cell", "dust.speed"})
    EXPECT_EQ(health::why_idle(dragged, acts), "") << acts;
  for (const char* const idle : {"dust.life", "dust.buoyancy", "dust.particles"})
    EXPECT_NE(health::why_idle(dragged, idle), "") << idle;
  const scene::Scene still = read_dusty("", none);
  EXPECT_NE(health::why_idle(still, "dust.wind"), "");
  EXPECT_EQ(health::why_idle(still, "dust.spray_drag"), "") << "above 0 it acts";
  const setup::Plan plan = setup::make_plan(dragged, {0, 12}, setup::Quality::preview, 1),
                    plain = setup::make_plan(still, {0, 12}, setup::Quality::preview, 1);
  EXPECT_GT(plan.memory, plain.memory) << "of the air";
  const health::Check check = health::examine(dragged, plan, 1);
  EXPECT_GE(check.dust_steps, 12);
  std::string text;
  for (const health::Finding& finding : check.findings) text += health::sentence(finding) + "\n";
  EXPECT_EQ(text.find("spray_drag has no effect"), std::string::npos) << text;
  EXPECT_EQ(text.find("wind has no effect"), std::string::npos) << text;
  EXPECT_NE(text.find("life has no effect"), std::string::npos) << text;
}

TEST(DustScene, PlansAndForecastsCountIt) {
  // Large cells: the forecasts of both run in a moment.
  const scene::Override large_cells{"solver.cell_size", "0.05"};
  const scene::Scene dusty = read_dusty("[dust]\nparticles = 50_000\n", {large_cells}),
                     clear = read_dusty("", {large_cells, {"material.snow.dust", "0"}});
  const setup::FrameRange frames{0, 12};
  const setup::Plan with = setup::make_plan(dusty, frames, setup::Quality::preview, 1),
                    without = setup::make_plan(clear, frames, setup::Quality::preview, 1);
  EXPECT_GT(with.memory, without.memory + 50'000 * 80) << "the particles of dust alone";
  // Nothing is faster than it falls: the longest step of dust is 0.05 s, a frame of 1/24 s has one.
  health::Check check;
  check.seconds_per_step = 0.01;
  check.dust_steps = 12;
  EXPECT_NEAR(check.seconds().expected, 1.5 * 12 * 0.01, 1e-9);
  EXPECT_EQ(check.seconds().least, 0) << "it may be that nothing flies";
  EXPECT_GE(health::examine(dusty, with, 1).dust_steps, 12);
  EXPECT_EQ(health::examine(clear, without, 1).dust_steps, 0);
}

TEST(DustLayer, DrawsTheDustAsSmokeWhereAViewShowsIt) {
  const DustyMoment moment =
      after_dusty_impact(read_dusty("[[view]]\nlayers = [\"snow\", \"dust\"]\n"));
  const render::Frame frame = dusty_frame(moment);
  ASSERT_NE(frame.smoke.nodes, nullptr);
  EXPECT_FALSE(frame.points.position.empty());
  double mass = 0, expected = 0;
  for (const float density : frame.smoke.density)
    mass +=
        static_cast<double>(density) * std::pow(static_cast<double>(frame.smoke.nodes->spacing), 3);
  const sim::DustArrays dust = moment.simulation->dust();
  for (const double m : dust.m) expected += m;
  ASSERT_GT(dust.x.size(), 50u);
  EXPECT_NEAR(mass, expected, 1e-4 * expected);
  EXPECT_EQ(
      dusty_frame(after_dusty_impact(read_dusty("[[view]]\nlayers = [\"snow\"]\n"))).smoke.nodes,
      nullptr);
}

TEST(DustExport, HasTheDustInThePlaceOfTheSnow) {
  DustyMoment moment =
      after_dusty_impact(read_dusty("[[export]]\nname = \"cloud\"\nformat = \"ply\"\ndust = true\n"
                                    "[[export]]\nname = \"fog\"\nformat = \"vdb\"\ndust = true\n"
                                    "[[export]]\nname = \"snow\"\nformat = \"ply\"\n"));
  const std::vector<scene::Export>& specs = moment.scene.exports;
  const exports::Origins origins(moment.scene, moment.seeded.body_end);
  const auto state =
      exports::read_state(specs, origins, moment.scene.colliders, *moment.simulation);
  const auto cloud = exports::state_of_dust(*state);
  const exports::Carried carried(moment.scene, moment.seeded.body_end);
  const exports::Table table =
      exports::make_table(moment.scene, specs[0], origins, carried, *cloud);
  EXPECT_EQ(table.rows, moment.simulation->dust().x.size());
  std::vector<std::string> names;
  for (const exports::Column& column : table.columns) names.push_back(column.name);
  EXPECT_EQ(names, (std::vector<std::string>{"id", "x", "v", "m", "radius"}));
  const sim::Vec3d first = moment.simulation->dust().x.front();
  EXPECT_EQ(table.places()[0], first.x());
  EXPECT_EQ(table.places()[1], first.y());
  const std::string fog =
      exports::encode({moment.scene, specs[1], *cloud,
                       exports::make_table(moment.scene, specs[1], origins, carried, *cloud)});
  EXPECT_NE(fog.find("density"), std::string::npos);
  double mass = 0, expected = 0;
  for (const double m : cloud->nodes.at({}).mass) mass += m;
  for (const double m : state->dust.m) expected += m;
  EXPECT_NEAR(mass, expected, 1e-9 * expected);
  EXPECT_EQ(exports::make_table(moment.scene, specs[2], origins, carried, *state).rows,
            moment.seeded.particles.x.size());
}

TEST(DustExport, MistakesAreLocated) {
  const auto with = [](const std::string& keys) {
    return dust_error("[[export]]\nname = \"cloud\"\ndust = true\n" + keys);
  };
  EXPECT_EQ(with("attributes = [\"x\", \"age\"]\n"), "no error");
  EXPECT_NE(with("attributes = [\"x\", \"J_P\"]\n").find("dust has no \"J_P\""), std::string::npos);
  EXPECT_NE(with("surface = true\n").find("dust has no surface"), std::string::npos);
  EXPECT_NE(with("bodies = [\"ball\"]\n").find("dust is of no body"), std::string::npos);
}

TEST(DustRecord, SaysWhatItsMassIsAndReadsBack) {
  const DustyMoment moment = after_dusty_impact(read_dusty(""));
  record::FrameRecord frame;
  frame.summary = moment.simulation->summary();
  const Json json = record::to_json(frame);
  ASSERT_TRUE(json.contains("dust"));
  EXPECT_EQ(json["dust"]["mass_is"], "decoration: taken from no snow");
  EXPECT_EQ(json["dust"]["particles"], moment.simulation->dust().x.size());
  const record::FrameRecord again = record::frame_record(json);
  EXPECT_EQ(again.summary.dust.born, frame.summary.dust.born);
  EXPECT_EQ(again.summary.dust.settled_mass, frame.summary.dust.settled_mass);
  EXPECT_FALSE(record::to_json(record::FrameRecord{}).contains("dust"));
}

}  // namespace
}  // namespace neve::app
