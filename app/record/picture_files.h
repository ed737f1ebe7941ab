#pragma once
/// Files that a picture was made with: found where they are now, and no other file is read.

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "app/record/picture_record.h"
#include "app/scene/scene.h"

namespace neve::app::record {

/// The files that a scene and its changes name, each with the hash of its content.
/// @throws IoError
std::map<std::string, std::string> hash_files(const scene::Scene& scene,
                                              const std::vector<scene::LiveChange>& changes = {});

/// A line for each of these files, for hashes of what depends on them. @throws IoError
std::string file_lines(const scene::Scene& scene,
                       const std::vector<scene::LiveChange>& changes = {});

/// Looks for the files of a picture. Those that are no longer where they were are found in the
/// folder of the picture and those above, by the end of their path and their content: a project
/// that was moved draws its pictures again. The record then has their places of today.
/// @param allow  is called with the names of files that are not in the folder of the picture,
/// before
///               another place is read
/// @throws Error naming the first file that is missing or has changed since the picture was made
void find_files(const std::filesystem::path& picture, PictureRecord& record,
                const std::function<void(const std::vector<std::string>&)>& allow);

/// The scene of a picture may come from anyone: it, its changes and its look read only files of
/// whose content the picture knows the hash. @throws Error naming another one
void require_listed(const PictureRecord& record, const std::string& file,
                    const std::string& picture);
void require_listed(const PictureRecord& record, const scene::Scene& scene,
                    const std::string& picture);

}  // namespace neve::app::record
