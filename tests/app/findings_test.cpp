/// Findings about shapes that the cells do not resolve.

#include "app/health/findings.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "app/health/mesh_findings.h"
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

/// Simulations keep their digits there.
TEST(Findings, SnowSoFarAwayThatPicturesRoundItIsFound) {
  const auto found = [](double x) {
    std::vector<health::Finding> findings;
    health::check_meshes(
        scene::read_scene_text(fmt::format("[solver]\ncell_size = 0.02\n[[body]]\nname = \"ball\"\n"
                                           "shape = {{ sphere = {{ center = [{}, 0.5, 0], radius = "
                                           "0.2 }} }}\n",
                                           x),
                               "far.toml"),
        findings);
    return findings;
  };
  EXPECT_TRUE(found(2000).empty());
  ASSERT_EQ(found(20000).size(), 1u);
  EXPECT_EQ(found(20000)[0].address, "body.ball.shape");
  EXPECT_NE(found(20000)[0].what.find("0.119 cells apart"), std::string::npos)
      << found(20000)[0].what;
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

/// Each of these changed no bit of a state, and nobody was told.
TEST(Findings, SettingsThatOtherNumbersSwitchOffAreFound) {
  const auto idle = [](const std::string& solver, const std::string& material,
                       const std::string& more = "") {
    std::vector<health::Finding> findings;
    health::check_unused(
        scene::read_scene_text("frames = 4\n[solver]\n" + solver + "[material.m]\n" + material +
                                   "[[body]]\nmaterial = \"m\"\n"
                                   "shape = { sphere = { radius = 0.2 } }\n" +
                                   more,
                               "idle.toml"),
        1, findings);
    std::string addresses;
    for (const health::Finding& finding : findings)
      if (finding.severity == health::Severity::warning) addresses += finding.address + " ";
    return addresses;
  };
  const std::string elastic = "model = \"corotated\"\n", sand = "model = \"sand\"\n";
  EXPECT_EQ(idle("", "variation = { size = 0.2 }\n"), "material.m.variation.size ");
  EXPECT_EQ(idle("", "variation = { size = 0.2, density = 0.1 }\n"), "");
  const std::string varied = "variation = { thresholds = 0.5 }\n";
  EXPECT_EQ(idle("", elastic + varied), "material.m.variation.thresholds ");
  EXPECT_EQ(idle("", "model = \"neo_hookean\"\n" + varied), "material.m.variation.thresholds ");
  EXPECT_EQ(idle("", sand + varied) + idle("", varied), "") << "strength of its surface";
  EXPECT_EQ(idle("", "hardening = 0\nmax_hardening = 20\n"), "material.m.max_hardening ");
  EXPECT_EQ(idle("", "hardening = 1\nmax_hardening = 20\n"), "");
  for (const char* stays : {"sand", "cam_clay"})
    EXPECT_EQ(idle("", fmt::format("model = \"{}\"\nmax_hardening = 20\n", stays)),
              "material.m.max_hardening ");
  EXPECT_EQ(idle("", elastic + "min_J_P = 0.2\nmax_J_P = 3\n"),
            "material.m.min_J_P material.m.max_J_P ");
  EXPECT_EQ(idle("", sand + "min_J_P = 0.2\nmax_J_P = 3\n"), "material.m.min_J_P ");
  EXPECT_EQ(idle("", "min_J_P = 0.2\nmax_J_P = 3\n"), "");
  const std::string curve =
      "[[curve]]\nname = \"c\"\nkeyframes = [{ time = 0, value = 0 }, { time = 0.1, value = 0.5 "
      "}]\n"
      "parameter = ";
  EXPECT_EQ(idle("", "hardening = 0\nmax_hardening = 20\n", curve + "\"material.m.hardening\"\n"),
            "");
  EXPECT_EQ(idle("flip_ratio = 1\nflip_reference_dt = 1e-3\n", ""), "solver.flip_reference_dt ");
  EXPECT_EQ(idle("flip_ratio = 0\nflip_reference_dt = 1e-3\n", ""), "solver.flip_reference_dt ");
  EXPECT_EQ(idle("flip_ratio = 0.5\nflip_reference_dt = 1e-3\n", ""), "");
  EXPECT_EQ(
      idle("flip_ratio = 0\nflip_reference_dt = 1e-3\n", "", curve + "\"solver.flip_ratio\"\n"),
      "");
  const std::string shares = "separation_min = 0.2\nseparation_max = 0.8\nseparation_J_E = 0.9\n",
                    all_shares =
                        "solver.separation_min solver.separation_max solver.separation_J_E ";
  EXPECT_EQ(idle(shares, ""), "");
  EXPECT_EQ(idle(shares + "flip_ratio = 0\n", ""), all_shares);
  EXPECT_EQ(idle(shares, elastic), all_shares);
  EXPECT_EQ(idle("separation_max = 0\nseparation_J_E = 0.9\n", ""), "solver.separation_J_E ");
  EXPECT_EQ(
      idle("separation_max = 0\nseparation_J_E = 0.9\n", "", curve + "\"solver.separation_max\"\n"),
      "");
  EXPECT_EQ(idle("shock_viscosity = 0.5\n", elastic), "solver.shock_viscosity ");
  EXPECT_EQ(idle("shock_viscosity = 0.5\n", sand), "");
  EXPECT_EQ(idle("threshold_cell = 0.01\n", elastic), "solver.threshold_cell ");
  EXPECT_EQ(idle("threshold_cell = 0.01\n", sand), "solver.threshold_cell ");
  EXPECT_EQ(idle("threshold_cell = 0.01\n", "model = \"cam_clay\"\n"), "");
}

/// Free flight at dt = 1e-6 moved particles by 0 to twice v t, and gravity added nothing at 1e-8.
TEST(Findings, StepsTooShortForSinglePrecisionAreFound) {
  const auto findings = [](const std::string& solver, const std::string& material,
                           const std::string& velocity) {
    const scene::Scene scene = scene::read_scene_text(
        "frames = 4\n[solver]\n" + solver + "[material.snow]\n" + material +
            "[[body]]\nshape = { sphere = { center = [0, 0.4, 0], radius = 0.06 } }\nvelocity = " +
            velocity + "\n",
        "short.toml");
    std::vector<health::Finding> found;
    health::check_rounding(scene, found);
    return found;
  };
  const std::string flight = "cell_size = 0.05\ngravity = [0, 0, 0]\ntime_step = \"fixed\"\n",
                    slow = "[0.0015, -0.0008, 0.003]";
  EXPECT_TRUE(findings(flight + "dt = 1e-4\n", "", slow).empty());
  EXPECT_TRUE(findings(flight + "dt = 1e-6\nprecision = \"double\"\n", "", slow).empty());
  const auto lost = findings(flight + "dt = 1e-6\n", "", slow);
  ASSERT_EQ(lost.size(), 1u);
  EXPECT_EQ(health::sentence(lost[0]),
            "solver.precision: steps of 1e-06 s are so short that single precision does not move "
            "snow slower than 0.0015 m/s, and moves snow at 0.00345 m/s by up to 44 % too much or "
            "too little; solver.precision = \"double\", or longer steps: solver.dt = 4.35e-05");
  const std::string ice = "model = \"corotated\"\nyoungs_modulus = 9e9\ndensity = 917\n";
  EXPECT_TRUE(findings("", ice, "[0, -3, 0]").empty()) << "steps of 3e-6 s";
  const auto falls = findings("time_step = \"fixed\"\ndt = 1e-8\n", ice, "[0, -3, 0]");
  ASSERT_EQ(falls.size(), 2u);
  EXPECT_NE(falls[1].what.find("adds 9.81e-08 m/s of gravity to speeds of "), std::string::npos)
      << falls[1].what;
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
