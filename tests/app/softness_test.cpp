/// Soft snow under an impact: it runs, the user is told, and the advised stiffness holds.

#include "app/health/softness.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "app/health/diagnosis.h"
#include "app/run/step_warnings.h"
#include "app/scene/read.h"
#include "app/setup/seed_scene.h"

namespace neve::app {
namespace {

struct Impact {
  double youngs_modulus, hardening, speed;
  const char* contact_at;
};

/// @param shock_viscosity  without it, all of these crush their snow
scene::Scene impact_scene(const Impact& impact, double min_J_P, double shock_viscosity = 0) {
  return scene::read_scene_text(
      fmt::format(R"(
[solver]
cell_size = 0.04
shock_viscosity = {}
contact_at = "{}"
[material.snow]
youngs_modulus = {}
hardening = {}
min_J_P = {}
[[body]]
name = "ball"
shape = {{ sphere = {{ center = [0, 0.18, 0], radius = 0.16 }} }}
velocity = [0, -{}, 0]
[[collider]]
name = "floor"
shape = {{ plane = {{ point = [0, 0.001, 0], normal = [0, 1, 0] }} }}
)",
                  shock_viscosity, impact.contact_at, impact.youngs_modulus, impact.hardening,
                  min_J_P, impact.speed),
      "soft.toml");
}

sim::Simulation run_impact(const scene::Scene& scene) {
  sim::Simulation simulation = setup::make_simulation(scene, setup::seed_scene(scene).particles, 2);
  for (int frame = 1; frame <= 4 && !simulation.divergence(); ++frame)
    simulation.advance_to(frame / 24.0);
  return simulation;
}

const std::vector<Impact>& impacts() {
  static const std::vector<Impact> all{{1e4, 5, 10, "nodes"},     {4.8e4, 2, 20, "nodes"},
                                       {4.8e4, 0, 10, "nodes"},   {1e4, 5, 30, "particles"},
                                       {1e4, 1, 6, "particles"},  {4.8e4, 5, 60, "nodes"},
                                       {2e4, 2, 15, "particles"}, {4.8e4, 5, 30, "nodes"}};
  return all;
}

constexpr double unbounded = 1e-6;

TEST(Softness, ImpactHoldsWithTheStiffnessThatIsAdvised) {
  for (Impact impact : impacts()) {
    SCOPED_TRACE(fmt::format("{} Pa, xi {}, {} m/s, contact at {}", impact.youngs_modulus,
                             impact.hardening, impact.speed, impact.contact_at));
    const scene::Scene scene = impact_scene(impact, unbounded);
    const sim::Simulation crushed = run_impact(scene);
    ASSERT_TRUE(crushed.divergence());
    const sim::Divergence& d = *crushed.divergence();
    ASSERT_EQ(d.rule, "J_P");
    const health::Diagnosis diagnosis = health::diagnose(scene, d);
    EXPECT_TRUE(diagnosis.cause == health::Cause::too_soft ||
                diagnosis.cause == health::Cause::shock)
        << diagnosis.evidence;
    EXPECT_EQ(diagnosis.address, "material.snow.youngs_modulus");
    const double speed = health::load_speed(scene);
    impact.youngs_modulus =
        health::stiffness_that_holds(scene.materials[0], scene.solver, d.J_P, speed);
    EXPECT_NE(diagnosis.remedy.find(
                  fmt::format("material.snow.youngs_modulus = {:.3g}", impact.youngs_modulus)),
              std::string::npos)
        << diagnosis.remedy;
    const sim::Simulation held = run_impact(impact_scene(impact, unbounded));
    EXPECT_FALSE(held.divergence()) << held.divergence()->sentence;
  }
}

TEST(Softness, CrushedSnowRunsOnAndTheRunSaysSo) {
  for (Impact impact : impacts()) {
    SCOPED_TRACE(fmt::format("{} Pa, xi {}, {} m/s, contact at {}", impact.youngs_modulus,
                             impact.hardening, impact.speed, impact.contact_at));
    const scene::Scene scene = impact_scene(impact, sim::Material{}.min_J_P);
    const sim::Simulation crushed = run_impact(scene);
    if (crushed.divergence()) {
      // Too much snow is crushed, and not just an edge.
      EXPECT_EQ(crushed.divergence()->rule, "packed");
      continue;
    }
    const std::vector<std::string> warnings = run::step_warnings(scene, crushed);
    ASSERT_EQ(warnings.size(), 1u);
    impact.youngs_modulus = health::stiffness_that_holds(
        scene.materials[0], scene.solver, crushed.warnings().least_J_P, health::load_speed(scene));
    const std::string advice =
        fmt::format("try material.snow.youngs_modulus = {:.3g}", impact.youngs_modulus);
    EXPECT_NE(warnings[0].find(advice), std::string::npos) << warnings[0];
    const scene::Scene stiffer = impact_scene(impact, sim::Material{}.min_J_P);
    // It may be denser than ice still.
    for (const std::string& warning : run::step_warnings(stiffer, run_impact(stiffer)))
      EXPECT_EQ(warning.find("was packed to J_P"), std::string::npos) << warning;
  }
}

TEST(Softness, SnowDenserThanIceIsSaid) {
  const Impact impact{1e4, 5, 10, "nodes"};
  const auto warnings = [&](double min_J_P) {
    const scene::Scene scene = impact_scene(impact, min_J_P, 1);
    const sim::Simulation dense = run_impact(scene);
    EXPECT_EQ(dense.summary().denser_than_ice > 0, min_J_P < 0.4);
    return run::step_warnings(scene, dense);
  };
  const std::vector<std::string> said = warnings(sim::Material{}.min_J_P);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("% of the snow was packed denser than ice (917 kg/m3)"), std::string::npos)
      << said[0];
  EXPECT_NE(said[0].find("min_J_P = 0.437"), std::string::npos) << said[0];
  EXPECT_TRUE(warnings(0.437).empty());
}

