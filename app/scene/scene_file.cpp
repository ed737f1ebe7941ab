#include "app/scene/scene_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <vector>

#include "app/advice/suggest.h"
#include "app/scene/toml/error.h"
#include "app/scene/toml/toml_text.h"
#include "app/scene/toml/value.h"
#include "app/support/errors.h"
#include "app/support/machine.h"
#include "app/support/out_folder.h"
#include "app/support/text.h"

namespace neve::app::scene {

namespace {

namespace fs = std::filesystem;

constexpr const char* standard_input = "/dev/stdin";

/// "63" of /dev/fd/63, the name of a `<(command)`.
bool is_open_file(const fs::path& file) {
  const fs::path folder = file.parent_path();
  return folder == "/dev/fd" || folder == "/proc/self/fd";
}

/// True for a stream, whatever is behind it: `< FILE` makes a file of standard input.
bool is_stream(const std::string& file) {
  return file == standard_input || is_open_file(file);
}

/// The scene in a folder whose name is nearest; empty: none is near.
fs::path nearest_scene(const fs::path& folder, const std::string& stem) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (at->path().extension() == ".toml" && names.size() < 10'000)
      names.push_back(at->path().stem().string());
  std::sort(names.begin(), names.end());
  const std::string nearest = advice::nearest_name(stem, names);
  return nearest.empty() ? fs::path() : folder / (nearest + ".toml");
}

/// The folder of the scenes that came with the program; empty where they are gone.
fs::path own_scenes() {
  try {
    return default_scene().parent_path();
  } catch (const std::exception&) {
    return {};
  }
}

/// Returns a path as a person would type it here: relative for a file below this folder.
std::string typed(const fs::path& file) {
  std::error_code error;
  const fs::path near = fs::relative(file, error);
  const bool is_below = !error && !near.empty() && *near.begin() != "..";
  return (is_below ? near : file).string();
}

/// Advice for a missing file: a similar name in its folder, in scenes/ or among the examples, or
/// the missing folder.
std::string nearest_file(const std::string& file) {
  const fs::path wanted(file);
  const fs::path folder = wanted.has_parent_path() ? wanted.parent_path() : fs::path(".");
  std::error_code error;
  if (fs::exists(wanted, error)) return "";
  if (const std::string kind = kind_of_no_file(wanted); !kind.empty()) return "it is " + kind;
  for (const fs::path& place : {folder, fs::path("scenes"), own_scenes()}) {
    if (place.empty()) continue;
    const fs::path nearest = nearest_scene(place, wanted.stem().string());
    if (!nearest.empty()) return advice::did_you_mean(typed(nearest));
  }
  if (file.find("://") != std::string::npos) return "download the file, and name it";
  if (!fs::is_directory(folder, error)) return "there is no folder " + folder.string();
  return "neve new NAME writes a first scene";
}

/// The parser's words on the first line of a YAML file help nobody.
void refuse_other_languages(const std::string& file) {
  const std::string suffix = lower_text(fs::path(file).extension().string());
  const bool is_result = fs::path(file).filename() == "run.json";
  for (const char* other : {".json", ".yaml", ".yml", ".xml", ".py", ".ini", ".usd", ".usda",
                            ".abc", ".hip", ".blend", ".obj", ".ply", ".stl", ".mp4", ".npz"})
    if (suffix == other)
      throw toml::SceneError(
          file, 0, 0, "is not a scene: scenes are TOML files",
          is_result          ? "name the folder of the run, or one of its pictures"
          : suffix == ".mp4" ? "those of a movie are in the folder of its run: name that, or a "
                               "picture in it"
          : suffix == ".obj" || suffix == ".ply" || suffix == ".stl"
              ? "a scene names the mesh: shape = { mesh = { file = " +
                    toml::toml_string(fs::path(file).filename().string()) + " } }"
              : "neve new NAME writes a first scene");
}

/// A pipe with a name in a folder has no writer until somebody comes. Those of `<(command)`, which
/// have none, are read.
void refuse_waiting_pipe(const std::string& file) {
  std::error_code no_pipe, no_name;
  if (!fs::is_fifo(file, no_pipe)) return;
  if (!fs::canonical(file, no_name).empty())
    throw toml::SceneError(file, 0, 0, "is a pipe", "name a file, or give <(cat " + file + ")");
}

/// @throws IoError where errno says that another try may succeed: it is no mistake in the scene
void refuse_failing_machine(const std::string& file) {
  for (const int reason : {EIO, EMFILE, ENFILE, ENOMEM, ESTALE})
    if (errno == reason) throw IoError(file + ": cannot read: " + std::strerror(reason), file);
}

/// @throws SceneError, IoError
std::string read_whole(const std::string& file) {
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) refuse_failing_machine(file);
  if (!in) {
    // The search for a similar name changes errno.
    const std::string reason = errno ? std::strerror(errno) : "cannot be opened";
    throw toml::SceneError(file, 0, 0, reason, nearest_file(file));
  }
  // One byte more than allowed tells an oversized file without reading all of it.
  std::string text(toml::max_toml_bytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) refuse_failing_machine(file);
  if (in.bad()) throw toml::SceneError(file, 0, 0, errno ? std::strerror(errno) : "cannot be read");
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

/// The text of a pipe, read once: it is kept for those who read the scene again.
const std::string& text_of_stream(const std::string& file) {
  static std::mutex mutex;
  static std::map<std::string, std::string> texts;
  const std::lock_guard lock(mutex);
  const auto found = texts.find(file);
  return found != texts.end() ? found->second : texts.emplace(file, read_whole(file)).first->second;
}

}  // namespace

std::string path_of_scene(const std::string& typed) {
  if (typed == "-") return standard_input;
  std::error_code error;
  const std::string longer = typed + ".toml";
  if (fs::is_regular_file(typed, error)) refuse_other_languages(typed);
  const bool is_short = !typed.empty() && !fs::exists(typed, error);
  return is_short && fs::is_regular_file(longer, error) ? longer : typed;
}

std::string base_dir_of(const std::string& file) {
  return is_stream(file) ? std::string() : fs::path(file).parent_path().string();
}

bool is_lasting_file(const std::string& file) {
  std::error_code error;
  return !is_stream(file) && fs::is_regular_file(file, error);
}

std::string name_of_scene(const std::string& file) {
  if (is_open_file(file)) return "pipe";
  const std::string name = fs::path(file).stem().string();
  return name.find_first_not_of('.') == std::string::npos ? "scene" : name;
}

std::string kind_of_no_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error), end = fs::status(path, error);
  if (fs::is_directory(end)) return "a directory";
  if (fs::is_fifo(end)) return "a pipe";
  if (fs::is_symlink(status) && !fs::exists(end)) return "a link to nothing";
  return fs::is_other(end) ? "no file" : "";
}

