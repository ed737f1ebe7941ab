#include "app/cli/devices/terminal_lines.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>

namespace neve::app::cli::devices {

namespace {

/// A program in the background that reads from its terminal is stopped.
bool is_in_foreground() {
  const pid_t group = ::tcgetpgrp(STDIN_FILENO);
  return group < 0 || group == ::getpgrp();
}

}  // namespace

bool TerminalLines::is_there() {
  return ::isatty(STDIN_FILENO) != 0;
}

std::optional<std::string> TerminalLines::next(double seconds) {
  std::size_t end = typed_.find('\n');
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (end == std::string::npos && !is_at_end_ && is_in_foreground() &&
      ::poll(&input, 1, static_cast<int>(1e3 * seconds)) > 0) {
    char bytes[4096];
    const ssize_t count = ::read(STDIN_FILENO, bytes, sizeof bytes);
    if (count > 0) typed_.append(bytes, static_cast<std::size_t>(count));
    is_at_end_ = count == 0 || (count < 0 && errno != EINTR && errno != EAGAIN);
    end = typed_.find('\n');
  }
  if (end == std::string::npos) return std::nullopt;
  std::string line = typed_.substr(0, end);
  typed_.erase(0, end + 1);
  return line;
}

}  // namespace neve::app::cli::devices
