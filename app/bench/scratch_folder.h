#pragma once
/// A folder for temporary files.

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "app/support/errors.h"

namespace neve::app::bench {

class ScratchFolder {
 public:
  /// @throws IoError
  ScratchFolder() {
    std::string path = (std::filesystem::temp_directory_path() / "neve-bench-XXXXXX").string();
    if (!::mkdtemp(path.data())) throw IoError("cannot make the folder " + path, path);
    path_ = path;
  }
  ~ScratchFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace neve::app::bench
