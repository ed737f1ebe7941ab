/// Decisions of panels: scales of sliders, places of tips, parameters that pass a filter.

#include <gtest/gtest.h>
#include <imgui_internal.h>

#include <algorithm>
#include <map>
#include <memory>

#include "app/scene/params.h"
#include "app/scene/read.h"
#include "app/support/text.h"
#include "app/view/frontend/imgui_input.h"
#include "app/view/panels/labels.h"
#include "app/view/panels/orbit.h"
#include "app/view/panels/slider_scale.h"
#include "app/view/panels/tip.h"
#include "app/view/panels/viewer_state.h"
#include "app/view/panels/viewport.h"
#include "app/view/panels/widgets.h"
#include "app/view/panels/words.h"
#include "tests/cli/run_neve.h"
#include "tests/view/panels.h"
#include "tests/view/view_support.h"

namespace neve::app {
namespace {

using TurnedAs = app::view::panels::SliderScale::Kind;

app::view::panels::SliderScale scale_of(const std::string& address) {
  const auto info = app::scene::param_at(address);
  const auto usual = app::view::panels::usual_number(address);
  return app::view::panels::slider_scale(info->valid, usual, usual.value_or(0));
}

TEST(SliderScale, SliderScaleIsLogarithmicWhereAValueSpansDecades) {
  for (const char* address :
       {"material.snow.critical_compression", "material.snow.critical_stretch",
        "material.snow.youngs_modulus", "material.snow.density", "solver.cell_size",
        "solver.max_dt", "solver.dt", "solver.cfl", "collider.floor.friction"}) {
    const app::view::panels::SliderScale scale = scale_of(address);
    const double usual = *app::view::panels::usual_number(address);
    EXPECT_EQ(scale.kind, TurnedAs::logarithmic) << address;
    EXPECT_GT(scale.low, 0) << address;
    EXPECT_LE(scale.low, usual / 30) << address;
    EXPECT_GE(scale.high, 30 * usual) << address;
  }
}

TEST(SliderScale, SliderScaleIsLogarithmicBetweenBoundsThatAreFarApartWhateverIsUsual) {
  const app::scene::Valid valid = app::scene::between(0.01, 1e4);
  const app::view::panels::SliderScale scale =
      app::view::panels::slider_scale(valid, std::nullopt, 5);
  EXPECT_EQ(scale.kind, TurnedAs::logarithmic);
  EXPECT_EQ(scale.low, 0.01);
  EXPECT_EQ(scale.high, 1e4);
  EXPECT_TRUE(app::scene::spans_decades(valid, 9e3)) << "values around it have equal ratios, too";
  EXPECT_EQ(app::view::panels::slider_scale(app::scene::between(1, 170), std::nullopt, 5).kind,
            TurnedAs::linear);
}

TEST(SliderScale, SliderScaleIsLinearBetweenNearEndsAndOpenWithoutAny) {
  for (const char* address : {"material.snow.poisson_ratio", "solver.flip_ratio", "solver.beta",
                              "material.snow.hardening", "camera.fov"})
    EXPECT_EQ(scale_of(address).kind, TurnedAs::linear) << address;
  EXPECT_EQ(app::view::panels::slider_scale(app::scene::above(0), 1.0, 1).kind, TurnedAs::drag);
  EXPECT_EQ(app::view::panels::slider_scale(app::scene::within(1e6), 1.0, 1).kind, TurnedAs::drag);
  EXPECT_FALSE(app::view::panels::usual_number("body.ball.velocity"));
  EXPECT_FALSE(app::view::panels::usual_number("no.such.thing"));
}

TEST(SliderScale, SliderScaleReachesThePresentValueAndZeroWhereItIsAllowed) {
  const app::scene::Valid valid = app::scene::between(0, 1e6);
  EXPECT_TRUE(app::view::panels::slider_scale(valid, 1.0, 1).is_zero_at_low);
  EXPECT_FALSE(
      app::view::panels::slider_scale(app::scene::above(0).at_most(1e6), 1.0, 1).is_zero_at_low);
  EXPECT_EQ(app::view::panels::slider_scale(valid, 1.0, 5000).high, 5000);
  EXPECT_EQ(app::view::panels::slider_scale(valid, 1.0, 1e-4).low, 1e-4);
  EXPECT_GT(app::view::panels::slider_scale(valid, 1.0, 0).low, 0);
}

// A drag over a slider gives a value that the scene may have, whatever its kind.
TEST(SliderScale, SliderScaleGivesOnlyValidValues) {
  for (const app::scene::ParamInfo& info : app::scene::params()) {
    if (info.type != "number") continue;
    const app::view::panels::SliderScale scale =
        app::view::panels::slider_scale(info.valid, app::view::panels::usual_number(info.address),
                                        app::view::panels::usual_number(info.address).value_or(0));
    if (scale.kind == TurnedAs::drag) continue;
    EXPECT_LT(scale.low, scale.high) << info.address;
    EXPECT_TRUE(info.valid.contains(scale.low)) << info.address;
    EXPECT_TRUE(info.valid.contains(scale.high)) << info.address;
    if (scale.is_zero_at_low) {
      EXPECT_TRUE(info.valid.contains(0)) << info.address;
    }
  }
}

TEST(Tip, TipIsBesideItsWidgetAndOnTheScreen) {
  const ImVec2 screen(800, 600), size(200, 80);
  const ImVec2 below = app::view::panels::tip_place({100, 10}, {160, 30}, size, screen);
  EXPECT_EQ(below.x, 100);
  EXPECT_GE(below.y, 30);
  const ImVec2 above = app::view::panels::tip_place({700, 560}, {780, 580}, size, screen);
  EXPECT_EQ(above.x, 600);
  EXPECT_LE(above.y + size.y, 560);
}

TEST(Tip, TipWaitsUntilTheMouseRests) {
  Panels panels;
  ImGuiIO& io = ImGui::GetIO();
  int shown_at = -1;
  for (int k = 0; k < 60 && shown_at < 0; ++k) {
    io.MousePos = ImVec2(30, 20);
    panels.frame([&] {
      ImGui::Button("a button that is wide");
      if (app::view::panels::wants_tip()) shown_at = k;
      if (k == 5) {
        EXPECT_TRUE(app::view::panels::is_tip_coming());
      }
    });
  }
  EXPECT_GT(shown_at, 15);  // a quarter of a second
  EXPECT_LT(shown_at, 60);
  io.MousePos = ImVec2(500, 500);
  panels.frame([&] {
    ImGui::Button("a button that is wide");
    EXPECT_FALSE(app::view::panels::wants_tip());
  });
  EXPECT_FALSE(app::view::panels::is_tip_coming());
}

/// ImGui hides a new window in its first frame: a viewer that draws no more then never shows it.
TEST(Tip, APausedViewerDrawsUntilTheTipIsVisible) {
  Panels panels;
  ImGui::GetIO().MousePos = ImVec2(30, 20);
  int first = -1, drawn_after = 0;
  // The viewer draws while a tip is coming, and some frames after input.
  for (int k = 0; k < 200 && (k < 3 || app::view::panels::is_tip_coming()); ++k)
    panels.frame([&] {
      ImGui::Button("a button that is wide");
      if (!app::view::panels::wants_tip()) return;
      app::view::panels::show_tip({{"what it does"}});
      if (first < 0) first = k;
      drawn_after = k - first;
    });
  EXPECT_GT(first, 0);
  EXPECT_GE(drawn_after, 2);
  EXPECT_LT(drawn_after, 10) << "and rests then";
  const ImGuiWindow* tip = nullptr;
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
    if (window->Flags & ImGuiWindowFlags_Tooltip) tip = window;
  ASSERT_TRUE(tip);
  EXPECT_TRUE(tip->Active && !tip->Hidden);
}

TEST(Words, NumbersAreNotBrokenBehindTheirPoint) {
  Panels panels;
  const std::string text =
      "crosses 8.24 cells in a step of 0.008 s. Try: solver.dt = 0.000243\nor time_step";
  panels.frame([&] {
    const float letter = ImGui::CalcTextSize("x").x;
    for (int letters = 22; letters < 90; ++letters) {
      const float width = static_cast<float>(letters) * letter;
      std::string lines = app::view::panels::in_lines(text, width);
      EXPECT_LE(ImGui::CalcTextSize(lines.c_str()).x, width) << lines;
      for (const char* number : {"8.24", "0.008", "0.000243\n"})
        EXPECT_NE(lines.find(number), std::string::npos) << lines;
      std::replace(lines.begin(), lines.end(), '\n', ' ');
      std::string whole = text;
      std::replace(whole.begin(), whole.end(), '\n', ' ');
      EXPECT_EQ(lines, whole);
    }
  });
}

TEST(Tip, ATipThatChangesIsNeverCutOff) {
  Panels panels;
  ImGui::GetIO().MousePos = ImVec2(30, 20);
  std::string text = "short";
  const auto draw = [&] {
    panels.frame([&] {
      ImGui::Button("a button that is wide");
      if (app::view::panels::wants_tip()) app::view::panels::show_tip({{text}});
    });
  };
  for (int k = 0; k < 60; ++k) draw();
  const ImGuiWindow* tip = nullptr;
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
    if (window->Flags & ImGuiWindowFlags_Tooltip) tip = window;
  ASSERT_TRUE(tip);
  text = "a sentence that is much longer than what was there before it";
  draw();
  const ImVec2 size = tip->Size, space = tip->WindowPadding;
  draw();  // which measures the text
  EXPECT_GE(size.x, tip->ContentSize.x + 2 * space.x);
  EXPECT_GE(size.y, tip->ContentSize.y + 2 * space.y);
}

/// The labels that a scene's parameters leave with a filter, and whether something was shown.
std::pair<std::vector<std::string>, bool> filtered(const std::string& filter) {
  Panels panels;
  app::scene::Scene scene = app::scene::read_scene_text(test::tiny_scene, "scene.toml");
  bool has_shown = false;
  float height = 0;
  for (int k = 0; k < 2; ++k)
    panels.frame([&] {
      app::view::panels::Labels::of_panels().clear();
      app::view::panels::KnobPanel panel(filter, {});
      app::view::panels::Knobs knobs(panel, "");
      const float top = ImGui::GetCursorPosY();
      describe(knobs, scene);
      has_shown = panel.has_shown();
      height = ImGui::GetCursorPosY() - top;
    });
  // A title and a row each at most: no titles of groups without rows.
  const std::vector<std::string> names = app::view::panels::Labels::of_panels().names();
  EXPECT_LE(height, static_cast<float>(2 * names.size()) * ImGui::GetFrameHeightWithSpacing());
  return {names, has_shown};
}

TEST(Filter, FilterLeavesNoEmptyGroups) {
  const auto [names, has_shown] = filtered("critical_c");
  EXPECT_EQ(names, std::vector<std::string>{"material.snow.critical_compression"});
  EXPECT_TRUE(has_shown);
  const auto [none, nothing_shown] = filtered("no such words");
  EXPECT_TRUE(none.empty());
  EXPECT_FALSE(nothing_shown);
}

TEST(Columns, ColumnsShareANarrowWindow) {
  app::view::panels::PanelSwitches panels;
  EXPECT_TRUE(panels.shows_left() && panels.shows_right());
  panels.is_narrow = true;
  EXPECT_TRUE(panels.shows_left() && !panels.shows_right());
  panels.prefers_right = true;
  EXPECT_TRUE(!panels.shows_left() && panels.shows_right());
  panels.right = false;
  EXPECT_TRUE(panels.shows_left() && !panels.shows_right());
}

TEST(ProbeText, ProbeTextHasTheSizeOfTheQuantityAndSaysWhatIsCutAway) {
  app::view::session::ProbeReading probe;
  EXPECT_EQ(app::view::panels::probe_text(probe, "", true), "cut away");
  EXPECT_EQ(app::view::panels::probe_text(probe, "", false), "");
  app::view::session::ProbeRow row;
  row.name = "v";
  row.unit = "m/s";
  row.magnitude = 2;
  probe.rows = {row};
  EXPECT_EQ(app::view::panels::probe_text(probe, "id", false), "|v| = " + rough_text(2) + " m/s");
  EXPECT_EQ(app::view::panels::probe_text(probe, "v", true),
            "|v| = " + rough_text(2) + " m/s, cut away");
}

TEST(Slice, SliceTellsWhyThereAreNoArrows) {
  app::scene::View view;
  view.layers = {app::scene::Layer::arrows};
  view.slice.field = app::scene::VectorField::velocity;
  view.slice.range = app::scene::Range{0, 2};
  app::picture::FieldSamples fields;
  EXPECT_EQ(app::view::panels::reason_for_no_arrows(view, fields), "");  // not worked out yet
  fields.vectors[app::scene::VectorField::velocity] = {{0, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(app::view::panels::reason_for_no_arrows(view, fields),
            "no arrows: velocity is 0 everywhere");
  fields.vectors[app::scene::VectorField::velocity] = {{0, 0.001f, 0}};
  EXPECT_NE(app::view::panels::reason_for_no_arrows(view, fields).find("no visible arrows"),
            std::string::npos);
  fields.vectors[app::scene::VectorField::velocity] = {{0, 1, 0}};
  EXPECT_EQ(app::view::panels::reason_for_no_arrows(view, fields), "");
  view.layers = {app::scene::Layer::particles};
  fields.vectors[app::scene::VectorField::velocity] = {{0, 0, 0}};
  EXPECT_EQ(app::view::panels::reason_for_no_arrows(view, fields), "");
}

TEST(SliderScale, ThePlaceOfAValueIsBetweenTheEnds) {
  using app::view::panels::share_of;
  const app::view::panels::SliderScale linear{TurnedAs::linear, 0, 4, false},
      decades{TurnedAs::logarithmic, 1e-2, 1e2, true};
  EXPECT_DOUBLE_EQ(share_of(linear, 1), 0.25);
  EXPECT_DOUBLE_EQ(share_of(linear, 9), 1);
  EXPECT_DOUBLE_EQ(share_of(decades, 1), 0.5);
  EXPECT_DOUBLE_EQ(share_of(decades, 0), 0);
  EXPECT_DOUBLE_EQ(share_of(decades, 100), 1);
}

TEST(FrameAll, HasTheSnowAndThingsOfItsSizeAndNoPlaneOrMountain) {
  const auto scene = std::make_shared<app::scene::Scene>(app::scene::read_scene_text(R"(
frames = 1
[[body]]
shape = { sphere = { center = [0, 1, 0], radius = 0.1 } }
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[[collider]]
name = "above"
shape = { sphere = { center = [0, 2, 0], radius = 0.3 } }
[[collider]]
name = "mountain"
shape = { box = { center = [0, -500, 0], size = [900, 900, 900] } }
)",
                                                                                     "s.toml"));
  app::view::session::LiveFrame live;
  live.scene = scene;
  live.snapshot.particles.x = {sim::Vec3d(-0.1, 0.9, -0.1), sim::Vec3d(0.1, 1.1, 0.1)};
  const sim::shapes::Bounds box = app::view::panels::bounds_of_all(live);
  EXPECT_NEAR(box.max.y(), 2.3, 1e-9);
  EXPECT_NEAR(box.min.y(), 0.9, 1e-9);
  EXPECT_NEAR(box.max.x(), 0.3, 1e-9);
  live.snapshot.particles.x.clear();
  EXPECT_NEAR(app::view::panels::bounds_of_all(live).max.x(), 450, 1e-6) << "no snow: all things";
}

TEST(Orbit, OrbitIsAsLevelAsTheCameraOfTheSceneUntilItIsTurned) {
  using app::view::panels::Orbit;
  const sim::Vec3d eye(0.3, 0.4, 2), target(0, 0.1, 0), tilted(1, 1, 0.2);
  Orbit orbit(eye, target, tilted, 30);
  EXPECT_TRUE(orbit.eye().isApprox(eye, 1e-12));
  const sim::Vec3d along = orbit.forward(),
                   in_picture = (tilted - tilted.dot(along) * along).normalized();
  EXPECT_TRUE(orbit.up().isApprox(in_picture, 1e-12)) << orbit.up().transpose();
  EXPECT_TRUE(orbit.right().isApprox(along.cross(in_picture), 1e-12));
  EXPECT_TRUE(orbit.settings().up.isApprox(in_picture, 1e-12)) << "so is the picture";
  // A place on a ray is projected to the point of the picture from which the ray comes.
  const sim::Vec3d place = orbit.eye() + 1.5 * orbit.ray(0.2, -0.1), seen = orbit.project(place);
  EXPECT_NEAR(seen.x(), 0.2, 1e-12);
  EXPECT_NEAR(seen.y(), -0.1, 1e-12);
  orbit.pan(0.1, 0);
  EXPECT_TRUE(orbit.up().isApprox(in_picture, 1e-12));
  orbit.turn(0.01, 0);
  EXPECT_NEAR(orbit.right().y(), 0, 1e-12);
  EXPECT_EQ(orbit.settings().up, sim::Vec3d(0, 1, 0));
  EXPECT_EQ(Orbit(eye, target, {0, 1, 0}, 30).settings().up, sim::Vec3d(0, 1, 0));
}

/// A moment at which the speed of the probed particle is as given.
app::view::session::LiveFrame probed(double time, double speed) {
  app::view::session::LiveFrame live;
  live.scene = std::make_shared<app::scene::Scene>();
  live.snapshot.time = time;
  live.probed = app::dump::Probe(std::size_t{7});
  app::view::session::ProbeReading& reading = live.probe.emplace();
  reading.target = *live.probed;
  reading.time = time;
  app::view::session::ProbeRow row;
  row.name = "v";
  row.magnitude = speed;
  reading.rows = {row};
  return live;
}

TEST(ProbeTrace, ProbeTraceHasAllMomentsOfTheRunInTheOrderOfTime) {
  app::view::panels::ProbeTrace trace;
  trace.target = app::dump::Probe(std::size_t{7});
  const double fps = app::scene::Scene{}.fps;
  const auto at = [&](int frame) { return frame / fps; };
  for (const int frame : {1, 2, 4}) trace.take(probed(at(frame), frame));
  trace.take(probed(at(3), 3));  // an earlier moment is looked at
  using Points = std::map<double, double>;
  EXPECT_EQ(trace.points, (Points{{at(1), 1}, {at(2), 2}, {at(3), 3}, {at(4), 4}}));
  auto forked = probed(at(3), 5);  // continued from frame 2
  forked.returns = 1;
  forked.returned_to = at(2);
  trace.take(forked);
  EXPECT_EQ(trace.points, (Points{{at(1), 1}, {at(2), 2}, {at(3), 5}}));
  auto other = probed(at(2), 9);
  other.probed = app::dump::Probe(std::size_t{8});
  other.returns = 1;
  trace.take(other);
  EXPECT_EQ(trace.points.size(), 3u) << "of another particle";
  auto again = probed(0, 6);  // after a Reset
  again.start = 1;
  again.returns = 1;
  trace.take(again);
  EXPECT_EQ(trace.points, (Points{{0, 6}}));
}

TEST(Plots, SharesOfPhasesAreOfAllOfThem) {
  app::view::session::LiveFrame live;
  live.phases = {1, 2, 4, 8, 16, 32, 64};
  EXPECT_EQ(live.phases.total(), 127);
}

/// ";" is shift and "," on many keyboards: it was a step of the run.
TEST(Keys, ASignIsWhatIsTypedOnceForEachPress) {
  const test::TemporaryFolder folder;
  view::session::Workbench bench = test::bench_for(folder, test::tiny_scene);
  view::panels::ViewerState state{.bench = bench};
  state.live = bench.session().latest();
  Panels panels;
  ClipboardFrontend front;
  view::frontend::ImGuiInput input(front);
  const auto play = [&](std::vector<view::frontend::InputEvent> events) {
    input.push(std::move(events));
    for (bool is_more = true; is_more;) {
      is_more = input.feed();
      panels.frame([&] { view::panels::use_keys(state); });
    }
  };
  const auto wait_for_stage = [&](sim::Stage stage) {
    const auto live = test::wait_for(bench.session(), [&](const view::session::LiveFrame& shown) {
      return shown.stage && shown.stage->stage == stage;
    });
    EXPECT_EQ(live->steps, 0u);
  };
  const view::frontend::Modifiers shift{.shift = true};
  play({press(',', shift), text(";")});
  play({text(";")});  // it is held
  wait_for_stage(sim::Stage{});
  play({release(',', shift)});
  play({text(";")});  // of a phone
  wait_for_stage(static_cast<sim::Stage>(1));
}

}  // namespace
}  // namespace neve::app
