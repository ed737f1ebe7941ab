/// Pictures that are added to a finished run: nothing is simulated again, and nothing is removed
/// without a word.

#include <fstream>
#include <map>

#include "app/output/atomic_file.h"
#include "app/support/errors.h"
#include "render/image/image.h"
#include "tests/cli/run_neve.h"
#include "tests/support/child.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

class Addition : public Cli {
 protected:
  app::output::ProcessResult render(const std::vector<std::string>& more, int exit_code = 0) {
    std::vector<std::string> words{"render"};
    words.insert(words.end(), more.begin(), more.end());
    const auto done = neve(words);
    EXPECT_EQ(done.exit_code, exit_code) << done.errors;
    return done;
  }

  std::map<std::string, std::vector<std::uint8_t>> pictures(const std::string& out) {
    std::map<std::string, std::vector<std::uint8_t>> all;
    for (const auto& entry : fs::directory_iterator(folder / out))
      if (entry.path().extension() == ".png")
        all[entry.path().filename().string()] = app::output::read_file(entry.path());
    return all;
  }

  void expect_whole(const std::string& out) {
    const auto verified = neve({"verify", out});
    EXPECT_EQ(verified.exit_code, 0) << verified.output << verified.errors;
  }

  std::vector<int> states(const std::string& out) {
    return json_of(out + "/run.json")["states"]["frames"].get<std::vector<int>>();
  }
};

TEST_F(Addition, AFinishedRunIsDrawnInAnotherViewWithoutAStep) {
  const auto first = render({"scene.toml", "--out", "a", "--no-movie"});
  EXPECT_TRUE(contains(first.errors, "4 states in a/states, ")) << first.errors;
  EXPECT_TRUE(contains(first.errors, " of at most 1.0 GiB")) << first.errors;
  const auto before = pictures("a/particles");
  const auto done = render({"a", "--view", "smoke", "--no-movie"});
  EXPECT_TRUE(contains(done.errors, "5 frames of smoke added to the run in a, without simulating"))
      << done.errors;
  EXPECT_EQ(json_of("a/run.json").value("frames_from_states", 0), 4);
  EXPECT_TRUE(pictures("a/particles") == before);
  EXPECT_EQ(json_of("a/run.json")["views"], (app::Json{"particles", "smoke"}));
  expect_whole("a");
  render({"scene.toml", "--view", "smoke", "--out", "b", "--no-movie"});
  EXPECT_TRUE(pictures("a/smoke") == pictures("b/smoke"));
  EXPECT_EQ(hashes("a"), hashes("b"));
}

/// "slice" is the name of a built-in view, too.
TEST_F(Addition, ViewsThatARunDidNotDrawAreKnownByItsFolder) {
  folder.write("scene.toml", std::string(tiny_scene) + R"([[view]]
name = "slice"
layers = ["heatmap"]
[view.slice]
scalar = "pressure"
[[view]]
name = "close"
size = [64, 64]
[[mosaic]]
name = "both"
views = ["slice", "close"]
)");
  render({"scene.toml", "--view", "particles", "--out", "a", "--no-movie"});
  EXPECT_EQ(json_of("a/run.json")["views"], app::Json{"particles"});
  render({"a", "--view", "slice", "--no-movie"});
  render({"a", "--view", "both", "--no-movie"});
  render({"a", "--view", "close", "--set", "view.close.layers=[\"ground\"]", "--no-movie"});
  expect_whole("a");
  render({"scene.toml", "--view", "slice", "--out", "b", "--no-movie"});
  const auto pixels = [&](const std::string& file) {
    return render::decode_png(app::output::read_file(folder / file)).pixels;
  };
  EXPECT_EQ(pixels("a/slice/0003.png"), pixels("b/slice/0003.png"));
  EXPECT_TRUE(exists("a/both/0003.png"));
  EXPECT_TRUE(contains(neve({"info", "a/close/0002.png"}).output, "layers = [\"ground\"]"));
  EXPECT_FALSE(json_of("a/run.json").contains("undrawn")) << "all are drawn";
  // A damaged list of them is told.
  app::Json damaged = json_of("b/run.json");
  ASSERT_TRUE(damaged.contains("undrawn"));
  for (const char* text : {"view = 3", "view = [3]", "view ["}) {
    damaged["undrawn"] = text;
    folder.write("b/run.json", damaged.dump());
    const auto refused = render({"b", "--view", "close", "--no-movie"}, app::exit_invalid_scene);
    EXPECT_TRUE(contains(refused.errors, "b/run.json (its scene):")) << refused.errors;
  }
  // Without --view the views are those that the folder has, and no others.
  render({"scene.toml", "--view", "close", "--out", "c", "--no-movie"});
  render({"c", "--size", "32x32", "--out", "d", "--no-movie"});
  EXPECT_EQ(json_of("d/run.json")["views"], app::Json{"close"});
}

TEST_F(Addition, TheSameCommandAgainDrawsNothing) {
  render({"scene.toml", "--out", "a", "--no-movie"});
  const auto run = json_of("a/run.json");
  const auto again = render({"scene.toml", "--out", "a", "--no-movie"});
  EXPECT_TRUE(contains(again.errors, "nothing to draw: a has these pictures of particles"))
      << again.errors;
  EXPECT_EQ(json_of("a/run.json")["files"], run["files"]);
  EXPECT_EQ(json_of("a/run.json")["frames"], run["frames"]);
  // A picture that is missing is drawn, from its state.
  fs::remove(folder / "a/particles/0003.png");
  const auto mended = render({"a", "--no-movie"});
  EXPECT_TRUE(contains(mended.errors, "1 frame of particles added")) << mended.errors;
  EXPECT_EQ(json_of("a/run.json")["files"], run["files"]);
  expect_whole("a");
}

