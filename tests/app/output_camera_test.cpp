/// Automatic framing and ranges: everything in the picture, round numbers, the scene alone decides.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "app/picture/frame_builder.h"
#include "app/scene/read.h"
#include "app/scene/toml/error.h"
#include "app/setup/auto_ranges.h"
#include "app/setup/coarse_run.h"
#include "app/setup/resolve.h"
#include "app/setup/seed_scene.h"
#include "tests/support/meshes.h"

namespace neve::app {
namespace {

const char* const drop = R"(
frames = 12
[[body]]
shape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } }
[[collider]]
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
)";

/// Returns the larger of the coordinates of a point in the picture, 1 at its border.
double reach(const app::scene::CameraSettings& camera, double aspect, const sim::Vec3d& point) {
  const sim::Vec3d forward = (*camera.target - *camera.eye).normalized();
  const sim::Vec3d right = forward.cross(camera.up).normalized();
  const sim::Vec3d up = right.cross(forward);
  const sim::Vec3d q = point - *camera.eye;
  const double half = std::tan(camera.fov * std::numbers::pi / 360) * q.dot(forward);
  return std::max(std::abs(q.dot(right)) / (half * aspect), std::abs(q.dot(up)) / half);
}

TEST(AutomaticCamera, AutomaticCameraShowsTheStartAndTheLandingOfTheSnow) {
  app::scene::Scene scene = app::scene::read_scene_text(drop, "drop.toml");
  app::setup::resolve(scene, 1000);
  ASSERT_TRUE(scene.camera && scene.camera->eye);
  EXPECT_GT(scene.camera->eye->y(), 0) << "the eye is below the floor";
  double largest = 0;
  for (const double y : {0.0, 0.4, 0.6})
    largest = std::max(largest, reach(*scene.camera, 16.0 / 9, {0, y, 0}));
  EXPECT_LT(largest, 0.9);
  EXPECT_GT(largest, 0.4);
}

/// An eye among the snow went further in with the next step towards it: eye and target ended in one
/// place, far away, and the pictures of such a run could not be drawn again.
TEST(AutomaticCamera, AWideLensStaysOutsideTheSnow) {
  for (const char* fov : {"130", "150", "160", "170"})
    for (const char* orbit : {"", "orbit = 160\n"}) {
      SCOPED_TRACE(std::string(fov) + orbit);
      app::scene::Scene scene = app::scene::read_scene_text(
          std::string(drop) + "[camera]\nfov = " + fov + "\n" + orbit, "drop.toml");
      app::setup::resolve(scene, 1000);
      ASSERT_TRUE(scene.camera && scene.camera->eye);
      const sim::Vec3d way = *scene.camera->target - *scene.camera->eye;
      EXPECT_GT(way.norm(), 0.2);
      for (const double y : {0.0, 0.3, 0.6}) {
        EXPECT_GT(way.dot(sim::Vec3d(0, y, 0) - *scene.camera->eye), 0) << "it is before the eye";
        EXPECT_LT(reach(*scene.camera, 16.0 / 9, {0, y, 0}), 1);
      }
    }
}

/// Width of what may be seen of a plane through the target.
double width_seen(const app::scene::CameraSettings& camera, double aspect) {
  return 2 * aspect * std::tan(camera.fov * std::numbers::pi / 360) *
         (*camera.target - *camera.eye).norm();
}

/// A ball that misses the pile and flies on for 30 m does not make the pile small.
TEST(AutomaticCamera, AFlyingBallDoesNotMakeTheSubjectSmall) {
  const std::string pile =
      "frames = 48\n[[body]]\nname = \"pile\"\nshape = { cone = { center = [0, 0.3, 0], radius = "
      "0.5, "
      "height = 0.6 } }\n[[collider]]\nshape = { plane = {} }\n";
  const std::string ball =
      "[[body]]\nname = \"ball\"\nshape = { sphere = { center = [-0.8, 0.9, 0], radius = 0.12 } }\n"
      "velocity = [15, 4, 0]\n";
  app::scene::Scene alone = app::scene::read_scene_text(pile, "pile.toml");
  app::scene::Scene with_ball = app::scene::read_scene_text(pile + ball, "ball.toml");
  app::setup::resolve(alone, 1000);
  app::setup::resolve(with_ball, 1000);
  const double aspect = 16.0 / 9;
  EXPECT_LT(width_seen(*with_ball.camera, aspect), 3 * width_seen(*alone.camera, aspect));
  EXPECT_LT(reach(*with_ball.camera, aspect, {-0.8, 0.9, 0}), 1) << "the start of the ball";
  EXPECT_LT(reach(*with_ball.camera, aspect, {0.4, 0, 0}), 1);
}

