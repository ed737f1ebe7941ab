/// Settings of a view besides attributes: styles of colliders, a cut, no background, mosaics.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "app/picture/collider_looks.h"
#include "app/picture/frame_builder.h"
#include "app/picture/mosaic.h"
#include "app/picture/to_float.h"
#include "app/scene/read.h"
#include "app/scene/toml/error.h"

namespace neve::app {
namespace {

using sim::Vec3d;

const char* const looked_at =
    "[[body]]\nshape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } }\n";

app::scene::Scene scene_with(const std::string& more) {
  return app::scene::read_scene_text(looked_at + more, "s.toml");
}

std::string view_error(const std::string& more) {
  try {
    scene_with(more);
  } catch (const app::scene::toml::SceneError& error) {
    return error.what();
  }
  return "no error";
}

render::Frame build(const app::scene::Scene& scene, const std::vector<Vec3d>& positions,
                    int frame = 0) {
  app::picture::Snapshot snapshot;
  snapshot.frame = frame;
  snapshot.time = frame / scene.fps;
  snapshot.particles.x = positions;
  snapshot.particles.v.assign(positions.size(), Vec3d(0, 0, 0));
  snapshot.particles.m.assign(positions.size(), 1);
  snapshot.particles.F_E.assign(positions.size(), sim::Mat3d::Identity());
  snapshot.particles.J_P.assign(positions.size(), 1);
  snapshot.particles.material.assign(positions.size(), 0);
  app::setup::SeededScene seeded;
  seeded.body_end = {positions.size()};
  return app::picture::FrameBuilder(scene, seeded).build(scene.views.front(), snapshot);
}

TEST(ColliderStyle, ColliderStyleSelectsTheDrawnShapes) {
  const app::scene::Scene scene = scene_with(R"([[collider]]
shape = { sphere = { radius = 0.1 } }
[[collider]]
shape = { sphere = { radius = 0.1 } }
style = "ghost"
[[collider]]
shape = { box = { size = [0.2, 0.2, 0.2] } }
style = "wire"
[[collider]]
shape = { plane = {} }
style = "wire"
[[collider]]
shape = { plane = {} }
style = "ghost"
)");
  render::Frame frame;
  app::picture::add_colliders(scene, scene.views.front(), 0, 0.1f, frame);
  EXPECT_EQ(frame.meshes.size(), 1u);
  EXPECT_EQ(frame.ghosts.size(), 1u);
  ASSERT_EQ(frame.lines.size(), 1u);
  EXPECT_EQ(frame.lines[0].ends.size(), 24u);
  EXPECT_TRUE(frame.grounds.empty());
  ASSERT_EQ(frame.ghost_grounds.size(), 2u);
  EXPECT_EQ(frame.ghost_grounds[0].fill, 0) << "wire: lines only";
  EXPECT_GT(frame.ghost_grounds[1].fill, 0);
}

TEST(ColliderStyle, ColliderStyleKeepsToTheLayersOfTheView) {
  const app::scene::Scene scene = scene_with(
      "[[collider]]\nshape = { sphere = { radius = 0.1 } }\nstyle = \"wire\"\n[[collider]]\nshape "
      "= { plane = {} "
      "}\n"
      "[[view]]\nlayers = [\"ground\"]\n");
  render::Frame frame;
  app::picture::add_colliders(scene, scene.views.front(), 0, 0.1f, frame);
  EXPECT_TRUE(frame.lines.empty());
  EXPECT_EQ(frame.grounds.size(), 1u);
}

TEST(ColliderStyle, ColliderStyleDoesNotAffectTheSimulation) {
  const app::scene::Scene scene = scene_with(
      "[[collider]]\nfriction = 0.3\nshape = { box = { size = [0.2, 0.2, 0.2] } }\nstyle = "
      "\"ghost\"");
  const std::vector<sim::shapes::Collider> colliders = app::scene::sim_colliders(scene);
  ASSERT_EQ(colliders.size(), 1u);
  EXPECT_EQ(colliders[0].friction, 0.3);
  EXPECT_EQ(
      view_error("[[collider]]\nshape = { box = { size = [0.2, 0.2, 0.2] } }\nstyle = \"glass\""),
      "s.toml:5:9: error: collider.1.style = \"glass\"; expected \"solid\", \"wire\", "
      "\"ghost\" or \"holdout\"; did you mean \"ghost\"?");
}

TEST(Clip, ClipRemovesTheParticlesOnItsSide) {
  const app::scene::Scene scene =
      scene_with("[[view]]\nclip = { normal = [0, 0, 5], point = [0, 0, 0.1] }\n");
  const render::Frame frame = build(scene, {{0, 0, 0}, {0, 0, 0.09}, {0, 0, 0.11}, {5, 0, 9}});
  ASSERT_EQ(frame.points.position.size(), 2u);
  EXPECT_EQ(frame.points.id, (std::vector<std::uint32_t>{0, 1})) << "the others keep their looks";
}

TEST(Clip, ASurfaceKnowsTheSnowBeyondItsCut) {
  const app::scene::Scene scene = scene_with(
      "[[view]]\nlayers = [\"snow\"]\nclip = { normal = [0, 0, 5], point = [0, 0, 0.1] }\n");
  const render::Frame frame = build(scene, {{0, 0, 0}, {0, 0, 0.09}, {0, 0, 0.1001}, {5, 0, 9}});
  EXPECT_EQ(frame.points.id, (std::vector<std::uint32_t>{0, 1}));
  ASSERT_TRUE(frame.points.cut.has_value());
  EXPECT_EQ(frame.points.cut->point, (Vec3f{0, 0, 0.1f}));
  EXPECT_EQ(frame.points.cut->normal, (Vec3f{0, 0, 1}));
  EXPECT_EQ(frame.points.cut->id, std::vector<std::uint32_t>{2}) << "9 m away shapes nothing";
  EXPECT_EQ(frame.points.cut->volume.size(), 1u);
  const render::Frame beyond = build(scene, {{0, 0, 0.1001}, {0, 0, 0.11}});
  EXPECT_TRUE(beyond.points.position.empty());
  EXPECT_FALSE(beyond.points.cut.has_value()) << "nothing is left for it to shape";
}

TEST(Turn, IsTheRotationOfSnowAlsoWhereItIsStrained) {
  const sim::Mat3d R = (Eigen::AngleAxisd(2.1, Vec3d(0.3, -0.8, 0.5).normalized())).matrix();
  sim::Mat3d stretch = sim::Mat3d::Identity();
  stretch(0, 0) = 1.02;
  stretch(0, 1) = stretch(1, 0) = 0.01;
  stretch(2, 2) = 0.97;
  const render::Turn turn(app::picture::turn_of(R * stretch));
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3d to = R.col(axis);
    const Vec3f unit{axis == 0 ? 1.0f : 0.0f, axis == 1 ? 1.0f : 0.0f, axis == 2 ? 1.0f : 0.0f};
    const Vec3f forth = turn.forth(unit), back = turn.back(forth);
    // Shear turns the columns by half of what it is; 16 bits are exact to 3e-5.
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(forth[k], to[k], 0.012) << axis << k;
      EXPECT_NEAR(back[k], unit[k], 2e-4) << axis << k;
    }
  }
  EXPECT_EQ(app::picture::turn_of(sim::Mat3d::Identity()), render::no_turn);
  EXPECT_EQ(app::picture::turn_of(sim::Mat3d::Zero()), render::no_turn);
  EXPECT_EQ(app::picture::turn_of(sim::Mat3d::Constant(std::numeric_limits<double>::quiet_NaN())),
            render::no_turn);
}

