/// Scenes that go wrong, each for one known reason, and whether the report names it.

#include "app/health/diagnosis.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "app/health/incident.h"
#include "app/scene/read.h"
#include "app/scene/toml/error.h"
#include "app/setup/resolve.h"
#include "app/setup/seed_scene.h"
#include "sim/retry.h"

namespace neve::app {
namespace {

/// A snowball of some 2000 particles that falls on a floor. Held nodes, a little below the surface
/// of the floor, make the hardest impact.
constexpr const char* base = R"(
[solver]
cell_size = 0.04
contact_at = "nodes"
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.3, 0], radius = 0.16 } }
velocity = [0, -3, 0]
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0.001, 0], normal = [0, 1, 0] } }
)";

constexpr const char* press = R"(
[[collider]]
name = "press"
shape = { plane = { point = [0, 0.5, 0], normal = [0, -1, 0] } }
velocity = [0, -8, 0]
)";

constexpr const char* bullet = R"(
[[collider]]
name = "bullet"
shape = { sphere = { center = [-0.9, 0.3, 0], radius = 0.1 } }
velocity = [800, 0, 0]
)";

/// A collider that is at rest again, beyond the snow, when the snow breaks.
constexpr const char* flash = R"(
[[collider]]
name = "flash"
shape = { box = { center = [0, -1, 0], size = [1, 0.1, 1] } }
keyframes = [{ time = 0 }, { time = 0.001, position = [0, 1, 0] }]
)";

struct Fault {
  const char* what;
  app::health::Cause cause;
  std::vector<const char*> changes;  ///< as for --set
  const char* more = "";             ///< appended to the scene
  const char* proof = "";            ///< what the evidence has to mention
};

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all = {
      {"a step per frame",
       app::health::Cause::time_step,
       {"solver.time_step=\"fixed\"", "solver.dt=0.0416"},
       "",
       "cells in a step"},
      {"a body too quick for its fixed step",
       app::health::Cause::time_step,
       {"solver.time_step=\"fixed\"", "solver.dt=4e-4", "body.ball.velocity=[300,0,0]"},
       "",
       "300 m/s"},
      {"stiffness in kPa taken for Pa twice",
       app::health::Cause::stiffness,
       {"solver.time_step=\"fixed\"", "solver.dt=1e-3", "material.snow.youngs_modulus=1.4e8"},
       "",
       "youngs_modulus is 1.4e+08"},
      {"density in g/cm3",
       app::health::Cause::density,
       {"solver.time_step=\"fixed\"", "solver.dt=1e-3", "material.snow.density=0.4"},
       "",
       "density is 0.4"},
      {"centimetres, adaptive steps",
       app::health::Cause::units,
       {"solver.cell_size=4", "solver.gravity=[0,-981,0]", "material.snow.min_J_P=1e-3",
        "body.ball.shape.sphere.radius=16", "body.ball.shape.sphere.center=[0,60,0]",
        "body.ball.velocity=[0,0,0]", "solver.shock_viscosity=0"},
       "",
       "centimetres"},
      {"acoustic limit raised",
       app::health::Cause::raised_limits,
       {"solver.acoustic_cfl=8"},
       "",
       "solver.acoustic_cfl = 8"},
      {"an elastic body whose steps are a little too long",
       app::health::Cause::raised_limits,
       {"solver.kernel=\"quadratic\"", "solver.acoustic_cfl=0.8",
        "material.snow.model=\"corotated\"", "material.snow.poisson_ratio=0.4",
        "body.ball.particles_per_cell=1"},
       "",
       "solver.acoustic_cfl = 0.8 is above the default"},
      {"speed limit raised",
       app::health::Cause::raised_limits,
       {"solver.cfl=20", "solver.acoustic_cfl=50", "body.ball.velocity=[0,-60,0]"},
       "",
       "is above the stable value"},
      {"snow that hardens too fast for a fixed step",
       app::health::Cause::hardening,
       {"solver.time_step=\"fixed\"", "solver.dt=1e-3", "solver.transfer=\"flip\"",
        "material.snow.hardening=30"},
       "",
       "hardened"},
      {"the same with a longer step",
       app::health::Cause::hardening,
       {"solver.time_step=\"fixed\"", "solver.dt=1.1e-3", "material.snow.hardening=30"},
       "",
       "J_P"},
      {"a press that leaves no room",
       app::health::Cause::colliders_closing,
       {},
       press,
       "floor and press"},
      {"a press with fixed steps",
       app::health::Cause::colliders_closing,
       {"solver.time_step=\"fixed\"", "solver.dt=2e-5", "material.snow.hardening=2"},
       press,
       "floor and press"},
      {"a bullet",
       app::health::Cause::collider_speed,
       {"solver.time_step=\"fixed\"", "solver.dt=1e-3"},
       bullet,
       "bullet hits the snow at 800 m/s"},
      {"a bullet with fixed steps",
       app::health::Cause::collider_speed,
       {"solver.time_step=\"fixed\"", "solver.dt=5e-4"},
       bullet,
       "bullet"},
      {"a plate at the speed of a bullet",
       app::health::Cause::collider_speed,
       {"solver.time_step=\"fixed\"", "solver.dt=1e-4"},
       flash,
       "collider flash hits"},
      {"an impact at twenty times the speed of sound",
       app::health::Cause::shock,
       {"body.ball.velocity=[0,-400,0]", "material.snow.min_J_P=1e-3"},
       "",
       "times the speed of its sound"},
      {"snow too soft for its impact",
       app::health::Cause::too_soft,
       {"material.snow.youngs_modulus=4.8e4", "material.snow.hardening=2",
        "material.snow.min_J_P=1e-3", "body.ball.velocity=[0,-12,0]", "solver.shock_viscosity=0"},
       "",
       "too soft for its impact at 12"},
      {"next to incompressible",
       app::health::Cause::incompressible,
       {"material.snow.poisson_ratio=0.49999"},
       "",
       "poisson_ratio"},
      {"slippery snow that packs where it is sheared",
       app::health::Cause::law,
       {"material.snow.model=\"cam_clay\"", "material.snow.friction_angle=1e-5",
        "material.snow.consolidation_pressure=3e4", "solver.gravity=[0,0,0]",
        "body.ball.velocity=[0,0,0]", "body.ball.angular_velocity=[0,3,0]"},
       "",
       "makes energy out of nothing"},
      {"snow of steel in single precision",
       app::health::Cause::rounding,
       {"material.snow.model=\"neo_hookean\"", "material.snow.youngs_modulus=1e10",
        "body.ball.shape.sphere.radius=0.06", "body.ball.velocity=[0,0,0]",
        "body.ball.angular_velocity=[0,0.1,0]", "solver.gravity=[0,0,0]",
        "solver.precision=\"float\""},
       "",
       "single precision knows F_E"},
      {"flight beyond the lattice",
       app::health::Cause::far_flight,
       {"solver.cell_size=0.04", "body.ball.velocity=[-100,0,0]",
        "body.ball.shape.sphere.center=[-167770,0.3,0]"},
       "",
       "where the lattice ends"},
  };
  return all;
}

