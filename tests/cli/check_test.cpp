/// `neve check`: what a scene will cost, and what looks wrong in it.

#include <cmath>

#include "app/output/atomic_file.h"
#include "render/image/image.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

/// A ball of about 2000 particles and whatever a test adds or changes.
std::string scene(const std::string& solver, const std::string& more = {}, int frames = 2) {
  return "frames = " + std::to_string(frames) + "\n[solver]\ncell_size = 0.02\n" + solver +
         "\n[[body]]\nname = \"ball\"\n"
         "shape = { sphere = { center = [0, 0.2, 0], radius = 0.08 } }\n"
         "velocity = [0, -3, 0]\n" +
         more;
}

constexpr const char* floor_plane =
    "[[collider]]\nname = \"floor\"\n"
    "shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }\n";

class Check : public Cli {
 protected:
  /// Severity and address of all findings but notes.
  std::vector<std::string> findings(const std::string& text, int exit_code = 0) {
    folder.write("scene.toml", text);
    const auto result = neve({"check", "scene.toml", "--json"});
    EXPECT_EQ(result.exit_code, exit_code) << result.errors;
    std::vector<std::string> found;
    const app::Json json = app::parse_json(std::string_view(result.output));
    for (const app::Json& finding : json["findings"])
      if (finding["severity"] != "note")
        found.push_back(finding["severity"].get<std::string>() + " " +
                        finding["address"].get<std::string>());
    return found;
  }
  using Findings = std::vector<std::string>;
};

TEST_F(Check, AHealthySceneHasNoWarning) {
  EXPECT_EQ(findings(scene("", floor_plane)), Findings{});
}

/// A check draws nothing, so that only the run has no memory for the pictures.
TEST_F(Check, ASceneWhosePicturesAreTooLargeIsCheckedAndToldTheirSize) {
  folder.write("scene.toml", scene("", std::string(floor_plane) + "[limits]\nmemory = \"50MB\"\n"));
  const auto refused = neve({"check", "scene.toml"});
  EXPECT_EQ(refused.exit_code, 8) << refused.errors;
  EXPECT_TRUE(contains(refused.output, "first step")) << refused.output;
  EXPECT_FALSE(contains(refused.output, "too large for a check")) << refused.output;
  EXPECT_TRUE(contains(refused.errors, "draw smaller ones with output.size")) << refused.errors;
  EXPECT_EQ(neve({"check", "scene.toml", "--set", "output.size=[320, 180]"}).exit_code, 0);
  const auto snow = neve({"check", "scene.toml", "--set", "limits.memory=1MB"});
  EXPECT_TRUE(contains(snow.output, "try neve check with --coarsen ")) << snow.output;
}

TEST_F(Check, SnowInLessThanACellHasNoNumberPerCell) {
  folder.write("scene.toml", scene("", floor_plane));
  const auto done = neve({"check", "scene.toml", "--set", "solver.cell_size=60"});
  EXPECT_TRUE(contains(done.output, "in less than a cell of 60 m\n")) << done.output;
}

TEST_F(Check, AMosaicOfTransparentViewsIsOpaque) {
  folder.write("scene.toml",
               scene("", std::string(floor_plane) + "[[view]]\nname = \"a\"\n"
                                                    "[[mosaic]]\nname = \"m\"\nviews = [\"a\"]\n"
                                                    "[output]\nbackground = \"transparent\"\n"));
  const auto done = neve({"check", "scene.toml"});
  EXPECT_TRUE(contains(done.output, "note: mosaic.m: is opaque")) << done.output;
  EXPECT_FALSE(contains(neve({"check", "scene.toml", "--set", "output.background=gradient"}).output,
                        "mosaic.m"));
}

/// A cube from `low` of edge 0.1 in an OBJ of several.
std::string cube_text(double low, double edge = 0.1, bool is_inward = false) {
  std::string text;
  for (int k = 0; k < 8; ++k) {
    text += "v";
    for (const int side : {k % 4 == 1 || k % 4 == 2, k % 4 > 1, k > 3})
      text += " " + std::to_string(low + edge * side);
    text += "\n";
  }
  return text + (is_inward ? "f -8 -7 -6 -5\nf -1 -2 -3 -4\nf -4 -3 -7 -8\nf -3 -2 -6 -7\n"
                             "f -2 -1 -5 -6\nf -1 -4 -8 -5\n"
                           : "f -8 -5 -6 -7\nf -4 -3 -2 -1\nf -8 -7 -3 -4\nf -7 -6 -2 -3\n"
                             "f -6 -5 -1 -2\nf -5 -8 -4 -1\n");
}

