/// A run in time: its changes made again, from any moment of it.

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/scene/read.h"
#include "app/support/errors.h"
#include "app/timeline/changes.h"
#include "app/timeline/origin.h"
#include "app/timeline/timeline.h"
#include "app/timeline/times.h"
#include "sim/laws/list.h"
#include "sim/shapes/held_files.h"
#include "tests/support/changed_run.h"
#include "tests/support/meshes.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

using timeline::Moment;
using timeline::Moments;
using timeline::Timeline;

sim::Simulation simulate(const scene::Scene& scene) {
  return sim::Simulation(scene.solver, scene.materials, scene::sim_colliders(scene),
                         setup::seed_scene(scene).particles, 1);
}

/// A session as a person has it: frames, and in between, at any step, other parameters.
class Session {
 public:
  explicit Session(const std::string& more = {})
      : scene_(test::changed_scene(more)), simulation(simulate(scene_)) {}

  void set(const std::string& address, const std::string& value) {
    scene::note_change(changes, {simulation.steps(), address, value});
    scene_ = timeline::with_changes(scene_, {{0, address, value}});
    simulation.apply(scene_.solver, scene_.materials, scene::sim_colliders(scene_));
  }
  void steps(std::size_t count) {
    simulation.advance_to(end(), nullptr, simulation.steps() + count);
  }
  void finish() { simulation.advance_to(end()); }
  void frame() { ++frame_; }

  std::vector<scene::LiveChange> changes;

 private:
  double end() const { return frame_ / 24.0; }
  int frame_ = 1;
  scene::Scene scene_;

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
  session.set("view.snow.particles.color_by", "id");
  session.finish();
  session.set("solver.kernel", "quadratic");
  session.frame();
  session.finish();
}

/// A timeline of one thread, and the steps that it has taken itself.
struct Counted {
  explicit Counted(const scene::Scene& scene, std::vector<scene::LiveChange> changes = {},
                   Moments moments = {})
      : timeline(scene, std::move(changes),
                 std::make_shared<setup::SeededScene>(setup::seed_scene(scene)), 1,
                 std::move(moments)) {
    timeline.watch({[this](double) {
      ++steps;
      return stop_after > 0 && --stop_after == 0;
    }});
  }
  std::size_t steps = 0;
  std::size_t stop_after = 0;  ///< 0: never
  Timeline timeline;

  const sim::Simulation& simulation() const { return timeline.simulation(); }
};

std::uint64_t hash_after(int frames, const scene::Scene& scene,
                         const std::vector<scene::LiveChange>& changes) {
  Counted run(scene, changes);
  EXPECT_TRUE(run.timeline.go_to(frames / 24.0));
  return run.simulation().state_hash();
}

/// Returns the moment that one process writes and the next one reads.
Moment through_a_file(const Timeline& timeline) {
  output::Checkpoint checkpoint = output::parse_checkpoint(
      output::encode_checkpoint(timeline::to_checkpoint(timeline.moment(), "identity", "simd")));
  checkpoint.file = "moment.ckpt";
  return timeline::to_moment(std::move(checkpoint));
}

TEST(Timeline, GetsTheStateOfTheRunInWhichTheChangesWereMade) {
  Session session;
  play(session);
  ASSERT_FALSE(session.simulation.divergence());
  const scene::Scene scene = test::changed_scene();
  Counted again(scene, session.changes);
  int told = 0;
  again.timeline.watch({.after_change = [&](const scene::Scene&) { ++told; }});
  std::size_t steps = 0;
  for (int frame = 1; frame <= 3; ++frame) {
    ASSERT_TRUE(again.timeline.advance_frame());
    EXPECT_EQ(again.timeline.here().frame, frame);
    steps += again.timeline.here().advance.steps;
  }
  EXPECT_EQ(again.simulation().state_hash(), session.simulation.state_hash());
  EXPECT_EQ(again.simulation().steps(), session.simulation.steps());
  EXPECT_EQ(steps, again.simulation().steps());
  EXPECT_EQ(again.timeline.here().history.size(), 4u);
  EXPECT_EQ(again.simulation().choose_dt(1).dt, session.simulation.choose_dt(1).dt);
  EXPECT_GT(told, 5);
  const scene::Scene now = again.timeline.scene();
  EXPECT_EQ(now.views[0].particles.color_by, scene::ColorBy::id);
  EXPECT_EQ(now.solver.kernel, sim::Kernel::quadratic);
  // Drawn colliders are at their simulated places.
  EXPECT_EQ(now.colliders[1].pose_offset.since,
            again.simulation().colliders()[1].pose_offset.since);
  EXPECT_GT(again.simulation().colliders()[1].pose_offset.since, 0);
  EXPECT_NE(hash_after(3, scene, {}), again.simulation().state_hash());
}