TEST(Clip, AutomaticallyCutsTheMiddleOfTheSnow) {
  for (const char* point : {"", ", point = \"auto\""}) {
    const app::scene::Scene scene =
        scene_with(std::string("[[view]]\nclip = { normal = [1, 0, 0]") + point + " }\n");
    EXPECT_FALSE(scene.views[0].clip->point.has_value());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const render::Frame frame =
        build(scene, {{7, 0, 0}, {8, 0, 0}, {11, 0, 0}, {nan, 0, 0}});  // the middle is 8.67
    EXPECT_EQ(frame.points.position.size(), 2u);
  }
}

TEST(Clip, ClipNeedsADirection) {
  EXPECT_EQ(view_error("[[view]]\nclip = { normal = [0, 0, 0] }"),
            "s.toml:4:19: error: normal is zero; it must point towards the side to cut away");
  EXPECT_EQ(view_error("[[view]]\nclip = { point = \"middle\" }"),
            "s.toml:4:18: error: view.1.clip.point = \"middle\"; expected three numbers [x, y, z]");
}

TEST(Background, BackgroundOfTheViewOverridesThatOfTheOutput) {
  const app::scene::Scene scene = scene_with(
      "[[view]]\n[[view]]\nbackground = \"gradient\"\n[output]\nbackground = \"transparent\"\n");
  EXPECT_EQ(app::scene::background_of(scene, scene.views[0]), app::scene::Background::transparent);
  EXPECT_EQ(app::scene::background_of(scene, scene.views[1]), app::scene::Background::gradient);
  EXPECT_TRUE(build(scene, {{0, 0, 0}}).is_transparent);
}

