#pragma once
/// Files that the user names, which may be anything: links, pipes, devices, files of others.

#include <filesystem>
#include <string_view>

namespace neve::app::output {

/// Follows links. A regular file is replaced as a whole and keeps owner, mode and access list; one
/// with several names (hard links) or of another owner is written in place, once there is room for
/// all of it. Pipes, terminals and other character devices are written in place.
/// @throws IoError, also for folders, sockets and block devices
void write_named_file(const std::filesystem::path& path, std::string_view text);

}  // namespace neve::app::output