TEST_F(Check, MeshesThatAreNotPlainAreSaidByCheckAndByTheRun) {
  const auto said = [&](const std::string& mesh, const std::string& more = {}) {
    folder.write("m.obj", mesh);
    folder.write("mesh.toml",
                 "frames = 1\n[solver]\ncell_size = 0.02\n[[body]]\nname = \"rock\"\n"
                 "shape = { mesh = { file = \"m.obj\"" +
                     more + " } }\n" + floor_plane);
    const auto check = neve({"check", "mesh.toml"});
    EXPECT_EQ(check.exit_code, 0) << check.errors;
    const auto run = neve({"render", "mesh.toml", "--frames", "0-0", "--size", "160x90",
                           "--no-movie", "--out", "run", "--replace"});
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    const std::string warnings = json_of("run/run.json")["warnings"].dump();
    EXPECT_TRUE(contains(check.output + check.errors, "body.rock.shape.mesh")) << check.output;
    return warnings;
  };
  const auto expect = [&](const std::string& warnings, const std::string& part) {
    EXPECT_TRUE(contains(warnings, part)) << warnings;
  };
  expect(said(cube_text(0) + cube_text(0.05)), "parts of rock cross: 6.7 % of its volume");
  EXPECT_NEAR(json_of("run/run.json")["frames"][0]["mass"].get<double>(), 400 * (2e-3 - 0.125e-3),
              1e-3);
  expect(said(cube_text(0) + cube_text(0.2, 0.1, true)),
         "1 of the 2 parts of rock is wound inward and read outward");
  expect(said(cube_text(0) + cube_text(0.02, 0.05)), "1 part of rock is in another one");
  expect(said(cube_text(0) + cube_text(0.02, 0.05), ", fill = \"even_odd\""), "1 cavity");
  const std::string open = cube_text(0);
  expect(said(open.substr(0, open.rfind("f "))), "filled by winding numbers, with 4 open edges");
  EXPECT_EQ(neve({"check", "mesh.toml", "--open-edges", "holes.png"}).exit_code, 0);
  EXPECT_TRUE(contains(neve({"info", "holes.png"}).output, "the open meshes of a scene\n"));
  const render::Image holes = render::decode_png(app::output::read_file(folder / "holes.png"));
  int red = 0;
  for (std::size_t i = 0; i + 2 < holes.pixels.size(); i += 3)
    red += holes.pixels[i] > 150 && holes.pixels[i + 1] < 100;
  EXPECT_GT(red, 500) << "four edges of a cube that fills the picture, 3 pixels wide";
}

TEST_F(Check, CheckNamesEachMistake) {
  EXPECT_EQ(findings(scene("time_step = \"fixed\"\ndt = 2e-3", floor_plane), 9).at(0),
            "error solver.dt");
  EXPECT_EQ(findings(scene("time_step = \"fixed\"\ndt = 5e-4", floor_plane)),
            Findings{"warning solver.dt"});
  const auto with_floor = [&](const std::string& solver, const std::string& more) {
    return findings(scene(solver, floor_plane + more));
  };
  EXPECT_EQ(with_floor("flip_reference_dt = 0", ""), Findings{"warning solver.flip_reference_dt"});
  EXPECT_EQ(with_floor("", "[material.snow]\ndensity = 0.4\n"),
            Findings{"warning material.snow.density"});
  EXPECT_EQ(findings(scene("", "[material.snow]\nyoungs_modulus = 140\n")).at(0),
            "warning material.snow.youngs_modulus");
  EXPECT_EQ(findings(scene("gravity = [0, -981, 0]")).at(0), "warning solver.gravity");
  EXPECT_EQ(findings(scene("", std::string(floor_plane) +
                                   "[[collider]]\nname = \"sheet\"\nshape = { box = { center = "
                                   "[0, 0, 0.5], size = [1, 1, 0.02] } }\n")),
            Findings{"warning collider.sheet.shape"});
  // The box around this rod is thick every way, the rod is not.
  EXPECT_EQ(
      findings(scene("", std::string(floor_plane) +
                             "[[collider]]\nname = \"rod\"\nshape = { capsule = { a = [0.5, 0, "
                             "0.3], b = [0.8, 0.3, 0.6], radius = 0.01 } }\n")),
      Findings{"warning collider.rod.shape"});
  EXPECT_EQ(findings(scene("", std::string(floor_plane) +
                                   "[[emitter]]\nname = \"well\"\nrate = 1\nshape = { box = { "
                                   "center = [0, -0.1, 0], size = [0.2, 0.16, 0.2] } }\n"))
                .at(0),
            "warning emitter.well.shape");
  const auto ram_to = [](const std::string& y) {
    return std::string(floor_plane) +
           "[[collider]]\nname = \"ram\"\nshape = { box = { center = [1, 1, 1], size = [0.2, 0.2, "
           "0.2] } }\n"
           "keyframes = [{ time = 0 }, { time = 0.05, position = [1, " +
           y + ", 1] }]\n";
  };
  EXPECT_EQ(findings(scene("time_step = \"fixed\"\ndt = 5e-4", ram_to("2.2"))),
            (Findings{"warning solver.dt", "warning collider.ram.keyframes"}));
  // Adaptive steps are short enough.
  EXPECT_EQ(findings(scene("", ram_to("1.8"))), Findings{});
  EXPECT_EQ(findings(scene("",
                           "[[body]]\nname = \"other\"\nshape = { sphere = { center = [0.05, "
                           "0.2, 0], radius = 0.08 } }\nvelocity = [0, -3, 0]\n"))
                .at(0),
            "warning body.other.shape");
  EXPECT_EQ(findings(scene("",
                           "[[collider]]\nname = \"floor\"\nshape = { plane = { point = [0, "
                           "0.15, 0], normal = [0, 1, 0] } }\n"))
                .at(0),
            "warning body.ball.shape");
  EXPECT_EQ(findings(scene("", std::string(floor_plane) +
                                   "[camera]\neye = [0, 0.2, 1]\ntarget = [1, 0.2, 1]\n")),
            Findings{"warning camera"});
}