TEST(Counter, FramesBelowZeroAreWrittenAsInNamesOfFiles) {
  const app::scene::Scene scene = app::scene::read_scene_text(
      std::string("frames = 209\nfirst_frame = 0\nhandles = 8\n[[view]]\n"
                  "layers = [\"counter\"]\n") +
          looked_at,
      "s.toml");
  EXPECT_EQ(build(scene, {{0, 0, 0}}).caption, std::vector<std::string>{"-008 / 217"});
}

/// A run may become longer than its scene; its earlier pictures know no other end.
TEST(Counter, FramesBeyondTheSceneHaveNoEnd) {
  const app::scene::Scene scene = app::scene::read_scene_text(
      std::string("frames = 20\n[[view]]\nlayers = [\"counter\", \"plots\"]\n") + looked_at,
      "s.toml");
  const auto frame_at = [&](int frame) { return build(scene, {{0, 0, 0}}, frame); };
  EXPECT_EQ(frame_at(20).caption, std::vector<std::string>{"20 / 20"});
  EXPECT_EQ(frame_at(31).caption, std::vector<std::string>{"31"});
  EXPECT_EQ(frame_at(20).plots.at(0).x_end, float(20 / scene.fps));
  EXPECT_EQ(frame_at(31).plots.at(0).x_end, float(31 / scene.fps));
}

const char* const three_views = R"([[view]]
name = "a"
[[view]]
name = "b"
size = [400, 400]
[[view]]
name = "c"
)";

TEST(Mosaic, TilesKeepTheShapeOfTheirViewsAndStandInRows) {
  const app::scene::Scene scene =
      scene_with(std::string(three_views) +
                 "[[mosaic]]\nname = \"all\"\nviews = [\"a\", \"b\", \"c\"]\n"
                 "columns = 2\nwidth = 802\n");
  const app::setup::MosaicLayout layout = app::setup::layout_of(scene, scene.mosaics[0], 2);
  ASSERT_EQ(layout.tiles.size(), 3u);
  EXPECT_EQ(layout.width, 802);
  EXPECT_EQ(layout.tiles[0].view.size->width, 400);
  EXPECT_EQ(layout.tiles[0].view.size->height, 225);  // 16:9
  EXPECT_EQ(layout.tiles[1].view.size->height, 400);
  EXPECT_EQ(layout.tiles[1].x, 402);
  EXPECT_EQ(layout.tiles[0].y, layout.caption_height);
  EXPECT_EQ(layout.tiles[2].x, 0);
  EXPECT_EQ(layout.tiles[2].y, layout.caption_height + 400 + 2) << "below the highest of its row";
  EXPECT_EQ(layout.height, layout.tiles[2].y + 225);
  for (const app::setup::MosaicTile& tile : layout.tiles)
    EXPECT_FALSE(app::scene::has_layer(tile.view, app::scene::Layer::caption))
        << "there is one caption";
}

