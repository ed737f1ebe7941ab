#pragma once
/// Exit codes, and the errors that lead to them; those of scenes are in app/scene/toml/error.h.
/// main turns each into one message and one code.

#include <new>
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

/// "WHERE: error: TEXT; ADVICE", without what is empty.
inline std::string error_sentence(const std::string& where, const std::string& text,
                                  const std::string& advice) {
  return where + (where.empty() ? "" : ": error: ") + text + (advice.empty() ? "" : "; ") + advice;
}

/// A mistake on the command line. what() is "WHERE: error: MESSAGE; HINT", where WHERE is the flag.
struct UsageError : std::runtime_error {
  UsageError(std::string flag, std::string text, std::string advice = {})
      : std::runtime_error(error_sentence(flag, text, advice)),
        where(std::move(flag)),
        message(std::move(text)),
        hint(std::move(advice)) {}
  std::string where, message, hint;
};

/// A file that could not be read or written.
struct IoError : Error {
  IoError(const std::string& message, std::string place, std::string advice = {})
      : Error(exit_io, message, std::move(place), std::move(advice)) {}
};

/// An existing file that cannot be read, for its permissions or an error of the disk.
struct UnreadableError : IoError {
  using IoError::IoError;
};

/// The error for more than a limit allows, found before anything was allocated.
struct LimitError : Error {
  LimitError(const std::string& message, std::string place, std::string advice)
      : Error(exit_refused, message, std::move(place), std::move(advice)) {}
};

/// Lets an error of memory, or of its limit, pass on. Call it first where any error of a file is
/// handled: an allocation that failed says nothing about the file.
inline void rethrow_no_memory(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) || dynamic_cast<const LimitError*>(&error)) throw;
}

}  // namespace neve::app
