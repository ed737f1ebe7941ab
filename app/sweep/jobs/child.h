#pragma once
/// A program that is watched: it may run so long and take so much memory, and it dies with us.

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "app/output/process.h"

namespace neve::app::sweep::jobs {

struct ChildLimits {
  double timeout = 0;        ///< s; 0: none
  std::uint64_t memory = 0;  ///< bytes; 0: none
  double grace = 10;         ///< s between asking to end and ending
};

enum class Ending {
  exited,         ///< by itself, with a code
  signaled,       ///< by a signal that was not ours
  timeout,        ///< it ran longer than allowed
  out_of_memory,  ///< it held more than allowed
  stopped         ///< by stop()
};

struct ChildResult {
  Ending ending = Ending::exited;
  int code = 0;    ///< of exited
  int signal = 0;  ///< of signaled
  double seconds = 0, cpu_seconds = 0;
  std::uint64_t peak_memory = 0;  ///< bytes, resident
};

class Child {
 public:
  using Clock = std::chrono::steady_clock;

  /// Starts it as output::start_process does, without input.
  /// @param log  takes the output of the child, appended
  /// @throws IoError when the log cannot be opened or the process cannot be made
  Child(const output::Command& command, const std::filesystem::path& log,
        const ChildLimits& limits);
  /// Kills the child if it still runs.
  ~Child();
  Child(Child&& other) noexcept;
  Child& operator=(Child&& other) = delete;

  /// Enforces the limits. To be called some times a second.
  /// @return how the child ended; empty while it runs
  std::optional<ChildResult> poll();

  /// Asks the child to end; poll() kills it when it does not within the grace.
  void stop();

  pid_t pid() const { return pid_; }
  double seconds() const;

 private:
  void end_because(Ending why);

  pid_t pid_ = -1;
  ChildLimits limits_;
  Clock::time_point start_, asked_at_, checked_at_;
  std::uint64_t seen_memory_ = 0;  ///< bytes, the most that looking at its limit found
  std::optional<Ending> why_;      ///< it was asked to end
  bool is_killed_ = false;
};

}  // namespace neve::app::sweep::jobs