TEST(Mosaic, MosaicLeavesFewGapsAndComesNearTheShapeOfTheOutput) {
  const auto columns = [](int views, const std::string& size) {
    std::string text, names;
    for (int k = 0; k < views; ++k) {
      const std::string name = "v" + std::to_string(k);
      text += "[[view]]\nname = \"" + name + "\"\nsize = " + size + "\n";
      names += (k > 0 ? ", \"" : "\"") + name + "\"";
    }
    const app::scene::Scene scene =
        scene_with(text + "[[mosaic]]\nname = \"all\"\nviews = [" + names + "]\n");
    const app::setup::MosaicLayout layout = app::setup::layout_of(scene, scene.mosaics[0], 2);
    return std::count_if(
        layout.tiles.begin(), layout.tiles.end(),
        [&](const app::setup::MosaicTile& tile) { return tile.y == layout.tiles[0].y; });
  };
  const int wide[] = {1, 2, 3, 2, 3, 3, 3, 4, 3};
  for (int views = 1; views <= 9; ++views)
    EXPECT_EQ(columns(views, "[1280, 720]"), wide[views - 1]) << views;
  EXPECT_EQ(columns(4, "[720, 1280]"), 4);
}

TEST(Mosaic, MosaicIsAsWideAsTheOutput) {
  const app::scene::Scene scene =
      scene_with(std::string(three_views) + "[[mosaic]]\nviews = [\"c\", \"a\"]\n");
  const app::setup::MosaicLayout layout = app::setup::layout_of(scene, scene.mosaics[0], 2);
  EXPECT_EQ(layout.width, 1280);
  EXPECT_EQ(layout.tiles[0].view.name, "c");
  EXPECT_EQ(layout.tiles[1].y, layout.tiles[0].y);
}

/// A line that comes in the middle of a film, as of an ignored rule, must not change the height.
TEST(Mosaic, ItsHeightIsKnownBeforeTheRun) {
  scene::Scene scene = scene_with("");
  scene.title.clear();
  EXPECT_EQ(setup::caption_lines(scene, false), 1);
  EXPECT_EQ(setup::caption_lines(scene, true), 2);
  scene.title = "fall";
  EXPECT_EQ(setup::caption_lines(scene, false), 2);
  scene.solver.on_divergence = sim::OnDivergence::ignore;
  EXPECT_EQ(setup::caption_lines(scene, false), setup::max_caption_lines);
}

TEST(Mosaic, MosaicMayNameBuiltInViews) {
  const app::scene::Scene scene = scene_with("[[mosaic]]\nviews = [\"particles\", \"slice\"]\n");
  ASSERT_EQ(scene.views.size(), 2u);
  EXPECT_EQ(app::setup::layout_of(scene, scene.mosaics[0], 2).tiles[1].view.name, "slice");
}

TEST(Mosaic, ErrorsAreLocated) {
  const std::string views = three_views;  // from line 3 to line 9
  EXPECT_EQ(view_error(views + "[[mosaic]]\nviews = [\"a\", \"bb\"]"),
            "s.toml:11:9: error: there is no view \"bb\"; did you mean \"b\"?");
  EXPECT_EQ(view_error(views + "[[mosaic]]\nname = \"a\"\nviews = [\"b\"]"),
            "s.toml:11:8: error: a view is called \"a\" too; both would write into the folder of "
            "that name; rename the mosaic");
  EXPECT_EQ(view_error(views + "[[mosaic]]\nname = \"m\""),
            "s.toml:10:1: error: a mosaic of 0 views; name 1 to 64 of \"a\", \"b\" or \"c\"");
  EXPECT_EQ(view_error(views + "[[mosaic]]\nviews = [1]"),
            "s.toml:11:10: error: mosaic.1.views[0] = 1; expected a string");
}

}  // namespace
}  // namespace neve::app
