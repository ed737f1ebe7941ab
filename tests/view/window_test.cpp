#include "app/view/frontend/window_frontend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>

#include "app/view/frontend/imgui_input.h"
#include "render/gl/context.h"
#include "render/gl/gl.h"
#include "tests/support/needs.h"
#include "tests/support/xvfb.h"

namespace neve::app {
namespace {

using Kind = app::view::frontend::InputEvent::Kind;

/// One display for all tests of this file, and a window on it for each.
class InWindow : public testing::Test {
 protected:
  static void SetUpTestSuite() { display = std::make_unique<test::Xvfb>(); }
  static void TearDownTestSuite() { display.reset(); }

  void SetUp() override {
    if (!display->reason().empty()) SKIP_OR_FAIL(display->reason());
    hand = std::make_unique<test::XHand>();
    if (!hand->reason().empty()) SKIP_OR_FAIL(hand->reason());
    try {
      front = std::make_unique<app::view::frontend::WindowFrontend>(
          "neve test", app::view::frontend::ScreenSize{640, 480, 1});
    } catch (const render::gl::ContextError& error) {
      const std::string reason = error.what();
      if (reason.find("built without") == std::string::npos) FAIL() << reason;
      SKIP_OR_FAIL(reason);
    }
    hand->move(320, 240);
    wait_until([&] { return saw(Kind::move); });
  }

  /// Collects events until it is true, ten seconds at most.
  void wait_until(const std::function<bool()>& is_true) {
    for (int k = 0; k < 1000 && !is_true(); ++k)
      for (app::view::frontend::InputEvent& event : front->wait(0.01))
        events.push_back(std::move(event));
    EXPECT_TRUE(is_true());
  }

  const app::view::frontend::InputEvent* last(Kind kind) const {
    for (auto at = events.rbegin(); at != events.rend(); ++at)
      if (at->kind == kind) return &*at;
    return nullptr;
  }
  bool saw(Kind kind) const { return last(kind) != nullptr; }
  std::size_t count(Kind kind) const {
    return static_cast<std::size_t>(
        std::count_if(events.begin(), events.end(),
                      [&](const app::view::frontend::InputEvent& e) { return e.kind == kind; }));
  }

