/// Sweep files around the value of a parameter.

#include <gtest/gtest.h>

#include "app/scene/read.h"
#include "app/support/errors.h"
#include "app/sweep/plan/around.h"
#include "app/sweep/plan/expand.h"
#include "app/sweep/read/read_sweep.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

constexpr const char* around_scene = R"(
[solver]
cell_size = 0.05
[[body]]
name = "ball"
shape = { sphere = { radius = 0.1 } }
velocity = [0, -4, 0]
[[collider]]
shape = { plane = {} }
)";

app::scene::FlatParam flat_param(const std::string& address, const std::string& value = {}) {
  std::vector<app::scene::Override> overrides;
  if (!value.empty()) overrides.push_back({address, value});
  for (app::scene::FlatParam& found :
       app::scene::flatten(app::scene::read_scene_text(around_scene, "s.toml", "", overrides)))
    if (found.address == address) return found;
  throw std::runtime_error("nothing is called " + address);
}

std::string around(const std::string& address, const std::string& value = {}) {
  return app::scene::toml::toml_literal(
      {app::scene::toml::Array(app::sweep::plan::values_around(flat_param(address, value)))});
}

TEST(ValuesAround, ValuesSpanDecadesIfRatiosMatter) {
  EXPECT_EQ(around("material.snow.youngs_modulus"), "[14000, 44300, 140000, 443000, 1400000]");
  EXPECT_EQ(around("solver.cell_size"), "[0.0125, 0.025, 0.05, 0.1, 0.2]");
  EXPECT_EQ(around("solver.max_dt"), "[0.00025, 5e-4, 0.001, 0.002, 0.004]");
  EXPECT_EQ(around("solver.cfl", "800"), "[200, 400, 800]");
  // Zero is allowed, and half of the usual value looks like it.
  EXPECT_EQ(around("material.snow.critical_stretch"), "[0.00187, 0.00375, 0.0075, 0.015, 0.03]");
}

TEST(ValuesAround, OtherValuesHaveEqualDistancesAndStayInRange) {
  EXPECT_EQ(around("material.snow.hardening"), "[5, 7.5, 10, 12.5, 15]");
  EXPECT_EQ(around("material.snow.poisson_ratio"), "[0.1, 0.15, 0.2, 0.25, 0.3]");
  EXPECT_EQ(around("material.snow.poisson_ratio", "0.4"), "[0.2, 0.3, 0.4, 0.445, 0.49]");
  EXPECT_EQ(around("solver.flip_ratio"), "[0.475, 0.712, 0.95, 0.975, 1]");
  EXPECT_EQ(around("solver.flip_ratio", "1"), "[0.5, 0.625, 0.75, 0.875, 1]");
  EXPECT_EQ(around("collider.1.friction", "0"), "[0, 0.125, 0.25, 0.375, 0.5]");
  EXPECT_EQ(around("seed"), "[0, 1, 2, 3]");
  EXPECT_EQ(around("frames", "100000"), "[50000, 62500, 75000, 87500, 100000]");
}

TEST(ValuesAround, ChoicesTakeAllValuesAndVectorsAreStretched) {
  EXPECT_EQ(around("solver.transfer"), "[\"flip\", \"apic\", \"mls\", \"aflip\", \"asflip\"]");
  EXPECT_EQ(around("body.ball.velocity"),
            "[[0, -2, 0], [0, -3, 0], [0, -4, 0], [0, -5, 0], [0, -6, 0]]");
  EXPECT_THROW(around("body.ball.angular_velocity"), app::UsageError);
  EXPECT_THROW(around("title"), app::UsageError);
  EXPECT_THROW(around("body.ball.name"), app::UsageError);
  EXPECT_THROW(around("camera"), app::UsageError);
}

/// All parameters that have values around them: each value is valid, the present one among them.
TEST(ValuesAround, AllValuesAreValidAndThePresentOneIsAmongThem) {
  int count = 0;
  for (const app::scene::FlatParam& param :
       app::scene::flatten(app::scene::read_scene_text(around_scene, "s.toml"))) {
    std::vector<app::scene::toml::Value> values;
    try {
      values = app::sweep::plan::values_around(param);
    } catch (const app::UsageError&) {
      continue;
    }
    ++count;
    EXPECT_GE(values.size(), 2u) << param.address;
    bool has_present = false;
    for (const app::scene::toml::Value& value : values) {
      has_present = has_present || app::scene::same_value(value, param.value);
      try {
        app::scene::read_scene_text(around_scene, "s.toml", "",
                                    {{param.address, app::scene::toml::toml_literal(value)}});
      } catch (const std::exception& error) {
        // Only rules for values that belong together may object.
        EXPECT_EQ(std::string(error.what()).find("expected"), std::string::npos) << error.what();
      }
    }
    EXPECT_EQ(has_present, param.value.has_value()) << param.address;
  }
  EXPECT_GT(count, 50);
}

TEST(SweepAround, ASweepAroundAValueIsAFileThatReadsAsTheSweep) {
  const test::TemporaryFolder folder;
  const auto scene = folder.write("scenes/a b.toml", around_scene);
  const auto file = folder / "sweeps/hardening.toml";
  const std::vector<app::scene::Override> set{
      app::scene::parse_override("solver.cfl=0.3"),
      app::scene::parse_override("title=It « is »"),
      app::scene::parse_override("material.snow.hardening=8"),
      app::scene::parse_override("solver.cfl=0.2"),
      app::scene::parse_override("camera={ fov = 20 }"),
      app::scene::parse_override("camera.orbit=none")};
  const std::string text = app::sweep::plan::sweep_around(
      scene.string(), file.string(), flat_param("material.snow.hardening", "8"), set);
  EXPECT_NE(text.find("scene = \"../scenes/a b.toml\""), std::string::npos) << text;
  folder.write("sweeps/hardening.toml", text);
  const app::sweep::read::Sweep sweep = app::sweep::read::read_sweep(file.string(), {});
  ASSERT_EQ(sweep.axes.size(), 1u);
  ASSERT_EQ(sweep.axes[0].parameters.size(), 1u);
  EXPECT_EQ(sweep.axes[0].parameters[0].address, "material.snow.hardening");
  EXPECT_EQ(sweep.axes[0].size(), 5u);
  EXPECT_EQ(sweep.fixed.size(), 4u);
  // The scene of each run is the one that --set would make.
  for (const app::scene::Override& value : sweep.axes[0].parameters[0].values) {
    std::vector<app::scene::Override> in_sweep = sweep.fixed, by_hand = set;
    in_sweep.push_back(value);
    by_hand.push_back(value);
    EXPECT_EQ(app::scene::write_scene(app::scene::read_scene_file(sweep.scene_file, in_sweep)),
              app::scene::write_scene(app::scene::read_scene_file(scene.string(), by_hand)));
  }
}

}  // namespace
}  // namespace neve::app
