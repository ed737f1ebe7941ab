#include "app/output/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>
#include <system_error>

namespace neve::app::output {

namespace {

/// Owns a descriptor until it is closed on purpose.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

  /// 0 or errno. Network file systems report a full disk only here.
  int close() {
    const int fd = fd_;
    fd_ = -1;
    return ::close(fd) == 0 || errno == EINTR ? 0 : errno;
  }

 private:
  int fd_;
};

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what, int reason) {
  const char* hint = reason == ENOSPC || reason == EDQUOT || reason == EFBIG
                         ? "make room there, or choose another folder with --out"
                         : "choose another folder with --out";
  throw IoError(path.string() + ": " + what + ": " + std::strerror(reason), path.string(), hint);
}

/// 0 or errno.
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

int open_temporary(const std::filesystem::path& temporary) {
  const int flags = O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC;
  const int fd = ::open(temporary.c_str(), flags, 0666);
  if (fd >= 0 || errno != EEXIST) return fd;
  // Ours by its process number: left by a process that had the same number and was killed.
  ::unlink(temporary.c_str());
  return ::open(temporary.c_str(), flags, 0666);
}

}  // namespace

void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes,
                Durability durability) {
  const std::filesystem::path temporary = temporary_name(path);
  Descriptor file(open_temporary(temporary));
  if (file.get() < 0) fail(path, "cannot create", errno);

  int reason = write_all(file.get(), bytes);
  if (reason == 0 && durability == Durability::synced && ::fsync(file.get()) != 0) reason = errno;
  const int close_reason = file.close();
  if (reason == 0) reason = close_reason;
  if (reason != 0) {
    ::unlink(temporary.c_str());
    fail(path, "cannot write " + std::to_string(bytes.size()) + " bytes", reason);
  }
  move_into_place(temporary, path);
}

void write_file(const std::filesystem::path& path, std::string_view text, Durability durability) {
  write_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, durability);
}

std::filesystem::path temporary_name(const std::filesystem::path& path) {
  std::string name(1, '.');
  name += path.filename().string();
  name += '.';
  name += std::to_string(::getpid());
  name += ".tmp";
  return path.parent_path() / name;
}

void move_into_place(const std::filesystem::path& temporary, const std::filesystem::path& path) {
  if (std::rename(temporary.c_str(), path.c_str()) == 0) return;
  const int reason = errno;
  ::unlink(temporary.c_str());
  fail(path, "cannot rename the finished file", reason);
}

void make_folder(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) fail(path, "cannot create the folder", error.value());
}

std::vector<std::uint8_t> read_file(const std::filesystem::path& path, std::uint64_t limit) {
  const auto fail_reading = [&](const std::string& reason) {
    throw IoError(path.string() + ": cannot read: " + reason, path.string());
  };
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) fail_reading(std::strerror(errno));
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) fail_reading(std::strerror(errno));
  if (!S_ISREG(status.st_mode)) fail_reading("not a regular file");
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size > limit) fail_reading("larger than " + std::to_string(limit) + " bytes");

  std::vector<std::uint8_t> bytes(size);
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::read(file.get(), bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail_reading(std::strerror(errno));
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
