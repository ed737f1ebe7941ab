/// "Vary from here": sweeps of a kept frame, in the session and by clicks.

#include "app/view/session/view_sweep.h"
#include "tests/support/needs.h"
#include "tests/view/view_support.h"

namespace neve::test {
namespace {

namespace session = app::view::session;

app::Json json_in(const std::filesystem::path& file) {
  return app::parse_json(std::string_view(read_text(file)));
}

class ViewSweeps : public testing::Test {
 protected:
  ViewSweeps() {
    session::WorkbenchOptions options;
    options.folder = folder / "out";
    options.program = NEVE_BINARY;
    std::string text = tiny_scene;
    bench = std::make_unique<session::Workbench>(
        session::open_document(folder.write("scene.toml", text), {}, 1).document, options,
        std::function<void()>());
  }

  void go_to(int frame) {
    bench->session().next_frame();
    rest_at(bench->session(), frame);
  }

  std::string vary(const std::vector<session::SweepAxis>& axes, int last) {
    return bench->vary_from_here({axes, last, false}, bench->document().scene()->views.front());
  }

  const session::ViewSweepProgress& wait_for_sweep() {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(100);
    while (bench->sweep().is_running() && std::chrono::steady_clock::now() < end) {
      bench->sweep().poll();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return bench->sweep().progress();
  }

  /// "" where the program has no OpenGL here.
  std::string hash_of(int run, int frame) {
    char name[8];
    std::snprintf(name, sizeof name, "%04d", run);
    const app::Json json = json_in(bench->sweep().progress().folder / "runs" / name / "run.json");
    for (const app::Json& made : json["frames"])
      if (made["frame"] == frame) return made["state_hash"];
    return "";
  }

  TemporaryFolder folder;
  std::unique_ptr<session::Workbench> bench;
};

TEST_F(ViewSweeps, EveryRunIsTheRunOfTheViewWithItsChangeAtThatFrame) {
  go_to(1);
  bench->set("solver.gravity", "[3, -9.81, 0]");  // by hand, before
  go_to(2);
  go_to(3);
  bench->session().show_frame(2);
  rest_at(bench->session(), 2);
  ASSERT_EQ(vary({{"material.snow.hardening", "4, 10"}}, 4), "");
  const session::ViewSweepProgress done = wait_for_sweep();
  if (done.state == session::ViewSweepProgress::State::failed) SKIP_OR_FAIL(done.error);
  ASSERT_EQ(done.state, session::ViewSweepProgress::State::done);
  EXPECT_EQ(done.runs, 2);
  EXPECT_EQ(done.ok, 2);
  EXPECT_DOUBLE_EQ(done.share, 1);
  EXPECT_TRUE(std::filesystem::exists(done.sheet()));
  EXPECT_TRUE(std::filesystem::exists(done.report()));
  // The view itself, with that change at that frame.
  bench->continue_from_here();
  bench->set("material.snow.hardening", "4");
  go_to(3);
  go_to(4);
  const auto live = bench->session().latest();
  EXPECT_EQ(hash_of(0, 4), app::record::hash_text(live->state_hash));
  EXPECT_NE(hash_of(1, 4), hash_of(0, 4));
  // The picture alone makes a whole run from its start.
  const auto again = app::output::run_process(
      NEVE_BINARY,
      {"render", (done.folder / "runs/0000/particles/0004.png").string(), "--out", "again"},
      folder.path());
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(json_in(folder / "again/run.json")["frames"].back()["state_hash"], hash_of(0, 4));
  // The command makes the same sweep: nothing is left to do.
  const auto same = app::output::run_process(
      "/bin/sh", {"-c", "exec '" NEVE_BINARY "' " + done.command.substr(5) + " --json"},
      folder.path());
  ASSERT_EQ(same.exit_code, 0) << done.command << "\n" << same.errors;
  EXPECT_EQ(app::parse_json(std::string_view(same.output))["started"], 0);
}

TEST_F(ViewSweeps, WhatCannotVaryIsRefusedWithWhatCan) {
  go_to(1);
  const std::string restart = vary({{"solver.cell_size", "0.04, 0.05"}}, 4);
  EXPECT_TRUE(contains(restart,
                       "solver.cell_size cannot change while a simulation runs; parameters "
                       "that can: solver.threshold_cell, solver.kernel"))
      << restart;
  EXPECT_TRUE(contains(vary({{"material.snow.hardening", "soft, hard"}}, 4), "soft"));
  EXPECT_TRUE(contains(vary({{"material.snow.hardening", "1, 2"}}, 1), "at or after frame 1"));
  EXPECT_TRUE(contains(vary({}, 4), "no parameter is chosen"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out/vary_0001"));
  EXPECT_FALSE(bench->sweep().is_running());
}

TEST_F(ViewSweeps, ASecondSweepOfAFrameHasItsOwnFolderAndASweepCanBeStopped) {
  go_to(1);
  ASSERT_EQ(vary({{"material.snow.hardening", "4, 10"}}, 4), "");
  EXPECT_TRUE(contains(vary({{"material.snow.hardening", "4, 10"}}, 4), "in progress"));
  bench->sweep().stop();
  const session::ViewSweepProgress first = wait_for_sweep();
  EXPECT_NE(first.state, session::ViewSweepProgress::State::failed) << first.error;
  ASSERT_EQ(vary({{"material.snow.hardening", "4"}}, 40000), "");
  EXPECT_NE(bench->sweep().progress().folder, first.folder);
  bench->sweep().stop();
  EXPECT_EQ(wait_for_sweep().state, session::ViewSweepProgress::State::stopped);
}

TEST_F(ViewSweeps, ItsRunsTakeTheCoresAndTheRendererOfTheView) {
  session::WorkbenchOptions options;
  options.folder = folder / "out";
  options.program = NEVE_BINARY;
  options.session.threads = 1;
  options.backend = "osmesa";
  bench = std::make_unique<session::Workbench>(
      session::open_document((folder / "scene.toml").string(), {}, 1).document, options,
      std::function<void()>());
  go_to(1);
  ASSERT_EQ(vary({{"material.snow.hardening", "4"}}, 2), "");
  bench->sweep().stop();
  const std::string command = wait_for_sweep().command;
  EXPECT_TRUE(contains(command, "--threads 1")) << command;
  EXPECT_TRUE(contains(command, "--backend osmesa")) << command;
}

}  // namespace
}  // namespace neve::test
