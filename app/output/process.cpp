#include "app/output/process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>

#include "app/support/clock.h"

namespace neve::app::output {

namespace {

constexpr std::size_t max_kept = std::size_t{1} << 20;

struct Pipe {
  int read_end = -1, write_end = -1;
  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) == 0) read_end = ends[0], write_end = ends[1];
  }
  ~Pipe() {
    close_write_end();
    if (read_end >= 0) ::close(read_end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close_write_end() {
    if (write_end >= 0) ::close(write_end);
    write_end = -1;
  }
};

/// Returns the wait of poll() for a time: -1 where there is no end, and a second at most.
int milliseconds_until(const std::optional<Clock::time_point>& end) {
  if (!end) return -1;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(*end - Clock::now()).count();
  return static_cast<int>(std::clamp<long long>(left, 0, 1000));
}

/// Reads both pipes to their ends, whichever has something first.
/// @return false when that took too long
bool drain(int out, int err, const std::optional<Clock::time_point>& end, ProcessResult& result) {
  std::array<pollfd, 2> waiting{{{out, POLLIN, 0}, {err, POLLIN, 0}}};
  std::array<std::string*, 2> texts{&result.output, &result.errors};
  std::array<char, 4096> buffer;
  while (waiting[0].fd >= 0 || waiting[1].fd >= 0) {
    if (end && Clock::now() >= *end) return false;
    if (::poll(waiting.data(), waiting.size(), milliseconds_until(end)) < 0) {
      if (errno == EINTR) continue;
      return true;
    }
    for (std::size_t k = 0; k < waiting.size(); ++k) {
      if (waiting[k].fd < 0 || waiting[k].revents == 0) continue;
      const ssize_t count = ::read(waiting[k].fd, buffer.data(), buffer.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) {
        waiting[k].fd = -1;
      } else if (texts[k]->size() < max_kept) {
        texts[k]->append(buffer.data(), static_cast<std::size_t>(count));
      }
    }
  }
  return true;
}

int wait_for(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Copies first: a given file may be a standard stream itself, which another one replaces.
void set_streams(const StartOptions& options) {
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  int files[] = {options.input, options.output, options.errors};
  for (int& file : files) file = ::fcntl(file < 0 ? nothing : file, F_DUPFD_CLOEXEC, 3);
  for (int stream = 0; stream < 3; ++stream) ::dup2(files[stream], stream);
}

/// Makes only calls that are safe between fork and exec. @return errno of the call that failed
int become(const char* folder, char* const* argv, const StartOptions& options, pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // A parent that ended before the line above sends no signal any more.
  if (::getppid() != parent) ::_exit(127);
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
  for (const ResourceLimit& limit : options.limits) {
    const rlimit both{limit.value, limit.value};
    ::setrlimit(static_cast<decltype(RLIMIT_DATA)>(limit.resource), &both);
  }
  set_streams(options);
  if (::chdir(folder) == 0) ::execv(argv[0], argv);
  return errno;
}

/// Waits until a new process runs its program. @return 0, or errno of the call that failed in it
int start_error(Pipe& report) {
  report.close_write_end();
  int reason = 0;
  ssize_t count = 0;
  do count = ::read(report.read_end, &reason, sizeof reason);
  while (count < 0 && errno == EINTR);
  return count > 0 ? reason : 0;
}

}  // namespace

pid_t start_process(const Command& command, const StartOptions& options) {
  std::vector<std::string> words{command.program.string()};
  words.insert(words.end(), command.arguments.begin(), command.arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const std::string folder = command.folder.string();
  Pipe report;
  if (report.read_end < 0) throw std::system_error(errno, std::generic_category());
  const pid_t parent = ::getpid(), child = ::fork();
  if (child == 0) {
    const int reason = become(folder.c_str(), argv.data(), options, parent);
    ::_exit(::write(report.write_end, &reason, sizeof reason) < 0 ? 126 : 127);
  }
  if (child < 0) throw std::system_error(errno, std::generic_category());
  if (const int reason = start_error(report); reason != 0) {
    wait_for(child);
    throw std::system_error(reason, std::generic_category());
  }
  return child;
}

ProcessResult run_process(const std::filesystem::path& program,
                          const std::vector<std::string>& arguments,
                          const std::filesystem::path& folder, double longest) {
  ProcessResult result;
  Pipe out, err;
  if (out.read_end < 0 || err.read_end < 0) {
    result.errors = std::strerror(errno);
    return result;
  }
  pid_t child = -1;
  try {
    child = start_process({program, arguments, folder}, {-1, out.write_end, err.write_end, {}});
  } catch (const std::system_error& error) {
    result.errors = error.code().message();
    return result;
  }
  out.close_write_end();
  err.close_write_end();
  result.has_started = true;
  std::optional<Clock::time_point> end;
  if (longest < 1e9)
    end = Clock::now() + std::chrono::ceil<Clock::duration>(std::chrono::duration<double>(longest));
  result.is_too_slow = !drain(out.read_end, err.read_end, end, result);
  // The child has a group of its own: what it started in turn ends too.
  if (result.is_too_slow) ::kill(-child, SIGKILL);
  result.exit_code = wait_for(child);
  return result;
}

std::optional<std::filesystem::path> find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "/usr/local/bin:/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    std::error_code error;
    const auto file = std::filesystem::absolute(folder.empty() ? "." : folder, error) / name;
    if (std::filesystem::is_regular_file(file, error) && ::access(file.c_str(), X_OK) == 0)
      return file;
  }
  return std::nullopt;
}

}  // namespace neve::app::output
