/// Plots of diagnostics: what they hold, and that their axes depend on the scene alone.

#include "app/picture/plots.h"

#include <gtest/gtest.h>

#include "app/scene/read.h"
#include "app/setup/resolve.h"

namespace neve::app {
namespace {

std::vector<app::picture::PlotSample> history_of(int frames) {
  std::vector<app::picture::PlotSample> history;
  for (int k = 0; k <= frames; ++k)
    history.push_back({0.5 * k, 3.0 * k, 1.0 * k, 2.0, 7.0 * k, static_cast<std::size_t>(k) * 10,
                       k % 2 ? sim::DtLimit::acoustic : sim::DtLimit::cfl});
  return history;
}

const app::scene::PlotRanges ranges{app::scene::Range{0, 10}, app::scene::Range{0, 4},
                                    app::scene::Range{0, 50}, app::scene::Range{0, 1e-3}};
constexpr bool without_colliders = false, with_colliders = true;

TEST(Plots, HoldEnergiesSpeedAndStep) {
  const auto plots = app::picture::make_plots(ranges, without_colliders, history_of(4), 2, 0.5, 3);
  ASSERT_EQ(plots.size(), 3u);
  EXPECT_EQ(plots[0].unit, "J");
  ASSERT_EQ(plots[0].series.size(), 3u);
  EXPECT_EQ(plots[0].series[0].value.back(), 12);
  EXPECT_EQ(plots[0].series[1].value.back(), 4);
  EXPECT_EQ(plots[0].series[2].value.back(), 16) << "the total is the sum";
  EXPECT_EQ(plots[1].series.at(0).value, std::vector<float>(5, 2.0f));
  EXPECT_EQ(plots[0].x_end, 3);
  EXPECT_EQ(plots[0].now, 2);
}

TEST(Plots, StepsAreBarsUnderTheLimitThatRuledThem) {
  const render::Plot plot =
      app::picture::make_plots(ranges, without_colliders, history_of(4), 2, 0.5, 3)[2];
  EXPECT_EQ(plot.unit, "ms");
  EXPECT_EQ(plot.max, 1);
  ASSERT_EQ(plot.series.size(), 2u) << "limits that never ruled are not named";
  EXPECT_EQ(plot.series[0].name, "cfl");
  EXPECT_EQ(plot.series[0].x, (std::vector<float>{1, 2})) << "frame 0 has no steps";
  EXPECT_EQ(plot.series[0].value, (std::vector<float>{25, 12.5}));  // ms: 500 / 20, 500 / 40
  EXPECT_EQ(plot.series[1].name, "acoustic");
  EXPECT_NE(plot.series[0].color, plot.series[1].color);
}

TEST(Plots, ForcesArePlottedWhereThereAreColliders) {
  const auto plots = app::picture::make_plots(ranges, with_colliders, history_of(4), 2, 0.5, 3);
  ASSERT_EQ(plots.size(), 4u);
  EXPECT_EQ(plots[2].unit, "N");
  EXPECT_EQ(plots[2].max, 50);
  EXPECT_EQ(plots[2].series.at(0).value, (std::vector<float>{0, 7, 14, 21, 28}));
  EXPECT_EQ(plots[3].unit, "ms") << "steps are last";
}

TEST(Plots, LeaveOutWhatIsLaterThanTheFrame) {
  const auto plots = app::picture::make_plots(ranges, without_colliders, history_of(6), 1, 0.5, 3);
  EXPECT_EQ(plots[0].series[0].x, (std::vector<float>{0, 0.5, 1}));
  EXPECT_TRUE(
      app::picture::make_plots(ranges, without_colliders, {}, 1, 0.5, 3)[0].series[0].x.empty());
}

TEST(PlotRanges, ComeFromTheSceneAndHoldTheFall) {
  app::scene::Scene scene = app::scene::read_scene_text(R"(
frames = 12
[[body]]
shape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } }
[[collider]]
shape = { plane = {} }
[[view]]
name = "a"
layers = ["plots"]
[[view]]
name = "b"
layers = ["plots"]
plots = { dt_range = [0, 0.01] }
)",
                                                        "s.toml");
  app::setup::resolve(scene, 1000);
  const app::scene::PlotRanges& automatic = scene.views[0].plots;
  // m g h = 400 kg/m3 * 4/3 pi (0.1 m)^3 * 9.81 m/s2 * 0.5 m = 8.2 J, rounded up.
  EXPECT_EQ(automatic.energy->max, 10);
  EXPECT_EQ(automatic.speed->max, 4);
  // 1.68 kg at 3.13 m/s stopped in a frame of 1/24 s, 126 N, and their weight, 16 N, rounded up.
  EXPECT_EQ(automatic.force->max, 150);
  // Steps at rest: acoustic_cfl * h / c with h = 0.02 m, c = 19.7 m/s at most; 1 ms is the longest.
  EXPECT_GT(automatic.dt->max, 1e-4);
  EXPECT_LE(automatic.dt->max, 1.5e-3);
  EXPECT_EQ(scene.views[1].plots.dt->max, 0.01) << "a given range stays";
  const app::scene::Scene again =
      app::scene::read_scene_text(app::scene::write_scene(scene), "written");
  EXPECT_EQ(again.views[0].plots.energy->max, 10);
}

TEST(PlotSample, PlotSampleTakesTheLimitThatRuledMost) {
  sim::AdvanceReport advance;
  advance.steps = 5;
  advance.ruled[static_cast<std::size_t>(sim::DtLimit::strain)] = 4;
  sim::Summary summary;
  summary.kinetic_energy = 7;
  advance.loads = {{.impulse = {0, -3, 4}}, {.impulse = {1, 0, 0}}};
  const app::picture::PlotSample sample = app::picture::plot_sample(0.25, 0.5, summary, advance);
  EXPECT_EQ(sample.max_force, 10) << "5 N s in 0.5 s";
  EXPECT_EQ(sample.limit, sim::DtLimit::strain);
  EXPECT_EQ(sample.steps, 5u);
  EXPECT_EQ(sample.kinetic_energy, 7);
}

}  // namespace
}  // namespace neve::app