TEST(Timeline, PlaysAgainTheChangesThatItMadeBetweenSteps) {
  const scene::Scene scene = test::changed_scene();
  Counted live(scene);
  Timeline& timeline = live.timeline;
  const auto set = [&](const std::string& address, const std::string& value) {
    timeline.change(timeline::with_changes(*timeline.here().scene, {{0, address, value}}));
  };
  set("material.snow.youngs_modulus", "2e5");
  timeline.advance_step();
  EXPECT_EQ(live.simulation().steps(), 1u);
  set("solver.gravity", "[0, -20, 0]");
  timeline.advance_frame();
  const Moment then = timeline.moment();
  timeline.advance_step();
  set("solver.transfer", "apic");
  timeline.advance_frame();
  EXPECT_EQ(timeline.changes().size(), 3u);
  const std::uint64_t first_way = live.simulation().state_hash();
  EXPECT_EQ(hash_after(2, scene, timeline.changes()), first_way);

  // Another way from the frame in between.
  timeline.restore(then);
  EXPECT_EQ(timeline.changes().size(), 3u);
  timeline.fork();
  EXPECT_EQ(timeline.changes().size(), 2u);
  timeline.advance_step();
  set("solver.transfer", "mls");
  timeline.advance_frame();
  EXPECT_NE(live.simulation().state_hash(), first_way);
  EXPECT_EQ(hash_after(2, scene, timeline.changes()), live.simulation().state_hash());
}

TEST(Timeline, LoadsStayWithTheirColliders) {
  Counted live(test::changed_scene());
  Timeline& timeline = live.timeline;
  const auto loads = [&] { return timeline.here().advance.loads; };
  // It touches the floor after half of the first frame.
  do timeline.advance_step();
  while (!timeline.here().is_frame_end() && loads().at(0).impulse.norm() == 0);
  ASSERT_FALSE(timeline.here().is_frame_end());
  const sim::ColliderLoad of_ball = loads().at(1);
  ASSERT_LT(of_ball.impulse.norm(), loads().at(0).impulse.norm());
  timeline.change(timeline::with_changes(*timeline.here().scene, {{0, "collider.floor", "none"}}));
  ASSERT_EQ(loads().size(), 1u) << "the floor is gone, and what it bore";
  EXPECT_EQ(loads()[0].impulse, of_ball.impulse);
}

TEST(Timeline, ContinuesFromAMomentAtAnyStep) {
  Session session;
  play(session);
  const scene::Scene scene = test::changed_scene();
  Counted whole(scene, session.changes);
  whole.timeline.go_to(3 / 24.0);
  for (const std::size_t length : {1u, 3u, 4u, 7u}) {
    auto run = std::make_unique<Counted>(scene, session.changes);
    while (run->timeline.here().frame < 3) {
      run->stop_after = length;
      run->timeline.advance_frame();
      // A process is interrupted here, and the next one resumes.
      auto next = std::make_unique<Counted>(scene, session.changes);
      next->timeline.restore(through_a_file(run->timeline));
      EXPECT_EQ(next->timeline.here().advance.steps, run->timeline.here().advance.steps);
      run = std::move(next);
    }
    EXPECT_EQ(run->simulation().state_hash(), session.simulation.state_hash()) << length;
    EXPECT_EQ(run->simulation().save(), whole.simulation().save()) << length;
    EXPECT_EQ(run->timeline.here().history.size(), 4u);
  }
}