TEST(AutomaticCamera, ACameraThatFollowsABodyFramesIt) {
  app::scene::Scene scene = app::scene::read_scene_text(
      "[camera]\nfollow = \"ball\"\n[[body]]\nname = \"ball\"\nshape = { sphere = { center = [5, "
      "3, "
      "0], radius = 0.1 } }\n[[body]]\nname = \"wall\"\nshape = { box = { center = [0, 1, 0], size "
      "= "
      "[1, 2, 4] } }\n",
      "follow.toml");
  app::setup::resolve(scene, 1000);
  // The target is relative to the middle of the ball.
  EXPECT_LT(scene.camera->target->norm(), 0.1);
  EXPECT_LT(width_seen(*scene.camera, 16.0 / 9), 1.5);
  const app::setup::SeededScene seeded = app::setup::seed_scene(scene);
  app::picture::Snapshot snapshot;
  snapshot.particles = seeded.particles;
  for (sim::Vec3d& x : snapshot.particles.x) x += sim::Vec3d(0, 10, 0);
  const app::setup::CameraPlace place =
      app::picture::camera_place(scene, scene.views[0], seeded, snapshot);
  EXPECT_LT((place.target - sim::Vec3d(5, 13, 0)).norm(), 0.1);
  EXPECT_THROW(app::scene::read_scene_text(
                   "[camera]\nfollow = \"egg\"\n[[body]]\nshape = { box = { size = [1, 1, 1] } }\n",
                   "follow.toml"),
               app::scene::toml::SceneError);
}

TEST(AutomaticCamera, ACameraThatFollowsAMeshFramesItWhereverTheOriginOfItsFileIs) {
  const test::TemporaryFolder folder;
  const auto moved = [](double) { return sim::Vec3d(5, 0.2, 0); };
  folder.write("boot.obj", test::plate_obj({0.4, 0.4, 0.4}, 1, moved));
  const std::string mesh =
      "shape = { mesh = { file = \"" + (folder / "boot.obj").string() + "\" } }\n";
  for (const char* kind : {"body", "collider"}) {
    SCOPED_TRACE(kind);
    scene::Scene scene = scene::read_scene_text(
        std::string("[camera]\nfollow = \"boot\"\n[[") + kind + "]]\nname = \"boot\"\n" + mesh +
            "[[body]]\nshape = { sphere = { center = [5, 1, 0], radius = 0.1 } }\n"
            "[[view]]\nname = \"cut\"\nlayers = [\"heatmap\"]\nslice = { follow = \"boot\" }\n"
            "[[view]]\nname = \"all\"\n",
        "boot.toml");
    const setup::SeededScene seeded = setup::seed_scene(scene);
    setup::resolve(scene, seeded.particles.x.size());
    picture::Snapshot snapshot;
    snapshot.particles = seeded.particles;
    const setup::CameraPlace place = picture::camera_place(scene, scene.views[1], seeded, snapshot);
    const sim::Vec3d middle(5, 0.2, 0);
    EXPECT_LT((place.target - middle).norm(), 0.1);
    EXPECT_LT((picture::plane_of(scene, scene.views[0], seeded, snapshot).point - middle).norm(),
              0.01);
    // Target and slice stay once a sink has taken the body.
    if (std::string(kind) == "collider") continue;
    snapshot.particles = {};
    EXPECT_EQ(picture::camera_place(scene, scene.views[1], seeded, snapshot).target, place.target);
  }
}

