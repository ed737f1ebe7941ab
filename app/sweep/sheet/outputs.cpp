#include "app/sweep/sheet/outputs.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include "app/output/movie_format.h"
#include "app/output/sequence.h"
#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::sweep::sheet {

namespace {

namespace fs = std::filesystem;

/// "sheet", and "sheet_2" of a further page.
bool is_page(const std::string& stem, const std::string& name) {
  if (stem == name) return true;
  if (!stem.starts_with(name + "_")) return false;
  const auto number = number_of<int>(stem.substr(name.size() + 1));
  return number && *number >= 2;
}

bool is_movie(const fs::path& file) {
  return std::ranges::any_of(output::all_movie_formats, [&](output::MovieFormat format) {
    return file.extension() == output::info_of(format).suffix;
  });
}

/// A copy, as entries are removed while they are looked at.
std::vector<fs::directory_entry> entries_of(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::directory_entry> entries;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    entries.push_back(entry);
  return entries;
}

}  // namespace

void remove_result(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error)
    throw IoError(file.string() + ": cannot be removed: " + error.message(), file.string(),
                  "remove it, and neve sweep collect makes the results");
}

void Outputs::remove_unless_written(const fs::path& file) const {
  if (!written_.contains(file.lexically_normal())) remove_result(file);
}

void Outputs::remove_frames(const fs::path& frames) const {
  for (const fs::directory_entry& entry : entries_of(frames)) {
    const fs::path file = entry.path();
    const auto number = number_of<int>(file.stem().string());
    if (number && file == output::frame_path(folder_, frames.filename().string(), *number))
      remove_unless_written(file);
  }
  std::error_code error;
  if (fs::is_empty(frames, error) && !error) remove_result(frames);
}

void Outputs::remove_others() const {
  for (const fs::directory_entry& entry : entries_of(folder_)) {
    const fs::path& file = entry.path();
    const std::string stem = file.stem().string();
    const bool is_sheet = is_page(stem, "sheet");
    if (entry.is_symlink()) continue;
    if (entry.is_directory()) {
      if (is_sheet && !file.has_extension()) remove_frames(file);
    } else if (file.extension() == ".png" ? is_sheet || is_page(stem, "strips")
                                          : is_sheet && is_movie(file)) {
      remove_unless_written(file);
    }
  }
}

}  // namespace neve::app::sweep::sheet
