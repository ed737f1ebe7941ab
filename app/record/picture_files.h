#pragma once
/// Files that a picture was made with: found where they are now, and no other file is read.

#include <filesystem>
#include <map>
#include <string>

#include "app/record/picture_record.h"
#include "app/scene/scene.h"

namespace neve::app::record {

/// The files that a scene names, each with the hash of its content. @throws IoError
std::map<std::string, std::string> hash_files(const scene::Scene& scene);

/// Looks for the files of a picture. Those that are no longer where they were are found in the
/// folder of the picture and those above, by the end of their path and their content: a project
/// that was moved draws its pictures again. The record then has their places of today.
/// @throws Error naming the first file that is missing or has changed since the picture was made
void find_files(const std::filesystem::path& picture, PictureRecord& record);

/// The scene of a picture may come from anyone: it reads only files of whose content the picture
/// knows the hash. @throws Error naming another one
void require_listed(const PictureRecord& record, const std::string& file,
                    const std::string& picture);
void require_listed(const PictureRecord& record, const scene::Scene& scene,
                    const std::string& picture);

}  // namespace neve::app::record