/// A frame of it would take 1e13 steps: the forecast is made from the first of them.
/// Found by random scenes: 206 said nothing, and snow that bursts took two million steps.
TEST_F(Check, AdaptiveStepsThatCannotHoldAreAnError) {
  EXPECT_EQ(findings(scene("acoustic_cfl = 20\nmax_dt = 0.01", floor_plane), 9).at(0),
            "error solver.acoustic_cfl");
  // The value that --fast sets is no finding.
  EXPECT_EQ(findings(scene("acoustic_cfl = 0.85", floor_plane)), Findings{});
  // The limit is a number of cells, whatever their size.
  folder.write("scene.toml", scene("acoustic_cfl = 20\nmax_dt = 0.01", floor_plane));
  const auto coarse = neve({"check", "scene.toml", "--coarsen", "2"});
  EXPECT_TRUE(contains(coarse.output, "solver.acoustic_cfl = 0.5 holds")) << coarse.output;
}

/// An emitter has no particle yet when it is checked: its snow is as stiff as that of a body. Sound
/// in new snow of the paper has 19.72 m/s, and e^(xi (1 - J_P) / 2) times that at another J_P.
TEST_F(Check, SoundInEmittedSnowKnowsHowItIsPacked) {
  for (const double J_P : {0.8, 1.0, 1.5}) {
    folder.write("scene.toml",
                 "frames = 1\n[solver]\ncell_size = 0.04\n[[emitter]]\nrate = 4\nJ_P = " +
                     std::to_string(J_P) +
                     "\nvelocity = [0, -8, 0]\nshape = { box = { center = [0, 0.5, 0], size = "
                     "[0.16, 0.16, 0.16] } }\n" +
                     floor_plane);
    const auto check = neve({"check", "scene.toml", "--json"});
    ASSERT_EQ(check.exit_code, 0) << check.errors;
    const app::Json json = app::parse_json(std::string_view(check.output));
    EXPECT_NEAR(json["sound_speed"].get<double>() / (19.7203 * std::exp(5 * (1 - J_P))), 1, 1e-4);
  }
}

TEST_F(Check, SnowFarSmallerThanACellIsForetoldInSeconds) {
  const auto check =
      neve({"check", "scene.toml", "--json", "--set", "body.ball.shape.sphere.radius=1e-9"});
  ASSERT_EQ(check.exit_code, 0) << check.errors;
  const app::Json json = app::parse_json(std::string_view(check.output));
  EXPECT_GT(json["steps"].get<double>(), 1e9);
  EXPECT_TRUE(contains(check.output, "cells thick")) << check.output;
}

