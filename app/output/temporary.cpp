#include "app/output/temporary.h"

#include <signal.h>
#include <unistd.h>

#include <fmt/core.h>

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

#include "app/support/machine.h"
#include "app/support/text.h"

namespace neve::app::output {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_name = 255, longest_host = 32, random_digits = 8;
constexpr std::string_view suffix = ".tmp";
constexpr auto abandoned_elsewhere = std::chrono::hours(24);

/// Returns the name of the host without dots, which separate the parts of a name.
std::string plain_host() {
  std::string host = host_name().substr(0, longest_host);
  for (char& c : host)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '-';
  return host.empty() ? "host" : host;
}

/// The state and start that the system says a process has.
struct Life {
  char state = 0;
  /// Ticks from the start of the machine to that of the process: a number is given again, but not
  /// with the same start. 0: the system did not say.
  std::uint64_t start = 0;
};

/// Empty if the system does not say. Source: proc(5), /proc/PID/stat, fields 3 and 22.
std::optional<Life> life_of(pid_t process) {
  std::ifstream in("/proc/" + std::to_string(process) + "/stat");
  std::string text(4096, '\0');  // about 300 are used
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  // The name of a program may hold anything, a parenthesis too.
  const std::size_t end_of_name = text.rfind(')');
  if (end_of_name == std::string::npos) return std::nullopt;
  std::istringstream fields(text.substr(end_of_name + 1));
  Life life;
  fields >> life.state;
  std::string skipped;
  for (int field = 4; field < 22; ++field) fields >> skipped;
  if (!(fields >> life.start)) return std::nullopt;
  return life;
}

struct Owner {
  std::string host;
  pid_t process = 0;
  std::uint64_t start = 0;
};

/// Takes the last part of a dotted name off it.
std::string_view take_part(std::string_view& name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return {};
  const std::string_view part = name.substr(dot + 1);
  name.remove_suffix(part.size() + 1);
  return part;
}

/// Returns the process that a temporary file belongs to; nothing for other names.
std::optional<Owner> owner_of(std::string_view name) {
  if (!name.starts_with('.') || !name.ends_with(suffix)) return std::nullopt;
  name.remove_suffix(suffix.size());
  const std::string_view random = take_part(name);
  const auto start = number_of<std::uint64_t>(take_part(name));
  const auto process = number_of<pid_t>(take_part(name));
  const std::string_view host = take_part(name);
  const bool is_random = random.size() == random_digits &&
                         random.find_first_not_of("0123456789abcdef") == std::string_view::npos;
  if (!is_random || host.empty() || !process || *process <= 0 || !start) return std::nullopt;
  return Owner{std::string(host), *process, *start};
}

/// A process that was killed keeps its number until its parent asks for it; it writes no more.
bool is_alive(const Owner& owner) {
  if (::kill(owner.process, 0) != 0 && errno == ESRCH) return false;
  const std::optional<Life> life = life_of(owner.process);
  if (!life) return true;
  const bool is_same = owner.start == 0 || life->start == owner.start;
  return is_same && life->state != 'Z' && life->state != 'X';
}

bool is_abandoned(const fs::path& file, const Owner& owner) {
  if (owner.host == plain_host()) return !is_alive(owner);
  std::error_code error;
  const auto written = fs::last_write_time(file, error);
  return !error && fs::file_time_type::clock::now() - written > abandoned_elsewhere;
}

}  // namespace

fs::path temporary_name(const fs::path& path) {
  static thread_local std::mt19937_64 random{std::random_device{}()};
  const pid_t process = ::getpid();
  const std::string end =
      fmt::format(".{}.{}.{}.{:08x}{}", plain_host(), process,
                  life_of(process).value_or(Life{}).start, random() >> 32, suffix);
  const std::string name = path.filename().string().substr(0, longest_name - 1 - end.size());
  return path.parent_path() / ('.' + name + end);
}

void remove_abandoned(const fs::path& folder) {
  std::error_code error;
  const fs::path here = folder.empty() ? "." : folder;  // the parent of a name alone
  for (fs::directory_iterator it(here, error), end; !error && it != end; it.increment(error)) {
    const std::optional<Owner> owner = owner_of(it->path().filename().string());
    std::error_code ignored;
    const fs::file_status status = it->symlink_status(ignored);
    if (owner && (fs::is_regular_file(status) || fs::is_directory(status)) &&
        is_abandoned(it->path(), *owner))
      fs::remove_all(it->path(), ignored);
  }
}

void remove_abandoned_below(const fs::path& folder) {
  remove_abandoned(folder);
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;
    if (fs::is_directory(it->symlink_status(ignored))) remove_abandoned(it->path());
  }
}

}  // namespace neve::app::output
