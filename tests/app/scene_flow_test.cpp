/// Emitters, sinks and uneven snow in scenes: read, checked, planned, seeded and drawn.

#include <gtest/gtest.h>

#include "app/health/findings.h"
#include "app/picture/frame_builder.h"
#include "app/record/metrics.h"
#include "app/scene/override.h"
#include "app/scene/read.h"
#include "app/scene/toml/error.h"
#include "app/setup/auto_ranges.h"
#include "app/setup/coarse_run.h"
#include "app/setup/plan.h"
#include "app/setup/resolve.h"
#include "app/setup/seed_scene.h"
#include "app/setup/snow_pieces.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

const std::string spout = R"(
[[emitter]]
name = "spout"
shape = { box = { center = [0, 1, 0], size = [0.2, 0.04, 0.2] } }
velocity = [0, -2, 0]
rate = 20
)";

app::scene::Scene flow_scene(const std::string& text,
                             const std::vector<app::scene::Override>& overrides = {}) {
  return app::scene::read_scene_text(text, "scene.toml", "", overrides);
}

std::string flow_error(const std::string& text) {
  try {
    flow_scene(text);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(SceneFlow, AnEmitterIsEnoughOfAScene) {
  const app::scene::Scene scene = flow_scene(spout + "end = 0.5\n");
  ASSERT_EQ(scene.emitters.size(), 1u);
  const sim::seeding::Emitter& e = scene.emitters[0];
  EXPECT_EQ(e.name, "spout");
  EXPECT_EQ(e.material, "snow");
  EXPECT_EQ(e.rate, 20);
  EXPECT_EQ(e.end, 0.5);
  EXPECT_EQ(
      flow_scene(spout, {app::scene::parse_override("emitter.spout.end=none")}).emitters[0].end,
      std::nullopt);
}

TEST(SceneFlow, MistakesAreLocated) {
  EXPECT_NE(flow_error("title = \"x\"\n").find("no body and no emitter"), std::string::npos);
  const std::string late = flow_error(spout + "start = 1\nend = 0.5\n");
  EXPECT_NE(late.find("scene.toml:8"), std::string::npos) << late;
  EXPECT_NE(late.find("it closes at 0.5 s and opens at 1 s"), std::string::npos) << late;
  const std::string sand = flow_error(spout + "material = \"snwo\"\n");
  EXPECT_NE(sand.find("did you mean \"snow\"?"), std::string::npos) << sand;
  const std::string plane = flow_error(spout + "[[sink]]\nshape = { plane = {} }\n");
  EXPECT_NE(plane.find("plane"), std::string::npos) << plane;
  EXPECT_NE(flow_error(spout + "rat = 3\n").find("did you mean \"rate\"?"), std::string::npos);
}

TEST(SceneFlow, ThePlanCountsFutureParticles) {
  app::scene::Scene scene = flow_scene(spout);
  const double share = 400 * std::pow(scene.solver.cell_size, 3) / 8;
  const app::setup::Plan plan =
      app::setup::make_plan(scene, {0, 12}, app::setup::Quality::preview, 1);
  EXPECT_NEAR(plan.emitted, 20 * 12 / scene.fps / share, 1);
  EXPECT_NEAR(plan.volume, 20 * 12 / scene.fps / 400, 1e-4);
  scene.limits.particles = 100;
  EXPECT_THROW(app::setup::check_limits(
                   scene, app::setup::make_plan(scene, {0, 12}, app::setup::Quality::preview, 1)),
               std::exception);
}

TEST(SceneFlow, CamerasAndRangesKnowWhereSnowWillBe) {
  app::scene::Scene scene = flow_scene(spout + "[[collider]]\nshape = { plane = {} }\n");
  // Falls 1 m from 2 m/s.
  EXPECT_NEAR(app::setup::impact_speed(scene), std::sqrt(4 + 2 * 9.81), 1e-6);
  const std::vector<app::setup::CoarseMoment> moments = app::setup::coarse_run(scene);
  ASSERT_FALSE(moments.empty());
  double lowest = 1;
  for (const app::setup::CoarseMoment& moment : moments)
    for (const sim::Vec3d& x : moment.x) lowest = std::min(lowest, x.y());
  EXPECT_LT(lowest, 0.2) << "the coarse copy's snow reaches the floor";
  app::setup::resolve(scene, 1000);
  ASSERT_TRUE(scene.camera && scene.camera->eye);
}

TEST(SceneFlow, AMomentWithoutParticlesIsDrawnAndMeasured) {
  app::scene::Scene scene = flow_scene(spout);
  app::setup::resolve(scene, 1000);
  const sim::Simulation simulation = app::setup::make_simulation(scene, {}, 1);
  const app::picture::Snapshot snapshot =
      app::picture::take_snapshot(scene, scene.views, simulation, 0);
  const app::setup::SeededScene seeded;
  const app::picture::FrameBuilder builder(scene, seeded, {.quality = app::setup::Quality::draft});
  for (const app::scene::View& view : scene.views)
    EXPECT_TRUE(builder.build(view, snapshot).points.position.empty());
  EXPECT_EQ(app::record::measure(snapshot.particles, 0.02).fragments, 0u);
}

/// Loose snow is less dense by J_P, whatever bodies stand before or behind it.
TEST(SceneFlow, BodiesOfLooseSnowAreLoose) {
  const auto body = [](const std::string& name, double x, const std::string& more) {
    return "[[body]]\nname = \"" + name + "\"\nvolumes = \"given\"\n" + more +
           "shape = { box = { center = [" + std::to_string(x) +
           ", 0, 0], size = [0.2, 0.2, 0.2] } }\n";
  };
  const std::string packed = body("packed", 0, ""), loose = body("loose", 1, "J_P = 1.5\n");
  for (const std::string& text : {packed + loose, loose + packed, loose}) {
    const scene::Scene scene = scene::read_scene_text(text, "s.toml");
    const setup::SeededScene seeded = setup::seed_scene(scene);
    const sim::ParticleArrays& p = seeded.particles;
    ASSERT_EQ(p.J_P.size(), p.x.size());
    const double share =
        0.008 * static_cast<double>(scene.bodies.size()) / static_cast<double>(p.x.size());
    for (std::size_t q = 0; q < p.x.size(); ++q) {
      const double J_P = p.x[q].x() > 0.5 ? 1.5 : 1;
      EXPECT_EQ(p.J_P[q], J_P);
      EXPECT_NEAR(p.V0[q], share / J_P, 1e-12 * share);
      EXPECT_NEAR(p.m[q], scene.materials[0].density * share / J_P, 1e-9 * share);
    }
  }
}

TEST(SceneFlow, IdsStayWhereParticlesWereRemoved) {
  app::scene::Scene scene = flow_scene(R"(
[[body]]
name = "gone"
shape = { box = { center = [0, 0.05, 0], size = [0.1, 0.1, 0.1] } }
[[body]]
name = "kept"
shape = { box = { center = [1, 0.05, 0], size = [0.1, 0.1, 0.1] } }
[[sink]]
shape = { sphere = { center = [0, 0, 0], radius = 0.5 } }
[[view]]
name = "slice"
layers = ["bounds"]
)");
  app::setup::resolve(scene, 1000);
  const app::setup::SeededScene seeded = app::setup::seed_scene(scene);
  const sim::Simulation simulation = app::setup::make_simulation(scene, seeded.particles, 1);
  EXPECT_EQ(simulation.particle_count(), seeded.body_end[1] - seeded.body_end[0]);
  const app::picture::Snapshot snapshot =
      app::picture::take_snapshot(scene, scene.views, simulation, 0);
  EXPECT_EQ(snapshot.particles.id_of(0), seeded.body_end[0]);
  const app::picture::FrameBuilder builder(scene, seeded, {.quality = app::setup::Quality::draft});
  const render::Frame frame = builder.build(scene.views[0], snapshot);
  ASSERT_EQ(frame.labels.size(), 1u);
  EXPECT_EQ(frame.labels[0].text, "kept");
}

TEST(SceneFlow, APlaneStaysWhereTheBodyBeganThatASinkHasTaken) {
  app::scene::Scene scene = flow_scene(R"(
[[body]]
name = "gone"
shape = { box = { center = [0.4, 0.3, 0.2], size = [0.1, 0.1, 0.1] } }
[[body]]
name = "kept"
shape = { box = { center = [1, 0.05, 0], size = [0.1, 0.1, 0.1] } }
[[sink]]
shape = { sphere = { center = [0.4, 0.3, 0.2], radius = 0.2 } }
[[view]]
name = "slice"
layers = ["heatmap"]
[view.slice]
follow = "gone"
)");
  app::setup::resolve(scene, 1000);
  const app::setup::SeededScene seeded = app::setup::seed_scene(scene);
  const sim::Simulation simulation = app::setup::make_simulation(scene, seeded.particles, 1);
  const app::picture::Snapshot snapshot =
      app::picture::take_snapshot(scene, scene.views, simulation, 0);
  const app::picture::FrameBuilder builder(scene, seeded, {.quality = app::setup::Quality::draft});
  EXPECT_EQ(builder.build(scene.views[0], snapshot).footnote,
            "z = 0.2 m: no snow here, gone is gone: the plane is where it began");
}

TEST(SceneFlow, VariationBelongsToTheBodyAndNotToTheGrid) {
  const std::string text = R"(
[material.snow]
variation = { density = 0.2, youngs_modulus = 0.5, thresholds = 0.3, size = 0.05 }
[[body]]
shape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } }
volumes = "given"
)";
  const app::scene::Scene scene = flow_scene(text);
  const sim::ParticleArrays p = app::setup::seed_scene(scene).particles;
  ASSERT_EQ(p.stiffness.size(), p.x.size());
  const auto [least, most] = std::minmax_element(p.stiffness.begin(), p.stiffness.end());
  EXPECT_LT(*least, 0.8);
  EXPECT_GT(*most, 1.3);
  const sim::ParticleArrays moved =
      app::setup::seed_scene(
          flow_scene(text, {app::scene::parse_override("body.1.shape.sphere.center=[3,1,2]")}))
          .particles;
  ASSERT_EQ(moved.x.size(), p.x.size());
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    // Positions are rounded at another place.
    EXPECT_NEAR(moved.stiffness[q], p.stiffness[q], 1e-9);
    EXPECT_NEAR(moved.m[q] / p.m[q], 1, 1e-9);
  }
  EXPECT_TRUE(
      app::setup::seed_scene(
          flow_scene(text,
                     {app::scene::parse_override("material.snow.variation.thresholds=0"),
                      app::scene::parse_override("material.snow.variation.youngs_modulus=0")}))
          .particles.stiffness.empty());
}

