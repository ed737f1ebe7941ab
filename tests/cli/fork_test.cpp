/// Runs that fork at a moment of another run.

#include "app/record/picture_record.h"
#include "app/record/run_json.h"
#include "app/scene/read.h"
#include "app/setup/seed_scene.h"
#include "app/timeline/changes.h"
#include "tests/support/meshes.h"
#include "tests/support/resume.h"

namespace neve::test {
namespace {

class Fork : public Cli {
 protected:
  app::output::ProcessResult render(const std::vector<std::string>& more) {
    std::vector<std::string> words{"render", "--no-movie"};
    words.insert(words.end(), more.begin(), more.end());
    return neve(words);
  }

  /// The hash of frame 4 of a run that is advanced here, with a change at the end of a frame or so
  /// many steps later.
  std::string hash_of_whole(const std::string& run, int frame, std::size_t steps,
                            const std::string& address, const std::string& value) {
    const std::string text = json_of(run + "/run.json")["scene"];
    const app::scene::Scene scene = app::scene::read_scene_text(text, "run");
    sim::Simulation simulation =
        app::setup::make_simulation(scene, app::setup::seed_scene(scene).particles, 1);
    for (int k = 1; k <= frame; ++k) simulation.advance_to(k / 24.0);
    if (steps > 0) simulation.advance_to((frame + 1) / 24.0, nullptr, simulation.steps() + steps);
    changed_at = simulation.steps();
    const app::scene::Scene now = app::timeline::with_changes(
        scene, {{simulation.steps(), address, value}}, simulation.steps());
    simulation.apply(now.solver, now.materials, app::scene::sim_colliders(now));
    for (int k = frame + 1; k <= 4; ++k) simulation.advance_to(k / 24.0);
    return app::record::hash_text(simulation.state_hash());
  }

