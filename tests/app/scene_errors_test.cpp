// Every kind of mistake in a scene file is reported at its line and column.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

std::string error_of(std::string_view text) {
  try {
    app::scene::read_scene_text(text, "s.toml");
  } catch (const app::scene::toml::SceneError& error) {
    return error.what();
  }
  return "no error";
}

std::string file_error_of(const std::string& file) {
  try {
    app::scene::read_scene_file(file);
  } catch (const app::scene::toml::SceneError& error) {
    return error.what();
  }
  return "no error";
}

/// A scene that is fine, to which the mistake is added from line 4 on.
std::string with_ball(const std::string& mistake) {
  return "[[body]]\nname = \"ball\"\nshape = { sphere = { radius = 0.1 } }\n" + mistake;
}

/// The mistake inside a body from line 2 on.
std::string in_body(const std::string& mistake) {
  return "[[body]]\n" + mistake;
}

TEST(SceneErrors, PartsOfAnErrorAreKept) {
  try {
    app::scene::read_scene_text("titel = 1", "s.toml");
    FAIL();
  } catch (const app::scene::toml::SceneError& error) {
    EXPECT_EQ(error.file, "s.toml");
    EXPECT_EQ(error.line, 1);
    EXPECT_EQ(error.column, 1);
    EXPECT_EQ(error.message, "unknown key \"titel\"");
    EXPECT_EQ(error.hint, "did you mean \"title\"?");
  }
}

TEST(SceneErrors, VariationThatLeavesNoVolumeIsRefused) {
  const auto with = [](const char* numbers) {
    return error_of(
        with_ball("[material.snow]\ncritical_compression = 0.2\n"
                  "variation = { thresholds = " +
                  std::string(numbers) + " }"));
  };
  EXPECT_EQ(with("0.6"), "no error");
  EXPECT_EQ(
      with("1"),
      "s.toml:6:28: error: thresholds = 1 gives some particles a critical_compression of 1.72: "
      "snow cannot be compressed to nothing; use thresholds below 0.653, or "
      "critical_compression below 0.116");
}

TEST(SceneErrors, UnknownKeysNameTheNearest) {
  EXPECT_EQ(error_of("frame = 3"),
            "s.toml:1:1: error: unknown key \"frame\"; did you mean \"frames\"?");
  EXPECT_EQ(error_of(with_ball("[material.snow]\nyoungs_modulos = 1")),
            "s.toml:5:1: error: unknown key \"youngs_modulos\" in [material.snow]; did you mean "
            "\"youngs_modulus\"?");
  EXPECT_EQ(error_of(in_body("  shape = { sphere = { center = [0,0,0], raduis = 1 } }")),
            "s.toml:2:42: error: unknown key \"raduis\" in [body.1.shape.sphere]; did you mean "
            "\"radius\"?");
  EXPECT_EQ(error_of("[[view]]\nparticles = { colour_by = \"id\" }"),
            "s.toml:2:15: error: unknown key \"colour_by\" in [view.1.particles]; did you mean "
            "\"color_by\"?");
}

TEST(SceneErrors, KeysInTheWrongTableNameTheRightOne) {
  EXPECT_EQ(error_of("gravity = [0, 0, 0]"),
            "s.toml:1:1: error: unknown key \"gravity\"; did you mean solver.gravity?");
}

TEST(SceneErrors, KeysOfTheTopSayThatTheyBelongThere) {
  EXPECT_EQ(error_of(with_ball("[light]\nframes = 5")),
            "s.toml:5:1: error: unknown key \"frames\" in [light]; it belongs at the top of the "
            "file, before the first [table]");
}

