/// `neve new` and `neve schema`.

#include <filesystem>
#include <iostream>

#include "app/advice/suggest.h"
#include "app/cli/commands.h"
#include "app/output/atomic_file.h"
#include "app/output/temporary.h"
#include "app/scene/first_scene.h"
#include "app/scene/schema.h"
#include "app/scene/valid.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "app/sweep/read/sweep_schema.h"

namespace neve::app::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* schema_name = "scene.schema.json";

/// "FOLDER/NAME.toml" for "FOLDER/NAME". @throws UsageError, IoError
fs::path new_scene_path(const std::string& name) {
  fs::path path = name;
  if (path.extension() == ".toml") path.replace_extension();
  if (!scene::is_identifier(path.filename().string()))
    throw UsageError("new", "cannot call a scene \"" + path.filename().string() + "\"",
                     "expected 1 to 64 letters, digits, _ and -, as in neve new "
                     "my_scene");
  path += ".toml";
  std::error_code error;
  if (fs::symlink_status(path, error).type() != fs::file_type::not_found)
    throw UsageError("new", path.string() + " already exists",
                     "choose another name, or move that file away");
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (!fs::is_directory(folder, error))
    throw IoError(folder.string() + ": no such folder; make it first: mkdir -p " + folder.string(),
                  folder.string());
  return path;
}

/// An existing schema may be of this version or another; neve schema writes it again.
void write_schema_once(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) output::write_file(path, to_text(scene::scene_schema()) + "\n");
}

}  // namespace

int run_new(const PlainOptions& options) {
  const fs::path path = new_scene_path(options.name), schema = path.parent_path() / schema_name;
  try {
    output::remove_abandoned(path.parent_path());
    // The scene last: where it exists, the same command refuses to write it again.
    write_schema_once(schema);
    output::write_file(
        path, scene::first_scene(path.stem().string(), path.filename().string(), schema_name));
  } catch (const IoError& error) {
    throw IoError(error.what(), error.where, "choose another folder, as in neve new FOLDER/NAME");
  }
  const std::string file = path.string();
  if (options.is_json) {
    std::cout << to_text({{"scene", file}, {"schema", schema.string()}}) << "\n";
    return exit_ok;
  }
  const std::string word = shell_path(file);
  std::cout << "wrote " << file << ", and " << schema.string()
            << " for editors\nnext:\n  neve check " << word
            << "                what it costs, and what looks wrong\n  neve render " << word
            << " --coarsen 2   a quick preview\n  neve view " << word
            << "                 live: change numbers while the snow moves\n  neve render " << word
            << "               pictures and a film\n";
  return exit_ok;
}

int run_schema(const PlainOptions& options) {
  const std::string kind = options.name.empty() ? "scene" : options.name;
  if (kind != "scene" && kind != "sweep")
    throw UsageError("schema", "there is no schema of \"" + kind + "\"",
                     advice::suggest_one_of(kind, {"", {"scene", "sweep"}}));
  const bool is_scene = kind == "scene";
  std::cout << to_text(is_scene ? scene::scene_schema() : sweep::read::sweep_schema()) << "\n";
  return exit_ok;
}

}  // namespace neve::app::cli
