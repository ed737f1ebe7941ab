/// Balls that are thrown into a run: changes like others, made again to the bit.

#include <gtest/gtest.h>

#include <cmath>

#include "app/scene/read.h"
#include "app/setup/seed_scene.h"
#include "app/timeline/timeline.h"
#include "app/view/panels/orbit.h"
#include "app/view/panels/pick.h"
#include "tests/support/needs.h"
#include "tests/view/view_support.h"

namespace neve::test {
namespace {

using namespace app;
using view::session::LiveFrame;
using view::session::Throw;

/// A workbench with the run of the tiny scene on it.
struct Throwing {
  Throwing() : bench(bench_for(folder, tiny_scene)) {}
  view::session::Session& session() { return bench.session(); }
  std::shared_ptr<const LiveFrame> go_to(int frame) {
    session().next_frame();
    return rest_at(session(), frame);
  }
  std::shared_ptr<const LiveFrame> wait_for_colliders(std::size_t count) {
    return wait_for(session(),
                    [&](const LiveFrame& live) { return live.scene->colliders.size() == count; });
  }
  const TemporaryFolder folder;
  view::session::Workbench bench;
};

const Throw low_throw{{-0.4, 0.1, 0}, {4, 0.5, 0}, 0.05, 900};

TEST(ThrownBall, FliesFromNowOnAndIsMadeAgainToTheBit) {
  Throwing work;
  work.go_to(1);
  EXPECT_EQ(work.bench.throw_ball(low_throw), "collider.thrown");
  auto live = work.wait_for_colliders(2);
  EXPECT_EQ(live->frame, 1);
  EXPECT_EQ(sim::shapes::pose_at(live->scene->colliders[1], live->snapshot.time).point,
            sim::Vec3d(-0.4, 0.1, 0))
      << "it begins when it is thrown";
  work.session().next_step();
  wait_for(work.session(),
           [](const LiveFrame& frame) { return !frame.is_running && !frame.is_frame_end; });
  EXPECT_EQ(work.bench.throw_ball(low_throw), "collider.thrown_2");
  work.wait_for_colliders(3);
  work.bench.set("collider.thrown.friction", "0.1");
  work.session().run();
  live = rest_at(work.session(), 4);
  const sim::shapes::Collider& ball = live->scene->colliders[1];
  const sim::shapes::Pose pose = sim::shapes::pose_at(ball, live->snapshot.time);
  EXPECT_GT(pose.point.x(), -0.3);
  EXPECT_EQ(ball.velocity, sim::Vec3d(4, 0.5, 0)) << "its parameter is that of the throw";
  EXPECT_NE(pose.velocity, ball.velocity);
  EXPECT_GE(live->samples->back().bodies.size(), 2u) << "its curves are plotted";
  const record::PictureRecord record = work.bench.picture_record(*live, live->scene->views.front());
  ASSERT_EQ(record.changes.size(), 3u);
  const scene::Scene start = scene::read_scene_text(record.scene, "record");
  EXPECT_EQ(start.colliders.size(), 1u);
  timeline::Timeline again(start, record.changes,
                           std::make_shared<setup::SeededScene>(setup::seed_scene(start)), 0);
  again.go_to(4 / start.fps);
  EXPECT_EQ(again.simulation().state_hash(), live->state_hash);
}

TEST(ThrownBall, IsTakenBackAndThrownAgain) {
  Throwing work;
  work.go_to(1);
  work.bench.throw_ball(low_throw);
  work.wait_for_colliders(2);
  work.bench.undo();
  work.wait_for_colliders(1);
  work.bench.redo();
  work.wait_for_colliders(2);
  EXPECT_TRUE(work.bench.waiting_for_reset().empty());
  // Frames from before it lack it, and the run continues with it.
  work.go_to(2);
  work.session().show_frame(0);
  EXPECT_EQ(wait_for(work.session(),
                     [](const LiveFrame& live) { return live.is_older && live.frame == 0; })
                ->scene->colliders.size(),
            1u);
  work.session().show_head();
  const auto live = work.wait_for_colliders(2);
  EXPECT_EQ(live->frame, 2);
  for (const auto& message : work.bench.messages())
    EXPECT_EQ(message.kind, view::session::Message::Kind::note) << message.text;
}

/// The saved scene throws at its start: the message says which picture makes the run again.
TEST(ThrownBall, ASavedSceneSaysThatItBeginsWithIt) {
  Throwing work;
  work.go_to(1);
  work.bench.throw_ball(low_throw);
  work.wait_for_colliders(2);
  ASSERT_TRUE(work.bench.save_scene(work.folder / "out" / "scene.toml"));
  const scene::Scene saved = scene::read_scene_file((work.folder / "out" / "scene.toml").string());
  ASSERT_EQ(saved.colliders.size(), 2u);
  EXPECT_EQ(saved.colliders[1].body.density, 900);
  const std::string text = work.bench.messages().back().text;
  EXPECT_NE(text.find("collider.thrown came during the run"), std::string::npos) << text;
}

TEST(ThrownBall, MistakesAreMessages) {
  Throwing work;
  EXPECT_EQ(work.bench.throw_ball({{0, 1e9, 0}, {0, 0, 0}, 0.1, 900}), "");
  EXPECT_EQ(work.bench.messages().back().kind, view::session::Message::Kind::error);
  EXPECT_EQ(work.bench.throw_ball({{0, 1, 0}, {0, 0, 0}, -1, 900}), "");
  EXPECT_EQ(work.bench.document().scene()->colliders.size(), 1u);
}

TEST(Pick, FindsTheNearestOfSnowAndColliders) {
  Throwing work;
  const auto live = rest_at(work.session(), 0);
  const view::panels::Orbit orbit({0, 0.12, 3}, {0, 0.12, 0}, {0, 1, 0}, 30);
  const auto snow = view::panels::pick_surface(orbit, 0, 0, *live);
  ASSERT_TRUE(snow);
  EXPECT_NEAR(snow->z(), 0.06, 0.04) << "between the particles of its front";
  const auto floor = view::panels::pick_surface(orbit, 0, -0.3, *live);
  ASSERT_TRUE(floor);
  EXPECT_NEAR(floor->y(), 0, 1e-2);
  EXPECT_LT(floor->z(), 3);
  EXPECT_FALSE(view::panels::pick_surface(orbit, 0, 0.4, *live)) << "the sky";
}

class ThrownByHand : public Cli {};

TEST_F(ThrownByHand, AClickThrowsWhileTheToolIsOn) {
  folder.write("clicks.json", R"([
    {"click": "Frame"}, {"wait_for": "simulation frame 1"},
    {"key": "b"}, {"click": "picture"}, {"wait": 3},
    {"click": "Frame"}, {"wait_for": "simulation frame 2"}, {"screenshot": "thrown.png"},
    {"click": "picture"}, {"wait": 2}, {"key": "z", "ctrl": true}, {"wait": 2},
    {"key": "b"}, {"click": "picture"}, {"wait": 2},
    {"key": "s", "ctrl": true}, {"wait": 5}])");
  const auto result = neve({"view", "scene.toml", "--replay", "clicks.json", "--out", "out"});
  if (result.exit_code == app::exit_no_backend) SKIP_OR_FAIL(result.errors);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const scene::Scene saved = scene::read_scene_file((folder / "out" / "scene.toml").string());
  ASSERT_EQ(saved.colliders.size(), 2u) << "one throw was taken back, one click inspected";
  EXPECT_EQ(saved.colliders[1].name, "thrown");
  EXPECT_GT(saved.colliders[1].velocity.norm(), 1);
  EXPECT_TRUE(saved.colliders[1].body.moves());
}

}  // namespace
}  // namespace neve::test
