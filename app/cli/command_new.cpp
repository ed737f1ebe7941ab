/// `neve new` and `neve schema`, with their command lines.

#include <filesystem>
#include <iostream>
#include <memory>

#include "app/cli/command_line_parts.h"
#include "app/output/atomic_file.h"
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
    throw UsageError("new", path.string() + " is there already",
                     "choose another name, or move that file away");
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (!fs::is_directory(folder, error))
    throw IoError(
        folder.string() + ": there is no such folder; make it first: mkdir -p " + folder.string(),
        folder.string());
  return path;
}

/// A schema that is there may be of this version or another; neve schema writes it again.
void write_schema_once(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) output::write_file(path, to_text(scene::scene_schema()) + "\n");
}

int run_new(const std::string& name, bool is_json) {
  const fs::path path = new_scene_path(name), schema = path.parent_path() / schema_name;
  try {
    output::write_file(
        path, scene::first_scene(path.stem().string(), path.filename().string(), schema_name));
    write_schema_once(schema);
  } catch (const IoError& error) {
    throw IoError(error.what(), error.where, "choose another folder, as in neve new FOLDER/NAME");
  }
  const std::string file = path.string();
  if (is_json) {
    std::cout << to_text({{"scene", file}, {"schema", schema.string()}}) << "\n";
    return exit_ok;
  }
  std::cout << "wrote " << file << ", and " << schema.string()
            << " for editors\nnext:\n  neve check " << file
            << "                what it costs, and what looks wrong\n  neve render " << file
            << " --coarsen 2   a quick preview\n  neve view " << file
            << "                 live: change numbers while the snow moves\n  neve render " << file
            << "               pictures and a film\n";
  return exit_ok;
}

int run_schema(const std::string& kind) {
  if (kind != "scene" && kind != "sweep")
    throw UsageError("schema", "there is no schema of \"" + kind + "\"",
                     names_advice(kind, {"scene", "sweep"}));
  const bool is_scene = kind == "scene";
  std::cout << to_text(is_scene ? scene::scene_schema() : sweep::read::sweep_schema()) << "\n";
  return exit_ok;
}

}  // namespace

void add_new(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("new", "Write a first scene in which every line is explained");
  const auto name = std::make_shared<std::string>();
  const auto is_json = std::make_shared<bool>(false);
  command
      ->add_option("NAME", *name,
                   "Name of the scene, as in my_scene or FOLDER/my_scene; a file that is there is "
                   "not overwritten. Beside it is scene.schema.json, for editors that complete "
                   "TOML (taplo)")
      ->required()
      ->type_name("");
  command->add_flag("--json", *is_json, "Print the names of the files as JSON");
  command->final_callback([=, &action] { action = [=] { return run_new(*name, *is_json); }; });
}

void add_schema(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "schema", "Print the JSON Schema of scenes or sweeps, for editors and other programs");
  const auto kind = std::make_shared<std::string>("scene");
  command->add_option("KIND", *kind, "scene (default) or sweep")->type_name("");
  command->final_callback([=, &action] { action = [=] { return run_schema(*kind); }; });
}

}  // namespace neve::app::cli
