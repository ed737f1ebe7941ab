#include "app/output/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <set>
#include <string>
#include <system_error>
#include <thread>

#include "app/output/descriptor.h"
#include "app/output/temporary.h"
#include "app/support/out_folder.h"

namespace neve::app::output {

namespace {

constexpr std::size_t max_at_once = 16;

/// "link", "folder", "device"; nothing for regular or missing files.
const char* special_kind(const std::filesystem::path& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0 || S_ISREG(status.st_mode)) return nullptr;
  return S_ISLNK(status.st_mode) ? "link" : S_ISDIR(status.st_mode) ? "folder" : "device";
}

/// @return errno
int sync_at(const std::filesystem::path& path, int flags) {
  const Descriptor file(::open(path.c_str(), flags | O_CLOEXEC));
  if (file.get() < 0) return errno;
  // Some file systems keep folders in order by themselves and refuse this.
  return ::fsync(file.get()) == 0 || errno == EINVAL || errno == EOPNOTSUPP ? 0 : errno;
}

void rename_or_fail(const std::filesystem::path& temporary, const std::filesystem::path& path) {
  if (std::rename(temporary.c_str(), path.c_str()) == 0) return;
  const int reason = errno;
  ::unlink(temporary.c_str());
  fail_writing(path, "cannot rename the finished file", reason);
}

/// @param path  that it is to replace, named in errors; the temporary file is gone then
void write_temporary(const std::filesystem::path& temporary, const std::filesystem::path& path,
                     std::span<const std::uint8_t> bytes, Durability durability,
                     const Prepare& prepare = {}) {
  Descriptor file(
      ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666));
  if (file.get() < 0) fail_writing(path, "cannot create", errno);
  int reason = write_all(file.get(), bytes);
  if (reason == 0 && prepare) reason = prepare(file.get());
  if (reason == 0 && durability == Durability::synced && ::fsync(file.get()) != 0) reason = errno;
  const int close_reason = file.close();
  if (reason == 0) reason = close_reason;
  if (reason == 0) return;
  ::unlink(temporary.c_str());
  fail_writing(path, "cannot write " + std::to_string(bytes.size()) + " bytes", reason);
}

void refuse_special(const std::filesystem::path& path) {
  const char* kind = special_kind(path);
  if (!kind) return;
  throw IoError(path.string() + ": is a " + kind + ", where a file is to be written", path.string(),
                or_other_place("move it away"));
}

}  // namespace

[[noreturn]] void fail_writing(const std::filesystem::path& path, const std::string& sentence,
                               int reason) {
  const bool is_full = reason == ENOSPC || reason == EDQUOT || reason == EFBIG;
  throw IoError(path.string() + ": " + sentence + ": " + std::strerror(reason), path.string(),
                or_other_place(is_full ? "free disk space" : ""));
}

int write_all(int fd, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    if (written == 0) return ENOSPC;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return 0;
}

void replace_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes,
                  Durability durability, const Prepare& prepare) {
  const std::filesystem::path temporary = temporary_name(path);
  write_temporary(temporary, path, bytes, durability, prepare);
  rename_or_fail(temporary, path);
  if (durability == Durability::synced) sync_folder(path.parent_path());
}

void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes,
                Durability durability) {
  refuse_special(path);
  replace_file(path, bytes, durability);
}

void write_file(const std::filesystem::path& path, std::string_view text, Durability durability) {
  write_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, durability);
}

void write_among_others(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  remove_abandoned(path.parent_path());
  write_file(path, bytes);
}

void write_among_others(const std::filesystem::path& path, std::string_view text) {
  remove_abandoned(path.parent_path());
  write_file(path, text);
}