TEST_F(Addition, AFilmInAnotherFormatIsMadeFromThePictures) {
  const auto made = render({"scene.toml", "--out", "a", "--movie", "gif"});
  if (!exists("a/particles.gif")) GTEST_SKIP() << "no ffmpeg: " << made.errors;
  const auto more = render({"a", "--movie", "webp"});
  EXPECT_TRUE(contains(more.errors, "nothing to draw")) << more.errors;
  EXPECT_TRUE(exists("a/particles.gif"));
  EXPECT_TRUE(exists("a/particles.webp"));
  // The same film in another quality would replace the existing one.
  const auto other = render({"a", "--movie", "gif", "--movie-fps", "12"}, 2);
  EXPECT_TRUE(contains(other.errors, "it would replace particles.gif; add --replace"))
      << other.errors;
  expect_whole("a");
}

TEST_F(Addition, AnotherDrawingOfAViewIsRefusedUntilItMayReplaceIt) {
  render({"scene.toml", "--out", "a", "--no-movie"});
  const auto before = pictures("a/particles");
  for (const std::vector<std::string>& other :
       {std::vector<std::string>{"--size", "96x54"},
        {"--quality", "final"},
        {"--set", "camera.eye=[0, 1, 2]"},
        {"--set", "view.particles.particles.color_by=speed"}}) {
    std::vector<std::string> words{"a", "--no-movie"};
    words.insert(words.end(), other.begin(), other.end());
    const auto refused = render(words, 2);
    EXPECT_TRUE(contains(refused.errors, "it would replace 5 pictures of particles; add --replace"))
        << refused.errors;
    EXPECT_TRUE(pictures("a/particles") == before);
  }
  const auto done = render({"a", "--size", "96x54", "--no-movie", "--replace"});
  EXPECT_TRUE(contains(done.errors, "5 frames of particles added")) << done.errors;
  EXPECT_EQ(json_of("a/run.json").value("frames_from_states", 0), 4);
  EXPECT_FALSE(pictures("a/particles") == before);
  expect_whole("a");
  // The first drawing of all takes it back.
  render({"a", "--size", "160x90", "--no-movie", "--replace"});
  expect_whole("a");
}

TEST_F(Addition, ViewsInOtherSizesAreKnownAgain) {
  render({"scene.toml", "--out", "a", "--no-movie"});
  render({"a", "--view", "smoke", "--size", "96x54", "--no-movie"});
  for (const std::vector<std::string>& again :
       {std::vector<std::string>{"a", "--no-movie"},
        {"a", "--view", "smoke", "--no-movie"},
        {"scene.toml", "--out", "a", "--no-movie"},
        {"scene.toml", "--view", "smoke", "--size", "96x54", "--out", "a", "--no-movie"}}) {
    const auto done = render(again);
    EXPECT_TRUE(contains(done.errors, "nothing to draw")) << done.errors;
  }
  expect_whole("a");
}

/// The camera is that of the size: nobody has changed it.
TEST_F(Addition, AnotherSizeIsNamedAndNotTheCameraThatIsFoundForIt) {
  render({"scene.toml", "--out", "a", "--no-movie"});
  render({"a", "--view", "smoke", "--size", "96x96", "--no-movie"});
  for (const char* view : {"smoke", "particles"}) {
    const auto refused = render({"a", "--view", view, "--size", "64x64", "--no-movie"}, 2);
    EXPECT_TRUE(contains(refused.errors, "size was [")) << refused.errors;
    EXPECT_TRUE(contains(refused.errors, "and is [64, 64]")) << refused.errors;
    EXPECT_FALSE(contains(refused.errors, "camera")) << refused.errors;
  }
}

TEST_F(Addition, AllThatWouldBeReplacedIsNamed) {
  folder.write("scene.toml", std::string(tiny_scene) + "\n[[export]]\nformat = \"csv\"\n");
  render({"scene.toml", "--out", "a", "--no-movie", "--passes", "depth"});
  const auto refused = render({"a", "--no-movie", "--size", "96x54"}, 2);
  EXPECT_TRUE(contains(refused.errors, "it would replace 5 pictures of particles, 5 EXR of"))
      << refused.errors;
  const auto other =
      render({"scene.toml", "--out", "a", "--no-movie", "--set", "material.snow.hardening=5"}, 2);
  EXPECT_TRUE(contains(other.errors, "5 EXR of particles, 5 files in exports")) << other.errors;
}

TEST_F(Addition, AnotherSimulationIsRefusedUntilItMayReplaceTheRun) {
  render({"scene.toml", "--out", "a", "--no-movie"});
  render({"a", "--view", "smoke", "--frames", "0-1", "--no-movie"});
  const std::vector<std::string> other{"scene.toml", "--out", "a",
                                       "--no-movie", "--set", "material.snow.hardening=5",
                                       "--frames",   "0-2"};
  const auto refused = render(other, 2);
  EXPECT_TRUE(contains(refused.errors, "material.snow.hardening was 10 and is 5"))
      << refused.errors;
  EXPECT_TRUE(
      contains(refused.errors, "it would replace 5 pictures of particles, 2 pictures of smoke"))
      << refused.errors;
  expect_whole("a");
  auto words = other;
  words.push_back("--replace");
  render(words);
  EXPECT_FALSE(exists("a/smoke"));
  EXPECT_EQ(states("a"), (std::vector<int>{1, 2}));
  expect_whole("a");
}