/// The coarse run of one frame ends long before the snow is on the floor.
TEST(AutomaticCamera, ASliceShowsTheFloorBelow) {
  app::scene::Scene scene = app::scene::read_scene_text(
      "frames = 1\n[[body]]\nshape = { sphere = { center = [0, 0.6, 0], radius = 0.16 } }\n"
      "[[collider]]\nshape = { box = { center = [0, 0.3, 0], size = [0.2, 0.2, 0.2] } }\n"
      "[[collider]]\nshape = { plane = { normal = [0, 0, 1], rotation = [-90, 0, 0] } }\n"
      "[[view]]\nname = \"slice\"\n[[view]]\nname = \"particles\"\n",
      "post.toml");
  app::setup::resolve(scene, 1000);
  ASSERT_TRUE(scene.views[0].camera && scene.views[0].camera->eye);
  EXPECT_LT(reach(*scene.views[0].camera, 16.0 / 9, {0, 0, 0}), 0.95);
  EXPECT_LT(reach(*scene.views[0].camera, 16.0 / 9, {0, 0.76, 0}), 0.95);
}

TEST(AutomaticCamera, FramesUprightPicturesByThemselves) {
  const std::string upright = "[[view]]\nname = \"tall\"\nsize = [200, 600]\n";
  app::scene::Scene scene = app::scene::read_scene_text(
      std::string(drop) + "[[view]]\nname = \"wide\"\n" + upright, "d.toml");
  app::scene::Scene alone = app::scene::read_scene_text(drop, "d.toml");
  app::setup::resolve(scene, 1000);
  app::setup::resolve(alone, 1000);
  EXPECT_EQ(*scene.camera->eye, *alone.camera->eye);
  EXPECT_FALSE(scene.views[0].camera);
  ASSERT_TRUE(scene.views[1].camera);
  const app::scene::CameraSettings& tall = *scene.views[1].camera;
  for (const double x : {-0.1, 0.1}) EXPECT_LT(reach(tall, 1.0 / 3, {x, 0.5, 0}), 0.95);
  EXPECT_LT(width_seen(tall, 1.0 / 3), width_seen(*scene.camera, 16.0 / 9));
}

TEST(AutomaticCamera, AutomaticCameraIsTheSameEveryTime) {
  app::scene::Scene a = app::scene::read_scene_text(drop, "drop.toml"), b = a;
  app::setup::resolve(a, 1000);
  app::setup::resolve(b, 1000);
  EXPECT_EQ(app::scene::write_scene(a), app::scene::write_scene(b));
}

TEST(AutomaticCamera, AutomaticCameraLeavesAGivenPlaceAlone) {
  app::scene::Scene scene = app::scene::read_scene_text(
      std::string(drop) + "[camera]\neye = [3, 1, 0]\ntarget = [0, 0, 0]\n", "drop.toml");
  app::setup::resolve(scene, 1000);
  EXPECT_EQ(*scene.camera->eye, sim::Vec3d(3, 1, 0));
}

TEST(AutomaticCamera, AutomaticCameraStaysOnTheOpenSideOfASlope) {
  app::scene::Scene scene = app::scene::read_scene_text(R"(
frames = 12
[[body]]
shape = { box = { center = [0, 0.2, 0], size = [0.2, 0.2, 0.2], rotation = [0, 0, -30] } }
[[collider]]
shape = { plane = { point = [0, 0, 0], normal = [0.5, 0.866, 0] } }
)",
                                                        "slope.toml");
  app::setup::resolve(scene, 1000);
  EXPECT_GT(scene.camera->eye->dot(sim::Vec3d(0.5, 0.866, 0)), 0);
}

TEST(AutomaticCamera, AutomaticCameraStaysAboveGroundThatKeyframesTilt) {
  app::scene::Scene scene = app::scene::read_scene_text(R"(
frames = 12
[[body]]
shape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } }
[[collider]]
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
keyframes = [{ time = 0 }, { time = 0.2, rotation = [0, 0, 40] }]
)",
                                                        "tilt.toml");
  app::setup::resolve(scene, 1000);
  for (const double time : {0.0, 0.1, 0.2, 0.5}) {
    const sim::Vec3d normal =
        sim::shapes::pose_at(scene.colliders[0], time).rotation * sim::Vec3d(0, 1, 0);
    EXPECT_GT(scene.camera->eye->dot(normal), 0) << time;
  }
}

