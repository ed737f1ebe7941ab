#include "app/record/picture_files.h"

#include <sys/stat.h>

#include <algorithm>
#include <climits>
#include <optional>
#include <set>
#include <utility>

#include "app/output/file_hash.h"
#include "app/record/run_json.h"
#include "app/scene/override.h"
#include "app/scene/toml/value.h"
#include "app/support/errors.h"
#include "sim/shapes/held_files.h"
#include "sim/shapes/numbered_files.h"
#include "sim/types/errors.h"

namespace neve::app::record {

namespace {

namespace fs = std::filesystem;

/// Larger files are read by no scene.
constexpr std::uint64_t largest_input = std::uint64_t{1} << 30;
/// Limits on a path: people make no deeper ones, and each part is looked for in each folder.
constexpr std::size_t max_parts = 64, longest_path = 4096;

std::set<std::string> files_of(const scene::Scene& scene) {
  std::set<std::string> files;
  const auto add = [&](const sim::shapes::Shape& shape) {
    if (const auto* mesh = std::get_if<sim::shapes::Mesh>(&shape.form)) files.insert(mesh->file);
    if (const auto* sequence = std::get_if<sim::shapes::MeshSequence>(&shape.form))
      for (const std::string& file : sim::shapes::files_of(*sequence)) files.insert(file);
    if (const auto* points = std::get_if<sim::shapes::Points>(&shape.form))
      files.insert(points->file);
    if (const auto* terrain = std::get_if<sim::shapes::Terrain>(&shape.form))
      files.insert(terrain->file);
  };
  for (const sim::seeding::Body& body : scene.bodies) add(body.shape);
  for (const scene::Collider& collider : scene.colliders) add(collider.shape);
  for (const sim::seeding::Emitter& emitter : scene.emitters) add(emitter.shape);
  for (const sim::seeding::Sink& sink : scene.sinks) add(sink.shape);
  return files;
}

/// The files of a sequence; where its numbers are wrong, their pattern.
void add_numbered(const std::string& pattern, const scene::toml::Table& sequence,
                  std::set<std::string>& files) {
  sim::shapes::MeshSequence numbers{pattern};
  for (const auto& [key, number] : {std::pair{"first", &numbers.first}, {"last", &numbers.last}})
    if (const scene::toml::Entry* entry = sequence.find(key))
      if (const auto* given = std::get_if<std::int64_t>(&entry->value.data))
        *number = static_cast<int>(std::clamp<std::int64_t>(*given, -1, INT_MAX));
  try {
    for (const std::string& file : sim::shapes::files_of(numbers)) files.insert(file);
  } catch (const sim::ShapeError&) {
    files.insert(pattern);
  }
}

/// The files that the value of a change names, as a table or alone.
void add_files(const scene::toml::Value& value, bool is_file, std::set<std::string>& files) {
  if (const auto* text = std::get_if<std::string>(&value.data); text && is_file)
    files.insert(*text);
  if (const auto* list = std::get_if<scene::toml::Array>(&value.data))
    for (const scene::toml::Value& item : *list) add_files(item, is_file, files);
  const auto* table = std::get_if<scene::toml::Table>(&value.data);
  if (!table) return;
  for (const scene::toml::Entry& entry : table->entries) {
    const auto* text = std::get_if<std::string>(&entry.value.data);
    if (entry.key == "files" && text)
      add_numbered(*text, *table, files);
    else
      add_files(entry.value, entry.key == "file", files);
  }
}

std::set<std::string> files_of(const scene::LiveChange& change) {
  const bool is_file = change.address.ends_with(".file") || change.address.ends_with(".files");
  std::set<std::string> files;
  try {
    add_files(scene::value_of({change.address, change.value}, is_file ? "string" : "table"),
              is_file, files);
  } catch (const std::runtime_error&) {
    // The change is refused where it is made.
  }
  return files;
}

/// Hashes each file once, whatever names a picture gives it.
class Contents {
 public:
  /// @throws IoError
  std::string hash_of(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return hash_text(output::hash_file(file));
    const auto [known, is_new] = known_.try_emplace({status.st_dev, status.st_ino});
    if (is_new) known->second = hash_text(output::hash_file(file, largest_input));
    return known->second;
  }
  bool is_content(const fs::path& file, const std::string& hash) {
    try {
      return hash_of(file) == hash;
    } catch (const IoError&) {
      return false;
    }
  }

