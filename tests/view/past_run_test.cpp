/// A run that exists, opened by neve view: its time line, without simulating what is kept.

#include <gtest/gtest.h>

#include <cmath>

#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/support/errors.h"
#include "app/timeline/timeline.h"
#include "tests/view/view_support.h"

namespace neve::test {
namespace {

using namespace neve::app;

class PastRun : public Cli {
 protected:
  void render(const std::vector<std::string>& more) {
    std::vector<std::string> words{"render", "--no-movie"};
    words.insert(words.end(), more.begin(), more.end());
    const auto done = neve(words);
    ASSERT_EQ(done.exit_code, 0) << done.errors;
  }

  view::session::Workbench open(const std::string& run) {
    view::session::Opened opened = view::session::open_document((folder / run).string(), {}, 1);
    view::session::WorkbenchOptions options;
    options.folder = folder / "view";
    options.session.past = opened.past;
    return {std::move(opened.document), options, {}};
  }

  std::string hash_of(const view::session::LiveFrame& live) {
    return record::hash_text(live.state_hash);
  }
};

/// s, in steps that the simulation of the session has taken itself.
double seconds_of_steps(const view::session::LiveFrame& live) {
  const sim::PhaseSeconds& p = live.phases;
  return p.partition + p.particles_to_grid + p.grid_update + p.solve + p.grid_to_particles;
}

TEST_F(PastRun, AFinishedRunIsScrubbedWithoutAStep) {
  render({"scene.toml", "--out", "a", "--keep-states"});
  view::session::Workbench bench = open("a");
  view::session::Session& session = bench.session();
  auto live = session.latest();
  EXPECT_EQ(live->frame, 4);
  EXPECT_EQ(live->kept, (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(live->history.size(), 5u);
  ASSERT_EQ(live->samples->size(), 5u);
  EXPECT_NEAR((*live->samples)[2].time, 2 / 24.0, 1e-12);
  EXPECT_GT((*live->samples)[2].kinetic_energy, 0);
  EXPECT_TRUE(std::isnan((*live->samples)[0].dt)) << "frame 0 has no steps";
  EXPECT_GT((*live->samples)[1].dt, 0);
  EXPECT_GT(live->snapshot.advance.steps, 0u) << "the caption tells the steps of the frame";
  EXPECT_EQ(hash_of(*live), hashes("a")[4]);
  for (const int frame : {2, 0, 3, 1}) {
    session.show_frame(frame);
    live = wait_for(session, [&](const view::session::LiveFrame& other) {
      return other.is_older && other.frame == frame;
    });
    EXPECT_EQ(hash_of(*live), hashes("a")[frame]) << frame;
    EXPECT_EQ(live->head, 4);
  }
  session.show_head();
  live = wait_for(session, [](const view::session::LiveFrame& other) { return !other.is_older; });
  EXPECT_EQ(hash_of(*live), hashes("a")[4]);
  EXPECT_EQ(seconds_of_steps(*live), 0) << "a step was taken";
  // The folder stays as it was while one looks.
  EXPECT_EQ(neve({"verify", "a"}).exit_code, 0);
}

TEST_F(PastRun, WithoutStatesItHasItsCheckpointsAndTheStart) {
  render({"scene.toml", "--out", "a", "--checkpoint-every", "2", "--no-keep-states"});
  view::session::Workbench bench = open("a");
  view::session::Session& session = bench.session();
  EXPECT_EQ(session.latest()->frame, 4);
  EXPECT_EQ(session.latest()->kept, (std::vector<int>{0, 2, 4}));
  session.show_frame(3);  // the nearest before it
  const auto live =
      wait_for(session, [](const view::session::LiveFrame& other) { return other.is_older; });
  EXPECT_EQ(live->frame, 2);
  EXPECT_EQ(hash_of(*live), hashes("a")[2]);
  // From there the run continues as before.
  session.continue_from_here();
  session.run();
  EXPECT_EQ(hash_of(*rest_at(session, 4)), hashes("a")[4]);
}

TEST_F(PastRun, AnInterruptedRunContinuesAsIfItHadNotBeen) {
  render({"scene.toml", "--out", "whole"});
  render({"scene.toml", "--out", "a", "--frames", "2"});
  view::session::Workbench bench = open("a");
  EXPECT_EQ(bench.session().latest()->frame, 2);
  bench.session().run();
  EXPECT_EQ(hash_of(*rest_at(bench.session(), 4)), hashes("whole")[4]);
}

/// A branch has a change in its list: it is an edit of the document, as if it had been made here.
TEST_F(PastRun, ChangesOfTheRunStayWhenAnotherIsMade) {
  render({"scene.toml", "--out", "a", "--checkpoint-every", "1"});
  render({"a", "--from", "0.05", "--set", "material.snow.hardening=4", "--out", "b", "--frames",
          "3", "--checkpoint-every", "1"});
  view::session::Workbench bench = open("b");
  EXPECT_TRUE(bench.document().is_changed("material.snow.hardening"));
  EXPECT_TRUE(bench.waiting_for_reset().empty());
  bench.set("solver.gravity", "[3, -9.81, 0]");
  bench.session().run();
  const auto live = rest_at(bench.session(), 4);
  EXPECT_EQ(live->scene->materials[0].hardening, 4);
  ASSERT_EQ(live->snapshot.changes.size(), 2u);
  EXPECT_EQ(live->snapshot.changes[0].address, "material.snow.hardening");
  // The record of a picture of it makes the same state again, from the start.
  const record::PictureRecord record = bench.picture_record(*live, live->scene->views.front());
  const scene::Scene start = scene::read_scene_text(record.scene, "record");
  EXPECT_EQ(start.materials[0].hardening, 10);
  timeline::Timeline again(start, record.changes,
                           std::make_shared<setup::SeededScene>(setup::seed_scene(start)), 0);
  ASSERT_TRUE(again.go_to(4 / 24.0));
  EXPECT_EQ(again.simulation().state_hash(), live->state_hash);
}

TEST_F(PastRun, ARunWithoutAMomentIsSimulatedWithItsChanges) {
  render({"scene.toml", "--out", "a", "--checkpoint-every", "1"});
  render({"a", "--from", "0.05", "--set", "material.snow.hardening=4", "--out", "b"});
  for (const char* kept : {"b/checkpoint", "b/states"}) std::filesystem::remove_all(folder / kept);
  view::session::Workbench bench = open("b");
  const auto start = bench.session().latest();
  EXPECT_EQ(start->steps, 0u);
  EXPECT_EQ(start->scene->materials[0].hardening, 10);
  EXPECT_EQ(start->samples->size(), 1u) << "the rest is not simulated yet";
  EXPECT_TRUE(bench.document().is_changed("material.snow.hardening"));
  EXPECT_TRUE(bench.waiting_for_reset().empty());
  ASSERT_TRUE(bench.save_scene(folder / "view" / "saved.toml"));
  EXPECT_TRUE(contains(bench.messages().back().text, "hardening changed during the run"))
      << bench.messages().back().text;
  bench.session().run();
  const auto live = rest_at(bench.session(), 4);
  EXPECT_EQ(hash_of(*live), hashes("b")[4]);
  EXPECT_NE(hash_of(*live), hashes("a")[4]);
}

TEST_F(PastRun, AStateThatIsDamagedIsAMessageAndTheRunStaysWhereItIs) {
  render({"scene.toml", "--out", "a", "--keep-states"});
  view::session::Workbench bench = open("a");
  output::Checkpoint forged = *output::read_state(folder / "a", 2).checkpoint;
  forged.state.resize(forged.state.size() / 2);
  output::write_state(folder / "a", forged);
  bench.session().show_frame(2);
  const auto live = wait_for(
      bench.session(), [](const view::session::LiveFrame& other) { return other.errors > 0; });
  EXPECT_TRUE(contains(live->error, "000002.ckpt")) << live->error;
  EXPECT_FALSE(live->is_older);
  EXPECT_EQ(hash_of(*live), hashes("a")[4]);
}

TEST_F(PastRun, WhatARunWasMadeFromCannotBeSet) {
  render({"scene.toml", "--out", "a"});
  EXPECT_THROW(view::session::open_document((folder / "a").string(), {"seed=2"}, 1), UsageError);
  EXPECT_THROW(view::session::open_document((folder / "a").string(), {}, 2), UsageError);
}

/// A scene that lies beside a run or a picture is another one.
TEST_F(PastRun, OnlyASceneThatWasNamedIsWrittenOverAndReadAgain) {
  render({"scene.toml", "--out", "a"});
  const std::filesystem::path beside = folder.write("a.toml", "# mine\n");
  view::session::Workbench bench = open("a");
  std::filesystem::last_write_time(
      beside, std::filesystem::last_write_time(beside) + std::chrono::seconds(2));
  EXPECT_FALSE(bench.may_save_over_file());
  EXPECT_FALSE(bench.has_file_changed());
  const auto opened = [&](const std::string& named) {
    return view::session::open_document(named, {}, 1).document;
  };
  EXPECT_FALSE(opened((folder / "a/particles/0002.png").string()).has_file());
  EXPECT_TRUE(opened((folder / "scene.toml").string()).has_own_file());
  const view::session::Document shipped = opened("");
  EXPECT_FALSE(shipped.has_own_file());
  EXPECT_TRUE(std::filesystem::exists(shipped.file()));
  EXPECT_FALSE(scene::is_lasting_file("/dev/stdin"));
  EXPECT_FALSE(scene::is_lasting_file("/dev/fd/63"));
}

/// Captions and saved pictures say how coarse a run is and what was set, whoever opens it.
TEST_F(PastRun, PicturesOfAnOpenedCoarseRunSayThatItIs) {
  render({"scene.toml", "--out", "a", "--coarsen", "1.25", "--set", "material.snow.hardening=8"});
  for (const char* named : {"a", "a/particles/0000.png"}) {
    view::session::Opened opened = view::session::open_document((folder / named).string(), {}, 1);
    view::session::WorkbenchOptions options;
    options.overrides = opened.overrides;
    view::session::Workbench bench(std::move(opened.document), options, {});
    const auto live = bench.session().latest();
    const record::PictureRecord record = bench.picture_record(*live, live->scene->views.front());
    EXPECT_EQ(record.coarsening, 1.25) << named;
    EXPECT_EQ(record.overrides,
              (std::vector<std::string>{"material.snow.hardening=8", "solver.threshold_cell=0.04"}))
        << named;
    EXPECT_DOUBLE_EQ(scene::read_scene_text(record.scene, "record").solver.cell_size, 0.05)
        << "not coarsened twice";
  }
}

/// The command and the sweep are of the scene of the run, whatever lies beside its folder.
TEST_F(PastRun, TheCommandAndTheSweepOfARunNameItsOwnScene) {
  render({"scene.toml", "--out", "a", "--coarsen", "1.25", "--set", "material.snow.hardening=8"});
  folder.write("a.toml", tiny_scene);
  view::session::Workbench bench = open("a");
  bench.set("solver.cfl", "0.3");
  const std::string command = bench.command(), file = (folder / "view" / "a_opened.toml").string();
  EXPECT_TRUE(contains(command, file + " --set solver.cfl=0.3")) << command;
  EXPECT_TRUE(contains(bench.messages().back().text, command)) << bench.messages().back().text;
  const scene::Scene named = scene::read_scene_file(file);
  EXPECT_DOUBLE_EQ(named.solver.cell_size, 0.05);
  EXPECT_EQ(named.materials[0].hardening, 8);
  EXPECT_EQ(named.solver.cfl, 0.4) << "the change is in the command";
  const std::filesystem::path sweep = bench.sweep_around("solver.cfl");
  EXPECT_TRUE(contains(read_text(sweep), "scene = \"a_opened.toml\"")) << read_text(sweep);
  // Its file was written once, and the run of the command is that of the folder.
  EXPECT_FALSE(std::filesystem::exists(folder / "view" / "a_opened_2.toml"));
  render({file, "--out", "again"});
  EXPECT_EQ(hashes("again"), hashes("a"));
}

TEST_F(PastRun, AScriptGoesBackInTimeAndSavesThePictureOfTheRun) {
  render({"scene.toml", "--out", "a", "--keep-states"});
  folder.write("clicks.json", R"([
    {"wait_for": "simulation frame 4"}, {"key": "left"}, {"wait_for": "simulation frame 3"},
    {"key": "p"}, {"wait": 5}])");
  const auto result = neve({"view", "a", "--replay", "clicks.json", "--out", "out", "--quiet"});
  if (result.exit_code == exit_no_backend) GTEST_SKIP() << result.errors;
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  std::size_t steps = 0;
  const Json run = json_of("a/run.json");
  for (const Json& frame : run["frames"])
    if (frame["frame"] <= 3) steps += frame["steps"].get<std::size_t>();
  const std::string picture = "out/particles_0003_step" + std::to_string(steps) + ".png";
  ASSERT_TRUE(exists(picture));
  const auto info = neve({"info", picture, "--json"});
  EXPECT_EQ(parse_json(std::string_view(info.output))["state_hash"], hashes("a")[3]);
  // A time names the moment that is shown first.
  folder.write("at.json", R"([{"wait_for": "simulation frame 2"}, {"wait": 3}])");
  EXPECT_EQ(neve({"view", "a", "--at", "0.09s", "--replay", "at.json", "--out", "out"}).exit_code,
            0);
  const auto refused = neve({"view", "scene.toml", "--at", "0.09s", "--replay", "at.json"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(contains(refused.errors, "shows a moment that a run has kept")) << refused.errors;
}

}  // namespace
}  // namespace neve::test
