/// Colliders that move by themselves, as records, plots, cameras, findings and changes have them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/compare/series.h"
#include "app/health/findings.h"
#include "app/picture/frame_builder.h"
#include "app/picture/motion.h"
#include "app/picture/plots.h"
#include "app/record/run_json.h"
#include "app/scene/flat.h"
#include "app/scene/read.h"
#include "app/setup/auto_ranges.h"
#include "app/setup/coarse_run.h"
#include "app/setup/resolve.h"
#include "app/setup/seed_scene.h"
#include "app/timeline/changes.h"
#include "app/timeline/timeline.h"

namespace neve::app {
namespace {

using sim::Vec3d;

const std::string floor_and_snow = R"(
frames = 12
[solver]
cell_size = 0.04
[[body]]
name = "bed"
shape = { box = { center = [0, 0.08, 0], size = [0.4, 0.16, 0.4] } }
[[collider]]
name = "floor"
shape = { plane = {} }
)";

scene::Scene scene_with_body(const std::string& more) {
  return scene::read_scene_text(floor_and_snow + more, "s.toml");
}

std::string ball_that(const std::string& more, const std::string& center = "[0, 0.4, 0]") {
  return "[[collider]]\nname = \"ball\"\nshape = { sphere = { center = " + center +
         ", radius = 0.1 } }\n" + more + "\n";
}

/// A body as far as records know it.
record::BodyRecord body_at(const char* name, const Vec3d& centre, const Vec3d& velocity) {
  return {name, centre, {10, 20, 30}, centre, velocity, {1, 2, 3}};
}

TEST(Bodies, RecordsComeBackAsTheyWereWritten) {
  record::FrameRecord frame;
  frame.bodies = {body_at("ball", {1, 2, 3}, {0.1, 0.2, 0.3}),
                  body_at("can", {4, 5, 6}, {0, 0, 0})};
  const Json json = record::to_json(frame);
  ASSERT_EQ(json["bodies"].size(), 2u);
  EXPECT_EQ(json["bodies"][0]["collider"], "ball");
  EXPECT_EQ(json["bodies"][0]["rotation"], Json({10.0, 20.0, 30.0}));
  Json whole = json;  // as a run has it
  whole["spread"] = whole["height"] = whole["mean_J_P"] = whole["largest_fragment"] = 0.5;
  const record::FrameRecord back = record::frame_record(whole);
  EXPECT_EQ(record::to_json(back)["bodies"], json["bodies"]);
}

/// Place and rotation of a record are those of a keyframe: a collider with them is there.
TEST(Bodies, ARecordIsAKeyframe) {
  const scene::Scene scene = scene_with_body(
      "[[collider]]\nname = \"brick\"\nshape = { box = { center = [0.3, 0.5, 0.1], size = [0.2, "
      "0.1, "
      "0.3], rotation = [20, -30, 40] } }\ndensity = 800\nvelocity = [1, 2, 0]\n"
      "angular_velocity = [4, -9, 7]\n");
  sim::Simulation simulation = setup::make_simulation(scene, setup::seed_scene(scene).particles, 1);
  simulation.advance_to(0.15);
  const sim::shapes::Collider brick = simulation.colliders()[1];
  const auto bodies = record::bodies_of(simulation.colliders(), simulation.time());
  ASSERT_EQ(bodies.size(), 1u);
  sim::shapes::Collider keyed;
  keyed.shape = brick.shape;
  keyed.keyframes = {{0, bodies[0].position, bodies[0].rotation},
                     {1, bodies[0].position, bodies[0].rotation}};
  const sim::shapes::Pose wanted = sim::shapes::pose_at(brick, simulation.time()),
                          got = sim::shapes::pose_at(keyed, 0.5);
  EXPECT_LE((wanted.point - got.point).norm(), 1e-12);
  EXPECT_LE((wanted.rotation - got.rotation).norm(), 1e-12);
  EXPECT_LE((bodies[0].velocity - wanted.velocity).norm(), 1e-12)
      << "a box has its mass in its middle";
  EXPECT_GT((bodies[0].rotation - Vec3d(20, -30, 40)).norm(), 20) << "it has turned";
}

TEST(Bodies, DegreesComeBackFromARotation) {
  for (const Vec3d& degrees : {Vec3d(10, 20, 30), Vec3d(-170, 80, 100), Vec3d(0, 90, 35),
                               Vec3d(0, -90, -120), Vec3d(179, -1, -179)}) {
    const sim::Mat3d rotation = sim::rotation_from_degrees(degrees);
    const Vec3d back = sim::degrees_from_rotation(rotation);
    EXPECT_LE((sim::rotation_from_degrees(back) - rotation).norm(), 1e-7) << degrees.transpose();
    const double tolerance = std::abs(degrees.y()) < 89 ? 1e-9 : 1e3;
    EXPECT_LE((back - degrees).norm(), tolerance) << degrees.transpose();
  }
}

TEST(Bodies, MetricsAreOfTheOneThatMovedMost) {
  const std::vector<record::BodyRecord> before{body_at("a", {0, 1, 0}, {0, 0, 0}),
                                               body_at("b", {0, 2, 0}, {0, 0, 0})},
      after{body_at("b", {3, 1.5, 4}, {0, 3, 4}), body_at("a", {0, 0.2, 0}, {1, 0, 0}),
            body_at("thrown", {0, -9, 0}, {0, 0, 0})};
  EXPECT_DOUBLE_EQ(*record::largest_fall(before, after), 0.8);
  EXPECT_DOUBLE_EQ(*record::largest_way(before, after), std::sqrt(25.25));
  EXPECT_DOUBLE_EQ(*record::largest_speed(after), 5);
  EXPECT_DOUBLE_EQ(*record::lowest(after), -9);
  EXPECT_FALSE(record::largest_fall({}, after));
  EXPECT_FALSE(record::largest_speed({}));
}

/// Two runs are compared by their bodies only where they have some.
TEST(Bodies, ComparisonsListThemWhereThereAreSome) {
  record::FrameRecord without, with;
  with.bodies = {body_at("ball", {0, 0.5, 0}, {0, 3, 4})};
  const scene::Scene scene = scene_with_body("");
  const auto csv_of = [&](const record::FrameRecord& a, const record::FrameRecord& b) {
    return compare::series_csv({compare::moment_of(0, scene, {a}, {b})});
  };
  EXPECT_EQ(csv_of(without, without).find("body_"), std::string::npos);
  const std::string csv = csv_of(with, without);
  EXPECT_NE(csv.find("body_speed_a,body_speed_b,body_height_a,body_height_b"), std::string::npos);
  EXPECT_NE(csv.find(",5,,0.5,"), std::string::npos) << csv;
}

TEST(Comparisons, SnowThatASinkHasTakenHasNoShape) {
  record::FrameRecord some, none;
  some.metrics.particles = 1;
  some.metrics.spread = none.metrics.spread = 0.25;
  const std::string csv =
      compare::series_csv({compare::moment_of(0, scene_with_body(""), {some}, {none})});
  EXPECT_NE(csv.find(",0.25,,"), std::string::npos) << csv;
}

TEST(Bodies, PlotsHaveACurveOfEach) {
  std::vector<picture::PlotSample> history(3);
  for (int k = 0; k < 3; ++k) {
    history[static_cast<std::size_t>(k)].time = 0.5 * k;
    history[static_cast<std::size_t>(k)].bodies = {{"ball", 1.0 - k, 2.0 * k}};
  }
  history[2].bodies.push_back({"thrown", 7, 8});
  scene::PlotRanges ranges;
  ranges.body_height = scene::Range{-2, 2};
  const auto plots = picture::make_plots(ranges, true, history, 1, 0.5, 2);
  ASSERT_EQ(plots.size(), 6u);
  EXPECT_EQ(plots[3].title, "height of bodies");
  EXPECT_EQ(plots[3].min, -2);
  ASSERT_EQ(plots[3].series.size(), 2u);
  EXPECT_EQ(plots[3].series[0].value, (std::vector<float>{1, 0, -1}));
  EXPECT_EQ(plots[3].series[1].name, "thrown");
  EXPECT_TRUE(std::isnan(plots[3].series[1].value[0])) << "it was not there yet";
  EXPECT_EQ(plots[4].series[0].value, (std::vector<float>{0, 2, 4}));
  history.resize(2);
  EXPECT_EQ(picture::make_plots(ranges, true, history, 1, 0.5, 2)[3].series[0].name, "")
      << "one body needs no name";
}

TEST(Bodies, RangesOfPlotsHoldTheFall) {
  scene::Scene scene =
      scene_with_body(ball_that("density = 900\nvelocity = [0, 2, 0]") +
                      "[[view]]\nname = \"v\"\nlayers = [\"particles\", \"plots\"]\n");
  setup::resolve_ranges(scene, 1000);
  const scene::PlotRanges& ranges = scene.views[0].plots;
  ASSERT_TRUE(ranges.body_height && ranges.body_speed);
  EXPECT_LE(ranges.body_height->min, 0.1);
  EXPECT_GE(ranges.body_height->max, 0.4 + 2 * 2 / (2 * 9.81));
  EXPECT_LE(ranges.body_height->max, 1.5);
  EXPECT_GE(ranges.body_speed->max, std::sqrt(4 + 2 * 9.81 * 0.3));
  // The snow that it hits is as fast: colours and steps are chosen for it.
  EXPECT_GT(setup::largest_speed(scene), setup::largest_speed(scene_with_body("")));
  EXPECT_EQ(setup::impact_speed(scene), setup::impact_speed(scene_with_body("")));
  scene::Scene without = scene_with_body("[[view]]\nname = \"v\"\nlayers = [\"plots\"]\n");
  setup::resolve_ranges(without, 1000);
  EXPECT_FALSE(without.views[0].plots.body_height);
}

/// Axes reach to what rams and slopes do to the snow, and to what falls from its top.
TEST(Ranges, AxesReachToWhatPushesAndSlides) {
  const std::string snow =
      "frames = 48\n[[body]]\nname = \"block\"\n"
      "shape = { box = { center = [0, 0.1, 0], size = [0.3, 0.2, 0.3] } }\n";
  const auto speed_with = [&](const std::string& collider) {
    return setup::largest_speed(
        scene::read_scene_text(snow + "[[collider]]\n" + collider, "s.toml"));
  };
  const double still = speed_with("shape = { plane = {} }\n");
  EXPECT_GE(speed_with("shape = { box = { center = [-0.6, 0.1, 0], size = [0.2, 0.2, 0.5] } }\n"
                       "keyframes = [{ time = 0, position = [-0.6, 0.1, 0] },\n"
                       "  { time = 0.5, position = [3.4, 0.1, 0] }]\n"),
            8);
  // g sin(30 degrees) for 2 s; friction takes its share.
  const std::string slope = "shape = { plane = { normal = [0.5, 0.8660254, 0] } }\n";
  EXPECT_NEAR(speed_with(slope + "contact = \"slip\"\n"), 9.81, 1e-6);
  EXPECT_NEAR(speed_with(slope + "friction = 0.3\n"), 9.81 - 0.3 * 9.81 * std::sqrt(3.0), 1e-6);
  EXPECT_LT(speed_with(slope + "contact = \"sticky\"\n"), 1.2 * still);
}

/// A body that nothing carries falls until the end of the scene, and one that is held does not.
TEST(Ranges, WhatHoldsABodyBoundsItsFall) {
  const auto speed_with = [](const std::string& more) {
    const scene::Scene scene = scene::read_scene_text(
        "frames = 240\n[[body]]\nshape = { box = { center = [0, 0.1, 0], size = [0.3, 0.2, 0.3] "
        "} }\n[[collider]]\nname = \"ledge\"\nshape = { box = { center = [0, -0.1, 0], size = "
        "[1, 0.2, 1] } }\n" +
            ball_that("density = 500\n" + more, "[2, 0.5, 0]"),
        "s.toml");
    return setup::collider_speed(scene, "ball");
  };
  const double g = 9.81, freely = 10 * g, snow = std::sqrt(2 * g * 0.1);
  EXPECT_NEAR(speed_with(""), freely, 1e-6);
  EXPECT_NEAR(speed_with("hold = [\"x\", \"z\"]"), freely, 1e-6);
  EXPECT_NEAR(speed_with("hold = [\"x\", \"y\", \"z\"]\nangular_velocity = [0, 1, 0]"), snow, 0.1);
  EXPECT_NEAR(speed_with("joint = \"slider\"\njoint_axis = [0, 1, 0]"), freely, 1e-6);
  EXPECT_NEAR(speed_with("joint = \"slider\"\njoint_axis = [1, 0, 0]"), snow, 0.1);
  // 2.09 kg on 500 N/m sink by 4 cm and as much again; 50 cm off, the spring gives them its energy.
  const std::string spring = "spring_stiffness = 500\n";
  EXPECT_LT(speed_with(spring + "spring_place = [2, 0.5, 0]"), 3);
  EXPECT_NEAR(speed_with(spring + "spring_place = [2, 1, 0]"), 0.5 * std::sqrt(500 / 2.094), 0.5);
}

double share_of_picture(const scene::CameraSettings& camera, double aspect, const Vec3d& point) {
  const Vec3d forward = (*camera.target - *camera.eye).normalized();
  const Vec3d right = forward.cross(camera.up).normalized(), up = right.cross(forward);
  const Vec3d q = point - *camera.eye;
  const double half = std::tan(camera.fov * 3.14159265358979 / 360) * q.dot(forward);
  return std::max(std::abs(q.dot(right)) / (half * aspect), std::abs(q.dot(up)) / half);
}

/// The scene alone says where it begins; a coarse run, where it goes.
TEST(Bodies, TheAutomaticCameraSeesTheirWay) {
  scene::Scene scene = scene_with_body(
      ball_that("density = 900\nvelocity = [1.2, 0, 0]\nfriction = 0", "[0.35, 0.1, 0]"));
  setup::resolve(scene, 1000);
  const double aspect = 16.0 / 9;
  for (const double x : {0.35, 0.6, 0.9})
    EXPECT_LT(share_of_picture(*scene.camera, aspect, {x, 0.1, 0}), 1) << x;
  // One that is gone at once does not make the rest small.
  scene::Scene gone =
      scene_with_body(ball_that("density = 900\nvelocity = [80, 0, 0]", "[0.35, 0.1, 0]"));
  scene::Scene alone = scene_with_body("");
  setup::resolve(gone, 1000);
  setup::resolve(alone, 1000);
  EXPECT_LT((*gone.camera->eye - *gone.camera->target).norm(),
            4 * (*alone.camera->eye - *alone.camera->target).norm());
}

TEST(Bodies, ACameraFollowsOne) {
  scene::Scene scene = scene_with_body(ball_that("density = 900\nvelocity = [3, 0, 0]") +
                                       "[camera]\nfollow = \"ball\"\n");
  const setup::SeededScene seeded = setup::seed_scene(scene);
  setup::resolve(scene, seeded.particles.x.size());
  timeline::Timeline timeline(scene, {}, std::make_shared<const setup::SeededScene>(seeded), 1);
  const auto place = [&] {
    const scene::Scene now = timeline.scene();
    const picture::Snapshot snapshot =
        picture::take_snapshot(now, now.views, timeline.simulation(), 0);
    return picture::camera_place(now, now.views[0], seeded, snapshot);
  };
  const setup::CameraPlace before = place();
  EXPECT_LE((before.target - Vec3d(0, 0.4, 0)).norm(), 0.15) << "it is framed";
  timeline.go_to(0.1);
  const Vec3d moved = place().target - before.target;
  const Vec3d now =
      sim::shapes::pose_at(timeline.simulation().colliders()[1], timeline.simulation().time())
          .point;
  EXPECT_LE((moved - (now - Vec3d(0, 0.4, 0))).norm(), 1e-9);
  EXPECT_GT(moved.x(), 0.2);
  EXPECT_THROW(scene_with_body("[camera]\nfollow = \"bal\"\n"), std::exception);
  EXPECT_THROW(scene_with_body("[camera]\nfollow = \"floor\"\n"), std::exception)
      << "a plane has no middle";
}

/// A body keeps its velocity between two frames, as snow does.
TEST(Bodies, MotionVectorsAreTheirVelocities) {
  const scene::Scene scene = scene_with_body(ball_that("density = 900\nvelocity = [1, 0, 2]"));
  const auto seeded = std::make_shared<const setup::SeededScene>(setup::seed_scene(scene));
  timeline::Timeline timeline(scene, {}, seeded, 1);
  timeline.go_to(0.08);
  const scene::Scene now = timeline.scene();
  const picture::Snapshot snapshot =
      picture::take_snapshot(now, now.views, timeline.simulation(), 0);
  const auto things = picture::moving_meshes({now, now.views[0], *seeded, snapshot}, 0.01);
  ASSERT_EQ(things.size(), 1u);
  const sim::shapes::Pose pose =
      sim::shapes::pose_at(timeline.simulation().colliders()[1], timeline.simulation().time());
  EXPECT_LT(pose.velocity.y(), -0.5) << "it falls, unlike in its scene";
  const Vec3f middle{static_cast<float>(pose.point.x()), static_cast<float>(pose.point.y()),
                     static_cast<float>(pose.point.z())};
  const Vec3f after = things[0].after(middle), before = things[0].before(middle);
  EXPECT_NEAR((after.y - middle.y) / 0.01f, pose.velocity.y(), 1e-3);
  EXPECT_NEAR((middle.z - before.z) / 0.01f, pose.velocity.z(), 1e-3);
}

std::vector<health::Finding> body_findings(const std::string& more, const std::string& top = "") {
  const scene::Scene scene = scene::read_scene_text(top + floor_and_snow + more, "s.toml");
  std::vector<health::Finding> findings;
  health::check_moving_bodies(scene, setup::coarse_run(scene), 1, findings);
  return findings;
}

testing::AssertionResult tells_of(const std::vector<health::Finding>& findings,
                                  const std::string& address, const std::string& part) {
  std::string all;
  for (const health::Finding& finding : findings) {
    all += finding.address + ": " + finding.what + "; " + finding.hint + "\n";
    if (finding.address == address && finding.what.find(part) != std::string::npos)
      return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << "found only: " << all;
}

TEST(BodyFindings, AGoodBodyHasNone) {
  EXPECT_TRUE(body_findings(ball_that("density = 900")).empty());
  EXPECT_TRUE(body_findings(ball_that("density = 900", "[1, 0.1, 0]")).empty())
      << "it touches the floor";
  EXPECT_TRUE(body_findings(ball_that("", "[1, 0, 0]")).empty())
      << "what does not move may overlap";
  // A sign may overlap the post that it hangs from.
  EXPECT_TRUE(
      body_findings(ball_that("density = 900\njoint = \"ball\"\njoint_point = [0, 0.5, 0]") +
                    "[[collider]]\nname = \"post\"\nshape = { sphere = { center = [0, 0.5, "
                    "0], radius = 0.05 } }\n")
          .empty());
}

TEST(BodyFindings, OverlapsAreFound) {
  EXPECT_TRUE(tells_of(body_findings(ball_that("density = 900", "[1, 0.05, 0]")),
                       "collider.ball.shape",
                       "of ball starts inside floor: contact pushes them apart"));
  const auto pair =
      body_findings(ball_that("density = 900") +
                    "[[collider]]\nname = \"can\"\nshape = { sphere = { center = [0.1, "
                    "0.4, 0], radius = 0.1 } }\ndensity = 100\n");
  EXPECT_TRUE(tells_of(pair, "collider.ball.shape", "of ball starts inside can"));
  EXPECT_EQ(pair.size(), 1u) << "one of the two tells";
  EXPECT_TRUE(
      tells_of(body_findings(ball_that("density = 900") +
                             "[[collider]]\nname = \"pin\"\nshape = { sphere = { center = [0, "
                             "0.4, 0], radius = 0.004 } }\n"),
               "collider.ball.shape", "ball and pin overlap at the start"));
}

TEST(BodyFindings, NumbersOfNothingRealAreFound) {
  EXPECT_TRUE(tells_of(body_findings(ball_that("density = 0.9")), "collider.ball.density",
                       "a density of 0.9 kg/m3, lighter than anything"));
  EXPECT_NE(body_findings(ball_that("density = 0.9"))[0].hint.find("900"), std::string::npos)
      << "grams per cubic centimetre";
  EXPECT_TRUE(
      tells_of(body_findings(ball_that("density = 1e6")), "collider.ball.density", "heavier"));
  EXPECT_TRUE(tells_of(body_findings(ball_that("mass = 400")), "collider.ball.mass",
                       "400 kg in 0.00419 m3"));
  EXPECT_TRUE(body_findings(ball_that("mass = 4")).empty());
  EXPECT_TRUE(tells_of(
      body_findings(ball_that("density = 900\njoint = \"hinge\"\njoint_point = [30, 0, 0]")),
      "collider.ball.joint_point", "the joint of ball is 30 m away"));
}

TEST(BodyFindings, WhatNothingHoldsOrEverythingIsFound) {
  EXPECT_TRUE(
      tells_of(body_findings("[[collider]]\nname = \"crumb\"\nshape = { sphere = { center = [0, "
                             "0.3, 0], radius = 0.03 } }\ndensity = 900\n"),
               "collider.crumb.shape", "crumb is 1.5 cells large"));
  // The number to type is that of the scene.
  const scene::Scene coarse = scene::read_scene_text(
      floor_and_snow +
          "[[collider]]\nname = \"crumb\"\nshape = { sphere = { center = [0, 0.3, 0], "
          "radius = 0.03 } }\ndensity = 900\n",
      "s.toml");
  std::vector<health::Finding> of_crumb;
  health::check_moving_bodies(coarse, setup::coarse_run(coarse), 2, of_crumb);
  ASSERT_FALSE(of_crumb.empty());
  EXPECT_EQ(of_crumb[0].hint,
            "make it larger, or solver.cell_size = 0.0075 (--coarsen 2 makes it 0.015)");
  EXPECT_TRUE(
      tells_of(body_findings(ball_that("density = 900\nhold = [\"x\", \"y\", \"z\", \"turn_x\", "
                                       "\"turn_y\", \"turn_z\"]")),
               "collider.ball.hold", "never moves"));
  const std::string no_floor = R"(
frames = 24
[solver]
cell_size = 0.04
[[body]]
name = "bed"
shape = { box = { center = [0, 0.08, 0], size = [0.4, 0.16, 0.4] } }
)";
  const scene::Scene beside =
      scene::read_scene_text(no_floor + ball_that("density = 900", "[2, 0.4, 0]"), "s.toml");
  std::vector<health::Finding> findings;
  health::check_moving_bodies(beside, setup::coarse_run(beside), 1, findings);
  EXPECT_TRUE(tells_of(findings, "collider.ball", "nothing carries or stops ball"));
  EXPECT_TRUE(body_findings(ball_that("density = 900")).empty()) << "a floor does";
  scene::Scene weightless = scene_with_body(ball_that("density = 900"));
  weightless.solver.gravity.setZero();
  findings.clear();
  health::check_moving_bodies(weightless, setup::coarse_run(weightless), 1, findings);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, health::Severity::note);
  // A curve may give it gravity later, or a spring.
  const auto curved = [](const std::string& parameter, const std::string& key) {
    return "[[curve]]\nparameter = \"" + parameter + "\"\nkeyframes = [{ time = 0, " + key +
           " }]\n";
  };
  for (const std::string& curve :
       {curved("solver.gravity", "vector = [0, 0, 0] }, { time = 0.2, vector = [0, -9.81, 0]"),
        curved("collider.ball.spring_stiffness", "value = 0 }, { time = 0.2, value = 500")}) {
    scene::Scene pulled = scene_with_body(ball_that("density = 900") + curve);
    pulled.solver.gravity.setZero();
    findings.clear();
    health::check_moving_bodies(pulled, {}, 1, findings);
    EXPECT_TRUE(findings.empty()) << findings[0].what;
  }
}