const Fault& fault(const std::string& what) {
  for (const Fault& fault : faults())
    if (fault.what == what) return fault;
  throw std::logic_error("there is no such fault: " + what);
}

app::scene::Scene scene_of(const Fault& fault) {
  std::vector<app::scene::Override> changes;
  for (const char* change : fault.changes) changes.push_back(app::scene::parse_override(change));
  return app::scene::read_scene_text(std::string(base) + fault.more, "fault.toml", {}, changes);
}

/// Runs the scene for a second, or until it diverges.
sim::Simulation run(const app::scene::Scene& scene, sim::ParticleArrays particles) {
  sim::Simulation simulation(scene.solver, scene.materials, app::scene::sim_colliders(scene),
                             particles);
  for (int frame = 1; frame <= 24 && !simulation.divergence(); ++frame)
    simulation.advance_to(frame / 24.0);
  return simulation;
}

TEST(Diagnosis, DiagnosisNamesTheCauseOfEachFault) {
  for (const Fault& fault : faults()) {
    SCOPED_TRACE(fault.what);
    app::scene::Scene scene = scene_of(fault);
    const sim::Simulation simulation = run(scene, app::setup::seed_scene(scene).particles);
    ASSERT_TRUE(simulation.divergence());
    const app::health::Diagnosis diagnosis = app::health::diagnose(scene, *simulation.divergence());
    EXPECT_STREQ(app::scene::name(diagnosis.cause), app::scene::name(fault.cause))
        << app::health::sentence(*simulation.divergence(), diagnosis);
    EXPECT_NE(diagnosis.evidence.find(fault.proof), std::string::npos) << diagnosis.evidence;
    EXPECT_FALSE(diagnosis.remedy.empty());
  }
}

