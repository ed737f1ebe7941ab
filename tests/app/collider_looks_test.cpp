/// Colliders of every form as what is drawn.

#include "app/picture/collider_looks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/picture/frame_builder.h"
#include "app/picture/shutter.h"
#include "app/scene/read.h"
#include "app/setup/seed_scene.h"
#include "render/shapes/mesh_shapes.h"
#include "sim/shapes/held_files.h"
#include "tests/support/meshes.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

const std::vector<std::string> drawn_forms{
    "sphere = { radius = 0.3 }",
    "box = { size = [0.3, 0.5, 0.2], rotation = [20, 30, 40] }",
    "capsule = { a = [0, 0, 0], b = [0.3, 0.4, 0.1], radius = 0.1, rotation = [20, 30, 40] }",
    "cylinder = { center = [1, 2, 3], radius = 0.2, height = 0.6, rotation = [20, 30, 40] }",
    "cone = { center = [1, 2, 3], radius = 0.4, height = 0.6, rotation = [20, 30, 40] }",
    "torus = { center = [1, 2, 3], major_radius = 0.5, minor_radius = 0.2, rotation = [20, 30, 40] "
    "}",
    "mesh = { file = \"box.obj\", scale = 0.5, center = [1, 2, 3], rotation = [20, 30, 40] }",
    "mesh_sequence = { files = \"box_%d.obj\", first = 0, last = 2, rate = 3, center = [1, 2, 3], "
    "rotation = [20, 30, 40] }"};

class ColliderLooks : public testing::Test {
 protected:
  ColliderLooks() {
    folder_.write("box.obj", test::box_obj({1, 2, 1.5}));
    for (int k = 0; k < 3; ++k)
      folder_.write("box_" + std::to_string(k) + ".obj", test::box_obj({0.5, 1 - 0.2 * k, 0.75}));
  }

  app::scene::Scene scene_with(const std::string& form, const std::string& style) const {
    return app::scene::read_scene_text(
        "[[body]]\nshape = { sphere = { radius = 0.1 } }\n[[collider]]\nshape = { " + form +
            " }\nstyle = \"" + style +
            "\"\nkeyframes = [{ time = 0 }, { time = 1, position = [0.5, 0.2, 0.1], rotation = "
            "[30, 0, 60] }]\n",
        "s.toml", folder_.path().string());
  }

  static render::Frame drawn(const app::scene::Scene& scene, double time) {
    render::Frame frame;
    app::picture::add_colliders(scene, scene.views.front(), time, 0.1f, frame);
    return frame;
  }

  test::TemporaryFolder folder_;
};

sim::Vec3d place_of(Vec3f v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

TEST_F(ColliderLooks, SurfacesAreWhereContactIsAtEveryTime) {
  for (const std::string& form : drawn_forms) {
    SCOPED_TRACE(form);
    const app::scene::Scene scene = scene_with(form, "solid");
    for (const double time : {0.0, 0.4, 2.0}) {
      const render::Frame frame = drawn(scene, time);
      ASSERT_EQ(frame.meshes.size(), 1u);
      EXPECT_TRUE(frame.lines.empty() && frame.ghosts.empty());
      const render::TriangleMesh& mesh = frame.meshes[0];
      ASSERT_EQ(mesh.position.size(), mesh.normal.size());
      for (std::size_t k = 0; k < mesh.position.size(); ++k) {
        // Corners of the drawn mesh lie on the surface; floats of a few metres.
        const sim::Vec3d x = place_of(mesh.position[k]), n = place_of(mesh.normal[k]);
        EXPECT_NEAR(sim::shapes::signed_distance(scene.colliders[0], time, x), 0, 2e-6);
        EXPECT_NEAR(n.norm(), 1, 1e-5);
        // Normals point outward: a little along one is outside, but on edges just not inside.
        EXPECT_GT(sim::shapes::signed_distance(scene.colliders[0], time, x + 1e-3 * n), 5e-4);
      }
      // The middles of triangles too, but for the sagitta of 96 segments around.
      for (std::size_t t = 0; t + 2 < mesh.index.size(); t += 3) {
        sim::Vec3d middle = sim::Vec3d::Zero();
        for (std::size_t c = 0; c < 3; ++c)
          middle += place_of(mesh.position[mesh.index[t + c]]) / 3;
        EXPECT_NEAR(sim::shapes::signed_distance(scene.colliders[0], time, middle), 0, 2e-3);
      }
    }
  }
}

TEST_F(ColliderLooks, AMeshIsDrawnAsTheRunHasReadIt) {
  const sim::shapes::HeldFiles files;
  const auto scene = scene_with("mesh = { file = \"box.obj\" }", "solid");
  const auto before = drawn(scene, 0).meshes[0].position;
  // These are more meshes than are kept of those that are not held.
  for (int k = 0; k < 12; ++k)
    drawn(scene_with("mesh = { file = \"box.obj\", scale = 0." + std::to_string(k + 2) + " }",
                     "solid"),
          0);
  folder_.write("box.obj", test::box_obj({3, 2, 1.5}));
  const auto after = drawn(scene, 0).meshes[0].position;
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t k = 0; k < after.size(); ++k) EXPECT_EQ(after[k].x, before[k].x);
  EXPECT_THROW(drawn(scene_with("mesh = { file = \"box.obj\", scale = 0.95 }", "solid"), 0),
               std::exception)
      << "what is not at hand is not read from another file";
}

