/// Values that colours show, against hand-made states.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "app/picture/attributes.h"
#include "app/picture/frame_builder.h"
#include "app/scene/read.h"
#include "sim/health/diagnostics.h"

namespace neve::app {
namespace {

/// One particle of 400 kg/m3 at rest, squeezed to J_E = 0.5 and J_P = 0.8, under a known stress.
app::picture::Snapshot squeezed() {
  app::picture::Snapshot s;
  s.particles.x = {{0, 0.1, 0}};
  s.particles.v = {{3, 0, 4}};
  s.particles.m = {0.4};
  s.particles.V0 = {0.001};
  s.particles.F_E = {sim::Vec3d(0.5, 1, 1).asDiagonal().toDenseMatrix()};
  s.particles.J_P = {0.8};
  s.particles.material = {0};
  // tau = J sigma with sigma = diag(-300, 0, 0) Pa and J = 0.4.
  s.kirchhoff = {sim::Vec3d(-120, 0, 0).asDiagonal().toDenseMatrix()};
  return s;
}

class Attributes : public testing::Test {
 protected:
  double value(app::scene::ColorBy color_by, const app::picture::Snapshot& snapshot) {
    return app::picture::attribute_values(scene, color_by, snapshot).at(0);
  }
  app::scene::Scene scene = app::scene::read_scene_text(
      "[[body]]\nshape = { sphere = { radius = 0.1 } }\n[output]\nsize = [64, 64]\n", "a.toml");
};

TEST_F(Attributes, AttributesAreThoseOfTheCurrentConfiguration) {
  const app::picture::Snapshot s = squeezed();
  EXPECT_DOUBLE_EQ(value(app::scene::ColorBy::speed, s), 5);
  EXPECT_DOUBLE_EQ(value(app::scene::ColorBy::J_E, s), 0.5);
  EXPECT_DOUBLE_EQ(value(app::scene::ColorBy::J_P, s), 0.8);
  EXPECT_DOUBLE_EQ(value(app::scene::ColorBy::density, s), 1000);
  EXPECT_DOUBLE_EQ(value(app::scene::ColorBy::pressure, s), 100);
  EXPECT_DOUBLE_EQ(value(app::scene::ColorBy::von_mises, s), 300);
  EXPECT_DOUBLE_EQ(value(app::scene::ColorBy::id, s), 0);
  EXPECT_TRUE(app::picture::attribute_values(scene, app::scene::ColorBy::snow, s).empty());
}

/// Snow that yields to pressure alone has the same number for p0 and for pressure.
TEST_F(Attributes, PressureOfSnowThatPacksIsItsP0) {
  scene = app::scene::read_scene_text(
      "[[body]]\nshape = { sphere = { radius = 0.1 } }\n[material.snow]\nmodel = \"cam_clay\"\n"
      "youngs_modulus = 2e5\nconsolidation_pressure = 2000\nconsolidation_hardening = 0.2\n",
      "clay.toml");
  const sim::Material& m = scene.materials[0];
  app::picture::Snapshot s = squeezed();
  s.particles.J_P = {0.5};
  const double K = m.youngs_modulus / (3 * (1 - 2 * m.poisson_ratio)),
               top = sim::health::consolidation_pressure(m, 0.5), J_E = std::sqrt(1 - 2 * top / K);
  const sim::Mat3d F = std::cbrt(J_E) * sim::Mat3d::Identity();
  s.particles.F_E = {F};
  s.kirchhoff = {sim::health::first_piola(m, F, 0.5) * F.transpose()};
  const double pressure = value(app::scene::ColorBy::pressure, s);
  EXPECT_NEAR(value(app::scene::ColorBy::yield, s), 1, 1e-9);
  EXPECT_NEAR(value(app::scene::ColorBy::p0, s), pressure, 1e-9 * pressure);
  EXPECT_NEAR(pressure, top / (0.5 * J_E), 1e-9 * pressure);
}

TEST_F(Attributes, DensityIsThatOfTheMaterialBeforeVolumesAreKnown) {
  app::picture::Snapshot s = squeezed();
  s.particles.V0 = {0};
  EXPECT_DOUBLE_EQ(value(app::scene::ColorBy::density, s), 1000);
}

TEST_F(Attributes, AttributesOfABrokenStateStillMakeAPicture) {
  app::picture::Snapshot s = squeezed();
  s.particles.x.push_back(sim::Vec3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  s.particles.x.push_back(sim::Vec3d::Zero());
  s.particles.v.assign(3, sim::Vec3d::Constant(std::numeric_limits<double>::infinity()));
  app::scene::View view;
  view.particles.color_by = app::scene::ColorBy::speed;
  view.particles.range = app::scene::Range{0, 2};
  const app::setup::SeededScene seeded;
  const app::picture::FrameBuilder builder(scene, seeded);
  const render::Frame frame = builder.build(view, s);
  ASSERT_EQ(frame.points.position.size(), 2u);
  EXPECT_EQ(frame.points.id[1], 2u);
  for (const float v : frame.points.value) EXPECT_EQ(v, 2);
  ASSERT_EQ(frame.legends.size(), 1u);
  EXPECT_EQ(frame.legends[0].unit, "m/s");
}

TEST_F(Attributes, CaptionsShowTheCoarsening) {
  const auto last_line = [&](double coarsening) {
    const app::setup::SeededScene seeded;
    const app::picture::FrameBuilder builder(scene, seeded, {.coarsening = coarsening});
    return builder.build(app::scene::View{}, squeezed()).caption.back();
  };
  EXPECT_EQ(last_line(1), "1 particle");
  EXPECT_EQ(last_line(1.5), "1 particle, coarsened 1.5x");
}

}  // namespace
}  // namespace neve::app