TEST_F(Addition, TheFolderOfAnotherSceneIsRefused) {
  render({"scene.toml", "--out", "a", "--no-movie", "--frames", "0-1"});
  folder.write("other.toml", std::string(tiny_scene) + "\n[light]\nintensity = 2\n");
  folder.write("fall.toml", std::string(tiny_scene) + "\n[material.snow]\nhardening = 3\n");
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, std::vector<std::string>{"--replace"}}) {
    std::vector<std::string> words{"fall.toml", "--out", "a", "--no-movie", "--frames", "0-1"};
    words.insert(words.end(), more.begin(), more.end());
    const auto refused = render(words, 2);
    EXPECT_TRUE(contains(refused.errors, "a is the folder of another scene, scene.toml"))
        << refused.errors;
  }
  // The same simulation in other light is another drawing.
  const auto light = render({"other.toml", "--out", "a", "--no-movie", "--frames", "0-1"}, 2);
  EXPECT_TRUE(contains(light.errors, "drawn otherwise: light.intensity was 1 and is 2"))
      << light.errors;
}

TEST_F(Addition, StatesAreThinnedToTheirBudgetAndTheSameIsDrawnFromThem) {
  render({"scene.toml", "--out", "whole", "--no-movie"});
  const auto bytes = json_of("whole/run.json")["states"]["bytes"].get<std::uint64_t>();
  EXPECT_EQ(states("whole"), (std::vector<int>{1, 2, 3, 4}));
  const std::string budget = std::to_string(bytes * 6 / 10);
  const auto thin = render({"scene.toml", "--out", "a", "--no-movie", "--states-budget", budget});
  EXPECT_TRUE(contains(thin.errors, "2 states, one every 2 frames, in a/states")) << thin.errors;
  EXPECT_EQ(states("a"), (std::vector<int>{2, 4}));
  EXPECT_LE(json_of("a/run.json")["states"]["bytes"].get<std::uint64_t>(), bytes * 6 / 10);
  render({"a", "--view", "smoke", "--no-movie"});
  EXPECT_EQ(json_of("a/run.json").value("frames_from_states", 0), 2);
  EXPECT_EQ(hashes("a"), hashes("whole"));
  // One that takes more than all of it is not kept, and that is said.
  const auto none = render({"scene.toml", "--out", "b", "--no-movie", "--states-budget", "1000"});
  EXPECT_TRUE(contains(none.errors, "no states kept: one takes ")) << none.errors;
  EXPECT_FALSE(exists("b/states"));
  render({"scene.toml", "--out", "c", "--no-movie", "--no-keep-states"});
  EXPECT_FALSE(exists("c/states"));
  EXPECT_FALSE(json_of("c/run.json").contains("states"));
}

TEST_F(Addition, StatesThatCannotBeWrittenCostNoPicture) {
  folder.write("a/states", "in the way");
  const auto done = render({"scene.toml", "--out", "a", "--no-movie"});
  EXPECT_TRUE(contains(done.errors, "the run continues without states")) << done.errors;
  EXPECT_EQ(pictures("a/particles").size(), 5u);
  EXPECT_EQ(read_text(folder / "a/states"), "in the way");
  render({"scene.toml", "--out", "a", "--no-movie", "--replace", "--keep-states"}, 6);
}

TEST_F(Addition, ARunIsDrawnElsewhereWithAnotherCamera) {
  render({"scene.toml", "--out", "a", "--no-movie"});
  const std::vector<std::string> camera{"--set", "camera.eye=[0, 1, 2]", "--set",
                                        "camera.target=[0, 0, 0]", "--no-movie"};
  auto from_run = camera, fresh = camera;
  from_run.insert(from_run.begin(), {"a", "--out", "c"});
  fresh.insert(fresh.begin(), {"scene.toml", "--out", "d"});
  render(from_run);
  render(fresh);
  EXPECT_EQ(json_of("c/run.json").value("frames_from_states", 0), 4);
  EXPECT_TRUE(pictures("c/particles") == pictures("d/particles"));
  const auto refused = render({"a", "--set", "material.snow.hardening=5"}, 2);
  EXPECT_TRUE(contains(refused.errors, "material.snow.hardening belongs to the simulation"))
      << refused.errors;
}

/// The camera that was found for the shape of the run cut the snow off.
TEST_F(Addition, ARunInAnotherShapeIsFramedAnew) {
  const std::vector<std::string> tall{"--size", "48x120", "--no-movie"};
  const auto drawn = [&](const char* source, const char* out) {
    std::vector<std::string> words{source, "--out", out};
    words.insert(words.end(), tall.begin(), tall.end());
    render(words);
    return pictures(std::string(out) + "/particles");
  };
  render({"scene.toml", "--out", "a", "--no-movie"});
  const auto fresh = drawn("scene.toml", "b");
  EXPECT_TRUE(drawn("a", "c") == fresh);
  const auto pixels = [&](const std::string& file) {
    return render::decode_png(app::output::read_file(folder / file)).pixels;
  };
  drawn("a/particles/0003.png", "d");
  EXPECT_TRUE(pixels("d/particles/0003.png") == pixels("b/particles/0003.png"));
  const auto compared = [&] {
    const auto done = neve({"compare", "a", "a", "--mode", "beside", "--frames", "3-3", "--size",
                            "48x120", "--out", "pair.png"});
    EXPECT_EQ(done.exit_code, 0) << done.errors;
    return pixels("pair.png");
  };
  const auto of_run = compared();
  fs::rename(folder / "a", folder / "wide");
  fs::rename(folder / "c", folder / "a");
  EXPECT_TRUE(compared() == of_run);
}

