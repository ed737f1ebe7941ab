/// Changes of a scene while it runs: what is live, what waits, what is taken back, what is kept.

#include <gtest/gtest.h>

#include <array>

#include "app/scene/flat.h"
#include "app/scene/params.h"
#include "app/scene/presets.h"
#include "app/scene/read.h"
#include "app/setup/seed_scene.h"
#include "app/support/errors.h"
#include "app/sweep/read/read_sweep.h"
#include "app/timeline/changes.h"
#include "app/timeline/timeline.h"
#include "app/view/panels/orbit.h"
#include "app/view/panels/pick.h"
#include "tests/view/view_support.h"

namespace {

using namespace neve;
using namespace neve::app;
using namespace neve::test;

/// The state that neve render gets for a picture.
std::uint64_t hash_of_replay(const record::PictureRecord& record) {
  const scene::Scene start = scene::read_scene_text(record.scene, "record");
  timeline::Timeline timeline(start, record.changes,
                              std::make_shared<setup::SeededScene>(setup::seed_scene(start)), 0);
  timeline.go_to(record.frame / start.fps);
  return timeline.simulation().state_hash();
}

/// A workbench with the run of a scene on it.
struct Working {
  explicit Working(const std::string& text = tiny_scene, double coarsening = 1)
      : bench(bench_for(folder, text, coarsening)) {}

  view::session::Session& session() { return bench.session(); }
  void go_to(int frame) {
    session().next_frame();
    rest_at(session(), frame);
  }
  record::PictureRecord picture(const view::session::LiveFrame& live) {
    return bench.picture_record(live, live.scene->views.front());
  }