std::vector<std::string> findings_of(const std::string& text) {
  std::vector<app::health::Finding> findings;
  app::health::check_emitters(flow_scene(text), findings);
  std::vector<std::string> addresses;
  for (const app::health::Finding& finding : findings) addresses.push_back(finding.address);
  return addresses;
}

TEST(SceneFlow, ImpossibleEmittersAreFound) {
  EXPECT_TRUE(findings_of(spout).empty());
  EXPECT_EQ(findings_of(spout + "start = 100\n"), std::vector<std::string>{"emitter.spout.start"});
  std::string packed = spout;
  packed.replace(packed.find("rate = 20"), 9, "rate = 60");
  EXPECT_EQ(findings_of(packed), std::vector<std::string>{"emitter.spout.rate"});
}

/// A warning begins where snow is withheld, whatever its J_P, and names the cause.
TEST(SceneFlow, RatesBeyondTheNaturalOneAreFound) {
  const auto at_rate = [](double rate, double J_P) {
    std::string text = spout + "J_P = " + std::to_string(J_P) + "\n";
    text.replace(text.find("rate = 20"), 9, "rate = " + std::to_string(rate));
    std::vector<app::health::Finding> findings;
    const app::scene::Scene scene = flow_scene(text);
    app::health::check_emitters(scene, findings);
    return findings;
  };
  for (const double J_P : {0.25, 1.0, 2.0}) {
    const double natural = 400 / J_P * 0.2 * 0.2 * 2;
    EXPECT_TRUE(at_rate(natural, J_P).empty()) << J_P;
    const auto found = at_rate(1.1 * natural, J_P);
    ASSERT_EQ(found.size(), 1u) << J_P;
    EXPECT_NE(found[0].what.find("its velocity carries away only about"), std::string::npos)
        << found[0].what;
  }
  std::string fast = spout;
  fast.replace(fast.find("rate = 20"), 9, "rate = 64");
  const app::scene::Scene scene = flow_scene(fast);
  const auto by_rate = health::clogging(scene, "spout", 0.5),
             by_pile = health::clogging(scene, "spout", 0.9);
  ASSERT_TRUE(by_rate && by_pile);
  EXPECT_TRUE(by_rate->is_by_rate) << by_rate->cause;
  EXPECT_NE(by_rate->remedy.find("lower the rate"), std::string::npos) << by_rate->remedy;
  EXPECT_EQ(by_pile->cause, "snow fills the emitter");
  EXPECT_NE(by_pile->remedy.find("J_P = 1.5"), std::string::npos) << by_pile->remedy;
  const auto packed = health::clogging(flow_scene(spout + "J_P = 0.5\n"), "spout", 0.5);
  ASSERT_TRUE(packed);
  EXPECT_EQ(packed->remedy.find("loose"), std::string::npos) << packed->remedy;
}

