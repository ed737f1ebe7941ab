#include "sim/shapes/held_files.h"

#include <filesystem>
#include <map>
#include <optional>

#include "sim/types/errors.h"

namespace neve::sim::shapes {

namespace {

struct Held {
  std::mutex mutex;
  int holders = 0;
  std::map<std::string, std::string> stamps;
};

Held& held() {
  static Held held;
  return held;
}

/// Returns the stamp of a file as it is now; none of a file that is not there.
std::optional<std::string> stamp_now(const std::string& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error) return std::nullopt;
  const auto time = std::filesystem::last_write_time(path, error);
  if (error) return std::nullopt;
  return path + "|" + std::to_string(size) + "|" + std::to_string(time.time_since_epoch().count());
}

}  // namespace

HeldFiles::HeldFiles() {
  const std::lock_guard lock(held().mutex);
  ++held().holders;
}

HeldFiles::~HeldFiles() {
  const std::lock_guard lock(held().mutex);
  if (--held().holders == 0) held().stamps.clear();
}

bool are_files_held() {
  const std::lock_guard lock(held().mutex);
  return held().holders > 0;
}

bool is_held(const std::string& path) {
  const std::lock_guard lock(held().mutex);
  return held().stamps.contains(path);
}

std::vector<std::string> changed_held_files() {
  const std::lock_guard lock(held().mutex);
  std::vector<std::string> changed;
  for (const auto& [path, stamp] : held().stamps)
    if (stamp_now(path) != stamp) changed.push_back(path);
  return changed;
}

void require_unchanged(const std::string& path) {
  const std::string stamp = file_stamp(path);
  if (!is_held(path) || stamp_now(path) == stamp) return;
  throw ShapeError(path +
                   ": has changed since the command began and would have to be read again. Start "
                   "again when nothing writes it");
}

std::string file_stamp(const std::string& path) {
  const std::lock_guard lock(held().mutex);
  if (const auto known = held().stamps.find(path); known != held().stamps.end())
    return known->second;
  const std::optional<std::string> now = stamp_now(path);
  if (now && held().holders > 0) held().stamps.emplace(path, *now);
  return now.value_or(path);
}

}  // namespace neve::sim::shapes