  const TemporaryFolder folder;
  view::session::Workbench bench;
};

TEST(Document, DocumentTakesBackAndDoesAgain) {
  view::session::Document document("scene.toml", tiny_scene, {}, 1);
  document.set("material.snow.hardening", "5");
  document.set("solver.cfl", "0.3");
  EXPECT_DOUBLE_EQ(document.scene()->materials[0].hardening, 5);
  document.undo();
  document.undo();
  EXPECT_FALSE(document.can_undo());
  EXPECT_DOUBLE_EQ(document.scene()->materials[0].hardening, 10);
  document.redo();
  EXPECT_DOUBLE_EQ(document.scene()->materials[0].hardening, 5);
  EXPECT_DOUBLE_EQ(document.scene()->solver.cfl, 0.4);
  document.set("solver.max_dt", "5e-4");
  EXPECT_FALSE(document.can_redo());
  document.forget("");
  EXPECT_TRUE(document.changes().empty());
  EXPECT_DOUBLE_EQ(document.scene()->solver.max_dt, 1e-3);
}

TEST(Document, OneDragIsOneUndo) {
  view::session::Document document("scene.toml", tiny_scene, {}, 1);
  for (const char* value : {"9", "8", "7"}) document.set("material.snow.hardening", value, 42);
  document.set("material.snow.hardening", "3", 43);
  document.undo();
  EXPECT_DOUBLE_EQ(document.scene()->materials[0].hardening, 7);
  document.undo();
  EXPECT_DOUBLE_EQ(document.scene()->materials[0].hardening, 10);
}

TEST(Document, DocumentRefusesInvalidEditsAndStaysTheSame) {
  view::session::Document document("scene.toml", tiny_scene, {}, 1);
  document.set("material.snow.hardening", "5");
  EXPECT_THROW(document.set("material.snow.poisson_ratio", "0.7"), UsageError);
  EXPECT_THROW(document.set("material.snow.poison_ratio", "0.1"), UsageError);
  EXPECT_EQ(document.changes().size(), 1u);
  EXPECT_DOUBLE_EQ(document.scene()->materials[0].poisson_ratio, 0.2);
}

TEST(Document, DocumentKeepsTheCameraWhileKnobsAreTurned) {
  view::session::Document document("scene.toml", tiny_scene, {}, 1);
  const sim::Vec3d eye = *document.scene()->camera->eye;
  document.set("body.ball.velocity", "[3, -2, 0]");
  EXPECT_EQ(*document.scene()->camera->eye, eye);
}

// One list of concerns decides the time of a change and its entry in a picture.
TEST(Document, DocumentKnowsTheScopeOfEveryParameter) {
  for (const scene::ParamInfo& info : scene::params()) {
    const bool is_drawn = scene::concern_of(info.address) == scene::Concern::pictures &&
                          info.address != "first_frame";
    EXPECT_EQ(view::session::effect_of(info.address) == view::session::Effect::display, is_drawn)
        << info.address;
    if (!is_drawn && info.address.find('[') == std::string::npos) {
      EXPECT_EQ(view::session::effect_of(info.address) == view::session::Effect::live, info.is_live)
          << info.address;
    }
  }
  EXPECT_EQ(view::session::effect_of("frames"), view::session::Effect::live);
  EXPECT_FALSE(scene::concerns_simulation("frames"));
  EXPECT_EQ(view::session::effect_of("limits.particles"), view::session::Effect::restart);
  EXPECT_FALSE(scene::concerns_simulation("limits.particles"));
}

TEST(Workbench, ChangesAreReplayedToTheBit) {
  Working work;
  work.go_to(1);
  work.bench.set("material.snow.youngs_modulus", "30000");
  work.session().next_step();
  wait_for(work.session(), [](const view::session::LiveFrame& live) {
    return !live.is_running && !live.is_frame_end;
  });
  work.bench.set("solver.gravity", "[2, -9.81, 0]");
  work.bench.set("material.snow.youngs_modulus", "50000");
  work.session().run();
  const auto live = rest_at(work.session(), 4);
  const record::PictureRecord record = work.picture(*live);
  ASSERT_EQ(record.changes.size(), 3u);
  EXPECT_DOUBLE_EQ(scene::read_scene_text(record.scene, "record").materials[0].youngs_modulus,
                   1.4e5);
  EXPECT_EQ(hash_of_replay(record), live->state_hash);
}

/// Undone or abandoned changes are no longer part of the run; later changes are.
TEST(Workbench, ARunContinuedFromAnOlderFrameIsReplayedToTheBit) {
  Working work;
  work.go_to(1);
  work.bench.set("material.snow.youngs_modulus", "30000");
  work.go_to(2);
  work.bench.set("collider.floor.shape.plane.point", "[0, 0.01, 0]");
  work.go_to(3);
  work.bench.undo();
  work.bench.undo();
  work.bench.set("solver.gravity", "[2, -9.81, 0]");
  work.session().show_frame(2);
  wait_for(work.session(),
           [](const view::session::LiveFrame& live) { return live.is_older && live.frame == 2; });
  work.bench.continue_from_here();
  work.session().run();
  const auto live = rest_at(work.session(), 4);
  const record::PictureRecord record = work.picture(*live);
  EXPECT_EQ(hash_of_replay(record), live->state_hash);
  const scene::Scene last =
      timeline::with_changes(scene::read_scene_text(record.scene, "record"), record.changes);
  EXPECT_DOUBLE_EQ(last.materials[0].youngs_modulus, 1.4e5);
  EXPECT_DOUBLE_EQ(last.solver.gravity.x(), 2);
}

TEST(Workbench, APictureOfACameraThatPushesInCanBeMadeAgain) {
  Working work(std::string(tiny_scene) + "\n[camera]\npush_in = true\n");
  work.session().next_frame();
  const auto live = rest_at(work.session(), 1);
  const scene::Scene again = scene::read_scene_text(work.picture(*live).scene, "record");
  EXPECT_FALSE(again.camera->push_in);
}

/// A coarsened scene has other values than were typed; pictures keep those that the run had.
TEST(Workbench, ChangesOfACoarsenedRunAreReplayedToTheBit) {
  Working work(tiny_scene, 1.5);
  work.go_to(1);
  work.bench.set("solver.max_dt", "2e-4");
  work.go_to(2);
  work.bench.undo();
  work.session().run();
  const auto live = rest_at(work.session(), 4);
  const record::PictureRecord record = work.picture(*live);
  ASSERT_EQ(record.changes.size(), 2u);
  EXPECT_NEAR(std::stod(record.changes[0].value), 3e-4, 1e-15);
  EXPECT_NEAR(std::stod(record.changes[1].value), 1.5e-3, 1e-15);
  EXPECT_EQ(hash_of_replay(record), live->state_hash);
}

/// A picture of a paused run shows what was changed at that very moment, and so does its replay.
TEST(Workbench, APausedChangeBelongsToThePicture) {
  Working work;
  work.go_to(1);
  work.bench.set("solver.transfer", "apic");
  work.go_to(2);
  work.bench.set("solver.transfer", "flip");
  const auto live = wait_for(work.session(), [](const view::session::LiveFrame& now) {
    return now.is_frame_end && now.scene->solver.transfer == sim::Transfer::flip;
  });
  const record::PictureRecord record = work.picture(*live);
  EXPECT_EQ(record.changes.size(), 2u);
  EXPECT_EQ(hash_of_replay(record), live->state_hash);
}

TEST(Document, DocumentKeepsAPresetAsTheNumbersThatItChanges) {
  view::session::Document document("scene.toml", tiny_scene, {}, 1);
  document.set("material.snow.preset", "\"lower_hardening\"");
  ASSERT_EQ(document.changes().size(), 1u);
  EXPECT_EQ(document.changes()[0].address, "material.snow.hardening");
  document.set("material.snow.hardening", "3");
  document.set("material.snow.preset", "icy");
  EXPECT_EQ(scene::preset_of(document.scene()->materials[0]), scene::Preset::icy);
  document.undo();
  EXPECT_DOUBLE_EQ(document.scene()->materials[0].hardening, 3);
  EXPECT_DOUBLE_EQ(document.scene()->materials[0].density, 400);
  document.redo();
  document.forget("material.snow.preset");
  EXPECT_TRUE(document.changes().empty());
  EXPECT_THROW(document.set("material.snow.preset", "icey"), UsageError);
  EXPECT_THROW(document.set("material.ice.preset", "icy"), UsageError);
}

TEST(Document, DocumentKnowsTheNumbersOfAPresetInTheFile) {
  const std::string text = std::string(tiny_scene) + "[material.snow]\npreset = \"wet\"\n";
  view::session::Document document("scene.toml", text, {}, 1);
  EXPECT_EQ(document.in_file("material.snow.hardening"), "5");
  EXPECT_EQ(document.in_file("material.snow.model"), "\"snow\"");
  view::session::Document set("scene.toml", text,
                              {scene::parse_override("material.snow.preset=icy")}, 1);
  EXPECT_EQ(set.in_file("material.snow.hardening"), "20");
}

TEST(Workbench, APresetChosenWhileItRunsIsReplayedToTheBit) {
  Working work(std::string(tiny_scene) + "[material.snow]\npreset = \"wet\"\n");
  work.go_to(1);
  work.bench.set("material.snow.preset", "icy");
  EXPECT_EQ(work.bench.waiting_for_reset(), (std::vector<std::string>{"material.snow.density"}));
  work.go_to(2);
  work.bench.forget("material.snow.hardening");  // back to that of "wet", not to the default
  work.session().run();
  const auto live = rest_at(work.session(), 4);
  EXPECT_DOUBLE_EQ(live->scene->materials[0].density, 500);
  EXPECT_DOUBLE_EQ(live->scene->materials[0].hardening, 5);
  const record::PictureRecord record = work.picture(*live);
  ASSERT_EQ(record.changes.size(), 10u);  // the numbers of a preset but density
  EXPECT_EQ(scene::preset_of(scene::read_scene_text(record.scene, "record").materials[0]),
            scene::Preset::wet);
  EXPECT_EQ(hash_of_replay(record), live->state_hash);
}

TEST(Workbench, ChangesThatNeedARestartWaitForItUnlessNothingIsLost) {
  Working work;
  work.bench.set("body.ball.shape.sphere.radius", "0.1");
  EXPECT_TRUE(work.bench.waiting_for_reset().empty());
  const auto grown = wait_for(work.session(), [](const view::session::LiveFrame& live) {
    return live.scene->bodies[0].shape.form.index() == 0 &&
           std::get<sim::shapes::Sphere>(live.scene->bodies[0].shape.form).radius > 0.09;
  });
  work.session().next_frame();
  const auto later = rest_at(work.session(), 1);
  EXPECT_EQ(later->snapshot.particles.x.size(), grown->snapshot.particles.x.size());
  work.bench.set("material.snow.density", "200");
  work.bench.set("material.snow.hardening", "5");
  EXPECT_EQ(work.bench.waiting_for_reset(), (std::vector<std::string>{"material.snow.density"}));
  const auto applied = wait_for(work.session(), [](const view::session::LiveFrame& live) {
    return live.scene->materials[0].hardening == 5;
  });
  EXPECT_EQ(applied->frame, 1);
  EXPECT_DOUBLE_EQ(applied->scene->materials[0].density, 400);
  work.bench.reset();
  const auto restarted = wait_for(
      work.session(), [](const view::session::LiveFrame& live) { return live.steps == 0; });
  EXPECT_DOUBLE_EQ(restarted->scene->materials[0].density, 200);
  EXPECT_TRUE(work.bench.waiting_for_reset().empty());
  EXPECT_TRUE(restarted->snapshot.changes.empty());
}

/// A picture has one number, in its name, in its caption and in its record.
TEST(Workbench, FramesKeepTheirNumbersUntilReset) {
  Working work;
  work.go_to(1);
  work.bench.set("first_frame", "1001");
  EXPECT_EQ(work.bench.waiting_for_reset(), std::vector<std::string>{"first_frame"});
  const auto live = work.session().latest();
  EXPECT_EQ(scene::number_of(*live->scene, live->frame), 1);
  EXPECT_EQ(work.picture(*live).frame, 1);
  EXPECT_EQ(scene::number_of(work.bench.display_scene(*live), live->frame), 1);
  work.bench.reset();
  const auto again = wait_for(
      work.session(), [](const view::session::LiveFrame& frame) { return frame.steps == 0; });
  EXPECT_EQ(scene::number_of(*again->scene, again->frame), 1001);
  EXPECT_EQ(work.picture(*again).frame, 1001);
}

TEST(Workbench, WorkbenchSavesTheSceneWithItsComments) {
  Working work("# mine\n" + std::string(tiny_scene) + "# the end\n");
  work.bench.set("solver.cell_size", "0.05");
  work.bench.save_scene(work.folder / "saved.toml");
  const std::string text = read_text(work.folder / "saved.toml");
  EXPECT_TRUE(text.starts_with("# mine\n"));
  EXPECT_TRUE(text.ends_with("# the end\n"));
  EXPECT_DOUBLE_EQ(scene::read_scene_text(text, "saved").solver.cell_size, 0.05);
  EXPECT_EQ(work.bench.messages().back().kind, view::session::Message::Kind::note);
}

TEST(Workbench, WorkbenchWritesASweepAroundAValue) {
  Working work;
  work.bench.set("material.snow.hardening", "5");
  const std::filesystem::path file = work.bench.sweep_around("material.snow.hardening");
  ASSERT_TRUE(std::filesystem::exists(file)) << work.bench.messages().back().text;
  EXPECT_TRUE(contains(read_text(file), "material.snow.hardening"));
}

TEST(Workbench, ASweepReplacesNoFileButOneWithItsText) {
  Working work;
  const std::string address = "material.snow.hardening";
  const std::filesystem::path mine =
      work.folder.write("out/sweep_material_snow_hardening.toml", "# mine\n");
  const std::filesystem::path file = work.bench.sweep_around(address);
  EXPECT_EQ(read_text(mine), "# mine\n");
  EXPECT_EQ(file.filename(), "sweep_material_snow_hardening_2.toml");
  EXPECT_TRUE(contains(work.bench.messages().back().text, file.string()));
  EXPECT_EQ(work.bench.sweep_around(address), file) << "the text is the same";
  work.bench.set(address, "5");
  EXPECT_EQ(work.bench.sweep_around(address).filename(), "sweep_material_snow_hardening_3.toml");
}

// The sweep's runs are as coarse as the run was that it comes from, and not twice as coarse.
TEST(Workbench, ASweepOfACoarsenedRunSaysHowCoarse) {
  Working work(tiny_scene, 1.5);
  const std::filesystem::path file = work.bench.sweep_around("solver.cell_size");
  ASSERT_TRUE(std::filesystem::exists(file)) << work.bench.messages().back().text;
  const std::string text = read_text(file);
  EXPECT_TRUE(contains(text, "--coarsen 1.5\n")) << text;
  EXPECT_TRUE(contains(text, "around its value of 0.04 m")) << text;
  EXPECT_TRUE(contains(work.bench.messages().back().text, "--coarsen 1.5"))
      << work.bench.messages().back().text;
}

TEST(Workbench, ASweepSaysWhatWasChangedWhileItRan) {
  Working work;
  work.bench.set("material.snow.hardening", "5");  // before the first step
  work.go_to(1);
  work.bench.set("material.snow.youngs_modulus", "30000");
  const std::string text = read_text(work.bench.sweep_around("solver.cfl"));
  const std::size_t comment = text.find("# Changed during the run");
  ASSERT_NE(comment, std::string::npos) << text;
  const std::string list = text.substr(comment, text.find("[sweep]") - comment);
  EXPECT_TRUE(contains(list, "material.snow.youngs_modulus")) << text;
  EXPECT_FALSE(contains(list, "material.snow.hardening")) << text;
  EXPECT_TRUE(contains(work.bench.messages().back().text, "material.snow.youngs_modulus"));
}

TEST(Document, ReadAgainItHasTheAutomaticCameraOfTheNewText) {
  std::string text = tiny_scene;
  text.replace(text.find("radius = 0.08"), 13, "radius = 0.24");
  const auto eye = [](const view::session::Document& document) {
    return *document.scene()->camera->eye;
  };
  view::session::Document document("scene.toml", tiny_scene, {}, 1);
  document.set("material.snow.hardening", "5");
  document.reload(text);
  EXPECT_EQ(eye(document), eye(view::session::Document("scene.toml", text, {}, 1)));
  // Edits and their undo stay, and so does everything where the text is no scene.
  EXPECT_DOUBLE_EQ(document.scene()->materials[0].hardening, 5);
  EXPECT_THROW(document.reload("[nonsense\n"), std::exception);
  EXPECT_TRUE(document.is_changed("material.snow.hardening"));
  document.undo();
  EXPECT_DOUBLE_EQ(document.scene()->materials[0].hardening, 10);
}

TEST(Workbench, ASavedSceneAndACommandSayWhatWasChangedWhileItRan) {
  Working work;
  work.bench.set("material.snow.hardening", "5");  // before the first step
  ASSERT_TRUE(work.bench.save_scene(work.folder / "out" / "early.toml"));
  EXPECT_FALSE(contains(work.bench.messages().back().text, "during the run"));
  work.go_to(1);
  work.bench.set("material.snow.youngs_modulus", "30000");
  ASSERT_TRUE(work.bench.save_scene(work.folder / "out" / "late.toml"));
  const std::string saved = work.bench.messages().back().text;
  EXPECT_TRUE(contains(saved,
                       "; material.snow.youngs_modulus changed during the run, and the saved scene "
                       "has it from the start: a picture that is saved makes the run again"))
      << saved;
  EXPECT_FALSE(work.bench.command().empty());
  const std::string copied = work.bench.messages().back().text;
  EXPECT_TRUE(contains(copied, "youngs_modulus changed during the run, and its run has it"))
      << copied;
}

TEST(Workbench, WorkbenchNoticesAChangedFile) {
  Working work;
  EXPECT_FALSE(work.bench.has_file_changed());
  std::string text = tiny_scene;
  text.replace(text.find("0.04"), 4, "0.05");
  work.folder.write("scene.toml", text);
  std::filesystem::last_write_time(
      work.folder / "scene.toml",
      std::filesystem::last_write_time(work.folder / "scene.toml") + std::chrono::seconds(2));
  EXPECT_TRUE(work.bench.has_file_changed());
  work.bench.reload();
  EXPECT_DOUBLE_EQ(work.bench.document().scene()->solver.cell_size, 0.05);
  EXPECT_FALSE(work.bench.has_file_changed());
}

/// Another text in the scene's file, written a while after the last one.
void change_file(const Working& work, const std::string& text) {
  const std::filesystem::path file = work.folder / "scene.toml";
  const auto before = std::filesystem::last_write_time(file);
  work.folder.write("scene.toml", text);
  std::filesystem::last_write_time(file, before + std::chrono::seconds(2));
}

// The offer to reload stays until it works, or until the file is another one again.
TEST(Workbench, AFailedReloadSaysWhereAndLeavesTheFileChanged) {
  Working work;
  const std::uint64_t before = work.bench.errors_said();
  change_file(work, std::string(tiny_scene) + "[nonsense\n");
  work.bench.reload();
  EXPECT_TRUE(work.bench.has_file_changed());
  EXPECT_TRUE(contains(work.bench.reload_error(), "scene.toml:")) << work.bench.reload_error();
  EXPECT_EQ(work.bench.messages().back().kind, view::session::Message::Kind::error);
  EXPECT_EQ(work.bench.errors_said(), before + 1);
  work.bench.reload();
  EXPECT_EQ(work.bench.errors_said(), before + 2) << "the same error is one to be seen again";
  change_file(work, tiny_scene);
  EXPECT_EQ(work.bench.reload_error(), "") << "of a file that is not there any more";
  EXPECT_TRUE(work.bench.has_file_changed());
  work.bench.reload();
  EXPECT_FALSE(work.bench.has_file_changed());
  EXPECT_EQ(work.bench.reload_error(), "");
  EXPECT_EQ(work.bench.messages().back().kind, view::session::Message::Kind::note);
}

/// It is the work of an editor, which only who keeps the scene gives up.
TEST(Workbench, AFileThatWasChangedMeanwhileIsNotReplaced) {
  Working work;
  const std::filesystem::path file = work.folder / "scene.toml";
  const std::string edited = std::string(tiny_scene) + "# of an editor\n";
  change_file(work, edited);
  EXPECT_FALSE(work.bench.save_scene(file));
  EXPECT_TRUE(contains(work.bench.messages().back().text, "was changed on disk"));
  EXPECT_EQ(read_text(file), edited);
  EXPECT_TRUE(work.bench.has_file_changed()) << "the offer to reload stays";
  work.bench.keep_file();
  EXPECT_TRUE(work.bench.save_scene(file));
}

/// A box of three particles from a file, which may go away.
constexpr const char* from_points = R"(
frames = 4
[solver]
cell_size = 0.1
[[body]]
name = "grains"
shape = { points = { file = "grains.ply", spacing = 0.05 } }
velocity = [0, -3, 0]
[[view]]
name = "particles"
)";
constexpr const char* grains =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nend_header\n0 1 0\n0.05 1 0\n0.1 1 0\n";

