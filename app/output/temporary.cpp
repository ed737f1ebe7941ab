#include "app/output/temporary.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <system_error>

#include "app/support/machine.h"

namespace neve::app::output {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_name = 255, longest_host = 32, random_digits = 8;
constexpr std::string_view suffix = ".tmp";
constexpr auto abandoned_elsewhere = std::chrono::hours(24);

/// Without dots, which separate the parts of a name.
std::string plain_host() {
  std::string host = host_name().substr(0, longest_host);
  for (char& c : host)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '-';
  return host.empty() ? "host" : host;
}

struct Owner {
  std::string host;
  pid_t process = 0;
};

/// Takes the last part of a dotted name off it.
std::string_view take_part(std::string_view& name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return {};
  const std::string_view part = name.substr(dot + 1);
  name.remove_suffix(part.size() + 1);
  return part;
}

/// Whose temporary file this is; nothing for other names.
std::optional<Owner> owner_of(std::string_view name) {
  if (!name.starts_with('.') || !name.ends_with(suffix)) return std::nullopt;
  name.remove_suffix(suffix.size());
  const std::string_view random = take_part(name), process = take_part(name),
                         host = take_part(name);
  const bool is_random = random.size() == random_digits &&
                         random.find_first_not_of("0123456789abcdef") == std::string_view::npos;
  Owner owner{std::string(host), 0};
  const auto end = process.data() + process.size();
  const auto [last, error] = std::from_chars(process.data(), end, owner.process);
  if (!is_random || host.empty() || error != std::errc() || last != end || owner.process <= 0)
    return std::nullopt;
  return owner;
}

bool is_alive(pid_t process) {
  return ::kill(process, 0) == 0 || errno == EPERM;
}

bool is_abandoned(const fs::path& file, const Owner& owner) {
  if (owner.host == plain_host()) return !is_alive(owner.process);
  std::error_code error;
  const auto written = fs::last_write_time(file, error);
  return !error && fs::file_time_type::clock::now() - written > abandoned_elsewhere;
}

}  // namespace

fs::path temporary_name(const fs::path& path) {
  static thread_local std::mt19937_64 random{std::random_device{}()};
  char digits[random_digits + 1];
  std::snprintf(digits, sizeof digits, "%08x", static_cast<unsigned>(random() >> 32));
  const std::string end =
      '.' + plain_host() + '.' + std::to_string(::getpid()) + '.' + digits + std::string(suffix);
  const std::string name = path.filename().string().substr(0, longest_name - 1 - end.size());
  return path.parent_path() / ('.' + name + end);
}

void remove_abandoned(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::optional<Owner> owner = owner_of(it->path().filename().string());
    std::error_code ignored;
    if (owner && fs::is_regular_file(it->symlink_status(ignored)) &&
        is_abandoned(it->path(), *owner))
      fs::remove(it->path(), ignored);
  }
}

}  // namespace neve::app::output