  std::size_t changed_at = 0;
};

struct ForkedMethod {
  const char *transfer, *beta;
};

class ForkOf : public Fork, public testing::WithParamInterface<ForkedMethod> {};

TEST_P(ForkOf, BranchEqualsTheWholeRunWithThatChangeAtThatStep) {
  const std::string transfer = GetParam().transfer, beta = GetParam().beta;
  ASSERT_EQ(render({"scene.toml", "--out", "a", "--checkpoint-every", "1", "--set",
                    "solver.transfer=" + transfer, "--set", "solver.beta=" + beta})
                .exit_code,
            0);
  // The branch continues from a checkpoint, at the end of frame 3.
  const auto branch =
      render({"a", "--from", "0.125s", "--set", "material.snow.hardening=4", "--out", "b"});
  ASSERT_EQ(branch.exit_code, 0) << branch.errors;
  EXPECT_TRUE(contains(branch.errors, "continues from the checkpoint of frame 3")) << branch.errors;
  const std::string whole = hash_of_whole("a", 3, 0, "material.snow.hardening", "4");
  EXPECT_EQ(hashes("b"), (std::map<int, std::string>{{4, whole}}));
  EXPECT_NE(hashes("a")[4], whole);
  const app::Json run = json_of("b/run.json");
  EXPECT_EQ(run["forked"]["from"], "a");
  EXPECT_EQ(run["forked"]["frame"], 3);
  EXPECT_EQ(run["forked"]["step"], changed_at);
  EXPECT_EQ(run["forked"]["state_hash"], hashes("a")[3]);
  ASSERT_EQ(run["changes"].size(), 1u);
  EXPECT_EQ(run["changes"][0]["step"], changed_at);
  // Its picture makes itself again, without the run that was forked.
  std::filesystem::remove_all(folder / "a");
  ASSERT_EQ(render({"b/particles/0004.png", "--out", "again"}).exit_code, 0);
  EXPECT_EQ(hashes("again"), hashes("b"));
  EXPECT_TRUE(app::output::read_file(folder / "again/particles/0004.png") ==
              app::output::read_file(folder / "b/particles/0004.png"));
}

INSTANTIATE_TEST_SUITE_P(Methods, ForkOf,
                         testing::Values(ForkedMethod{"flip", "0"}, ForkedMethod{"flip", "0.5"},
                                         ForkedMethod{"mls", "0"}, ForkedMethod{"mls", "0.5"}));

TEST_F(Fork, BetweenTwoFramesTheStepsBeforeTheTimeAreThoseOfTheRun) {
  ASSERT_EQ(render({"scene.toml", "--out", "a", "--checkpoint-every", "0"}).exit_code, 0);
  const auto branch =
      render({"a", "--from", "0.11s", "--set", "solver.gravity=[3, -9.81, 0]", "--out", "b"});
  ASSERT_EQ(branch.exit_code, 0) << branch.errors;
  const app::Json forked = json_of("b/run.json")["forked"];
  EXPECT_EQ(forked["frame"], 2);
  EXPECT_LE(forked["time"].get<double>(), 0.11);
  EXPECT_GT(forked["time"].get<double>(), 0.1);
  std::size_t before = 0;
  const app::Json run = json_of("a/run.json");
  for (int frame = 1; frame <= 2; ++frame)
    before += run["frames"][static_cast<std::size_t>(frame)]["steps"].get<std::size_t>();
  const std::size_t inside = forked["step"].get<std::size_t>() - before;
  EXPECT_GT(inside, 0u);
  EXPECT_EQ(hashes("b")[4], hash_of_whole("a", 2, inside, "solver.gravity", "[3, -9.81, 0]"));
  EXPECT_EQ(hashes("b").begin()->first, 3);
}

/// The scene has 4 frames.
TEST_F(Fork, ABranchEndsWhereTheRunEndsThatBecameLonger) {
  ASSERT_EQ(render({"scene.toml", "--out", "a"}).exit_code, 0);
  ASSERT_EQ(render({"a", "--frames", "7"}).exit_code, 0);
  const std::vector<std::string> change{"--set", "material.snow.hardening=4"};
  for (const char* time : {"0.125s", "0.25s"}) {
    const auto branch = render({"a", "--from", time, change[0], change[1], "--out", "b"});
    ASSERT_EQ(branch.exit_code, 0) << branch.errors;
    EXPECT_EQ(hashes("b").rbegin()->first, 7) << time;
    std::filesystem::remove_all(folder / "b");
  }
  const auto swept = neve({"sweep", "a", "--from", "0.125s", "-p", "material.snow.hardening=4,5",
                           "--dry-run", "--json"});
  ASSERT_EQ(swept.exit_code, 0) << swept.errors;
  EXPECT_TRUE(contains(swept.output, "\"last_frame\": 7") ||
              contains(swept.output, "\"last_frame\":7"))
      << swept.output;
}

/// Meshes of a map: the scene has the place of the first, and one that comes later stands beside
/// it.
TEST_F(Fork, AColliderOfAMapIsPlacedThere) {
  for (const double east : {4310.0, 4311.0}) {
    std::string vertices = box_obj({0.2, 0.2, 0.2});
    vertices.replace(0, vertices.find("f "), "");
    std::ostringstream mesh;
    for (int k = 0; k < 8; ++k)
      mesh << "v " << east + (k & 1 ? 0.1 : -0.1) << ' ' << 5255 + (k & 2 ? 0.1 : -0.1) << ' '
           << 100 + (k & 4 ? 0.1 : -0.1) << '\n';
    folder.write(east < 4311 ? "base.obj" : "hut.obj", mesh.str() + vertices);
  }
  const auto map_mesh = [&](const char* file) {
    return "{ mesh = { file = \"" + (folder / file).string() +
           "\", coordinates = \"world\", rotation = [-90, 0, 0] } }";
  };
  folder.write("map.toml", read_text(folder / "scene.toml") +
                               "[[collider]]\nname = \"base\"\nshape = " + map_mesh("base.obj") +
                               "\n");
  const std::string hut = "collider.hut={ shape = " + map_mesh("hut.obj") + " }";
  ASSERT_EQ(render({"map.toml", "--out", "a", "--frames", "0-2"}).exit_code, 0);
  const auto whole = render({"map.toml", "--out", "w", "--frames", "0-2", "--set", hut});
  ASSERT_EQ(whole.exit_code, 0) << whole.errors;
  const auto branch = render({"a", "--from", "0.042s", "--out", "b", "--set", hut});
  ASSERT_EQ(branch.exit_code, 0) << branch.errors;
  const auto origin_of = [&](const std::string& run) {
    const std::string text = json_of(run)["scene"];
    const app::scene::Scene scene = app::scene::read_scene_text(text, "run");
    return std::get<sim::shapes::Mesh>(scene.colliders.back().shape.form).origin;
  };
  const sim::Vec3d origin = origin_of("w/run.json");
  EXPECT_EQ(origin, sim::Vec3d(4310, 5255, 100));
  EXPECT_EQ(origin_of("b/run.json"), origin);
  EXPECT_TRUE(contains(json_of("b/run.json")["changes"].dump(), "4310"));
  ASSERT_EQ(render({"b/particles/0002.png", "--out", "again"}).exit_code, 0);
  EXPECT_EQ(hashes("again")[2], hashes("b")[2]);
  const auto picture = render({"a/particles/0000.png", "--out", "p", "--set", hut});
  ASSERT_EQ(picture.exit_code, 0) << picture.errors;
  EXPECT_EQ(origin_of("p/run.json"), origin);
}

TEST_F(Fork, APictureAndASceneAreForkedLikeTheRunThatMadeThem) {
  ASSERT_EQ(render({"scene.toml", "--out", "a"}).exit_code, 0);
  const auto fork = [&](const char* source, const char* out) {
    const auto done =
        render({source, "--from", "0.125", "--set", "material.snow.hardening=4", "--out", out});
    EXPECT_EQ(done.exit_code, 0) << done.errors;
    return hashes(out);
  };
  const auto of_run = fork("a", "b");
  EXPECT_EQ(of_run.size(), 1u);
  EXPECT_EQ(fork("a/particles/0002.png", "c"), of_run);
  EXPECT_EQ(fork("scene.toml", "d"), of_run);
  // All branches also know what was greatest before them.
  const app::Json start = json_of("b/run.json")["start"];
  ASSERT_TRUE(start.contains("before"));
  for (const char* of : {"c", "d"})
    EXPECT_EQ(json_of(std::string(of) + "/run.json")["start"], start) << of;
  // Without a change the branch is the run itself.
  ASSERT_EQ(render({"a", "--from", "0.125", "--out", "same"}).exit_code, 0);
  EXPECT_EQ(hashes("same")[4], hashes("a")[4]);
}

TEST_F(Fork, ABranchOfABranchHasTheChangesOfBoth) {
  ASSERT_EQ(render({"scene.toml", "--out", "a", "--checkpoint-every", "1"}).exit_code, 0);
  ASSERT_EQ(render({"a", "--from", "0.05", "--set", "material.snow.hardening=4", "--out", "b",
                    "--checkpoint-every", "1"})
                .exit_code,
            0);
  ASSERT_EQ(
      render({"b", "--from", "0.126", "--set", "solver.transfer=mls", "--out", "c"}).exit_code, 0);
  const app::Json changes = json_of("c/run.json")["changes"];
  ASSERT_EQ(changes.size(), 2u);
  ASSERT_EQ(render({"c/particles/0004.png", "--out", "again"}).exit_code, 0);
  EXPECT_EQ(hashes("again"), hashes("c"));
  // An earlier way leaves the later change of the run behind.
  ASSERT_EQ(render({"b", "--from", "0.01", "--set", "solver.transfer=mls", "--out", "d"}).exit_code,
            0);
  EXPECT_EQ(json_of("d/run.json")["changes"].size(), 1u);
}

/// They were those of the run that it leaves up to its first picture, after the fork.
TEST_F(Fork, WhatWasGreatestAfterItIsNotBeforeIt) {
  ASSERT_EQ(render({"scene.toml", "--frames", "4-4", "--out", "late"}).exit_code, 0);
  ASSERT_TRUE(json_of("late/run.json")["start"].contains("before"));
  ASSERT_EQ(render({"late", "--from", "0.05s", "--set", "solver.gravity=[0, 5, 0]", "--out", "a"})
                .exit_code,
            0);
  EXPECT_EQ(hashes("a").begin()->first, 2);
  EXPECT_FALSE(json_of("a/run.json")["start"].contains("before"));
}

/// The card is of the snow that the branch has, and no run itself.
/// Those before it are pictures of the run that it left.
TEST_F(Fork, ABranchBeginsAtItsForkWhateverIsDrawnOfItLater) {
  ASSERT_EQ(render({"scene.toml", "--out", "a"}).exit_code, 0);
  ASSERT_EQ(render({"a", "--from", "0.084", "--set", "material.snow.hardening=4", "--out", "b"})
                .exit_code,
            0);
  const auto first = [&] { return hashes("b").begin()->first; };
  ASSERT_EQ(first(), 3);
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"b", "--resume"}, {"b", "--frames", "6"}}) {
    const auto done = render(more);
    EXPECT_EQ(done.exit_code, 0) << done.errors;
    EXPECT_FALSE(contains(done.errors, "missing")) << done.errors;
    EXPECT_EQ(first(), 3);
    EXPECT_FALSE(exists("b/particles/0002.png"));
  }
  EXPECT_EQ(hashes("b").rbegin()->first, 6);
  EXPECT_EQ(neve({"export", "b", "--format", "csv", "--frames", "5"}).exit_code, 0);
  EXPECT_FALSE(exists("b/exports/csv/0002.csv"));
  EXPECT_TRUE(exists("b/exports/csv/0003.csv") && exists("b/exports/csv/0005.csv"));
}