TEST(SceneFlow, EmittersThinnerThanASpacingAreFound) {
  const std::string pin = R"(
[[emitter]]
name = "pin"
shape = { sphere = { radius = 1e-4 } }
velocity = [0, -1, 0]
rate = 1
)";
  const std::vector<std::string> found = findings_of(pin);
  EXPECT_NE(std::find(found.begin(), found.end(), "emitter.pin.shape"), found.end());
}

TEST(SceneFlow, AnEmitterWithoutAWholeParticleIsFound) {
  std::string drop = spout;
  drop.replace(drop.find("rate = 20"), 9, "rate = 1e-6");
  EXPECT_EQ(findings_of(drop), std::vector<std::string>{"emitter.spout.rate"});
  EXPECT_TRUE(findings_of("frames = 0\n" + spout).empty()) << "a picture of the start";
}

TEST(SceneFlow, SnowBornAtRestHasToFallOut) {
  std::string still = spout;
  still.replace(still.find("velocity = [0, -2, 0]"), 21, "velocity = [0, 0, 0]");
  EXPECT_EQ(findings_of(still), std::vector<std::string>{"emitter.spout.rate"});
  still.replace(still.find("rate = 20"), 9, "rate = 5");
  EXPECT_TRUE(findings_of(still).empty());
  EXPECT_EQ(findings_of("[solver]\ngravity = [0, 0, 0]\n" + still),
            std::vector<std::string>{"emitter.spout.rate"});
}

