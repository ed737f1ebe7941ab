/// Changes by a stage of a step show in every view.

#include <gtest/gtest.h>

#include "app/output/atomic_file.h"
#include "app/picture/frame_builder.h"
#include "app/scene/names.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "render/image/image.h"
#include "tests/support/needs.h"
#include "tests/view/view_support.h"

namespace neve::test {
namespace {

using namespace app;
using sim::Stage;
using view::session::LiveFrame;

/// The default views: particles, smoke and slice.
render::Frame frame_of(view::session::Workbench& bench, const LiveFrame& live,
                       const std::string& name) {
  const scene::Scene scene = bench.display_scene(live);
  for (const scene::View& view : live.scene->views)
    if (view.name == name)
      return picture::FrameBuilder(scene, *live.seeded, {}).build(view, live.snapshot);
  return {};
}

TEST(StageChange, EveryStageThatChangesSnowHasANumberPerParticle) {
  const TemporaryFolder folder;
  view::session::Workbench bench = bench_for(folder, tiny_scene);
  view::session::Session& session = bench.session();
  session.next_frame();
  rest_at(session, 1);
  for (int k = 0; k <= static_cast<int>(Stage::colliders); ++k) {
    const auto stage = static_cast<Stage>(k);
    session.show_stage(stage);
    const auto live = wait_for(session, [&](const LiveFrame& frame) {
      return frame.stage && frame.stage->stage == stage;
    });
    const auto& change = live->snapshot.stage_change;
    if (stage == Stage::volumes || stage == Stage::colliders) {
      EXPECT_FALSE(change) << sim::name(stage);
      continue;
    }
    ASSERT_TRUE(change) << sim::name(stage);
    // Explicit steps have no solve, and the ball is still in the air.
    if (stage == Stage::implicit_solve || stage == Stage::grid_collisions) continue;
    if (stage == Stage::particle_collisions) continue;
    EXPECT_EQ(change->magnitude.size(), live->snapshot.particles.x.size()) << sim::name(stage);
    EXPECT_GT(change->largest(), 0) << sim::name(stage);
  }
}

TEST(StageChange, GravityAloneIsWhatAFallingBallGets) {
  const TemporaryFolder folder;
  std::string high = tiny_scene;
  high.replace(high.find("[0, 0.12, 0]"), 12, "[0, 9.12, 0]");
  view::session::Workbench bench = bench_for(folder, high);
  bench.session().show_stage(Stage::grid_velocities);
  const auto live =
      wait_for(bench.session(), [](const LiveFrame& frame) { return frame.stage.has_value(); });
  const auto& change = *live->snapshot.stage_change;
  for (const sim::Vec3d& v : change.vector) {
    if (v.norm() == 0) continue;  // its nearest node has no mass
    EXPECT_NEAR(v.y(), -9.81 * live->stage->dt, 1e-4 * 9.81 * live->stage->dt);
    EXPECT_NEAR(v.x(), 0, 1e-9);
  }
}

TEST(StageChange, ParticlesAreCutAndHaveArrowsAndTheirColoursHaveALegend) {
  const TemporaryFolder folder;
  view::session::Workbench bench = bench_for(folder, tiny_scene);
  view::session::Session& session = bench.session();
  session.set_views(bench.document().scene()->views);
  session.next_frame();
  rest_at(session, 1);
  const auto whole = wait_for(session, [](const LiveFrame& live) { return live.is_frame_end; });
  const std::size_t all = frame_of(bench, *whole, "particles").points.position.size();
  session.show_stage(Stage::elastic_forces);
  auto live = wait_for(session, [](const LiveFrame& frame) { return frame.stage.has_value(); });
  for (const char* view : {"particles", "smoke"}) {
    const render::Frame frame = frame_of(bench, *live, view);
    EXPECT_GT(frame.points.position.size(), 0u) << view;
    EXPECT_LT(frame.points.position.size(), all) << view << ": the plane cuts it";
    EXPECT_EQ(frame.points.value.size(), frame.points.position.size()) << view;
    ASSERT_EQ(frame.arrows.size(), 1u) << view;
    EXPECT_GT(frame.arrows[0].position.size(), 3u) << view;
    EXPECT_TRUE(frame.arrows[0].is_white) << view << ": the particles have the colours";
    ASSERT_EQ(frame.legends.size(), 1u) << view;
    EXPECT_EQ(frame.legends[0].title, "force over mass") << view;
  }
  // A slice has its own arrows of the grid; the stages of particles show on it as a layer of them.
  EXPECT_TRUE(frame_of(bench, *live, "slice").points.position.empty());
  session.show_stage(Stage::deformation);
  live = wait_for(session, [](const LiveFrame& frame) {
    return frame.stage && frame.stage->stage == Stage::deformation;
  });
  const render::Frame slice = frame_of(bench, *live, "slice");
  EXPECT_GT(slice.points.position.size(), 0u);
  EXPECT_LT(slice.points.position.size(), all / 2);
  // The plane keeps its colours, and they their legends.
  const std::vector<render::Legend> before = frame_of(bench, *whole, "slice").legends;
  ASSERT_EQ(slice.legends.size(), before.size() + 1);
  EXPECT_EQ(slice.legends[0].title, "change of F_E");
  for (std::size_t k = 0; k < before.size(); ++k)
    EXPECT_EQ(slice.legends[k + 1].title, before[k].title);
}

/// Views without a slice have no place of one: their cut goes through the snow wherever it is.
TEST(StageChange, SnowAwayFromTheOriginIsCutInItsMiddle) {
  const TemporaryFolder folder;
  std::string aside = tiny_scene;
  aside.replace(aside.find("[0, 0.12, 0]"), 12, "[0, 0.12, 9]");
  view::session::Workbench bench = bench_for(folder, aside);
  bench.session().show_stage(Stage::grid_velocities);
  const auto live =
      wait_for(bench.session(), [](const LiveFrame& frame) { return frame.stage.has_value(); });
  const std::size_t all = live->snapshot.particles.x.size();
  for (const char* view : {"particles", "smoke"}) {
    const std::size_t seen = frame_of(bench, *live, view).points.position.size();
    EXPECT_GT(seen, all / 4) << view;
    EXPECT_LT(seen, 3 * all / 4) << view;
  }
}

/// Explicit steps have no solve: the colour of nothing is that of 0 in the legend.
TEST(StageChange, AStageThatChangesNothingHasTheColourOfNothing) {
  const TemporaryFolder folder;
  view::session::Workbench bench = bench_for(folder, tiny_scene);
  bench.session().show_stage(Stage::implicit_solve);
  const auto live =
      wait_for(bench.session(), [](const LiveFrame& now) { return now.stage.has_value(); });
  const render::Frame frame = frame_of(bench, *live, "particles");
  ASSERT_FALSE(frame.points.value.empty());
  EXPECT_EQ(frame.points.value.front(), 0);
  EXPECT_EQ(frame.points.range_min, frame.legends.at(0).min);
  EXPECT_EQ(frame.points.range_max, frame.legends.at(0).max);
}

/// A picture of a frame says how many steps led to it, one of a stage which step it is.
TEST(StageChange, TheCaptionIsThatOfTheStepThatIsLookedAt) {
  const TemporaryFolder folder;
  view::session::Workbench bench = bench_for(folder, tiny_scene);
  view::session::Session& session = bench.session();
  session.next_frame();
  const auto frame = rest_at(session, 1);
  const auto caption_of = [&](const LiveFrame& live) {
    std::string all;
    for (const std::string& line : frame_of(bench, live, "particles").caption) all += line + "\n";
    return all;
  };
  EXPECT_TRUE(contains(caption_of(*frame), " steps, dt ")) << caption_of(*frame);
  session.show_stage(Stage::elastic_forces);
  const auto live = wait_for(session, [](const LiveFrame& now) { return now.stage.has_value(); });
  const std::string inside = " 1 step, dt " + app::rough_text(live->stage->dt) + " s";
  EXPECT_TRUE(contains(caption_of(*live), inside)) << caption_of(*live);
  EXPECT_FALSE(contains(caption_of(*live), " steps, dt ")) << caption_of(*live);
}

/// Forces are largest where snow is pressed against something: the others still have colours.
TEST(StageChange, TheFewThatArePressedDoNotHideTheOthers) {
  picture::StageChange change;
  change.magnitude.assign(95, 1.0);
  change.magnitude.insert(change.magnitude.end(), 5, 1000.0);
  EXPECT_GE(change.largest(), 1);
  EXPECT_LE(change.largest(), 2);
}

class StageByScript : public Cli {};

TEST_F(StageByScript, EveryStageOfParticlesOrNodesChangesEveryView) {
  std::string script = R"([{"key": "."}, {"wait_for": "simulation frame 1"},
    {"wait_for": "simulation paused"}, {"wait": 20})";
  // Stages 1, 3, 4, 7 and 8; the tiny ball touches nothing with particles in between.
  for (const int view : {1, 2, 3}) {
    const std::string key = std::to_string(view);
    script += R"(, {"key": ")" + key + R"("}, {"wait": 40}, {"screenshot": "whole_)" + key +
              R"(.png", "crop": "picture"}, {"key": ";"}, {"wait": 10}, {"key": ";"}, {"wait": 10},
      {"key": ";"}, {"wait": 40}, {"screenshot": "force_)" +
              key + R"(.png", "crop": "picture"})";
    for (int k = 0; k < 4; ++k) script += R"(, {"key": ";"}, {"wait": 10})";
    script += R"(, {"wait": 40}, {"screenshot": "deformed_)" + key +
              R"(.png", "crop": "picture"}, {"click": "deformation"}, {"wait": 20})";
  }
  folder.write("clicks.json", script + "]");
  const auto result = neve({"view", "scene.toml", "--replay", "clicks.json", "--out", "out"});
  if (result.exit_code == app::exit_no_backend) SKIP_OR_FAIL(result.errors);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto image = [&](const std::string& name, int view) {
    return render::decode_png(
        app::output::read_file(folder / "out" / (name + "_" + std::to_string(view) + ".png")));
  };
  for (const int view : {1, 2, 3}) {
    const render::Image whole = image("whole", view), force = image("force", view),
                        deformed = image("deformed", view);
    const auto differing = [](const render::Image& a, const render::Image& b) {
      std::size_t count = 0;
      for (std::size_t k = 0; k < std::min(a.pixels.size(), b.pixels.size()); ++k)
        count += std::abs(a.pixels[k] - b.pixels[k]) > 24;
      return count;
    };
    EXPECT_GT(differing(whole, force), 1000u) << view;
    EXPECT_GT(differing(force, deformed), 1000u) << view;
  }
}

}  // namespace
}  // namespace neve::test