/// A branch that was drawn elsewhere began with the frames of the run that it left.
TEST_F(Fork, ABranchIsOneWhereverItIsDrawn) {
  ASSERT_EQ(render({"scene.toml", "--out", "a"}).exit_code, 0);
  ASSERT_EQ(render({"a", "--from", "0.084", "--set", "material.snow.hardening=4", "--out", "b"})
                .exit_code,
            0);
  ASSERT_EQ(render({"b", "--view", "smoke", "--out", "c"}).exit_code, 0);
  const app::Json branch = json_of("b/run.json"), drawn = json_of("c/run.json");
  EXPECT_EQ(drawn["forked"], branch["forked"]);
  EXPECT_EQ(drawn["start"], branch["start"]);
  ASSERT_EQ(render({"c", "--frames", "6"}).exit_code, 0);
  EXPECT_EQ(hashes("c").begin()->first, 3);
  EXPECT_EQ(hashes("c").rbegin()->first, 6);
  ASSERT_EQ(render({"b", "--set", "first_frame=1001", "--out", "d"}).exit_code, 0);
  EXPECT_EQ(json_of("d/run.json")["forked"]["frame"], 1003);
}

/// The sum of their steps depended on how many parts a frame has: the last digit was another one.
TEST_F(Fork, ForcesOfAFrameInTwoPartsAreThoseOfTheWhole) {
  ASSERT_EQ(render({"scene.toml", "--out", "a"}).exit_code, 0);
  const app::Json whole = json_of("a/run.json")["frames"];
  for (const char* time : {"0.086", "0.09", "0.1", "0.11", "0.12"}) {
    ASSERT_EQ(render({"a", "--from", time, "--out", "b", "--replace"}).exit_code, 0);
    const app::Json frames = json_of("b/run.json")["frames"];
    ASSERT_EQ(frames[0]["frame"], 3);
    EXPECT_EQ(frames[0]["state_hash"], whole[3]["state_hash"]);
    EXPECT_EQ(frames[0]["forces"], whole[3]["forces"]) << time;
  }
}