/// Curves gave the values of the next frame to the state that a frame went back to, and again when
/// that was resumed: the pressure of shocks came off stress twice.
TEST(Timeline, AFrameWithCurvesThatIsLeftIsBegunAnew) {
  const scene::Scene scene = scene::read_scene_text(R"(
frames = 4
[solver]
cell_size = 0.04
on_divergence = "retry"
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.1, 0], radius = 0.08 } }
velocity = [0, -4, 0]
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[[curve]]
name = "stiffer"
parameter = "material.snow.youngs_modulus"
keyframes = [{ time = 0, value = 1.4e5 }, { time = 0.16, value = 8e5 }]
)",
                                                    "s.toml");
  Counted whole(scene);
  ASSERT_TRUE(whole.timeline.go_to(3 / 24.0));
  auto run = std::make_unique<Counted>(scene);
  for (int frame = 1; frame <= 3; ++frame) {
    const Moment before = run->timeline.moment();
    run->stop_after = 2;
    EXPECT_FALSE(run->timeline.advance_frame());
    const Moment left = run->timeline.moment();
    EXPECT_EQ(left.state, before.state) << frame;
    EXPECT_EQ(left.advance.steps, before.advance.steps) << frame;
    // A process is interrupted here, and the next one resumes.
    auto next = std::make_unique<Counted>(scene);
    next->timeline.restore(through_a_file(run->timeline));
    run = std::move(next);
    ASSERT_TRUE(run->timeline.advance_frame());
  }
  EXPECT_EQ(run->simulation().state_hash(), whole.simulation().state_hash());
  // A time between the end of a frame and that of its next step leads to the same state.
  Counted between(scene);
  for (int frame = 1; frame <= 3; ++frame) {
    ASSERT_TRUE(between.timeline.go_to((frame - 1) / 24.0 + 1e-7));
    auto next = std::make_unique<Counted>(scene);
    next->timeline.restore(through_a_file(between.timeline));
    ASSERT_TRUE(next->timeline.go_to(3 / 24.0));
    EXPECT_EQ(next->simulation().state_hash(), whole.simulation().state_hash()) << frame;
    ASSERT_TRUE(between.timeline.go_to(frame / 24.0));
  }
  EXPECT_EQ(between.simulation().state_hash(), whole.simulation().state_hash());
}

/// Each frame of a scene with curves is read anew: its files are not.
TEST(Timeline, KeepsTheMeshesThatItHasReadWhateverIsWritten) {
  const test::TemporaryFolder folder;
  const auto write_block = [&](double size) {
    folder.write("block.obj", test::box_obj({size, 0.2, size}));
  };
  write_block(0.3);
  const auto hash_after = [&](const auto& happening) {
    const sim::shapes::HeldFiles files;
    const scene::Scene scene = scene::read_scene_text(R"(
frames = 4
[solver]
cell_size = 0.04
[[body]]
shape = { sphere = { center = [0, 0.2, 0], radius = 0.08 } }
velocity = [0, -4, 0]
[[collider]]
name = "block"
shape = { mesh = { file = "block.obj" } }
[[curve]]
parameter = "solver.gravity"
keyframes = [{ time = 0, vector = [0, -9.81, 0] }, { time = 0.16, vector = [4, -9, 0] }]
)",
                                                      "s.toml", folder.path().string());
    Counted run(scene);
    EXPECT_TRUE(run.timeline.go_to(1 / 24.0));
    happening();
    EXPECT_TRUE(run.timeline.go_to(4 / 24.0));
    return std::pair(run.simulation().state_hash(), sim::shapes::changed_held_files());
  };
  const auto undisturbed = hash_after([] {});
  EXPECT_TRUE(undisturbed.second.empty());
  const auto removed = hash_after([&] { std::filesystem::remove(folder / "block.obj"); });
  EXPECT_EQ(removed.first, undisturbed.first);
  EXPECT_EQ(removed.second, std::vector<std::string>{(folder / "block.obj").string()});
  write_block(0.3);
  const auto written = hash_after([&] { write_block(0.16); });
  EXPECT_EQ(written.first, undisturbed.first);
  EXPECT_EQ(written.second.size(), 1u);
  // The next run has the new one.
  EXPECT_NE(hash_after([] {}).first, undisturbed.first);
}

