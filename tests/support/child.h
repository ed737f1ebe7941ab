#pragma once
/// Programs that a test starts and does not wait for.

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temporary_folder.h"

extern "C" char** environ;

namespace neve::test {

/// @return its process id, -1 when it could not be started
inline pid_t start_program(std::vector<std::string> words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child = -1;
  return posix_spawn(&child, words[0].c_str(), nullptr, nullptr, argv.data(), environ) == 0 ? child
                                                                                            : -1;
}

/// @return exit code, or 128 + signal
inline int wait_for(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Waits until the file exists, half a minute at most.
inline bool wait_for_file(const std::filesystem::path& file) {
  for (int k = 0; k < 3000; ++k) {
    if (std::filesystem::exists(file)) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

/// Waits until the file has something in it, half a minute at most.
inline bool wait_for_text(const std::filesystem::path& file) {
  for (int k = 0; k < 3000; ++k) {
    if (!read_text(file).empty()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

/// True once a process has ended, which has five seconds; one that waits for a reaper has ended.
inline bool is_gone_soon(pid_t process) {
  for (int k = 0; k < 1000; ++k) {
    std::ifstream in("/proc/" + std::to_string(process) + "/stat");
    std::string id, name, state;
    in >> id >> name >> state;
    if (!in || state == "Z") return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

}  // namespace neve::test