 private:
  std::map<std::pair<dev_t, ino_t>, std::string> known_;
};

/// Finds the file below a folder by the longest end of its recorded path that exists there with
/// this content. Returns an empty path if there is none.
fs::path file_below(const fs::path& folder, const std::string& recorded, const std::string& hash,
                    Contents& contents) {
  const fs::path path = recorded;
  const std::vector<fs::path> parts(path.begin(), path.end());
  std::error_code error;
  for (std::size_t first = path.is_absolute() ? 1 : 0; first < parts.size(); ++first) {
    fs::path file = folder;
    for (std::size_t k = first; k < parts.size(); ++k) file /= parts[k];
    error.clear();
    if (fs::is_regular_file(file, error) && contents.is_content(file, hash))
      return file.lexically_normal();
  }
  return {};
}

/// Finds a file in the folder of the picture or in one above, as projects move as a whole.
fs::path moved_file(const std::string& recorded, const std::string& hash, const fs::path& picture,
                    Contents& contents) {
  std::error_code error;
  for (fs::path folder = fs::absolute(picture, error).parent_path();;
       folder = folder.parent_path()) {
    if (fs::path file = file_below(folder, recorded, hash, contents); !file.empty()) return file;
    if (folder == folder.parent_path()) return {};
  }
}

/// The name of numbered files, as in "%04d", "####" or "$F4".
bool is_numbered(const std::string& name) {
  return name.find_first_of("%#$") != std::string::npos;
}

std::string folder_of(const std::string& file) {
  return file.substr(0, file.rfind('/') + 1);
}

/// Files that have moved, by the names that they had, and folders that have moved with them.
struct Moves {
  std::map<std::string, std::string> files, folders;

