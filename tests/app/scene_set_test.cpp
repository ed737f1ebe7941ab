// --set ADDRESS=VALUE.
#include <gtest/gtest.h>

#include "app/scene/read.h"
#include "app/scene/toml/toml_source.h"
#include "app/support/errors.h"
#include "app/support/film_rate.h"

namespace neve::app {
namespace {

constexpr const char* scene_text = R"(
frames = 10
[material.wet]
density = 500
[[body]]
name = "ball"
shape = { sphere = { radius = 0.1 } }
[[body]]
shape = { box = { size = [0.2, 0.2, 0.2] } }
[[collider]]
name = "floor"
shape = { plane = {} }
[[view]]
name = "close"
camera = { fov = 20 }
)";

app::scene::Scene set(const std::vector<std::string>& arguments, const char* text = scene_text) {
  std::vector<app::scene::Override> overrides;
  for (const std::string& argument : arguments)
    overrides.push_back(app::scene::parse_override(argument));
  return app::scene::read_scene_text(text, "s.toml", "", overrides);
}

std::string override_error(const std::string& argument, const char* scene = scene_text) {
  try {
    set({argument}, scene);
  } catch (const app::UsageError& error) {
    return error.what();
  }
  return "no usage error";
}

TEST(Set, SettingReachesEveryKindOfAddress) {
  EXPECT_EQ(set({"solver.cell_size=0.05"}).solver.cell_size, 0.05);
  EXPECT_EQ(set({"material.snow.hardening=5"}).materials[0].hardening, 5);
  EXPECT_EQ(set({"material.wet.hardening=5"}).materials[1].hardening, 5);
  EXPECT_EQ(set({"body.ball.velocity=[0,-5,0]"}).bodies[0].velocity.y(), -5);
  EXPECT_EQ(set({"body.2.velocity=[0, -5, 0]"}).bodies[1].velocity.y(), -5);
  EXPECT_EQ(set({"collider.floor.friction=0.1"}).colliders[0].friction, 0.1);
  EXPECT_EQ(set({"view.close.size=[64, 48]"}).views[0].size->width, 64);
  EXPECT_EQ(set({"view.close.camera.fov=33"}).views[0].camera->fov, 33);
  EXPECT_EQ(set({"camera.fov=33"}).camera->fov, 33);
  EXPECT_EQ(set({"output.size=[64,48]"}).size.height, 48);
  EXPECT_EQ(set({"frames=3"}).frames, 3);
  const app::scene::Scene scene = set({"body.ball.shape.sphere.radius=0.3"});
  EXPECT_EQ(std::get<sim::shapes::Sphere>(scene.bodies[0].shape.form).radius, 0.3);
}

TEST(Set, SettingReachesTheBuiltInView) {
  const char* text = "[[body]]\nshape = { box = { size = [0.2, 0.2, 0.2] } }";
  EXPECT_EQ(set({"view.particles.particles.color_by=id"}, text).views.back().particles.color_by,
            app::scene::ColorBy::id);
}

TEST(Set, SettingTakesTheLastOfTwo) {
  EXPECT_EQ(set({"frames=3", "frames=4"}).frames, 4);
}

TEST(Set, SettingTakesWholeTables) {
  const app::scene::Scene scene = set(
      {"body.ball.shape={ box = { size = [1, 1, 1] } }", "camera={eye=[0,0,2],target=[0,0,0]}"});
  EXPECT_TRUE(std::holds_alternative<sim::shapes::Box>(scene.bodies[0].shape.form));
  EXPECT_EQ(scene.camera->eye->z(), 2);
}

TEST(Set, ATableSetsAllThatIsInIt) {
  EXPECT_EQ(scene::addresses_of(scene::parse_overrides(
                {"fps=12", "solver={ cfl = 0.3, period = [0, 0, 0] }",
                 "material.snow={ variation = { size = 0.1 } }", "camera=none"})),
            (std::vector<std::string>{"fps", "solver", "solver.cfl", "solver.period",
                                      "material.snow", "material.snow.variation",
                                      "material.snow.variation.size", "camera"}));
}

TEST(Set, SettingReadsBareWordsAsStrings) {
  EXPECT_EQ(set({"solver.kernel=quadratic"}).solver.kernel, sim::Kernel::quadratic);
  EXPECT_EQ(set({"title=Boule de névé # 2"}).title, "Boule de névé # 2");
  EXPECT_EQ(set({"title=\"quoted\""}).title, "quoted");
  EXPECT_EQ(set({"title=2024"}).title, "2024");
  EXPECT_EQ(set({"title="}).title, "");
  EXPECT_EQ(set({"title=a=b"}).title, "a=b");
  EXPECT_EQ(set({"limits.memory=8GiB"}).limits.memory, 8ull << 30);
  EXPECT_EQ(set({"limits.memory=1G"}).limits.memory, 1ull << 30) << "as Slurm and Docker write it";
  EXPECT_EQ(set({"view.close.particles.range=auto"}).views[0].particles.range.has_value(), false);
}

TEST(Set, ErrorsShowTheArgument) {
  EXPECT_EQ(override_error("material.snow.poisson_ratio=0.62"),
            "--set material.snow.poisson_ratio=0.62: error: expected 0 <= value < 0.5");
  EXPECT_EQ(override_error("body.ball.velocity=[0, -5]"),
            "--set body.ball.velocity=[0, -5]: error: expected three numbers [x, y, z]");
  EXPECT_EQ(override_error("body.ball.velocity=[0, -5"),
            "--set body.ball.velocity=[0, -5: error: cannot parse array: encountered end-of-file");
  EXPECT_EQ(override_error("body.ball.material=ice"),
            "--set body.ball.material=ice: error: there is no material \"ice\"; expected \"snow\" "
            "or \"wet\"");
  EXPECT_EQ(override_error("solver.kernel=cubik"),
            "--set solver.kernel=cubik: error: expected \"cubic\" or \"quadratic\"; did you mean "
            "\"cubic\"?");
  EXPECT_EQ(override_error("camera={fow=3}"),
            "--set camera={fow=3}: error: unknown key \"fow\" in [camera]; did you mean \"fov\"?");
  EXPECT_EQ(override_error("frames=3\nseed=4"),
            "--set frames=3\nseed=4: error: a value is one line of UTF-8 without control bytes");
}

TEST(Set, UnknownAddressesNameTheNearest) {
  EXPECT_EQ(override_error("material.snow.hardenin=5"),
            "--set material.snow.hardenin=5: error: unknown parameter "
            "\"material.snow.hardenin\"; did you mean \"material.snow.hardening\"?");
  EXPECT_EQ(override_error("hardening=5"),
            "--set hardening=5: error: unknown parameter \"hardening\"; did you mean "
            "\"material.snow.hardening\"?");
  // The suggestion for a misspelt name may be of another table.
  EXPECT_EQ(
      override_error("body.ball.densty=300"),
      "--set body.ball.densty=300: error: unknown parameter \"body.ball.densty\"; did you mean "
      "\"material.snow.density\"?");
  EXPECT_EQ(override_error("body.bull.velocity=[0,0,0]"),
            "--set body.bull.velocity=[0,0,0]: error: there is no body \"bull\"; did you mean "
            "\"ball\"?");
  EXPECT_EQ(override_error("view.fog.size=[1,1]"),
            "--set view.fog.size=[1,1]: error: there is no view \"fog\"; expected \"close\"");
  std::string many = scene_text;
  for (int k = 1; k <= 100; ++k) many += "[material.kind" + std::to_string(k) + "]\n";
  const std::string text = override_error("material.gravel.density=300", many.c_str());
  EXPECT_NE(text.find("there is no material \"gravel\"; expected \"snow\", \"wet\", \"kind1\""),
            std::string::npos);
  EXPECT_TRUE(text.ends_with("\"kind18\" or one of 82 more")) << text;
  EXPECT_EQ(override_error("body.velocity=[0,0,0]"),
            "--set body.velocity=[0,0,0]: error: body.velocity does not say which body; write "
            "body.NAME.velocity, NAME being \"ball\" or \"2\"");
  EXPECT_EQ(
      override_error("body=3"),
      "--set body=3: error: body is not a parameter; it is a table: set one of its parameters, "
      "as in body.ball.name=...");
}

TEST(Set, SettingNeedsAnAddressAndAValue) {
  EXPECT_THROW(app::scene::parse_override("frames"), app::UsageError);
  EXPECT_THROW(app::scene::parse_override("=3"), app::UsageError);
  EXPECT_THROW(app::scene::parse_override(""), app::UsageError);
}

TEST(Set, HostileTextIsAUsageError) {
  for (const std::string value : {"[\\", "{{{{{{{{", "\"\\", "'", "\"\"\"", "[[[[[[[[", "{a={a={a=",
                                  "\xFF", "é", "[é]", "{é=1}", "nan", "-inf", "1e999", "\x1b"}) {
    for (const std::string address : {"frames", "solver.gravity", "camera", "body.ball.shape",
                                      "view.close.layers", "solver.kernel"}) {
      EXPECT_THROW(set({address + "=" + value}), app::UsageError) << address << "=" << value;
    }
  }
}

TEST(Set, MistakesOfTheFileStayWithTheFile) {
  EXPECT_THROW(set({"solver.dt=1e-4"}, "solver = 3"), app::scene::toml::SceneError);
  EXPECT_THROW(set({"camera.fov=3"}, "camera = [1]"), app::scene::toml::SceneError);
  EXPECT_THROW(set({"material.snow.density=3"}, "material = {snow = 4}"),
               app::scene::toml::SceneError);
}

TEST(FindView, ViewLookupKnowsTheBuiltInOne) {
  const app::scene::Scene scene = set({});
  EXPECT_EQ(app::scene::find_view(scene, "close").camera->fov, 20);
  EXPECT_EQ(app::scene::find_view(scene, "particles").name, "particles");
  EXPECT_THROW(app::scene::find_view(scene, "clos"), app::UsageError);
}

TEST(ValueAt, ValueLookupFindsTheValueOfAnAddress) {
  const app::scene::toml::Table root = app::scene::toml::parse_toml(
      "fps = 24\n[solver]\ncfl = 0.4\n[material.snow]\nhardening = 5\n[[body]]\nname = \"ball\"\n"
      "velocity = [0, 1, 2]\n[[body]]\nshape = { sphere = { radius = 0.1 } }\n",
      "s.toml");
  const auto text = [&](const char* address) {
    const app::scene::toml::Value* value = app::scene::value_at(root, address);
    return value ? app::scene::toml::toml_literal(*value) : "";
  };
  EXPECT_EQ(text("fps"), "24");
  EXPECT_EQ(text("solver.cfl"), "0.4");
  EXPECT_EQ(text("material.snow.hardening"), "5");
  EXPECT_EQ(text("body.ball.velocity"), "[0, 1, 2]");
  EXPECT_EQ(text("body.2.shape.sphere.radius"), "0.1");
  for (const char* nothing : {"", "frames", "solver.cfl.x", "body.bull.velocity", "body.3.name",
                              "material.ice.hardening", "fps.fps"})
    EXPECT_EQ(text(nothing), "") << nothing;
}

TEST(FilmRates, RatesOfTelevisionAreExact) {
  const auto fps = [](const std::string& text) {
    return scene::read_scene_text(
               "fps = " + text + "\n[[body]]\nshape = { sphere = { radius = 0.1 } }\n", "s.toml",
               ".")
        .fps;
  };
  EXPECT_EQ(fps("23.976"), 24000.0 / 1001);
  EXPECT_EQ(fps("23.98"), 24000.0 / 1001);
  EXPECT_EQ(fps("29.97"), 30000.0 / 1001);
  EXPECT_EQ(fps("59.94"), 60000.0 / 1001);
  EXPECT_EQ(fps("23.9"), 23.9);
  EXPECT_EQ(fps("25"), 25);
  EXPECT_EQ(rate_text(24000.0 / 1001), "24000/1001");
  EXPECT_EQ(rate_text(12.5), "12.5");
  EXPECT_EQ(plain_rate(24000.0 / 1001), "23.976");
  EXPECT_EQ(plain_rate(30000.0 / 1001), "29.97");
  EXPECT_EQ(plain_rate(120), "120");
  EXPECT_EQ(plain_rate(1e-4), "1e-04");
}

}  // namespace
}  // namespace neve::app
