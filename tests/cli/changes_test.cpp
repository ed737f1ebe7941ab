/// Changes during a run are repeated from its picture.

#include "app/timeline/changes.h"
#include "app/options/arguments.h"
#include "app/output/atomic_file.h"
#include "app/record/picture_record.h"
#include "app/record/run_json.h"
#include "app/run/render_options.h"
#include "app/scene/read.h"
#include "app/setup/seed_scene.h"
#include "app/sweep/plan/around.h"
#include "tests/support/resume.h"

namespace neve::test {
namespace {

class Changes : public Cli {
 protected:
  /// A session with changes up to the end of frame 4, and its picture of that frame.
  void play(const std::string& more = {}) {
    std::vector<std::string> render{"render", "scene.toml", "--out", "plain", "--frames", "4-4"};
    if (!more.empty()) render.insert(render.end(), {"--set", more});
    ASSERT_EQ(neve(render).exit_code, 0);
    const std::string plain = (folder / "plain/particles/0004.png").string();
    record = app::record::read_picture_record(plain);
    plain_hash = record.state_hash;
    const app::scene::Scene scene = app::scene::read_scene_text(record.scene, "plain");
    sim::Simulation simulation(scene.solver, scene.materials, app::scene::sim_colliders(scene),
                               app::setup::seed_scene(scene).particles, 1);
    const auto set = [&](const std::string& address, const std::string& value) {
      app::scene::note_change(record.changes, {simulation.steps(), address, value});
      const app::scene::Scene now = app::timeline::with_changes(scene, record.changes);
      simulation.apply(now.solver, now.materials, app::scene::sim_colliders(now));
    };
    simulation.advance_to(1.0 / 24);
    simulation.advance_to(2.0 / 24, nullptr, simulation.steps() + 3);
    set("material.snow.youngs_modulus", "4e5");
    set("solver.gravity", "[2, -9.81, 0]");
    simulation.advance_to(2.0 / 24);
    set("collider.floor.shape.plane.point", "[0, 0.01, 0]");
    simulation.advance_to(3.0 / 24);
    simulation.advance_to(4.0 / 24, nullptr, simulation.steps() + 2);
    set("solver.transfer", "mls");
    simulation.advance_to(4.0 / 24);
    ASSERT_FALSE(simulation.divergence());
    record.state_hash = app::record::hash_text(simulation.state_hash());
    app::output::write_file(folder / "session.png",
                            render::encode_png(render::decode_png(app::output::read_file(plain)),
                                               app::record::to_png_text(record)));
  }

  std::vector<std::string> hashes(const std::string& out) {
    std::vector<std::string> all;
    const app::Json run = json_of(out + "/run.json");
    for (const app::Json& frame : run["frames"])
      all.push_back(frame["state_hash"].get<std::string>());
    return all;
  }