  static std::unique_ptr<test::Xvfb> display;
  std::unique_ptr<test::XHand> hand;
  std::unique_ptr<app::view::frontend::WindowFrontend> front;
  std::vector<app::view::frontend::InputEvent> events;
};
std::unique_ptr<test::Xvfb> InWindow::display;

TEST_F(InWindow, WindowHasAnOpenGlContextThatDraws) {
  render::gl::Context& context = front->context();
  EXPECT_EQ(context.backend, "window");
  EXPECT_GE(std::atof(context.version.c_str()), 3.3);
  EXPECT_EQ(front->size().width, 640);
  EXPECT_EQ(front->size().height, 480);
  EXPECT_TRUE(front->is_ready());
  EXPECT_NE(context.get_proc("glClear"), nullptr);
}

TEST_F(InWindow, MouseComesInPixelsFromTheUpperLeftCorner) {
  events.clear();
  hand->move(100, 50);
  wait_until([&] { return saw(Kind::move) && last(Kind::move)->x == 100; });
  EXPECT_EQ(last(Kind::move)->y, 50);
  hand->button(3, true);
  hand->button(3, false);
  wait_until([&] { return count(Kind::button) == 2; });
  EXPECT_EQ(last(Kind::button)->button, 1);
  EXPECT_FALSE(last(Kind::button)->is_down);
}

TEST_F(InWindow, FastClicksKeepTheirPlaces) {
  while (!front->wait(0.1).empty()) {
  }
  events.clear();
  // All of it before anybody looks.
  for (const int x : {100, 500}) {
    hand->move(x, 200);
    hand->button(1, true);
    hand->button(1, false);
  }
  hand->move(600, 20);
  wait_until([&] { return count(Kind::button) == 4 && last(Kind::move)->x == 600; });
  std::vector<float> pressed;
  float x = -1;
  for (const app::view::frontend::InputEvent& event : events) {
    if (event.kind == Kind::move) x = event.x;
    if (event.kind == Kind::button && event.is_down) pressed.push_back(x);
  }
  EXPECT_EQ(pressed, (std::vector<float>{100, 500}));
}

TEST_F(InWindow, WheelCountsRightAndUp) {
  for (const int up : {4, 7}) {
    hand->button(up, true);
    hand->button(up, false);
  }
  wait_until([&] { return count(Kind::wheel) == 2; });
  EXPECT_EQ(last(Kind::wheel)->x, 1);
  const auto first =
      std::find_if(events.begin(), events.end(),
                   [](const app::view::frontend::InputEvent& e) { return e.kind == Kind::wheel; });
  EXPECT_EQ(first->y, 1);
}

TEST_F(InWindow, KeysTextAndModifiers) {
  hand->tap('a');
  wait_until([&] { return count(Kind::key) == 2 && saw(Kind::text); });
  EXPECT_EQ(last(Kind::key)->key, 'A');
  EXPECT_EQ(last(Kind::text)->text, "a");
  hand->key(0xffe4, true);  // control on the right
  hand->tap('z');
  hand->key(0xffe4, false);
  wait_until([&] { return count(Kind::key) == 6; });
  EXPECT_EQ(count(Kind::text), 1u) << "ctrl+Z types nothing";
  std::vector<app::view::frontend::InputEvent> keys;
  for (const app::view::frontend::InputEvent& event : events)
    if (event.kind == Kind::key) keys.push_back(event);
  EXPECT_EQ(keys[2].key, app::view::frontend::key::ctrl);
  EXPECT_TRUE(keys[2].held.ctrl) << "from its own press on";
  EXPECT_EQ(keys[3].key, 'Z');
  EXPECT_TRUE(keys[3].held.ctrl);
  EXPECT_EQ(keys[5].key, app::view::frontend::key::ctrl);
  EXPECT_FALSE(keys[5].held.ctrl);
}

TEST_F(InWindow, KeysWithoutLettersHaveTheCodesOfTheSeam) {
  const std::pair<unsigned long, int> all[] = {{0xff1b, app::view::frontend::key::escape},
                                               {0xff0d, app::view::frontend::key::enter},
                                               {0xff09, app::view::frontend::key::tab},
                                               {0xff08, app::view::frontend::key::backspace},
                                               {0xffff, app::view::frontend::key::del},
                                               {0xff51, app::view::frontend::key::left},
                                               {0xff53, app::view::frontend::key::right},
                                               {0xff52, app::view::frontend::key::up},
                                               {0xff54, app::view::frontend::key::down},
                                               {0xff55, app::view::frontend::key::page_up},
                                               {0xff50, app::view::frontend::key::home},
                                               {0xff57, app::view::frontend::key::end},
                                               {0xffbe, app::view::frontend::key::f1},
                                               {0xffc9, app::view::frontend::key::f1 + 11},
                                               {' ', ' '},
                                               {'5', '5'},
                                               {0xff8d, app::view::frontend::key::enter},
                                               {'/', '/'}};
  for (const auto& [symbol, code] : all) {
    events.clear();
    hand->tap(symbol);
    wait_until([&] { return count(Kind::key) == 2; });
    ASSERT_TRUE(saw(Kind::key));
    EXPECT_EQ(last(Kind::key)->key, code) << std::hex << symbol;
  }
}

TEST_F(InWindow, ResizingIsNoticedAndWantsAPicture) {
  hand->resize_newest_window(900, 700);
  wait_until([&] { return saw(Kind::resize) && last(Kind::resize)->x == 900; });
  EXPECT_EQ(front->size().width, 900);
  EXPECT_EQ(front->size().height, 700);
  EXPECT_TRUE(front->is_picture_wanted());
}

TEST_F(InWindow, WakeEndsAWaitFromAnotherThread) {
  // Nothing else happens any more.
  while (!front->wait(0.2).empty()) {
  }
  const auto start = std::chrono::steady_clock::now();
  std::thread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    front->wake();
  });
  front->wait(60);
  other.join();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

TEST_F(InWindow, ClipboardKeepsText) {
  front->set_clipboard("solver.dt = 1e-4 · ö");
  EXPECT_EQ(front->clipboard(), "solver.dt = 1e-4 · ö");
}

TEST_F(InWindow, PointerThatLeavesIsNowhere) {
  hand->resize_newest_window(400, 300);
  wait_until([&] { return front->size().width == 400; });
  hand->move(200, 200);
  events.clear();
  hand->move(1000, 900);
  wait_until(
      [&] { return saw(Kind::move) && last(Kind::move)->x == app::view::frontend::off_picture; });
}

TEST(WindowWithoutDisplay, AMissingDisplayIsNamed) {
  const char* before = std::getenv("DISPLAY");
  const std::string display = before ? before : "";
  const char* wayland_before = std::getenv("WAYLAND_DISPLAY");
  const std::string wayland = wayland_before ? wayland_before : "";
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  try {
    app::view::frontend::WindowFrontend front("neve");
    ADD_FAILURE() << "a window on nothing";
  } catch (const render::gl::ContextError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with("no window: ")) << message;
    ASSERT_EQ(error.attempts.size(), 1u);
    EXPECT_EQ(error.attempts[0].backend, "window");
  }
  if (!display.empty()) setenv("DISPLAY", display.c_str(), 1);
  if (!wayland.empty()) setenv("WAYLAND_DISPLAY", wayland.c_str(), 1);
}

}  // namespace
}  // namespace neve::app