TEST(Workbench, AResetThatFailsLeavesTheRecordOfTheRunThatIsShown) {
  const TemporaryFolder folder;
  folder.write("grains.ply", grains);
  view::session::Workbench bench = bench_for(folder, from_points);
  view::session::Session& session = bench.session();
  session.next_frame();
  const auto before = rest_at(session, 1);
  bench.set("body.grains.velocity", "[0, 9, 0]");
  EXPECT_EQ(bench.waiting_for_reset(), std::vector<std::string>{"body.grains.velocity"});
  std::filesystem::remove(folder / "grains.ply");
  bench.reset();
  const auto after =
      wait_for(session, [](const view::session::LiveFrame& live) { return live.errors == 1; });
  EXPECT_EQ(after->state_hash, before->state_hash);
  folder.write("grains.ply", grains);
  EXPECT_EQ(bench.waiting_for_reset(), std::vector<std::string>{"body.grains.velocity"});
  EXPECT_TRUE(bench.overrides(*after).empty());
  const record::PictureRecord record = bench.picture_record(*after, after->scene->views.front());
  EXPECT_EQ(hash_of_replay(record), after->state_hash);
  // The next one succeeds, and is what is recorded then.
  bench.reset();
  const auto next =
      wait_for(session, [](const view::session::LiveFrame& live) { return live.start == 2; });
  EXPECT_TRUE(bench.waiting_for_reset().empty());
  EXPECT_EQ(bench.overrides(*next), std::vector<std::string>{"body.grains.velocity=[0, 9, 0]"});
  EXPECT_TRUE(bench.overrides(*after).empty()) << "a picture of the earlier run has its own";
}

