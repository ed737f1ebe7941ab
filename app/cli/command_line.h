#pragma once
/// The command line: all commands, and the one that is called.

#include <functional>
#include <string>
#include <vector>

#include "app/cli/report_error.h"
#include "app/options/option.h"

namespace neve::app::cli {

inline constexpr const char* exit_codes =
    "Exit codes: 0 ok, 1 internal, 2 usage, 3 scene invalid or missing, 4 no GL backend,\n5 "
    "diverged, 6 input or output failed, 7 runs of a sweep failed, 8 refused by a limit,\n9 a "
    "check failed, 75 interrupted with a checkpoint, 130 interrupted.";

/// A command that can be called.
struct Entry {
  options::Command command;
  std::function<int()> run{};  ///< with the options that were read; none: a part has to be named
  std::vector<Entry> parts{};

  /// "sweep", "collect"; "neve" of the program
  std::string name() const;
  /// A part by its name; null if there is none.
  Entry* part(const std::string& name);
  std::vector<std::string> part_names() const;
  /// Broken into lines for a terminal.
  std::string help() const;
};

/// neve bench
Entry bench_entry();

/// The program: its parts are the commands, in the order of help.
Entry program();

/// Parses and runs. @return the exit code
/// @throws UsageError, and the errors of the command
int run_command_line(const std::vector<std::string>& words);

/// Finds out where the flags want errors; works on command lines that do not parse.
ErrorOutput error_output(const std::vector<std::string>& words);

}  // namespace neve::app::cli
