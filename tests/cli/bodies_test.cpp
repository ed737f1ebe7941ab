/// Colliders that move by themselves, through the command line: runs, resumed and forked runs,
/// exports, passes, comparisons and sweeps.

#include <algorithm>
#include <string>

#include "app/exports/usda.h"
#include "tests/support/resume.h"

namespace neve::test {
namespace {

/// A ball that rolls through a little snow, and a can on a hinge that it hits.
const std::string rolling = R"(
title = "Rolling"
frames = 4
[solver]
cell_size = 0.04
[[body]]
name = "bed"
shape = { box = { center = [0, 0.06, 0], size = [0.24, 0.12, 0.24] } }
[[collider]]
name = "floor"
shape = { plane = {} }
[[collider]]
name = "ball"
shape = { sphere = { center = [-0.22, 0.16, 0], radius = 0.08 } }
density = 900
velocity = [4, 0, 0]
angular_velocity = [0, 3, -20]
[[collider]]
name = "sign"
shape = { box = { center = [0.26, 0.2, 0], size = [0.05, 0.3, 0.2], rotation = [0, 10, 0] } }
density = 200
joint = "hinge"
joint_point = [0.26, 0.4, 0]
joint_axis = [0, 0, 1]
[[view]]
name = "particles"
layers = ["ground", "colliders", "particles", "plots"]
[[export]]
format = "usda"
[output]
size = [160, 90]
)";

class Bodies : public Cli {
 protected:
  Bodies() { folder.write("scene.toml", rolling); }

  app::output::ProcessResult render(std::vector<std::string> more) {
    for (const char* word : {"--quiet", "--no-movie", "render"}) more.insert(more.begin(), word);
    return neve(more);
  }
  sim::Vec3d place(const app::Json& body) {
    const app::Json& p = body["position"];
    return {p[0].get<double>(), p[1].get<double>(), p[2].get<double>()};
  }
};

TEST_F(Bodies, RunJsonHasThemAtEveryFrame) {
  ASSERT_EQ(render({"scene.toml", "--out", "a"}).exit_code, 0);
  const app::Json run = json_of("a/run.json");
  ASSERT_EQ(run["frames"].size(), 5u);
  for (const app::Json& frame : run["frames"]) {
    ASSERT_EQ(frame["bodies"].size(), 2u);
    EXPECT_EQ(frame["bodies"][0]["collider"], "ball");
  }
  const app::Json &first = run["frames"][0]["bodies"], &last = run["frames"][4]["bodies"];
  EXPECT_EQ(place(first[0]), sim::Vec3d(-0.22, 0.16, 0));
  EXPECT_EQ(first[0]["velocity"][0], 4.0);
  EXPECT_NEAR(first[1]["rotation"][1].get<double>(), 10, 1e-12);
  EXPECT_GT(place(last[0]).x(), place(first[0]).x() + 0.2) << "it has rolled";
  EXPECT_LT(last[0]["velocity"][0].get<double>(), 4.0) << "snow has braked it";
}

/// They jumped by whole turns, and such a list was refused.
TEST_F(Bodies, ARotationThatGoesOnIsAListOfKeyframes) {
  const auto scene = [](const std::string& motion) {
    return R"(
frames = 12
solver = { cell_size = 0.04, gravity = [0, 0, 0] }
[[body]]
name = "crumb"
shape = { sphere = { center = [2, 0, 0], radius = 0.04 } }
[[collider]]
name = "top"
shape = { box = { center = [0, 0, 0], size = [0.2, 0.3, 0.4], rotation = [10, 200, 30] } }
)" + motion +
           R"(
[[view]]
name = "particles"
[output]
size = [64, 36]
)";
  };
  for (const std::string spin : {"[0, 19, 0]", "[3, -21, 17]"}) {
    folder.write("spun.toml", scene("density = 700\nangular_velocity = " + spin));
    ASSERT_EQ(render({"spun.toml", "--out", "whole", "--replace"}).exit_code, 0);
    ASSERT_EQ(render({"spun.toml", "--frames", "7-12", "--out", "late", "--replace"}).exit_code, 0);
    const app::Json frames = json_of("whole/run.json")["frames"];
    const app::Json late = json_of("late/run.json");
    const auto bodies_of = [](const app::Json& frame) { return frame["bodies"][0]; };
    EXPECT_EQ(bodies_of(late["start"]), bodies_of(frames[0]));
    EXPECT_EQ(bodies_of(late["frames"][0]), bodies_of(frames[7]));
    EXPECT_NEAR(bodies_of(frames[0])["rotation"][1].get<double>(), 200, 1e-9) << "as it is written";
    std::string keyframes = "keyframes = [";
    for (const app::Json& frame : frames) {
      const app::Json body = bodies_of(frame);
      keyframes += "{ time = " + frame["time"].dump() + ", position = " + body["position"].dump() +
                   ", rotation = " + body["rotation"].dump() + " }, ";
    }
    folder.write("again.toml", scene(keyframes + "]"));
    const auto checked = neve({"check", "again.toml"});
    EXPECT_EQ(checked.exit_code, 0) << checked.errors;
  }
}