TEST(Bodies, MotionsThatAJointTakesAwayAreTold) {
  const std::string hinged =
      "density = 900\njoint = \"hinge\"\njoint_point = [-0.3, 0.4, 0]\njoint_axis = [0, 0, 1]\n"
      "angular_velocity = [0, 0, 2]\n";
  const auto found = body_findings(ball_that(hinged));
  EXPECT_TRUE(tells_of(found, "collider.ball.angular_velocity", "lets it start with"));
  ASSERT_FALSE(found.empty());
  EXPECT_NE(found[0].hint.find("velocity = [0, 0.6, 0]"), std::string::npos) << found[0].hint;
  EXPECT_TRUE(body_findings(ball_that(hinged + "velocity = [0, 0.6, 0]\n")).empty());
  EXPECT_TRUE(
      tells_of(body_findings(ball_that("density = 900\nhold = [\"z\"]\nvelocity = [0, -1, 3]")),
               "collider.ball.velocity", "[0, -1, 3] m/s"));
  EXPECT_TRUE(
      body_findings(ball_that("density = 900\nhold = [\"z\"]\nvelocity = [0, -1, 0]")).empty());
}

/// Whole colliders are changes like others.
TEST(ComingAndGoing, ADifferenceIsLiveAndSaysTheWholeCollider) {
  const scene::Scene before = scene_with_body(""),
                     after = scene_with_body(ball_that("density = 900"));
  const scene::SplitDifferences come = scene::split_live(before, after);
  EXPECT_TRUE(come.restart.empty());
  ASSERT_EQ(come.live.size(), 1u);
  EXPECT_EQ(come.live[0].address, "collider.ball");
  EXPECT_FALSE(come.live[0].before);
  const scene::Scene again = scene::apply(
      before, {{"collider.ball", scene::toml::toml_literal(*come.live[0].after)}}, "s.toml");
  EXPECT_EQ(scene::write_scene(again), scene::write_scene(after));
  const scene::SplitDifferences gone = scene::split_live(after, before);
  ASSERT_EQ(gone.live.size(), 1u);
  EXPECT_FALSE(gone.live[0].after);
  EXPECT_TRUE(scene::is_live("collider.ball"));
  EXPECT_FALSE(scene::is_live("body.bed"));
  EXPECT_FALSE(scene::is_live("collider.ball.density"));
}

