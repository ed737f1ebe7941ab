/// A scene as a list, and what differs between two.

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "app/scene/flat.h"
#include "app/scene/presets.h"
#include "app/scene/read.h"
#include "app/support/errors.h"

namespace neve::app {
namespace {

constexpr const char* flat_scene = R"(
[solver]
cfl = 0.3
[material.wet]
density = 500
[[body]]
name = "ball"
shape = { sphere = { radius = 0.1 } }
[[collider]]
shape = { plane = {} }
[[view]]
name = "close"
camera = { fov = 20, keyframes = [{ time = 0, eye = [1, 2, 3], target = [0, 0, 0] }] }
)";

app::scene::Scene read(const std::vector<std::string>& sets = {},
                       const std::string& text = flat_scene) {
  std::vector<app::scene::Override> overrides;
  for (const std::string& set : sets) overrides.push_back(app::scene::parse_override(set));
  return app::scene::read_scene_text(text, "s.toml", "", overrides);
}

const app::scene::FlatParam& find(const std::vector<app::scene::FlatParam>& list,
                                  const std::string& address) {
  for (const app::scene::FlatParam& param : list)
    if (param.address == address) return param;
  throw std::runtime_error("nothing is called " + address);
}

TEST(Flat, FlatListHasEveryParameterOfTheSceneWithValueAndRange) {
  const std::vector<app::scene::FlatParam> list = app::scene::flatten(read());
  const app::scene::FlatParam& cfl = find(list, "solver.cfl");
  EXPECT_EQ(cfl.text(), "0.3");
  EXPECT_EQ(cfl.type, "number");
  EXPECT_EQ(app::scene::toml::toml_literal(*cfl.default_value), "0.4");
  EXPECT_FALSE(cfl.is_default());
  EXPECT_TRUE(cfl.is_live);
  EXPECT_EQ(cfl.valid.max, 1e3);
  EXPECT_EQ(find(list, "material.snow.density").text(), "400");
  EXPECT_EQ(find(list, "material.wet.density").text(), "500");
  EXPECT_FALSE(find(list, "material.wet.density").is_live);
  EXPECT_STREQ(find(list, "material.wet.density").unit, "kg/m3");
  EXPECT_EQ(find(list, "body.ball.shape.sphere.radius").text(), "0.1");
  EXPECT_FALSE(find(list, "body.ball.shape.sphere.radius").is_live);
  EXPECT_TRUE(find(list, "collider.1.shape.plane.point").is_live);
  EXPECT_TRUE(find(list, "collider.1.shape").is_live);
  EXPECT_EQ(find(list, "solver.kernel").choices, (std::vector<std::string>{"cubic", "quadratic"}));
  EXPECT_EQ(find(list, "view.close.background").choices,
            (std::vector<std::string>{"gradient", "transparent"}));
  EXPECT_EQ(find(list, "camera").text(), "none");
  EXPECT_EQ(find(list, "view.close.camera.eye").text(), "none");
  EXPECT_EQ(find(list, "view.close.camera.keyframes").type, "tables");
  EXPECT_EQ(find(list, "view.close.clip").text(), "none");
}

/// Every leaf of params() that the scene can have occurs once, in the same order.
TEST(Flat, FlatListFollowsTheOrderOfTheDescription) {
  const std::string text = R"(
[[body]]
name = "NAME"
shape = { sphere = { radius = 0.1 } }
[[emitter]]
name = "NAME"
shape = { cone = { radius = 0.1, height = 0.2 } }
[[sink]]
name = "NAME"
shape = { torus = { major_radius = 0.15, minor_radius = 0.05 } }
[[collider]]
name = "NAME"
shape = { box = { size = [0.2, 0.2, 0.2] } }
[[curve]]
name = "NAME"
parameter = "solver.gravity"
keyframes = [{ time = 0, vector = [0, -9.81, 0] }]
[camera]
fov = 20
[[view]]
name = "NAME"
camera = { fov = 20 }
clip = {}
[[mosaic]]
name = "M"
views = ["NAME"]
[[export]]
name = "NAME"
)";
  std::vector<std::string> found;
  for (const app::scene::FlatParam& param : app::scene::flatten(read({}, text))) {
    std::string address = param.address;
    if (address.starts_with("material.snow")) address.replace(9, 4, "NAME");
    if (address.starts_with("mosaic.M")) address.replace(7, 1, "NAME");
    if (param.type != "table" && param.type != "tables") found.push_back(address);
  }
  std::vector<std::string> expected;
  for (const app::scene::ParamInfo& info : app::scene::params()) {
    const bool is_other_form = info.address.find(".shape.") != std::string::npos &&
                               !info.address.starts_with("body.NAME.shape.sphere.") &&
                               !info.address.starts_with("emitter.NAME.shape.cone.") &&
                               !info.address.starts_with("sink.NAME.shape.torus.") &&
                               !info.address.starts_with("collider.NAME.shape.box.");
    // A preset is a way to write the numbers after it.
    const bool is_shorthand = app::scene::is_preset_address(info.address);
    if (!is_other_form && !is_shorthand && info.address.find('[') == std::string::npos)
      expected.push_back(info.address);
  }
  EXPECT_EQ(found, expected);
}