TEST(SceneErrors, WholeNumbersBeyondTheirBoundsAreNotRounded) {
  // 2^53 + 1, which is 2^53 as a double.
  for (const char* given : {"seed = 9007199254740993", "[limits]\nparticles = 9007199254740993"}) {
    const std::string error = error_of(given);
    EXPECT_NE(error.find("= 9007199254740993; expected"), std::string::npos) << error;
    EXPECT_NE(error.find("<= 9007199254740992"), std::string::npos) << error;
  }
  const std::string largest = "seed = 9007199254740992\n" + with_ball("");
  EXPECT_EQ(scene::read_scene_text(largest, "s.toml").seed, 9007199254740992u);
}

TEST(SceneErrors, NumbersBeyondDoublesAreTooLargeAndHaveNoUnit) {
  for (const char* number : {"1e400", "-1e400", "+2.5e999"}) {
    const std::string error = error_of(std::string("fps = ") + number);
    EXPECT_NE(error.find("the number is too large"), std::string::npos) << error;
    EXPECT_EQ(error.find("unit"), std::string::npos) << error;
  }
  const std::string unit = error_of("fps = 1e3m");
  EXPECT_NE(unit.find("numbers have no unit"), std::string::npos) << unit;
}

/// A key that every form or keyframe spells in its own way: what is expected here, or its name
/// here.
TEST(SceneErrors, HintsStayInTheirTable) {
  const std::string torus = error_of(in_body("shape = { torus = { radius = 1 } }"));
  EXPECT_NE(torus.find("expected \"center\", \"major_radius\""), std::string::npos) << torus;
  const std::string capsule = error_of(in_body("shape = { capsule = { center = [0, 0, 0] } }"));
  EXPECT_NE(capsule.find("expected \"a\", \"b\", \"radius\""), std::string::npos) << capsule;
  const std::string key =
      error_of(with_ball("[[collider]]\nshape = { box = { size = [0.2, 0.2, 0.2] } }\n"
                         "keyframes = [{ time = 0 }, { time = 1, center = [0, 1, 0] }]"));
  EXPECT_NE(key.find("[collider.1.keyframes[2]]; did you mean \"position\"?"), std::string::npos)
      << key;
  const std::string camera = error_of(with_ball("[camera]\nposition = [0, 1, 2]"));
  EXPECT_NE(camera.find("did you mean \"eye\"?"), std::string::npos) << camera;
  const std::string size = error_of(with_ball("[solver]\nh = 0.01"));
  EXPECT_NE(size.find("did you mean \"cell_size\"?"), std::string::npos) << size;
}

TEST(SceneErrors, BracketsAreExplained) {
  EXPECT_EQ(error_of(in_body("sphere = { radius = 1 }")),
            "s.toml:2:1: error: unknown key \"sphere\" in [body.1]; write shape = { sphere = { "
            "... } }");
  const std::string solver = error_of("[[solver]]\ncell_size = 0.1\n");
  EXPECT_NE(solver.find("solver is not a list; write [solver], with one pair of brackets"),
            std::string::npos)
      << solver;
  const std::string bodies = error_of("[[bodies]]\nname = \"a\"\n");
  EXPECT_NE(bodies.find("did you mean \"body\"?"), std::string::npos) << bodies;
}

TEST(SceneErrors, APresetIsNoMaterialAndASweepNoScene) {
  const std::string powder = error_of(with_ball("material = \"powder\""));
  EXPECT_NE(powder.find("add [material.powder] with preset = \"powder\""), std::string::npos)
      << powder;
  const std::string sweep = error_of("[sweep]\nscene = \"a.toml\"\n");
  EXPECT_NE(sweep.find("neve sweep s.toml makes its runs"), std::string::npos) << sweep;
}

TEST(SceneErrors, AMosaicMayNameBuiltInViews) {
  const std::string mosaic = error_of(with_ball("[[mosaic]]\nviews = [\"slce\"]"));
  EXPECT_NE(mosaic.find("did you mean \"slice\"?"), std::string::npos) << mosaic;
}

