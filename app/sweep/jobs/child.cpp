#include "app/sweep/jobs/child.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "app/support/errors.h"

namespace neve::app::sweep::jobs {

namespace {

/// Data beyond the limit on resident memory: stacks of threads and unused mappings of drivers.
constexpr std::uint64_t unused_data = std::uint64_t{1} << 30;
constexpr auto memory_interval = std::chrono::milliseconds(50);

/// Bytes of memory that a process holds now.
std::uint64_t resident_bytes(pid_t pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/statm");
  std::uint64_t all = 0, resident = 0;
  in >> all >> resident;
  return in ? resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) : 0;
}

double seconds_of(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

/// A process that allocates faster than poll() checks meets the limit on data.
std::vector<output::ResourceLimit> resource_limits(const ChildLimits& limits) {
  std::vector<output::ResourceLimit> list{{RLIMIT_CORE, 0}};
  if (limits.memory > 0) list.push_back({RLIMIT_DATA, limits.memory + unused_data});
  return list;
}

}  // namespace

Child::Child(const output::Command& command, const std::filesystem::path& log,
             const ChildLimits& limits)
    : limits_(limits), start_(Clock::now()), checked_at_(start_) {
  const int file =
      ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (file < 0)
    throw IoError("cannot write " + log.string() + ": " + std::strerror(errno), log.string());
  try {
    pid_ = output::start_process(command, {-1, file, file, resource_limits(limits)});
  } catch (const std::system_error& error) {
    ::close(file);
    throw IoError("cannot start a process: " + error.code().message(), command.program.string(),
                  "try fewer --jobs");
  }
  ::close(file);
}

Child::Child(Child&& other) noexcept
    : pid_(other.pid_),
      limits_(other.limits_),
      start_(other.start_),
      asked_at_(other.asked_at_),
      checked_at_(other.checked_at_),
      seen_memory_(other.seen_memory_),
      why_(other.why_),
      is_killed_(other.is_killed_) {
  other.pid_ = -1;
}

Child::~Child() {
  if (pid_ <= 0) return;
  ::kill(-pid_, SIGKILL);
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
}

double Child::seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

void Child::end_because(Ending why) {
  why_ = why;
  asked_at_ = Clock::now();
  // A stopped process receives no signal before it continues.
  ::kill(-pid_, SIGTERM);
  ::kill(-pid_, SIGCONT);
}

void Child::stop() {
  if (pid_ > 0 && !why_) end_because(Ending::stopped);
}

std::optional<ChildResult> Child::poll() {
  int status = 0;
  rusage usage{};
  const pid_t ended = ::wait4(pid_, &status, WNOHANG, &usage);
  const auto now = Clock::now();
  if (ended == pid_) {
    ChildResult result;
    result.seconds = seconds();
    result.cpu_seconds = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
    // The kernel counts in batches: its peak may be below what was seen.
    result.peak_memory = std::max(seen_memory_, static_cast<std::uint64_t>(usage.ru_maxrss) * 1024);
    result.ending = why_ ? *why_ : WIFSIGNALED(status) ? Ending::signaled : Ending::exited;
    result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
    result.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    // Whatever it may have started goes with it.
    ::kill(-pid_, SIGKILL);
    pid_ = -1;
    return result;
  }
  if (!why_ && limits_.timeout > 0 && seconds() > limits_.timeout) end_because(Ending::timeout);
  if (!why_ && limits_.memory > 0 && now - checked_at_ >= memory_interval) {
    checked_at_ = now;
    // The process is killed at once: asking it to end costs memory too.
    seen_memory_ = std::max(seen_memory_, resident_bytes(pid_));
    if (seen_memory_ > limits_.memory) {
      why_ = Ending::out_of_memory;
      is_killed_ = true;
      ::kill(-pid_, SIGKILL);
    }
  }
  const std::chrono::duration<double> waited = now - asked_at_;
  if (why_ && !is_killed_ && waited.count() > limits_.grace) {
    is_killed_ = true;
    ::kill(-pid_, SIGKILL);
  }
  return std::nullopt;
}

}  // namespace neve::app::sweep::jobs
