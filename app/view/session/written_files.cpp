#include "app/view/session/written_files.h"

#include <algorithm>
#include <system_error>

namespace neve::app::view::session {

namespace {

namespace fs = std::filesystem;

/// A list of more is of no use to choose from.
constexpr std::size_t max_files = 5000;

bool is_hidden(const fs::path& path) {
  return path.filename().string().starts_with('.');
}

}  // namespace

std::vector<WrittenFile> written_files(const fs::path& folder) {
  std::vector<WrittenFile> files;
  std::error_code error;
  fs::recursive_directory_iterator at(folder, error), end;
  for (; !error && at != end && files.size() < max_files; at.increment(error)) {
    if (is_hidden(at->path())) {
      at.disable_recursion_pending();
      continue;
    }
    std::error_code gone;
    if (!fs::is_regular_file(at->symlink_status(gone)) || gone) continue;
    const std::uint64_t bytes = at->file_size(gone);
    if (!gone) files.push_back({at->path(), at->path().lexically_relative(folder).string(), bytes});
  }
  std::sort(files.begin(), files.end(),
            [](const WrittenFile& a, const WrittenFile& b) { return a.name < b.name; });
  return files;
}

}  // namespace neve::app::view::session