/// It ended where the run does, and said that all is well.
TEST_F(Addition, AnotherLengthOfARunIsThatOfItsScene) {
  render({"scene.toml", "--out", "a", "--no-movie"});
  render({"scene.toml", "--out", "long", "--no-movie", "--set", "frames=6"});
  render({"a", "--out", "b", "--no-movie", "--set", "frames=6"});
  EXPECT_EQ(hashes("b"), hashes("long"));
  EXPECT_EQ(hashes("b").size(), 7u);
  render({"a", "--out", "c", "--no-movie", "--set", "frames=2"});
  EXPECT_EQ(hashes("c").size(), 3u);
  render({"a", "--from", "0.125s", "--out", "d", "--no-movie", "--set", "frames=6"});
  EXPECT_EQ(hashes("d").rbegin()->first, 6);
  const auto swept = neve({"sweep", "a", "--from", "0.125s", "--out", "s.cdb", "--size", "96x54",
                           "--set", "frames=5", "-p", "material.snow.hardening=4"});
  EXPECT_EQ(swept.exit_code, 0) << swept.errors;
  EXPECT_EQ(hashes("s.cdb/runs/0000").rbegin()->first, 5);
  const auto exported = neve({"export", "a", "--format", "csv", "--set", "frames=5"});
  EXPECT_EQ(exported.exit_code, 0) << exported.errors;
  EXPECT_TRUE(exists("a/exports/csv/0005.csv"));
}

/// Later frames of a run start as later frames of its scene do.
TEST_F(Addition, LaterFramesOfARunKnowWhatWasBeforeThem) {
  render({"scene.toml", "--out", "a", "--no-movie"});
  render({"scene.toml", "--frames", "2-3", "--out", "b", "--no-movie"});
  render({"a", "--frames", "2-3", "--out", "c", "--no-movie"});
  const app::Json start = json_of("b/run.json")["start"];
  ASSERT_TRUE(start.contains("before"));
  EXPECT_EQ(json_of("c/run.json")["start"], start);
  render({"b", "--out", "d", "--no-movie", "--set", "first_frame=1001"});
  app::Json moved = start;
  moved["before"]["frame"] = 1002;
  EXPECT_EQ(json_of("d/run.json")["start"], moved);
}

TEST_F(Addition, FramesBetweenThoseThatAreThereAndTheNewOnesAreDrawnToo) {
  render({"scene.toml", "--out", "a", "--no-movie", "--frames", "0-1"});
  render({"a", "--view", "smoke", "--no-movie", "--frames", "3-4"});
  EXPECT_EQ(pictures("a/smoke").size(), 3u);
  EXPECT_EQ(pictures("a/particles").size(), 2u);
  EXPECT_EQ(json_of("a/run.json")["view_frames"],
            (app::Json{{"particles", {0, 1}}, {"smoke", {2, 4}}}));
  expect_whole("a");
  render({"scene.toml", "--out", "a", "--no-movie"});
  EXPECT_EQ(pictures("a/particles").size(), 5u);
  expect_whole("a");
}

TEST_F(Addition, StripAndExportOfARunSimulateNothing) {
  render({"scene.toml", "--out", "a", "--no-movie", "--frames", "0-3"});
  const auto strip = neve({"strip", "a", "--view", "smoke", "--tiles", "4", "--verbose"});
  EXPECT_EQ(strip.exit_code, 0) << strip.errors;
  EXPECT_TRUE(contains(strip.errors, "4 of 4 moments in a/strip_smoke.png")) << strip.errors;
  const auto exported = neve({"export", "a", "--format", "ply"});
  EXPECT_EQ(exported.exit_code, 0) << exported.errors;
  EXPECT_TRUE(exists("a/exports/ply/0003.ply"));
  EXPECT_FALSE(exists("a/exports/ply/0004.ply")) << "the run has frames 0 to 3";
}

TEST_F(Addition, ExportsOfARunStayWhenAViewIsAdded) {
  folder.write("scene.toml",
               std::string(tiny_scene) + "\n[[export]]\nname = \"mesh\"\nformat = \"ply\"\n");
  render({"scene.toml", "--out", "a", "--no-movie"});
  const auto exports = json_of("a/run.json")["exports"];
  render({"a", "--view", "smoke", "--no-movie"});
  EXPECT_EQ(json_of("a/run.json")["exports"], exports);
  expect_whole("a");
  const std::vector<std::string> same{"scene.toml", "--out", "a", "--no-movie"};
  EXPECT_TRUE(contains(render(same).errors, "nothing to draw"));
  std::filesystem::remove(folder / "a/exports/mesh/0002.ply");
  EXPECT_TRUE(contains(render(same).errors, "1 frame of particles added"));
  EXPECT_EQ(json_of("a/run.json")["exports"], exports);
  expect_whole("a");
  const auto refused =
      render({"scene.toml", "--out", "a", "--no-movie", "--set", "export.mesh.scale=2"}, 2);
  EXPECT_TRUE(contains(refused.errors, "other exports")) << refused.errors;
  // Files that --replace removes are not listed.
  render({"scene.toml", "--out", "a", "--no-movie", "--set", "export.mesh.every=2", "--replace"});
  for (const app::Json& file : json_of("a/run.json")["exports"][0]["files"])
    EXPECT_EQ(file["number"].get<int>() % 2, 0) << file.dump();
  expect_whole("a");
}

/// A run may be longer than its scene; a drawing of it elsewhere has all of it, resumed or not.
TEST_F(Addition, AnotherDrawingOfAnExtendedRunHasAllOfItsFrames) {
  render({"scene.toml", "--out", "a", "--no-movie"});
  render({"a", "--no-movie", "--resume", "--frames", "0-6"});
  render({"a", "--no-movie", "--view", "smoke", "--out", "b", "--frames", "0-2"});
  render({"a", "--no-movie", "--view", "smoke", "--out", "b", "--resume"});
  EXPECT_EQ(hashes("b"), hashes("a"));
  EXPECT_EQ(hashes("b").size(), 7u);
  // The folder of the run itself is no other one, although it is named twice.
  render({"scene.toml", "--out", "c", "--no-movie", "--frames", "0-2"});
  render({"c", "--no-movie", "--resume", "--out", "./c"});
  EXPECT_EQ(hashes("c").size(), 5u);
}