/// A run that is killed and resumed has the same bodies in pictures, plots and the stage too.
TEST_F(Bodies, KilledAndResumedTheyAreWhereTheyWere) {
  ASSERT_EQ(render({"scene.toml", "--out", "whole"}).exit_code, 0);
  EXPECT_EQ(kill_and_resume(folder / "scene.toml", folder / "parts", {4, 0.6, 7}), 4);
  ASSERT_EQ(
      render({"scene.toml", "--out", "parts", "--resume", "--checkpoint-every", "1"}).exit_code, 0);
  const RunFiles whole = files_of(folder / "whole"), parts = files_of(folder / "parts");
  EXPECT_EQ(whole.hashes, parts.hashes);
  EXPECT_EQ(whole.pictures, parts.pictures);
  const app::Json a = json_of("whole/run.json"), b = json_of("parts/run.json");
  for (std::size_t k = 0; k < 5; ++k)
    EXPECT_EQ(a["frames"][k]["bodies"], b["frames"][k]["bodies"]) << k;
  EXPECT_EQ(read_text(folder / "whole/exports/usda.usda"),
            read_text(folder / "parts/exports/usda.usda"));
}

/// Bodies are somewhere at each frame, also at those for which the stage has no file of snow.
TEST_F(Bodies, AStageThatARunGetsLaterHasAllTheirPlaces) {
  std::string with_stage = rolling, plain = rolling;
  const std::string stage = "[[export]]\nformat = \"usda\"\n";
  with_stage.replace(with_stage.find(stage), stage.size(), stage + "every = 4\n");
  plain.erase(plain.find(stage), stage.size());
  folder.write("scene.toml", with_stage);
  ASSERT_EQ(render({"scene.toml", "--out", "whole"}).exit_code, 0);
  folder.write("scene.toml", plain);
  ASSERT_EQ(render({"scene.toml", "--out", "later"}).exit_code, 0);
  folder.write("scene.toml", with_stage);
  const auto done = render({"scene.toml", "--out", "later"});
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  EXPECT_TRUE(read_text(folder / "whole/exports/usda.usda") ==
              read_text(folder / "later/exports/usda.usda"));
  EXPECT_EQ(json_of("later/run.json")["exports"], json_of("whole/run.json")["exports"]);
}

/// The scene alone does not say where colliders are that follow a curve, wait, or were changed.
TEST_F(Bodies, AStageThatARunGetsLaterHasPlacesThatTheSceneDoesNotSay) {
  const std::string plain =
      std::string(tiny_scene) +
      "[[collider]]\nname = \"plow\"\nvelocity = [1, 0, 0]\n"
      "shape = { box = { center = [0.5, 0.1, 0], size = [0.1, 0.1, 0.1] } }\n";
  const std::string stage = "[[export]]\nformat = \"usda\"\nevery = 4\n",
                    curve =
                        "[[curve]]\nparameter = \"collider.plow.velocity\"\nkeyframes = [\n"
                        "{ time = 0, vector = [1, 0, 0] }, { time = 0.1, vector = [3, 0, 0] }]\n";
  const auto stage_of = [&](const std::string& text, const std::string& out,
                            std::vector<std::string> more) {
    folder.write("plow.toml", text);
    more.insert(more.begin(), {"plow.toml", "--frames", "4", "--out", out});
    const auto done = render(more);
    EXPECT_EQ(done.exit_code, 0) << done.errors;
    return done.exit_code == 0 && exists(out + "/exports/usda.usda")
               ? read_text(folder / out / "exports/usda.usda")
               : "";
  };
  int k = 0;
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{},
        {"--set", "solver.bypass=[\"colliders\"]"},
        {"--from", "0.05s", "--set", "collider.plow.velocity=[2,0,0]"}}) {
    const std::string text = more.empty() ? plain + curve : plain, name = std::to_string(k++);
    const std::string whole = stage_of(text + stage, "whole" + name, more);
    stage_of(text, "later" + name, more);
    EXPECT_FALSE(whole.empty());
    EXPECT_TRUE(stage_of(text + stage, "later" + name, more) == whole) << name;
  }
}