TEST(Flat, FlatListMarksTheParametersThatMayChangeDuringARun) {
  for (const char* live :
       {"solver.gravity", "solver.bypass", "material.snow.hardening", "material.a.model",
        "collider.floor", "collider.floor.velocity", "collider.1.shape",
        "collider.1.shape.sphere.center", "camera", "camera.keyframes", "collider.1.keyframes",
        "solver.push_out", "view.close.camera", "view.close.clip", "view.x.slice", "light"})
    EXPECT_TRUE(app::scene::is_live(live)) << live;
  for (const char* restart :
       {"solver", "solver.cell_size", "solver.precision", "material.snow.density", "material.snow",
        "body.ball.velocity", "body.ball.shape", "seed", "fps", "sink.drain", "view.close",
        "nonsense", "solver.cf", "camera.keyframes[0].time.x", ""})
    EXPECT_FALSE(app::scene::is_live(restart)) << restart;
  EXPECT_TRUE(app::scene::concerns_simulation("collider.floor.friction"));
  EXPECT_FALSE(app::scene::concerns_simulation("collider.floor.style"));
  EXPECT_FALSE(app::scene::concerns_simulation("view.close.size"));
  // The same holds for whole tables, and for lists whose names differ.
  for (const char* table : {"solver", "dust", "material.snow", "collider.floor", "body", "seed"})
    EXPECT_TRUE(app::scene::concerns_simulation(table)) << table;
  EXPECT_EQ(app::scene::concern_of("limits"), app::scene::Concern::run);
  EXPECT_EQ(app::scene::concern_of("light"), app::scene::Concern::pictures);
}

std::vector<std::string> addresses(const std::vector<app::scene::Difference>& list) {
  std::vector<std::string> out;
  for (const app::scene::Difference& difference : list) out.push_back(difference.address);
  return out;
}

TEST(Differences, DifferencesAreSplitByTheNeedForARestart) {
  EXPECT_TRUE(app::scene::differences(read(), read()).empty());
  const app::scene::SplitDifferences split = app::scene::split_live(
      read(),
      read({"solver.cfl=0.2", "material.wet.density=300", "seed=5", "collider.1.friction=0.1",
            "body.ball.velocity=[1,0,0]", "view.close.camera.fov=25"}));
  EXPECT_EQ(addresses(split.live), (std::vector<std::string>{"solver.cfl", "collider.1.friction",
                                                             "view.close.camera.fov"}));
  EXPECT_EQ(addresses(split.restart),
            (std::vector<std::string>{"seed", "material.wet.density", "body.ball.velocity"}));
  EXPECT_EQ(app::scene::toml::toml_literal(*split.live[0].before), "0.3");
  EXPECT_EQ(app::scene::toml::toml_literal(*split.live[0].after), "0.2");
}

TEST(Differences, DifferencesOfTablesThatComeGoOrChangeKindAreWhole) {
  const auto found = app::scene::differences(read({"view.close.clip.normal=[1,0,0]"}),
                                             read({"camera.fov=40", "view.close.camera=none",
                                                   "collider.1.shape={sphere={ radius = 0.1 }}"}));
  EXPECT_EQ(addresses(found), (std::vector<std::string>{"collider.1.shape", "camera",
                                                        "view.close.clip", "view.close.camera"}));
  EXPECT_TRUE(std::all_of(found.begin(), found.end(), [](const auto& d) { return d.is_live; }));
  EXPECT_TRUE(found[2].before);
  EXPECT_FALSE(found[2].after);
}

TEST(Differences, DifferencesOfItemsNeedARestart) {
  const std::string more = std::string(flat_scene) +
                           "[[sink]]\nname = \"drain\"\nshape = { sphere = { radius = 0.1 } }\n";
  const app::scene::SplitDifferences split = app::scene::split_live(read(), read({}, more));
  EXPECT_TRUE(split.live.empty());
  EXPECT_EQ(addresses(split.restart), std::vector<std::string>{"sink"});
}

/// The promise of differences(): what it lists, set one by one, makes the other scene.
TEST(Differences, SetOneByOneMakeTheOtherScene) {
  const std::vector<std::string> sets{
      "solver.cfl=0.2",
      "solver.bypass=[\"advection\"]",
      "title=A « b »",
      "camera={ fov = 12, orbit = 90, eye = [1, 1, 1], target = [0, "
      "0, 0] }",
      "view.close.camera=none",
      "view.close.size=[100, 50]",
      "view.close.particles.range=[0, 3]",
      "view.close.slice.point=[0, 1, 0]",
      "collider.1.shape={ box = { size = [1, 2, 3] } }",
      "material.wet.youngs_modulus=1e6"};
  const app::scene::Scene a = read(), b = read(sets);
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
    std::vector<app::scene::Override> overrides;
    for (const app::scene::Difference& difference : app::scene::differences(from, to))
      overrides.push_back(
          {difference.address,
           difference.after ? app::scene::toml::toml_literal(*difference.after) : "none"});
    EXPECT_GE(overrides.size(), sets.size());
    EXPECT_EQ(app::scene::write_scene(
                  app::scene::read_scene_text(app::scene::write_scene(from), "s", "", overrides)),
              app::scene::write_scene(to));
  }
}

TEST(SetNone, SettingNoneRemovesOptionalValuesOnly) {
  EXPECT_FALSE(read({"view.close.camera=none"}).views[0].camera);
  EXPECT_TRUE(read({"view.close.camera.keyframes=none"}).views[0].camera->keyframes.empty());
  EXPECT_FALSE(read({"camera.orbit=90", "camera.orbit=none"}).camera->orbit);
  EXPECT_FALSE(read({"camera=none"}).camera);
  EXPECT_EQ(read({"solver=none"}).solver.cfl, 0.4);
  EXPECT_EQ(read({"title=none"}).title, "");
  EXPECT_EQ(read({"title=\"none\""}).title, "none");
  EXPECT_EQ(read({"burn_in.top_left=A", "burn_in.top_left=none"}).burn_in.top_left, "");
  EXPECT_THROW(read({"solver.cfl=none"}), app::UsageError);
  EXPECT_THROW(read({"body.ball.shape=none"}), std::runtime_error);
  EXPECT_THROW(read({"body=none"}), app::UsageError);
}

}  // namespace
}  // namespace neve::app
