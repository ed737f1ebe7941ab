#pragma once
/// Lines that a person types into the terminal, taken when they are complete: a program with a
/// screen does not wait for them.

#include <optional>
#include <string>

namespace neve::app::cli::devices {

class TerminalLines {
 public:
  /// True if the standard input is a terminal.
  static bool is_there();

  /// Returns the next line, for which it waits at most so many seconds. Returns nothing without a
  /// line, and in the background, where the terminal is another program's.
  std::optional<std::string> next(double seconds);
  bool is_at_end() const { return is_at_end_; }

 private:
  std::string typed_;
  bool is_at_end_ = false;
};

}  // namespace neve::app::cli::devices