/// A scene that was resolved says what neve found, so that changes of it reach as far as changes of
/// the scene that was written.
TEST(Reopened, ChangesOfAResolvedSceneGiveWhatTheyGiveTheSceneItself) {
  const std::string text = std::string(drop) + R"(
name = "floor"
[[body]]
name = "other"
shape = { sphere = { center = [1.5, 0.5, 0], radius = 0.1 } }
[[view]]
name = "wide"
layers = ["particles"]
particles = { color_by = "pressure" }
[[view]]
name = "square"
size = [300, 300]
layers = ["particles", "smoke"]
smoke = { field = "density" }
[[view]]
name = "plane"
layers = ["arrows", "heatmap"]
[[view]]
name = "lens"
camera = { fov = 50 }
layers = ["particles"]
)";
  const auto resolved = [](const std::string& from, const std::vector<std::string>& flags) {
    const std::vector<scene::Override> changes = scene::parse_overrides(flags);
    scene::Scene scene = scene::read_scene_text(from, "drop.toml", {}, changes);
    setup::reopen(scene, changes);
    setup::resolve(scene, 1000);
    return scene::write_scene(scene);
  };
  const std::string plain = resolved(text, {});
  const std::vector<std::vector<std::string>> all = {
      {},
      {"camera.fov=60"},
      {"camera.follow=other"},
      {"camera.orbit=90"},
      {"view.wide.particles.color_by=speed"},
      {"view.wide.particles.color_by=speed", "view.wide.particles.range=[0, 7]"},
      {"view.square.smoke.field=speed", "view.square.size=[200, 400]"},
      {"view.wide.size=[200, 400]"},
      {"output.size=[400, 400]"},
      {"view.plane.slice.scalar=pressure", "view.plane.slice.field=force"},
      {"view.plane.slice.normal=[1, 0, 0]"},
      {"view.plane.slice.follow=other"},
      {"view.lens.camera.fov=20"},
      {"camera.eye=[0, 1, 3]", "camera.target=[0, 0, 0]"},
      {"view.square.camera.eye=[0, 1, 3]", "view.square.camera.target=[0, 0, 0]"},
  };
  for (const std::vector<std::string>& flags : all)
    EXPECT_EQ(resolved(plain, flags), resolved(text, flags))
        << (flags.empty() ? "no change" : flags[0]);
}

TEST(DryRun, DryRunCoversTheWholeScene) {
  const app::scene::Scene scene = app::scene::read_scene_text(drop, "drop.toml");
  const std::vector<app::setup::CoarseMoment> moments = app::setup::coarse_run(scene);
  ASSERT_GT(moments.size(), 2u);
  EXPECT_DOUBLE_EQ(moments.back().time, 0.5);
  EXPECT_LT(moments.front().x.size(), 2000u);
}

/// A film of six frames with three more on both sides is as long as one of twelve.
TEST(DryRun, HandlesArePartOfTheScene) {
  std::string text = drop;
  text.replace(text.find("frames = 12"), 11, "frames = 6\nhandles = 3");
  app::scene::Scene whole = app::scene::read_scene_text(drop, "drop.toml"),
                    handled = app::scene::read_scene_text(text, "drop.toml");
  EXPECT_DOUBLE_EQ(app::setup::coarse_run(handled).back().time, 0.5);
  app::setup::resolve(whole, 1000);
  app::setup::resolve(handled, 1000);
  EXPECT_EQ(*handled.camera->eye, *whole.camera->eye);
}

TEST(AutomaticRange, AutomaticRangeOfSpeedReachesTheImpact) {
  const app::scene::Scene scene = app::scene::read_scene_text(drop, "drop.toml");
  // The ball falls from rest through half a metre: sqrt(2 g 0.5) = 3.13 m/s, rounded up.
  EXPECT_EQ(app::setup::automatic_range(scene, app::scene::ColorBy::speed, 10).max, 4);
  EXPECT_EQ(app::setup::automatic_range(scene, app::scene::ColorBy::speed, 10).min, 0);
}

TEST(AutomaticRange, AutomaticRangeHoldsTheNeutralValue) {
  const app::scene::Scene scene = app::scene::read_scene_text(drop, "drop.toml");
  const auto holds = [&](app::scene::ColorBy color_by, double value) {
    const app::scene::Range range = app::setup::automatic_range(scene, color_by, 10);
    return range.min < value && value < range.max;
  };
  EXPECT_TRUE(holds(app::scene::ColorBy::J_E, 1));
  EXPECT_TRUE(holds(app::scene::ColorBy::J_P, 1));
  EXPECT_TRUE(holds(app::scene::ColorBy::density, 400));
  EXPECT_TRUE(holds(app::scene::ColorBy::pressure, 0));
  EXPECT_EQ(app::setup::automatic_range(scene, app::scene::ColorBy::id, 10).max, 9);
}