/// It is meant to be another state than the picture shows.
TEST_F(Fork, ABranchOfAPictureIsNotTakenForOtherBits) {
  ASSERT_EQ(render({"scene.toml", "--out", "a"}).exit_code, 0);
  const auto done = render({"a/particles/0003.png", "--from", "0.05", "--set",
                            "solver.gravity=[0, 9, 0]", "--frames", "4", "--out", "b"});
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  EXPECT_FALSE(contains(done.errors, "another state")) << done.errors;
  EXPECT_EQ(json_of("b/run.json")["warnings"], app::Json::array());
}

TEST_F(Fork, ACardOfABranchHasItsChange) {
  ASSERT_EQ(render({"scene.toml", "--out", "a"}).exit_code, 0);
  ASSERT_EQ(
      render({"a", "--from", "0.1s", "--set", "material.snow.hardening=3", "--out", "b"}).exit_code,
      0);
  const auto card = neve({"card", "b", "--out", "b.png", "--json"});
  ASSERT_EQ(card.exit_code, 0) << card.errors;
  EXPECT_EQ(app::parse_json(std::string_view(card.output))["cards"][0]["material"]["hardening"], 3);
  const auto strip = neve({"strip", "b.png"});
  EXPECT_EQ(strip.exit_code, 2);
  EXPECT_TRUE(contains(strip.errors, "not a picture of a run")) << strip.errors;
}