/// `log` made every run of a sweep fail, with advice that did not help.
TEST(SceneErrors, ViewsHaveNoNamesThatTheFolderOfARunNeeds) {
  for (const char* list : {"view", "mosaic"})
    for (const std::string name : {"checkpoint", "exports", "log", "states"}) {
      const std::string error =
          error_of(with_ball("[[" + std::string(list) + "]]\nname = \"" + name + "\""));
      EXPECT_NE(error.find("is the name of something else in the folder of a run"),
                std::string::npos)
          << error;
    }
}

TEST(SceneErrors, KeysOfOtherVersionsListTheKnownOnes) {
  EXPECT_EQ(error_of(with_ball("[light]\nbloom = 0.5")),
            "s.toml:5:1: error: unknown key \"bloom\" in [light]; expected \"direction\", "
            "\"intensity\" or \"ambient\"");
}

TEST(SceneErrors, RangesAreNamed) {
  EXPECT_EQ(error_of(with_ball("[material.snow]\npoisson_ratio = 0.62")),
            "s.toml:5:17: error: material.snow.poisson_ratio = 0.62; expected 0 <= value < 0.5");
  EXPECT_EQ(error_of("frames = -1"),
            "s.toml:1:10: error: frames = -1; expected 0 <= value <= 100000");
  EXPECT_EQ(error_of("[solver]\ngravity = [0, 0, 1e9]"),
            "s.toml:2:18: error: solver.gravity[2] = 1000000000; expected -1000000 <= value <= "
            "1000000");
  EXPECT_EQ(error_of(in_body("shape = { sphere = { radius = 0 } }")),
            "s.toml:2:31: error: body.1.shape.sphere.radius = 0; expected 0 < value <= 1000000");
  EXPECT_EQ(error_of("[output]\nsize = [640, 15]"),
            "s.toml:2:14: error: output.size[1] = 15; expected 16 <= value <= 1000000");
  EXPECT_EQ(error_of("seed = 9223372036854775807"),
            "s.toml:1:8: error: seed = 9223372036854775807; expected 0 <= value <= "
            "9007199254740992");
}

TEST(SceneErrors, ColumnsAfterAccentsAreRight) {
  EXPECT_EQ(error_of("[[body]]\nname = \"né\""),
            "s.toml:2:8: error: body.1.name = \"né\"; expected a name of 1 to 64 letters, digits, "
            "_ and -");
  EXPECT_EQ(error_of("camera = { up = \"é\", fov = 0 }"),
            "s.toml:1:17: error: camera.up = \"é\"; expected three numbers [x, y, z]");
  EXPECT_EQ(error_of("x = [\"éé\", \"é\", 1e999]"),
            "s.toml:1:22: error: cannot parse floating-point: '1e999' could not be interpreted as "
            "a value");
}

TEST(SceneErrors, NumbersAreFinite) {
  EXPECT_EQ(error_of("fps = nan"), "s.toml:1:7: error: fps = nan; expected a finite number");
  EXPECT_EQ(error_of("fps = inf"), "s.toml:1:7: error: fps = inf; expected a finite number");
  EXPECT_EQ(error_of("frames = -inf"),
            "s.toml:1:10: error: frames = -inf; expected a finite number");
  EXPECT_EQ(error_of("[solver]\ngravity = [0, nan, 0]"),
            "s.toml:2:15: error: solver.gravity[1] = nan; expected a finite number");
}