  app::record::PictureRecord record;
  std::string plain_hash;
};

TEST_F(Changes, APictureOfASessionIsMadeAgainWithTheSameState) {
  ASSERT_NO_FATAL_FAILURE(play());
  ASSERT_NE(record.state_hash, plain_hash);
  const auto again = neve({"render", "session.png", "--out", "again", "--validate"});
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(hashes("again"), std::vector<std::string>{record.state_hash});
  const app::Json run = json_of("again/run.json");
  EXPECT_EQ(app::scene::live_changes(run["changes"]), record.changes);
  // The picture made again is one that can be made again.
  const auto made = app::record::read_picture_record(folder / "again/particles/0004.png");
  EXPECT_EQ(made.changes, record.changes);
  EXPECT_EQ(made.scene, record.scene);
  ASSERT_EQ(neve({"render", "again/particles/0004.png", "--out", "third"}).exit_code, 0);
  EXPECT_TRUE(app::output::read_file(folder / "third/particles/0004.png") ==
              app::output::read_file(folder / "again/particles/0004.png"));
}

TEST_F(Changes, PicturesBeforeAChangeDoNotListIt) {
  ASSERT_NO_FATAL_FAILURE(play());
  ASSERT_EQ(neve({"render", "session.png", "--out", "all", "--frames", "0-4"}).exit_code, 0);
  std::size_t before = 0;
  for (const char* frame : {"0000", "0001", "0002", "0003", "0004"}) {
    const auto made =
        app::record::read_picture_record(folder / ("all/particles/" + std::string(frame) + ".png"));
    EXPECT_GE(made.changes.size(), before);
    before = made.changes.size();
    const bool is_first = std::string(frame) < "0002";
    EXPECT_EQ(made.changes.empty(), is_first);
    // Each of them leads to its own state.
    const std::string out = "one" + std::string(frame);
    ASSERT_EQ(
        neve({"render", "all/particles/" + std::string(frame) + ".png", "--out", out}).exit_code,
        0);
    EXPECT_EQ(hashes(out), std::vector<std::string>{made.state_hash}) << frame;
  }
  EXPECT_EQ(before, record.changes.size());
}

TEST_F(Changes, AResumedRunMakesTheRestOfThem) {
  ASSERT_NO_FATAL_FAILURE(play());
  const auto render = [&](const char* frames, const char* out, bool is_resumed = false) {
    std::vector<std::string> words{"render", "session.png", "--frames", frames, "--out", out};
    if (is_resumed) words.emplace_back("--resume");
    return neve(words);
  };
  ASSERT_EQ(render("0-4", "whole").exit_code, 0);
  ASSERT_EQ(render("0-2", "parts").exit_code, 0);
  const auto more = render("0-4", "parts", true);
  ASSERT_EQ(more.exit_code, 0) << more.errors;
  EXPECT_TRUE(contains(more.errors, "resumed after frame 2")) << more.errors;
  EXPECT_EQ(hashes("parts"), hashes("whole"));
  EXPECT_EQ(kill_and_resume(folder / "session.png", folder / "killed", {4, 0.4, 7}), 4);
  ASSERT_EQ(
      neve({"render", "session.png", "--out", "killed", "--resume", "--checkpoint-every", "1"})
          .exit_code,
      0);
  EXPECT_EQ(hashes("killed"), std::vector<std::string>{record.state_hash});
  // A run with other changes is another run.
  record.changes.pop_back();
  app::output::write_file(
      folder / "session.png",
      render::encode_png(
          render::decode_png(app::output::read_file(folder / "plain/particles/0004.png")),
          app::record::to_png_text(record)));
  EXPECT_EQ(render("0-4", "parts", true).exit_code, 2);
}

TEST_F(Changes, ChangesAreShownByInfo) {
  ASSERT_NO_FATAL_FAILURE(play());
  const auto info = neve({"info", "session.png"});
  EXPECT_TRUE(contains(info.output, "changed     step ")) << info.output;
  EXPECT_TRUE(contains(info.output, ": material.snow.youngs_modulus = 4e5")) << info.output;
  const app::Json json =
      app::parse_json(std::string_view(neve({"info", "session.png", "--json"}).output));
  EXPECT_EQ(app::scene::live_changes(json["changes"]), record.changes);
  EXPECT_EQ(json["changes"].size(), 4u);
  EXPECT_EQ(json["changes"][0]["address"], "material.snow.youngs_modulus");
  EXPECT_EQ(json["changes"][0]["value"], "4e5");
  EXPECT_GT(json["changes"][0]["step"], 3);
  ASSERT_EQ(neve({"render", "session.png", "--out", "again"}).exit_code, 0);
  EXPECT_TRUE(contains(neve({"info", "again"}).output, "changed     step "));
}

TEST_F(Changes, InvalidChangesAreRefused) {
  ASSERT_NO_FATAL_FAILURE(play());
  const auto image =
      render::decode_png(app::output::read_file(folder / "plain/particles/0004.png"));
  const auto render_with = [&](const std::string& changes) {
    render::PngText text = app::record::to_png_text(record);
    text["neve:changes"] = changes;
    app::output::write_file(folder / "bad.png", render::encode_png(image, text));
    return neve({"render", "bad.png", "--out", "bad"});
  };
  const auto restart =
      render_with(R"([{"step": 3, "address": "solver.cell_size", "value": "0.02"}])");
  EXPECT_EQ(restart.exit_code, 3) << restart.errors;
  EXPECT_TRUE(contains(restart.errors, "solver.cell_size")) << restart.errors;
  EXPECT_EQ(render_with("{").exit_code, 3);
  const auto value = render_with(R"([{"step": 3, "address": "solver.cfl", "value": "-5"}])");
  EXPECT_NE(value.exit_code, 0);
  EXPECT_NE(value.exit_code, 1) << value.errors;
  EXPECT_TRUE(contains(value.errors, "change at step 3: solver.cfl=-5")) << value.errors;
}

TEST_F(Changes, ChangesAreRepeatedInRunsWithRetries) {
  folder.write("scene.toml", std::string(tiny_scene));
  ASSERT_NO_FATAL_FAILURE(play("solver.on_divergence=retry"));
  const auto a = neve({"render", "session.png", "--out", "a", "--frames", "0-4"});
  ASSERT_EQ(a.exit_code, 0) << a.errors;
  ASSERT_EQ(neve({"render", "session.png", "--out", "b", "--frames", "0-3"}).exit_code, 0);
  ASSERT_EQ(neve({"render", "session.png", "--out", "b", "--frames", "0-4", "--resume"}).exit_code,
            0);
  EXPECT_EQ(hashes("a"), hashes("b"));
}

/// Operations of the panels, through the program.
TEST_F(Changes, ASweepAroundAValueRuns) {
  const app::scene::Scene scene = app::scene::read_scene_file((folder / "scene.toml").string());
  for (const app::scene::FlatParam& param : app::scene::flatten(scene))
    if (param.address == "material.snow.hardening")
      folder.write("sweeps/hardening.toml",
                   app::sweep::plan::sweep_around((folder / "scene.toml").string(),
                                                  (folder / "sweeps/hardening.toml").string(),
                                                  param, {app::scene::parse_override("frames=1")}));
  const auto dry = neve({"sweep", "sweeps/hardening.toml", "--dry-run"});
  EXPECT_EQ(dry.exit_code, 0) << dry.errors;
  EXPECT_TRUE(contains(dry.output + dry.errors, "5 runs")) << dry.output << dry.errors;
}

TEST_F(Changes, ACopiedCommandMakesTheSamePicture) {
  app::run::RenderOptions options;
  options.scene = "scene.toml";
  options.overrides = {"title=It's « mine »", "material.snow.hardening=5"};
  options.frames = app::setup::FrameRange{1, 1};
  options.out = "by hand";
  const std::string line = app::options::shell_line(app::options::words_of(options), NEVE_BINARY);
  const auto shell = app::output::run_process("/bin/sh", {"-c", line}, folder.path());
  ASSERT_EQ(shell.exit_code, 0) << shell.errors;
  ASSERT_EQ(neve({"render", "scene.toml", "--set", "title=It's « mine »", "--set",
                  "material.snow.hardening=5", "--frames", "1-1", "--out", "plain"})
                .exit_code,
            0);
  EXPECT_TRUE(app::output::read_file(folder / "by hand/particles/0001.png") ==
              app::output::read_file(folder / "plain/particles/0001.png"));
}

}  // namespace
}  // namespace neve::test
