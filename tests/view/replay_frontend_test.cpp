#include "app/view/replay/replay_frontend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "app/output/atomic_file.h"
#include "app/support/errors.h"
#include "app/view/frontend/imgui_input.h"
#include "app/view/panels/labels.h"
#include "app/view/replay/recording_frontend.h"
#include "panels.h"
#include "render/image/image.h"
#include "render/renderer.h"
#include "render/screen.h"
#include "tests/render/gl_test.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

/// A user interface with one of each, the viewer of a simulation that counts frames.
struct SmallViewer {
  Panels panels;
  int runs = 0, resets = 0, frames = 0;
  int simulation_frame = 0;
  bool is_running = false, is_open = true, is_folded = false;
  float hardening = 10;
  char name[64] = "";
  std::vector<std::string> dropped;
  std::vector<app::view::frontend::ScreenSize> sizes;
  float wheel = 0;
  int space_pressed = 0;

  void widgets() {
    if (ImGui::Button("Run##transport", ImVec2(100, 30))) ++runs, is_running = true;
    app::view::panels::note_label("Run##transport");
    for (int k = 0; k < 2; ++k) {
      ImGui::PushID(k);
      if (ImGui::Button("Reset")) resets += k == 0 ? 1 : 10;
      app::view::panels::note_label("Reset");
      ImGui::PopID();
    }
    ImGui::SetNextItemWidth(200);
    ImGui::SliderFloat("hardening", &hardening, 0, 20);
    app::view::panels::note_label("hardening");
    ImGui::InputText("name", name, sizeof name);
    app::view::panels::note_label("name");
    // Behind the end of a panel that scrolls.
    ImGui::BeginChild("list", ImVec2(300, 100));
    for (int k = 0; k < 60; ++k) {
      const std::string label = "item " + std::to_string(k);
      if (ImGui::Button(label.c_str())) clicked = k;
      app::view::panels::note_label(label.c_str());
    }
    ImGui::EndChild();
    wheel += ImGui::GetIO().MouseWheel;
    space_pressed += app::view::frontend::is_key_pressed(' ');
  }
  int clicked = -1;

  /// @return how many frames it ran, until the frontend closed
  void run(app::view::frontend::Frontend& front) {
    app::view::frontend::ImGuiInput input(front);
    for (frames = 0; frames < 100'000; ++frames) {
      const std::vector<app::view::frontend::InputEvent> events = front.wait(0.01);
      for (const app::view::frontend::InputEvent& event : events) {
        if (event.kind == app::view::frontend::InputEvent::Kind::close) return;
        if (event.kind == app::view::frontend::InputEvent::Kind::drop)
          dropped.push_back(event.text);
        if (event.kind == app::view::frontend::InputEvent::Kind::resize)
          sizes.push_back(front.size());
      }
      const bool is_paste =
          !events.empty() && events[0].kind == app::view::frontend::InputEvent::Kind::paste;
      input.push(events);
      EXPECT_EQ(input.feed(), is_paste) << "a script brings one thing a frame";
      panels.frame([&] { widgets(); });
      if (is_running && frames % 5 == 0) ++simulation_frame;
      front.set_progress(simulation_frame, is_running);
    }
    FAIL() << "it never closed";
  }

  void run(const std::string& script, app::view::replay::ReplayFrontend::Options options = {}) {
    app::view::replay::ReplayFrontend front(app::view::replay::parse_replay(script, "clicks.json"),
                                            "clicks.json", std::move(options));
    run(front);
  }

  std::string failure(const std::string& script,
                      app::view::replay::ReplayFrontend::Options options = {}) {
    try {
      run(script, std::move(options));
    } catch (const Error& error) {
      EXPECT_EQ(error.code, exit_check_failed);
      return error.what();
    }
    return "no failure";
  }
};

TEST(Replay, ClicksByLabelAndByPlace) {
  SmallViewer viewer;
  viewer.run(R"([{"click": "Run"}, {"click": [50, 20], "times": 2}, {"click": "Reset#2"},
                 {"click": "Run", "button": "right"}])");
  EXPECT_EQ(viewer.runs, 3);
  EXPECT_EQ(viewer.resets, 10);
}

