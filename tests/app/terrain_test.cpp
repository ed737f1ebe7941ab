/// Terrain in scenes and frames.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <variant>

#include "app/health/diagnosis.h"
#include "app/health/findings.h"
#include "app/picture/collider_looks.h"
#include "app/picture/snow_volume.h"
#include "app/scene/read.h"
#include "app/setup/plan.h"
#include "sim/shapes/solid.h"
#include "tests/support/height_files.h"
#include "tests/support/meshes.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

class TerrainScene : public testing::Test {
 protected:
  TerrainScene() {
    folder_.write("hills.asc", test::height_grid(9, 7, 0.5, [](double x, double z) {
                    return 0.3 * std::sin(2 * x) + 0.2 * std::cos(3 * z) - 0.2 * x;
                  }));
    folder_.write("grey.png", test::height_png(4, 4, [](int x, int y) { return 900 * (x + y); }));
  }
  scene::Scene read(const std::string& terrain, const std::string& style = "solid") const {
    return scene::read_scene_text(
        "[[collider]]\nname = \"hills\"\nstyle = \"" + style + "\"\nshape = { terrain = { " +
            terrain +
            ", rotation = [0, 30, 0] } }\n[[body]]\nshape = { cover = { on = \"hills\", depth = "
            "0.2, radius = 0.4, center = [2.1, 0.1, 0.2] } }\n",
        "s.toml", folder_.path().string());
  }
  test::TemporaryFolder folder_;
};

TEST_F(TerrainScene, IsWrittenAsItWasRead) {
  for (const char* terrain :
       {"file = \"hills.asc\", center = [0.5, 1, 0]",
        "file = \"grey.png\", spacing = 2, low = -3, high = 8, center = [1, 0, 0]",
        "file = \"hills.asc\", coordinates = \"world\", origin = [0.5, -1, 2]"}) {
    SCOPED_TRACE(terrain);
    const std::string text = scene::write_scene(read(terrain));
    EXPECT_EQ(scene::write_scene(scene::read_scene_text(text, "again.toml")), text);
    EXPECT_NE(text.find("on = \"hills\""), std::string::npos);
  }
}

TEST_F(TerrainScene, AScaleBesideAGridIsIdle) {
  const std::string at = "collider.hills.shape.terrain.";
  EXPECT_NE(health::why_idle(read("file = \"hills.asc\", spacing = 0.3"), at + "spacing"), "");
  const scene::Scene grey = read("file = \"grey.png\", spacing = 2, low = -3, high = 8");
  for (const char* key : {"spacing", "low", "high"})
    EXPECT_EQ(health::why_idle(grey, at + key), "");
}

TEST_F(TerrainScene, ACoverLiesWhereItsTerrainIs) {
  const scene::Scene scene = read("file = \"hills.asc\", center = [0.5, 1, 0]");
  const sim::shapes::Solid cover(scene.bodies[0].shape);
  const sim::Vec3d middle = cover.center() + cover.inner_point();
  const sim::shapes::Surface ground = sim::shapes::surface_at(scene.colliders[0], 0, middle);
  // The middle is half of the depth above the ground, and lifted by the y of its centre.
  EXPECT_NEAR(ground.distance, (0.1 + 0.1) * ground.normal.y(), 1e-12);
}

/// A collider with keyframes starts where the first of them says, and not where its shape is.
TEST_F(TerrainScene, ACoverLiesWhereTheKeyframesOfItsGroundStart) {
  folder_.write("plate.obj", test::box_obj({2, 0.2, 2}));
  const auto read_with = [&](const std::string& ground, const std::string& first) {
    return scene::read_scene_text(
        "[[collider]]\nname = \"plate\"\nshape = { " + ground + " }\nkeyframes = [{ time = 0.5, " +
            first +
            " }, { time = 1, position = [0, 3, 0] }]\n[[body]]\nshape = { cover = { on = "
            "\"plate\", depth = 0.2, radius = 0.4, center = [2, 0, 3] } }\n",
        "s.toml", folder_.path().string());
  };
  for (const char* first : {"position = [2, 1, 3]", "position = [2, 1, 3], rotation = [0, 0, 20]",
                            "position = [2, 1, 3], rotation = [0, 100, 0]"})
    for (const char* ground : {"mesh = { file = \"plate.obj\" }",
                               "terrain = { file = \"hills.asc\", center = [5, 5, 5] }"}) {
      SCOPED_TRACE(std::string(first) + ground);
      std::string place = first;
      if (ground[0] == 't') {
        if (place.find("rotation") != std::string::npos) continue;  // see below
        place.replace(place.find("[2, 1, 3]"), 9, "[1, 1, 1.5]");
      }
      const scene::Scene scene = read_with(ground, place);
      const sim::shapes::Solid cover(scene.bodies[0].shape);
      const sim::Vec3d middle = cover.center() + cover.inner_point();
      const sim::shapes::Surface below = sim::shapes::surface_at(scene.colliders[0], 0, middle);
      EXPECT_NEAR(below.distance, 0.1 * below.normal.y(), 1e-12);
    }
  try {
    read_with("terrain = { file = \"hills.asc\" }", "position = [1, 1, 4], rotation = [0, 0, 20]");
    FAIL() << "it is tilted where the snow lies";
  } catch (const scene::toml::SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("tilted carries no cover"), std::string::npos)
        << error.what();
  }
}