TEST_F(ColliderLooks, WiresAndGhostsAreTheSameSurfaces) {
  for (const std::string& form : drawn_forms) {
    SCOPED_TRACE(form);
    const app::scene::Scene wire = scene_with(form, "wire"), ghost = scene_with(form, "ghost");
    const render::Frame lines = drawn(wire, 0.4), see_through = drawn(ghost, 0.4);
    EXPECT_TRUE(lines.meshes.empty() && lines.ghosts.empty());
    ASSERT_EQ(lines.lines.size(), 1u);
    EXPECT_GE(lines.lines[0].ends.size(), 24u);  // a box has 12 edges
    for (const Vec3f& end : lines.lines[0].ends)
      EXPECT_NEAR(sim::shapes::signed_distance(wire.colliders[0], 0.4, place_of(end)), 0, 2e-6);
    EXPECT_TRUE(see_through.meshes.empty());
    ASSERT_EQ(see_through.ghosts.size(), 1u);
    EXPECT_EQ(see_through.ghosts[0].position.size(),
              drawn(scene_with(form, "solid"), 0.4).meshes[0].position.size());
  }
}

/// A box without its lid: twelve edges, of which four have one face.
/// Its pose rests, and so does the snow.
TEST_F(ColliderLooks, AMeshThatDeformsIsBlurredByThat) {
  const scene::Scene scene = scene::read_scene_text(
      "[camera]\neye = [0, 0.5, 3]\ntarget = [0, 0, 0]\n"
      "[[body]]\nshape = { sphere = { center = [1, 0, 0], radius = 0.1 } }\n"
      "[[collider]]\nshape = { mesh_sequence = { files = \"box_%d.obj\", first = 0, last = 2, rate "
      "= "
      "3 } }\n",
      "s.toml", folder_.path().string());
  const setup::SeededScene seeded = setup::seed_scene(scene);
  const sim::Simulation simulation = setup::make_simulation(scene, seeded.particles, 1);
  picture::Snapshot snapshot = picture::take_snapshot(scene, scene.views, simulation, 0);
  snapshot.time = 0.2;
  const render::Frame frame = picture::FrameBuilder(scene, seeded).build(scene.views[0], snapshot);
  const render::Moments moments =
      picture::shutter_moments({scene, scene.views[0], seeded, snapshot}, frame, 180);
  ASSERT_GT(moments.count, 1);
  EXPECT_NE(moments.at(0).meshes.at(0), moments.at(moments.count - 1).meshes.at(0));
  EXPECT_EQ(moments.at(0).points.position, frame.points.position) << "the snow rests";
}

TEST(MeshLines, RimsOfHolesAreLines) {
  const std::vector<Vec3f> corners{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1},
                                   {0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}};
  const std::vector<std::uint32_t> index{0, 1, 2, 0, 2, 3, 0, 4, 5, 0, 5, 1, 1, 5, 6,
                                         1, 6, 2, 2, 6, 7, 2, 7, 3, 3, 7, 4, 3, 4, 0};
  EXPECT_EQ(render::shapes::mesh_lines(corners, index).ends.size(), 2u * 12);
}

}  // namespace
}  // namespace neve::app