/// Only the number that looks like centimetres is named, and not the other one beside it.
TEST(Diagnosis, UnitsAreNamedByTheNumberThatIsStrange) {
  const auto evidence = [](const std::vector<std::string>& changes) {
    sim::Divergence divergence;
    divergence.rule = "not_finite";
    const app::scene::Scene scene =
        app::scene::read_scene_text(base, "fault.toml", {}, app::scene::parse_overrides(changes));
    const app::health::Diagnosis diagnosis = app::health::diagnose(scene, divergence);
    return diagnosis.address + ": " + diagnosis.evidence;
  };
  const std::string strong = evidence({"solver.gravity=[0,-981,0]"}),
                    large = evidence({"body.ball.shape.sphere.radius=16"}),
                    both =
                        evidence({"solver.gravity=[0,-981,0]", "body.ball.shape.sphere.radius=16"});
  EXPECT_TRUE(strong.starts_with("solver.gravity: gravity of 981 m/s2 looks like centimetres"))
      << strong;
  EXPECT_TRUE(large.starts_with("body.ball.shape: a body 32 m across looks like centimetres"))
      << large;
  EXPECT_TRUE(both.starts_with(
      "solver.gravity: gravity of 981 m/s2 and a body 32 m across look like centimetres"))
      << both;
}

