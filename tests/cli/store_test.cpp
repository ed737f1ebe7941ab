/// Files on the disk: one writer for a folder, nothing of others destroyed, no gap called ok.

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>

#include "tests/support/resume.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

class Store : public Cli {
 protected:
  app::output::ProcessResult render(const std::string& out, std::vector<std::string> more = {}) {
    std::vector<std::string> words{"render", "scene.toml", "--out", out};
    words.insert(words.end(), more.begin(), more.end());
    return neve(words);
  }
  void damage(const std::string& file) {
    std::vector<std::uint8_t> bytes = app::output::read_file(folder / file);
    bytes[bytes.size() / 2] ^= 1;
    app::output::write_file(folder / file, bytes);
  }
};

TEST_F(Store, OfTwoRunsInAFolderOneWinsAndTheOtherTouchesNothing) {
  const fs::path out = folder / "out";
  const pid_t first = start_program({NEVE_BINARY, "render", folder / "scene.toml", "--out", out,
                                     "--frames", "5000", "--quiet", "--no-movie"});
  ASSERT_TRUE(wait_for_file(out / "particles/0002.png"));
  const auto second = render("out", {"--set", "material.snow.hardening=5"});
  EXPECT_EQ(second.exit_code, 6);
  EXPECT_TRUE(contains(second.errors, "is in use by neve render, process " + std::to_string(first)))
      << second.errors;
  const auto alive = neve({"info", "out"});
  EXPECT_TRUE(contains(alive.output, "running, by neve render, process " + std::to_string(first)))
      << alive.output;
  ::kill(first, SIGHUP);
  EXPECT_EQ(wait_for(first), 75) << "a terminal that closes stops it like Ctrl-C";
  const app::Json run = json_of("out/run.json");
  EXPECT_EQ(run["status"], "interrupted");
  EXPECT_TRUE(run["overrides"].empty());
  EXPECT_EQ(neve({"verify", "out"}).exit_code, 9) << "it is not finished";
  EXPECT_EQ(render("out", {"--frames", "0-1"}).exit_code, 0) << "the lock ended with its process";
}

TEST_F(Store, AKilledRunLeavesNothingForTheNextOne) {
  const fs::path out = folder / "out";
  for (int k = 0; k < 3; ++k) {
    const pid_t child = start_program({NEVE_BINARY, "render", folder / "scene.toml", "--out", out,
                                       "--frames", "5000", "--checkpoint-every", "1", "--quiet"});
    ASSERT_TRUE(wait_for_file(out / ("particles/000" + std::to_string(k) + ".png")));
    ::kill(child, SIGKILL);
    EXPECT_EQ(wait_for(child), 128 + SIGKILL);
    EXPECT_TRUE(contains(neve({"info", "out"}).output, "running, but its process has ended"));
  }
  ASSERT_EQ(render("out", {"--frames", "0-2", "--resume"}).exit_code, 0);
  for (const auto& entry : fs::recursive_directory_iterator(out))
    EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
}

TEST_F(Store, AFileCalledCheckpointSurvives) {
  folder.write("out/checkpoint", "model_checkpoint_path: \"mine\"");
  const auto result = render("out", {"--frames", "0-1"});
  EXPECT_EQ(result.exit_code, 6);
  EXPECT_TRUE(
      contains(result.errors, "out/checkpoint: cannot write checkpoints here: not a folder"))
      << result.errors;
  EXPECT_FALSE(exists("out/particles"));
  EXPECT_EQ(render("out", {"--frames", "0-1", "--checkpoint-every", "0"}).exit_code, 0);
  EXPECT_EQ(read_text(folder / "out/checkpoint"), "model_checkpoint_path: \"mine\"");
}

TEST_F(Store, NumbersGoIntoDevicesAndThroughLinks) {
  fs::create_symlink("/dev/null", folder / "null");
  EXPECT_EQ(neve({"dump", "scene.toml", "--at", "0.01s", "--out", "null", "--quiet"}).exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(folder / "null"));
  const auto out = neve({"dump", "scene.toml", "--at", "0.01s", "--out", "/dev/stdout", "--quiet"});
  EXPECT_EQ(out.exit_code, 0) << out.errors;
  EXPECT_TRUE(contains(out.output, "scene.toml")) << out.output.substr(0, 200);
  EXPECT_EQ(neve({"sweep", "scene.toml", "-p", "seed=1,2", "--emit", "null", "--quiet"}).exit_code,
            0);
  EXPECT_TRUE(fs::is_symlink(folder / "null"));
}

