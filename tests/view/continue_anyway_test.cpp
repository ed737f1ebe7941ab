/// Runs that continue past a broken rule, to watch the snow burst.

#include <gtest/gtest.h>

#include "app/picture/frame_builder.h"
#include "app/scene/read.h"
#include "app/setup/seed_scene.h"
#include "app/support/errors.h"
#include "app/timeline/timeline.h"
#include "tests/support/needs.h"
#include "tests/view/view_support.h"

namespace neve::test {
namespace {

using namespace app;
using view::session::LiveFrame;

/// Steps too long for its sound, but not by much: what bursts can be watched.
constexpr const char* bursting_scene = R"(
frames = 6
[solver]
cell_size = 0.04
time_step = "fixed"
dt = 4e-3
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.12, 0], radius = 0.1 } }
velocity = [0, -3, 0]
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[output]
size = [160, 90]
)";

/// A ball that crosses more than a cell in each step: a broken rule that bursts nothing.
constexpr const char* fast_scene = R"(
frames = 6
[solver]
cell_size = 0.04
time_step = "fixed"
dt = 1e-3
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } }
velocity = [45, 0, 0]
[output]
size = [160, 90]
)";

/// A workbench whose run has broken a rule.
struct Broken {
  explicit Broken(const std::string& text = bursting_scene) : bench(bench_for(folder, text)) {
    bench.session().run();
    broken = wait_for(bench.session(),
                      [](const LiveFrame& live) { return live.divergence.has_value(); });
  }
  const TemporaryFolder folder;
  view::session::Workbench bench;
  std::shared_ptr<const LiveFrame> broken;
};

std::shared_ptr<const LiveFrame> wait_for_ignored(view::session::Session& session) {
  return wait_for(session, [](const LiveFrame& live) {
    return live.snapshot.warnings.rules_ignored > 0 && (live.is_frame_end || live.divergence);
  });
}

/// neve render makes whole frames, and this is none.
TEST(ContinueAnyway, APictureOfABrokenStepSaysThatItIsNotMadeAgain) {
  Broken run;
  ASSERT_FALSE(run.broken->is_frame_end);
  const std::string frame = std::to_string(run.broken->frame);
  run.bench.say_saved_picture("a b.png", *run.broken, false);
  EXPECT_EQ(run.bench.messages().back().text,
            "saved a b.png; it shows step " + std::to_string(run.broken->steps) +
                ", where the run diverged, and only whole frames can be made again; neve render "
                "'a b.png' makes frame " +
                frame);
  run.bench.session().show_frame(0);
  const auto whole =
      wait_for(run.bench.session(), [](const LiveFrame& live) { return live.is_older; });
  run.bench.say_saved_picture("c.png", *whole, false);
  EXPECT_EQ(run.bench.messages().back().text, "saved c.png; neve render c.png makes it again");
}

TEST(ContinueAnyway, ARunContinuesPastItsBrokenRuleAndItsPicturesSaySo) {
  Broken run;
  run.bench.continue_anyway();
  const auto live = wait_for_ignored(run.bench.session());
  EXPECT_GT(live->steps, run.broken->steps);
  EXPECT_EQ(live->snapshot.warnings.first_ignored, run.broken->divergence->step)
      << "up to there it is the same run";
  const scene::Scene scene = run.bench.display_scene(*live);
  const scene::View view = run.bench.document().scene()->views.front();
  const render::Frame frame =
      picture::FrameBuilder(scene, *live->seeded, {}).build(view, live->snapshot);
  const std::string mark = "step " + std::to_string(run.broken->divergence->step) +
                           " broke the rule " + run.broken->divergence->rule +
                           ", which was ignored";
  EXPECT_NE(std::find(frame.caption.begin(), frame.caption.end(), mark), frame.caption.end())
      << mark;
  // It is a change like any other, and waits for nothing.
  EXPECT_TRUE(run.bench.document().is_changed("solver.on_divergence"));
  EXPECT_TRUE(run.bench.waiting_for_reset().empty());
}

TEST(ContinueAnyway, ItsPicturesAreMadeAgainToTheBit) {
  Broken run(fast_scene);
  run.bench.continue_anyway();
  const auto live = wait_for_ignored(run.bench.session());
  ASSERT_FALSE(live->divergence) << live->divergence->sentence;
  const record::PictureRecord record = run.bench.picture_record(*live, live->scene->views.front());
  const scene::Scene start = scene::read_scene_text(record.scene, "record");
  timeline::Timeline timeline(start, record.changes,
                              std::make_shared<setup::SeededScene>(setup::seed_scene(start)), 0);
  timeline.go_to(record.frame / start.fps);
  EXPECT_EQ(timeline.simulation().state_hash(), live->state_hash);
}

class ContinueAnywayByScript : public Cli {};

TEST_F(ContinueAnywayByScript, TheButtonIsBelowTheExplanation) {
  folder.write("scene.toml", bursting_scene);
  folder.write("clicks.json", R"([
    {"click": "Run"}, {"wait_for": "label Continue anyway"}, {"wait": 5},
    {"screenshot": "stopped.png"}, {"click": "Objects"}, {"wait": 3},
    {"click": "Find the parameter"}, {"wait_for": "label solver.dt", "within": 10},
    {"click": "Continue anyway"}, {"wait": 60},
    {"screenshot": "burst.png"}, {"key": "space"}, {"wait": 10}])");
  const auto result = neve({"view", "scene.toml", "--replay", "clicks.json", "--out", "out"});
  if (result.exit_code == app::exit_no_backend) SKIP_OR_FAIL(result.errors);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
}

TEST_F(ContinueAnywayByScript, ACommandMarksTheRecordOfTheRun) {
  folder.write("scene.toml", bursting_scene);
  const auto result = neve({"render", "scene.toml", "--set", "solver.on_divergence=ignore",
                            "--frames", "0-2", "--size", "64x64", "--no-movie", "--quiet"});
  if (result.exit_code == app::exit_no_backend) SKIP_OR_FAIL(result.errors);
  // It may burst beyond all numbers.
  EXPECT_TRUE(result.exit_code == 0 || result.exit_code == app::exit_diverged) << result.errors;
  EXPECT_TRUE(contains(json_of("out/scene/run.json")["warnings"].dump(), "which was ignored"))
      << read_text(folder / "out/scene/run.json");
}

}  // namespace
}  // namespace neve::test
