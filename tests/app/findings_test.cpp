/// Findings about shapes that the cells do not resolve.

#include "app/health/findings.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "app/scene/coarsen.h"
#include "app/scene/read.h"
#include "app/setup/coarse_run.h"

namespace neve::app {
namespace {

/// The findings about a wall between two bodies.
std::vector<health::Finding> findings_of_wall(const char* kernel, double cells) {
  const scene::Scene scene = scene::read_scene_text(fmt::format(R"(
[solver]
cell_size = 0.02
kernel = "{}"
[[body]]
shape = {{ box = {{ center = [0, 0.3, 0], size = [0.4, 0.2, 0.4] }} }}
[[collider]]
name = "wall"
shape = {{ box = {{ center = [0, 0, 0], size = [1, {}, 1] }} }}
)",
                                                                kernel, 0.02 * cells),
                                                    "wall.toml");
  std::vector<health::Finding> findings;
  health::check_resolution(scene, findings);
  return findings;
}

TEST(Findings, WallThroughWhichSnowIsDraggedIsFound) {
  EXPECT_TRUE(findings_of_wall("cubic", 3.01).empty());
  EXPECT_TRUE(findings_of_wall("quadratic", 2.51).empty());
  // With snow on one side only such a wall is as good as any.
  ASSERT_EQ(findings_of_wall("quadratic", 2.4).size(), 1u);
  EXPECT_EQ(findings_of_wall("quadratic", 2.4)[0].severity, health::Severity::note);
  const std::vector<health::Finding> thin = findings_of_wall("cubic", 1.5);
  ASSERT_EQ(thin.size(), 1u);
  EXPECT_EQ(thin[0].severity, health::Severity::warning);
  EXPECT_EQ(thin[0].address, "collider.wall.shape");
  EXPECT_EQ(thin[0].what, "wall is 1.5 cells thick");
  EXPECT_EQ(thin[0].hint,
            "if snow lies on both of its sides, what slides on one side drags what lies on the "
            "other, because nodes reach over less than 3; make it thicker; solver.cell_size = "
            "0.01");
}

/// 3 times 0.07 is more than 0.21 in floating point.
TEST(Findings, AWallOfTheCellsThatDoHasNoFindingByRounding) {
  const scene::Scene scene = scene::read_scene_text(R"(
[solver]
cell_size = 0.07
[[body]]
shape = { box = { center = [0, 1.3, 0], size = [1, 0.5, 1] } }
[[collider]]
name = "wall"
shape = { box = { center = [0, 0, 0], size = [1, 0.21, 1] } }
)",
                                                    "wall.toml");
  std::vector<health::Finding> findings;
  health::check_resolution(scene, findings);
  EXPECT_TRUE(findings.empty()) << findings.front().what;
}

/// The ball is before the camera at first, and behind it once that has turned half around.
TEST(Findings, ACameraThatTurnsIsLookedThroughAtAllTimes) {
  const auto findings = [](const char* turn) {
    const scene::Scene scene = scene::read_scene_text(
        std::string("frames = 4\n[solver]\ncell_size = 0.05\ngravity = [0, 0, 0]\n"
                    "[[body]]\nshape = { sphere = { center = [0, 0.2, -1.5], radius = 0.2 } }\n"
                    "[[view]]\nname = \"snow\"\n[camera]\neye = [0, 0.2, 1]\n"
                    "target = [0, 0.2, 0]\n") +
            turn,
        "turn.toml");
    std::vector<health::Finding> found;
    health::check_cameras(scene, setup::coarse_run(scene), found);
    return found;
  };
  EXPECT_TRUE(findings("").empty());
  ASSERT_EQ(findings("orbit = 180\n").size(), 1u);
  EXPECT_NE(findings("orbit = 180\n")[0].what.find("outside of the picture"), std::string::npos);
}

/// A run of --coarsen keeps its scene with longer steps, which nobody has set.
TEST(Findings, AResolvedSceneOfACoarseRunWarnsOfNoStepThatNobodySet) {
  const auto idle = [](const char* settings, double factor) {
    scene::Scene scene = scene::read_scene_text(
        std::string("[solver]\ncell_size = 0.02\n") + settings +
            "[[body]]\nshape = { sphere = { center = [0, 0.2, 0], radius = 0.2 } }\n",
        "coarse.toml");
    scene::coarsen(scene, factor);
    std::vector<health::Finding> findings;
    health::check_unused(scene::read_scene_text(scene::write_scene(scene), "scene.toml"), 1,
                         findings);
    std::string addresses;
    for (const health::Finding& finding : findings) addresses += finding.address + " ";
    return addresses;
  };
  const std::string fixed = "time_step = \"fixed\"\n", sand = "[material.snow]\nmodel = \"sand\"\n";
  EXPECT_EQ(idle("", 1), "");
  EXPECT_EQ(idle("", 2.5), "");
  EXPECT_EQ(idle(fixed.c_str(), 2.5), "");
  EXPECT_EQ(idle((fixed + sand).c_str(), 2), "");
  EXPECT_EQ(idle("dt = 1e-3\n", 1), "solver.dt ");
  EXPECT_EQ(idle("dt = 1e-3\n", 2), "solver.dt ");
  EXPECT_EQ(idle((fixed + "max_dt = 0.02\n").c_str(), 2), "solver.max_dt ");
}

TEST(Findings, SnowThatBeginsDenserThanIceIsFound) {
  const auto findings = [](const char* J_P) {
    std::vector<health::Finding> found;
    health::check_units(scene::read_scene_text(
                            std::string("[[body]]\nname = \"ball\"\nJ_P = ") + J_P +
                                "\nshape = { sphere = { center = [0, 0.2, 0], radius = 0.2 } }\n",
                            "dense.toml"),
                        found);
    return found;
  };
  EXPECT_TRUE(findings("0.5").empty());
  ASSERT_EQ(findings("0.4").size(), 1u);
  EXPECT_EQ(findings("0.4")[0].address, "body.ball.J_P");
  EXPECT_NE(findings("0.4")[0].what.find("denser than ice"), std::string::npos);
}

}  // namespace
}  // namespace neve::app