TEST(SceneErrors, TypesAreNamed) {
  EXPECT_EQ(error_of("frames = \"3\""),
            "s.toml:1:10: error: frames = \"3\"; expected a whole number; numbers have no quotes");
  EXPECT_EQ(error_of("frames = 48.5"),
            "s.toml:1:10: error: frames = 48.5; expected a whole number");
  EXPECT_EQ(error_of("fps = true"), "s.toml:1:7: error: fps = true; expected a number");
  EXPECT_EQ(error_of("title = 3"), "s.toml:1:9: error: title = 3; expected a string");
  EXPECT_EQ(error_of("title = 1979-05-27"), "s.toml:1:9: error: title = a date; expected a string");
  EXPECT_EQ(error_of("solver = 3"), "s.toml:1:10: error: solver = 3; expected a table");
  EXPECT_EQ(error_of("[solver]\ngravity = [0, 1]"),
            "s.toml:2:11: error: solver.gravity = [0, 1]; expected three numbers [x, y, z]");
  EXPECT_EQ(
      error_of("[solver]\ngravity = 9.81"),
      "s.toml:2:11: error: solver.gravity = 9.81; expected three numbers [x, y, z]; write [0, "
      "-9.81, 0]");
  EXPECT_EQ(error_of("[output]\nsize = [1, 2, 3]"),
            "s.toml:2:8: error: output.size = [1, 2, 3]; expected two whole numbers [width, "
            "height]");
  EXPECT_EQ(error_of("[limits]\nmemory = \"8 bananas\""),
            "s.toml:2:10: error: limits.memory = \"8 bananas\"; expected bytes, or a size such as "
            "\"8GiB\" or \"500MB\"");
  EXPECT_EQ(error_of("[[material]]\nname = \"snow\""),
            "s.toml:1:3: error: material is not a list; each has a table of its name, with one "
            "pair of brackets: [material.NAME]");
  EXPECT_EQ(error_of("body = [3]"), "s.toml:1:9: error: body.1 = 3; expected a table");
}

TEST(SceneErrors, ChoicesAreListed) {
  EXPECT_EQ(error_of("[solver]\nkernel = \"cubik\""),
            "s.toml:2:10: error: solver.kernel = \"cubik\"; expected \"cubic\" or \"quadratic\"; "
            "did you mean \"cubic\"?");
  EXPECT_EQ(error_of("[solver]\nkernel = 3"),
            "s.toml:2:10: error: solver.kernel = 3; expected \"cubic\" or \"quadratic\"");
  const std::string layer = error_of("[[view]]\nlayers = [\"ground\", \"drizzle\"]");
  EXPECT_TRUE(
      layer.starts_with("s.toml:2:21: error: view.1.layers[1] = \"drizzle\"; expected \"ground\", "
                        "\"colliders\", \"particles\", "))
      << layer;
  EXPECT_TRUE(layer.ends_with(", \"dust\" or \"extremes\"")) << layer;
  EXPECT_EQ(error_of("[[view]]\nlayers = [\"ground\", \"ground\"]"),
            "s.toml:2:21: error: view.1.layers[1] = \"ground\"; expected each at most once");
}

TEST(SceneErrors, NamesAreUnique) {
  const std::string ball = "[[body]]\nname = \"x\"\nshape = { box = { size = [0.2, 0.2, 0.2] } }\n";
  EXPECT_EQ(error_of(ball + ball),
            "s.toml:5:8: error: duplicate body name \"x\"; names must be unique");
  EXPECT_EQ(
      error_of("[[body]]\nshape = { box = { size = [0.2, 0.2, 0.2] } }\n[[body]]\nname = \"1\""),
      "s.toml:4:8: error: duplicate body name \"1\"; the unnamed one has its number for a name");
  EXPECT_EQ(
      error_of("[[view]]\nname = \"2\"\n[[view]]"),
      "s.toml:2:8: error: duplicate view name \"2\"; the unnamed one has its number for a name");
  EXPECT_EQ(error_of("[material.\"a b\"]"),
            "s.toml:1:11: error: bad material name \"a b\"; expected 1 to 64 letters, digits, _ "
            "and -");
}

TEST(SceneErrors, ListsNeedTwoBracketsAndMaterialsAName) {
  EXPECT_EQ(error_of("[body]\nshape = {}"),
            "s.toml:1:2: error: \"body\" is a list; write [[body]], with two brackets");
  EXPECT_EQ(error_of("[material]\ndensity = 1"),
            "s.toml:2:1: error: unknown key \"density\" in [material]; each material has a name: "
            "[material.NAME]");
}

