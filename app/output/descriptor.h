#pragma once
/// Open files of the system, for the writers of this folder.

#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>

namespace neve::app::output {

/// Owns a descriptor until it is closed on purpose.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(Descriptor&& other) noexcept : fd_(other.fd_) { other.fd_ = -1; }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
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

/// 0 or errno.
int write_all(int fd, std::span<const std::uint8_t> bytes);

/// @throws IoError with the path, the sentence, the system's reason and advice
[[noreturn]] void fail_writing(const std::filesystem::path& path, const std::string& sentence,
                               int reason);

}  // namespace neve::app::output
