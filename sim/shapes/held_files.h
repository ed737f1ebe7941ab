#pragma once
/// Files that shapes are read from, and what was read of them lately.

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace neve::sim::shapes {

/// A run keeps what it has read: while one of these exists, files count as they were when they were
/// first asked for, whoever writes them anew. Things made of them are kept as long.
class HeldFiles {
 public:
  HeldFiles();
  ~HeldFiles();
  HeldFiles(const HeldFiles&) = delete;
  HeldFiles& operator=(const HeldFiles&) = delete;
};

bool are_files_held();
/// True for a file that was there when it was first asked for.
bool is_held(const std::string& path);
/// Held files that have been written or removed since.
std::vector<std::string> changed_held_files();
/// Checks a file before and after it is read. @throws ShapeError where a held one has changed
void require_unchanged(const std::string& path);

/// Tells one content of a file from another: path, size and time of the last change, of a held file
/// those of the time when it was first asked for.
std::string file_stamp(const std::string& path);

/// Lifetime of things that are made: one for a whole run, or one for each moment, which is dropped.
enum class Made { once, each_moment };

/// The things that were used last, by name; all of them while files are held. Making happens under
/// a lock: nothing is made twice.
template <class Thing>
class Recent {
 public:
  explicit Recent(Made made = Made::once) : made_(made) {}

  template <class Make>
  std::shared_ptr<const Thing> get(const std::string& name, const Make& make) {
    const std::lock_guard lock(mutex_);
    for (const auto& [key, thing] : things_)
      if (key == name) return thing;
    std::shared_ptr<const Thing> made = make();
    const bool is_kept = made_ == Made::once && are_files_held();
    while (!is_kept && things_.size() >= most) things_.erase(things_.begin());
    things_.emplace_back(name, made);
    return made;
  }

 private:
  static constexpr std::size_t most = 8;
  const Made made_;
  std::mutex mutex_;
  std::vector<std::pair<std::string, std::shared_ptr<const Thing>>> things_;
};

}  // namespace neve::sim::shapes
