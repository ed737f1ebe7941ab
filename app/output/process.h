#pragma once
/// Other programs, started from an argument vector and never through a shell.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace neve::app::output {

struct ProcessResult {
  bool has_started = false;
  int exit_code = -1;  ///< 128 + signal when it was killed
  std::string output;  ///< stdout
  std::string errors;  ///< stderr
};

/// Runs a program in a folder and waits for it. It gets its own process group, so that a Ctrl-C
/// meant for us does not reach it, no input, and at most 1 MiB of what it prints is kept.
ProcessResult run_process(const std::filesystem::path& program,
                          const std::vector<std::string>& arguments,
                          const std::filesystem::path& folder);

/// Searches PATH for an executable file.
std::optional<std::filesystem::path> find_program(const std::string& name);

}  // namespace neve::app::output
