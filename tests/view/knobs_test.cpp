/// Numbers typed into a parameter's field.

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "app/view/frontend/imgui_input.h"
#include "app/view/panels/widgets.h"
#include "tests/view/panels.h"

namespace neve::app {
namespace {

/// One parameter's field, and the edits that it has made.
template <class T>
struct Field {
  ClipboardFrontend front;
  Panels panels;
  app::view::frontend::ImGuiInput input{front};
  T value;
  app::scene::Valid valid;
  std::vector<app::view::session::Edit> edits;
  ImVec2 middle;

  Field(T start, const app::scene::Valid& allowed) : value(start), valid(allowed) { play({}); }

  void draw() {
    app::view::panels::KnobPanel panel("", {});
    app::view::panels::Knobs knobs(panel, "test");
    const ImVec2 at = ImGui::GetCursorScreenPos();
    middle = ImVec2(at.x + 40, at.y + 0.5f * ImGui::GetFrameHeight());
    knobs("stiffness", value, "Pa", valid, app::scene::Change::live, "Stiffness of the snow.");
    for (const app::view::session::Edit& edit : panel.edits()) edits.push_back(edit);
  }

  void play(std::vector<app::view::frontend::InputEvent> events) {
    input.push(std::move(events));
    for (bool is_more = true; is_more;) {
      is_more = input.feed();
      panels.frame([&] { draw(); });
    }
    panels.frame([&] { draw(); });
  }

  /// Types into the field after ctrl and a click, which select its text.
  void type(const std::string& typed, int last_key = app::view::frontend::key::enter) {
    const app::view::frontend::Modifiers ctrl{.ctrl = true};
    edits.clear();
    const app::view::frontend::InputEvent down{
        .kind = app::view::frontend::InputEvent::Kind::button, .is_down = true, .held = ctrl};
    const app::view::frontend::InputEvent up{.kind = app::view::frontend::InputEvent::Kind::button,
                                             .held = ctrl};
    play({move_to(middle.x, middle.y), press(app::view::frontend::key::ctrl, ctrl), down, up,
          release(app::view::frontend::key::ctrl)});
    for (const char c : typed) play({text(std::string(1, c))});
    play({press(last_key), release(last_key)});
  }
};

TEST(TypedNumber, TypedNumberIsTakenWhenComplete) {
  Field<double> field(140000, app::scene::between(0.001, 1e12));
  field.type("30000");
  ASSERT_EQ(field.edits.size(), 1u);
  EXPECT_EQ(field.edits[0].kind, app::view::session::Edit::Kind::set);
  EXPECT_EQ(field.edits[0].address, "test.stiffness");
  EXPECT_EQ(std::stod(field.edits[0].value), 30000);
}

TEST(TypedNumber, OutOfRangeIsRefusedWithTheRange) {
  Field<double> field(140000, app::scene::between(0.001, 1e12));
  for (const char* typed : {"-5", "0", "2e13"}) {
    field.type(typed);
    ASSERT_EQ(field.edits.size(), 1u) << typed;
    EXPECT_EQ(field.edits[0].kind, app::view::session::Edit::Kind::refused) << typed;
    EXPECT_EQ(field.edits[0].address, "test.stiffness") << typed;
    EXPECT_NE(field.edits[0].value.find("expected 0.001 <= value <= "), std::string::npos)
        << field.edits[0].value;
    EXPECT_NE(field.edits[0].value.find(" Pa"), std::string::npos) << field.edits[0].value;
  }
}

TEST(TypedNumber, TypedNumberWithLettersIsRefused) {
  Field<double> field(140000, app::scene::between(0.001, 1e12));
  for (const char* typed : {"banana", "30 kPa", "0,5"}) {
    field.type(typed);
    ASSERT_EQ(field.edits.size(), 1u) << typed;
    EXPECT_EQ(field.edits[0].kind, app::view::session::Edit::Kind::refused) << typed;
  }
}

TEST(TypedNumber, TypedNumberIsForgottenWithEscape) {
  Field<double> field(140000, app::scene::between(0.001, 1e12));
  field.type("30000", app::view::frontend::key::escape);
  EXPECT_TRUE(field.edits.empty());
  field.type("-5", app::view::frontend::key::escape);
  EXPECT_TRUE(field.edits.empty());
}

TEST(TypedNumber, TypedNumberOfAWholeNumberIsHeldToItsRangeToo) {
  Field<int> field(5, app::scene::between(1, 100));
  field.type("101");
  ASSERT_EQ(field.edits.size(), 1u);
  EXPECT_EQ(field.edits[0].kind, app::view::session::Edit::Kind::refused);
  field.type("100");
  ASSERT_EQ(field.edits.size(), 1u);
  EXPECT_EQ(field.edits[0].kind, app::view::session::Edit::Kind::set);
  EXPECT_EQ(field.edits[0].value, "100");
}

/// The widest drag is no reason to move a value that the scene may have.
TEST(UntouchedField, UntouchedFieldsChangeNothing) {
  Field<std::uint64_t> seed(9007199254740992, app::scene::between(0, 0x1p53));
  Field<app::scene::PictureSize> size({20000, 400}, app::scene::between(16, 1000000));
  Field<double> number(0.0, app::scene::at_least(1e-6).at_most_or_0(1e6));
  EXPECT_TRUE(seed.edits.empty());
  EXPECT_TRUE(size.edits.empty());
  EXPECT_TRUE(number.edits.empty());
}

TEST(TypedNumber, TypedNumberMayBeAsLargeAsInAScene) {
  Field<std::uint64_t> field(1, app::scene::between(0, 0x1p53));
  field.type("9007199254740992");
  ASSERT_EQ(field.edits.size(), 1u);
  EXPECT_EQ(field.edits[0].kind, app::view::session::Edit::Kind::set);
  EXPECT_EQ(field.edits[0].value, "9007199254740992");
}

TEST(TypedText, TypedTextOfAnyLengthIsTaken) {
  Field<std::string> field("short", app::scene::anything);
  const std::string typed(1500, 'b');
  field.type(typed);
  ASSERT_EQ(field.edits.size(), 1u);
  EXPECT_EQ(field.edits[0].value, "\"" + typed + "\"");
}

}  // namespace
}  // namespace neve::app
