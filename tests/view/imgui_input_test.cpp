#include "app/view/frontend/imgui_input.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "panels.h"

namespace neve::app {
namespace {

/// A button at (10, 10), a text field below it, and what they have seen.
struct InputOfPanels : testing::Test {
  ClipboardFrontend front;
  Panels panels;
  app::view::frontend::ImGuiInput input{front};
  char field[256] = "";
  int clicks = 0, double_clicks = 0, frames = 0;
  bool is_field_focused = false;
  ImVec2 button_middle, field_middle;

  void widgets() {
    if (ImGui::Button("Run", ImVec2(100, 40))) ++clicks;
    button_middle = middle();
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) ++double_clicks;
    ImGui::InputText("name", field, sizeof field);
    field_middle = ImVec2(ImGui::GetItemRectMin().x + 40, middle().y);
    is_field_focused = ImGui::IsItemActive();
  }

  static ImVec2 middle() {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    return {(low.x + high.x) / 2, (low.y + high.y) / 2};
  }

  /// Frames until nothing waits any more, and one in which the panels follow.
  void play(std::vector<app::view::frontend::InputEvent> events) {
    input.push(std::move(events));
    bool is_more = true;
    frames = 0;
    while (is_more && frames < 1000) {
      is_more = input.feed();
      panels.frame([&] { widgets(); });
      ++frames;
    }
    EXPECT_LT(frames, 1000);
    panels.frame([&] { widgets(); });
  }

  void SetUp() override { play({}); }