/// Gravity that begins at 0 and grows carries snow away all the same.
TEST(SceneFlow, GravityOfACurveCarriesSnowAway) {
  std::string still = spout + "end = 0.5\n";
  still.replace(still.find("velocity = [0, -2, 0]"), 21, "velocity = [0, 0, 0]");
  still.replace(still.find("rate = 20"), 9, "rate = 5");
  EXPECT_TRUE(findings_of("[[curve]]\nparameter = \"solver.gravity\"\nkeyframes = [{ time = 0, "
                          "vector = [0, 0, 0] }, { time = 0.2, vector = [0, -9.81, 0] }]\n" +
                          still)
                  .empty());
}

TEST(SceneFlow, SinksThatSnowFliesThroughAreFound) {
  const auto found = [](double thick, double speed, const std::string& more) {
    std::vector<app::health::Finding> findings;
    app::health::check_sinks(flow_scene("[solver]\ncell_size = 0.02\n" + spout +
                                        "[[sink]]\nshape = { box = { size = [1, " +
                                        std::to_string(thick) + ", 1] } }\n" + more),
                             speed, findings);
    return findings.size();
  };
  EXPECT_EQ(found(0.025, 100, ""), 1u);
  EXPECT_EQ(found(0.025, 1, ""), 0u) << "a millimetre in a step";
  EXPECT_EQ(found(0.03, 100, ""), 0u) << "1.4 cells";
  EXPECT_EQ(found(0.025, 100, "outside = true\n"), 0u);
}

/// Values of the whole scene, not of the mesh file alone.
TEST(SceneFlow, ShapesThatCannotBeAreLocated) {
  const auto expect_error = [](const std::string& text, const std::string& part) {
    const std::string said = flow_error(spout + text);
    EXPECT_EQ(said.find("scene.toml:"), 0u) << said;
    EXPECT_NE(said.find(part), std::string::npos) << said;
  };
  const std::string no_volume = "the volume of the shape is 0 m3";
  const std::string cone = "shape = { cone = { radius = 1e-300, height = 0.2 } }\n";
  for (const char* piece : {"body", "sink", "collider"})
    expect_error(std::string("[[") + piece + "]]\n" + cone, "scene.toml:8:9: error: " + no_volume);
  const test::TemporaryFolder folder;
  const std::string open = folder.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  for (const char* piece : {"body", "sink", "collider"})
    expect_error(std::string("[[") + piece + "]]\nshape = { mesh = { file = \"" + open + "\" } }\n",
                 "open.obj:4: the mesh is open");
  const std::string far = "center = [1e6, 0, 0]";
  for (const char* piece : {"body", "collider", "emitter"})
    expect_error(
        std::string("[[") + piece + "]]\nshape = { box = { " + far + ", size = [1, 1, 1] } }\n",
        "more than 4194280 cells from the origin");
  expect_error(
      "[[collider]]\nshape = { box = { size = [0.2, 0.2, 0.2] } }\nkeyframes = [{ position = [1e6, "
      "0, 0] }]\n",
      "scene.toml:9:27: error: more than 4194280 cells from the origin");
  expect_error("[[body]]\nshape = { box = { size = [1e6, 1, 1] } }\n", "more than 4194280 cells");
  EXPECT_EQ(flow_error(spout + "[[collider]]\nshape = { plane = { point = [-1e6, 0, 0] } }\n"), "");
}

TEST(SceneFlow, NumbersThatDoublesCannotDivideByAreRefused) {
  const std::string said = flow_error(spout + "[material.snow]\nvariation = { size = 1e-310 }\n");
  EXPECT_NE(said.find("expected 0 or 1e-6 <= value <= 1000000"), std::string::npos) << said;
  EXPECT_EQ(flow_error(spout + "[material.snow]\nvariation = { size = 0 }\n"), "");
}

}  // namespace
}  // namespace neve::app