/// A run under its own numbers had other frames, or none: frame 0 had the state of frame 1.
TEST_F(Addition, FramesOfARunKeepTheirStatesUnderOtherNumbers) {
  render({"scene.toml", "--out", "a", "--no-movie"});
  const auto before = hashes("a");
  for (const auto& [change, first] :
       {std::pair{"first_frame=1001", 1001}, std::pair{"handles=1", -1}}) {
    const std::string out = std::string("of_") + std::to_string(first);
    render({"a", "--set", change, "--out", out, "--no-movie"});
    const auto after = hashes(out);
    ASSERT_EQ(after.size(), before.size()) << change;
    for (const auto& [frame, hash] : before) EXPECT_EQ(after.at(frame + first), hash) << change;
    for (const char* command : {"export", "strip"}) {
      std::vector<std::string> words{command, "a", "--set", change, "--out"};
      words.push_back(command + out + (command == std::string("strip") ? ".png" : ""));
      if (command == std::string("export")) words.insert(words.end(), {"--format", "csv"});
      const auto done = neve(words);
      EXPECT_EQ(done.exit_code, 0) << done.errors;
      EXPECT_FALSE(contains(done.errors, "another state")) << done.errors;
    }
  }
  EXPECT_TRUE(exists("exportof_1001/csv/1001.csv"));
}

TEST_F(Addition, FramesOfOtherNumbersAreNotMixedWithThoseThatAreThere) {
  render({"scene.toml", "--out", "a", "--no-movie"});
  const std::string record = read_text(folder / "a/run.json");
  for (const char* change : {"first_frame=2", "handles=2"}) {
    const auto added = render({"scene.toml", "--set", change, "--out", "a", "--view", "smoke"}, 2);
    EXPECT_TRUE(contains(added.errors, "a has frames from 0 on, and these begin with ")) << change;
    EXPECT_TRUE(contains(added.errors, "add --replace, or choose another folder with --out"));
    // A run that replaces itself in its own folder would lose what it has besides its pictures.
    const auto own = render({"a", "--set", change, "--view", "smoke", "--replace"}, 2);
    EXPECT_TRUE(contains(own.errors, "; choose another folder with --out")) << own.errors;
  }
  EXPECT_EQ(read_text(folder / "a/run.json"), record);
  render({"scene.toml", "--set", "first_frame=2", "--out", "a", "--no-movie", "--replace"});
  EXPECT_EQ(hashes("a").begin()->first, 2);
  EXPECT_EQ(hashes("a").size(), 5u);
  expect_whole("a");
  // Files of an export are not replaced either.
  const std::vector<std::string> exported{"export", "scene.toml", "--format", "csv", "--out", "e"};
  EXPECT_EQ(neve(exported).exit_code, 0);
  const std::string first = read_text(folder / "e/csv/0000.csv");
  std::vector<std::string> others = exported;
  others.insert(others.end(), {"--set", "handles=1"});
  const auto refused = neve(others);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(contains(refused.errors, "at other frames or times")) << refused.errors;
  EXPECT_EQ(read_text(folder / "e/csv/0000.csv"), first);
  EXPECT_EQ(neve(exported).exit_code, 0) << "the same again";
}

/// run.json had the scene of the first drawing: drawn again, a dark picture was light.
TEST_F(Addition, TheSceneOfARunIsTheOneThatAllOfItsPicturesShow) {
  render({"scene.toml", "--out", "a", "--no-movie"});
  render({"scene.toml", "--out", "a", "--no-movie", "--replace", "--set", "light.intensity=0.2",
          "--set", "title=Dark"});
  const std::string scene = json_of("a/run.json")["scene"];
  EXPECT_TRUE(contains(scene, "intensity = 0.2") && contains(scene, "title = \"Dark\"")) << scene;
  render({"a", "--out", "b", "--no-movie"});
  EXPECT_TRUE(pictures("a/particles") == pictures("b/particles"));
  render({"a", "--no-movie", "--resume"});
  render({"a", "--no-movie", "--view", "smoke"});
  // A run has one light.
  for (const std::string more : {"--quiet", "--replace"}) {
    const auto refused =
        render({"a", "--no-movie", "--view", "smoke", "--set", "light.intensity=1", more}, 2);
    EXPECT_TRUE(contains(refused.errors,
                         "pictures of particles drawn otherwise, and all of a run "
                         "share it: light.intensity was 0.2 and is 1"))
        << refused.errors;
  }
  render({"a", "--no-movie", "--view", "smoke", "--view", "particles", "--set", "light.intensity=1",
          "--replace"});
  EXPECT_FALSE(contains(json_of("a/run.json")["scene"], "intensity = 0.2"));
  expect_whole("a");
}

TEST_F(Addition, WholeTablesOfTheSimulationAreNoDrawing) {
  render({"scene.toml", "--out", "a", "--no-movie", "--frames", "0"});
  for (const char* change : {"solver={cell_size=0.04, gravity=[0, 5, 0]}", "solver=none", "dust={}",
                             "dust=none", "collider.floor=none"}) {
    const auto refused = render({"a", "--set", change, "--out", "b"}, 2);
    EXPECT_TRUE(contains(refused.errors, " belongs to the simulation")) << refused.errors;
  }
}

