#pragma once
/// The one way this program writes files: a reader sees the old file or the whole new one.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "app/support/errors.h"

namespace neve::app::output {

/// Durability of written bytes: synced bytes survive a power cut after the call returns.
enum class Durability { cached, synced };

/// Writes a temporary file in the same folder, then renames it. The program chooses these names: a
/// link, device or folder of that name is refused.
/// @throws IoError with path, bytes and the system's reason; nothing is left behind
void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes,
                Durability durability = Durability::cached);
void write_file(const std::filesystem::path& path, std::string_view text,
                Durability durability = Durability::cached);

/// The same, into a folder where a person has other files: temporary ones that killed programs left
/// there go first. @throws IoError
void write_among_others(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void write_among_others(const std::filesystem::path& path, std::string_view text);

struct FileToWrite {
  std::filesystem::path path;
  std::span<const std::uint8_t> bytes;
};
/// The same of files that belong together: all are whole before the first has its name, so that a
/// full disk leaves none of them, or the earlier ones. @throws IoError
void write_together(const std::vector<FileToWrite>& files);

/// Sets up a temporary file before it replaces another one. @return 0 or errno
using Prepare = std::function<int(int fd)>;

/// Writes as write_file() does, but does not refuse a link or a device of that name.
void replace_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes,
                  Durability durability, const Prepare& prepare = {});

/// Puts a file that was written under its temporary name in place; the temporary file is gone in
/// any case. @throws IoError, also where a link, device or folder has the name
void move_into_place(const std::filesystem::path& temporary, const std::filesystem::path& path);

/// Creates a folder and those above it; "", the one of a bare name, is there. @throws IoError
void make_folder(const std::filesystem::path& path);

/// The same of a folder whose name the program chooses, inside one that a person named: a link in
/// its place is refused, as for files.
void make_own_folder(const std::filesystem::path& path);

/// These bring the bytes of files, and the list of files in a folder, to the disk: both survive a
/// power cut afterwards.
/// Many files at once take little longer than one. @throws IoError
void sync_files(const std::vector<std::filesystem::path>& files);
void sync_folder(const std::filesystem::path& folder);

/// The whole of a regular file. @throws IoError, also when it is larger than `limit` bytes;
/// UnreadableError when the file exists and cannot be read
std::vector<std::uint8_t> read_file(const std::filesystem::path& path,
                                    std::uint64_t limit = std::uint64_t{1} << 30);

/// Full disks and closed pipes then come back as errors of write() instead of killing the process.
void ignore_write_signals();

/// Writes a file that the user names, which may be anything: a link, pipe, device, file of another.
/// Follows links. A regular file is replaced as a whole and keeps owner, mode and access list; one
/// with several names (hard links) or of another owner is written in place, once there is room for
/// all of it. Pipes, terminals and other character devices are written in place.
/// @throws IoError, also for folders, sockets and block devices
void write_named_file(const std::filesystem::path& path, std::string_view text);

}  // namespace neve::app::output