TEST(Replay, DragsASliderToItsMiddle) {
  SmallViewer viewer;
  viewer.hardening = 0;
  viewer.run(R"([{"drag": [{"label": "hardening", "part": [0.05, 0.5]},
                           {"label": "hardening", "part": [0.36, 0.5]}]}])");
  // The label beside the slider belongs to the widget: the slider is 200 px of it.
  EXPECT_GT(viewer.hardening, 5);
  EXPECT_LT(viewer.hardening, 15);
}

TEST(Replay, TypesIntoAFieldAndPressesKeys) {
  SmallViewer viewer;
  viewer.run(R"([{"click": {"label": "name", "part": [0.2, 0.5]}}, {"type": "Snö 5"},
                 {"key": "backspace"}, {"key": "7"}, {"paste": "!"}, {"key": "a", "ctrl": true},
                 {"key": "c", "ctrl": true}, {"key": "end"}, {"key": "v", "ctrl": true}])");
  EXPECT_STREQ(viewer.name, "Snö 7!Snö 7!");
  EXPECT_EQ(viewer.space_pressed, 1) << "keyboards send the key with the text";
}

TEST(Replay, ReplayScrollsToHiddenWidgets) {
  SmallViewer viewer;
  viewer.run(R"([{"click": "item 47"}])");
  EXPECT_EQ(viewer.clicked, 47);
  viewer.run(R"([{"click": "item 2"}])");
  EXPECT_EQ(viewer.clicked, 2);
}

TEST(Replay, ReplayWaitsForFramesAndForTheSimulation) {
  SmallViewer viewer;
  viewer.run(R"([{"wait": 20}, {"click": "Run"}, {"wait_for": "simulation running"},
                 {"wait_for": "simulation frame 12"}, {"wait_for": "label Run"},
                 {"at_frame": 200, "click": "Reset"}])");
  EXPECT_GE(viewer.simulation_frame, 12);
  EXPECT_GE(viewer.frames, 200);
  EXPECT_EQ(viewer.resets, 1);
}

TEST(Replay, FramesBelowZeroAreAwaited) {
  SmallViewer viewer;
  viewer.simulation_frame = -9;
  viewer.run(R"([{"wait_for": "simulation paused", "within": 5}, {"click": "Run"},
                 {"wait_for": "simulation frame -5"}])");
  EXPECT_GE(viewer.simulation_frame, -5);
}

TEST(Replay, ReplayResizesDropsAndTurnsTheWheel) {
  SmallViewer viewer;
  app::view::replay::ReplayFrontend::Options options;
  options.folder = "/somewhere";
  viewer.run(R"([{"resize": [1920, 1080, 2]}, {"drop": "a.toml"}, {"wheel": 2.5, "at": [700, 500]},
                 {"quit": true}, {"click": "no such thing"}])",
             options);
  ASSERT_EQ(viewer.sizes.size(), 1u);
  EXPECT_EQ(viewer.sizes[0].width, 1920);
  EXPECT_EQ(viewer.sizes[0].scale, 2);
  EXPECT_EQ(viewer.dropped, std::vector<std::string>{"/somewhere/a.toml"});
  EXPECT_FLOAT_EQ(viewer.wheel, 2.5f);
}

TEST(Replay, SameScriptTakesTheSameFramesEveryTime) {
  const auto frames = [] {
    SmallViewer viewer;
    viewer.run(R"([{"click": "item 30"}, {"type": "x"}, {"wait": 3}, {"click": "Run"}])");
    return viewer.frames;
  };
  EXPECT_EQ(frames(), frames());
}

TEST(Replay, MissingLabelNamesStepAndNearestLabel) {
  SmallViewer viewer;
  EXPECT_EQ(viewer.failure("[{\"wait\": 2},\n {\"click\": \"Rnu\"}]"),
            "clicks.json:2:2: error: step 2 (click): \"Rnu\" is not on the picture; did you mean "
            "\"Run\"?");
}

