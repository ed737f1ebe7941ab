/// Findings on numbers that mean something else than their writer thinks.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "app/health/findings.h"
#include "app/scene/read.h"

namespace neve::app {
namespace {

/// The findings on a ball on a floor with these lines, as sentences.
std::vector<std::string> senses_of(const std::string& lines) {
  const scene::Scene scene = scene::read_scene_text(
      "frames = 24\n" + lines +
          "\n[[body]]\nname = \"ball\"\nshape = { sphere = { radius = 0.1 } }\n",
      "senses.toml");
  std::vector<health::Finding> findings;
  health::check_units(scene, findings);
  std::vector<std::string> sentences;
  for (const health::Finding& finding : findings) sentences.push_back(sentence(finding));
  return sentences;
}

void expect_only(const std::string& lines, const std::string& expected) {
  const std::vector<std::string> found = senses_of(lines);
  ASSERT_EQ(found.size(), 1u) << lines << (found.size() > 1 ? found[1] : "");
  EXPECT_EQ(found[0], expected);
}

TEST(Senses, NumbersInAnotherUnitOrSenseAreSaidWithTheNumberThatWasMeant) {
  expect_only("[solver]\ngravity = [0, -1, 0]\n",
              "solver.gravity: gravity of 1 m/s2 is a tenth of the earth's; in m/s2 it is [0, "
              "-9.81, 0]");
  expect_only("[material.snow]\ncritical_stretch = 7.5\n",
              "material.snow.critical_stretch: 7.5 is a share of the length: snow stretches to "
              "twice its length and never breaks; tables of the paper are in thousandths: 0.0075");
  expect_only("[camera]\nturntable = 360\n",
              "camera.turntable: a turn in 360 s is 1 degrees in this scene; turntable is the time "
              "of one turn; for an angle set camera.orbit = 360");
  expect_only("[camera]\norbit = 1\n",
              "camera.orbit: an orbit of 1 degrees is hardly seen; it is in degrees over the whole "
              "scene; a turn is 360");
  expect_only("[camera]\nfov = 170\n",
              "camera.fov: a view of 170 degrees bends what is near its edges; 30 is usual; a lens "
              "of 35 mm has 38");
  expect_only("[light]\ndirection = [1, -2, 1]\n",
              "light.direction: the light comes from below; it points to the light: [-1, 2, -1]");
}

TEST(Senses, RadiansAndDegreesAreKnownByTheirUsualValues) {
  const std::string wall = "[[collider]]\nname = \"wall\"\n";
  expect_only(wall + "shape = { box = { size = [1, 1, 1], rotation = [0, 1.5708, 0] } }\n",
              "collider.wall.shape.rotation: a rotation of [0, 1.5708, 0] degrees is hardly seen; "
              "it looks like radians; rotations are in degrees: [0, 90, 0]");
  expect_only(wall + "shape = { box = { size = [1, 1, 1] } }\nangular_velocity = [0, 90, 0]\n",
              "collider.wall.angular_velocity: 90 rad/s are 14.3 turns a second; 90 degrees a "
              "second are 1.57");
}

TEST(Senses, AMaterialOfNothingIsSaid) {
  expect_only("[material.powder]\npreset = \"powder\"\n",
              "material.powder: no body and no emitter is of powder: its numbers do nothing; "
              "body.ball.material = \"powder\"");
  std::string many;
  for (int k = 0; k < 250; ++k) many += "[material.idle" + std::to_string(k) + "]\n";
  expect_only(many,
              "material.idle0: no body and no emitter is of idle0, idle1, idle2, idle3, idle4 and "
              "245 more: their numbers do nothing; body.ball.material = \"idle0\"");
}

TEST(Senses, GrainsAreNotPacked) {
  const auto with = [](const std::string& J_P) {
    return "[material.sand]\nmodel = \"sand\"\ndensity = 1500\n[[body]]\nname = \"heap\"\n"
           "material = \"sand\"\nshape = { sphere = { center = [1, 0, 0], radius = 0.1 } }\nJ_P "
           "= " +
           J_P + "\n";
  };
  expect_only(with("0.8"),
              "body.heap.J_P: sand is never packed: 0.8 puts 1.25 times its mass into the same "
              "space, and counts as 1 from the first step on; body.heap.J_P = 1; "
              "material.sand.density makes it denser");
  EXPECT_TRUE(senses_of(with("1.2")).empty()) << "loose";
}

/// A J_P of 5 became 2 in the first step of sand, and where snow first yielded, in silence.
TEST(Senses, PackingOutsideTheRangeOfItsMaterialIsSaid) {
  const auto with = [](const std::string& material, const std::string& J_P) {
    return "[material.m]\n" + material + "[[body]]\nname = \"heap\"\nmaterial = \"m\"\n" +
           "shape = { sphere = { center = [1, 0, 0], radius = 0.1 } }\nJ_P = " + J_P + "\n";
  };
  const std::string sand = "model = \"sand\"\ndensity = 1500\n", narrow = "max_J_P = 2\n",
                    packed = "min_J_P = 0.6\n", elastic = "model = \"corotated\"\n";
  const std::string loose =
      "body.heap.J_P: 5 is outside of the range of m, whose max_J_P is 2: J_P becomes that where "
      "it first yields, without a load that moved it there; body.heap.J_P = 2, or "
      "material.m.max_J_P = 5";
  expect_only(with(sand + narrow, "5"), loose);
  expect_only(with(narrow, "5"), loose);
  expect_only(with(packed, "0.5"),
              "body.heap.J_P: 0.5 is outside of the range of m, whose min_J_P is 0.6: J_P becomes "
              "that where it first yields, without a load that moved it there; body.heap.J_P = "
              "0.6, or material.m.min_J_P = 0.5");
  EXPECT_TRUE(senses_of(with(narrow, "2")).empty());
  EXPECT_TRUE(senses_of(with(packed, "0.6")).empty());
  EXPECT_TRUE(senses_of(with(elastic + narrow, "5")).empty()) << "it never yields";
  expect_only(
      "[material.m]\nmax_J_P = 1.2\n[[emitter]]\nname = \"jet\"\nmaterial = \"m\"\nJ_P = 1.5\n"
      "shape = { sphere = { center = [1, 0, 0], radius = 0.1 } }\n",
      "emitter.jet.J_P: 1.5 is outside of the range of m, whose max_J_P is 1.2: J_P becomes that "
      "where it first yields, without a load that moved it there; emitter.jet.J_P = 1.2, or "
      "material.m.max_J_P = 1.5");
}

TEST(Senses, UsualNumbersGetNoWord) {
  EXPECT_TRUE(senses_of("[solver]\ngravity = [0, -1.62, 0]\n").empty());
  EXPECT_TRUE(senses_of("[camera]\nturntable = 2\n").empty());
  EXPECT_TRUE(senses_of("[[collider]]\nname = \"wall\"\nangular_velocity = [0, 8, 0]\nshape = { "
                        "box = { size = [1, 1, 1], rotation = [0, 20, 0] } }\n")
                  .empty());
}

}  // namespace
}  // namespace neve::app