/// The speeds of a ball that falls on a floor grow with the root of gravity.
TEST(AutomaticRange, AutomaticRangesKnowTheGravityOfACurve) {
  const auto scene_with = [](const std::string& more) {
    return app::scene::read_scene_text(drop + more, "drop.toml");
  };
  const auto curve = [](const std::string& keyframes) {
    return "[[curve]]\nparameter = \"solver.gravity\"\nkeyframes = [" + keyframes + "]\n";
  };
  const double usual = app::setup::impact_speed(scene_with(""));
  const auto impact = [&](const std::string& keyframes) {
    return app::setup::impact_speed(scene_with(curve(keyframes)));
  };
  const std::string weak = "{ time = 0, vector = [0, -0.0981, 0] }";
  EXPECT_NEAR(impact(weak + ", { time = 0.2, vector = [0, -981, 0] }"), 10 * usual, 1e-9);
  EXPECT_LT(impact(weak), 0.5 * usual);
  // A keyframe after the end, at 0.5 s, acts as far as the scene goes towards it.
  EXPECT_LT(impact(weak + ", { time = 100, vector = [0, -981, 0] }"), usual);
  scene::PlotRanges still, strong;
  app::setup::resolve_plot_ranges(scene_with(""), still);
  app::setup::resolve_plot_ranges(scene_with(curve("{ time = 0, vector = [0, -98.1, 0] }")),
                                  strong);
  EXPECT_GT(strong.energy->max, 5 * still.energy->max);
}

/// A value beside a curve is not used, so a scene whose curve stays at another value has the ranges
/// of a scene with that value.
TEST(AutomaticRange, AutomaticRangesKnowCurvesOfMaterialsAndColliders) {
  const auto scene_with = [](const std::string& velocity, const std::string& pressure,
                             const std::string& more) {
    return app::scene::read_scene_text(
        std::string(drop) + "[material.snow]\nmodel = \"cam_clay\"\nconsolidation_pressure = " +
            pressure + "\n[[collider]]\nname = \"ram\"\nvelocity = " + velocity +
            "\nshape = { box = { center = [-3, 0.5, 0], size = [0.5, 0.5, 0.5] } }\n" + more,
        "ram.toml");
  };
  const std::string curves =
      "[[curve]]\nparameter = \"material.snow.consolidation_pressure\"\n"
      "keyframes = [{ time = 0, value = 5000 }, { time = 0.25, value = 20000 }]\n"
      "[[curve]]\nparameter = \"collider.ram.velocity\"\n"
      "keyframes = [{ time = 0, vector = [1, 0, 0] }, { time = 0.25, vector = [9, 0, 0] }]\n";
  const scene::Scene plain = scene_with("[9, 0, 0]", "2e4", ""),
                     curved = scene_with("[0, 0, 0]", "1000", curves);
  using C = scene::ColorBy;
  for (const C color_by : {C::speed, C::density, C::J_E, C::pressure, C::von_mises, C::p0}) {
    const scene::Range expected = app::setup::automatic_range(plain, color_by, 10),
                       range = app::setup::automatic_range(curved, color_by, 10);
    EXPECT_EQ(range.min, expected.min) << int(color_by);
    EXPECT_EQ(range.max, expected.max) << int(color_by);
  }
  EXPECT_GE(app::setup::automatic_range(curved, C::speed, 10).max, 9);
  EXPECT_EQ(app::setup::automatic_range(curved, C::p0, 10).max, 40000);
  EXPECT_EQ(app::setup::collider_speed(curved, "ram"), 9);
}