/// The program advises --resume: it ended at the last frame of the scene, and drew frames that
/// nobody had asked for.
TEST_F(Addition, AResumedRunHasTheFramesThatItWasAskedFor) {
  render({"scene.toml", "--out", "whole", "--no-movie", "--frames", "2-40"});
  const pid_t child = start_program({NEVE_BINARY, "render", folder / "scene.toml", "--out",
                                     folder / "a", "--frames", "2-40", "--quiet", "--no-movie"});
  ASSERT_TRUE(wait_for_file(folder / "a/particles/0004.png"));
  ::kill(child, SIGINT);
  EXPECT_EQ(wait_for(child), 75);
  EXPECT_EQ(json_of("a/run.json")["frames_asked"], (app::Json{2, 40}));
  const auto more = render({"a", "--resume", "--no-movie"});
  EXPECT_FALSE(contains(more.errors, "missing")) << more.errors;
  EXPECT_EQ(hashes("a"), hashes("whole"));
  EXPECT_FALSE(exists("a/particles/0001.png"));
  // One that has them continues to the end of its scene.
  render({"scene.toml", "--out", "b", "--no-movie", "--frames", "1-2"});
  render({"b", "--resume", "--no-movie"});
  EXPECT_EQ(hashes("b").begin()->first, 1);
  EXPECT_EQ(hashes("b").rbegin()->first, 4);
}

/// They made it "ok" and complete, and it forgot the frames that it lacks.
TEST_F(Addition, OtherPicturesFinishNoRunThatWasKilledOrFailed) {
  render({"scene.toml", "--out", "whole", "--no-movie", "--frames", "0-30"});
  const pid_t child = start_program({NEVE_BINARY, "render", folder / "scene.toml", "--out",
                                     folder / "a", "--frames", "0-30", "--quiet", "--no-movie"});
  ASSERT_TRUE(wait_for_file(folder / "a/particles/0003.png"));
  ::kill(child, SIGKILL);
  wait_for(child);
  const auto expect_unfinished = [&](const std::string& status) {
    const app::Json run = json_of("a/run.json");
    EXPECT_EQ(run["status"], status);
    EXPECT_EQ(run["frames_asked"], (app::Json{0, 30}));
    EXPECT_TRUE(contains(neve({"verify", "a"}).output, "not finished: its status is " + status));
    EXPECT_TRUE(contains(neve({"info", "a"}).output, status));
  };
  expect_unfinished("running");
  render({"a", "--no-movie", "--view", "smoke", "--frames", "0-2"});
  expect_unfinished("interrupted");
  render({"a", "--no-movie", "--set", "camera.eye=[0, 1, 2]", "--replace"});
  expect_unfinished("interrupted");
  app::Json failed = json_of("a/run.json");
  failed["status"] = "failed";
  failed["error"] = "no space";
  folder.write("a/run.json", failed.dump());
  render({"a", "--no-movie", "--view", "smoke"});
  expect_unfinished("failed");
  EXPECT_EQ(json_of("a/run.json").value("error", ""), "no space");
  render({"a", "--no-movie", "--resume"});
  EXPECT_EQ(json_of("a/run.json")["status"], "ok");
  EXPECT_FALSE(json_of("a/run.json").contains("error"));
  EXPECT_EQ(hashes("a"), hashes("whole"));
  expect_whole("a");
}

/// A command that draws other pictures may be interrupted, too.
TEST_F(Addition, AFinishedRunIsFinishedAgainOnceItsPicturesAreDrawn) {
  render({"scene.toml", "--out", "a", "--no-movie"});
  app::Json run = json_of("a/run.json");
  run["status"] = "interrupted";
  folder.write("a/run.json", run.dump());
  render({"a", "--no-movie", "--view", "smoke"});
  EXPECT_EQ(json_of("a/run.json")["status"], "ok");
  expect_whole("a");
}

/// Pictures that were to be replaced were gone before it was told that they cannot be written.
TEST_F(Addition, ALinkInThePlaceOfAViewCostsNoPicture) {
  render({"scene.toml", "--out", "a", "--no-movie"});
  render({"a", "--view", "smoke", "--no-movie"});
  const auto before = pictures("a/particles");
  fs::rename(folder / "a/smoke", folder / "elsewhere");
  fs::create_symlink(folder / "elsewhere", folder / "a/smoke");
  const auto refused = render({"a", "--no-movie", "--size", "96x54", "--replace"}, 6);
  EXPECT_TRUE(contains(refused.errors, "a/smoke: is a link")) << refused.errors;
  EXPECT_TRUE(pictures("a/particles") == before);
  EXPECT_EQ(json_of("a/run.json")["status"], "ok");
}

/// The checkpoint knows them as they were drawn first: it called them damaged, and put the first
/// drawing in their place.
TEST_F(Addition, ADrawingThatReplacedAnotherIsNotReplacedByAResumedRun) {
  for (const std::vector<std::string>& other :
       {std::vector<std::string>{"--set", "camera.eye=[0, 1, 2]"},
        {"--quality", "final"},
        {"--passes", "depth"}}) {
    render({"scene.toml", "--out", "a", "--no-movie", "--frames", "0-3", "--replace"});
    std::vector<std::string> words{"a", "--no-movie", "--replace"};
    words.insert(words.end(), other.begin(), other.end());
    render(words);
    const auto before = pictures("a/particles");
    const auto refused = render({"scene.toml", "--out", "a", "--no-movie", "--resume"}, 2);
    EXPECT_TRUE(contains(refused.errors, "drawn otherwise")) << refused.errors;
    EXPECT_FALSE(contains(refused.errors, "is not the file")) << refused.errors;
    EXPECT_TRUE(pictures("a/particles") == before);
    expect_whole("a");
    words[2] = "--resume";
    render(words);
    EXPECT_TRUE(exists("a/particles/0004.png"));
    for (const auto& [name, bytes] : before) EXPECT_TRUE(pictures("a/particles")[name] == bytes);
    expect_whole("a");
  }
}

