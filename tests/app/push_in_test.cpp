/// An automatic camera that comes nearer to the settled snow.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/scene/override.h"
#include "app/scene/read.h"
#include "app/scene/toml/error.h"
#include "app/setup/camera_path.h"
#include "app/setup/coarse_run.h"
#include "app/setup/resolve.h"

namespace neve::app {
namespace {

using setup::CameraPlace;

constexpr double picture_aspect = 16.0 / 9;
constexpr int film_frames = 48;

/// A ball that falls far, and is small when it lies.
scene::Scene fall_of(const std::string& camera, const std::string& more = "") {
  return scene::read_scene_text("frames = " + std::to_string(film_frames) + R"(
fps = 24
[[body]]
name = "ball"
shape = { sphere = { center = [0, 1.6, 0], radius = 0.15 } }
[[collider]]
shape = { plane = {} }
[camera]
)" + camera + more,
                                "fall.toml");
}

scene::Scene resolved_fall(const std::string& camera, const std::string& more = "") {
  scene::Scene scene = fall_of(camera, more);
  setup::resolve(scene, 1000);
  return scene;
}

CameraPlace camera_of(const scene::Scene& scene, double time) {
  return setup::camera_at(*scene.camera, time, scene::duration(scene));
}

double far(const CameraPlace& place) {
  return (place.eye - place.target).norm();
}

/// Share of points that a camera has in its picture.
double share_seen(const CameraPlace& place, const std::vector<sim::Vec3d>& points) {
  const sim::Vec3d forward = (place.target - place.eye).normalized();
  const sim::Vec3d right = forward.cross(sim::Vec3d(0, 1, 0)).normalized();
  const sim::Vec3d up = right.cross(forward);
  const double slope = std::tan(place.fov * std::numbers::pi / 360);
  const auto seen = std::count_if(points.begin(), points.end(), [&](const sim::Vec3d& x) {
    const sim::Vec3d q = x - place.eye;
    const double half = slope * q.dot(forward);
    return std::abs(q.dot(right)) < half * picture_aspect && std::abs(q.dot(up)) < half;
  });
  return static_cast<double>(seen) / static_cast<double>(points.size());
}

TEST(PushIn, TheSettledSnowGetsThePicture) {
  const scene::Scene still = resolved_fall(""), moving = resolved_fall("push_in = true");
  const double duration = scene::duration(moving);
  EXPECT_TRUE(still.camera->keyframes.empty());
  EXPECT_EQ(camera_of(still, 0).eye, camera_of(moving, 0).eye);
  EXPECT_EQ(camera_of(still, 0).target, camera_of(moving, 0).target);
  EXPECT_LT(far(camera_of(moving, duration)), 0.6 * far(camera_of(still, duration)));
  for (const setup::CoarseMoment& moment : setup::coarse_run(moving))
    EXPECT_GT(share_seen(camera_of(moving, moment.time), moment.x), 0.9) << moment.time;
}

TEST(PushIn, TheMoveIsSlowAndEased) {
  for (const std::string camera : {"push_in = true", "push_in = true\norbit = 40"}) {
    const scene::Scene scene = resolved_fall(camera);
    ASSERT_EQ(scene.camera->keyframes.size(), 2u) << camera;
    std::vector<double> steps;
    for (int frame = 1; frame < film_frames; ++frame)
      steps.push_back(std::log2(far(camera_of(scene, (frame - 1) / scene.fps)) /
                                far(camera_of(scene, frame / scene.fps))));
    EXPECT_NEAR(steps.front(), 0, 1e-12) << "the fall begins at rest";
    EXPECT_NEAR(steps.back(), 0, 1e-12) << "the last pictures are at rest";
    for (std::size_t k = 0; k < steps.size(); ++k) {
      EXPECT_GE(steps[k], -1e-9) << "it never goes back";
      // Half the distance in a second on average is twice that at the fastest.
      EXPECT_LT(steps[k], 2.2 / scene.fps) << k;
      if (k == 0) continue;
      EXPECT_LT(std::abs(steps[k] - steps[k - 1]), 0.4 / scene.fps) << "no jerk, frame " << k;
    }
  }
}

/// A run that continues reads the scene of its record.
TEST(PushIn, TheResolvedSceneHasTheWholeMove) {
  const scene::Scene scene = resolved_fall("push_in = true");
  const std::string text = scene::write_scene(scene);
  scene::Scene again = scene::read_scene_text(text, "again.toml");
  EXPECT_FALSE(setup::needs_framing(again));
  setup::resolve(again, 1000);
  EXPECT_EQ(scene::write_scene(again), text);
  for (const double time : {0.0, 0.7, 1.3, 1.9})
    EXPECT_EQ(camera_of(again, time).eye, camera_of(scene, time).eye) << time;
  // A camera that is told to follow something is moved by it, without keyframes.
  const std::vector<scene::Override> changes = scene::parse_overrides({"camera.follow=ball"});
  scene::Scene following = scene::read_scene_text(text, "again.toml", {}, changes);
  setup::reopen(following, changes);
  setup::resolve(following, 1000);
  EXPECT_TRUE(following.camera->eye && following.camera->keyframes.empty());
}

TEST(PushIn, ItStandsStillInAFilmTooShortForASlowMove) {
  scene::Scene scene = fall_of("push_in = true");
  scene.frames = 4;
  setup::resolve(scene, 1000);
  EXPECT_TRUE(scene.camera->eye);
  EXPECT_TRUE(scene.camera->keyframes.empty());
}

TEST(PushIn, SlicesStandStill) {
  const scene::Scene scene =
      resolved_fall("push_in = true", "\n[[view]]\nname = \"slice\"\n[[view]]\nname = \"snow\"\n");
  ASSERT_TRUE(scene.views[0].camera);
  EXPECT_TRUE(scene.views[0].camera->keyframes.empty());
  EXPECT_EQ(scene.camera->keyframes.size(), 2u);
}

TEST(PushIn, WhatHasAPlaceIsNotMoved) {
  const auto error_of = [](const std::string& camera) -> std::string {
    try {
      fall_of("push_in = true\n" + camera);
    } catch (const scene::toml::SceneError& error) {
      return error.what();
    }
    return "no error";
  };
  for (const auto& [camera, word] :
       {std::pair{"eye = [1, 1, 1]\ntarget = [0, 0, 0]", "eye is given"},
        std::pair{"keyframes = [{ time = 0 }, { time = 1, fov = 20 }]", "keyframes is given"},
        std::pair{"follow = \"ball\"", "follow is given"}}) {
    const std::string error = error_of(camera);
    EXPECT_NE(error.find(word), std::string::npos) << error;
    EXPECT_NE(error.find("fall.toml:9:"), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace neve::app