TEST(Workbench, ACopyOfTheSceneReplacesNoFileButAnEarlierCopy) {
  const TemporaryFolder folder;
  view::session::WorkbenchOptions options;
  options.folder = folder.path();
  view::session::Workbench bench(
      view::session::open_document(folder.write("scene.toml", tiny_scene), {}, 1).document, options,
      {});
  bench.set("material.snow.hardening", "17");
  EXPECT_EQ(bench.save_copy(), folder / "scene_2.toml");
  EXPECT_EQ(read_text(folder / "scene.toml"), tiny_scene);
  EXPECT_TRUE(contains(read_text(folder / "scene_2.toml"), "hardening = 17"));
  bench.set("material.snow.hardening", "18");
  EXPECT_EQ(bench.save_copy(), folder / "scene_2.toml");
  EXPECT_TRUE(contains(read_text(folder / "scene_2.toml"), "hardening = 18"));
}

TEST(Workbench, ACopyOfTheSceneFindsItsFiles) {
  const TemporaryFolder folder;
  folder.write("grains.ply", grains);
  view::session::Workbench bench = bench_for(folder, "# mine" + std::string(from_points));
  bench.set("body.grains.velocity", "[0, 2, 0]");
  const std::filesystem::path copy = bench.save_copy();
  ASSERT_EQ(copy, folder / "out" / "scene.toml") << bench.messages().back().text;
  const scene::Scene saved = scene::read_scene_file(copy.string());
  EXPECT_EQ(saved.bodies[0].velocity.y(), 2);
  EXPECT_TRUE(read_text(copy).starts_with("# mine"));
  EXPECT_EQ(bench.save_copy(), copy) << "the same text again";
  // The words of the scene find the files from its own folder.
  ASSERT_TRUE(bench.save_scene(folder / "scene.toml"));
  const std::string text = read_text(folder / "scene.toml");
  EXPECT_TRUE(text.starts_with("# mine") && contains(text, "\"grains.ply\"")) << text;
  EXPECT_FALSE(bench.has_file_changed());
}