TEST_F(Bodies, AnyNumberOfThreadsGivesTheSame) {
  ASSERT_EQ(render({"scene.toml", "--out", "one", "--threads", "1"}).exit_code, 0);
  ASSERT_EQ(render({"scene.toml", "--out", "three", "--threads", "3"}).exit_code, 0);
  EXPECT_EQ(hashes("one"), hashes("three"));
  EXPECT_EQ(json_of("one/run.json")["frames"][4]["bodies"],
            json_of("three/run.json")["frames"][4]["bodies"]);
}

/// The stage has the places that run.json tells.
TEST_F(Bodies, TheStageMovesThem) {
  ASSERT_EQ(render({"scene.toml", "--out", "a"}).exit_code, 0);
  const std::string stage = read_text(folder / "a/exports/usda.usda");
  const app::Json frames = json_of("a/run.json")["frames"];
  std::size_t at = stage.find("def Mesh \"ball\"");
  ASSERT_NE(at, std::string::npos);
  for (std::size_t k = 0; k < 5; ++k) {
    const sim::Vec3d x = place(frames[k]["bodies"][0]);
    const std::string row = "(" + app::exports::usd_number(x.x()) + ", " +
                            app::exports::usd_number(x.y()) + ", " +
                            app::exports::usd_number(x.z()) + ")";
    at = stage.find(row, at);
    EXPECT_NE(at, std::string::npos) << k << row;
  }
  EXPECT_EQ(stage.find("visibility"), std::string::npos);
}

