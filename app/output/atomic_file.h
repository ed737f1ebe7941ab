#pragma once
/// The one way this program writes files: a reader sees the old file or the whole new one.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "app/support/errors.h"

namespace neve::app::output {

/// Durability of written bytes: synced bytes survive a power cut after the call returns.
enum class Durability { cached, synced };

/// Writes to `.name.PID.tmp` in the same folder, then renames.
/// @throws IoError with path, bytes and the system's reason; nothing is left behind
void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes,
                Durability durability = Durability::cached);
void write_file(const std::filesystem::path& path, std::string_view text,
                Durability durability = Durability::cached);

/// The temporary name that belongs to a path, for programs that write it for us.
std::filesystem::path temporary_name(const std::filesystem::path& path);

/// Puts a file that was written under its temporary name in place. @throws IoError
void move_into_place(const std::filesystem::path& temporary, const std::filesystem::path& path);

/// Creates a folder and those above it. @throws IoError
void make_folder(const std::filesystem::path& path);

/// The whole of a regular file. @throws IoError, also when it is larger than `limit` bytes
std::vector<std::uint8_t> read_file(const std::filesystem::path& path,
                                    std::uint64_t limit = std::uint64_t{1} << 30);

/// Full disks and closed pipes then come back as errors of write() instead of killing the process.
void ignore_write_signals();

}  // namespace neve::app::output
