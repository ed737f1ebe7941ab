/// Changes made while a simulation runs: kept, read back, made again.

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/run/changes.h"
#include "app/scene/flat.h"
#include "app/scene/read.h"
#include "app/setup/seed_scene.h"
#include "app/support/errors.h"

namespace neve::app {
namespace {

constexpr const char* changed_scene = R"(
frames = 4
[solver]
cell_size = 0.04
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.12, 0], radius = 0.08 } }
velocity = [0, -2, 0]
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[[collider]]
name = "ball"
shape = { sphere = { center = [0.2, 0, 0], radius = 0.08 } }
velocity = [-1, 0, 0]
)";

app::scene::Scene start(const std::string& more = {}) {
  std::vector<app::scene::Override> overrides;
  if (!more.empty()) overrides.push_back(app::scene::parse_override(more));
  return app::scene::read_scene_text(changed_scene, "s.toml", "", overrides);
}

sim::Simulation simulate(const app::scene::Scene& scene, bool is_empty = false) {
  return sim::Simulation(scene.solver, scene.materials, app::scene::sim_colliders(scene),
                         is_empty ? sim::ParticleArrays{} : app::setup::seed_scene(scene).particles,
                         1);
}

TEST(LiveChanges, ChangesSurviveJson) {
  const std::vector<app::scene::LiveChange> changes{{0, "solver.cfl", "0.2"},
                                                    {17, "collider.floor.contact", "\"sticky\""},
                                                    {17, "camera", "none"}};
  EXPECT_EQ(
      app::scene::live_changes(parse_json(std::string_view(to_text(app::scene::to_json(changes))))),
      changes);
  EXPECT_EQ(app::scene::text_of(changes[1]), "step 17: collider.floor.contact = \"sticky\"");
  EXPECT_TRUE(app::scene::live_changes(Json::array()).empty());
}

TEST(LiveChanges, InvalidChangesAreRefused) {
  for (const char* bad : {"{}", "[1]", "null", R"([{"step": 1, "address": "solver.cfl"}])",
                          R"([{"step": -1, "address": "solver.cfl", "value": "1"}])",
                          R"([{"step": 1.5, "address": "solver.cfl", "value": "1"}])",
                          R"([{"step": 1, "address": "solver.cell_size", "value": "1"}])",
                          R"([{"step": 1, "address": "nonsense", "value": "1"}])",
                          R"([{"step": 2, "address": "solver.cfl", "value": "1"},
            {"step": 1, "address": "solver.cfl", "value": "1"}])"})
    EXPECT_THROW(app::scene::live_changes(parse_json(std::string_view(bad))), std::runtime_error)
        << bad;
}

TEST(LiveChanges, OnlyTheFirstAndLastChangeOfAStepAndAddressAreKept) {
  std::vector<app::scene::LiveChange> changes;
  for (const char* value : {"1", "2", "3", "4"})
    app::scene::note_change(changes, {5, "light.ambient", value});
  app::scene::note_change(changes, {5, "solver.cfl", "0.2"});
  app::scene::note_change(changes, {6, "solver.cfl", "0.3"});
  const std::vector<app::scene::LiveChange> expected{{5, "light.ambient", "1"},
                                                     {5, "light.ambient", "4"},
                                                     {5, "solver.cfl", "0.2"},
                                                     {6, "solver.cfl", "0.3"}};
  EXPECT_EQ(changes, expected);
  app::scene::forget_changes_after(changes, 5);
  EXPECT_EQ(changes.size(), 3u);
}

