#include "app/record/earlier.h"

#include <fmt/core.h>

#include <algorithm>
#include <system_error>

#include "app/output/descriptor.h"
#include "app/output/file_hash.h"
#include "app/record/verify.h"
#include "app/support/errors.h"

namespace neve::app::record {

namespace {

namespace fs = std::filesystem;

void remove_file(const fs::path& folder, const fs::path& name) {
  std::error_code error;
  if (!fs::remove(folder / name, error) && error)
    output::fail_writing(folder / name, "cannot remove what an earlier run made", error.value());
  // Succeeds only when nothing else is left in it.
  if (name.has_parent_path()) fs::remove(folder / name.parent_path(), error);
}

}  // namespace

bool has_hash(const fs::path& file, const std::string& hash) {
  try {
    return hash_text(output::hash_file(file)) == hash;
  } catch (const IoError&) {
    return false;
  }
}

bool is_below(const fs::path& folder, const fs::path& name) {
  fs::path at = folder;
  std::error_code error;
  for (const fs::path& part : name) {
    const std::string text = part.string();
    if (text.empty() || text == "." || text == ".." || text == "/") return false;
    at /= part;
    if (fs::is_symlink(fs::symlink_status(at, error))) return false;
  }
  return !name.empty() && fs::is_regular_file(fs::symlink_status(at, error));
}

bool is_same_path(const std::string& a, const std::string& b) {
  std::error_code error;
  return a == b || fs::equivalent(a, b, error);
}

std::vector<std::string> unchanged_files(const fs::path& folder, const FileHashes& files) {
  std::vector<std::string> names;
  for (const auto& [name, hash] : files)
    if (is_below(folder, name) && has_hash(folder / name, hash)) names.push_back(name);
  return names;
}

std::string files_text(const std::vector<std::string>& files) {
  if (files.size() == 1) return files.front();
  return fmt::format("{} files, from {} to {}", files.size(), files.front(), files.back());
}

FileHashes files_made(const fs::path& folder, const Json& list) {
  FileHashes files = file_hashes(list);
  const Json begun = list.is_object() ? list.value("begun", Json()) : Json();
  if (!begun.is_array()) return files;
  for (const Json& entry : begun) {
    const std::string name = entry.is_string() ? entry.get<std::string>() : "";
    if (!files.contains(name) && is_below(folder, name))
      files[name] = hash_text(output::hash_file(folder / name));
  }
  return files;
}

std::vector<std::string> foreign_files(const fs::path& folder, const std::set<std::string>& to_come,
                                       const std::set<std::string>& listed) {
  std::vector<std::string> files;
  std::error_code error;
  for (const std::string& name : to_come)
    if (!listed.contains(name) && fs::is_regular_file(fs::symlink_status(folder / name, error)))
      files.push_back(name);
  return files;
}

std::size_t remove_listed(const fs::path& folder, const FileHashes& files) {
  std::size_t removed = 0;
  for (const auto& [name, hash] : files) {
    if (!is_below(folder, name)) continue;
    // Fails where it cannot be read: it would lie beside the files of another run.
    if (hash_text(output::hash_file(folder / name)) != hash) continue;
    remove_file(folder, name);
    ++removed;
  }
  return removed;
}

std::size_t remove_earlier_run(const fs::path& folder) {
  const Json run = read_run_json(folder);
  const FileHashes files = file_hashes(run);
  std::size_t removed = remove_listed(folder, files);
  const std::optional<Pictures> pictures = listed_pictures(run);
  if (!pictures) return removed;
  // The last ones before a kill, and those of earlier versions.
  const auto remove = [&](const std::string& view, const std::string& name,
                          const FrameRecord& frame) {
    if (files.contains(name) || !is_below(folder, name) ||
        !is_picture_of(folder / name, view, frame))
      return;
    remove_file(folder, name);
    ++removed;
  };
  for_each_picture(*pictures, remove);
  return removed;
}

}  // namespace neve::app::record