void write_together(const std::vector<FileToWrite>& files) {
  for (const FileToWrite& file : files) {
    refuse_special(file.path);
    remove_abandoned(file.path.parent_path());
  }
  std::vector<std::filesystem::path> temporaries;
  const auto remove_temporaries = [&] {
    for (const std::filesystem::path& temporary : temporaries) ::unlink(temporary.c_str());
  };
  try {
    for (const FileToWrite& file : files) {
      temporaries.push_back(temporary_name(file.path));
      write_temporary(temporaries.back(), file.path, file.bytes, Durability::cached);
    }
    for (std::size_t k = 0; k < files.size(); ++k) rename_or_fail(temporaries[k], files[k].path);
  } catch (...) {
    remove_temporaries();
    throw;
  }
}

void move_into_place(const std::filesystem::path& temporary, const std::filesystem::path& path) {
  try {
    refuse_special(path);
  } catch (const IoError&) {
    ::unlink(temporary.c_str());
    throw;
  }
  rename_or_fail(temporary, path);
}

void sync_files(const std::vector<std::filesystem::path>& files) {
  std::set<std::filesystem::path> folders;
  for (const std::filesystem::path& file : files) folders.insert(file.parent_path());
  std::atomic<std::size_t> next = 0;
  std::atomic<int> failed = -1, reason = 0;
  const auto sync_some = [&] {
    for (std::size_t k = next++; k < files.size(); k = next++)
      if (const int error = sync_at(files[k], O_RDONLY); error != 0) {
        reason = error;
        failed = static_cast<int>(k);
      }
  };
  // The journal of a file system writes down together what is asked for at the same time.
  std::vector<std::thread> others;
  try {
    while (others.size() + 1 < std::min(files.size(), max_at_once)) others.emplace_back(sync_some);
  } catch (const std::system_error&) {
    // Fewer threads only take longer.
  }
  sync_some();
  for (std::thread& other : others) other.join();
  if (failed >= 0)
    fail_writing(files[static_cast<std::size_t>(failed)], "cannot flush it to the disk", reason);
  for (const std::filesystem::path& folder : folders) sync_folder(folder);
}

void sync_folder(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder.empty() ? "." : folder;
  if (const int reason = sync_at(path, O_RDONLY | O_DIRECTORY); reason != 0)
    fail_writing(path, "cannot flush the folder to the disk", reason);
}

void make_folder(const std::filesystem::path& path) {
  if (path.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(path, error);
  std::error_code ignored;
  if (error && is_symlink(symlink_status(path, ignored)))
    fail_writing(path, "cannot make the folder: it is a link to nothing", error.value());
  if (error && is_regular_file(path, ignored))
    fail_writing(path, "cannot make the folder: it is a file", error.value());
  if (error) fail_writing(path, "cannot create the folder", error.value());
}

void make_own_folder(const std::filesystem::path& path) {
  std::error_code error;
  if (is_symlink(symlink_status(path, error)))
    throw IoError(path.string() + ": is a link, where a folder is to be made", path.string(),
                  or_other_place("move it away"));
  make_folder(path);
}

std::vector<std::uint8_t> read_file(const std::filesystem::path& path, std::uint64_t limit) {
  const auto fail_reading = [&](const std::string& reason) {
    throw IoError(path.string() + ": cannot read: " + reason, path.string());
  };
  const auto fail_by_machine = [&](int reason) {
    if (reason == ENOENT || reason == ENOTDIR || reason == ELOOP)
      fail_reading(std::strerror(reason));
    throw UnreadableError(path.string() + ": cannot read: " + std::strerror(reason), path.string());
  };
  struct stat status {};
  // The type is known before opening: a pipe waits for its writer, and a device may do anything.
  if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    fail_reading("not a regular file");
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) fail_by_machine(errno);
  if (::fstat(file.get(), &status) != 0) fail_by_machine(errno);
  if (!S_ISREG(status.st_mode)) fail_reading("not a regular file");
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size > limit) fail_reading("larger than " + std::to_string(limit) + " bytes");

  std::vector<std::uint8_t> bytes(size);
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::read(file.get(), bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail_by_machine(errno);
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  bytes.resize(done);
  return bytes;
}

void ignore_write_signals() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace neve::app::output