TEST(LiveChanges, ChangesUpToAStepMakeItsScene) {
  const app::run::SceneSource source{
      changed_scene, "s.toml", "", {app::scene::parse_override("solver.cfl=0.1")}};
  const std::vector<app::scene::LiveChange> changes{{3, "solver.cfl", "0.2"},
                                                    {5, "solver.cfl", "0.3"},
                                                    {5, "camera.fov", "20"},
                                                    {9, "camera", "none"}};
  EXPECT_EQ(app::run::with_changes(source, changes, 2).solver.cfl, 0.1);
  EXPECT_EQ(app::run::with_changes(source, changes, 3).solver.cfl, 0.2);
  EXPECT_EQ(app::run::with_changes(source, changes, 8).solver.cfl, 0.3);
  EXPECT_EQ(app::run::with_changes(source, changes, 8).camera->fov, 20);
  EXPECT_FALSE(app::run::with_changes(source, changes).camera);
  try {
    app::run::with_changes(source, {{7, "solver.cfl", "-1"}});
    FAIL() << "a bad value was taken";
  } catch (const app::UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("change at step 7: solver.cfl=-1"), std::string::npos)
        << error.what();
  }
}

TEST(LiveChanges, ARecordedSceneStartsAsTheRunAndLooksAsItDoesNow) {
  const app::scene::Scene from = start();
  app::scene::Scene now = start("view.particles.particles.color_by=speed");
  now.solver.cfl = 0.1;
  now.colliders[0].friction = 0.9;
  now.colliders[0].style = app::scene::ColliderStyle::wire;
  const app::scene::Scene recorded = app::run::recorded_scene(from, now);
  EXPECT_EQ(recorded.solver.cfl, from.solver.cfl);
  EXPECT_EQ(recorded.colliders[0].friction, from.colliders[0].friction);
  EXPECT_EQ(recorded.colliders[0].style, app::scene::ColliderStyle::wire);
  EXPECT_EQ(recorded.views[0].particles.color_by, app::scene::ColorBy::speed);
  for (const app::scene::Difference& difference : app::scene::differences(from, recorded))
    EXPECT_FALSE(app::scene::concerns_simulation(difference.address)) << difference.address;
}

/// A session as a person has it: frames, and in between, at any step, other parameters.
class Session {
 public:
  explicit Session(const std::string& more = {})
      : scene_(start(more)), simulation(simulate(scene_)) {}

  void set(const std::string& address, const std::string& value) {
    app::scene::note_change(changes, {simulation.steps(), address, value});
    scene_ = app::run::with_changes({app::scene::write_scene(scene_), "now", "", {}},
                                    {{0, address, value}});
    app::run::apply_scene(scene_, simulation);
  }
  void steps(std::size_t count) {
    simulation.advance_to(end(), nullptr, simulation.steps() + count);
  }
  void finish() { simulation.advance_to(end()); }
  void frame() { ++frame_; }

  std::vector<app::scene::LiveChange> changes;

 private:
  double end() const { return frame_ / 24.0; }
  int frame_ = 1;
  app::scene::Scene scene_;

 public:
  sim::Simulation simulation;
};

void play(Session& session) {
  session.set("material.snow.youngs_modulus", "2e5");
  session.steps(3);
  session.set("material.snow.youngs_modulus", "5e5");
  session.set("material.snow.youngs_modulus", "8e5");
  session.set("material.snow.youngs_modulus", "2e5");
  session.set("solver.gravity", "[0, -20, 0]");
  session.set("material.snow.youngs_modulus", "3e5");
  session.steps(1);
  session.set("collider.ball.velocity", "[2, 0, 0]");
  session.finish();
  session.frame();
  session.set("solver.transfer", "apic");
  session.steps(2);
  session.set("collider.floor.shape.plane.point", "[0, 0.01, 0]");
  session.set("material.snow.model", "corotated");
  session.set("view.particles.particles.color_by", "id");
  session.finish();
  session.set("solver.kernel", "quadratic");
  session.frame();
  session.finish();
}

