/// The layer "smoke": its keys, its built-in view, what it asks of the grid and hands to render.

#include <gtest/gtest.h>

#include <cmath>

#include "app/picture/frame_builder.h"
#include "app/scene/read.h"
#include "app/scene/toml/error.h"
#include "app/setup/auto_ranges.h"
#include "app/setup/resolve.h"
#include "app/setup/seed_scene.h"

namespace neve::app {
namespace {

constexpr const char* powder_ball = R"([camera]
eye = [0, 0.5, 2]
target = [0, 0.5, 0]
[material.powder]
density = 100
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } }
velocity = [0, -2, 0]
)";

app::scene::Scene read_powder(const std::string& more,
                              const std::vector<app::scene::Override>& overrides = {}) {
  return app::scene::read_scene_text(powder_ball + more, "ball.toml", {}, overrides);
}

/// The first view of frame 0.
render::Frame first_frame(app::scene::Scene scene) {
  app::setup::SeededScene seeded = app::setup::seed_scene(scene);
  seeded.spacing = 0.01;
  app::setup::resolve(scene, seeded.particles.x.size());
  const sim::Simulation simulation(scene.solver, scene.materials, app::scene::sim_colliders(scene),
                                   seeded.particles, 1);
  const app::picture::FrameBuilder builder(scene, seeded);
  return builder.build(scene.views.front(),
                       app::picture::take_snapshot(scene, scene.views, simulation, 0));
}

double mass_of(const render::Smoke& smoke) {
  double sum = 0;
  for (const float density : smoke.density) sum += density;
  return sum * std::pow(smoke.nodes->spacing, 3);
}

TEST(SmokeLayer, BuiltInViewTakesItsOwnLayers) {
  const app::scene::View view = app::scene::find_view(read_powder(""), "smoke");
  EXPECT_TRUE(app::scene::has_layer(view, app::scene::Layer::smoke));
  EXPECT_TRUE(app::scene::has_layer(view, app::scene::Layer::ground));
  EXPECT_FALSE(app::scene::has_layer(view, app::scene::Layer::particles));
  EXPECT_EQ(view.smoke.field, app::scene::ScalarField::mass);
  const app::scene::Scene named =
      read_powder("[[view]]\nname = \"smoke\"\nsmoke = { density_scale = 2 }");
  EXPECT_TRUE(app::scene::has_layer(named.views.front(), app::scene::Layer::smoke));
  EXPECT_EQ(named.views.front().smoke.density_scale, 2);
  EXPECT_EQ(read_powder("", {{"view.smoke.smoke.field", "J_P"}}).views.back().smoke.field,
            app::scene::ScalarField::J_P);
}

TEST(SmokeLayer, SmokeLayerHoldsTheMassOfTheSnow) {
  app::scene::Scene scene = read_powder("");
  scene.views = {app::scene::find_view(scene, "smoke")};
  const render::Frame frame = first_frame(scene);
  ASSERT_NE(frame.smoke.nodes, nullptr);
  ASSERT_EQ(frame.smoke.density.size(), 64 * frame.smoke.nodes->block.size());
  EXPECT_TRUE(frame.smoke.value.empty());
  EXPECT_EQ(frame.legends.size(), 1u);
  EXPECT_TRUE(frame.points.position.empty());
  // Particles have the mass of the body between them; feather-light nodes are left out.
  const double mass = 400 * 4.0 / 3 * 3.14159265 * std::pow(0.1, 3);
  EXPECT_NEAR(mass_of(frame.smoke), mass, 1e-3 * mass);
}

TEST(SmokeLayer, PackedIsTheDensestSnowOfABodyNotOfAnUnusedMaterial) {
  app::scene::Scene scene = read_powder("", {{"body.ball.material", "powder"}});
  scene.views = {app::scene::find_view(scene, "smoke")};
  EXPECT_EQ(first_frame(scene).smoke.full_density, 100);
}

TEST(SmokeLayer, AFieldColoursItWithALegendAndAnAutomaticRange) {
  for (const app::scene::ScalarField field :
       {app::scene::ScalarField::speed, app::scene::ScalarField::J_P,
        app::scene::ScalarField::pressure, app::scene::ScalarField::density}) {
    app::scene::Scene scene = read_powder("");
    scene.views = {app::scene::find_view(scene, "smoke")};
    scene.views.front().smoke.field = field;
    const render::Frame frame = first_frame(scene);
    ASSERT_EQ(frame.smoke.value.size(), frame.smoke.density.size());
    const app::scene::Range range = app::setup::automatic_range(scene, field);
    EXPECT_EQ(frame.smoke.range_min, static_cast<float>(range.min));
    EXPECT_EQ(frame.smoke.range_max, static_cast<float>(range.max));
    ASSERT_EQ(frame.legends.size(), 1u);
    EXPECT_EQ(frame.legends[0].max, frame.smoke.range_max);
  }
}

TEST(SmokeLayer, SmokeLayerShowsTheSpeedOfTheBall) {
  app::scene::Scene scene = read_powder("");
  scene.views = {app::scene::find_view(scene, "smoke")};
  scene.views.front().smoke.field = app::scene::ScalarField::speed;
  const render::Smoke smoke = first_frame(scene).smoke;
  for (std::size_t n = 0; n < smoke.density.size(); ++n) {
    if (!(smoke.density[n] > 0)) continue;
    ASSERT_NEAR(smoke.value[n], 2, 1e-4);
  }
}

std::string smoke_error(const std::string& more) {
  try {
    read_powder(more);
  } catch (const app::scene::toml::SceneError& error) {
    return error.what();
  }
  return "no error";
}

TEST(SmokeLayer, MistakesAreLocated) {
  const auto with = [](const std::string& keys) {
    return "[[view]]\nname = \"smoke\"\nsmoke = { " + keys + " }";
  };
  EXPECT_TRUE(smoke_error(with("field = \"fog\"")).starts_with("ball.toml:12:19: error: "))
      << smoke_error(with("field = \"fog\""));
  EXPECT_NE(smoke_error(with("density_scale = -1")).find("expected 0 <= value <= 1000"),
            std::string::npos)
      << smoke_error(with("density_scale = -1"));
  EXPECT_NE(smoke_error(with("densty_scale = 1")).find("did you mean \"density_scale\"?"),
            std::string::npos);
  EXPECT_NE(smoke_error(with("range = [1, 0]")).find("expected min < max"), std::string::npos);
}

}  // namespace
}  // namespace neve::app