/// States that no scene can ask for, as from a damaged file.
TEST(Diagnosis, DiagnosisNamesFaultsBeforeTheFirstStep) {
  const app::scene::Scene scene = app::scene::read_scene_text(base, "fault.toml");
  const auto cause_with = [&](auto&& damage) {
    sim::ParticleArrays particles = app::setup::seed_scene(scene).particles;
    particles.F_E.assign(particles.x.size(), sim::Mat3d::Identity());
    particles.J_P.assign(particles.x.size(), 1);
    damage(particles);
    const sim::Simulation simulation = run(scene, particles);
    EXPECT_TRUE(simulation.divergence());
    return simulation.divergence() ? app::health::diagnose(scene, *simulation.divergence())
                                   : app::health::Diagnosis{};
  };
  const app::health::Diagnosis zero_F = cause_with(
      [](sim::ParticleArrays& p) { p.F_E.assign(p.x.size(), 1e-3 * sim::Mat3d::Identity()); });
  EXPECT_EQ(zero_F.cause, app::health::Cause::initial_state) << zero_F.evidence;
  EXPECT_NE(zero_F.evidence.find("det F_E"), std::string::npos);
  const app::health::Diagnosis zero_J = cause_with([](sim::ParticleArrays& p) { p.J_P[7] = 0.05; });
  EXPECT_EQ(zero_J.cause, app::health::Cause::initial_state) << zero_J.evidence;
  EXPECT_NE(zero_J.evidence.find("particle 7"), std::string::npos) << zero_J.evidence;
  const app::health::Diagnosis nan = cause_with(
      [](sim::ParticleArrays& p) { p.v[9][1] = std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_EQ(nan.cause, app::health::Cause::initial_state) << nan.evidence;
  EXPECT_NE(nan.evidence.find("particle 9"), std::string::npos) << nan.evidence;
}

/// The law of energy knows no particle, so no material either.
TEST(Diagnosis, AnyMaterialMayMakeEnergy) {
  const app::scene::Scene scene = app::scene::read_scene_text(
      std::string(base) +
          "[material.gel]\npoisson_ratio = 0.4999995\n[material.unused]\npoisson_ratio = "
          "0.4999999\n"
          "[[body]]\nmaterial = \"gel\"\nshape = { box = { center = [3, 1, 0], size = [0.2, 0.2, "
          "0.2] } }\n",
      "two.toml");
  sim::Divergence d;
  d.rule = "energy";
  const app::health::Diagnosis diagnosis = app::health::diagnose(scene, d);
  EXPECT_EQ(diagnosis.cause, app::health::Cause::incompressible) << diagnosis.evidence;
  EXPECT_EQ(diagnosis.address, "material.gel.poisson_ratio");
}

/// Nothing crushes rubber: the law of energy ends its run, and knows no particle. A stiffer body
/// elsewhere hides nothing.
TEST(Diagnosis, RubberThatHitsFasterThanItsSoundIsNamed) {
  const auto diagnosis_of = [](const std::string& model, double speed) {
    const app::scene::Scene scene = app::scene::read_scene_text(
        "[material.stone]\nyoungs_modulus = 1e7\n[material.soft]\nyoungs_modulus = 1e5\n"
        "model = \"" +
            model + "\"\n[[body]]\nname = \"rubber\"\nmaterial = \"soft\"\n" +
            fmt::format("velocity = [0, -{}, 0]\n", speed) +
            "shape = { sphere = { center = [0, 0.5, 0], radius = 0.3 } }\n"
            "[[body]]\nname = \"far\"\nmaterial = \"stone\"\n"
            "shape = { sphere = { center = [3, 0.5, 0], radius = 0.3 } }\n"
            "[[collider]]\nshape = { plane = {} }\n",
        "soft.toml");
    sim::Divergence d;
    d.rule = "energy";
    for (const sim::Material& material : scene.materials)
      d.start.max_sound_speed = std::max(d.start.max_sound_speed, sim::sound_speed(material));
    return app::health::diagnose(scene, d);
  };
  const app::health::Diagnosis fast = diagnosis_of("neo_hookean", 40);
  EXPECT_EQ(fast.cause, app::health::Cause::shock) << fast.evidence;
  EXPECT_EQ(fast.address, "material.soft.youngs_modulus");
  EXPECT_NE(fast.evidence.find("body.rubber hits something at 40"), std::string::npos)
      << fast.evidence;
  EXPECT_NE(diagnosis_of("neo_hookean", 4).cause, app::health::Cause::shock);
  EXPECT_NE(diagnosis_of("snow", 40).cause, app::health::Cause::shock);
}

/// The body that the grid resolves least is named if no other cause shows.
TEST(Diagnosis, ABodyOfACellMakesEnergy) {
  const auto diagnosis_of = [](const std::string& radius) {
    const app::scene::Scene scene = app::scene::read_scene_text(
        std::string(base) +
            "[[body]]\nname = \"pea\"\nshape = { sphere = { center = [1, 1, 0], radius = " +
            radius + " } }\n",
        "pea.toml");
    sim::Divergence d;
    d.rule = "energy";
    return app::health::diagnose(scene, d, 1.5);
  };
  const app::health::Diagnosis thin = diagnosis_of("0.03");
  EXPECT_EQ(thin.cause, app::health::Cause::thin) << thin.evidence;
  EXPECT_NE(thin.evidence.find("pea is 1.5 cells thick"), std::string::npos) << thin.evidence;
  EXPECT_EQ(diagnosis_of("0.09").cause, app::health::Cause::unexplained);
}

/// Adaptive steps shrink with hardening for hours before a rule breaks; the end is made up here.
TEST(Diagnosis, DiagnosisNamesHardeningOfAdaptiveSteps) {
  const app::scene::Scene scene = app::scene::read_scene_text(base, "fault.toml");
  sim::Divergence d;
  d.rule = "time_step";
  d.J_P = 0.4;
  d.start.max_speed = 3;
  d.start.max_sound_speed = 20;
  const app::health::Diagnosis diagnosis = app::health::diagnose(scene, d);
  EXPECT_EQ(diagnosis.cause, app::health::Cause::hardening) << diagnosis.evidence;
  EXPECT_NE(diagnosis.evidence.find("403 times"), std::string::npos) << diagnosis.evidence;
  d.rule = "energy";
  EXPECT_EQ(app::health::diagnose(scene, d).cause, app::health::Cause::unexplained);
}

/// Soft snow that hardens much: a step that was right for the sound before it packs it too far.
TEST(Diagnosis, DiagnosisNamesAStepThatHardenedSnow) {
  const app::scene::Scene scene = app::scene::read_scene_text(base, "fault.toml");
  sim::Divergence d;
  d.rule = "acoustic_cfl";
  d.J_P = 0.9;
  d.dt = 1e-3;
  d.sound_speed = 70;
  d.start.max_speed = 3;
  d.start.max_sound_speed = 20;
  d.last_steps.resize(2);
  d.last_steps[0].max_sound_speed = 14;
  const app::health::Diagnosis diagnosis = app::health::diagnose(scene, d);
  EXPECT_EQ(diagnosis.cause, app::health::Cause::hardening) << diagnosis.evidence;
  EXPECT_NE(diagnosis.evidence.find("its sound became 5 times as fast with hardening = 10"),
            std::string::npos)
      << diagnosis.evidence;
  EXPECT_NE(diagnosis.remedy.find("solver.on_divergence = \"retry\""), std::string::npos);
  d.sound_speed = 20;
  EXPECT_NE(app::health::diagnose(scene, d).cause, app::health::Cause::hardening);
}

TEST(Diagnosis, DiagnosisKeepsTheLastStepsInOrder) {
  const app::scene::Scene scene = scene_of(fault("acoustic limit raised"));
  const sim::Simulation simulation = run(scene, app::setup::seed_scene(scene).particles);
  ASSERT_TRUE(simulation.divergence());
  const sim::Divergence& d = *simulation.divergence();
  ASSERT_GT(d.last_steps.size(), 10u);
  for (std::size_t k = 1; k < d.last_steps.size(); ++k)
    EXPECT_EQ(d.last_steps[k].step, d.last_steps[k - 1].step + 1);
  EXPECT_EQ(d.last_steps.back().step, d.step);
  EXPECT_DOUBLE_EQ(d.last_steps.back().dt, d.dt);
  EXPECT_GT(d.sound_speed, 0);
  EXPECT_GT(d.kirchhoff.norm(), 0);
  const Json json =
      app::health::incident_json(d, app::health::diagnose(scene, d), "", scene.solver.cell_size);
  EXPECT_EQ(json["cause"], "raised_limits");
  EXPECT_EQ(json["last_steps"].size(), d.last_steps.size());
  EXPECT_GT(json["last_steps"].back()["acoustic_cfl"].get<double>(), 1.5);
}

/// Half of a step that is just too long holds; the frames that follow may be as they were.
TEST(Retry, RetryContinuesWithHalfTheStepIfThatHolds) {
  app::scene::Scene scene = scene_of(fault("the same with a longer step"));
  const sim::ParticleArrays particles = app::setup::seed_scene(scene).particles;
  sim::Simulation simulation(scene.solver, scene.materials, app::scene::sim_colliders(scene),
                             particles);
  std::vector<sim::Retry> retries;
  int frames = 0;
  for (; frames < 4 && !simulation.divergence(); ++frames)
    sim::advance_retrying(simulation, (frames + 1) / 24.0, nullptr, retries);
  EXPECT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
  EXPECT_DOUBLE_EQ(simulation.time(), 4 / 24.0);
  ASSERT_FALSE(retries.empty());
  EXPECT_EQ(retries[0].dt_scale, 0.5);
  EXPECT_LT(retries[0].back_to, retries[0].time);
  EXPECT_FALSE(retries[0].rule.empty());
}

TEST(Retry, RetryGivesUpIfNoStepHelps) {
  const app::scene::Scene scene = app::scene::read_scene_text(base, "fault.toml");
  sim::ParticleArrays particles = app::setup::seed_scene(scene).particles;
  particles.J_P.assign(particles.x.size(), 1);
  particles.J_P[7] = 0.05;
  sim::Simulation simulation(scene.solver, scene.materials, app::scene::sim_colliders(scene),
                             particles);
  std::vector<sim::Retry> retries;
  sim::advance_retrying(simulation, 1 / 24.0, nullptr, retries);
  ASSERT_TRUE(simulation.divergence());
  EXPECT_EQ(simulation.divergence()->rule, "J_P");
  EXPECT_EQ(retries.size(), static_cast<std::size_t>(sim::max_retries));
  EXPECT_EQ(simulation.dt_scale(), std::pow(0.5, sim::max_retries));
}

int polls = 0;

/// An interrupted frame saves its beginning, so a resumed run repeats it.
TEST(Retry, AnInterruptedFrameStartsAgain) {
  app::scene::Scene scene = scene_of(fault("the same with a longer step"));
  const sim::ParticleArrays particles = app::setup::seed_scene(scene).particles;
  const auto make = [&] {
    return sim::Simulation(scene.solver, scene.materials, app::scene::sim_colliders(scene),
                           particles);
  };
  std::vector<sim::Retry> whole, cut;
  sim::Simulation reference = make();
  for (int frame = 1; frame <= 3; ++frame)
    sim::advance_retrying(reference, frame / 24.0, nullptr, whole);
  for (const int after : {3, 20, 40, 70}) {
    sim::Simulation first = make();
    polls = after;
    cut.clear();
    for (int frame = 1; frame <= 3 && polls > 0; ++frame)
      sim::advance_retrying(
          first, frame / 24.0, [] { return --polls <= 0; }, cut);
    sim::Simulation second = make();
    second.restore(first.save());
    for (int frame = static_cast<int>(std::lround(second.time() * 24)) + 1; frame <= 3; ++frame)
      sim::advance_retrying(second, frame / 24.0, nullptr, cut);
    EXPECT_EQ(second.state_hash(), reference.state_hash()) << after;
    EXPECT_EQ(cut.size(), whole.size()) << after;
  }
}

}  // namespace
}  // namespace neve::app