TEST_F(Store, APictureThatIsALinkIsNotWrittenThrough) {
  const fs::path other = folder.write("precious", "mine");
  fs::create_directories(folder / "out/particles");
  fs::create_symlink(other, folder / "out/particles/0001.png");
  const auto result = render("out", {"--frames", "0-1"});
  EXPECT_EQ(result.exit_code, 6);
  EXPECT_TRUE(contains(result.errors, "0001.png: is a link")) << result.errors;
  EXPECT_EQ(read_text(other), "mine");
}

TEST_F(Store, AWholeRunIsVerifiedAndEveryDamageIsNamed) {
  ASSERT_EQ(render("out").exit_code, 0);
  const auto whole = neve({"verify", "out"});
  EXPECT_EQ(whole.exit_code, 0) << whole.output;
  EXPECT_TRUE(contains(whole.output, "out: complete, ")) << whole.output;
  fs::remove(folder / "out/particles/0001.png");
  folder.write("out/particles/0002.png", "");
  damage("out/particles/0003.png");
  const auto found = neve({"verify", "out"});
  EXPECT_EQ(found.exit_code, 9);
  for (const char* line : {"out/particles/0001.png is missing", "out/particles/0002.png is empty",
                           "out/particles/0003.png is not the file that the run wrote"})
    EXPECT_TRUE(contains(found.output, line)) << found.output;
  const app::Json json =
      app::parse_json(std::string_view(neve({"verify", "out", "--json"}).output));
  EXPECT_EQ(json["whole"], false);
  EXPECT_EQ(json["flaws"].size(), 3u);
  EXPECT_EQ(neve({"verify", "scene.toml"}).exit_code, 6);
  EXPECT_EQ(neve({"verify", "."}).exit_code, 6) << "no run was ever there";
}

TEST_F(Store, StatesAndCheckpointsAreVerifiedWhereTheyAreKept) {
  ASSERT_EQ(render("out", {"--no-movie"}).exit_code, 0);
  ASSERT_EQ(neve({"verify", "out"}).exit_code, 0);
  std::string checkpoint;
  for (const auto& file : fs::directory_iterator(folder / "out/checkpoint"))
    checkpoint = "out/checkpoint/" + file.path().filename().string();
  damage("out/states/000002.ckpt");
  damage(checkpoint);
  fs::remove(folder / "out/states/000003.ckpt");
  const auto found = neve({"verify", "out"});
  EXPECT_EQ(found.exit_code, 9);
  for (const std::string& line :
       {std::string("out/states/000002.ckpt is damaged: its checksum is wrong"),
        std::string("out/states/000003.ckpt is missing"), checkpoint + " is damaged: its checksum",
        std::string("no picture, film or export is damaged: remove the folder states")})
    EXPECT_TRUE(contains(found.output, line)) << found.output;
  // The way out that it names.
  fs::remove_all(folder / "out/states");
  fs::remove(folder / checkpoint);
  EXPECT_EQ(neve({"verify", "out"}).exit_code, 0);
  // Numbers of a shot are not those of the files of its states; a small budget thins states out.
  ASSERT_EQ(render("shot", {"--set", "first_frame=1001", "--no-movie"}).exit_code, 0);
  EXPECT_EQ(neve({"verify", "shot"}).exit_code, 0);
  fs::remove(folder / "shot/states/000003.ckpt");
  EXPECT_TRUE(contains(neve({"verify", "shot"}).output, "shot/states/000003.ckpt is missing"));
  ASSERT_EQ(render("thin", {"--states-budget", "64KiB", "--no-movie"}).exit_code, 0);
  const auto thin = neve({"verify", "thin"});
  EXPECT_EQ(thin.exit_code, 0) << thin.output;
}

TEST_F(Store, EveryDamageOfRunJsonIsNoticed) {
  ASSERT_EQ(render("out", {"--frames", "0-2", "--no-movie"}).exit_code, 0);
  const std::string text = read_text(folder / "out/run.json");
  ASSERT_EQ(neve({"verify", "out"}).exit_code, 0);
  for (std::size_t k = 0; k < 40; ++k) {
    std::string other = text;
    const std::size_t place = (2 * k + 1) * text.size() / 80;
    if (k % 2 == 0)
      other.resize(place);
    else
      other[place] = other[place] == '7' ? '8' : '7';
    // An eighteenth digit of a number changes nothing.
    if (app::Json::parse(other, nullptr, false) == app::Json::parse(text)) continue;
    folder.write("out/run.json", other);
    EXPECT_EQ(neve({"verify", "out"}).exit_code, 9) << k << ": " << other.substr(place, 40);
  }
}