TEST(ChangePlayer, ChangePlayerGetsTheStateOfTheRunInWhichTheChangesWereMade) {
  Session session;
  play(session);
  ASSERT_FALSE(session.simulation.divergence());
  const app::scene::Scene scene = start();
  sim::Simulation again = simulate(scene);
  int told = 0;
  app::run::ChangePlayer player(scene, session.changes, again,
                                [&](const app::scene::Scene&) { ++told; });
  std::vector<sim::Retry> retries;
  player.begin();
  std::size_t steps = 0;
  for (int frame = 1; frame <= 3; ++frame)
    steps += player.advance_to(frame / 24.0, nullptr, retries).steps;
  EXPECT_EQ(again.state_hash(), session.simulation.state_hash());
  EXPECT_EQ(again.steps(), session.simulation.steps());
  EXPECT_EQ(steps, again.steps());
  EXPECT_EQ(again.choose_dt(1).dt, session.simulation.choose_dt(1).dt);
  EXPECT_GT(told, 5);
  EXPECT_EQ(player.scene().views[0].particles.color_by, app::scene::ColorBy::id);
  EXPECT_EQ(player.scene().solver.kernel, sim::Kernel::quadratic);
  // Drawn colliders are at their simulated places.
  EXPECT_EQ(player.scene().colliders[1].pose_offset.since, again.colliders()[1].pose_offset.since);
  EXPECT_GT(again.colliders()[1].pose_offset.since, 0);
  // Without them it is another run.
  sim::Simulation plain = simulate(scene);
  plain.advance_to(3 / 24.0);
  EXPECT_NE(plain.state_hash(), again.state_hash());
}

TEST(ChangePlayer, ChangePlayerPlaysAgainTheChangesThatItMadeBetweenSteps) {
  const app::scene::Scene scene = start();
  sim::Simulation live = simulate(scene);
  app::run::ChangePlayer player(scene, {}, live);
  std::vector<sim::Retry> none;
  const auto set = [&](const std::string& address, const std::string& value) {
    player.make_now(std::make_shared<app::scene::Scene>(app::run::with_changes(
        {app::scene::write_scene(player.scene()), "now", "", {}}, {{0, address, value}})));
  };
  const auto hash_after_replay = [&] {
    sim::Simulation again = simulate(scene);
    app::run::ChangePlayer replay(scene, player.changes(), again);
    replay.begin();
    for (int frame = 1; frame <= 2; ++frame) replay.advance_to(frame / 24.0, nullptr, none);
    return again.state_hash();
  };
  set("material.snow.youngs_modulus", "2e5");
  player.step_towards(1 / 24.0, nullptr);
  EXPECT_EQ(live.steps(), 1u);
  set("solver.gravity", "[0, -20, 0]");
  player.advance_to(1 / 24.0, nullptr, none);
  const std::vector<std::uint8_t> state = live.save();
  const std::size_t steps = live.steps();
  const std::shared_ptr<const app::scene::Scene> then = player.shared_scene();
  player.step_towards(2 / 24.0, nullptr);
  set("solver.transfer", "apic");
  player.advance_to(2 / 24.0, nullptr, none);
  EXPECT_EQ(player.changes().size(), 3u);
  const std::uint64_t first_way = live.state_hash();
  EXPECT_EQ(hash_after_replay(), first_way);

  // Another way from the frame in between.
  live = simulate(*then);
  live.restore(state);
  player.go_to(steps, then);
  EXPECT_EQ(player.changes().size(), 3u);
  player.forget_later();
  EXPECT_EQ(player.changes().size(), 2u);
  player.step_towards(2 / 24.0, nullptr);
  set("solver.transfer", "mls");
  player.advance_to(2 / 24.0, nullptr, none);
  EXPECT_NE(live.state_hash(), first_way);
  EXPECT_EQ(hash_after_replay(), live.state_hash());
}

TEST(ChangePlayer, ChangePlayerContinuesFromAStateAtAnyStep) {
  Session session;
  play(session);
  const app::scene::Scene scene = start();
  static std::size_t left = 0;
  const auto stop = [] { return --left == 0; };
  sim::Simulation whole = simulate(scene);
  app::run::ChangePlayer at_once(scene, session.changes, whole);
  std::vector<sim::Retry> none;
  at_once.begin();
  for (int frame = 1; frame <= 3; ++frame) at_once.advance_to(frame / 24.0, nullptr, none);
  for (const std::size_t length : {1u, 3u, 4u, 7u}) {
    auto simulation = std::make_unique<sim::Simulation>(simulate(scene));
    auto player = std::make_unique<app::run::ChangePlayer>(scene, session.changes, *simulation);
    player->begin();
    std::vector<sim::Retry> retries;
    for (int frame = 1; frame <= 3; ++frame)
      while (simulation->time() < frame / 24.0) {
        left = length;
        player->advance_to(frame / 24.0, stop, retries);
        // As a process that is interrupted, and the one that resumes.
        const std::vector<std::uint8_t> bytes = simulation->save();
        const std::size_t steps = simulation->steps();
        auto next = std::make_unique<sim::Simulation>(simulate(scene));
        player = std::make_unique<app::run::ChangePlayer>(scene, session.changes, *next);
        player->go_to(steps);
        next->restore(bytes);
        simulation = std::move(next);
      }
    EXPECT_EQ(simulation->state_hash(), session.simulation.state_hash()) << length;
    EXPECT_EQ(simulation->save(), whole.save()) << length;
  }
}