TEST(Workbench, WorkbenchReportsRefusedValues) {
  Working work;
  work.bench.edit(
      {view::session::Edit::Kind::refused, "solver.cfl", "not accepted; expected 0 < value", 0});
  EXPECT_EQ(work.bench.messages().back().text, "solver.cfl: not accepted; expected 0 < value");
  EXPECT_EQ(work.bench.messages().back().kind, view::session::Message::Kind::error);
  EXPECT_TRUE(work.bench.document().changes().empty());
}

/// A person follows the advice after a divergence: change a parameter, and reset or go back.
TEST(Workbench, AChangeBeyondTheLimitsIsAMessageAndChangesNothing) {
  Working work(std::string("limits.particles = 5000\n") + tiny_scene);
  const auto before = work.bench.document().scene();
  for (const auto& [address, value, name] :
       {std::array{"output.size", "[16384, 16384]", "limits.pixels"},
        {"solver.cell_size", "0.005", "limits.particles"},
        {"body.ball.particles_per_cell", "1000", "limits.particles"}}) {
    work.bench.set(address, value);
    const view::session::Message& last = work.bench.messages().back();
    EXPECT_EQ(last.kind, view::session::Message::Kind::error) << address;
    EXPECT_TRUE(contains(last.text, name)) << last.text;
    EXPECT_EQ(work.bench.document().scene(), before) << address;
  }
  work.bench.set("output.size", "[320, 180]");
  EXPECT_EQ(work.bench.document().scene()->size.width, 320);
}