/// A frame that holds takes the same steps with "retry": changes inside it are made at theirs.
TEST(Timeline, RetriesDoNotAffectAHealthyFrame) {
  Session session("solver.on_divergence=retry");
  play(session);
  Counted again(test::changed_scene("solver.on_divergence=retry"), session.changes);
  again.timeline.go_to(3 / 24.0);
  EXPECT_TRUE(again.timeline.here().retries.empty());
  EXPECT_EQ(again.simulation().state_hash(), session.simulation.state_hash());
}

/// With retries, the steps of a frame are final at its end: changes inside it wait until then, in
/// the same way however the run got there.
TEST(Timeline, ChangesInsideARetriedFrameWaitForItsEnd) {
  scene::Scene scene = test::changed_scene("solver.on_divergence=retry");
  scene.solver.time_step = sim::TimeStep::fixed;
  scene.solver.dt = 1 / 240.0;
  scene.materials[0].model = sim::laws::model::corotated;
  scene.materials[0].youngs_modulus = 3e6;
  scene.bodies[0].velocity = {0, -6, 0};
  const std::vector<scene::LiveChange> changes{{0, "solver.gravity", "[0, -20, 0]"},
                                               {14, "material.snow.youngs_modulus", "2e5"}};
  std::size_t went_back = 0;
  const auto run = [&](bool resumes) {
    auto counted = std::make_unique<Counted>(scene, changes);
    for (int frame = 1; frame <= 3; ++frame) {
      counted->timeline.advance_frame();
      EXPECT_FALSE(counted->simulation().divergence());
      EXPECT_EQ(counted->timeline.here().scene->materials[0].youngs_modulus,
                counted->simulation().steps() < 14 ? 3e6 : 2e5);
      if (!resumes) continue;
      auto next = std::make_unique<Counted>(scene, changes);
      next->timeline.restore(through_a_file(counted->timeline));
      counted = std::move(next);
    }
    went_back += counted->timeline.here().retries.size();
    return counted->simulation().state_hash();
  };
  EXPECT_EQ(run(false), run(true));
  EXPECT_GT(went_back, 0u) << "nothing broke: the test looks at nothing";
}

/// Its first frame goes back.
scene::Scene scene_that_goes_back() {
  return scene::read_scene_text(R"(
frames = 3
[solver]
cell_size = 0.04
time_step = "fixed"
dt = 2.4e-3
on_divergence = "retry"
[material.snow]
hardening = 30
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.2, 0], radius = 0.12 } }
velocity = [0, -4, 0]
[[collider]]
name = "floor"
shape = { plane = {} }
)",
                                "s.toml");
}

/// Changes that a person makes in steps of the window are made again by the run of their list.
TEST(Timeline, AChangeInsideAFrameThatGoesBackWaitsForItsEnd) {
  const scene::Scene scene = scene_that_goes_back();
  const auto seeded = std::make_shared<const setup::SeededScene>(setup::seed_scene(scene));
  Timeline session(scene, {}, seeded, 1, Moments());
  for (int step = 0; step < 4; ++step) session.advance_step();
  ASSERT_FALSE(session.here().is_frame_end());
  scene::Scene changed = session.scene();
  changed.materials[0].hardening = 20;
  session.change(changed);
  EXPECT_TRUE(session.here().is_frame_end());
  ASSERT_EQ(session.changes().size(), 1u);
  Timeline again(scene, session.changes(), seeded, 1, Moments());
  for (int frame = 0; frame < 2; ++frame) ASSERT_TRUE(again.advance_frame());
  ASSERT_TRUE(session.advance_frame());
  EXPECT_EQ(again.simulation().state_hash(), session.simulation().state_hash());
}

