/// Answers for programs: JSON everywhere, progress as JSON lines, logs, NEVE_OUT; and suggestions.

#include <sstream>

#include "app/output/atomic_file.h"
#include "render/image/image.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

app::Json json(const std::string& text) {
  return app::parse_json(std::string_view(text));
}

/// The JSON lines of a stream, in order.
std::vector<app::Json> events(const std::string& text) {
  std::vector<app::Json> list;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) list.push_back(json(line));
  return list;
}

TEST_F(Cli, EveryCommandAnswersInJson) {
  EXPECT_EQ(json(neve({"version", "--json"}).output)["name"], "neve");
  const auto run = neve({"render", "scene.toml", "--frames", "1", "--no-movie", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const app::Json result = json(run.output);
  EXPECT_EQ(result["exit_code"], 0);
  EXPECT_TRUE(exists(result["run_json"].get<std::string>())) << run.output;
  EXPECT_TRUE(result["warnings"].is_array());
  const app::Json check = json(neve({"check", "scene.toml", "--json"}).output);
  EXPECT_TRUE(check["particles"].is_number_integer()) << check["particles"];
  EXPECT_TRUE(check["steps"].is_number_integer()) << check["steps"];
  EXPECT_TRUE(json(neve({"render", "scene.toml", "--dry-run", "--json"}).output)["particles"]
                  .is_number_integer());
  const auto sweep = neve({"sweep", "scene.toml", "-p", "seed=1,2", "--frames", "0", "--json"});
  ASSERT_EQ(sweep.exit_code, 0) << sweep.errors;
  const std::string folder_of_sweep = json(sweep.output)["out"].get<std::string>();
  EXPECT_EQ(json(sweep.output)["exit_code"], 0);
  EXPECT_EQ(json(neve({"sweep", "run", folder_of_sweep, "--index", "0", "--json"}).output)["ok"],
            1);
  const app::Json whole = json(neve({"sweep", "collect", folder_of_sweep, "--json"}).output);
  EXPECT_EQ(whole["exit_code"], 0);
  EXPECT_EQ(whole["ok"], 2);
  EXPECT_EQ(whole["unfinished"], 0);
  // One of the two is lost.
  std::filesystem::remove_all(folder.path() / folder_of_sweep / "runs" / "0001");
  const auto half = neve({"sweep", "collect", folder_of_sweep, "--json"});
  EXPECT_EQ(json(half.output)["unfinished"], 1) << half.output;
  EXPECT_TRUE(contains(half.errors, "1 of 2 runs is not finished")) << half.errors;
}

TEST_F(Cli, WordsOfOtherProgramsGetTheWordsOfThisOne) {
  folder.write("points.npz", std::string("PK\3\4\0\0id.npy", 13));
  folder.write("points.vtp", "<?xml version=\"1.0\"?>\n<VTKFile>\n");
  const std::string points = "body.ball.shape={ points = { file = \"points.";
  const std::vector<std::pair<std::vector<std::string>, const char*>> cases{
      {{"export", "scene.toml", "--format", "ply", "--up", "Z"}, "did you mean z?"},
      {{"export", "scene.toml", "--format", "ply", "--attributes", "id,velocity"},
       "did you mean v?"},
      {{"sweep", "scene.toml", "-p", "seed=1,2", "--resume"}, "the same command continues"},
      {{"completion"}, "neve manual DIR"},
      {{"render", "scene.toml", "--max-memory", "16"}, "did you mean 16GiB?"},
      {{"render", "scene.toml", "--max-memory", "1KiB"}, "expected a size such as 8GiB"},
      {{"params", "--markdown"}, "give --wishes too"},
      {{"sweep", "str", "out/study", "0"}, "did you mean neve sweep star?"},
      {{"sweep", "promot", "out/study", "0"}, "did you mean neve sweep promote?"},
      {{"check", "scene.toml", "--set", points + "npz\" } }"}, "it is not a table of points"},
      {{"check", "scene.toml", "--set", points + "vtp\" } }"}, "it is not a table of points"},
      {{"render", "scene.toml", "--out", "scene.toml"}, "is what the command reads"}};
  for (const auto& [command, expected] : cases) {
    const auto answer = neve(command);
    EXPECT_NE(answer.exit_code, 0) << command.front();
    EXPECT_TRUE(contains(answer.errors, expected)) << answer.errors;
  }
  EXPECT_EQ(neve({"render", "--dry-run", "--", "scene.toml"}).exit_code, 0);
}

TEST_F(Cli, ErrorsInJsonHaveCodeAndPlace) {
  folder.write("wrong.toml", "frames = 4\n[solver]\ncell_sise = 0.04\n");
  const auto wrong = neve({"render", "wrong.toml", "--json"});
  EXPECT_EQ(wrong.exit_code, 3);
  const app::Json error = json(wrong.output);
  EXPECT_EQ(error["exit_code"], 3);
  EXPECT_EQ(error["file"], "wrong.toml");
  EXPECT_EQ(error["line"], 3);
  EXPECT_EQ(error["column"], 1);
  EXPECT_TRUE(error["warnings"].empty());
  // The place is not said again in the message.
  const app::Json missing = json(neve({"compare", "none.png", "scene.toml", "--json"}).output);
  EXPECT_EQ(missing["error"], "does not exist");
  EXPECT_EQ(missing["where"], "none.png");
  EXPECT_EQ(missing["exit_code"], 6);
  EXPECT_EQ(json(neve({"render", "--nonsense", "--json"}).output)["exit_code"], 2);
  folder.write("bang.toml", exploding_scene);
  const auto diverged = neve({"render", "bang.toml", "--json", "--quiet"});
  EXPECT_EQ(json(diverged.output)["exit_code"], 5) << diverged.output;
  EXPECT_FALSE(json(diverged.output)["warnings"].empty()) << diverged.output;
  // A script finds what is left of it as it finds a run that holds.
  EXPECT_EQ(json(diverged.output)["status"], "diverged");
  EXPECT_FALSE(json(diverged.output)["error"].empty());
  EXPECT_TRUE(
      std::filesystem::exists(folder.path() / json(diverged.output)["run_json"].get<std::string>()))
      << diverged.output;
}

TEST_F(Cli, ProgressAsJsonIsOneObjectALine) {
  const auto run =
      neve({"render", "scene.toml", "--frames", "2", "--no-movie", "--progress", "json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const std::vector<app::Json> list = events(run.errors);
  std::vector<int> frames;
  for (const app::Json& event : list)
    if (event["event"] == "frame" && (frames.empty() || frames.back() != event["frame"]))
      frames.push_back(event["frame"].get<int>());
  EXPECT_EQ(frames, (std::vector<int>{0, 1, 2}));
  EXPECT_GT(list.back()["text"].get<std::string>().size(), 0u);
  // Every command counts in the numbers of the shot.
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"dump", "scene.toml", "--at", "0.1"},
        {"strip", "scene.toml", "--at", "0.1", "--out", "s.png"}}) {
    std::vector<std::string> words = more;
    words.insert(words.end(), {"--set", "first_frame=1001", "--progress", "json"});
    const auto counted = neve(words);
    ASSERT_EQ(counted.exit_code, 0) << counted.errors;
    for (const app::Json& event : events(counted.errors))
      EXPECT_GT(event.value("last_frame", 1006), 1000) << counted.errors;
  }
  const auto wrong = neve({"render", "none.toml", "--progress=json"});
  EXPECT_EQ(wrong.exit_code, 3);
  EXPECT_EQ(events(wrong.errors).back()["event"], "error");
  EXPECT_EQ(events(wrong.errors).back()["exit_code"], 3);
  EXPECT_EQ(neve({"render", "scene.toml", "--progress", "xml"}).exit_code, 2);
  const auto sweep = neve({"sweep", "scene.toml", "-p", "seed=1,2", "--frames", "0", "--out", "s",
                           "--progress", "json"});
  EXPECT_EQ(sweep.exit_code, 0) << sweep.errors;
  EXPECT_FALSE(events(sweep.errors).empty());
}

TEST_F(Cli, ALogHasAllMessagesWithTimes) {
  ASSERT_EQ(
      neve({"render", "scene.toml", "--frames", "1", "--no-movie", "--quiet", "--log", "run.log"})
          .exit_code,
      0);
  const std::string log = read_text(folder / "run.log");
  EXPECT_TRUE(contains(log, "OpenGL: ")) << log;
  EXPECT_TRUE(contains(log, "frame 1/1")) << log;
  EXPECT_TRUE(contains(log, "Z  frame 1: ")) << "details too: " << log;
  // The next run is appended, and so is an error.
  neve({"render", "none.toml", "--log", "run.log"});
  const std::string both = read_text(folder / "run.log");
  EXPECT_TRUE(both.starts_with(log));
  EXPECT_TRUE(contains(both, "none.toml: error: ")) << both;
  EXPECT_EQ(neve({"render", "scene.toml", "--log", "no/such/folder/log"}).exit_code, 6);
}

TEST_F(Cli, OutputsGoIntoTheFolderThatTheEnvironmentNames) {
  const std::string command =
      "NEVE_OUT=elsewhere exec '" NEVE_BINARY "' render scene.toml --frames 0 --quiet";
  const auto result = app::output::run_process("/bin/sh", {"-c", command}, folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(exists("elsewhere/scene/particles/0000.png"));
  EXPECT_FALSE(exists("out"));
}

TEST_F(Cli, MisspeltNamesGetTheRightOnes) {
  const auto said = [&](const std::vector<std::string>& words, const std::string& part) {
    const auto result = neve(words);
    EXPECT_NE(result.exit_code, 0);
    EXPECT_TRUE(contains(result.errors, part)) << result.errors;
  };
  folder.write("scenes/snowball_drop.toml", tiny_scene);
  said({"render", "snowbal_drop.toml"},
       "No such file or directory; did you mean scenes/snowball_drop.toml?");
  said({"render", "snowball_drop"}, "did you mean scenes/snowball_drop.toml?");
  said({"render", "scenes/snowbal_drop.toml"}, "did you mean scenes/snowball_drop.toml?");
  // An example that came with the program.
  said({"render", "snowplouhg.toml"}, "scenes/snowplough.toml?");
  said({"render", "scene.toml", "--quality", "high"}, "did you mean final?");
  said({"render", "scene.toml", "--set", "solver.transfer=pic"},
       "PIC is transfer = \"flip\" with flip_ratio = 0");
  said({"render", "scene.toml", "--set", "material.snow.preset=sticky"},
       "for snow that is stickier see material.NAME.critical_stretch");
  said({"render", "scene.toml", "--set=", "--dry-run"}, "has no value");
  said({"render", "scene.toml", "--frames", "1", "--frames", "2"},
       "takes one value and was given 2");
  folder.write("comma.toml", "[solver]\ncell_size = 0,04\n");
  said({"render", "comma.toml"}, "decimals have a point, as in 0.04");
}

TEST_F(Cli, WordsOverPicturesAreLayersAndAFlagLeavesThemOut) {
  const auto frame = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"render",     "scene.toml", "--frames", "0",
                                   "--no-movie", "--quiet",    "--replace"};
    words.insert(words.end(), more.begin(), more.end());
    const auto result = neve(words);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return app::output::read_file(folder / "out/scene/particles/0000.png");
  };
  const auto layers = [](const std::string& names) {
    return std::vector<std::string>{"--set", "view.particles.layers=[\"particles\"" + names + "]"};
  };
  const auto bare = frame(layers(""));
  EXPECT_EQ(render::decode_png(frame(layers(""))).pixels, render::decode_png(bare).pixels);
  for (const char* words : {", \"caption\"", ", \"counter\"", ", \"slate\""})
    EXPECT_NE(render::decode_png(frame(layers(words))).pixels, render::decode_png(bare).pixels)
        << words;
  std::vector<std::string> without = layers(", \"caption\"");
  without.emplace_back("--no-caption");
  EXPECT_EQ(render::decode_png(frame(without)).pixels, render::decode_png(bare).pixels);
  // The picture knows: it is made again without.
  const auto again = neve({"render", "out/scene/particles/0000.png", "--out", "again"});
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(neve({"compare", "out/scene/particles/0000.png", "again/particles/0000.png"}).exit_code,
            0);
}

/// docs/wishes.md shows the table of neve params --wishes.
TEST_F(Cli, ThePageOfWishesHasTheTableOfTheProgram) {
  const auto table = neve({"params", "--wishes", "--markdown"});
  ASSERT_EQ(table.exit_code, 0) << table.errors;
  EXPECT_TRUE(
      contains(read_text(std::filesystem::path(NEVE_SOURCE_DIR) / "docs/wishes.md"), table.output))
      << "docs/wishes/make writes it";
  EXPECT_TRUE(contains(neve({"params", "stickiness"}).output, "I WANT IT"));
  EXPECT_EQ(neve({"params", "--wishes", "nonsense"}).exit_code, 2);
}

}  // namespace
}  // namespace neve::test
