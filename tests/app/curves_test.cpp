/// Keyframes of parameters: the values of each frame, and a run that has them.

#include "app/setup/curves.h"

#include <gtest/gtest.h>

#include "app/forecast/forecast.h"
#include "app/health/check.h"
#include "app/health/findings.h"
#include "app/scene/coarsen.h"
#include "app/scene/override.h"
#include "app/scene/read.h"
#include "app/scene/toml/error.h"
#include "app/setup/coarse_run.h"
#include "app/support/errors.h"
#include "app/timeline/timeline.h"

namespace neve::app {
namespace {

using timeline::Timeline;

/// A ball of snow that falls on a floor.
scene::Scene falling(const std::string& more) {
  return scene::read_scene_text(R"(
frames = 6
[solver]
cell_size = 0.04
[material.snow]
model = "cam_clay"
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.12, 0], radius = 0.08 } }
velocity = [0, -2, 0]
[[collider]]
name = "floor"
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
)" + more,
                                "s.toml");
}

std::string error_of_curve(const std::string& curve) {
  try {
    falling("[[curve]]\n" + curve);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

const std::string curves = R"(
[[curve]]
name = "fall"
parameter = "solver.gravity"
interpolation = "linear"
keyframes = [{ time = 0, vector = [0, -9.81, 0] }, { time = 0.25, vector = [4, -5, 0] }]
[[curve]]
parameter = "material.snow.cohesion"
interpolation = "step"
keyframes = [{ time = 0, value = 0 }, { time = 0.125, value = 0.5 }]
[[curve]]
parameter = "material.snow.hardening"
keyframes = [{ time = 0.05, value = 10 }, { time = 0.2, value = 3 }]
)";

std::string value(const scene::Scene& scene, int frame, std::size_t curve) {
  return setup::curve_values(scene, frame).at(curve).value;
}

TEST(Curves, GiveTheValueOfTheMiddleOfAFrame) {
  const scene::Scene scene = falling(curves);
  EXPECT_EQ(value(scene, 0, 0), "[0, -9.81, 0]");
  // Frame 3 is from 2/24 s to 3/24 s.
  const sim::Vec3d third = setup::with_curves(scene, 3).solver.gravity;
  const double part = 2.5 / 24 / 0.25;
  EXPECT_NEAR(third.x(), 4 * part, 1e-12);
  EXPECT_NEAR(third.y(), -9.81 + part * 4.81, 1e-12);
  EXPECT_EQ(value(scene, 7, 0), "[4, -5, 0]");
  EXPECT_EQ(value(scene, 3, 1), "0") << "the frame that ends at the keyframe";
  EXPECT_EQ(value(scene, 4, 1), "0.5") << "the frame that begins there";
  const double smooth = setup::with_curves(scene, 3).materials.front().hardening;
  EXPECT_NEAR(smooth, 10 - 7 * (3 - 2 * 0.3611111) * 0.3611111 * 0.3611111, 1e-5);
  EXPECT_EQ(setup::with_curves(scene, 48).materials.front().hardening, 3);
}

TEST(Curves, AreWrittenAndReadAgain) {
  const scene::Scene scene = falling(curves);
  const scene::Scene again = scene::read_scene_text(scene::write_scene(scene), "again");
  EXPECT_EQ(scene::write_scene(again), scene::write_scene(scene));
  ASSERT_EQ(again.curves.size(), 3u);
  EXPECT_EQ(again.curves[0].name, "fall");
  EXPECT_EQ(again.curves[1].name, "2");
}

std::shared_ptr<const setup::SeededScene> seeded(const scene::Scene& scene) {
  return std::make_shared<const setup::SeededScene>(setup::seed_scene(scene));
}

TEST(Curves, MoveTheirParameterWhileARunRuns) {
  const scene::Scene scene = falling(curves);
  Timeline run(scene, {}, seeded(scene), 1);
  for (int frame = 1; frame <= 5; ++frame) {
    ASSERT_TRUE(run.advance_frame());
    EXPECT_EQ(run.scene().solver.gravity, setup::with_curves(scene, frame).solver.gravity);
    EXPECT_EQ(run.here().scene->materials.front().own,
              setup::with_curves(scene, frame).materials.front().own);
  }
  scene::Scene still = scene;
  still.curves.clear();
  Timeline other(still, {}, seeded(still), 1);
  ASSERT_TRUE(other.go_to(5 / 24.0));
  EXPECT_NE(other.simulation().state_hash(), run.simulation().state_hash());
  EXPECT_GT(run.summary().momentum.x(), 0) << "gravity has turned towards x";
}

/// Bits do not depend on the moment that a run continues from, nor on how it got there.
TEST(Curves, HaveTheSameBitsFromEveryMoment) {
  const scene::Scene scene = falling(curves);
  Timeline whole(scene, {}, seeded(scene), 1, timeline::Moments(std::uint64_t{1} << 30));
  std::vector<std::uint64_t> hashes{whole.simulation().state_hash()};
  whole.keep();
  for (int frame = 1; frame <= 6; ++frame) {
    ASSERT_TRUE(whole.advance_frame());
    hashes.push_back(whole.simulation().state_hash());
    whole.keep();
  }
  for (int frame = 0; frame < 6; ++frame) {
    // A moment that a file holds has no scene.
    timeline::Moment moment = *whole.moments().find(frame / 24.0, 24);
    moment.scene = nullptr;
    Timeline again(scene, {}, seeded(scene), 1);
    again.restore(moment);
    ASSERT_TRUE(again.go_to(6 / 24.0));
    EXPECT_EQ(again.simulation().state_hash(), hashes.back()) << frame;
    ASSERT_TRUE(whole.go_to(frame / 24.0));
    EXPECT_EQ(whole.simulation().state_hash(), hashes[static_cast<std::size_t>(frame)]);
    ASSERT_TRUE(whole.advance_frame());
    EXPECT_EQ(whole.simulation().state_hash(), hashes[static_cast<std::size_t>(frame) + 1]);
  }
}

TEST(Curves, GoOnWhenAnotherParameterIsChanged) {
  const scene::Scene scene = falling(curves);
  Timeline run(scene, {}, seeded(scene), 1);
  ASSERT_TRUE(run.go_to(2 / 24.0));
  // A panel gives the scene of the start with one other number, and one of a curve.
  scene::Scene edited = scene;
  edited.materials.front().youngs_modulus *= 0.5;
  edited.solver.gravity = {0, 0, 0};
  run.change(edited);
  ASSERT_EQ(run.changes().size(), 1u);
  EXPECT_EQ(run.changes().front().address, "material.snow.youngs_modulus");
  ASSERT_TRUE(run.go_to(5 / 24.0));
  EXPECT_EQ(run.scene().solver.gravity, setup::with_curves(scene, 5).solver.gravity);
  Timeline again(run.start(), run.changes(), seeded(scene), 1);
  ASSERT_TRUE(again.go_to(5 / 24.0));
  EXPECT_EQ(again.simulation().state_hash(), run.simulation().state_hash());
}

TEST(Curves, MistakesAreToldAtTheirPlace) {
  const auto expect = [](const std::string& curve, const std::string& words) {
    const std::string error = error_of_curve(curve);
    EXPECT_NE(error.find(words), std::string::npos) << error;
  };
  expect("keyframes = [{ time = 0, value = 1 }]", "the curve names no parameter");
  expect("parameter = \"material.snow.hardning\"",
         "s.toml:15:13: error: nothing in the scene is called \"material.snow.hardning\"; did you "
         "mean material.snow.hardening?");
  expect("parameter = \"material.wet.hardening\"", "nothing in the scene is called");
  expect("parameter = \"solver.cell_size\"",
         "solver.cell_size cannot change while a simulation runs");
  expect("parameter = \"light.intensity\"", "only concerns pictures");
  expect("parameter = \"solver.transfer\"", "solver.transfer is a choice");
  expect("parameter = \"solver.cfl\"", "the curve has no keyframes");
  expect(
      "parameter = \"solver.cfl\"\nkeyframes = [{ time = 1, value = 1 }, { time = 1, value = 2 }]",
      "s.toml:16:48: error: keyframe 2 is at 1 s, the one before at 1 s");
  expect("parameter = \"solver.cfl\"\nkeyframes = [{ time = 0, vector = [1, 2, 3] }]",
         "solver.cfl is a number; give value = 0.5");
  expect("parameter = \"solver.gravity\"\nkeyframes = [{ time = 0, value = 3 }]",
         "solver.gravity is a vector; give vector = [0, -9.81, 0]");
  expect("parameter = \"solver.cfl\"\nkeyframes = [{ time = 0 }]", "the keyframe has no value");
  expect("parameter = \"collider.floor.friction\"\nkeyframes = [{ time = 0, value = -1 }]",
         "collider.floor.friction would be -1; expected 0 <= value <= 1000");
  expect(
      "parameter = \"solver.cfl\"\nkeyframes = [{ time = 0, value = 1 }]\n[[curve]]\nparameter = "
      "\"solver.cfl\"\nkeyframes = [{ time = 0, value = 1 }]",
      "solver.cfl has the curve 1 already");
}

/// Snow feels the speed of a surface, and a curve of its place has none.
TEST(Curves, PlacesOfCollidersHaveKeyframesInstead) {
  const std::string keys = "\nkeyframes = [{ time = 0, vector = [0, 0, 0] }]";
  for (const char* key : {"shape.plane.point", "shape.plane.rotation"}) {
    const std::string error =
        error_of_curve("parameter = \"collider.floor." + std::string(key) + "\"" + keys);
    EXPECT_NE(error.find("give collider.floor.keyframes"), std::string::npos) << error;
  }
  EXPECT_EQ(error_of_curve("parameter = \"collider.floor.velocity\"" + keys), "no error");
  const std::string body =
      "[[collider]]\nname = \"b\"\ndensity = 100\n"
      "shape = { sphere = { center = [1, 1, 0], radius = 0.1 } }\n";
  const std::string error =
      error_of_curve("parameter = \"collider.b.velocity\"" + keys + "\n" + body);
  EXPECT_NE(error.find("b moves by itself"), std::string::npos) << error;
}

TEST(Curves, ForecastsFollowThem) {
  const auto steps = [](const std::string& more, double youngs_modulus) {
    scene::Scene scene = falling(more);
    scene.materials[0].youngs_modulus = youngs_modulus;
    return forecast::foresee(scene, 300, scene.frames, {1e9, 1e9}).steps().expected;
  };
  const std::string curve =
      "[[curve]]\nparameter = \"material.snow.youngs_modulus\"\n"
      "interpolation = \"step\"\nkeyframes = [{ time = 0, value = 1e5 }";
  const double soft = steps("", 1e5);
  EXPECT_EQ(steps(curve + "]\n", 1e7), soft);
  // Half of the frames are ten times as stiff in the speed of sound.
  const double rising = steps(curve + ", { time = 0.125, value = 1e7 }]\n", 1e5);
  EXPECT_GT(rising, 3 * soft);
  EXPECT_LT(rising, 10 * soft);
}

TEST(Curves, ChangesOfWhatFollowsOneAreRefused) {
  const scene::Scene scene = falling(curves);
  try {
    setup::refuse_followers(
        scene, scene::parse_overrides({"solver.cfl=0.3", "material.snow.hardening=2"}));
    FAIL() << "not refused";
  } catch (const UsageError& error) {
    EXPECT_EQ(error.where, "--set material.snow.hardening=2");
    EXPECT_NE(error.message.find("material.snow.hardening follows its curve 3"), std::string::npos)
        << error.message;
    EXPECT_EQ(error.hint, "change curve.3.keyframes instead");
  }
  setup::refuse_followers(scene,
                          scene::parse_overrides({"solver.cfl=0.3", "curve.fall.keyframes=[]"}));
}

TEST(Curves, TablesWithAValueOfWhatFollowsOneAreRefused) {
  const scene::Scene scene = falling(curves);
  EXPECT_THROW(setup::refuse_followers(
                   scene, scene::parse_overrides({"material.snow={density=200, hardening=2}"})),
               UsageError);
  setup::refuse_followers(scene, scene::parse_overrides({"material.snow={density=200}"}));
  setup::refuse_followers(scene, scene::parse_overrides({"solver=none"}));
}

/// A run would end in its middle.
TEST(Curves, ValuesThatNoSceneMayHaveAreNamedWithTheirKeyframe) {
  const auto error_of = [](const std::string& more) -> std::string {
    try {
      setup::require_curve_values(falling(more), "s.toml");
    } catch (const scene::toml::SceneError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(error_of(curves), "");
  const std::string blade =
      "[[collider]]\nname = \"blade\"\nshape = { sphere = { center = [2, 0, 0], radius = 0.1 } }\n";
  const std::string moved = error_of(
      blade +
      "keyframes = [{ time = 0, position = [2, 0, 0] }, { time = 1, position = [3, 0, 0] }]\n"
      "[[curve]]\nname = \"c\"\nparameter = \"collider.blade.velocity\"\n"
      "keyframes = [{ time = 0.5, vector = [0, 0, 0] }, { time = 1, vector = [1, 0, 0] }]\n");
  EXPECT_NE(moved.find("curve.c.keyframes[2]"), std::string::npos) << moved;
  EXPECT_NE(moved.find("velocity and keyframes both move"), std::string::npos) << moved;
  const std::string sprung =
      error_of(blade +
               "[[curve]]\nname = \"c\"\nparameter = \"collider.blade.restitution\"\n"
               "keyframes = [{ time = 0, value = 0 }, { time = 1, value = 0.5 }]\n");
  EXPECT_NE(sprung.find("curve.c.keyframes[2]"), std::string::npos) << sprung;
  // Curves that share their times are asked once, and the one at fault is named.
  const std::string second =
      error_of(blade +
               "[[curve]]\nname = \"a\"\nparameter = \"solver.cfl\"\n"
               "keyframes = [{ time = 0, value = 0.3 }, { time = 1, value = 0.4 }]\n"
               "[[curve]]\nname = \"b\"\nparameter = \"collider.blade.restitution\"\n"
               "keyframes = [{ time = 0, value = 0 }, { time = 1, value = 0.5 }]\n");
  EXPECT_NE(second.find("curve.b.keyframes[2]"), std::string::npos) << second;
}

/// Its snow is none that a file could have.
TEST(Curves, ACoarseRunOfCrushedSnowFollowsThem) {
  const scene::Scene scene = scene::read_scene_text(R"(
frames = 24
[solver]
cell_size = 0.02
[material.snow]
hardening = 20
variation = { thresholds = 0.3 }
[[body]]
shape = { sphere = { center = [0, 0.3, 0], radius = 0.1 } }
velocity = [0, -60, 0]
[[collider]]
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[[curve]]
parameter = "solver.gravity"
keyframes = [{ time = 0, vector = [0, -9.81, 0] }, { time = 0.5, vector = [0, -5, 0] }]
)",
                                                    "s.toml");
  EXPECT_FALSE(setup::coarse_run(scene).empty());
}

TEST(Curves, WithoutEffectAreTold) {
  const auto found = [](const std::string& more) {
    const scene::Scene scene = falling(more);
    std::vector<health::Finding> findings;
    health::check_unused(scene, 1, findings);
    health::check_idle(scene, {}, findings);
    std::string text;
    for (const health::Finding& finding : findings) text += health::sentence(finding) + "\n";
    return text;
  };
  const auto curve = [](const std::string& parameter) {
    return "[[curve]]\nname = \"c\"\nparameter = \"" + parameter +
           "\"\nkeyframes = [{ time = 0, value = 0.01 }, { time = 0.2, value = 0.02 }]\n";
  };
  EXPECT_NE(found(curve("solver.cfl")).find("follows 2 keyframes"), std::string::npos);
  const std::string why = ", which curve c sets, has no effect: ";
  for (const char* parameter :
       {"solver.dt", "material.snow.critical_stretch", "solver.solve_tolerance"}) {
    const std::string text = found(curve(parameter));
    EXPECT_NE(text.find(why), std::string::npos) << parameter << ": " << text;
    EXPECT_EQ(text.find("keyframes"), std::string::npos) << text;
  }
  scene::Scene fixed = falling(curve("solver.max_dt"));
  fixed.solver.time_step = sim::TimeStep::fixed;
  EXPECT_NE(health::why_idle(fixed, "solver.max_dt"), "");
  EXPECT_NE(health::why_idle(fixed, "solver.cfl"), "");
  EXPECT_EQ(health::why_idle(fixed, "solver.dt"), "");
  fixed.solver.beta = 0.5;
  EXPECT_EQ(health::why_idle(fixed, "solver.cfl"), "") << "solves that are given up take parts";
  // Dust is made by a material, or by the curve of one.
  scene::Scene dustless = falling(curve("dust.speed"));
  EXPECT_NE(health::why_idle(dustless, "dust.speed"), "");
  const scene::Scene still = falling(
      "[[collider]]\nname = \"sign\"\ncontact = \"slip\"\n"
      "shape = { sphere = { radius = 0.1 } }\ndensity = 300\n"
      "joint = \"slider\"\njoint_axis = [0, 1, 0]\n");
  for (const char* const key : {"joint_point", "spring_place", "friction"})
    EXPECT_NE(health::why_idle(still, std::string("collider.sign.") + key), "") << key;
  EXPECT_EQ(health::why_idle(still, "collider.sign.joint_axis"), "");
  EXPECT_EQ(health::why_idle(falling(curve("material.snow.dust")), "dust.speed"), "");
  // A number that is 0 at first is not 0 for ever.
  const std::string sprung =
      "[[collider]]\nname = \"can\"\nshape = { sphere = { radius = 0.1 } }\ndensity = 300\n";
  EXPECT_NE(health::why_idle(falling(sprung), "collider.can.spring_place"), "");
  EXPECT_EQ(health::why_idle(falling(sprung + curve("collider.can.spring_stiffness")),
                             "collider.can.spring_place"),
            "");
  EXPECT_EQ(health::why_idle(falling(curve("solver.beta")), "solver.solve_tolerance"), "");
}

/// Values without effect have none: the same bits.
TEST(Curves, OfIdleParametersChangeNoBit) {
  const auto hash_with = [](const std::string& parameter, sim::TimeStep time_step) {
    scene::Scene scene = falling(parameter.empty() ? ""
                                                   : "[[curve]]\nparameter = \"" + parameter +
                                                         "\"\nkeyframes = [{ time = 0, value = "
                                                         "2e-4 }, { time = 0.1, value = 1e-3 }]\n");
    scene.solver.time_step = time_step;
    scene.solver.dt = 4e-4;
    EXPECT_TRUE(parameter.empty() || !health::why_idle(scene, parameter).empty()) << parameter;
    Timeline run(scene, {}, seeded(scene), 1);
    EXPECT_TRUE(run.go_to(2 / 24.0));
    return run.simulation().state_hash();
  };
  const std::uint64_t fixed = hash_with("", sim::TimeStep::fixed),
                      adaptive = hash_with("", sim::TimeStep::adaptive);
  EXPECT_EQ(hash_with("solver.max_dt", sim::TimeStep::fixed), fixed);
  EXPECT_EQ(hash_with("solver.solve_tolerance", sim::TimeStep::adaptive), adaptive);
  EXPECT_EQ(hash_with("solver.dt", sim::TimeStep::adaptive), adaptive);
  EXPECT_EQ(hash_with("material.snow.critical_stretch", sim::TimeStep::adaptive), adaptive);
}

TEST(Curves, OfStepsGrowWithTheCells) {
  const std::string text =
      "[[curve]]\nparameter = \"solver.max_dt\"\n"
      "keyframes = [{ time = 0, value = 1e-3 }, { time = 0.1, value = 2e-3 }]\n"
      "[[curve]]\nparameter = \"solver.flip_ratio\"\n"
      "keyframes = [{ time = 0, value = 0.9 }, { time = 0.1, value = 0.95 }]\n";
  scene::Scene scene = falling(text);
  scene::coarsen(scene, 3);
  EXPECT_EQ(*scene.curves[0].keyframes[1].value, 6e-3);
  EXPECT_EQ(*scene.curves[1].keyframes[0].value, 0.9) << "it is of flip_reference_dt";
  scene = falling(text);
  scene.solver.flip_reference_dt = 0;
  scene::coarsen(scene, 3);
  EXPECT_NEAR(*scene.curves[1].keyframes[0].value, 0.9 * 0.9 * 0.9, 1e-11);
  // A step that would be longer than any may be is refused.
  scene =
      falling("[[curve]]\nparameter = \"solver.dt\"\nkeyframes = [{ time = 0, value = 0.5 }]\n");
  EXPECT_THROW(scene::coarsen(scene, 3), UsageError);
}

}  // namespace
}  // namespace neve::app