/// No stiffness and no min_J_P helps against the density that the scene gives.
TEST(Softness, SnowThatTheSceneMadeDenserThanIceIsNotCalledTooSoft) {
  scene::Scene scene = impact_scene({1e6, 5, 2, "nodes"}, sim::Material{}.min_J_P);
  scene.materials[0].density = 1000;
  const auto said = health::softness_warning(scene, run_impact(scene));
  ASSERT_TRUE(said);
  EXPECT_NE(said->find("material.snow.density = 1000 kg/m3"), std::string::npos) << *said;
  EXPECT_EQ(said->find("min_J_P"), std::string::npos) << *said;
  EXPECT_EQ(said->find("too soft"), std::string::npos) << *said;
}

TEST(Softness, WhatIsSoftAndNoSnowIsNotCalledTooSoft) {
  const Impact impact{1e4, 5, 10, "nodes"};
  scene::Scene scene = impact_scene(impact, sim::Material{}.min_J_P, 1);
  const scene::Scene other = scene::read_scene_text(R"(
[material.rubber]
model = "neo_hookean"
youngs_modulus = 1e3
[[body]]
shape = { sphere = { center = [0, 1, 0], radius = 0.1 } }
)",
                                                    "rubber.toml");
  scene.materials.push_back(other.materials.back());
  ASSERT_EQ(scene.materials.back().name, "rubber");
  const auto said = health::softness_warning(scene, run_impact(scene));
  ASSERT_TRUE(said);
  EXPECT_NE(said->find("material.snow.youngs_modulus"), std::string::npos) << *said;
}

/// A jet, or a ball, of snow that is packed before it moves.
TEST(Softness, SnowThatBeginsDenserThanIceIsNotCalledSoft) {
  const auto scene_with = [](const char* kind, double J_P) {
    return scene::read_scene_text(fmt::format(R"(
[solver]
cell_size = 0.04
[[{}]]
name = "jet"
shape = {{ sphere = {{ center = [0, 0.5, 0], radius = 0.08 }} }}
velocity = [0, -2, 0]
J_P = {}
[[collider]]
shape = {{ plane = {{ point = [0, 0, 0], normal = [0, 1, 0] }} }}
)",
                                              kind, J_P),
                                  "jet.toml");
  };
  for (const std::string kind : {"emitter", "body"}) {
    const scene::Scene dense = scene_with(kind.c_str(), 0.25);
    sim::Simulation simulation =
        setup::make_simulation(dense, setup::seed_scene(dense).particles, 2);
    simulation.advance_to(0.01);
    const auto said = health::softness_warning(dense, simulation);
    ASSERT_TRUE(said);
    EXPECT_EQ(*said, kind +
                         ".jet.J_P = 0.25 packs snow to 1.6e+03 kg/m3 before it moves, denser than "
                         "ice (917 kg/m3); try " +
                         kind + ".jet.J_P = 1, snow that is not packed, or 0.437 at least");
    const scene::Scene denser = scene_with(kind.c_str(), 0.1);
    const sim::Simulation stopped = run_impact(denser);
    ASSERT_TRUE(stopped.divergence());
    const health::Diagnosis diagnosis = health::diagnose(denser, *stopped.divergence());
    EXPECT_EQ(diagnosis.cause, health::Cause::initial_state) << diagnosis.evidence;
    EXPECT_EQ(diagnosis.address, kind + ".jet.J_P");
    EXPECT_NE(diagnosis.evidence.find("packs snow to 4e+03 kg/m3 before it moves"),
              std::string::npos)
        << diagnosis.evidence;
    EXPECT_FALSE(health::dense_birth(scene_with(kind.c_str(), 0.5)));
  }
}

}  // namespace
}  // namespace neve::app
