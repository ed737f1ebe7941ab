#include "app/sweep/jobs/child.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>

#include "app/support/errors.h"

namespace neve::app::sweep::jobs {

namespace {

/// Beyond the limit on resident memory: stacks of threads and what drivers map without using it.
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

/// Between fork and exec: only what is safe there.
[[noreturn]] void become(const char* program, char* const* argv, const char* folder, int log,
                         pid_t parent, std::uint64_t memory) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
  if (memory > 0) {
    // A process that allocates faster than poll() checks meets this limit.
    const rlim_t data = memory + unused_data;
    const rlimit limit{data, data};
    ::setrlimit(RLIMIT_DATA, &limit);
  }
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(log, STDOUT_FILENO);
  ::dup2(log, STDERR_FILENO);
  if (::chdir(folder) != 0) ::_exit(127);
  ::execv(program, argv);
  ::_exit(127);
}

}  // namespace

Child::Child(const ChildCommand& command, const ChildLimits& limits)
    : limits_(limits), start_(Clock::now()), checked_at_(start_) {
  std::vector<std::string> words{command.program.string()};
  words.insert(words.end(), command.arguments.begin(), command.arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const std::string folder = command.folder.string(), program = command.program.string();
  const int log =
      ::open(command.log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (log < 0)
    throw IoError("cannot write " + command.log.string() + ": " + std::strerror(errno),
                  command.log.string());
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ == 0) become(program.c_str(), argv.data(), folder.c_str(), log, parent, limits.memory);
  const int reason = errno;
  ::close(log);
  if (pid_ < 0)
    throw IoError(std::string("cannot start a process: ") + std::strerror(reason), program,
                  "try fewer --jobs");
  // Both sides set it, so the order does not matter.
  ::setpgid(pid_, pid_);
}

Child::Child(Child&& other) noexcept
    : pid_(other.pid_),
      limits_(other.limits_),
      start_(other.start_),
      asked_at_(other.asked_at_),
      checked_at_(other.checked_at_),
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
    result.peak_memory = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
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
    // Not asked: asking costs memory too.
    if (resident_bytes(pid_) > limits_.memory) {
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