std::string read_toml_file(const std::string& file) {
  std::error_code error;
  if (fs::is_directory(file, error)) {
    const bool is_sweep = is_sweep_folder(file);
    throw toml::SceneError(file, 0, 0, "is a directory",
                           is_sweep ? "it has the runs of a sweep: name one, as in " +
                                          (fs::path(file) / "runs/0000").string()
                                    : "name a scene file");
  }
  refuse_waiting_pipe(file);
  std::string text = fs::is_fifo(file, error) ? text_of_stream(file) : read_whole(file);
  if (text.size() > toml::max_toml_bytes) throw toml::SceneError(file, 0, 0, "larger than 1 MiB");
  if (file.ends_with(".png") && text.starts_with("\x89PNG"))
    throw toml::SceneError(file, 0, 0, "is a picture, and a scene is wanted here",
                           "name the scene that it was made of: neve info says which; from the "
                           "moment of a picture neve sweep continues with --from TIME");
  if (file.ends_with(".png"))
    throw toml::SceneError(file, 0, 0, "is not a PNG picture, although its name ends in .png",
                           "name a scene file, or a picture that neve has made");
  if (text.empty())
    throw toml::SceneError(file, 0, 0, "the file is empty", "a scene needs at least one [[body]]");
  return text;
}

}  // namespace neve::app::scene
