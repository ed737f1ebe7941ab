#include "app/support/machine.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <thread>

#include "app/support/errors.h"
#include "app/support/version.h"

namespace neve::app {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

/// The number in a file that holds nothing else; none when it is missing or says "max".
std::optional<std::uint64_t> read_number(const fs::path& file) {
  std::ifstream in(file);
  std::string word;
  std::uint64_t value = 0;
  if (!(in >> word)) return std::nullopt;
  const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
  if (result.ec != std::errc()) return std::nullopt;
  return value;
}

/// The value of "KEY: 1234 kB" or "KEY 1234" in a file of such lines.
std::optional<std::uint64_t> read_field(const fs::path& file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string word;
    std::uint64_t value = 0;
    if (words >> word >> value && word == key) return value;
  }
  return std::nullopt;
}

/// Memory that a group and those above it still allow. Reclaimable cache counts as free.
std::uint64_t left_in_groups(const fs::path& root, fs::path group, const char* limit_file,
                             const char* usage_file, const char* cache_key) {
  std::uint64_t left = unlimited;
  while (true) {
    const fs::path folder = root / group.relative_path();
    const auto limit = read_number(folder / limit_file);
    const auto usage = read_number(folder / usage_file);
    if (limit && usage) {
      const auto cache = read_field(folder / "memory.stat", cache_key).value_or(0);
      const std::uint64_t used = *usage - std::min(*usage, cache);
      left = std::min(left, *limit - std::min(*limit, used));
    }
    if (!group.has_relative_path()) return left;
    group = group.parent_path();
  }
}

std::uint64_t left_in_control_groups() {
  std::uint64_t left = unlimited;
  std::ifstream in("/proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    // "0::/path" is version 2, "9:memory:/path" version 1.
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const fs::path group = line.substr(second + 1);
    if (controllers.empty()) {
      left = std::min(left, left_in_groups("/sys/fs/cgroup", group, "memory.max", "memory.current",
                                           "inactive_file"));
    } else if (controllers.find("memory") != std::string::npos) {
      left = std::min(left, left_in_groups("/sys/fs/cgroup/memory", group, "memory.limit_in_bytes",
                                           "memory.usage_in_bytes", "total_inactive_file"));
    }
  }
  return left;
}

}  // namespace

std::uint64_t address_space_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return std::numeric_limits<std::uint64_t>::max();
  return limit.rlim_cur;
}

std::uint64_t available_memory() {
  const auto kilobytes = read_field("/proc/meminfo", "MemAvailable:");
  const std::uint64_t system = kilobytes ? *kilobytes * 1024 : std::uint64_t{1} << 30;
  return std::min(system, left_in_control_groups());
}

std::uint64_t usable_memory() {
  return available_memory() / 10 * 8;
}

std::string machine_text() {
  std::string processor = "unknown processor";
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const std::size_t colon = line.find(": ");
    if (!line.starts_with("model name") || colon == std::string::npos) continue;
    processor = line.substr(colon + 2);
    break;
  }
  const unsigned cores = std::thread::hardware_concurrency();
  return processor + ", " + std::to_string(cores) + (cores == 1 ? " core; " : " cores; ") +
         build().compiler;
}

int core_count(int threads) {
  return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

std::string host_name() {
  char name[256] = "";
  ::gethostname(name, sizeof name - 1);
  return name;
}

fs::path this_program() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error)
    throw IoError("cannot find the path of the program: " + error.message(), "/proc/self/exe",
                  "mount /proc, which sweeps, pick and the example need");
  return program;
}

fs::path default_scene() {
  const char* const name = "snowball.toml";
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  // The scene next to the sources comes first by the program's place, then by where it was built.
  for (const fs::path& folder :
       {program / "../../scenes", program / "../share/neve/scenes", fs::path(NEVE_SCENE_DIR)})
    if (fs::is_regular_file(folder / name, error)) return (folder / name).lexically_normal();
  throw IoError(std::string("the default scene ") + name + " is not in the program's folder", name,
                "name a scene file");
}

}  // namespace neve::app