/// Frames that are drawn again have had fewer steps: their number stood beside that of the run.
TEST_F(Addition, WarningsOfStepsHaveTheNumbersOfTheWholeRun) {
  folder.write("scene.toml", exploding_scene);
  render({"scene.toml", "--out", "a", "--no-movie"}, 5);
  const app::Json before = json_of("a/run.json")["warnings"];
  ASSERT_EQ(before.size(), 1u) << before;
  EXPECT_TRUE(contains(before[0], "the acoustic CFL reached"));
  render({"a", "--view", "smoke", "--no-movie"});
  EXPECT_EQ(json_of("a/run.json")["warnings"], before);
}

TEST_F(Addition, AWarningOfStepsGrowsWithTheRun) {
  folder.write("scene.toml", std::string(tiny_scene) + R"([[emitter]]
name = "hose"
shape = { sphere = { center = [0, 0.15, 0], radius = 0.1 } }
velocity = [0, 0, 0]
rate = 200
)");
  const auto warnings = [&] { return json_of("a/run.json")["warnings"].dump(); };
  render({"scene.toml", "--out", "a", "--no-movie", "--frames", "0-2"});
  const std::string before = warnings();
  ASSERT_TRUE(contains(before, "particles found no room")) << before;
  render({"a", "--resume", "--no-movie", "--frames", "0-4"});
  const std::string after = warnings();
  EXPECT_NE(after, before);
  const std::string words = "found no room";
  EXPECT_EQ(after.find(words), after.rfind(words)) << after;
}

TEST_F(Addition, ARunThatGrowsWritesItsExports) {
  folder.write("scene.toml",
               std::string(tiny_scene) + "\n[[export]]\nname = \"mesh\"\nformat = \"ply\"\n");
  render({"scene.toml", "--out", "a", "--no-movie", "--frames", "0-3"});
  render({"a", "--no-movie", "--frames", "0-6"});
  for (int frame = 0; frame <= 6; ++frame)
    EXPECT_TRUE(exists("a/exports/mesh/000" + std::to_string(frame) + ".ply")) << frame;
  EXPECT_EQ(json_of("a/run.json")["exports"][0]["files"].size(), 7u);
  expect_whole("a");
}

/// They were overwritten without a word.
TEST_F(Addition, FilesThatNoRunHasMadeAreNotReplacedInSilence) {
  for (const char* file : {"a/particles/0003.png", "b/particles.gif"}) {
    folder.write(file, "mine");
    const std::string out = std::string(file).substr(0, 1);
    std::vector<std::string> words{"scene.toml", "--out", out, "--movie", "gif"};
    if (out == "b" && !app::output::find_program("ffmpeg")) continue;
    const auto refused = render(words, 2);
    EXPECT_TRUE(contains(refused.errors, out +
                                             " has files that no run there has made; it would "
                                             "replace " +
                                             std::string(file).substr(2)))
        << refused.errors;
    EXPECT_EQ(read_text(folder / file), "mine");
    words.push_back("--replace");
    render(words);
    EXPECT_NE(read_text(folder / file), "mine");
    expect_whole(out);
  }
  folder.write("c/particles/0009.png", "mine");
  render({"scene.toml", "--out", "c", "--no-movie"});
  EXPECT_EQ(read_text(folder / "c/particles/0009.png"), "mine") << "no frame of the run";
}

/// They counted as no run: its states went, and pictures of the old simulation stayed among the new
/// ones.
TEST_F(Addition, ADamagedOrForeignRunJsonIsNotWrittenOverInSilence) {
  render({"scene.toml", "--out", "a", "--no-movie"});
  const std::string whole = read_text(folder / "a/run.json");
  const auto before = pictures("a/particles");
  for (const std::string& text :
       {whole.substr(0, whole.size() / 2), std::string(), std::string(R"({"mine": [1, 2]})")}) {
    folder.write("a/run.json", text);
    const auto refused =
        render({"scene.toml", "--out", "a", "--no-movie", "--frames", "2", "--set", "seed=2"}, 2);
    EXPECT_TRUE(contains(refused.errors, "a has a run.json that neve cannot read")) << text;
    EXPECT_EQ(read_text(folder / "a/run.json"), text);
    EXPECT_TRUE(pictures("a/particles") == before);
    EXPECT_TRUE(exists("a/states/000003.ckpt"));
  }
  render({"scene.toml", "--out", "a", "--no-movie", "--resume"});
  expect_whole("a");
  folder.write("a/run.json", R"({"mine": [1, 2]})");
  render({"scene.toml", "--out", "a", "--no-movie", "--replace"});
  expect_whole("a");
}

/// Its exports are files of the run, too.
TEST_F(Addition, ForeignFilesInThePlaceOfItsExportsAreNotReplacedInSilence) {
  folder.write("scene.toml", std::string(tiny_scene) +
                                 "[[export]]\nname = \"geo\"\nformat = \"ply\"\nevery = 2\n");
  folder.write("a/exports/geo/0002.ply", "mine");
  const auto refused = render({"scene.toml", "--out", "a", "--no-movie"}, 2);
  EXPECT_TRUE(contains(refused.errors, "it would replace exports/geo/0002.ply")) << refused.errors;
  EXPECT_EQ(read_text(folder / "a/exports/geo/0002.ply"), "mine");
  render({"scene.toml", "--out", "a", "--no-movie", "--replace"});
  expect_whole("a");
}