TEST(Workbench, FromElsewhereNoFileIsNamedAndNoneIsWrittenOutside) {
  const TemporaryFolder folder;
  folder.write("secret.csv", "password\nhunter2\n");
  folder.write("points.csv", "x,y,z,volume\n0,0.1,0,1e-6\n0,0.2,0,1e-6\n");
  const std::string text = std::string(tiny_scene) +
                           "[[body]]\nname = \"cloud\"\n"
                           "shape = { points = { file = \"points.csv\" } }\n";
  view::session::WorkbenchOptions options;
  options.folder = folder / "out";
  options.is_remote = true;
  view::session::Workbench bench(
      view::session::open_document(folder.write("scene.toml", text), {}, 1).document, options, {});
  const auto refused = [&](const std::string& address, const std::string& value) {
    const std::uint64_t before = bench.errors_said();
    bench.set(address, value);
    EXPECT_EQ(bench.errors_said(), before + 1) << address;
    EXPECT_FALSE(contains(bench.messages().back().text, "hunter2"));
    return bench.messages().back().text;
  };
  const std::string secret = "\"" + (folder / "secret.csv").string() + "\"";
  EXPECT_TRUE(contains(refused("body.cloud.shape.points.file", secret), "over the web"));
  EXPECT_TRUE(contains(refused("body.cloud.shape", "{ points = { file = " + secret + " } }"),
                       "over the web"));
  EXPECT_TRUE(
      contains(refused("body.cloud.shape", "{ points = { \"f\\u0069le\" = " + secret + " } }"),
               "over the web"));
  const std::string pattern = "\"" + (folder / "secret_%d.obj").string() + "\"";
  EXPECT_TRUE(contains(
      refused("collider.floor.shape", "{ mesh_sequence = { files = " + pattern + ", last = 2 } }"),
      "over the web"));
  EXPECT_TRUE(contains(refused("limits.memory", "\"1TiB\""), "over the web"));
  EXPECT_TRUE(contains(refused("limits", "{ memory = \"1TiB\" }"), "over the web"));
  EXPECT_FALSE(bench.may_save_over_file());
  bench.save_scene(folder / "scene.toml");
  EXPECT_TRUE(contains(bench.not_saved(), "over the web")) << bench.not_saved();
  EXPECT_EQ(read_text(folder / "scene.toml"), text);
  bench.set("body.ball.velocity", "[0, -1, 0]");
  bench.save_scene(folder / "out/scene.toml");
  EXPECT_TRUE(contains(read_text(folder / "out/scene.toml"), "velocity = [0, -1, 0]"));
}

