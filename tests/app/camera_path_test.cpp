/// Cameras that move: keyframes, orbit, turntable, alone and around the automatic framing.

#include "app/setup/camera_path.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "app/scene/read.h"
#include "app/scene/toml/error.h"
#include "app/setup/resolve.h"
#include "app/support/errors.h"

namespace neve::app {
namespace {

using sim::Vec3d;

// Places are sums and products of a few numbers near 1: rounding stays far below this.
constexpr double rounding = 1e-12;

const char* const path_ball =
    "[[body]]\nshape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } }\n";

app::scene::Scene scene_with_camera(const std::string& camera, const std::string& more = "") {
  return app::scene::read_scene_text(
      "frames = 24\nfps = 24\n" + std::string(path_ball) + "[camera]\n" + camera + more, "s.toml");
}

app::setup::CameraPlace place(const app::scene::Scene& scene, double time) {
  return app::setup::camera_at(*scene.camera, time, scene::duration(scene));
}

std::string camera_error(const std::string& camera) {
  try {
    scene_with_camera(camera);
  } catch (const app::scene::toml::SceneError& error) {
    return error.what();
  }
  return "no error";
}

double distance(const Vec3d& a, const Vec3d& b) {
  return (a - b).norm();
}

TEST(CameraPath, CameraPathPassesThroughItsKeyframes) {
  const app::scene::Scene scene = scene_with_camera(R"(eye = [9, 9, 9]
target = [0, 0, 0]
keyframes = [
  { time = 0.25, eye = [1, 0, 0], fov = 20 },
  { time = 0.5, eye = [0, 1, 2], target = [0, 0, 1] },
  { time = 1, eye = [4, 1, 0], fov = 60 },
])");
  EXPECT_EQ(place(scene, 0.25).eye, Vec3d(1, 0, 0));
  EXPECT_EQ(place(scene, 0.25).fov, 20);
  EXPECT_EQ(place(scene, 0.5).eye, Vec3d(0, 1, 2));
  EXPECT_EQ(place(scene, 0.5).target, Vec3d(0, 0, 1));
  EXPECT_EQ(place(scene, 0.5).fov, 30) << "what a keyframe leaves out is the camera's own";
  EXPECT_EQ(place(scene, 1).eye, Vec3d(4, 1, 0));
  EXPECT_EQ(place(scene, 0).eye, Vec3d(1, 0, 0)) << "it does not move before the first";
  EXPECT_EQ(place(scene, 7).eye, Vec3d(4, 1, 0)) << "and after the last";
}

TEST(CameraPath, CameraPathIsSmoothAndAtRestAtItsEnds) {
  const app::scene::Scene scene = scene_with_camera(R"(keyframes = [
  { time = 0, eye = [1, 0, 0], target = [0, 0, 0] }, { time = 0.3, eye = [2, 0, 3], target = [0, 0, 0] },
  { time = 1, eye = [6, 1, 4], target = [0, 0, 0] } ])");
  const double d = 1e-4;
  const auto velocity = [&](double t) -> Vec3d {
    return (place(scene, t + d).eye - place(scene, t - d).eye) / (2 * d);
  };
  EXPECT_LT(velocity(0).norm(), 0.05);
  EXPECT_LT(velocity(1).norm(), 0.05);
  double largest_jump = 0;
  for (double t = 0.01; t < 1; t += 0.001)
    largest_jump = std::max(largest_jump, distance(velocity(t + 0.001), velocity(t)));
  // Accelerations here stay below 6 * 5 m / (0.3 s)^2 = 330 m/s2; a kink would jump by about 10
  // m/s.
  EXPECT_LT(largest_jump, 0.4);
  EXPECT_GT(velocity(0.3).norm(), 1) << "it does not stop on the way";
}

TEST(CameraPath, PathNeverOvershootsKeyframesAndRestsBetweenEqualOnes) {
  const app::scene::Scene scene = scene_with_camera(R"(keyframes = [
  { time = 0, eye = [0, 0, 9], target = [0, 0, 0], fov = 1 },
  { time = 0.2, eye = [5, 0, 9], target = [0, 0, 0], fov = 80 },
  { time = 0.6, eye = [5, 0, 9], target = [0, 0, 0], fov = 80 },
  { time = 1, eye = [-1, 0, 9], target = [0, 0, 0], fov = 1 } ])");
  for (double t = 0; t < 1; t += 0.01) {
    EXPECT_LE(place(scene, t).eye.x(), 5 + rounding) << t;
    EXPECT_GE(place(scene, t).fov, 1 - rounding) << t;
  }
  for (double t = 0.2; t <= 0.6; t += 0.01) {
    EXPECT_LT(distance(place(scene, t).eye, {5, 0, 9}), rounding) << t;
  }
}

