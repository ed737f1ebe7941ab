#pragma once
/// Programs that are killed, and what they leave behind.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "app/output/temporary.h"
#include "tests/support/child.h"
#include "tests/support/temporary_folder.h"

namespace neve::test {

/// The program in a folder. @param arguments  for the shell
inline pid_t start_in(const std::filesystem::path& folder, const std::string& arguments) {
  return start_program(
      {"/bin/bash", "-c", "cd \"$1\" && exec \"$0\" " + arguments, NEVE_BINARY, folder.string()});
}

/// Processes that work in a folder or below it, or have its name among their arguments, as ffmpeg
/// has that of a movie.
inline std::set<std::string> processes_of(const std::filesystem::path& folder) {
  std::set<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::error_code error;
    const auto where = std::filesystem::read_symlink(entry.path() / "cwd", error);
    if (error) continue;
    if (where.string().starts_with(folder.string()) ||
        read_text(entry.path() / "cmdline").find(folder.string()) != std::string::npos)
      found.insert(entry.path().filename().string() + " " + read_text(entry.path() / "comm"));
  }
  return found;
}

/// A second after a kill.
inline void expect_no_process(const std::filesystem::path& folder, const std::string& place) {
  std::this_thread::sleep_for(std::chrono::seconds(1));
  EXPECT_EQ(processes_of(folder), std::set<std::string>{}) << place;
}

/// @return exit code, or 128 + SIGKILL
inline int kill_after(const std::filesystem::path& folder, const std::string& arguments,
                      double seconds) {
  const pid_t child = start_in(folder, arguments);
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  ::kill(child, SIGKILL);
  return wait_for(child);
}

struct Ended {
  int exit_code = -1;            ///< or 128 + signal
  double processor_seconds = 0;  ///< that it took after the signal, with those it waited for
};

/// Asks the program to end as Ctrl-C does. What a busy machine does meanwhile is not counted.
inline Ended interrupt_after(const std::filesystem::path& folder, const std::string& arguments,
                             double seconds) {
  const pid_t child = start_in(folder, arguments);
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  const auto taken = [&] {
    std::ifstream in("/proc/" + std::to_string(child) + "/stat");
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    std::istringstream words(text.substr(std::min(text.rfind(')') + 1, text.size())));
    std::string word;
    double ticks = 0;
    for (int k = 3; k <= 15 && words >> word; ++k)
      if (k == 14 || k == 15) ticks += std::stod(word);
    return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
  };
  const double before = taken();
  ::kill(child, SIGINT);
  Ended ended;
  int status = 0;
  rusage usage{};
  ::wait4(child, &status, 0, &usage);
  const auto all = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  ended.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  ended.processor_seconds = all(usage.ru_utime) + all(usage.ru_stime) - before;
  return ended;
}

/// A process that has begun to write a file in each folder when it ends, and is to be waited for.
inline pid_t end_unfinished(const std::vector<std::filesystem::path>& folders) {
  const pid_t child = ::fork();
  if (child == 0) {
    for (const std::filesystem::path& folder : folders)
      std::ofstream(app::output::temporary_name(folder / "part")) << "a";
    ::_exit(0);
  }
  return child;
}

/// A file in each folder that a process has begun to write when it ends.
inline void leave_unfinished(const std::vector<std::filesystem::path>& folders) {
  wait_for(end_unfinished(folders));
}

/// Nothing that a killed program had not finished is left below a folder.
inline void expect_nothing_unfinished(const std::filesystem::path& folder,
                                      const std::string& place) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    EXPECT_NE(entry.path().extension(), ".tmp") << entry.path() << " after " << place;
}

}  // namespace neve::test
