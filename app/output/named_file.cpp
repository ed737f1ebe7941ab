#include "app/output/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <optional>
#include <string>
#include <system_error>

#include "app/output/descriptor.h"
#include "app/output/temporary.h"
#include "app/support/text.h"

namespace neve::app::output {

namespace {

namespace fs = std::filesystem;

using Bytes = std::span<const std::uint8_t>;

constexpr int max_links = 40;
constexpr const char* access_list = "system.posix_acl_access";

struct Target {
  fs::path path;
  std::optional<int> descriptor;  ///< of a link to an open file of this process, as /dev/stdout
};

/// N of /proc/self/fd/N: its link names a pipe or a file that may have another name by now.
std::optional<int> open_file_named(const fs::path& path) {
  if (path.parent_path() != fs::path("/proc") / std::to_string(::getpid()) / "fd")
    return std::nullopt;
  return number_of<int>(path.filename().string());
}

/// Finds the file to which the links of a path lead; it need not exist.
Target follow_links(fs::path path) {
  for (int links = 0; links < max_links; ++links) {
    std::error_code error;
    const fs::path folder = fs::canonical(path.has_parent_path() ? path.parent_path() : ".", error);
    if (error) return {path, std::nullopt};
    path = folder / path.filename();
    if (const std::optional<int> fd = open_file_named(path)) return {path, fd};
    if (!fs::is_symlink(path, error)) return {path, std::nullopt};
    const fs::path next = fs::read_symlink(path, error);
    if (error) fail_writing(path, "cannot follow the link", error.value());
    path = folder / next;
  }
  fail_writing(path, "cannot follow the link", ELOOP);
}

void write_into(const fs::path& path, int fd, Bytes bytes) {
  if (const int reason = write_all(fd, bytes); reason != 0)
    fail_writing(path, "cannot write " + std::to_string(bytes.size()) + " bytes", reason);
}

void write_to_device(const fs::path& path, Bytes bytes) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY));
  if (file.get() < 0) fail_writing(path, "cannot open", errno);
  write_into(path, file.get(), bytes);
  if (const int reason = file.close(); reason != 0) fail_writing(path, "cannot write", reason);
}

/// Keeps the file and with it all its names. Nothing is lost when there is no room: that is asked
/// for first.
void write_in_place(const fs::path& path, Bytes bytes) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW));
  if (file.get() < 0) fail_writing(path, "cannot open", errno);
  const auto size = static_cast<off_t>(bytes.size());
  if (size > 0 && ::fallocate(file.get(), FALLOC_FL_KEEP_SIZE, 0, size) != 0 &&
      errno != EOPNOTSUPP && errno != ENOSYS)
    fail_writing(path, "cannot write " + std::to_string(bytes.size()) + " bytes", errno);
  write_into(path, file.get(), bytes);
  int reason = ::ftruncate(file.get(), size) == 0 && ::fsync(file.get()) == 0 ? 0 : errno;
  const int close_reason = file.close();
  if (reason == 0) reason = close_reason;
  if (reason != 0) fail_writing(path, "cannot write", reason);
}

/// Gives a new file the owner, the mode and the access list of another one. @return 0 or errno
int take_over(const fs::path& other, const struct stat& status, int fd) {
  if (::fchown(fd, status.st_uid, status.st_gid) != 0) return errno;
  if (::fchmod(fd, status.st_mode & 07777) != 0) return errno;
  std::array<char, 4096> list;
  const ssize_t size = ::getxattr(other.c_str(), access_list, list.data(), list.size());
  if (size > 0 && ::fsetxattr(fd, access_list, list.data(), static_cast<std::size_t>(size), 0) != 0)
    return errno;
  return 0;
}

/// Whether a file of ours can take its place: only root gives files to others.
bool is_replaceable(const struct stat& status) {
  const bool is_ours = status.st_uid == ::geteuid() && status.st_gid == ::getegid();
  return status.st_nlink == 1 && (is_ours || ::geteuid() == 0);
}

}  // namespace

void write_named_file(const fs::path& path, std::string_view text) {
  const Bytes bytes{reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
  const Target target = follow_links(path);
  if (target.descriptor) return write_into(path, *target.descriptor, bytes);
  struct stat status {};
  remove_abandoned(target.path.parent_path());
  if (::stat(target.path.c_str(), &status) != 0)
    return replace_file(target.path, bytes, Durability::synced);
  if (S_ISCHR(status.st_mode) || S_ISFIFO(status.st_mode))
    return write_to_device(target.path, bytes);
  if (!S_ISREG(status.st_mode))
    throw IoError(path.string() + ": cannot write here: not a file, pipe or terminal",
                  path.string(), "name a file");
  if (!is_replaceable(status)) return write_in_place(target.path, bytes);
  replace_file(target.path, bytes, Durability::synced,
               [&](int fd) { return take_over(target.path, status, fd); });
}

}  // namespace neve::app::output
