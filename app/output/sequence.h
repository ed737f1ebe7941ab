#pragma once
/// The layout of an output folder.

#include <filesystem>
#include <string>

#include "app/output/movie_format.h"

namespace neve::app::output {

/// Name of the slice through the culprit of a diverged run, next to the pictures of its views.
inline constexpr const char* culprit_view = "culprit_slice";

/// Folder of the geometry that a run writes beside its pictures.
inline constexpr const char* exports_folder = "exports";

/// Largest number of a frame that a file may name.
inline constexpr int max_frame = 99'999'999;

/// [A-Za-z0-9_-]+: safe as the name of a folder.
bool is_plain_name(const std::string& name);

/// DIR/<view>/0024.png; -008.png of a frame before 0, as printf names it
std::filesystem::path frame_path(const std::filesystem::path& folder, const std::string& view,
                                 int number);
/// DIR/<view>/0024.exr
std::filesystem::path channels_path(const std::filesystem::path& folder, const std::string& view,
                                    int number);
/// DIR/<view>.mp4, or with another suffix
std::filesystem::path movie_path(const std::filesystem::path& folder, const std::string& view,
                                 MovieFormat format);
/// DIR/diverged_<view>.png
std::filesystem::path diverged_path(const std::filesystem::path& folder, const std::string& view);
std::filesystem::path incident_path(const std::filesystem::path& folder);
std::filesystem::path run_json_path(const std::filesystem::path& folder);
/// DIR/NAME.png, or DIR/NAME_2.png and so on where a file or folder is called so already.
/// @param suffix  ".png"; "" for a folder
std::filesystem::path free_path(const std::filesystem::path& folder, const std::string& name,
                                const std::string& suffix);
/// The list of the files that `neve export` wrote into a folder.
std::filesystem::path export_list_path(const std::filesystem::path& folder);
/// The list of the files that `neve compare` wrote into a folder.
std::filesystem::path comparison_list_path(const std::filesystem::path& folder);

}  // namespace neve::app::output