TEST(SceneErrors, MaterialsOfBodiesExist) {
  EXPECT_EQ(error_of(with_ball("material = \"snw\"")),
            "s.toml:4:12: error: there is no material \"snw\"; did you mean \"snow\"?");
  EXPECT_EQ(error_of(with_ball("material = \"gravel\"\n[material.ice]")),
            "s.toml:4:12: error: there is no material \"gravel\"; expected \"snow\" or \"ice\"");
}

TEST(SceneErrors, AShapeHasExactlyOneForm) {
  const std::string example =
      "; for example shape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } }";
  EXPECT_EQ(error_of("\n[[body]]\nname = \"a\""),
            "s.toml:2:1: error: body.a has no shape" + example);
  EXPECT_EQ(error_of(in_body("shape = {}")),
            "s.toml:2:9: error: body.1.shape is empty; expected \"sphere\", \"box\", \"capsule\", "
            "\"cylinder\", \"cone\", \"torus\", \"mesh\", \"points\" or \"cover\"");
  EXPECT_EQ(error_of(in_body("shape = { sphere = {}, box = {} }")),
            "s.toml:2:24: error: body.1.shape has two forms, \"sphere\" and \"box\"; expected "
            "exactly one");
  EXPECT_EQ(error_of(in_body("shape = { spere = {} }")),
            "s.toml:2:11: error: unsupported shape \"spere\" in body.1.shape; did you mean "
            "\"sphere\"?");
  EXPECT_EQ(error_of(in_body("shape = { box = {}, rotation = [0, 0, 45] }")),
            "s.toml:2:21: error: \"rotation\" is outside the shape in body.1.shape; write it "
            "inside the braces of the shape: { box = { ..., rotation = ... } }");
  EXPECT_EQ(
      error_of(in_body("shape = { plane = {} }")),
      "s.toml:2:11: error: unsupported shape \"plane\" in body.1.shape; only colliders can be "
      "planes: use a large box");
  EXPECT_EQ(error_of(in_body("shape = { cube = {} }")),
            "s.toml:2:11: error: unsupported shape \"cube\" in body.1.shape; did you mean "
            "\"box\"?");
  EXPECT_EQ(error_of(with_ball("[[collider]]\nshape = { pyramid = {} }")),
            "s.toml:5:11: error: unsupported shape \"pyramid\" in collider.1.shape; expected "
            "\"plane\", \"sphere\", \"box\", \"capsule\", \"cylinder\", \"cone\", \"torus\", "
            "\"mesh\", \"mesh_sequence\" or \"terrain\"");
}

TEST(SceneErrors, ShapesWithoutASizeAreRefused) {
  EXPECT_EQ(
      error_of(in_body("shape = { sphere = { center = [0, 1, 0] } }")),
      "s.toml:2:20: error: body.1.shape.sphere has no radius; expected radius (Radius, in m), "
      "for example radius = 0.1");
  EXPECT_EQ(error_of(with_ball("[[collider]]\nname = \"wall\"\nshape = { box = {} }")),
            "s.toml:6:17: error: collider.wall.shape.box has no size; expected size (Edge lengths, "
            "in m), for example size = [0.2, 0.2, 0.2]");
  for (const char* shape :
       {"capsule = { a = [0, 0, 0], b = [0, 1, 0] }", "capsule = { a = [0, 0, 0], radius = 1 }",
        "cylinder = { radius = 1 }", "cone = { height = 1 }", "torus = { major_radius = 1 }"}) {
    const std::string said = error_of(in_body("shape = { " + std::string(shape) + " }"));
    EXPECT_NE(said.find(" has no "), std::string::npos) << shape << ": " << said;
  }
  // A size given on the command line is enough.
  const std::string text = in_body("shape = { sphere = {} }");
  const app::scene::Scene scene = app::scene::read_scene_text(
      text, "s.toml", {}, {app::scene::parse_override("body.1.shape.sphere.radius=0.3")});
  EXPECT_EQ(std::get<sim::shapes::Sphere>(scene.bodies[0].shape.form).radius, 0.3);
}