TEST(Replay, SimulationThatDoesNotGetThereIsGivenUp) {
  SmallViewer viewer;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(viewer.failure(R"([{"wait_for": "simulation frame 9", "within": 0.2}])"),
            "clicks.json:1:2: error: step 1 (wait_for): no simulation frame 9 within 0.2 s");
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(200));
}

TEST(Replay, FramesEndItAndTooFewAreSaid) {
  SmallViewer viewer;
  app::view::replay::ReplayFrontend::Options options;
  options.frames = 30;
  viewer.run(R"([{"click": "Run"}])", options);
  EXPECT_EQ(viewer.frames, 30);
  options.frames = 3;
  EXPECT_EQ(viewer.failure(R"([{"wait": 2}, {"wait": 100}, {"click": "Run"}])", options),
            "clicks.json:1:30: error: step 3 (click): not reached after 3 frames of the panels; "
            "raise --frames");
}

TEST(Replay, WakeEndsTheWaitOfAScriptThatWaits) {
  app::view::replay::ReplayFrontend front(
      app::view::replay::parse_replay(R"([{"wait_for": "simulation frame 9"}])", "a"), "a", {});
  front.wait(1);
  front.wake();
  const auto start = std::chrono::steady_clock::now();
  front.wait(1);
  // It would have been 10 ms; a busy machine may take a while to notice.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST(Replay, ScreenshotsAreTheScreenOrAPartOfIt) {
  OPEN_OR_SKIP(context, "egl");
  const test::TemporaryFolder folder;
  app::view::replay::ReplayFrontend::Options options;
  options.folder = folder.path();
  options.size = {640, 400, 1};
  const std::string script =
      R"([{"screenshot": "all.png"}, {"screenshot": "a/run.png", "crop": "Run"},
                                 {"screenshot": "corner.png", "crop": [0, 0, 20, 10]},
                                 {"screenshot": "beyond.png", "crop": [600, 0, 80, 10]}])";
  app::view::replay::ReplayFrontend front(app::view::replay::parse_replay(script, "clicks.json"),
                                          "clicks.json", options);
  render::Renderer renderer(*context);
  render::Screen screen(*context);
  const auto run = [&] {
    for (int k = 0; k < 100; ++k) {
      if (!front.wait(0).empty()) return;
      screen.begin(640, 400, 14, 1.0f / 60);
      ImGui::SetNextWindowPos(ImVec2(0, 0));
      ImGui::Begin("panel");
      ImGui::Button("Run", ImVec2(100, 30));
      app::view::panels::note_label("Run");
      ImGui::End();
      screen.end(renderer, {320, 0, 320, 400});
      front.show(screen);
    }
  };
  try {
    run();
    ADD_FAILURE() << "a part beyond the picture";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("640x400"), std::string::npos) << error.what();
  }
  const auto picture = [&](const char* name) {
    return render::decode_png(app::output::read_file(folder / name));
  };
  EXPECT_EQ(picture("all.png").width, 640);
  EXPECT_EQ(picture("all.png").height, 400);
  EXPECT_EQ(picture("corner.png").width, 20);
  const render::Image run_button = picture("a/run.png");
  EXPECT_EQ(run_button.width, 100);
  EXPECT_EQ(run_button.height, 30);
  // Blue of the button, white of its text.
  EXPECT_GT(std::count_if(run_button.pixels.begin(), run_button.pixels.end(),
                          [](std::uint8_t value) { return value > 200; }),
            20);
  EXPECT_FALSE(std::filesystem::exists(folder / "beyond.png"));
}