TEST_F(Check, CheckNamesParametersWithoutEffect) {
  const auto with = [&](const std::string& more) {
    return findings(scene("", floor_plane + more));
  };
  EXPECT_EQ(findings(scene("dt = 1e-4", floor_plane)), Findings{"warning solver.dt"});
  EXPECT_EQ(findings(scene("beta = 1\ncollide_after_solve = true", floor_plane)),
            Findings{"warning solver.collide_after_solve"});
  EXPECT_EQ(
      findings(scene("beta = 1\ncontact_at = \"nodes\"\ncollide_after_solve = true", floor_plane)),
      Findings{});
  EXPECT_EQ(with("[[sink]]\nshape = { box = { center = [0, 0.2, 0], size = [1, 1, 1] } }\n").at(0),
            "warning body.ball.shape");
  EXPECT_EQ(with("[[emitter]]\nshape = { box = { center = [1, 0.5, 0], size = [0.1, 0.1, 0.1] } }\n"
                 "[[sink]]\nshape = { box = { center = [1.5, 0.5, 0], size = [1, 1, 1] } }\n"),
            Findings{"warning emitter.1.shape"});
  EXPECT_EQ(with("[[collider]]\nname = \"lid\"\nshape = { box = { center = [1, 1, 1], size = [0.2, "
                 "0.2, 0.2] } }\n"
                 "keyframes = [{ time = 0 }, { time = 9, position = [1, 1.2, 1] }]\n"),
            Findings{"warning collider.lid.keyframes"});
  EXPECT_EQ(with("[[view]]\nname = \"side\"\n[view.slice]\nisolines = 6\n"),
            Findings{"warning view.side.slice"});
  EXPECT_EQ(with("[[view]]\nname = \"slice\"\n[view.slice]\nisolines = 6\n"), Findings{});
  EXPECT_EQ(findings(scene("transfer = \"aflip\"\nadvect = \"pic\"", floor_plane)),
            Findings{"warning solver.advect"});
  EXPECT_EQ(findings(scene("transfer = \"aflip\"\nseparation_max = 0.5", floor_plane)),
            Findings{"warning solver.separation_max"});
  EXPECT_EQ(findings(scene("transfer = \"apic\"\nseparation_min = 0.5\nseparation_J_E = 0.99",
                           floor_plane)),
            (Findings{"warning solver.separation_min", "warning solver.separation_J_E"}));
  EXPECT_EQ(findings(scene("transfer = \"asflip\"\nseparation_min = 0.5\nseparation_max = 0.9\n"
                           "separation_J_E = 0.99",
                           floor_plane)),
            Findings{});
}

TEST_F(Check, CheckSaysThatFlipStopsSpinAndWhatKeepsIt) {
  const auto said = [&](const std::string& solver, const std::string& spin) {
    folder.write("scene.toml", scene(solver, floor_plane));
    const auto result =
        neve({"check", "scene.toml", "--set", "body.ball.angular_velocity=" + spin});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return result.output;
  };
  const std::string flip = said("transfer = \"flip\"", "[0,0,8]");
  EXPECT_TRUE(contains(flip, "FLIP halves its spin every")) << flip;
  EXPECT_TRUE(contains(flip, "solver.transfer = \"asflip\" or \"aflip\" keeps it")) << flip;
  EXPECT_FALSE(contains(said("transfer = \"flip\"", "[0,0,0]"), "spin"));
  EXPECT_FALSE(contains(said("", "[0,0,8]"), "spin"));
  EXPECT_FALSE(contains(said("transfer = \"flip\"\nflip_ratio = 1", "[0,0,8]"), "spin"));
  const std::string damped = said("transfer = \"flip\"\nflip_ratio = 0.9", "[0,0,0]");
  EXPECT_TRUE(contains(damped, "pieces a few cells across stop turning")) << damped;
  EXPECT_TRUE(contains(damped, "transfer = \"asflip\" or \"aflip\" keeps them turning")) << damped;
  EXPECT_FALSE(contains(said("flip_ratio = 0.9\ntransfer = \"aflip\"", "[0,0,0]"), "stop turning"));
}

