#pragma once
/// Names of files that are not finished: `.NAME.HOST.PROCESS.START.RANDOM.tmp`, beside the file
/// itself.

#include <filesystem>

namespace neve::app::output {

/// Another name at every call, also on machines that share the folder.
std::filesystem::path temporary_name(const std::filesystem::path& path);

/// Removes what processes that have ended left in a folder: those of this machine at once, those of
/// others after a day. Other files stay.
void remove_abandoned(const std::filesystem::path& folder);
/// The same in the folders that it has, too; not through links.
void remove_abandoned_below(const std::filesystem::path& folder);

}  // namespace neve::app::output
