#pragma once
/// Other programs, started from an argument vector and never through a shell.

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace neve::app::output {

struct Command {
  std::filesystem::path program;
  std::vector<std::string> arguments;
  std::filesystem::path folder;  ///< that it runs in
};

struct ResourceLimit {
  int resource;  ///< RLIMIT_DATA or another of setrlimit()
  std::uint64_t value;
};

struct StartOptions {
  /// File descriptors that become its standard streams; /dev/null for -1.
  int input = -1, output = -1, errors = -1;
  std::vector<ResourceLimit> limits;
};

/// Starts a program and returns once it runs. It has its own process group, so that a Ctrl-C meant
/// for us does not reach it, and the default actions of the signals that we catch or ignore.
///
/// The system kills it when the calling thread ends, also by SIGKILL: that thread has to wait for
/// it. Programs that it starts in turn are not killed.
/// @throws std::system_error if it cannot be started
pid_t start_process(const Command& command, const StartOptions& options);

struct ProcessResult {
  bool has_started = false;
  int exit_code = -1;        ///< 128 + signal when it was killed
  bool is_too_slow = false;  ///< killed, with its process group, because it took too long
  std::string output;        ///< stdout
  std::string errors;        ///< stderr
};

/// Runs a program and waits for it. It gets no input, and at most 1 MiB of each output is kept.
/// Starts it as start_process() does.
/// @param longest  s that it may take
ProcessResult run_process(const std::filesystem::path& program,
                          const std::vector<std::string>& arguments,
                          const std::filesystem::path& folder,
                          double longest = std::numeric_limits<double>::infinity());

/// Searches PATH for an executable file.
std::optional<std::filesystem::path> find_program(const std::string& name);

}  // namespace neve::app::output