/// "a" and "./a" were two folders.
TEST_F(Addition, ARunByAnotherNameOfItsFolderKeepsItsStates) {
  render({"scene.toml", "--out", "a", "--no-movie", "--frames", "2"});
  render({"a", "--out", "./a", "--no-movie", "--frames", "4"});
  EXPECT_EQ(states("a"), (std::vector<int>{1, 2, 3, 4}));
}

/// Views say that they have captions, which is a matter of their layers.
TEST_F(Addition, ARunWithAMosaicWithoutACaptionIsContinued) {
  folder.write("scene.toml",
               std::string(tiny_scene) + "[[mosaic]]\nname = \"both\"\nviews = [\"particles\"]\n");
  render({"scene.toml", "--out", "a", "--no-movie", "--no-caption", "--frames", "2"});
  render({"a", "--resume", "--no-movie", "--frames", "4"});
  render({"scene.toml", "--out", "whole", "--no-movie", "--no-caption"});
  EXPECT_TRUE(pictures("a/both") == pictures("whole/both"));
}

/// Files of a run are replaced by commands that draw the run, and by no other.
TEST_F(Addition, OtherOutputsDoNotReplaceItsFiles) {
  render({"scene.toml", "--out", "a", "--no-movie"});
  const std::string record = read_text(folder / "a/run.json");
  const auto dumped = neve({"dump", "a", "--at", "0.1", "--out", "a/run.json"});
  EXPECT_EQ(dumped.exit_code, 2);
  EXPECT_TRUE(contains(dumped.errors, "a/run.json belongs to what neve wrote into"))
      << dumped.errors;
  const auto before = pictures("a/particles");
  const auto strip = neve({"strip", "a", "--out", "a/particles/0001.png"});
  EXPECT_EQ(strip.exit_code, 2);
  EXPECT_TRUE(contains(strip.errors, "a/particles/0001.png belongs to what neve wrote into"))
      << strip.errors;
  EXPECT_TRUE(pictures("a/particles") == before);
  EXPECT_EQ(read_text(folder / "a/run.json"), record);
  for (int time = 0; time < 2; ++time) {
    EXPECT_EQ(neve({"strip", "a", "--out", "a/strip.png"}).exit_code, 0) << "its own";
    EXPECT_EQ(neve({"dump", "a", "--at", "0.1", "--out", "status.json"}).exit_code, 0)
        << "a name that somebody else has given";
  }
}

/// The simulation was done: the run stayed interrupted, whatever was drawn of it afterwards.
TEST_F(Addition, AnInterruptedDrawingOfAWholeRunIsFinishedByItsCommand) {
  render({"scene.toml", "--out", "a", "--frames", "0-40", "--no-movie"});
  const std::filesystem::path printed = folder / "printed";
  const auto interrupt = [&](const std::string& words, const std::string& picture) {
    const pid_t child =
        start_program({"/bin/sh", "-c",
                       "cd " + folder.path().string() + " && exec " NEVE_BINARY " render " + words +
                           " --no-movie 2>" + printed.string()});
    ASSERT_TRUE(wait_for_file(folder / picture));
    ::kill(child, SIGINT);
    EXPECT_EQ(wait_for(child), 75) << read_text(printed);
    EXPECT_EQ(json_of("a/run.json")["status"], "interrupted");
    EXPECT_FALSE(contains(read_text(printed), "--resume")) << read_text(printed);
  };
  interrupt("a --view smoke --size 320x180", "a/smoke/0001.png");
  EXPECT_TRUE(contains(read_text(printed), "the same command continues from here"));
  // A part of the rest is not all of it.
  render({"a", "--view", "smoke", "--size", "320x180", "--frames", "0-39", "--no-movie"});
  EXPECT_EQ(json_of("a/run.json")["status"], "interrupted");
  render({"a", "--view", "smoke", "--size", "320x180", "--no-movie"});
  EXPECT_EQ(json_of("a/run.json")["status"], "ok");
  expect_whole("a");
  fs::remove_all(folder / "a/particles");
  interrupt("a --view particles --quality final --replace", "a/particles/0001.png");
  EXPECT_TRUE(
      contains(read_text(printed), "the same command without --replace continues from here"));
  render({"a", "--view", "particles", "--quality", "final", "--no-movie"});
  EXPECT_EQ(json_of("a/run.json")["status"], "ok");
  expect_whole("a");
}

/// The record keeps all frames that were simulated, drawn or not.
TEST_F(Addition, ADrawingThatFailsKeepsTheRecordsOfTheFrames) {
  render({"scene.toml", "--out", "a", "--no-movie"});
  const auto before = hashes("a");
  fs::remove(folder / "a/particles/0003.png");
  fs::create_directories(folder / "a/particles/0003.png");
  render({"a", "--size", "96x54", "--replace", "--no-movie"}, app::exit_io);
  EXPECT_EQ(json_of("a/run.json")["status"], "failed");
  EXPECT_EQ(hashes("a"), before);
}

TEST_F(Addition, AnInterruptedRunIsFinishedByItsNameAlone) {
  render({"scene.toml", "--out", "whole", "--no-movie"});
  render({"scene.toml", "--out", "a", "--no-movie", "--frames", "0-2"});
  const auto more = render({"a", "--resume", "--no-movie"});
  EXPECT_TRUE(contains(more.errors, "resumed after frame 2")) << more.errors;
  EXPECT_EQ(hashes("a"), hashes("whole"));
  // Another view of a run needs no checkpoint of it.
  render({"a", "--view", "smoke", "--frames", "0-1", "--no-movie"});
  render({"scene.toml", "--out", "a", "--resume", "--no-movie"});
  expect_whole("a");
  EXPECT_EQ(pictures("a/smoke").size(), 2u);
}

}  // namespace
}  // namespace neve::test