/// A script plays the user, and a recorder writes it down.
TEST(Recording, RecordedInputDoesTheSameAgain) {
  const test::TemporaryFolder folder;
  const std::string script = R"([
    {"click": "Run"}, {"click": {"label": "name", "part": [0.2, 0.5]}}, {"type": "snow"},
    {"key": "backspace"}, {"key": "a", "ctrl": true}, {"key": "c", "ctrl": true},
    {"drag": [{"label": "hardening", "part": [0.05, 0.5]},
              {"label": "hardening", "part": [0.3, 0.5]}], "steps": 7},
    {"wheel": -3, "at": [100, 150]}, {"resize": [700, 500]}, {"drop": "/x/a.toml"}])";
  SmallViewer first;
  {
    app::view::replay::ReplayFrontend hand(app::view::replay::parse_replay(script, "hand.json"),
                                           "hand.json", {});
    app::view::replay::RecordingFrontend recording(hand, folder / "recorded.json");
    first.run(recording);
  }
  const std::string recorded = test::read_text(folder / "recorded.json");
  SmallViewer second;
  second.run(recorded);
  EXPECT_EQ(second.runs, first.runs);
  EXPECT_STREQ(second.name, "sno");
  EXPECT_NEAR(second.hardening, first.hardening, 0.11) << "a pixel of 200 for a range of 20";
  EXPECT_FLOAT_EQ(second.wheel, -3);
  EXPECT_EQ(second.dropped, first.dropped);
  ASSERT_FALSE(second.sizes.empty());
  EXPECT_EQ(second.sizes.back().width, 700);
  EXPECT_NE(recorded.find("\"click\":\"Run\""), std::string::npos) << recorded;
}

/// A script looks for the handle before it drags: that it came along is the effect of the drag.
TEST(Recording, ADragOfWhatMovesEndsWhereTheHandWas) {
  app::view::panels::Labels& labels = app::view::panels::Labels::of_panels();
  app::view::replay::InputRecorder recorder;
  float y = 100;
  int frame = 1'000'000;
  const auto note = [&](const app::view::frontend::InputEvent& event) {
    labels.note("handle y", {100, y - 5, 10, 10}, ++frame);
    recorder.note({event}, frame / 60.0);
  };
  note(move_to(105, y));
  note(button(true));
  for (int k = 0; k < 4; ++k) {
    y -= 10;
    note(move_to(105, y));
  }
  note(button(false));
  labels.clear();
  const app::view::replay::ReplayStep& drag = recorder.steps().back();
  ASSERT_EQ(drag.kind, app::view::replay::ReplayStep::Kind::drag);
  EXPECT_EQ(drag.places.front().label, "handle y");
  EXPECT_EQ(drag.places.back().label, "");
  EXPECT_FLOAT_EQ(drag.places.back().x, 105);
  EXPECT_FLOAT_EQ(drag.places.back().y, 60);
}

/// Whatever a device can do, it does while its input is recorded too.
TEST(Recording, TellsTheDeviceWhereAFingerScrolls) {
  struct Finger : ClipboardFrontend {
    void set_scrolling(const std::vector<app::view::frontend::ScrollPlace>& list) override {
      places = list;
    }
    std::vector<app::view::frontend::ScrollPlace> places;
  } device;
  const test::TemporaryFolder folder;
  app::view::replay::RecordingFrontend recording(device, folder / "recorded.json");
  recording.set_scrolling({{0, 0, 100, 200, 20}});
  EXPECT_EQ(device.places.size(), 1u);
}

TEST(Recording, UnwritableFileIsAnErrorAtOnce) {
  ClipboardFrontend front;
  EXPECT_THROW(app::view::replay::RecordingFrontend(front, "/proc/no/such.json"), IoError);
}

TEST(Labels, SmallestWidgetAroundAPlaceNamesIt) {
  app::view::panels::Labels labels;
  labels.note("picture", {0, 0, 800, 600}, 1);
  labels.note("Run", {10, 10, 50, 20}, 1);
  labels.note("hidden", {12, 12, 5, 5, false}, 1);
  EXPECT_EQ(labels.name_at(15, 15), "Run");
  EXPECT_EQ(labels.name_at(300, 300), "picture");
  EXPECT_EQ(labels.name_at(900, 300), "");
  labels.note("Stop", {10, 10, 50, 20}, 2);
  EXPECT_FALSE(labels.find("Run")) << "of the frame before";
}

}  // namespace
}  // namespace neve::app