TEST_F(Store, ResumeMakesMissingAndDamagedPicturesAgain) {
  ASSERT_EQ(render("whole").exit_code, 0);
  const RunFiles whole = files_of(folder / "whole");
  for (const char* every : {"1", "2", "10"}) {
    ASSERT_EQ(render("out", {"--frames", "0-3", "--checkpoint-every", every}).exit_code, 0);
    fs::remove(folder / "out/particles/0001.png");
    folder.write("out/particles/0002.png", "");
    damage("out/particles/0003.png");
    folder.write("out/run.json", "");
    const auto more = render("out", {"--resume"});
    ASSERT_EQ(more.exit_code, 0) << more.errors;
    EXPECT_TRUE(contains(more.errors, "particles/0001.png is missing")) << more.errors;
    const RunFiles found = files_of(folder / "out");
    EXPECT_EQ(found.hashes, whole.hashes);
    for (const auto& [name, bytes] : whole.pictures)
      EXPECT_TRUE(found.pictures.at(name) == bytes) << name << " every " << every;
    EXPECT_EQ(neve({"verify", "out"}).exit_code, 0);
  }
}

TEST_F(Store, ResumeMakesDamagedExportsAgain) {
  folder.write("scene.toml", std::string(tiny_scene) + "[[export]]\nformat = \"npz\"\n");
  ASSERT_EQ(render("whole").exit_code, 0);
  ASSERT_EQ(render("out").exit_code, 0);
  EXPECT_EQ(neve({"verify", "out"}).exit_code, 0);
  const app::Json list = json_of("whole/run.json")["exports"];
  const std::string third = list[0]["files"][3]["file"];
  damage("out/" + third);
  EXPECT_TRUE(contains(neve({"verify", "out"}).output, third + " is not the file"));
  const auto more = render("out", {"--resume"});
  ASSERT_EQ(more.exit_code, 0) << more.errors;
  EXPECT_TRUE(contains(more.errors, third + " is not the file")) << more.errors;
  EXPECT_EQ(json_of("out/run.json")["exports"], list);
  EXPECT_EQ(read_text(folder / ("out/" + third)), read_text(folder / ("whole/" + third)));
  EXPECT_EQ(neve({"verify", "out"}).exit_code, 0);
}

TEST_F(Store, FramesThatWereNeverDrawnAreNoPartOfARunThatIsOk) {
  ASSERT_EQ(render("out", {"--frames", "3-4"}).exit_code, 0);
  const auto more = render("out", {"--frames", "0-4", "--resume"});
  ASSERT_EQ(more.exit_code, 0) << more.errors;
  EXPECT_EQ(json_of("out/run.json")["frames"].size(), 5u) << more.errors;
  EXPECT_TRUE(exists("out/particles/0000.png"));
  EXPECT_EQ(neve({"verify", "out"}).exit_code, 0);
}

/// Some frames are drawn by a later command, before the first ones of the checkpoint.
TEST_F(Store, FramesBeforeThoseOfTheCheckpointAreNotMissing) {
  ASSERT_EQ(render("out", {"--frames", "2-3", "--no-movie"}).exit_code, 0);
  ASSERT_EQ(render("out", {"--frames", "0-3", "--no-movie"}).exit_code, 0);
  const auto drawn = fs::last_write_time(folder / "out/particles/0001.png");
  for (const char* what : {"out", "scene.toml"}) {
    const auto more = neve({"render", what, "--out", "out", "--no-movie", "--resume"});
    ASSERT_EQ(more.exit_code, 0) << more.errors;
    EXPECT_FALSE(contains(more.errors, "missing")) << more.errors;
  }
  EXPECT_TRUE(fs::last_write_time(folder / "out/particles/0001.png") == drawn);
  EXPECT_EQ(json_of("out/run.json")["frames"].size(), 5u);
  EXPECT_EQ(neve({"verify", "out"}).exit_code, 0);
}

TEST_F(Store, AMovieThatCannotBeWrittenIsNoSuccess) {
  if (!app::output::find_program("ffmpeg")) GTEST_SKIP() << "no ffmpeg";
  fs::create_directories(folder / "out/particles.mp4/inside");
  const auto result = render("out", {"--frames", "0-1"});
  EXPECT_EQ(result.exit_code, 6);
  EXPECT_TRUE(contains(result.errors, "particles.mp4")) << result.errors;
  const app::Json run = json_of("out/run.json");
  EXPECT_EQ(run["status"], "failed");
  ASSERT_EQ(run["warnings"].size(), 1u);
  EXPECT_TRUE(contains(run["warnings"][0].get<std::string>(), "no movie out/particles.mp4"));
  fs::remove_all(folder / "out/particles.mp4");
  EXPECT_EQ(render("out", {"--frames", "0-1", "--resume"}).exit_code, 0);
  EXPECT_TRUE(exists("out/particles.mp4"));
  EXPECT_EQ(neve({"verify", "out"}).exit_code, 0);
}