TEST(SceneErrors, DegenerateShapesAreRefused) {
  EXPECT_EQ(error_of(in_body("shape = { torus = { minor_radius = 0.2, major_radius = 0.15 } }")),
            "s.toml:2:36: error: minor_radius is larger than major_radius; a tube thicker than its "
            "ring overlaps itself");
  EXPECT_EQ(error_of(with_ball("[[collider]]\nshape = { plane = { normal = [0, 0, 0] } }")),
            "s.toml:5:30: error: normal is zero; it must point out of the solid side");
  EXPECT_EQ(error_of(in_body("shape = { mesh = { scale = 2 } }")),
            "s.toml:2:18: error: mesh has no file; give file = \"NAME.obj\", .ply or .stl");
  EXPECT_EQ(error_of(with_ball("[[collider]]\nshape = { mesh_sequence = { last = 9 } }")),
            "s.toml:5:27: error: mesh_sequence has no files; give files = \"NAME_%04d.obj\"");
  EXPECT_EQ(error_of(in_body("shape = { points = { spacing = 0.1 } }")),
            "s.toml:2:20: error: points have no file; give file = \"NAME.ply\" or .csv");
  EXPECT_EQ(error_of(in_body("shape = { box = { size = [1, 0, 1] } }")),
            "s.toml:2:30: error: body.1.shape.box.size[1] = 0; expected 0 < value <= 1000000");
  EXPECT_EQ(
      error_of("[solver]\ncell_size = 1e-9\n" + in_body("shape = { box = { center = [9, 0, "
                                                        "0], size = [0.2, 0.2, 0.2] } }")),
      "s.toml:4:28: error: more than 4194280 cells from the origin; move it closer or enlarge "
      "solver.cell_size");
}

TEST(SceneErrors, BodiesThatCannotMoveAreLocated) {
  const auto error_with = [](const std::string& lines) {
    return error_of(with_ball("[[collider]]\n" + lines));
  };
  const std::string box = "shape = { box = { size = [0.2, 0.2, 0.2] } }\n";
  EXPECT_EQ(error_with(box + "density = 400"), "no error");
  EXPECT_EQ(error_with(box + "density = 400\nmass = 2"),
            "s.toml:7:8: error: the body has a mass and a density; give one of the two");
  EXPECT_EQ(error_with("shape = { plane = {} }\ndensity = 400"),
            "s.toml:6:11: error: a shape of this kind cannot move by itself; give a mass to a "
            "sphere, box, capsule, cylinder, cone, torus or mesh");
  EXPECT_EQ(error_with(box + "mass = 2\nkeyframes = [{ time = 1 }]"),
            "s.toml:6:8: error: keyframes and a mass both move the collider; omit the one or the "
            "other");
  EXPECT_EQ(error_with(box + "joint = \"hinge\""),
            "s.toml:6:9: error: joint is of a body that moves by itself; give collider.1 a density "
            "in kg/m3, or a mass in kg");
  EXPECT_EQ(error_with(box + "mass = 2\njoint_stiffness = 3"),
            "s.toml:7:19: error: only a hinge or a slider has a spring or a damper; give joint = "
            "\"hinge\" or \"slider\"");
  EXPECT_EQ(error_with(box + "mass = 2\njoint = \"hinge\"\njoint_axis = [0, 0, 0]"),
            "s.toml:8:14: error: the axis of the joint has no direction; give a vector, as [0, 0, "
            "1]");
  EXPECT_EQ(error_with(box + "mass = 2\ninertia = [1, 1, 3]"),
            "s.toml:7:11: error: no body has these moments of inertia; give three above 0, none "
            "larger than the other two together");
  EXPECT_EQ(error_with(box + "mass = 2\nhold = [\"w\"]").find("s.toml:7:"), 0u);
  EXPECT_EQ(error_with(box + "mass = 2\n[solver]\ncontact_at = \"nodes\""),
            "s.toml:6:8: error: snow does not move bodies with solver.contact_at = \"nodes\"; use "
            "contact_at = \"particles\", the default");
}

