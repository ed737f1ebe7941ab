/// Folders of strangers, and files that are not of neve: lists, links, locks, logs and outputs.

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/output/checkpoint.h"
#include "app/record/run_json.h"
#include "tests/support/costly_cli.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

class StrangerFolders : public CostlyCli {
 protected:
  app::output::ProcessResult render(const std::string& out, std::vector<std::string> more = {}) {
    std::vector<std::string> words{"render",     "scene.toml", "--frames", "0-2",
                                   "--no-movie", "--quiet",    "--out",    out};
    words.insert(words.end(), more.begin(), more.end());
    return neve(words);
  }
  app::output::ProcessResult sweep(const std::string& frames = "0-1",
                                   std::vector<std::string> more = {}) {
    std::vector<std::string> words{
        "sweep",    "scene.toml", "-p",     "material.snow.hardening=5,7",
        "--frames", frames,       "--out",  "s",
        "--movie",  "none",       "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return neve(words);
  }
  void replace(const std::string& file, const std::string& before, const std::string& after) {
    std::string text = read_text(folder / file);
    const std::size_t at = text.find(before);
    ASSERT_NE(at, std::string::npos) << file << ": " << before;
    folder.write(file, text.replace(at, before.size(), after));
  }
};

/// One bit made a table show a value that was never run, and all was said to be whole.
TEST_F(StrangerFolders, OneFlippedBitInAListOfASweepIsFound) {
  ASSERT_EQ(sweep().exit_code, 0);
  ASSERT_EQ(neve({"verify", "s"}).exit_code, 0);
  replace("s/manifest.json", "\"5\"", "\"7\"");
  EXPECT_EQ(neve({"verify", "s"}).exit_code, 9);
  const auto collected = neve({"sweep", "collect", "s"});
  EXPECT_EQ(collected.exit_code, 9) << collected.errors;
  EXPECT_TRUE(contains(collected.errors, "is not as neve sweep wrote it")) << collected.errors;
  EXPECT_EQ(sweep().exit_code, 0) << "the sweep writes it again";
  EXPECT_EQ(neve({"verify", "s"}).exit_code, 0);
  replace("s/runs/0001/status.json", "\"state\": \"ok\"", "\"state\": \"crashed\"");
  const auto found = neve({"verify", "s"});
  EXPECT_EQ(found.exit_code, 9);
  EXPECT_TRUE(contains(found.output, "status.json is damaged")) << found.output;
  EXPECT_EQ(neve({"sweep", "collect", "s"}).exit_code, 9);
  EXPECT_EQ(sweep().exit_code, 0);
  EXPECT_EQ(neve({"verify", "s"}).exit_code, 0);
}

TEST_F(StrangerFolders, ADamagedBeginningIsMadeAgain) {
  const std::vector<std::string> fork{"--fork", "0.05"};
  ASSERT_EQ(sweep("0-3", fork).exit_code, 0);
  ASSERT_EQ(neve({"verify", "s"}).exit_code, 0);
  const std::string whole = read_text(folder / "s/beginning/run.json");
  folder.write("s/beginning/run.json", whole.substr(0, whole.size() / 2));
  for (const auto& file : fs::directory_iterator(folder / "s/runs/0001/particles")) {
    fs::remove(file.path());
    break;
  }
  EXPECT_EQ(neve({"verify", "s"}).exit_code, 9);
  const auto again = sweep("0-3", fork);
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(neve({"verify", "s"}).exit_code, 0);
}

TEST_F(StrangerFolders, NoListDeletesAFileOfAPerson) {
  folder.write("theirs/thesis.tex", "years");
  folder.write("theirs/photos/0001.png", "years");
  folder.write("theirs/run.json",
               R"({"exports": [{"series": "thesis.tex", "files": [{"file": "photos/0001.png"}]}],
                   "views": ["photos"], "frames": [{"frame": 1}]})");
  folder.write("theirs/exports/mine.ply", "years");
  folder.write("theirs/exports/export.json",
               R"({"scene_file": "scene.toml", "is_whole": true, "exports": [{"name": "ply",
                   "series": "mine.ply", "files": [{"file": "mine.ply"}]}], "files": {}})");
  EXPECT_EQ(render("theirs").exit_code, 2) << "nothing tells which files are ours";
  EXPECT_EQ(neve({"render", "scene.toml", "--out", "theirs", "--frames", "0-3", "--no-movie",
                  "--quiet", "--replace"})
                .exit_code,
            0);
  EXPECT_EQ(neve({"export", "theirs", "--format", "ply", "--frames", "0", "--quiet"}).exit_code, 0);
  for (const char* file : {"thesis.tex", "photos/0001.png", "exports/mine.ply"})
    EXPECT_EQ(read_text(folder / ("theirs/" + std::string(file))), "years") << file;
}

