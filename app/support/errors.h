#pragma once
/// Exit codes, and the errors that lead to them; those of scenes and of the command line are in
/// scene/error.h. main turns each into one message and one code.

#include <stdexcept>
#include <string>
#include <vector>

namespace neve::app {

enum ExitCode {
  exit_ok = 0,
  exit_internal = 1,
  exit_usage = 2,
  exit_invalid_scene = 3,
  exit_no_backend = 4,
  exit_diverged = 5,
  exit_io = 6,
  exit_runs_failed = 7,  ///< of a sweep
  exit_refused = 8,
  exit_check_failed = 9,
  exit_resumable = 75,     ///< interrupted, with a checkpoint
  exit_interrupted = 130,  ///< interrupted without
};

/// A mistake at the border: what() is the whole sentence, where and hint serve `--json`.
struct Error : std::runtime_error {
  Error(int exit_code, const std::string& message, std::string place = {}, std::string advice = {})
      : std::runtime_error(message),
        code(exit_code),
        where(std::move(place)),
        hint(std::move(advice)) {}
  int code;
  std::string where;                    ///< file or address concerned, may be empty
  std::string hint;                     ///< advice, may be empty
  std::vector<std::string> warnings{};  ///< said before it, for `--json`
};

/// A file that could not be read or written.
struct IoError : Error {
  IoError(const std::string& message, std::string place, std::string advice = {})
      : Error(exit_io, message, std::move(place), std::move(advice)) {}
};

/// A file that is there and that the machine does not give: it says nothing about what is in it.
struct UnreadableError : IoError {
  using IoError::IoError;
};

/// More than a limit allows, found before anything was allocated.
struct LimitError : Error {
  LimitError(const std::string& message, std::string place, std::string advice)
      : Error(exit_refused, message, std::move(place), std::move(advice)) {}
};

}  // namespace neve::app
