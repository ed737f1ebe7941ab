/// Ctrl-C: every finished frame and a playable movie of them stay.

#include "tests/cli/run_neve.h"
#include "tests/support/child.h"

namespace neve::test {
namespace {

int frames_in(const std::filesystem::path& folder) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    count += entry.path().extension() == ".png";
  return count;
}

TEST_F(Cli, AnInterruptKeepsEveryFrameAndAMovieOfThem) {
  const std::filesystem::path out = folder / "out";
  const pid_t child = start_program(
      {NEVE_BINARY, "render", folder / "scene.toml", "--out", out, "--frames", "5000", "--quiet"});
  ASSERT_GT(child, 0);
  ASSERT_TRUE(wait_for_file(out / "particles/0002.png"));
  ::kill(child, SIGINT);
  EXPECT_EQ(wait_for(child), 75) << "a checkpoint makes it resumable";

  const int frames = frames_in(out / "particles");
  EXPECT_GE(frames, 3);
  const app::Json run = json_of("out/run.json");
  EXPECT_EQ(run["status"], "interrupted");
  EXPECT_EQ(static_cast<int>(run["frames"].size()), frames);
  // The movie was counted when it was made; its presence says that it is whole.
  EXPECT_EQ(exists("out/particles.mp4"), app::output::find_program("ffmpeg").has_value());
}

/// Half a forecast would be a wrong one.
TEST_F(Cli, AnInterruptedCheckPrintsNoForecast) {
  const std::filesystem::path printed = folder / "printed";
  const pid_t child =
      start_program({"/bin/sh", "-c",
                     "exec " NEVE_BINARY " check " NEVE_SOURCE_DIR "/scenes/castle_hit.toml >" +
                         printed.string() + " 2>" + printed.string() + ".errors"});
  ASSERT_GT(child, 0);
  ASSERT_TRUE(wait_for_file(printed));
  // The check takes some seconds; sooner than this it may not listen yet, and ends as well.
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  ::kill(child, SIGINT);
  EXPECT_EQ(wait_for(child), 130);
  EXPECT_EQ(read_text(printed), "");
}

/// Scripts that ask for JSON get an answer whenever they stop a command.
TEST_F(Cli, ACommandInterruptedBeforeAnythingWasMadeAnswersInJson) {
  const std::filesystem::path printed = folder / "printed";
  const pid_t child = start_program({"/bin/sh", "-c",
                                     "exec " NEVE_BINARY " check --json " NEVE_SOURCE_DIR
                                     "/scenes/castle_hit.toml >" +
                                         printed.string() + " 2>" + printed.string() + ".errors"});
  ASSERT_TRUE(wait_for_file(printed));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  ::kill(child, SIGINT);
  EXPECT_EQ(wait_for(child), 130);
  const app::Json answer = app::parse_json(std::string_view(read_text(printed)));
  EXPECT_EQ(answer["exit_code"], 130);
  EXPECT_EQ(answer["error"], "interrupted before anything was made");
  EXPECT_EQ(read_text(printed.string() + ".errors"),
            "neve: error: interrupted before anything was made\n");
}

}  // namespace
}  // namespace neve::test