TEST_F(Check, CheckSaysThatThePapersTransferMovesSnowByWhatDoesNotStrainIt) {
  const auto is_said = [&](const std::string& solver) {
    folder.write("scene.toml", scene(solver, floor_plane));
    const auto result = neve({"check", "scene.toml"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return contains(result.output, "flip moves particles by a velocity that does not strain them");
  };
  EXPECT_TRUE(is_said("transfer = \"flip\""));
  EXPECT_FALSE(is_said("transfer = \"flip\"\nadvect = \"pic\""));
  EXPECT_FALSE(is_said("transfer = \"flip\"\nflip_ratio = 0"));  // PIC
  EXPECT_FALSE(is_said(""));
}

TEST_F(Check, CheckFindsSnowThatMeetsNothing) {
  EXPECT_EQ(findings(scene("", "", 6)), Findings{"warning body.ball"});
  // A ball that meets nothing is not crushed.
  folder.write("scene.toml", scene("", "", 6));
  EXPECT_FALSE(contains(
      neve({"check", "scene.toml", "--set", "body.ball.velocity=[0, -25, 0]"}).output, "crush"));
  // The speed of a fall is not that of snow which the air slows down.
  EXPECT_TRUE(contains(neve({"check", "scene.toml"}).output, "m/s when the scene ends"));
  const auto slowed = neve({"check", "scene.toml", "--set", "dust.spray_drag=0.5"});
  EXPECT_TRUE(contains(slowed.output, "it flies freely until the scene ends")) << slowed.output;
  EXPECT_FALSE(contains(slowed.output, "m/s when the scene ends")) << slowed.output;
  const std::string wall =
      "[[collider]]\nname = \"wall\"\nshape = { box = { center = [0.3, 0, 0], size = [0.1, 0.6, "
      "0.6] } }\n";
  EXPECT_EQ(findings(scene("", wall, 6)), Findings{"warning body.ball"});
  const auto text = neve({"check", "scene.toml"});
  EXPECT_TRUE(contains(text.output, "nearest is wall, 0.177 m away at 0 s")) << text.output;
  EXPECT_EQ(findings(scene("", wall, 6), 0).size(), 1u);
  // A ball that is thrown at the wall meets it.
  folder.write("scene.toml", scene("", wall, 6));
  EXPECT_FALSE(
      contains(neve({"check", "scene.toml", "--set", "body.ball.velocity=[3, 1, 0]"}).output,
               "meets nothing"));
  // A ball that only meets the other one, which rests on the floor, and one that flies over it.
  const std::string pile = floor_plane + std::string(
                                             "[[body]]\nname = \"pile\"\nshape = { cone = { center "
                                             "= [1, 0.1, 0], radius = 0.2, height = "
                                             "0.2 } }\n");
  folder.write("scene.toml", scene("", pile, 6));
  const std::vector<std::string> flat{"check", "scene.toml", "--set",
                                      "body.ball.velocity=[9, 0, 0]"};
  EXPECT_FALSE(contains(neve(flat).output, "meets nothing"));
  const std::vector<std::string> high{"check", "scene.toml", "--set",
                                      "body.ball.velocity=[9, 5, 0]"};
  EXPECT_TRUE(contains(neve(high).output,
                       "ball meets nothing until the scene ends, at 0.25 s; "
                       "nearest is"));
  // A ball that a sink takes on its way does not fly until the end.
  folder.write("scene.toml",
               scene("",
                     pile + "[[sink]]\nname = \"drain\"\nshape = { box = { center = [1.5, 1, "
                            "0], size = [0.5, 3, 3] } }\n",
                     6));
  EXPECT_FALSE(contains(neve(high).output, "meets nothing"));
  folder.write("scene.toml", scene("", pile, 6));
  // neve render says it too, before it starts.
  const auto render = neve({"render", "scene.toml", "--set", "body.ball.velocity=[9, 5, 0]",
                            "--frames", "0", "--size", "64x36"});
  EXPECT_TRUE(contains(render.errors, "ball meets nothing")) << render.errors;
  EXPECT_EQ(json_of("out/scene/run.json")["warnings"].size(), 1u);
}

TEST_F(Check, SnowThatFallsFollowsTheCurveOfGravity) {
  // 0.32 m above the floor for 0.5 s: gravity takes it there in 0.26 s, that of the first frame
  // alone 0.2 m far.
  const auto meets_nothing = [&](const char* keyframes) {
    folder.write("scene.toml", scene("", floor_plane, 12) +
                                   "[[curve]]\nname = \"g\"\nparameter = \"solver.gravity\"\n"
                                   "interpolation = \"step\"\nkeyframes = [" +
                                   keyframes + "]\n");
    const auto done = neve({"check", "scene.toml", "--set", "body.ball.velocity=[0, 0, 0]", "--set",
                            "body.ball.shape.sphere.center=[0, 0.4, 0]"});
    EXPECT_TRUE(contains(done.output, "particles")) << done.errors;
    return contains(done.output, "ball meets nothing");
  };
  EXPECT_FALSE(
      meets_nothing("{ time = 0, vector = [0, 0, 0] }, { time = 0.1, vector = [0, -9.81, 0] }"));
  EXPECT_TRUE(
      meets_nothing("{ time = 0, vector = [0, -9.81, 0] }, { time = 0.03, vector = [0, 0, 0] }"));
}

TEST_F(Check, CheckFindsGravityThatIsNotDown) {
  EXPECT_EQ(findings(scene("gravity = [0, 0, -9.81]", floor_plane)).at(0),
            "warning solver.gravity");
  EXPECT_EQ(findings(scene("gravity = [0, 9.81, 0]", "")).at(0), "warning solver.gravity");
  EXPECT_EQ(findings(scene("gravity = [0, -9.81, 0]", floor_plane)), Findings{});
  // A slope, and a scene that says where up is.
  EXPECT_EQ(findings(scene("gravity = [5, -8.4, 0]", floor_plane)), Findings{});
  EXPECT_EQ(findings(scene("gravity = [0, 0, -9.81]",
                           "[camera]\nup = [0, 0, 1]\n[[collider]]\nname = \"floor\"\nshape = { "
                           "plane = { point = [0, 0, 0], normal = [0, 0, 1] } }\n"))
                .size(),
            1u);  // of the ball in the floor
}

TEST_F(Check, CheckFindsSnowThatIsASpeckInThePicture) {
  const auto with_eye = [&](const char* eye) {
    return findings(scene(
        "", std::string(floor_plane) + "[camera]\ntarget = [0, 0.1, 0]\neye = " + eye + "\n"));
  };
  EXPECT_EQ(with_eye("[0, 0.1, 1]"), Findings{});
  EXPECT_EQ(with_eye("[0, 0.1, 100]"), Findings{"warning camera"});
}

/// A layer of the places that it is asked at lay in the surface, and counted as outside.
TEST_F(Check, HalfOfABallOnAPlaneIsInsideIt) {
  const auto result =
      neve({"check", "scene.toml", "-q", "--set",
            "collider.rock={ shape = { sphere = { center = [2, 0, 0], radius = 0.1 } }, density = "
            "900 }"});
  EXPECT_TRUE(contains(result.output, "50 % of rock starts inside floor")) << result.output;
}

/// Ranges, dust and what softness is advised against knew of the ram; check said 1.7 m/s.
TEST_F(Check, ARamThatHitsSnowIsAnImpact) {
  const auto result = neve({"check", "scene.toml", "--json", "--set",
                            "collider.ram={ shape = { box = { center = [2, 0.2, 0], size = "
                            "[0.2, 0.2, 0.2] } }, velocity = [-20, 0, 0] }"});
  EXPECT_NEAR(app::parse_json(std::string_view(result.output))["impact_speed"].get<double>(), 20,
              1e-9);
}

/// A floor is likelier turned upside down than snow is buried in it.
TEST_F(Check, AFloorWhoseNormalPointsDownIsTurnedRound) {
  const auto hint_of = [&](const std::string& normal, const std::string& center) {
    const auto result =
        neve({"check", "scene.toml", "-q", "--set", "collider.floor.shape.plane.normal=" + normal,
              "--set", "body.ball.shape.sphere.center=" + center});
    EXPECT_TRUE(contains(result.output, "100 % of ball starts inside collider floor"))
        << result.output;
    return result.output;
  };
  const std::string down = hint_of("[0,-1,0]", "[0, 0.12, 0]");
  EXPECT_TRUE(contains(down,
                       "its normal [0, -1, 0] points down, so its upper side is the solid "
                       "one; a floor has collider.floor.shape.plane.normal = [0, 1, 0]"))
      << down;
  EXPECT_FALSE(contains(down, "move it out")) << down;
  const std::string wall = hint_of("[1,0,0]", "[-0.5, 0.12, 0]");
  EXPECT_TRUE(contains(wall,
                       "turn it round, collider.floor.shape.plane.normal = [-1, 0, 0], or "
                       "move the snow"))
      << wall;
  EXPECT_TRUE(contains(hint_of("[0,1,0]", "[0, -0.5, 0]"), "move it out"));
}

/// Under --coarsen the number that is proposed is the one to type.
TEST_F(Check, AdviceIsInTheNumbersThatSetTakes) {
  // With this transfer snow hardens little after the step that diverged.
  folder.write("scene.toml", scene("transfer = \"flip\"", floor_plane));
  const std::vector<std::string> coarse{"--coarsen", "2", "--set", "solver.time_step=fixed"};
  const auto run = [&](const char* command, const std::string& dt) {
    std::vector<std::string> words{command, "scene.toml", "--set", "solver.dt=" + dt};
    words.insert(words.end(), coarse.begin(), coarse.end());
    if (std::string_view(command) == "render")
      for (const char* word : {"--size", "64x36", "--frames", "2", "--no-movie", "--replace"})
        words.emplace_back(word);
    return neve(words);
  };
  const auto advice_in = [](const std::string& text) {
    const std::string before = "solver.dt = ";
    const std::size_t at = text.rfind(before);
    EXPECT_NE(at, std::string::npos) << text;
    const std::string rest = text.substr(at + before.size());
    EXPECT_TRUE(contains(rest, "(--coarsen 2 makes it ")) << text;
    return rest.substr(0, rest.find(' '));
  };
  const auto diverged = run("render", "4e-3");
  ASSERT_EQ(diverged.exit_code, 5) << diverged.errors;
  const auto mended = run("render", advice_in(diverged.errors));
  EXPECT_EQ(mended.exit_code, 0) << mended.errors;
  EXPECT_FALSE(contains(mended.errors, "acoustic CFL")) << mended.errors;
  const auto check = run("check", "4e-3");
  EXPECT_EQ(check.exit_code, 9) << check.output;
  const auto fine = run("check", advice_in(check.output));
  EXPECT_FALSE(contains(fine.output, "fixed steps")) << fine.output;
  // Cells too.
  const auto thin = neve(
      {"check", "scene.toml", "--coarsen", "2", "--set", "body.ball.shape.sphere.radius=0.03"});
  EXPECT_TRUE(contains(thin.output, "solver.cell_size = 0.005 (--coarsen 2 makes it 0.01)"))
      << thin.output;
}

TEST_F(Check, CentimetresAreToldBeforeALimitSpeaks) {
  folder.write("cm.toml",
               "[solver]\ncell_size = 0.04\n[[body]]\nshape = { sphere = { center = [0, 30, 0], "
               "radius = 15 } }\n");
  for (const std::vector<std::string>& words : {std::vector<std::string>{"check", "cm.toml"},
                                                {"render", "cm.toml"},
                                                {"render", "cm.toml", "--dry-run"}}) {
    const auto result = neve(words);
    EXPECT_EQ(result.exit_code, 8) << result.errors;
    EXPECT_TRUE(contains(result.errors,
                         "the largest piece of snow is 30 m across: lengths are in "
                         "metres, and in centimetres it would be 0.3 m"))
        << result.errors;
    EXPECT_FALSE(contains(result.errors, "raise it")) << result.errors;
  }
}

TEST_F(Check, CheckJoinsEqualFindingsOfManyBodies) {
  std::string more = floor_plane;
  for (const char* x : {"0.5", "0.8", "1.1"})
    more += "[[body]]\nshape = { box = { center = [" + std::string(x) +
            ", 0.2, 0], size = [0.2, 0.2, 0.06] } }\nvelocity = [0, -3, 0]\n";
  EXPECT_EQ(findings(scene("", more)), Findings{"warning body.2.shape"});
  const auto text = neve({"check", "scene.toml"});
  EXPECT_TRUE(contains(text.output, "body 2 is 3 cells thick (also under 4: body 3, body 4);"))
      << text.output;
}

/// Two balls that touch nothing for a while: one crushed particle at the end of a frame rules a
/// few of its steps and not all of them.
TEST_F(Check, CheckForeseesTheFirstFrameToo) {
  const std::string file = std::string(NEVE_SOURCE_DIR) + "/scenes/two_snowballs.toml";
  const auto check = neve({"check", file, "--coarsen", "3", "--json"});
  ASSERT_EQ(check.exit_code, 0) << check.errors;
  const app::Json json = app::parse_json(std::string_view(check.output));
  const auto run = neve(
      {"render", file, "--coarsen", "3", "--frames", "0-1", "--size", "64x36", "--out", "out"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const double steps = json_of("out/run.json")["frames"][1]["steps"].get<double>();
  EXPECT_GT(json["frames"][0]["steps"].get<double>(), 0.5 * steps);
  EXPECT_LT(json["frames"][0]["steps"].get<double>(), 2 * steps);
}

/// The forecast comes from a coarse copy: the factor of two is what it claims, no more.
TEST_F(Check, CheckForeseesTheStepsOfTheRun) {
  folder.write("scene.toml", scene("", floor_plane, 6));
  const auto check = neve({"check", "scene.toml", "--json"});
  ASSERT_EQ(check.exit_code, 0) << check.errors;
  const app::Json json = app::parse_json(std::string_view(check.output));
  ASSERT_EQ(json["frames"].size(), 6u);
  const auto run = neve({"render", "scene.toml", "--size", "64x36", "--out", "out"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  double steps = 0;
  const app::Json record = json_of("out/run.json");
  for (const app::Json& frame : record["frames"]) steps += frame["steps"].get<double>();
  EXPECT_GT(json["dt_limits"]["acoustic"].get<double>(), 0);
  EXPECT_GT(json["seconds_per_frame"].get<double>(), 0);
  EXPECT_NEAR(json["steps_per_frame"].get<double>() * static_cast<double>(json["frames"].size()),
              json["steps"].get<double>(), 1e-6 * json["steps"].get<double>());
  EXPECT_TRUE(json["warnings"].is_array());
  EXPECT_GT(json["steps"].get<double>(), 0.5 * steps);
  EXPECT_LT(json["steps"].get<double>(), 2 * steps);
  EXPECT_LE(json["steps_range"][0].get<double>(), steps);
  EXPECT_GE(json["steps_range"][1].get<double>(), steps);
  EXPECT_LT(json["seconds_range"][0].get<double>(), json["seconds"].get<double>());
  EXPECT_GT(json["seconds_range"][1].get<double>(), json["seconds"].get<double>());
  EXPECT_GT(json["seconds_per_step"].get<double>(), 0);
  EXPECT_EQ(json["dt_limit"], "acoustic");
}

/// A scene too large to be looked at has no time that is known: null, and not 0 s.
TEST_F(Check, WhatIsNotKnownIsNull) {
  folder.write("scene.toml", scene("", floor_plane, 1));
  const auto check = neve({"check", "scene.toml", "--json", "--set", "solver.cell_size=0.0011"});
  const app::Json json = app::parse_json(std::string_view(check.output));
  for (const char* key : {"seconds", "seconds_range", "seconds_per_step", "seconds_per_frame"})
    EXPECT_TRUE(json[key].is_null()) << key << " " << json[key];
}

/// A ball that bursts: where its particles are few, and still share nodes, each costs as much as
/// many packed ones.
TEST_F(Check, CheckForeseesThatSprayIsDear) {
  const std::string burst =
      "frames = 12\n[solver]\ncell_size = 0.02\ngravity = [0, 0, 0]\n"
      "[[body]]\nname = \"ball\"\nmaterial = \"snow\"\n"
      "shape = { sphere = { center = [0, 1, 0], radius = 0.15 } }\nangular_velocity = [0, 120, "
      "0]\n";
  folder.write("burst.toml", burst);
  const app::Json spray =
      app::parse_json(std::string_view(neve({"check", "burst.toml", "--json"}).output));
  const app::Json still = app::parse_json(std::string_view(
      neve({"check", "burst.toml", "--json", "--set", "body.ball.angular_velocity=[0,0,0]"})
          .output));
  const auto dearest = [](const app::Json& json) {
    return json["seconds_range"][1].get<double>() / json["steps_range"][1].get<double>() /
           json["seconds_per_step"].get<double>();
  };
  // Nothing spreads: a step costs what the first one costs, or, as is always allowed for, twice
  // that.
  EXPECT_NEAR(dearest(still), 2, 0.4);
  EXPECT_GT(dearest(spray), 4);
}

/// Chance decides which particles an impact crushes: the range says what one of them would cost.
TEST_F(Check, CheckForeseesThatAHardImpactMayCrushAParticle) {
  const std::string ball =
      "frames = 12\n[solver]\ncell_size = 0.02\nshock_viscosity = "
      "0\n[material.snow]\nyoungs_modulus = 2e5\n"
      "critical_compression = 0.03\ncritical_stretch = 0.005\n[[body]]\nname = \"ball\"\n"
      "shape = { sphere = { center = [0, 0.6, 0], radius = 0.08 } }\nvelocity = [0, -14, 0]\n"
      "[[collider]]\nname = \"post\"\nshape = { sphere = { center = [0, 0.3, 0], radius = 0.05 } "
      "}\n"
      "[[collider]]\nname = \"floor\"\nshape = { plane = { point = [0, -3, 0] } }\n";
  folder.write("hit.toml", ball);
  const auto check_of = [&](const char* change) {
    return app::parse_json(
        std::string_view(neve({"check", "hit.toml", "--json", "--set", change}).output));
  };
  const auto notes = [](const app::Json& json) { return json["findings"].dump(); };
  const auto steps_of_busiest = [](const app::Json& json) {
    return json["steps_range"][1].get<double>() / json["steps"].get<double>();
  };
  const app::Json hard = check_of("seed=1");
  EXPECT_NE(notes(hard).find("may crush single particles"), std::string::npos) << notes(hard);
  EXPECT_GT(steps_of_busiest(hard), 3);
  const app::Json bounded = check_of("material.snow.max_hardening=5");
  EXPECT_EQ(notes(bounded).find("may crush"), std::string::npos) << notes(bounded);
  const app::Json slow = check_of("body.ball.velocity=[0,-3,0]");
  EXPECT_EQ(notes(slow).find("may crush"), std::string::npos) << notes(slow);
  EXPECT_LT(steps_of_busiest(slow), 5);
}

TEST_F(Check, CheckRefusesTheScenesThatRenderRefuses) {
  folder.write("scene.toml", scene("", "[limits]\nparticles = 10\n"));
  const auto refused = neve({"check", "scene.toml"});
  EXPECT_EQ(refused.exit_code, 8);
  EXPECT_TRUE(contains(refused.output, "particles"));
  folder.write("scene.toml", scene("", floor_plane));
  const auto text =
      neve({"check", "scene.toml", "--set", "solver.dt=2e-3", "--set", "solver.time_step=fixed"});
  EXPECT_EQ(text.exit_code, 9);
  EXPECT_TRUE(contains(text.output, "error: solver.dt: ")) << text.output;
  EXPECT_TRUE(contains(text.output, "adaptive")) << text.output;
  EXPECT_EQ(neve({"check", "nothing.toml"}).exit_code, 3);
}

TEST_F(Check, ARunAndItsPictureAreCheckedLikeTheirScene) {
  ASSERT_EQ(neve({"render", "scene.toml", "--no-movie", "--out", "a"}).exit_code, 0);
  const auto findings_of = [&](const std::string& origin) {
    const auto result = neve({"check", origin, "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return app::parse_json(std::string_view(result.output))["findings"];
  };
  EXPECT_EQ(findings_of("a"), findings_of("scene.toml"));
  EXPECT_EQ(findings_of("a/particles/0002.png"), findings_of("scene.toml"));
  const auto nothing = neve({"check", folder.path().string()});
  EXPECT_EQ(nothing.exit_code, 3) << nothing.errors;
  EXPECT_TRUE(contains(nothing.errors, "is a directory")) << nothing.errors;
}

}  // namespace
}  // namespace neve::test
