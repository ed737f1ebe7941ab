#pragma once
/// Files of an earlier run in a folder, removed before another one writes there. The list of them
/// may be anyone's: a file goes only where its bytes say that the run wrote it.

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "app/record/run_json.h"

namespace neve::app::record {

/// True for the name of a file below a folder: no absolute path, nothing that leads out of it, no
/// link on the way.
bool is_below(const std::filesystem::path& folder, const std::filesystem::path& name);

/// True if a file has this hash; false also if it is missing or cannot be read.
bool has_hash(const std::filesystem::path& file, const std::string& hash);

/// True of two names, as people gave them, of one file or folder.
bool is_same_path(const std::string& a, const std::string& b);

/// Names of the files of a list that are below the folder and have the bytes that it gives the hash
/// of: those that remove_listed() would remove.
std::vector<std::string> unchanged_files(const std::filesystem::path& folder,
                                         const FileHashes& files);

/// "8 files, from ply/0000.ply to ply/0007.ply". @param files  at least one
std::string files_text(const std::vector<std::string>& files);

/// Files that export.json or compare.json lists, and those of its `begun` that exist: it was
/// cut off after it had made some of them, and their bytes are all that tells which. These are of
/// the list where they are now. @throws IoError for one that cannot be read
FileHashes files_made(const std::filesystem::path& folder, const Json& list);

/// Files that are in the place of those to come, and that no list there names.
std::vector<std::string> foreign_files(const std::filesystem::path& folder,
                                       const std::set<std::string>& to_come,
                                       const std::set<std::string>& listed);

/// Removes the files of a list that are below the folder and have the bytes that it gives the hash
/// of, and folders that are empty then. @return how many files @throws IoError, also where one
/// cannot be read
std::size_t remove_listed(const std::filesystem::path& folder, const FileHashes& files);

/// Removes what DIR/run.json lists: files with their hashes, and pictures without one that say that
/// they are frames of this run. No run.json, or one that cannot be read: nothing is removed.
/// @return how many files were removed @throws IoError
std::size_t remove_earlier_run(const std::filesystem::path& folder);

}  // namespace neve::app::record