/// A folder may be named with a slash at its end.
TEST(Workbench, FromElsewhereFilesAreWrittenIntoAFolderHoweverItIsNamed) {
  const TemporaryFolder folder;
  view::session::WorkbenchOptions options;
  options.is_remote = true;
  options.folder = folder.path() / "out" / "";
  view::session::Workbench bench(
      view::session::open_document(folder.write("scene.toml", tiny_scene), {}, 1).document, options,
      {});
  EXPECT_EQ(bench.save_copy(), folder / "out" / "scene.toml") << bench.not_saved();
  EXPECT_EQ(bench.folder(), folder / "out");
}

TEST(Workbench, AChangeAfterADivergenceWaitsAndIsNoError) {
  Working work(exploding_scene);
  work.session().run();
  wait_for(work.session(), [](const view::session::LiveFrame& live) {
    return live.divergence.has_value() && !live.is_running;
  });
  const std::uint64_t errors = work.bench.errors_said();
  work.bench.set("solver.dt", "1e-5");
  EXPECT_EQ(work.bench.waiting_for_reset(), std::vector<std::string>{"solver.dt"});
  EXPECT_EQ(work.bench.messages().back().text,
            "solver.dt: this run has diverged; the change takes effect at Reset, or after going "
            "back to an earlier frame");
  // The same while an older frame is shown, and continued from there it counts.
  work.session().show_frame(0);
  wait_for(work.session(), [](const view::session::LiveFrame& live) { return live.is_older; });
  work.bench.set("material.snow.youngs_modulus", "1e5");
  EXPECT_EQ(work.bench.waiting_for_reset().size(), 2u);
  work.bench.continue_from_here();
  const auto live = wait_for(work.session(), [](const view::session::LiveFrame& shown) {
    return !shown.is_older && shown.scene->solver.dt == 1e-5;
  });
  EXPECT_EQ(live->scene->materials[0].youngs_modulus, 1e5);
  EXPECT_TRUE(work.bench.waiting_for_reset().empty());
  EXPECT_FALSE(live->divergence);
  work.go_to(1);
  EXPECT_EQ(work.bench.errors_said(), errors);
  EXPECT_TRUE(work.session().latest()->error.empty()) << work.session().latest()->error;
}

