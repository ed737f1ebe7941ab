#include "app/output/file_hash.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "app/output/atomic_file.h"
#include "app/output/descriptor.h"
#include "app/support/errors.h"
#include "sim/base/hash.h"

namespace neve::app::output {

WrittenFile write_hashed(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  write_file(file, bytes);
  return {file, hash_bytes(bytes.data(), bytes.size())};
}

WrittenFile write_hashed(const std::filesystem::path& file, std::string_view text) {
  write_file(file, text);
  return {file, hash_bytes(text.data(), text.size())};
}

std::uint64_t hash_file(const std::filesystem::path& path, std::uint64_t limit) {
  const auto fail_reading = [&](const std::string& reason) -> std::uint64_t {
    throw IoError(path.string() + ": cannot read: " + reason, path.string());
  };
  struct stat status {};
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0 || ::fstat(file.get(), &status) != 0) fail_reading(std::strerror(errno));
  if (!S_ISREG(status.st_mode)) fail_reading("not a regular file");
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size > limit) fail_reading("larger than " + std::to_string(limit) + " bytes");
  std::vector<std::uint8_t> block(std::size_t{1} << 18);
  std::uint64_t hash = hash_bytes(nullptr, 0), done = 0;
  // Files of the kernel have no size and no end.
  while (done <= size) {
    const ssize_t count = ::read(file.get(), block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail_reading(std::strerror(errno));
    if (count == 0) return hash;
    hash = hash_bytes(block.data(), static_cast<std::size_t>(count), hash);
    done += static_cast<std::uint64_t>(count);
  }
  return fail_reading("holds more than its size");
}

}  // namespace neve::app::output