TEST(ComingAndGoing, ARunIsMadeAgainFromItsChanges) {
  const scene::Scene scene = scene_with_body(
      "[[collider]]\nname = \"post\"\nshape = { sphere = { center "
      "= [0.2, 0.1, 0], radius = 0.06 } }\n");
  const auto seeded = std::make_shared<const setup::SeededScene>(setup::seed_scene(scene));
  timeline::Timeline live(scene, {}, seeded, 1);
  const auto set = [&](const std::string& address, const std::string& value) {
    live.change(scene::apply(*live.here().scene, {{address, value}}, "s.toml"));
  };
  const std::string thrown =
      "{ shape = { sphere = { center = [-0.3, 0.4, 0], radius = 0.08 } }, density = 700, velocity "
      "= [3, -1, 0] }";
  live.advance_frame();
  live.advance_step();
  set("collider.thrown", thrown);
  live.advance_step();
  set("collider.thrown.friction", "0.1");
  live.advance_frame();
  const timeline::Moment then = live.moment();
  live.advance_step();
  set("collider.post", "none");
  set("collider.thrown_2", thrown);
  live.advance_frame();
  set("collider.thrown", "none");
  set("collider.post", "{ shape = { sphere = { center = [0.2, 0.1, 0], radius = 0.06 } } }");
  live.advance_frame();
  EXPECT_EQ(live.here().frame, 4);
  EXPECT_EQ(live.changes().size(), 6u);
  std::vector<std::string> names;
  for (const auto& collider : live.scene().colliders) names.push_back(collider.name);
  EXPECT_EQ(names, (std::vector<std::string>{"floor", "thrown_2", "post"}));
  timeline::Timeline again(scene, live.changes(), seeded, 1);
  ASSERT_TRUE(again.go_to(4 / 24.0));
  EXPECT_EQ(again.simulation().state_hash(), live.simulation().state_hash());
  // The same holds from a moment in between, which is read with the changes so far.
  const timeline::Moment kept = timeline::to_moment([&] {
    output::Checkpoint file = output::parse_checkpoint(
        output::encode_checkpoint(timeline::to_checkpoint(then, "identity", "simd")));
    file.file = "moment.ckpt";
    return file;
  }());
  EXPECT_EQ(kept.history.back().bodies.size(), 1u);
  again.restore(kept);
  ASSERT_TRUE(again.go_to(4 / 24.0));
  EXPECT_EQ(again.simulation().state_hash(), live.simulation().state_hash());
}

}  // namespace
}  // namespace neve::app