TEST(SceneErrors, KeyframesOfCollidersAreLocated) {
  const auto error_with = [](const std::string& line) {
    return error_of(
        with_ball("[[collider]]\nshape = { box = { size = [0.2, 0.2, 0.2] } }\n" + line));
  };
  EXPECT_EQ(error_with("keyframes = [{ time = 1 }, { time = 0.5 }]"),
            "s.toml:6:37: error: keyframe 2 is at 0.5 s, the one before at 1 s; times must "
            "increase from one keyframe to the next");
  EXPECT_EQ(error_with("velocity = [1, 0, 0]\nkeyframes = [{ time = 1 }]"),
            "s.toml:6:12: error: velocity and keyframes both move the collider; give one of the "
            "two; two equal keyframes hold the collider still");
  EXPECT_EQ(error_with("keyframes = [{ time = 1 }]\nangular_velocity = [0, 0, 1]"),
            "s.toml:7:20: error: angular_velocity and keyframes both move the collider; give one "
            "of the two; two equal keyframes hold the collider still");
  EXPECT_EQ(error_with("keyframes = [{}, { time = 1, rotation = [0, 270, 0] }]"),
            "s.toml:6:41: error: keyframe 2 turns by 180 degrees or more since the one before; a "
            "collider turns the shorter way; add a keyframe in between, or use angular_velocity");
  for (const char* half : {"[0, 180, 0]", "[0, 0, -180]", "[90, 90, -90]"})
    EXPECT_NE(error_with(std::string("keyframes = [{}, { time = 1, rotation = ") + half + " }]")
                  .find("keyframe 2 turns by 180 degrees"),
              std::string::npos)
        << half;
  EXPECT_EQ(error_with("keyframes = [{}, { time = 1, rotation = [0, 179.9, 0] }]"), "no error");
  EXPECT_EQ(
      error_with("keyframes = [{ place = [0, 0, 0] }]").find("s.toml:6:16: error: unknown key"),
      0u);
  EXPECT_EQ(error_with("keyframes = { time = 1 }").find("s.toml:6:13: error: "), 0u);
}

TEST(SceneErrors, MeshFilesExist) {
  try {
    app::scene::read_scene_text(in_body("shape = { mesh = { file = \"none.obj\" } }"), "s.toml",
                                "/nowhere");
    FAIL();
  } catch (const app::scene::toml::SceneError& error) {
    EXPECT_STREQ(error.what(),
                 "s.toml:2:27: error: body.1.shape.mesh.file = \"none.obj\"; expected a file that "
                 "exists; looked for /nowhere/none.obj");
  }
}

TEST(SceneErrors, CamerasCanSee) {
  EXPECT_EQ(error_of(with_ball("[camera]\neye = [1, 1, 1]\ntarget = [1, 1, 1]")),
            "s.toml:6:10: error: eye and target are the same point; move one of them");
  EXPECT_EQ(error_of(with_ball("[camera]\neye = [1, 1, 1]")),
            "s.toml:5:7: error: eye and target go together; give both, or neither to frame the "
            "whole scene");
  EXPECT_EQ(error_of(with_ball("[[view]]\ncamera = { eye = [0, 1, 0], target = [0, 0, 0] }")),
            "s.toml:5:10: error: up is parallel to the direction of view; try up = [0, 0, -1]");
  EXPECT_EQ(error_of(with_ball("[camera]\nup = [0, 0, 0]")),
            "s.toml:5:6: error: up is zero; it must point upwards in the picture");
  EXPECT_EQ(error_of(with_ball("[light]\ndirection = [0, 0, 0]")),
            "s.toml:5:13: error: direction is zero; it must point towards the light");
}