/// A frame that goes back has the dt of its last attempt from its beginning on, which only its end
/// tells: a moment inside it is one of that attempt, and later frames are those of the run.
TEST(Timeline, AMomentInsideAFrameThatGoesBackIsOneOfTheRun) {
  const scene::Scene scene = scene_that_goes_back();
  const auto seeded = std::make_shared<const setup::SeededScene>(setup::seed_scene(scene));
  Timeline run(scene, {}, seeded, 1, Moments());
  std::vector<std::uint64_t> hashes;
  std::vector<std::size_t> retries;
  for (int frame = 0; frame < 3; ++frame) {
    ASSERT_TRUE(run.advance_frame());
    hashes.push_back(run.simulation().state_hash());
    retries.push_back(run.here().retries.size());
  }
  ASSERT_GT(retries[0], 0u);
  for (const double inside : {0.004, 0.02, 0.041}) {
    Timeline jumping(scene, {}, seeded, 1, Moments());
    ASSERT_TRUE(jumping.go_to(inside));
    EXPECT_LE(jumping.simulation().time(), inside);
    EXPECT_EQ(jumping.here().retries.size(), retries[0]);
    for (int frame = 0; frame < 3; ++frame) {
      ASSERT_TRUE(jumping.go_to((frame + 1) / 24.0));
      EXPECT_EQ(jumping.simulation().state_hash(), hashes[static_cast<std::size_t>(frame)])
          << "after " << inside << " s, frame " << frame + 1;
      EXPECT_EQ(jumping.here().retries.size(), retries[static_cast<std::size_t>(frame)]);
    }
  }
  Timeline stepping(scene, {}, seeded, 1, Moments());
  while (stepping.here().frame < 3) {
    stepping.advance_step();
    ASSERT_FALSE(stepping.simulation().divergence());
    if (stepping.here().is_frame_end()) {
      EXPECT_EQ(stepping.simulation().state_hash(),
                hashes[static_cast<std::size_t>(stepping.here().frame - 1)]);
    }
  }
  EXPECT_EQ(stepping.here().steps, run.here().steps);
}

TEST(Timeline, PassesOverChangesOfViewsThatAreNotDrawn) {
  const Counted run(test::changed_scene(), {{0, "view.smoke.smoke.density_scale", "2"},
                                            {0, "mosaic.all.columns", "2"},
                                            {0, "solver.cfl", "0.2"}});
  EXPECT_EQ(run.timeline.here().scene->views.size(), 1u);
  EXPECT_EQ(run.timeline.here().scene->solver.cfl, 0.2);
}

TEST(Timeline, GoesToAnyTimeByTheStepsOfTheRun) {
  const scene::Scene scene = test::changed_scene();
  Counted straight(scene);
  ASSERT_TRUE(straight.timeline.go_to(2 / 24.0));
  Counted wandering(scene);
  ASSERT_TRUE(wandering.timeline.go_to(2.5 / 24));
  EXPECT_EQ(wandering.timeline.here().frame, 2);
  EXPECT_FALSE(wandering.timeline.here().is_frame_end());
  EXPECT_LE(wandering.simulation().time(), 2.5 / 24);
  // Nothing is kept: earlier is from the start again.
  ASSERT_TRUE(wandering.timeline.go_to(1 / 24.0));
  EXPECT_EQ(wandering.timeline.here().frame, 1);
  ASSERT_TRUE(wandering.timeline.go_to(2 / 24.0));
  EXPECT_EQ(wandering.simulation().save(), straight.simulation().save());
}

TEST(Timeline, TakesNoStepToAMomentThatIsKept) {
  const scene::Scene scene = test::changed_scene();
  Counted run(scene, {{4, "solver.gravity", "[0, -20, 0]"}}, Moments(1u << 30));
  std::vector<std::uint64_t> hashes;
  for (int frame = 0; frame <= 4; ++frame) {
    if (frame > 0) run.timeline.advance_frame();
    run.timeline.keep();
    hashes.push_back(run.simulation().state_hash());
  }
  const std::size_t before = run.steps;
  for (const int frame : {2, 0, 3, 1, 4}) {
    ASSERT_TRUE(run.timeline.go_to(frame / 24.0));
    EXPECT_EQ(run.simulation().state_hash(), hashes[static_cast<std::size_t>(frame)]) << frame;
    EXPECT_EQ(run.timeline.here().frame, frame);
    EXPECT_EQ(run.timeline.here().history.size(), static_cast<std::size_t>(frame) + 1);
  }
  EXPECT_EQ(run.steps, before);
  // The timeline takes the steps that are missing from the nearest moment before a time.
  ASSERT_TRUE(run.timeline.go_to(2.5 / 24));
  EXPECT_GT(run.steps, before);
  EXPECT_EQ(run.timeline.here().frame, 2);
  // A run that forks has none of the moments after it.
  run.timeline.fork();
  EXPECT_EQ(run.timeline.moments().frames(), (std::vector<int>{0, 1, 2}));
  // The planned length of the run belongs to none of its moments.
  scene::Scene longer = *run.timeline.here().scene;
  longer.frames = 99;
  run.timeline.change(longer);
  ASSERT_TRUE(run.timeline.go_to(1 / 24.0));
  EXPECT_EQ(run.timeline.here().scene->frames, 99);
}