TEST_F(Fork, AKilledBranchIsResumed) {
  ASSERT_EQ(render({"scene.toml", "--out", "a", "--frames", "12"}).exit_code, 0);
  const std::vector<std::string> fork{"a",
                                      "--from",
                                      "0.125",
                                      "--set",
                                      "material.snow.hardening=4",
                                      "--frames",
                                      "12",
                                      "--checkpoint-every",
                                      "1"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), fork.begin(), fork.end());
    return render(more);
  };
  ASSERT_EQ(with({"--out", "whole"}).exit_code, 0);
  std::vector<std::string> words{NEVE_BINARY, "render", "--no-movie"};
  words.insert(words.end(), fork.begin(), fork.end());
  words.insert(words.end(), {"--out", (folder / "killed").string(), "--resume"});
  words[3] = (folder / "a").string();
  for (int k = 0; k < 4; ++k) {
    const pid_t child = start_program(words);
    std::this_thread::sleep_for(std::chrono::milliseconds(60 + 50 * k));
    ::kill(child, SIGKILL);
    wait_for(child);
  }
  ASSERT_EQ(with({"--out", "killed", "--resume"}).exit_code, 0);
  EXPECT_EQ(hashes("killed"), hashes("whole"));
}

TEST_F(Fork, OnlyWhatMayChangeInARunIsTaken) {
  ASSERT_EQ(render({"scene.toml", "--out", "a"}).exit_code, 0);
  const auto refused = [&](const std::vector<std::string>& more, const char* why) {
    std::vector<std::string> words{"a", "--from", "0.1"};
    words.insert(words.end(), more.begin(), more.end());
    const auto done = render(words);
    EXPECT_EQ(done.exit_code, 2) << done.errors;
    EXPECT_TRUE(contains(done.errors, why)) << done.errors;
  };
  refused({"--set", "body.ball.velocity=[1, 0, 0]"},
          "body.ball.velocity cannot change while a simulation runs; parameters that can: ");
  refused({"--set", "material.snow.density=300"}, "material.NAME.youngs_modulus");
  refused({"--set", "solver.cell_size=0.02"}, "solver.cell_size cannot change");
  refused({"--set", "material.snow.hardness=3"}, "did you mean");
  refused({"--coarsen", "2"}, "cannot be combined with --from");
  refused({"--frames", "2"}, "is at or after frame 2, the last one");
  refused({"--out", "a"}, "a is the run that is forked");
  EXPECT_EQ(hashes("a").size(), 5u);
  // Changes that concern the run alone change no state.
  const auto allowed =
      render({"a", "--from", "0.1", "--set", "limits.particles=5000", "--out", "b"});
  EXPECT_EQ(allowed.exit_code, 0) << allowed.errors;
  EXPECT_TRUE(contains(json_of("b/run.json")["scene"].get<std::string>(), "particles = 5000"));
  EXPECT_EQ(hashes("b")[4], hashes("a")[4]);
  const auto negative = render({"a", "--from", "-1"});
  EXPECT_EQ(negative.exit_code, 2);
  EXPECT_TRUE(contains(negative.errors, "as in --from 0.25s")) << negative.errors;
}

/// A number counts in either order with a preset, as where a run starts.
TEST_F(Fork, ANumberBesideAPresetCounts) {
  ASSERT_EQ(render({"scene.toml", "--out", "a"}).exit_code, 0);
  const std::string number = "material.snow.hardening=4", preset = "material.snow.preset=wet";
  const auto hardening_with = [&](const std::vector<std::string>& changes, const std::string& out) {
    std::vector<std::string> words{"a", "--from", "0.1", "--out", out};
    for (const std::string& change : changes) words.insert(words.end(), {"--set", change});
    const auto done = render(words);
    EXPECT_EQ(done.exit_code, 0) << done.errors;
    std::string hardening;
    const app::Json run = json_of(out + "/run.json");
    for (const app::Json& change : run["changes"])
      if (change["address"] == "material.snow.hardening") hardening = change["value"];
    return hardening;
  };
  EXPECT_EQ(hardening_with({number, preset}, "first"), "4");
  EXPECT_EQ(hardening_with({preset, number}, "last"), "4");
  EXPECT_EQ(hardening_with({preset}, "alone"), "5");
}