TEST_F(StrangerFolders, FoldersThatAreLinksAreNotWrittenTo) {
  fs::create_directories(folder / "other");
  for (const char* name : {"particles", "checkpoint"}) {
    const std::string out = std::string("of_") + name;
    fs::create_directories(folder / out);
    fs::create_directory_symlink(folder / "other", folder / (out + "/" + name));
    const auto result = render(out);
    EXPECT_EQ(result.exit_code, 6) << name << ": " << result.errors;
    EXPECT_TRUE(fs::is_empty(folder / "other")) << name;
  }
  fs::create_directories(folder / "s");
  fs::create_directory_symlink(folder / "other", folder / "s/runs");
  EXPECT_EQ(sweep().exit_code, 6);
  EXPECT_TRUE(fs::is_empty(folder / "other"));
  fs::create_directory_symlink(folder / "other", folder / "mine");
  EXPECT_EQ(render("mine").exit_code, 0) << "a link that a person names is followed";
}

TEST_F(StrangerFolders, LocksOfOtherProgramsAreKept) {
  folder.write("theirs/.lock", "pid 4711 of another program\n");
  EXPECT_EQ(render("theirs").exit_code, 6);
  EXPECT_EQ(read_text(folder / "theirs/.lock"), "pid 4711 of another program\n");
  folder.write("linked/notes", "");
  fs::create_hard_link(folder / "linked/notes", folder / "linked/.lock");
  EXPECT_EQ(render("linked").exit_code, 6);
  EXPECT_EQ(read_text(folder / "linked/notes"), "");
  EXPECT_EQ(render("ours").exit_code, 0);
  EXPECT_EQ(render("ours").exit_code, 0) << "our own is used again";
}

TEST_F(StrangerFolders, OutputsReplaceNoInput) {
  const std::string scene = read_text(folder / "scene.toml");
  EXPECT_EQ(neve({"sweep", "scene.toml", "-p", "seed=1,2", "--emit", "scene.toml"}).exit_code, 2);
  EXPECT_EQ(neve({"dump", "scene.toml", "--out", "./scene.toml"}).exit_code, 2);
  folder.write("sweep.toml", "[sweep]\nscene = \"scene.toml\"\n[axis]\nseed = [1, 2]\n");
  EXPECT_EQ(neve({"sweep", "sweep.toml", "--emit", "scene.toml"}).exit_code, 2);
  EXPECT_EQ(neve({"sweep", "sweep.toml", "--emit", "sweep.toml"}).exit_code, 2);
  EXPECT_EQ(read_text(folder / "scene.toml"), scene);
}

TEST_F(StrangerFolders, LogsThatCannotBeWrittenAreSaid) {
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(render("a", {"--log", "pipe"}).exit_code, 6) << "nobody reads it";
  EXPECT_EQ(render("a", {"--log", "/dev/full"}).exit_code, 6);
  EXPECT_EQ(render("a", {"--log", "log"}).exit_code, 0);
  EXPECT_TRUE(contains(read_text(folder / "log"), "neve ")) << read_text(folder / "log");
}

