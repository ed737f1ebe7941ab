#pragma once
/// Programs that are killed, and what they leave behind.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
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

/// Processor time of a process, of those that it waited for and of those that it has not yet
/// waited for, s.
inline double processor_seconds_of(pid_t process) {
  double seconds = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::string text = read_text(entry.path() / "stat");
    std::istringstream words(text.substr(std::min(text.rfind(')') + 1, text.size())));
    // proc(5): the 4th word is the parent, the 14th to 17th are the times of the process and of
    // those that it waited for.
    std::vector<std::string> fields(2);
    for (std::string word; fields.size() < 17 && words >> word;) fields.push_back(word);
    if (fields.size() < 17) continue;  // it has ended
    if (name == std::to_string(process)) {
      const auto ticks = static_cast<double>(::sysconf(_SC_CLK_TCK));
      for (std::size_t k = 13; k < 17; ++k) seconds += std::stod(fields[k]) / ticks;
    } else if (fields[3] == std::to_string(process)) {
      seconds += processor_seconds_of(std::stoi(name));
    }
  }
  return seconds;
}

/// Asks the program to end as Ctrl-C does. The work of a busy machine meanwhile is not counted.
inline Ended interrupt_after(const std::filesystem::path& folder, const std::string& arguments,
                             double seconds) {
  const pid_t child = start_in(folder, arguments);
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  const double before = processor_seconds_of(child);
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