TEST(AutomaticRange, MaterialsWithoutSnowDoNotCount) {
  const auto scene_of = [](const std::string& name) {
    return app::scene::read_scene_text(
        "[material." + name + "]\nmodel = \"cam_clay\"\ndensity = 200\n[[body]]\nmaterial = \"" +
            name + "\"\nshape = { sphere = { center = [0, 1, 0], radius = 0.2 } }\n",
        "clay.toml");
  };
  // A scene has a material called snow, whether or not anything is of it.
  const scene::Scene snow = scene_of("snow"), clay = scene_of("clay");
  ASSERT_GT(clay.materials.size(), snow.materials.size());
  using C = scene::ColorBy;
  for (const C color_by : {C::density, C::J_E, C::pressure, C::von_mises, C::p0})
    EXPECT_EQ(app::setup::automatic_range(clay, color_by, 10).max,
              app::setup::automatic_range(snow, color_by, 10).max)
        << int(color_by);
  scene::PlotRanges of_snow, of_clay;
  app::setup::resolve_plot_ranges(snow, of_snow);
  app::setup::resolve_plot_ranges(clay, of_clay);
  EXPECT_EQ(of_clay.dt->max, of_snow.dt->max);
}

/// Rubber that falls as fast as snow beside it is hit harder where its sound is slower.
TEST(AutomaticRange, TheHardestImpactIsInTheSnowOfTheSlowestSound) {
  const auto scene = app::scene::read_scene_text(
      "[material.stiff]\nyoungs_modulus = 1e6\n[material.soft]\nyoungs_modulus = 1e4\n"
      "[[body]]\nname = \"a\"\nmaterial = \"stiff\"\nvelocity = [0, -1.5, 0]\n"
      "shape = { sphere = { center = [0, 1, 0], radius = 0.2 } }\n"
      "[[body]]\nname = \"b\"\nmaterial = \"soft\"\nvelocity = [0, -1, 0]\n"
      "shape = { sphere = { center = [3, 1, 0], radius = 0.2 } }\n"
      "[[collider]]\nshape = { plane = {} }\n",
      "two.toml");
  const app::setup::Impact impact = app::setup::hardest_impact(scene);
  EXPECT_EQ(impact.address, "body.b");
  EXPECT_LT(impact.speed, app::setup::impact_speed(scene));
  EXPECT_NEAR(impact.share_of_sound, 0.1, 1e-12);  // sound goes with the root of the modulus
}

/// Snow that a curve stiffens was taken for as soft at the start as the stiffest is to it at the
/// end.
TEST(AutomaticRange, TheSoundOfAnImpactIsAShareOfThatAtTheStart) {
  const auto share = [](double first, double last) {
    const auto scene = app::scene::read_scene_text(
        "frames = 6\n[[body]]\nname = \"a\"\nvelocity = [0, -1, 0]\n"
        "shape = { sphere = { center = [0, 1, 0], radius = 0.2 } }\n"
        "[[collider]]\nshape = { plane = {} }\n"
        "[[curve]]\nname = \"e\"\nparameter = \"material.snow.youngs_modulus\"\n"
        "keyframes = [{ time = 0, value = " +
            std::to_string(first) + " }, { time = 0.2, value = " + std::to_string(last) + " }]\n",
        "curve.toml");
    return app::setup::hardest_impact(scene).share_of_sound;
  };
  EXPECT_NEAR(share(1e5, 1e9), 1, 1e-12);
  EXPECT_NEAR(share(1e6, 1e4), 0.1, 1e-12);
}

TEST(AutomaticRange, WideFlatSnowSlumpsByItsHeight) {
  const app::scene::Scene scene = app::scene::read_scene_text(R"(
[[body]]
shape = { box = { center = [0, 0.1, 0], size = [8, 0.2, 6] } }
[[collider]]
shape = { plane = {} }
)",
                                                              "slab.toml");
  EXPECT_NEAR(app::setup::impact_speed(scene), std::sqrt(2 * 9.81 * 0.1), 1e-9);
}

/// It was taken at the corner of the box around the snow, also of a ball.
TEST(AutomaticRange, ASpinIsAsFastAsItsOutermostSnow) {
  const auto speed = [](const std::string& shape) {
    return app::setup::impact_speed(app::scene::read_scene_text(
        "solver = { gravity = [0, 0, 0] }\n[[body]]\nangular_velocity = [0, 10, 0]\nshape = { " +
            shape + " }\n",
        "spin.toml"));
  };
  EXPECT_NEAR(speed("sphere = { center = [0, 1, 0], radius = 0.3 }"), 3, 1e-9);
  EXPECT_NEAR(speed("box = { center = [0, 1, 0], size = [0.6, 5, 0.8] }"), 5, 1e-9);
}

}  // namespace
}  // namespace neve::app