TEST(Timeline, TakesNoStepToAMomentInAFolder) {
  const scene::Scene scene = test::changed_scene();
  Counted run(scene);
  ASSERT_TRUE(run.timeline.go_to(2.5 / 24));
  ASSERT_FALSE(run.timeline.here().is_frame_end());
  const test::TemporaryFolder folder;
  record::RunRecord record;
  record.scene = scene::write_scene(scene);
  record.simd = run.simulation().simd();
  timeline::write_origin(folder.path(), record, run.timeline.moment());
  EXPECT_EQ(scene::write_scene(timeline::Origin::of(folder.path().string(), {}).scene),
            record.scene);
  const auto opened = [&] {
    Moments moments;
    moments.add_run(folder.path());
    return std::make_unique<Counted>(scene, std::vector<scene::LiveChange>{}, std::move(moments));
  };
  auto again = opened();
  ASSERT_TRUE(again->timeline.go_to(2.5 / 24));
  EXPECT_EQ(again->steps, 0u);
  EXPECT_EQ(again->simulation().save(), run.simulation().save());
  EXPECT_EQ(again->timeline.here().advance.steps, run.timeline.here().advance.steps);
  ASSERT_TRUE(again->timeline.go_to(3 / 24.0));
  EXPECT_GT(again->steps, 0u);
  // It is later than the end of its frame, which is simulated.
  auto earlier = opened();
  ASSERT_TRUE(earlier->timeline.go_to(2 / 24.0));
  EXPECT_GT(earlier->steps, 0u);
  const std::size_t before = earlier->steps;
  ASSERT_TRUE(earlier->timeline.go_to(2.5 / 24));
  EXPECT_EQ(earlier->steps, before) << "the moment is ahead in the same frame";
  EXPECT_EQ(earlier->simulation().save(), run.simulation().save());
  // The file is of the moment before a change that is made there.
  auto changed = opened();
  ASSERT_TRUE(changed->timeline.go_to(2.5 / 24));
  scene::Scene stiffer = *changed->timeline.here().scene;
  stiffer.materials.front().youngs_modulus *= 10;
  changed->timeline.change(stiffer);
  ASSERT_TRUE(changed->timeline.go_to(2.5 / 24));  // by shorter steps
  const std::vector<std::uint8_t> state = changed->simulation().save();
  ASSERT_TRUE(changed->timeline.go_to(3 / 24.0));
  ASSERT_TRUE(changed->timeline.go_to(2.5 / 24));
  EXPECT_EQ(changed->simulation().save(), state);
  // Another run takes the place of the one that is read: nobody holds its folder.
  const auto write = [&](std::uint64_t hash) {
    timeline::Moment moment = run.timeline.moment();
    record::FrameRecord listed;
    listed.frame = moment.frame;
    listed.state_hash = hash;
    moment.made.frames.push_back(listed);
    record.frames = moment.made.frames;
    timeline::write_origin(folder.path(), record, std::move(moment));
  };
  write(7);
  auto same = opened(), other = opened();
  ASSERT_TRUE(same->timeline.go_to(2.5 / 24));
  EXPECT_EQ(same->steps, 0u);
  write(8);
  ASSERT_TRUE(other->timeline.go_to(2.5 / 24));
  EXPECT_GT(other->steps, 0u);
}

