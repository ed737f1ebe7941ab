#pragma once
/// Hashes of files, by which a run knows what it wrote.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace neve::app::output {

/// A written file, with the hash of its bytes.
struct WrittenFile {
  std::filesystem::path file;
  std::uint64_t hash = 0;
};

/// Writes it as write_file does. @throws IoError
WrittenFile write_hashed(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);
WrittenFile write_hashed(const std::filesystem::path& file, std::string_view text);

/// Hashes the bytes of a regular file. @throws IoError, also when it is larger than `limit` bytes
std::uint64_t hash_file(const std::filesystem::path& file, std::uint64_t limit = UINT64_MAX);

}  // namespace neve::app::output