TEST(CameraPath, OneKeyframeIsAStillCamera) {
  const app::scene::Scene scene =
      scene_with_camera("keyframes = [{ time = 0.5, eye = [1, 2, 3], target = [0, 0, 0] }]");
  for (const double t : {0.0, 0.5, 1.0}) EXPECT_EQ(place(scene, t).eye, Vec3d(1, 2, 3));
}

TEST(CameraPath, OrbitTurnsAboutUpFromRestToRest) {
  const app::scene::Scene scene =
      scene_with_camera("eye = [2, 1, 0]\ntarget = [0, 0.5, 0]\norbit = 90");
  EXPECT_EQ(place(scene, 0).eye, Vec3d(2, 1, 0));
  EXPECT_LT(distance(place(scene, 1).eye, {0, 1, -2}), rounding);
  EXPECT_LT(distance(place(scene, 0.5).eye, {std::sqrt(2), 1, -std::sqrt(2)}), rounding);
  for (const double t : {0.1, 0.37, 0.9})
    EXPECT_NEAR(distance(place(scene, t).eye, {0, 1, 0}), 2, rounding);
  EXPECT_LT(app::setup::turned(*scene.camera, 0.01, 1), 0.01) << "starts at rest";
}

TEST(CameraPath, TurntableTurnsEvenlyOnceInItsTime) {
  const app::scene::Scene scene =
      scene_with_camera("eye = [2, 1, 0]\ntarget = [0, 0, 0]\nturntable = 4");
  EXPECT_LT(distance(place(scene, 1).eye, {0, 1, -2}), rounding);
  EXPECT_LT(distance(place(scene, 4).eye, {2, 1, 0}), rounding);
  EXPECT_DOUBLE_EQ(app::setup::turned(*scene.camera, 3, 1), 270);
}

TEST(CameraPath, OrbitTurnsTheKeyframedCamera) {
  const app::scene::Scene scene = scene_with_camera(
      "orbit = 180\neye = [1, 0, 0]\ntarget = [0, 0, 0]\n"
      "keyframes = [{ time = 0 }, { time = 1, eye = [3, 0, 0] }]");
  EXPECT_LT(distance(place(scene, 1).eye, {-3, 0, 0}), rounding);
}

/// Returns the larger of the coordinates of a point in the picture, 1 at its border.
double reach_in_picture(const app::setup::CameraPlace& camera, double aspect, const Vec3d& point) {
  const Vec3d forward = (camera.target - camera.eye).normalized();
  const Vec3d right = forward.cross(Vec3d(0, 1, 0)).normalized(), up = right.cross(forward);
  const Vec3d q = point - camera.eye;
  const double half = std::tan(camera.fov * std::numbers::pi / 360) * q.dot(forward);
  return std::max(std::abs(q.dot(right)) / (half * aspect), std::abs(q.dot(up)) / half);
}

/// A bar thrown along x: the picture is much wider seen from the side than from its end.
const char* const thrown = R"(
frames = 24
[solver]
gravity = [0, 0, 0]
[[body]]
shape = { box = { center = [-1, 0.5, 0.2], size = [0.6, 0.2, 0.2] } }
velocity = [1.5, 0, 0]
)";

