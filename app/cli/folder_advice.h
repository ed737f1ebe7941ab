#pragma once
/// Advice for folders and files that a command cannot use: what they are, what to name instead.

#include <filesystem>
#include <string>

namespace neve::app::cli {

struct FolderAdvice {
  std::string what;  ///< "is the folder of a sweep, not of a run"
  std::string hint;
};

/// About a folder without run.json.
FolderAdvice advice_on_folder(const std::filesystem::path& folder);

/// Refuses a regular file that is no picture, with advice by its suffix.
/// @param command  "neve compare"
/// @throws Error
void require_picture(const std::filesystem::path& file, const std::string& command);

}  // namespace neve::app::cli
