/// The readers of the table of laws draw their lines where the table says.

#include "sim/health/limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "app/health/diagnosis.h"
#include "app/health/expected.h"
#include "app/health/findings.h"
#include "app/scene/read.h"
#include "app/setup/seed_scene.h"
#include "sim/checks/watch.h"

namespace neve::app {
namespace {

using sim::health::Law;
using sim::health::limits_of;

/// A snowball above a floor.
scene::Scene ball() {
  return scene::read_scene_text(R"(
[solver]
cell_size = 0.04
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.3, 0], radius = 0.16 } }
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
)",
                                "ball.toml");
}

bool has_finding(const std::vector<health::Finding>& findings, const std::string& address) {
  return std::any_of(findings.begin(), findings.end(),
                     [&](const health::Finding& f) { return f.address == address; });
}

TEST(Limits, LimitsAreThoseOfTheWatch) {
  scene::Scene scene = ball();
  scene.solver.time_step = sim::TimeStep::fixed;
  for (const sim::Precision precision : {sim::Precision::real64, sim::Precision::single}) {
    scene.solver.precision = precision;
    const sim::checks::Watch watch(scene.solver, scene.materials);
    for (const sim::checks::WatchRecord& record : watch.records()) {
      const sim::health::Limits& law = limits_of(record.check);
      const bool is_rounding = precision == sim::Precision::single && !std::isnan(law.watch_single);
      EXPECT_EQ(record.threshold, is_rounding ? law.watch_single : law.watch_warning) << law.name;
      EXPECT_EQ(record.error, is_rounding ? law.watch_single : law.watch_error) << law.name;
    }
  }
}

TEST(Limits, LimitsAreThoseOfTheStopRules) {
  scene::Scene scene = ball();
  scene.solver.time_step = sim::TimeStep::fixed;
  scene.solver.dt = 1;
  sim::Simulation simulation = setup::make_simulation(scene, setup::seed_scene(scene).particles, 1);
  simulation.advance_to(1);
  ASSERT_TRUE(simulation.divergence());
  EXPECT_EQ(simulation.divergence()->rule, limits_of(Law::speed_cfl).name);
  EXPECT_EQ(simulation.divergence()->limit, limits_of(Law::speed_cfl).stop);
}

TEST(Limits, LimitsAreThoseOfTheCheck) {
  scene::Scene scene = ball();
  const auto has_warning = [&](double gravity, double density) {
    scene.solver.gravity = {0, -gravity, 0};
    scene.materials[0].density = density;
    std::vector<health::Finding> findings;
    health::check_units(scene, findings);
    return std::pair(has_finding(findings, "solver.gravity"),
                     has_finding(findings, "material." + scene.materials[0].name + ".density"));
  };
  const double gravity = limits_of(Law::gravity).check_warning;
  const double least = limits_of(Law::low_density).check_warning;
  const double most = limits_of(Law::high_density).check_warning;
  EXPECT_EQ(has_warning(gravity, least), std::pair(false, false));
  EXPECT_EQ(has_warning(1.001 * gravity, most), std::pair(true, false));
  EXPECT_EQ(has_warning(gravity, 0.999 * least), std::pair(false, true));
  EXPECT_EQ(has_warning(gravity, 1.001 * most), std::pair(false, true));
}

TEST(Limits, LimitsAreThoseOfTheDiagnosis) {
  scene::Scene scene = ball();
  sim::Divergence divergence;
  divergence.rule = "time_step";
  divergence.start.max_sound_speed = 20;
  const auto cause_at = [&](double factor) {
    divergence.J_P = 1 - std::log(factor) / scene.materials[0].hardening;
    return health::diagnose(scene, divergence).cause;
  };
  const double line = limits_of(Law::hardening).cause;
  EXPECT_EQ(cause_at(1.001 * line), health::Cause::hardening);
  EXPECT_EQ(cause_at(0.999 * line), health::Cause::unexplained);
}

TEST(Limits, LimitsAreThoseOfDumps) {
  scene::Scene scene = ball();
  scene.materials[0].max_J_P = 1e4;
  const sim::ParticleArrays state =
      setup::make_simulation(scene, setup::seed_scene(scene).particles, 1).particles();
  const health::Expected expected(scene, state, 1e-4);
  EXPECT_EQ(expected.J_P().range.min, limits_of(Law::compaction).expected);
  EXPECT_EQ(expected.J_P().range.max, limits_of(Law::dilation).expected);
  const double full = scene.materials[0].density * std::pow(scene.solver.cell_size, 3);
  EXPECT_DOUBLE_EQ(expected.negligible_mass(), limits_of(Law::light_node).expected * full);
}

}  // namespace
}  // namespace neve::app