/// Their places follow from no time of the scene, so frames without a file are noted.
TEST_F(Bodies, TheStageHasThemAtFramesWithoutAFileToo) {
  const auto make = [&](const std::string& out, const std::string& frames, const char* more) {
    ASSERT_EQ(render({"scene.toml", "--out", out, "--set", "export.1.every=2", "--frames", frames,
                      "--no-keep-states", more})
                  .exit_code,
              0);
  };
  make("all", "0-4", "--set=export.1.every=1");
  make("some", "0-4", "--quiet");
  make("parts", "0-1", "--quiet");
  make("parts", "0-4", "--resume");
  const auto movements = [&](const std::string& out) {
    const std::string text = read_text(folder / out / "exports/usda.usda");
    const std::size_t from = text.find("def Xform \"colliders\"");
    return text.substr(from, text.find("def Xform \"view\"") - from);
  };
  EXPECT_FALSE(std::filesystem::exists(folder / "some/exports/usda/0001.usda"));
  EXPECT_EQ(movements("some"), movements("all"));
  EXPECT_EQ(read_text(folder / "parts/exports/usda.usda"),
            read_text(folder / "some/exports/usda.usda"));
  // The stage of an export of times has the same movements.
  const auto result = neve({"export", "scene.toml", "--format", "usda", "--at",
                            "0,0.16666666666666666", "--out", "times", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const std::string text = read_text(folder / "times/usda.usda");
  const std::size_t from = text.find("def Xform \"colliders\"");
  EXPECT_EQ(text.substr(from, text.find("def Xform \"view\"") - from), movements("all"));
}

/// A fork is the run that was changed there; the change may be a new collider.
TEST_F(Bodies, AForkMayThrowAnotherOne) {
  ASSERT_EQ(render({"scene.toml", "--out", "a", "--checkpoint-every", "1"}).exit_code, 0);
  const auto forked =
      render({"a", "--from", "0.09s", "--out", "b", "--set",
              "collider.egg={ shape = { sphere = { center = [0, 0.4, 0], radius = 0.06 } }, "
              "density = 700, velocity = [0, -4, 0] }",
              "--set", "collider.ball.friction=0.1", "--set", "collider.sign=none"});
  ASSERT_EQ(forked.exit_code, 0) << forked.errors;
  const app::Json run = json_of("b/run.json");
  ASSERT_EQ(run["changes"].size(), 3u);
  const app::Json& bodies = run["frames"].back()["bodies"];
  ASSERT_EQ(bodies.size(), 2u);
  EXPECT_EQ(bodies[1]["collider"], "egg");
  EXPECT_LT(bodies[1]["position"][1].get<double>(), 0.4) << "it flies";
  const std::string stage = read_text(folder / "b/exports/usda.usda");
  EXPECT_NE(stage.find("def Mesh \"egg\""), std::string::npos);
  EXPECT_EQ(stage.find("def Mesh \"sign\""), std::string::npos) << "it was gone at every frame";
  // Its picture makes itself again, without the run that was forked.
  std::filesystem::remove_all(folder / "a");
  const auto again = render({"b/particles/0004.png", "--out", "c"});
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(hashes("c")[4], hashes("b")[4]);
  EXPECT_EQ(json_of("c/run.json")["frames"].back()["bodies"], bodies);
  const auto refused =
      render({"b", "--from", "0.13s", "--out", "d", "--set", "collider.ball.density=100"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(contains(refused.errors, "collider.ball.density cannot change while"))
      << refused.errors;
}

/// Exports of a picture's run draw from the simulation, as its pictures do.
TEST_F(Bodies, AnExportAfterwardsHasTheSameStage) {
  ASSERT_EQ(render({"scene.toml", "--out", "a"}).exit_code, 0);
  const auto result =
      neve({"export", "scene.toml", "--format", "usda", "--out", "alone", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto transforms = [&](const std::string& file) {
    const std::string text = read_text(folder / file);
    const std::size_t from = text.find("def Xform \"colliders\""),
                      to = text.find("def Xform \"view\"");
    return text.substr(from, to - from);
  };
  EXPECT_EQ(transforms("alone/usda.usda"), transforms("a/exports/usda.usda"));
}

TEST_F(Bodies, ComparisonsAndSweepsMeasureThem) {
  folder.write(
      "sweep.toml",
      "[sweep]\nscene = \"scene.toml\"\n[axis]\n\"collider.ball.density\" = [100, 3000]\n");
  const auto sweep = neve({"sweep", "sweep.toml", "--out", "s.cdb", "--quiet"});
  ASSERT_EQ(sweep.exit_code, 0) << sweep.errors;
  const std::string table = read_text(folder / "s.cdb/data.csv");
  const std::string head = table.substr(0, table.find('\n'));
  EXPECT_TRUE(contains(head, "max_pressure,body_fall,body_way,max_body_speed,steps")) << head;
  const auto compared =
      neve({"compare", "s.cdb/runs/0000", "s.cdb/runs/0001", "--json", "--out", "x"});
  ASSERT_EQ(compared.exit_code, 0) << compared.errors;
  EXPECT_TRUE(contains(compared.output, "body_speed_b")) << compared.output.substr(0, 400);
  // Without bodies there is no such column.
  folder.write("none.toml", tiny_scene);
  folder.write("sweep.toml",
               "[sweep]\nscene = \"none.toml\"\n[axis]\n\"body.ball.velocity\" = [[0, -1, 0]]\n");
  ASSERT_EQ(neve({"sweep", "sweep.toml", "--out", "t.cdb", "--quiet"}).exit_code, 0);
  EXPECT_FALSE(contains(read_text(folder / "t.cdb/data.csv"), "body_fall"));
}

TEST_F(Bodies, CoarseAndFastRunsKeepThem) {
  const auto coarse = render({"scene.toml", "--out", "coarse", "--coarsen", "1.5", "--fast",
                              "--passes", "motion,collider", "--shutter", "180"});
  ASSERT_EQ(coarse.exit_code, 0) << coarse.errors;
  const app::Json run = json_of("coarse/run.json");
  EXPECT_EQ(place(run["frames"][0]["bodies"][0]), sim::Vec3d(-0.22, 0.16, 0));
  EXPECT_GT(place(run["frames"][4]["bodies"][0]).x(), 0);
}

}  // namespace
}  // namespace neve::test