TEST_F(StrangerFolders, FilesThatAreNoRunAreAnsweredWithTheirName) {
  ASSERT_EQ(render("run").exit_code, 0);
  const app::Json good = json_of("run/run.json");
  for (const auto& [key, value] : {std::pair{"changes", app::Json("x")},
                                   {"version", app::Json::array({nullptr})},
                                   {"overrides", app::Json(7)},
                                   {"frames", app::Json("x")}}) {
    app::Json forged = good;
    forged[key] = value;
    fs::create_directories(folder / "forged");
    folder.write("forged/run.json", app::to_text(forged));
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"export", "forged", "--format", "csv", "--frames", "0"},
          {"strip", "forged", "--tiles", "2"},
          {"render", "forged", "--from", "0.05", "--out", "fork", "--no-movie"},
          {"info", "forged"},
          {"verify", "forged"}}) {
      const auto result = neve(words);
      EXPECT_NE(result.exit_code, 1) << words[0] << " " << key << ": " << result.errors;
      if (result.exit_code == 3) {
        EXPECT_TRUE(contains(result.errors, "run.json")) << result.errors;
      }
    }
  }
  ASSERT_EQ(neve({"export", "run", "--format", "csv,ply", "--frames", "0", "--quiet"}).exit_code,
            0);
  app::Json list = json_of("run/exports/export.json");
  list["exports"][1]["files"] = app::Json::array({7});
  folder.write("run/exports/export.json", app::to_text(list));
  const std::vector<std::string> words{"export", "run", "--format", "csv", "--frames", "0", "-q"};
  const auto refused = neve(words);
  EXPECT_EQ(refused.exit_code, 2) << refused.errors;
  EXPECT_TRUE(contains(refused.errors, "export.json")) << refused.errors;
  std::vector<std::string> replacing = words;
  replacing.emplace_back("--replace");
  EXPECT_EQ(neve(replacing).exit_code, 0);
  EXPECT_EQ(neve(words).exit_code, 0);
}

TEST_F(StrangerFolders, SweepsOfStrangersAreCollectedOrRefusedAtOnce) {
  ASSERT_EQ(sweep().exit_code, 0);
  const app::Json good = json_of("s/manifest.json");
  const auto forge = [&](const auto& change) {
    app::Json forged = good;
    change(forged);
    forged.erase("hash");
    folder.write("s/manifest.json", app::record::with_own_hash(forged));
  };
  const auto expect_ends = [&](const char* what) {
    const Cost cost = cost_of("sweep collect s --movie none");
    EXPECT_LT(cost.seconds, 5) << what;
    EXPECT_LT(cost.memory, 800e6) << what;
    EXPECT_NE(cost.exit_code, 1) << what << read_text(folder / "said");
    EXPECT_NE(cost.exit_code, -1) << what;
  };
  forge([](app::Json& m) {
    const std::vector<std::string> values(70'000, "1");
    m["axes"] = {{{"name", "a"}, {"values", values}}, {{"name", "b"}, {"values", values}}};
    for (app::Json& run : m["runs"]) run["coordinates"] = {0, 0};
  });
  expect_ends("two axes of 70 000 values");
  forge([](app::Json& m) {
    for (app::Json& run : m["runs"]) run["last_frame"] = 100'000;
  });
  expect_ends("100 000 frames that nobody has made");
  forge([](app::Json& m) { m["tile"] = {1, 65536}; });
  expect_ends("a tile of 65 536 rows");
  forge([](app::Json&) {});
  const fs::path picture = folder / "s/runs/0000/particles/0001.png";
  fs::remove(picture);
  fs::create_symlink(picture.filename(), picture);
  expect_ends("a picture that is a link to itself");
}

/// A comparison may be interrupted before its first picture, when no curves can be drawn yet.
TEST_F(StrangerFolders, AComparisonIsInterruptedAtAnyMoment) {
  ASSERT_EQ(render("run").exit_code, 0);
  for (const char* delay : {"0", "0.02", "0.04", "0.08", "0.2"})
    EXPECT_EQ(cost_of("compare run run --out both & sleep " + std::string(delay) +
                      "; kill -INT $!; wait $!; code=$?; test $code = 130 -o $code = 0")
                  .exit_code,
              0)
        << delay << read_text(folder / "said");
}

/// The newest checkpoint is judged by its first bytes and its size.
TEST_F(StrangerFolders, ASparseFileInThePlaceOfACheckpointIsPassedOver) {
  ASSERT_EQ(render("run").exit_code, 0);
  const auto sparse = [&](const std::string& start) {
    const fs::path file = folder / "run/checkpoint/000009-000000000009.ckpt";
    const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ASSERT_EQ(::write(fd, start.data(), start.size()), static_cast<ssize_t>(start.size()));
    ASSERT_EQ(::ftruncate(fd, off_t{3} << 30), 0);
    ::close(fd);
  };
  for (const char* start : {"", "NEVECKP1"}) {
    sparse(start);
    const Cost cost =
        cost_of("render scene.toml --frames 0-2 --no-movie --out run --resume --max-memory 400MB");
    EXPECT_EQ(cost.exit_code, 0) << read_text(folder / "said");
    EXPECT_LT(cost.memory, 440e6);
  }
}

}  // namespace
}  // namespace neve::test
