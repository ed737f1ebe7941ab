/// Ctrl-C: every finished frame and a playable movie of them stay.

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <chrono>
#include <thread>

#include "tests/cli/run_neve.h"

extern "C" char** environ;

namespace neve::test {
namespace {

pid_t start_neve(std::vector<std::string> words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child = -1;
  return posix_spawn(&child, words[0].c_str(), nullptr, nullptr, argv.data(), environ) == 0 ? child
                                                                                            : -1;
}

bool wait_for_file(const std::filesystem::path& file) {
  for (int k = 0; k < 3000; ++k) {
    if (std::filesystem::exists(file)) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

int frames_in(const std::filesystem::path& folder) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    count += entry.path().extension() == ".png";
  return count;
}

TEST_F(Cli, AnInterruptKeepsEveryFrameAndAMovieOfThem) {
  const std::filesystem::path out = folder / "out";
  const pid_t child = start_neve(
      {NEVE_BINARY, "render", folder / "scene.toml", "--out", out, "--frames", "5000", "--quiet"});
  ASSERT_GT(child, 0);
  ASSERT_TRUE(wait_for_file(out / "particles/0002.png"));
  ::kill(child, SIGINT);
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);

  const int frames = frames_in(out / "particles");
  EXPECT_GE(frames, 3);
  const app::Json run = json_of("out/run.json");
  EXPECT_EQ(run["status"], "interrupted");
  EXPECT_EQ(static_cast<int>(run["frames"].size()), frames);
  // The movie was counted when it was made; that it is there says that it is whole.
  EXPECT_EQ(exists("out/particles.mp4"), app::find_program("ffmpeg").has_value());
}

}  // namespace
}  // namespace neve::test
