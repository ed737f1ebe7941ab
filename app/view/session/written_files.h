#pragma once
/// The files that a run of `neve view` has written, to choose one for download.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace neve::app::view::session {

struct WrittenFile {
  std::filesystem::path path;
  std::string name;  ///< below the folder
  std::uint64_t bytes = 0;
};

/// Plain files in a folder and below, by name; hidden ones and links are left out.
std::vector<WrittenFile> written_files(const std::filesystem::path& folder);

}  // namespace neve::app::view::session