/// Snow on terrain and boxes ended ragged above them, by a spacing of particles.
TEST_F(TerrainScene, SnowKnowsTheWayToWhatItRestsOn) {
  const std::string box = R"([[collider]]
name = "box"
style = "STYLE"
shape = { box = { center = [0, 5, 0], size = [1, THICK, 1] } }
)";
  const auto way = [&](std::string text, const sim::Vec3d& x) {
    text += "[[body]]\nshape = { sphere = { radius = 0.1 } }\n";
    const scene::Scene scene = scene::read_scene_text(text, "s.toml", folder_.path().string());
    render::Points points;
    points.spacing = 0.02f;
    points.position = {
        {static_cast<float>(x.x()), static_cast<float>(x.y()), static_cast<float>(x.z())}};
    picture::find_solids_below(scene, scene.views.front(), 0, points);
    return points.to_solid.empty() ? Vec3f{0, 1e9f, 0} : points.to_solid[0];
  };
  const auto with = [&](const std::string& thick, const std::string& style) {
    std::string text = box;
    text.replace(text.find("THICK"), 5, thick);
    return text.replace(text.find("STYLE"), 5, style);
  };
  EXPECT_NEAR(way(with("1", "solid"), {0.1, 5.53, 0.1}).y, -0.03, 1e-6);
  EXPECT_EQ(way(with("1", "solid"), {0.1, 5.55, 0.1}), Vec3f{}) << "beyond the kernel's reach";
  EXPECT_EQ(way(with("1", "solid"), {0.1, 5.4, 0.1}), Vec3f{}) << "inside";
  EXPECT_EQ(way(with("0.05", "solid"), {0.1, 5.055, 0.1}), Vec3f{})
      << "the mirror image would come out below the plate";
  EXPECT_EQ(way(with("1", "ghost"), {0.1, 5.53, 0.1}).y, 1e9f) << "its inside is seen";
  const std::string hills =
      "[[collider]]\nshape = { terrain = { file = \"hills.asc\", center = [0.5, 1, 0], rotation = "
      "[0, 30, 0] } }\n";
  const scene::Scene scene = read("file = \"hills.asc\", center = [0.5, 1, 0]");
  sim::Vec3d x(0.4, 1, 0.3);
  x.y() -= sim::shapes::surface_at(scene.colliders[0], 0, x).distance - 0.02;
  const sim::shapes::Surface ground = sim::shapes::surface_at(scene.colliders[0], 0, x);
  ASSERT_GT(ground.distance, 0.001);
  ASSERT_LT(ground.distance, 0.04);
  const Vec3f to_ground = way(hills, x);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(to_ground[axis], -ground.distance * ground.normal[axis], 1e-5) << axis;
}

TEST_F(TerrainScene, IsDrawnOnItsSurfaceWithTheNormalsOfContact) {
  const scene::Scene scene = read("file = \"hills.asc\", center = [0.5, 1, 0]");
  render::Frame frame;
  picture::add_colliders(scene, scene.views.front(), 0, 0.1f, frame);
  ASSERT_EQ(frame.meshes.size(), 1u);
  const render::TriangleMesh& mesh = frame.meshes[0];
  std::size_t on_surface = 0;
  for (std::size_t k = 0; k < mesh.position.size(); ++k) {
    const auto vec = [](Vec3f v) {
      return sim::Vec3d(static_cast<double>(v.x), static_cast<double>(v.y),
                        static_cast<double>(v.z));
    };
    if (!(mesh.normal[k].y > 0.1f)) continue;
    ++on_surface;
    const sim::shapes::Surface ground =
        sim::shapes::surface_at(scene.colliders[0], 0, vec(mesh.position[k]));
    EXPECT_NEAR(ground.distance, 0, 2e-6);  // floats of a few metres
    // The middle of each cell, where the normal has no jump.
    if (on_surface % 5 == 0) {
      EXPECT_LT((ground.normal - vec(mesh.normal[k])).norm(), 1e-5);
    }
  }
  EXPECT_EQ(on_surface, 8u * 6 * 5);
}

/// Maps are in metres: large snow on them is no mistake of units, wherever advice is given.
TEST_F(TerrainScene, LargeSnowOnAMapIsNotTakenForCentimetres) {
  scene::Scene scene = read("file = \"hills.asc\"");
  std::get<sim::shapes::Cover>(scene.bodies[0].shape.form).radius = 100;
  sim::seeding::Body ball = scene.bodies[0];
  ball.name = "ball";
  ball.shape = {};
  ball.shape.form = sim::shapes::Sphere{.radius = 30};
  scene.bodies = {ball};
  scene.solver.cell_size = 2;
  scene.limits.particles = 10;
  const auto told = [&] {
    try {
      setup::check_limits(scene, setup::make_plan(scene, {0, 1}, setup::Quality::draft, 1), 1);
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  sim::Divergence divergence;
  divergence.rule = "not_finite";
  EXPECT_NE(told().find("raise it"), std::string::npos) << told();
  EXPECT_NE(health::diagnose(scene, divergence).cause, health::Cause::units);
  scene.colliders.clear();
  EXPECT_NE(told().find("in centimetres it would be 0.6 m"), std::string::npos) << told();
  EXPECT_EQ(health::diagnose(scene, divergence).cause, health::Cause::units);
}

TEST_F(TerrainScene, BelongsToTheGround) {
  scene::Scene scene = read("file = \"hills.asc\"");
  scene.views.front().layers = {scene::Layer::colliders};
  render::Frame frame;
  picture::add_colliders(scene, scene.views.front(), 0, 0.1f, frame);
  EXPECT_TRUE(frame.meshes.empty());
  scene.views.front().layers = {scene::Layer::ground};
  picture::add_colliders(scene, scene.views.front(), 0, 0.1f, frame);
  EXPECT_EQ(frame.meshes.size(), 1u);
  render::Frame wire;
  picture::add_colliders(read("file = \"hills.asc\"", "wire"), scene.views.front(), 0, 0.1f, wire);
  EXPECT_TRUE(wire.meshes.empty());
  EXPECT_EQ(wire.lines.size(), 1u);
}

}  // namespace
}  // namespace neve::app