  void focus_field() {
    play({move_to(field_middle.x, field_middle.y), button(true), button(false)});
    ASSERT_TRUE(is_field_focused);
  }
};

/// A finger moves and presses at once, and leaves no place where it stays: without that, tabs
/// ignore the next tap, because what it hovered last is still lit.
TEST_F(InputOfPanels, TapsOnTabsAllCount) {
  int open = -1;
  ImVec2 tabs[3];
  const auto tap = [&](ImVec2 place) {
    for (const auto& batch : std::vector<std::vector<app::view::frontend::InputEvent>>{
             {move_to(place.x, place.y), button(true), button(false)},
             {move_to(-100000, -100000)}}) {
      input.push(batch);
      bool is_more = true;
      while (is_more) {
        is_more = input.feed();
        panels.frame([&] {
          if (!ImGui::BeginTabBar("bar")) return;
          for (int k = 0; k < 3; ++k) {
            if (ImGui::BeginTabItem(("tab " + std::to_string(k)).c_str())) {
              open = k;
              ImGui::EndTabItem();
            }
            tabs[k] = middle();
          }
          ImGui::EndTabBar();
        });
      }
    }
  };
  tap({700, 500});
  tap({700, 500});
  for (const int wanted : {1, 2, 0, 2, 1, 0, 1}) {
    tap(tabs[wanted]);
    tap({700, 500});
    EXPECT_EQ(open, wanted);
  }
}

TEST_F(InputOfPanels, ClickWithinOneBatchIsOneClick) {
  play({move_to(button_middle.x, button_middle.y), button(true), button(false)});
  EXPECT_EQ(clicks, 1);
  EXPECT_EQ(frames, 2);  // the move and the press share one
}

TEST_F(InputOfPanels, DoubleClickWithinOneBatchIsADoubleClick) {
  play({move_to(button_middle.x, button_middle.y), button(true), button(false), button(true),
        button(false)});
  EXPECT_EQ(clicks, 2);
  EXPECT_EQ(double_clicks, 1);
}

TEST_F(InputOfPanels, ClickKeepsItsPlaceIfTheMouseMovesOn) {
  play({move_to(button_middle.x, button_middle.y), button(true), button(false), move_to(700, 500)});
  EXPECT_EQ(clicks, 1);
  play({move_to(button_middle.x, button_middle.y), button(true), move_to(700, 500), button(false)});
  EXPECT_EQ(clicks, 1) << "let go elsewhere";
}

TEST_F(InputOfPanels, MovesOfABatchShareAFrame) {
  std::vector<app::view::frontend::InputEvent> moves;
  for (int k = 0; k < 500; ++k) moves.push_back(move_to(static_cast<float>(k), 300));
  play(moves);
  EXPECT_EQ(frames, 1);
  EXPECT_EQ(ImGui::GetIO().MousePos.x, 499);
}

/// Sixty steps of two fingers that move apart, around a middle that trembles.
TEST_F(InputOfPanels, APinchSharesAFrameAndEndsWhereItIs) {
  std::vector<app::view::frontend::InputEvent> pinch;
  float turned = 0;
  for (int k = 0; k < 60; ++k) {
    pinch.push_back(move_to(400 + static_cast<float>(k % 3), 300));
    pinch.push_back({.kind = app::view::frontend::InputEvent::Kind::wheel, .y = 0.1f});
  }
  input.push(std::move(pinch));
  EXPECT_FALSE(input.feed()) << "nothing is left for the next frame";
  panels.frame([&] {
    widgets();
    turned = ImGui::GetIO().MouseWheel;
  });
  EXPECT_NEAR(turned, 6, 1e-4);
  // A wheel, and a mouse that goes elsewhere: the wheel is for the place where it was turned.
  play({move_to(400, 300),
        {.kind = app::view::frontend::InputEvent::Kind::wheel, .y = 1},
        move_to(600, 300)});
  EXPECT_EQ(frames, 2);
}

TEST_F(InputOfPanels, TypedTextArrivesInOrder) {
  focus_field();
  // Keyboards send the key, what it prints, and the next key before the first is up.
  play({press('S'), text("s"), press('N'), text("n"), release('S'), release('N'), press('O'),
        text("ö"), release('O'), text("w"), text("界")});
  EXPECT_STREQ(field, "snöw界");
}

TEST_F(InputOfPanels, KeysBetweenTextsKeepTheirPlace) {
  focus_field();
  play({text("ab"), press(app::view::frontend::key::backspace),
        release(app::view::frontend::key::backspace), text("c"),
        press(app::view::frontend::key::left), release(app::view::frontend::key::left), text("X")});
  EXPECT_STREQ(field, "aXc");
}

TEST_F(InputOfPanels, SelectCopyAndPasteUseTheClipboardOfTheFrontend) {
  focus_field();
  const app::view::frontend::Modifiers ctrl{.ctrl = true};
  play({text("snow"), press(app::view::frontend::key::ctrl, ctrl), press('A', ctrl),
        release('A', ctrl), press('C', ctrl), release('C', ctrl),
        release(app::view::frontend::key::ctrl)});
  EXPECT_EQ(front.clipboard(), "snow");
  front.set_clipboard("ice");
  play({press(app::view::frontend::key::ctrl, ctrl), press('V', ctrl), release('V', ctrl),
        press('V', ctrl), release('V', ctrl), release(app::view::frontend::key::ctrl)});
  EXPECT_STREQ(field, "iceice");
  EXPECT_FALSE(ImGui::GetIO().KeyCtrl);
}

TEST_F(InputOfPanels, ModifierIsHeldFromItsOwnPress) {
  focus_field();
  // X11 reports the state before the event.
  const app::view::frontend::Modifiers none, ctrl{.ctrl = true};
  play({text("snow"), press(app::view::frontend::key::ctrl, none), press('A', ctrl),
        release('A', ctrl), release(app::view::frontend::key::ctrl, ctrl), text("x")});
  EXPECT_STREQ(field, "x") << "all of it was selected, then typed over";
}

TEST_F(InputOfPanels, PasteBringsItsText) {
  focus_field();
  app::view::frontend::InputEvent first{.kind = app::view::frontend::InputEvent::Kind::paste,
                                        .text = "one "};
  app::view::frontend::InputEvent second{.kind = app::view::frontend::InputEvent::Kind::paste,
                                         .text = "two"};
  play({first, second, text("!")});
  EXPECT_STREQ(field, "one two!");
  EXPECT_FALSE(ImGui::GetIO().KeyCtrl);
}

TEST_F(InputOfPanels, WheelScrollsBothWays) {
  play({wheel(0, 1), wheel(0, 1.5f), wheel(-1, 0)});
  EXPECT_EQ(frames, 1);
  input.push({wheel(0.5f, -2)});
  input.feed();
  EXPECT_EQ(ImGui::GetIO().MouseWheel, -2);
  EXPECT_EQ(ImGui::GetIO().MouseWheelH, -0.5f) << "Dear ImGui counts to the left";
  panels.frame([] {});
  EXPECT_EQ(ImGui::GetIO().MouseWheel, 0);
}

TEST_F(InputOfPanels, WheelAfterAClickWaitsForTheNextFrame) {
  play({move_to(button_middle.x, button_middle.y), button(true), wheel(0, 1), button(false)});
  EXPECT_EQ(clicks, 1);
  EXPECT_EQ(frames, 3);
}

TEST_F(InputOfPanels, WhoeverLeavesReleasesPressedAndPendingInput) {
  const app::view::frontend::Modifiers shift{.shift = true};
  play({press(app::view::frontend::key::shift, shift), press('Q', shift), button(true, 1)});
  EXPECT_TRUE(app::view::frontend::is_key_down('Q'));
  input.push({press('W', shift)});
  play({{.kind = app::view::frontend::InputEvent::Kind::gone}});
  for (const int key : {int{'Q'}, int{'W'}, app::view::frontend::key::shift})
    EXPECT_FALSE(app::view::frontend::is_key_down(key)) << key;
  EXPECT_FALSE(ImGui::GetIO().MouseDown[1]);
  EXPECT_FALSE(ImGui::GetIO().KeyShift);
  EXPECT_FALSE(ImGui::IsMousePosValid());
}

TEST_F(InputOfPanels, KeyIsPressedInOneFrame) {
  int pressed = 0;
  input.push({press(' '), release(' '), press(' '), release(' ')});
  for (int k = 0; k < 6; ++k) {
    input.feed();
    panels.frame([&] { pressed += app::view::frontend::is_key_pressed(' '); });
  }
  EXPECT_EQ(pressed, 2);
}

TEST_F(InputOfPanels, ImpossibleEventsAreLeftOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  play({move_to(nan, 1), move_to(1, std::numeric_limits<float>::infinity()), wheel(nan, nan),
        button(true, -1), button(true, 99), press(-5), press(100000), press(0), text("")});
  EXPECT_TRUE(std::isfinite(ImGui::GetIO().MousePos.x));
  EXPECT_EQ(frames, 1);
  play({text("\xff\xfe broken"), text(std::string("a\0b", 3))});
}

}  // namespace
}  // namespace neve::app