TEST(Timeline, AMomentAfterADivergenceIsLeft) {
  scene::Scene scene = test::changed_scene();
  scene.solver.time_step = sim::TimeStep::fixed;
  scene.solver.dt = 1 / 240.0;
  scene.materials[0].model = sim::laws::model::corotated;
  scene.bodies[0].velocity = {0, -6, 0};
  Counted run(scene, {{3, "material.snow.youngs_modulus", "3e8"}}, Moments(1u << 30));
  run.timeline.keep();
  const std::uint64_t at_start = run.simulation().state_hash();
  EXPECT_FALSE(run.timeline.go_to(4 / 24.0));
  ASSERT_TRUE(run.simulation().divergence()) << "nothing broke: the test looks at nothing";
  EXPECT_FALSE(run.timeline.go_to(4 / 24.0)) << "a broken state takes no more steps";
  ASSERT_TRUE(run.timeline.go_to(0));
  EXPECT_EQ(run.simulation().state_hash(), at_start);
  EXPECT_FALSE(run.simulation().divergence());
}

TEST(Moments, StayWithinTheirMemory) {
  Moments kept(1000);
  for (int frame = 0; frame <= 40; ++frame) {
    Moment one;
    one.frame = frame;
    one.state.resize(100);
    kept.keep(std::move(one));
    ASSERT_LE(kept.bytes(), 1000u);
  }
  const std::vector<int> frames = kept.frames();
  EXPECT_EQ(frames.size(), 10u);
  EXPECT_EQ(frames.front(), 0);
  EXPECT_EQ(frames.back(), 40);
  // No gap is more than twice an even one, and the newest are not the ones that went.
  for (std::size_t k = 1; k < frames.size(); ++k)
    EXPECT_LE(frames[k] - frames[k - 1], 2 * 40 / 9) << k;
  EXPECT_EQ(kept.find(39 / 24.0, 24)->frame, frames[8]);
  EXPECT_EQ(kept.find_newest(24)->frame, 40);
  EXPECT_FALSE(kept.find(39 / 24.0, 24, frames[8]));
  kept.forget_after(frames[3], 0);
  EXPECT_EQ(kept.frames().size(), 4u);
  EXPECT_EQ(kept.bytes(), 400u);
}

/// A fork inside a frame: a moment of the same frame that is later belongs to the other branch.
TEST(Moments, AForkForgetsLaterStepsOfItsOwnFrame) {
  Moments kept(1000);
  for (const int frame : {0, 1, 2}) {
    Moment one;
    one.frame = frame;
    one.steps = static_cast<std::size_t>(10 * frame + 5);
    one.state.resize(100);
    kept.keep(std::move(one));
  }
  kept.forget_after(2, 25);
  EXPECT_EQ(kept.frames(), (std::vector<int>{0, 1, 2}));
  kept.forget_after(2, 24);
  EXPECT_EQ(kept.frames(), (std::vector<int>{0, 1}));
  EXPECT_EQ(kept.bytes(), 200u);
}

TEST(Times, ATypedTimeMeansTheFrameThatEndsThere) {
  EXPECT_EQ(timeline::frame_at(0.1 + 0.2, 10), 3);  // 0.30000000000000004
  EXPECT_EQ(timeline::frame_at(0.3 - 1e-14, 10), 3);
  EXPECT_EQ(timeline::frame_at(0.2999, 10), 2);
  EXPECT_TRUE(timeline::is_not_after(0.1 + 0.2, 0.3));
  EXPECT_FALSE(timeline::is_not_after(0.301, 0.3));
}

/// Pictures of strips and comparisons have the plots and changes of those of a run.
TEST(Timeline, ASnapshotHasTheHistoryTheStepsAndTheChangesOfTheRun) {
  const scene::Scene scene = test::changed_scene();
  const auto seeded = std::make_shared<const setup::SeededScene>(setup::seed_scene(scene));
  const std::vector<scene::LiveChange> changes{{2, "material.snow.youngs_modulus", "2e5"},
                                               {100000, "material.snow.youngs_modulus", "3e5"}};
  Timeline run(scene, changes, seeded, 1);
  ASSERT_TRUE(run.go_to(3 / scene.fps));
  const picture::Snapshot snapshot = timeline::take_snapshot(run, scene, scene.views, 3);
  EXPECT_EQ(snapshot.history.size(), 4u);
  EXPECT_EQ(snapshot.advance.steps, run.here().advance.steps);
  EXPECT_GT(snapshot.advance.steps, 0u);
  ASSERT_EQ(snapshot.changes.size(), 1u);
  EXPECT_EQ(snapshot.changes[0].value, "2e5");
}

}  // namespace
}  // namespace neve::app