TEST(Workbench, FailuresAreErrorsToBeSeen) {
  Working work;
  const std::uint64_t before = work.bench.errors_said();
  work.folder.write("file", "");
  work.bench.save_scene(work.folder / "file" / "scene.toml");
  EXPECT_EQ(work.bench.errors_said(), before + 1);
  work.bench.sweep_around("no.such.thing");
  EXPECT_EQ(work.bench.errors_said(), before + 2);
}

TEST(Orbit, OrbitStartsWhereTheCameraIs) {
  const sim::Vec3d eye(1.5, 0.9, 2.0), target(0.1, 0.2, -0.3);
  const view::panels::Orbit orbit(eye, target, {0, 1, 0}, 30);
  EXPECT_LT((orbit.eye() - eye).norm(), 1e-12);
}

TEST(Orbit, OrbitZoomsTowardsTheMouse) {
  view::panels::Orbit orbit({1.5, 0.9, 2.0}, {0, 0, 0}, {0, 1, 0}, 30);
  // A point at the target's distance under the mouse stays under it.
  const sim::Vec3d ray = orbit.ray(0.3, -0.2);
  const sim::Vec3d point = orbit.eye() + ray * (orbit.distance() / ray.dot(orbit.forward()));
  orbit.zoom(3, 0.3, -0.2);
  const sim::Vec3d place = orbit.project(point);
  EXPECT_NEAR(place.x(), 0.3, 1e-9);
  EXPECT_NEAR(place.y(), -0.2, 1e-9);
}

TEST(Orbit, FramesABoxAndLooksAlongAxes) {
  view::panels::Orbit orbit;
  orbit.frame({{-1, 0, -1}, {1, 2, 1}}, 1.5);
  for (int corner = 0; corner < 8; ++corner) {
    const sim::Vec3d p =
        orbit.project({corner & 1 ? 1.0 : -1.0, corner & 2 ? 2.0 : 0.0, corner & 4 ? 1.0 : -1.0});
    EXPECT_LT(std::abs(p.x()), 0.75) << corner;
    EXPECT_LT(std::abs(p.y()), 0.5) << corner;
  }
  orbit.look_along(0);
  EXPECT_NEAR(orbit.forward().x(), -1, 1e-9);
  orbit.look_along(0);
  EXPECT_NEAR(orbit.forward().x(), 1, 1e-9);
}

TEST(Pick, PickingFindsTheNearestParticleUnderTheMouse) {
  const view::panels::Orbit orbit({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 30);
  view::session::LiveFrame live;
  app::setup::SeededScene seeded;
  seeded.spacing = 0.1;
  live.seeded = std::make_shared<app::setup::SeededScene>(seeded);
  live.snapshot.particles.x = {{0, 0, -1}, {0, 0, 1}, {0.5, 0, 2}};
  EXPECT_EQ(view::panels::pick_particle(orbit, 0, 0, live), std::optional<std::size_t>(1));
  const sim::Vec3d third = orbit.project({0.5, 0, 2});
  EXPECT_EQ(view::panels::pick_particle(orbit, third.x(), third.y(), live),
            std::optional<std::size_t>(2));
  EXPECT_FALSE(view::panels::pick_particle(orbit, -0.4, 0.3, live));
}

}  // namespace
