#pragma once
/// Runs that are killed and resumed, against one that was left alone.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <random>
#include <thread>

#include "app/output/atomic_file.h"
#include "tests/cli/run_neve.h"
#include "tests/support/child.h"

namespace neve::test {

/// Every picture by its name, and the state hashes of run.json.
struct RunFiles {
  std::map<std::string, std::vector<std::uint8_t>> pictures;
  std::vector<std::string> hashes;
};

inline RunFiles files_of(const std::filesystem::path& out) {
  RunFiles files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(out))
    if (entry.path().extension() == ".png")
      files.pictures[std::filesystem::relative(entry.path(), out).string()] =
          app::output::read_file(entry.path());
  const app::Json run = app::parse_json(std::string_view(read_text(out / "run.json")));
  for (const app::Json& frame : run["frames"])
    files.hashes.push_back(frame["state_hash"].get<std::string>());
  return files;
}

struct Kills {
  int count;
  double longest;  ///< s until one
  unsigned seed;
  int signal = SIGKILL;
  std::function<void()> after = [] {};  ///< each
};

/// Starts over where the program was done before it was killed.
/// @return how many of the kills met a running program, all but on a machine that is too quick
inline int kill_and_resume(const std::filesystem::path& scene, const std::filesystem::path& out,
                           Kills kills) {
  std::mt19937 random(kills.seed);
  std::uniform_real_distribution<double> share(0, 1);
  int met = 0;
  for (int k = 0; met < kills.count && k < 10 * kills.count; ++k) {
    const pid_t child = start_program({NEVE_BINARY, "render", scene, "--out", out, "--resume",
                                       "--checkpoint-every", "1", "--quiet"});
    const double seconds = 0.02 + share(random) * (kills.longest - 0.02);
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    ::kill(child, kills.signal);
    const int code = wait_for(child);
    EXPECT_TRUE(code == 0 || code == 128 + kills.signal ||
                (kills.signal != SIGKILL && (code == 75 || code == 130)))
        << code;
    kills.after();
    if (code != 0) {
      ++met;
    } else {
      // It was done before it could be killed, on a machine that is as quick as that.
      std::filesystem::remove_all(out);
      kills.longest = std::max(0.6 * kills.longest, 0.05);
    }
  }
  return met;
}

}  // namespace neve::test
