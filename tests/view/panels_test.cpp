/// What panels decide: how numbers are turned, where tips stand, what a filter leaves.

#include <gtest/gtest.h>

#include <algorithm>

#include "app/scene/params.h"
#include "app/scene/read.h"
#include "app/text.h"
#include "app/view/labels.h"
#include "app/view/slider_scale.h"
#include "app/view/tip.h"
#include "app/view/viewport.h"
#include "app/view/widgets.h"
#include "tests/cli/run_neve.h"
#include "tests/view/panels.h"

namespace neve::app {
namespace {

using TurnedAs = SliderScale::Kind;

SliderScale scale_of(const std::string& address) {
  const auto info = param_at(address);
  const auto usual = usual_number(address);
  return slider_scale(info->valid, usual, usual.value_or(0));
}

TEST(SliderScale, IsLogarithmicWhereAValueSpansDecades) {
  for (const char* address :
       {"material.snow.critical_compression", "material.snow.critical_stretch",
        "material.snow.youngs_modulus", "material.snow.density", "solver.cell_size",
        "solver.max_dt", "solver.dt", "solver.cfl", "collider.floor.friction"}) {
    const SliderScale scale = scale_of(address);
    const double usual = *usual_number(address);
    EXPECT_EQ(scale.kind, TurnedAs::logarithmic) << address;
    EXPECT_GT(scale.low, 0) << address;
    EXPECT_LE(scale.low, usual / 30) << address;
    EXPECT_GE(scale.high, 30 * usual) << address;
  }
}

TEST(SliderScale, IsLinearBetweenNearEndsAndOpenWithoutAny) {
  for (const char* address : {"material.snow.poisson_ratio", "solver.flip_ratio", "solver.beta",
                              "material.snow.hardening", "camera.fov"})
    EXPECT_EQ(scale_of(address).kind, TurnedAs::linear) << address;
  EXPECT_EQ(slider_scale(above(0), 1.0, 1).kind, TurnedAs::drag);
  EXPECT_EQ(slider_scale(within(1e6), 1.0, 1).kind, TurnedAs::drag);
  EXPECT_FALSE(usual_number("body.ball.velocity"));
  EXPECT_FALSE(usual_number("no.such.thing"));
}

TEST(SliderScale, ReachesThePresentValueAndZeroWhereItIsAllowed) {
  const Valid valid = between(0, 1e6);
  EXPECT_TRUE(slider_scale(valid, 1.0, 1).is_zero_at_low);
  EXPECT_FALSE(slider_scale(above(0).at_most(1e6), 1.0, 1).is_zero_at_low);
  EXPECT_EQ(slider_scale(valid, 1.0, 5000).high, 5000);
  EXPECT_EQ(slider_scale(valid, 1.0, 1e-4).low, 1e-4);
  EXPECT_GT(slider_scale(valid, 1.0, 0).low, 0);
}

// A drag over a slider gives a value that the scene may have, whatever its kind.
TEST(SliderScale, GivesOnlyValidValues) {
  for (const ParamInfo& info : params()) {
    if (info.type != "number") continue;
    const SliderScale scale = slider_scale(info.valid, usual_number(info.address),
                                           usual_number(info.address).value_or(0));
    if (scale.kind == TurnedAs::drag) continue;
    EXPECT_LT(scale.low, scale.high) << info.address;
    EXPECT_TRUE(info.valid.contains(scale.low)) << info.address;
    EXPECT_TRUE(info.valid.contains(scale.high)) << info.address;
    if (scale.is_zero_at_low) {
      EXPECT_TRUE(info.valid.contains(0)) << info.address;
    }
  }
}

TEST(Tip, StandsBesideItsWidgetAndOnTheScreen) {
  const ImVec2 screen(800, 600), size(200, 80);
  const ImVec2 below = tip_place({100, 10}, {160, 30}, size, screen);
  EXPECT_EQ(below.x, 100);
  EXPECT_GE(below.y, 30);
  const ImVec2 above = tip_place({700, 560}, {780, 580}, size, screen);
  EXPECT_EQ(above.x, 600);
  EXPECT_LE(above.y + size.y, 560);
}

TEST(Tip, WaitsUntilTheMouseRests) {
  Panels panels;
  ImGuiIO& io = ImGui::GetIO();
  int shown_at = -1;
  for (int k = 0; k < 60 && shown_at < 0; ++k) {
    io.MousePos = ImVec2(30, 20);
    panels.frame([&] {
      ImGui::Button("a button that is wide");
      if (wants_tip()) shown_at = k;
      if (k == 5) {
        EXPECT_TRUE(is_tip_coming());
      }
    });
  }
  EXPECT_GT(shown_at, 15);  // a quarter of a second
  EXPECT_LT(shown_at, 60);
  io.MousePos = ImVec2(500, 500);
  panels.frame([&] {
    ImGui::Button("a button that is wide");
    EXPECT_FALSE(wants_tip());
  });
  EXPECT_FALSE(is_tip_coming());
}

/// The labels that a scene's parameters leave with a filter, and whether something was shown.
std::pair<std::vector<std::string>, bool> filtered(const std::string& filter) {
  Panels panels;
  Scene scene = read_scene_text(test::tiny_scene, "scene.toml");
  bool has_shown = false;
  float height = 0;
  for (int k = 0; k < 2; ++k)
    panels.frame([&] {
      Labels::of_panels().clear();
      KnobPanel panel(filter, {});
      Knobs knobs(panel, "");
      const float top = ImGui::GetCursorPosY();
      describe(knobs, scene);
      has_shown = panel.has_shown();
      height = ImGui::GetCursorPosY() - top;
    });
  // A title and a row each at most: no titles of groups without rows.
  const std::vector<std::string> names = Labels::of_panels().names();
  EXPECT_LE(height, static_cast<float>(2 * names.size()) * ImGui::GetFrameHeightWithSpacing());
  return {names, has_shown};
}

TEST(Filter, LeavesNoEmptyGroups) {
  const auto [names, has_shown] = filtered("critical_c");
  EXPECT_EQ(names, std::vector<std::string>{"material.snow.critical_compression"});
  EXPECT_TRUE(has_shown);
  const auto [none, nothing_shown] = filtered("no such words");
  EXPECT_TRUE(none.empty());
  EXPECT_FALSE(nothing_shown);
}

TEST(Columns, ShareTheRoomOfANarrowWindow) {
  PanelSwitches panels;
  EXPECT_TRUE(panels.shows_left() && panels.shows_right());
  panels.is_narrow = true;
  EXPECT_TRUE(panels.shows_left() && !panels.shows_right());
  panels.prefers_right = true;
  EXPECT_TRUE(!panels.shows_left() && panels.shows_right());
  panels.right = false;
  EXPECT_TRUE(panels.shows_left() && !panels.shows_right());
}

TEST(ProbeText, HasTheSizeOfTheQuantityAndSaysWhatIsCutAway) {
  ProbeReading probe;
  EXPECT_EQ(probe_text(probe, "", true), "cut away");
  EXPECT_EQ(probe_text(probe, "", false), "");
  ProbeRow row;
  row.name = "v";
  row.unit = "m/s";
  row.magnitude = 2;
  probe.rows = {row};
  EXPECT_EQ(probe_text(probe, "id", false), "|v| = " + rough_text(2) + " m/s");
  EXPECT_EQ(probe_text(probe, "v", true), "|v| = " + rough_text(2) + " m/s, cut away");
}

TEST(Slice, TellsWhyThereAreNoArrows) {
  View view;
  view.layers = {Layer::arrows};
  view.slice.field = VectorField::velocity;
  view.slice.range = Range{0, 2};
  NodeFields fields;
  EXPECT_EQ(reason_for_no_arrows(view, fields), "");  // not worked out yet
  fields.vectors[VectorField::velocity] = {{0, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(reason_for_no_arrows(view, fields), "no arrows: velocity is 0 everywhere");
  fields.vectors[VectorField::velocity] = {{0, 0.001f, 0}};
  EXPECT_NE(reason_for_no_arrows(view, fields).find("no arrows to be seen"), std::string::npos);
  fields.vectors[VectorField::velocity] = {{0, 1, 0}};
  EXPECT_EQ(reason_for_no_arrows(view, fields), "");
  view.layers = {Layer::particles};
  fields.vectors[VectorField::velocity] = {{0, 0, 0}};
  EXPECT_EQ(reason_for_no_arrows(view, fields), "");
}

}  // namespace
}  // namespace neve::app