TEST_F(Store, SweepsMakeDamagedRunsAgainAndCollectNamesThem) {
  const std::vector<std::string> sweep{"sweep",    "scene.toml", "-p",    "seed=1,2",
                                       "--frames", "0-2",        "--out", "s"};
  ASSERT_EQ(neve(sweep).exit_code, 0);
  EXPECT_EQ(neve({"verify", "s"}).exit_code, 0);
  const std::vector<std::uint8_t> picture =
      app::output::read_file(folder / "s/runs/0001/particles/0001.png");
  fs::remove(folder / "s/runs/0001/particles/0001.png");
  const auto found = neve({"verify", "s"});
  EXPECT_EQ(found.exit_code, 9);
  EXPECT_TRUE(contains(found.output, "runs/0001/particles/0001.png is missing")) << found.output;
  const auto collected = neve({"sweep", "collect", "s"});
  EXPECT_EQ(collected.exit_code, 9);
  EXPECT_TRUE(contains(collected.errors, "run 1: particles/0001.png is missing"))
      << collected.errors;
  const auto again = neve(sweep);
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_TRUE(contains(again.errors, "run 1: particles/0001.png is missing; it is made again"))
      << again.errors;
  EXPECT_TRUE(app::output::read_file(folder / "s/runs/0001/particles/0001.png") == picture);
}

/// Its sheet showed another camera, and its table the numbers of another simulation.
TEST_F(Store, SweepsNoticeThatARunWasDrawnOrSimulatedOtherwise) {
  const std::vector<std::string> sweep{
      "sweep", "scene.toml", "-p", "material.snow.hardening=4,8", "--frames", "0-2", "--out", "s"};
  ASSERT_EQ(neve(sweep).exit_code, 0);
  const RunFiles before = files_of(folder / "s/runs/0001");
  const auto expect_noticed = [&](const std::string& what) {
    const auto found = neve({"verify", "s"});
    EXPECT_EQ(found.exit_code, 9);
    EXPECT_TRUE(contains(found.output, "runs/0001/run.json " + what)) << found.output;
    const auto collected = neve({"sweep", "collect", "s"});
    EXPECT_EQ(collected.exit_code, 9);
    EXPECT_TRUE(contains(collected.errors, "run 1: run.json " + what)) << collected.errors;
    const auto again = neve(sweep);
    EXPECT_EQ(again.exit_code, 0) << again.errors;
    EXPECT_TRUE(contains(again.errors, "run 1: run.json " + what)) << again.errors;
    EXPECT_EQ(neve({"verify", "s"}).exit_code, 0);
    EXPECT_TRUE(files_of(folder / "s/runs/0001").pictures == before.pictures);
  };
  neve({"render", "s/runs/0001", "--set", "camera.eye=[0, 1, 2]", "--no-movie", "--replace"});
  expect_noticed("has pictures of particles that are drawn otherwise than the sweep did");
  const auto done = neve({"render", "s/runs/0001/scene.toml", "--out", "s/runs/0001", "--frames",
                          "0-2", "--set", "material.snow.hardening=50", "--no-movie", "--replace"});
  EXPECT_EQ(done.exit_code, 0) << done.errors;
  neve({"sweep", "collect", "s"});
  EXPECT_TRUE(contains(read_text(folder / "s/data.csv"), "\n1,run 1,8.0,ok,-,1,0,,,"))
      << "no number";
  expect_noticed("is of another simulation than the sweep made");
}

/// They were called damaged, and their further frames were lost without a word.
TEST_F(Store, SweepsCompareRunsThatBecameLongerAtTheirOwnEnd) {
  const std::vector<std::string> sweep{
      "sweep", "scene.toml", "-p", "material.snow.hardening=4,8", "--frames", "0-2", "--out", "s"};
  ASSERT_EQ(neve(sweep).exit_code, 0);
  const std::string table = read_text(folder / "s/data.csv");
  const auto done = neve({"render", "s/runs/0001", "--frames", "0-4", "--no-movie"});
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  ASSERT_EQ(neve({"render", "s/runs/0001", "--view", "smoke", "--no-movie"}).exit_code, 0);
  EXPECT_EQ(neve({"verify", "s"}).exit_code, 0);
  const auto collected = neve({"sweep", "collect", "s"});
  EXPECT_EQ(collected.exit_code, 0) << collected.errors;
  EXPECT_EQ(read_text(folder / "s/data.csv"), table);
  EXPECT_EQ(neve(sweep).exit_code, 0);
  EXPECT_TRUE(exists("s/runs/0001/particles/0004.png"));
}

}  // namespace
}  // namespace neve::test