/// The curve has the word over a preset, which sets other numbers too.
TEST_F(Fork, APresetLeavesANumberToItsCurve) {
  folder.write("soft.toml", std::string(tiny_scene) +
                                "[[curve]]\nname = \"soft\"\n"
                                "parameter = \"material.snow.youngs_modulus\"\n"
                                "keyframes = [{ time = 0, value = 1e5 }]\n");
  ASSERT_EQ(render({"soft.toml", "--out", "a"}).exit_code, 0);
  const auto done =
      render({"a", "--from", "0.1", "--set", "material.snow.preset=icy", "--out", "b"});
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  EXPECT_TRUE(
      contains(done.errors, "youngs_modulus is not of the preset: it follows its curve soft"))
      << done.errors;
  std::string changed;
  const app::Json run = json_of("b/run.json");
  for (const app::Json& change : run["changes"])
    changed += change["address"].get<std::string>() + " ";
  EXPECT_TRUE(contains(changed, "material.snow.hardening")) << changed;
  EXPECT_FALSE(contains(changed, "youngs_modulus")) << changed;
}

TEST_F(Fork, ColoursAndCamerasChangeWithoutATraceInTheState) {
  ASSERT_EQ(render({"scene.toml", "--out", "a"}).exit_code, 0);
  const auto done = render(
      {"a", "--from", "0.1", "--set", "view.particles.particles.color_by=J_P", "--out", "b"});
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  EXPECT_EQ(hashes("b")[4], hashes("a")[4]);
  EXPECT_TRUE(json_of("b/run.json")["changes"].empty());
  EXPECT_FALSE(app::output::read_file(folder / "a/particles/0004.png") ==
               app::output::read_file(folder / "b/particles/0004.png"));
}

TEST_F(Fork, ABranchKnowsTheViewsThatItDoesNotDraw) {
  folder.write("views.toml", std::string(tiny_scene) +
                                 "[[view]]\nname = \"slice\"\n"
                                 "slice = { normal = [0, 1, 0], point = [0, 0.05, 0] }\n");
  ASSERT_EQ(render({"views.toml", "--view", "particles", "--out", "a"}).exit_code, 0);
  const auto branch = render({"a", "--from", "0.1", "--set", "material.snow.hardening=4", "--out",
                              "b", "--view", "particles"});
  ASSERT_EQ(branch.exit_code, 0) << branch.errors;
  const auto drawn = render({"b", "--view", "slice"});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.errors;
  const std::string record = neve({"info", "b/slice/0004.png"}).output;
  EXPECT_TRUE(contains(record, "normal = [0, 1, 0]")) << record;
  EXPECT_TRUE(contains(record, "point = [0, 0.05, 0]")) << record;
}

/// Only files that the scene names counted: a branch showed the states of the mesh before.
TEST_F(Fork, AMeshOfAChangeThatIsAnotherFileIsAnotherSimulation) {
  ASSERT_EQ(render({"scene.toml", "--out", "a"}).exit_code, 0);
  const std::vector<std::string> words{
      "a",     "--from", "0.05", "--set", "collider.floor={shape={mesh={file=\"wall.obj\"}}}",
      "--out", "b"};
  folder.write("wall.obj", box_obj({1, 0.02, 1}));
  const auto first = render(words);
  ASSERT_EQ(first.exit_code, 0) << first.errors;
  const auto before = hashes("b");
  folder.write("wall.obj", box_obj({1, 0.1, 1}));
  const auto refused = render(words);
  EXPECT_EQ(refused.exit_code, 2) << refused.errors;
  EXPECT_TRUE(contains(refused.errors, "wall.obj has changed since")) << refused.errors;
  auto again = words;
  again.push_back("--replace");
  ASSERT_EQ(render(again).exit_code, 0);
  EXPECT_NE(hashes("b"), before);
}

}  // namespace
}  // namespace neve::test