/// A frame that holds takes the same steps with "retry": changes inside it are made at theirs.
TEST(ChangePlayer, RetriesDoNotAffectAHealthyFrame) {
  Session session("solver.on_divergence=retry");
  play(session);
  const app::scene::Scene scene = start("solver.on_divergence=retry");
  sim::Simulation again = simulate(scene);
  app::run::ChangePlayer player(scene, session.changes, again);
  std::vector<sim::Retry> retries;
  player.begin();
  for (int frame = 1; frame <= 3; ++frame) player.advance_to(frame / 24.0, nullptr, retries);
  EXPECT_TRUE(retries.empty());
  EXPECT_EQ(again.state_hash(), session.simulation.state_hash());
}

/// With retries, the steps of a frame are final at its end: changes inside it wait until then, in
/// the same way however the run got there.
TEST(ChangePlayer, ChangesInsideARetriedFrameWaitForItsEnd) {
  app::scene::Scene scene = start("solver.on_divergence=retry");
  scene.solver.time_step = sim::TimeStep::fixed;
  scene.solver.dt = 1 / 240.0;
  scene.materials[0].model = sim::Model::corotated;
  scene.materials[0].youngs_modulus = 3e6;
  scene.bodies[0].velocity = {0, -6, 0};
  const std::vector<app::scene::LiveChange> changes{{0, "solver.gravity", "[0, -20, 0]"},
                                                    {14, "material.snow.youngs_modulus", "2e5"}};
  std::size_t went_back = 0;
  const auto run = [&](bool resumes) {
    auto simulation = std::make_unique<sim::Simulation>(simulate(scene));
    auto player = std::make_unique<app::run::ChangePlayer>(scene, changes, *simulation);
    player->begin();
    std::vector<sim::Retry> retries;
    for (int frame = 1; frame <= 3; ++frame) {
      player->advance_to(frame / 24.0, nullptr, retries);
      EXPECT_FALSE(simulation->divergence());
      EXPECT_EQ(player->scene().materials[0].youngs_modulus, simulation->steps() < 14 ? 3e6 : 2e5);
      if (!resumes) continue;
      const std::vector<std::uint8_t> bytes = simulation->save();
      const std::size_t steps = simulation->steps();
      auto next = std::make_unique<sim::Simulation>(simulate(scene));
      player = std::make_unique<app::run::ChangePlayer>(scene, changes, *next);
      player->go_to(steps);
      next->restore(bytes);
      simulation = std::move(next);
    }
    went_back += retries.size();
    return simulation->state_hash();
  };
  EXPECT_EQ(run(false), run(true));
  EXPECT_GT(went_back, 0u) << "nothing broke: the test looks at nothing";
}

TEST(ChangePlayer, ChangePlayerPassesOverViewsThatAreNotDrawn) {
  const app::scene::Scene scene = start();
  sim::Simulation simulation = simulate(scene);
  app::run::ChangePlayer player(scene,
                                {{0, "view.smoke.smoke.density_scale", "2"},
                                 {0, "mosaic.all.columns", "2"},
                                 {0, "solver.cfl", "0.2"}},
                                simulation);
  player.begin();
  EXPECT_EQ(player.scene().views.size(), 1u);
  EXPECT_EQ(player.scene().solver.cfl, 0.2);
}

}  // namespace
}  // namespace neve::app