  void add(const std::string& before, const std::string& now) {
    files[before] = now;
    folders[folder_of(before)] = folder_of(now);
  }
  /// Returns the present name of a file, or of the pattern of numbered files in a folder.
  std::string now(const std::string& file) const {
    if (const auto moved = files.find(file); moved != files.end()) return moved->second;
    const std::string name = file.substr(folder_of(file).size());
    const auto moved = folders.find(folder_of(file));
    return moved == folders.end() || !is_numbered(name) ? file : moved->second + name;
  }
};

/// The strings of TOML that neve wrote, each with what it is now, as the TOML writer writes it.
std::string follow(const Moves& moves, const std::string& toml) {
  std::map<std::string, std::string> literal;  // with quotes, before and now
  for (const auto& [before, now] : moves.files)
    literal[scene::toml::toml_string(before)] = scene::toml::toml_string(now);
  const auto inner = [](const std::string& folder) {
    std::string text = scene::toml::toml_string(folder);
    text.pop_back();
    return text;
  };
  std::map<std::string, std::string> folders;
  for (const auto& [before, now] : moves.folders) folders[inner(before)] = inner(now);
  std::string text;
  for (std::size_t at = 0; at < toml.size();) {
    const std::size_t begin = std::min(toml.find('"', at), toml.size());
    text.append(toml, at, begin - at);
    std::size_t end = begin + 1;
    while (end < toml.size() && toml[end] != '"') end += toml[end] == '\\' ? 2 : 1;
    at = std::min(end + 1, toml.size());
    const std::string string = toml.substr(std::min(begin, toml.size()), at - begin);
    const std::string folder = folder_of(string);
    if (const auto moved = literal.find(string); moved != literal.end())
      text += moved->second;
    else if (const auto around = folders.find(folder);
             around != folders.end() && is_numbered(string.substr(folder.size())))
      text += around->second + string.substr(folder.size());
    else
      text += string;
  }
  return text;
}

[[noreturn]] void refuse(const std::string& place, const std::string& what,
                         const std::string& advice) {
  throw Error(exit_invalid_scene, place + ": error: " + what, place, advice);
}

void check_length(const fs::path& picture, const std::string& recorded) {
  const fs::path path = recorded;
  const auto parts = static_cast<std::size_t>(std::distance(path.begin(), path.end()));
  if (recorded.size() > longest_path || parts > max_parts)
    refuse(picture.string(),
           "names a file of " + std::to_string(parts) + " parts; at most " +
               std::to_string(max_parts) + " are looked for",
           "the picture was not made by neve");
}

/// Finds a file in the folder of the picture, or below it.
fs::path file_inside(const std::string& recorded, const std::string& hash, const fs::path& picture,
                     Contents& contents) {
  std::error_code error;
  return file_below(fs::absolute(picture, error).parent_path(), recorded, hash, contents);
}

/// Returns the present place of a file of the picture.
fs::path found_file(const fs::path& picture, const std::string& recorded, const std::string& hash,
                    Contents& contents) {
  const fs::path path = recorded;
  std::error_code error;
  const bool is_in_place = path.is_absolute() && fs::exists(path, error);
  if (!is_in_place && !contents.is_content(path, hash)) {
    fs::path moved = moved_file(recorded, hash, picture, contents);
    if (!moved.empty()) return moved;
  }
  std::string now;
  try {
    now = contents.hash_of(path);
  } catch (const IoError& failure) {
    throw IoError(failure.what(), recorded,
                  "the picture was made with this file: put it back, or beside the picture");
  }
  if (now != hash)
    refuse(recorded, "has changed since the picture was made; the picture used " + hash,
           "restore the old file, or render the scene file instead");
  return path;
}

}  // namespace

std::map<std::string, std::string> hash_files(const scene::Scene& scene,
                                              const std::vector<scene::LiveChange>& changes) {
  std::map<std::string, std::string> files;
  const auto add = [&](const std::string& file) {
    // The hash is of what the run has read.
    sim::shapes::require_unchanged(file);
    files[file] = hash_text(output::hash_file(file));
    sim::shapes::require_unchanged(file);
  };
  for (const std::string& file : files_of(scene)) add(file);
  for (const scene::LiveChange& change : changes)
    for (const std::string& file : files_of(change)) try {
        add(file);
      } catch (const IoError&) {
        // The change was refused, or its file is gone: the picture cannot be made again.
      }
  return files;
}

std::string file_lines(const scene::Scene& scene, const std::vector<scene::LiveChange>& changes) {
  std::string text;
  for (const auto& [file, hash] : hash_files(scene, changes)) text += "\n" + file + " " + hash;
  return text;
}

void find_files(const fs::path& picture, PictureRecord& record,
                const std::function<void(const std::vector<std::string>&)>& allow) {
  std::map<std::string, std::string> files;
  Contents contents;
  Moves moves;
  std::vector<std::string> outside;
  const auto add = [&](const std::string& recorded, const std::string& now) {
    files[now] = record.files.at(recorded);
    if (now != recorded) moves.add(recorded, now);
  };
  for (const auto& [recorded, hash] : record.files) {
    check_length(picture, recorded);
    const fs::path inside = file_inside(recorded, hash, picture, contents);
    if (inside.empty())
      outside.push_back(recorded);
    else
      add(recorded, inside.string());
  }
  if (!outside.empty()) allow(outside);
  for (const std::string& recorded : outside)
    add(recorded, found_file(picture, recorded, record.files.at(recorded), contents).string());
  record.files = std::move(files);
  if (moves.files.empty()) return;
  record.scene = follow(moves, record.scene);
  for (std::string& change : record.overrides) change = follow(moves, change);
  for (scene::LiveChange& change : record.changes) change.value = follow(moves, change.value);
  record.plate = moves.now(record.plate);
  record.lut = moves.now(record.lut);
}

void require_listed(const PictureRecord& record, const std::string& file,
                    const std::string& picture) {
  if (record.files.contains(file)) return;
  refuse(picture, "its scene reads " + file + ", of which it has no hash",
         "a picture reads only files that it was made with; render the scene file instead, or name "
         "the file yourself with --set or --plate");
}

void require_listed(const PictureRecord& record, const scene::Scene& scene,
                    const std::string& picture) {
  for (const std::string& file : files_of(scene)) require_listed(record, file, picture);
  for (const scene::LiveChange& change : record.changes)
    for (const std::string& file : files_of(change)) require_listed(record, file, picture);
}

}  // namespace neve::app::record
