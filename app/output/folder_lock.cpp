#include "app/output/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/chrono.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <exception>
#include <string_view>
#include <thread>

#include "app/output/atomic_file.h"
#include "app/output/temporary.h"
#include "app/support/errors.h"
#include "app/support/machine.h"
#include "app/support/out_folder.h"

namespace neve::app::output {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_holder = 400;

[[noreturn]] void fail_locking(const fs::path& file, int reason) {
  throw IoError(file.string() + ": cannot lock the folder: " + std::strerror(reason), file.string(),
                reason == ENOLCK || reason == ENOSYS || reason == EOPNOTSUPP
                    ? or_other_place("use a file system that has locks")
                    : or_other_place());
}

/// True for text of write_holder(), or none: another process may just be writing it.
bool is_ours(int fd) {
  char bytes[longest_holder];
  const ssize_t count = ::pread(fd, bytes, sizeof bytes, 0);
  if (count <= 0) return true;
  const std::string_view text(bytes, static_cast<std::size_t>(count));
  // A power cut may leave zeros, or a part of it.
  constexpr std::string_view start = "neve ";
  return text.find_first_not_of('\0') == text.npos ||
         start.starts_with(text.substr(0, start.size())) || text.find(", process ") != text.npos;
}

Descriptor open_lock(const fs::path& file) {
  Descriptor lock(
      ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666));
  if (lock.get() < 0) fail_locking(file, errno);
  struct stat status {};
  if (::fstat(lock.get(), &status) != 0) fail_locking(file, errno);
  if (!S_ISREG(status.st_mode)) fail_locking(file, EINVAL);
  if (status.st_nlink > 1 || !is_ours(lock.get()))
    throw IoError(file.string() + ": is a file of another program, and has the name of our lock",
                  file.string(), or_other_place("move it away"));
  return lock;
}

void write_holder(const fs::path& file, int fd, const std::string& holder) {
  const std::string text =
      fmt::format("{}, process {} on {}, since {:%Y-%m-%d %H:%M:%S} UTC\n", holder, ::getpid(),
                  host_name(), fmt::gmtime(std::time(nullptr)));
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
  int reason = ::ftruncate(fd, 0) == 0 ? 0 : errno;
  if (reason == 0) reason = write_all(fd, {bytes, text.size()});
  if (reason != 0) fail_writing(file, "cannot write", reason);
}

/// Returns the first line of a file; "" where no such file exists, or no text is in it.
std::string first_line(const fs::path& file) {
  std::string text;
  try {
    const std::vector<std::uint8_t> bytes = read_file(file, longest_holder);
    text.assign(bytes.begin(), bytes.end());
  } catch (const std::exception&) {
    // Another program may have written the file.
  }
  text.resize(std::min(text.size(), text.find('\n')));
  return text;
}

constexpr int looks = 30;
constexpr std::chrono::milliseconds between_looks{10};

}  // namespace

std::optional<FolderLock> FolderLock::try_lock(const fs::path& folder, const std::string& holder,
                                               Kind kind, const char* name) {
  make_folder(folder);
  const fs::path file = folder / name;
  Descriptor lock = open_lock(file);
  int result = 0;
  do result = ::flock(lock.get(), (kind == Kind::alone ? LOCK_EX : LOCK_SH) | LOCK_NB);
  while (result != 0 && errno == EINTR);
  if (result != 0 && errno == EWOULDBLOCK) return std::nullopt;
  if (result != 0) fail_locking(file, errno);
  write_holder(file, lock.get(), holder);
  remove_abandoned_below(folder);
  return FolderLock(std::move(lock));
}

FolderLock::FolderLock(const fs::path& folder, const std::string& holder, Kind kind) : file_(-1) {
  std::optional<FolderLock> lock = try_lock(folder, holder, kind);
  if (!lock)
    throw IoError(folder.string() + ": is in use by " + holder_of(folder), folder.string(),
                  or_other_place("wait for it"));
  file_ = std::move(lock->file_);
}

bool FolderLock::is_held(const fs::path& folder) {
  const Descriptor lock(
      ::open((folder / default_name).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  return lock.get() >= 0 && ::flock(lock.get(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

std::string FolderLock::holder_of(const fs::path& folder, const char* name) {
  std::string text = first_line(folder / name);
  // A process that has just got the lock writes its name at once.
  for (int look = 0; text.empty() && look < looks; ++look) {
    std::this_thread::sleep_for(between_looks);
    text = first_line(folder / name);
  }
  const bool is_plain =
      std::all_of(text.begin(), text.end(), [](unsigned char c) { return c >= ' ' && c < 127; });
  return text.empty() || !is_plain ? "another process" : text;
}

}  // namespace neve::app::output