TEST(SceneErrors, ColourRangesAreNotEmpty) {
  EXPECT_EQ(error_of("[[view]]\nparticles = { range = [1, 1] }"),
            "s.toml:2:23: error: view.1.particles.range = [1, 1]; expected min < max");
  EXPECT_EQ(error_of("[[view]]\nparticles = { range = \"all\" }"),
            "s.toml:2:23: error: view.1.particles.range = \"all\"; expected \"auto\" or two "
            "numbers [min, max]");
}

TEST(SceneErrors, ASceneHasSnow) {
  const std::string none =
      "s.toml:1:1: error: the scene has no body and no emitter; add [[body]] with shape = { sphere "
      "= { center = "
      "[0, 0.5, 0], radius = 0.1 } }";
  EXPECT_EQ(error_of("title = \"nothing\""), none);
  EXPECT_EQ(error_of("body = []"), none);
}

TEST(SceneErrors, SyntaxErrorsAreLocated) {
  EXPECT_EQ(error_of("frames = 1\nframes = 2"),
            "s.toml:2:10: error: cannot parse key-value pair: cannot redefine existing integer "
            "'frames'");
}

TEST(SceneErrors, MoreCollidersThanASimulationTakesAreLocated) {
  std::string text = "[[body]]\nshape = { sphere = { radius = 0.1 } }\n";
  for (int k = 0; k < 65; ++k) text += "[[collider]]\nshape = { plane = {} }\n";
  EXPECT_EQ(error_of(text), "s.toml:131:1: error: there are 65 colliders; at most 64 are allowed");
}

TEST(SceneErrors, ControlBytesOfNamesAreNotEchoed) {
  EXPECT_EQ(error_of("[[body]]\nname = \"\\u001b[31m\""),
            "s.toml:2:8: error: body.1.name = \"\\u001b[31m\"; expected a name of 1 to 64 letters, "
            "digits, _ and -");
}

TEST(SceneErrors, LongValuesAreCutBetweenCharacters) {
  std::string name;
  for (int k = 0; k < 200; ++k) name += "é";
  const std::string error = error_of("[[body]]\nname = \"" + name + "\"");
  EXPECT_LT(error.size(), 200u);
  EXPECT_NE(error.find("é...; expected"), std::string::npos) << error;
}

TEST(SceneErrors, FilesThatAreNoScenesAreExplained) {
  const test::TemporaryFolder folder;
  const std::string directory = folder.path().string();
  EXPECT_EQ(file_error_of("/nowhere/s.toml"),
            "/nowhere/s.toml: error: No such file or directory; there is no folder /nowhere");
  EXPECT_EQ(file_error_of(directory), directory + ": error: is a directory; name a scene file");
  const std::string circle = directory + "/circle.toml";
  std::filesystem::create_symlink("circle.toml", circle);
  EXPECT_NE(file_error_of(circle).find("; it is a link to nothing"), std::string::npos)
      << file_error_of(circle);
  const std::string mesh =
      error_of("[[body]]\nname = \"b\"\nshape.mesh.file = \"" + circle + "\"\n");
  EXPECT_TRUE(mesh.ends_with(circle + ", which is a link to nothing")) << mesh;
  EXPECT_EQ(scene::name_of_scene("..toml"), "scene") << "out/. would be the folder of all runs";
  const std::string empty = directory + "/empty.toml";
  std::ofstream(empty).close();
  EXPECT_EQ(file_error_of(empty),
            empty + ": error: the file is empty; a scene needs at least one [[body]]");
  EXPECT_EQ(file_error_of("/dev/zero"), "/dev/zero: error: larger than 1 MiB");
}

}  // namespace
}  // namespace neve::app