TEST(CameraPath, OrbitAroundTheAutomaticTargetKeepsTheSnowInThePicture) {
  for (const char* camera : {"orbit = 90", "orbit = -200", "turntable = 0.7"}) {
    app::scene::Scene scene =
        app::scene::read_scene_text(std::string(thrown) + "[camera]\n" + camera, "s.toml");
    app::setup::resolve(scene, 1000);
    double largest = 0;
    for (double t = 0; t <= 1; t += 0.05)
      for (const double x : {-1.3, -0.7, 0.2, 0.8})
        largest = std::max(largest, reach_in_picture(place(scene, t), 16.0 / 9, {x, 0.5, 0.2}));
    EXPECT_LT(largest, 1) << camera;
    EXPECT_GT(largest, 0.4) << camera << ": too far away";
  }
}

TEST(CameraPath, OrbitNeverPassesThroughASlope) {
  app::scene::Scene scene = app::scene::read_scene_text(R"(
frames = 12
[[body]]
shape = { box = { center = [0, 0.2, 0], size = [0.2, 0.2, 0.2] } }
[[collider]]
shape = { plane = { normal = [0.5, 0.866, 0] } }
[camera]
orbit = 360
)",
                                                        "s.toml");
  app::setup::resolve(scene, 1000);
  for (double t = 0; t <= 0.5; t += 0.02)
    EXPECT_GT(place(scene, t).eye.dot(Vec3d(0.5, 0.866, 0)), 0) << t;
}

TEST(CameraPath, KeyframesWithPlacesNeedNoFraming) {
  app::scene::Scene scene =
      scene_with_camera("keyframes = [{ time = 0, eye = [1, 1, 1], target = [0, 0, 0] }]");
  app::setup::resolve(scene, 1000);
  EXPECT_FALSE(scene.camera->eye.has_value());
  app::scene::Scene zoom = scene_with_camera("keyframes = [{ time = 0 }, { time = 1, fov = 10 }]");
  app::setup::resolve(zoom, 1000);
  ASSERT_TRUE(zoom.camera->eye.has_value());
  EXPECT_EQ(place(zoom, 1).eye, *zoom.camera->eye);
}

TEST(CameraErrors, CameraErrorsHaveAPlaceAndAHint) {
  EXPECT_EQ(camera_error("keyframes = [{ time = 1 }, { time = 0.5 }]"),
            "s.toml:6:37: error: keyframe 2 is at 0.5 s, the one before at 1 s; times must "
            "increase from one keyframe to the next");
  EXPECT_EQ(camera_error("orbit = 90\nturntable = 2"),
            "s.toml:7:13: error: orbit and turntable both turn the eye; give one: orbit = degrees "
            "over the whole scene, turntable = seconds per turn");
  EXPECT_EQ(camera_error("keyframes = [{ tiem = 1 }]"),
            "s.toml:6:16: error: unknown key \"tiem\" in [camera.keyframes[1]]; did you mean "
            "\"time\"?");
  EXPECT_EQ(
      camera_error("keyframes = 3"),
      "s.toml:6:13: error: camera.keyframes = 3; expected a list of tables; write keyframes = "
      "[{ ... }, { ... }]");
  EXPECT_EQ(camera_error("turntable = 0"),
            "s.toml:6:13: error: camera.turntable = 0; expected 0.001 <= value <= 1000000");
  EXPECT_EQ(camera_error("keyframes = [{ eye = [1, 1, 1], target = [1, 1, 1] }]"),
            "s.toml:6:42: error: eye and target are the same point; move one of them");
}

TEST(CameraErrors, KeyframesAreSetTogether) {
  const auto scene_set = [](const std::string& change) {
    return app::scene::read_scene_text(path_ball, "s.toml", {},
                                       {app::scene::parse_override(change)});
  };
  EXPECT_EQ(scene_set("camera.orbit=45").camera->orbit, 45);
  EXPECT_EQ(scene_set("camera.keyframes=[{time = 1}, {time = 2}]").camera->keyframes.size(), 2u);
  EXPECT_THROW(scene_set("camera.keyframes[N].time=1"), app::UsageError);
  EXPECT_THROW(scene_set("camera.keyframes[0].time=1"), app::UsageError);
}

}  // namespace
}  // namespace neve::app
