#include "app/sweep/store/promote.h"

#include <fmt/core.h>

#include <filesystem>
#include <iostream>
#include <vector>

#include "app/options/arguments.h"
#include "app/options/common.h"
#include "app/options/languages.h"
#include "app/output/atomic_file.h"
#include "app/record/earlier.h"
#include "app/record/run_json.h"
#include "app/scene/edit_text.h"
#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/support/errors.h"
#include "app/support/json.h"
#include "app/support/text.h"
#include "app/sweep/store/manifest.h"
#include "app/sweep/store/store.h"

namespace neve::app::sweep::store {

namespace {

namespace fs = std::filesystem;

const Run& chosen_run(const PromoteOptions& options, const Manifest& manifest) {
  if (options.run < 0 || options.run >= static_cast<int>(manifest.runs.size()))
    throw UsageError("sweep promote", fmt::format("there is no run {}", options.run),
                     fmt::format("expected a number from 0 to {}, as the sheet and the report "
                                 "have it",
                                 manifest.runs.size() - 1));
  const Run& run = manifest.runs[static_cast<std::size_t>(options.run)];
  if (manifest.beginning)
    throw UsageError(
        "sweep promote", "the runs of this sweep fork from one beginning: no scene is theirs alone",
        "the report has the command that makes each of them again, to which --size, --view and "
        "--quality can be added");
  return run;
}

/// The text of the sweep's scene. @throws IoError where it is gone
std::string scene_text(const std::string& folder, const Manifest& manifest, const Run& run) {
  std::error_code error;
  if (!fs::is_regular_file(manifest.scene_file, error))
    throw IoError(manifest.scene_file + ": the scene of the sweep is not here", manifest.scene_file,
                  "begin the command where the sweep began; or take " +
                      (runs_folder(folder) / run.folder / "scene.toml").string() +
                      ", which has all numbers in the resolution of its tile");
  return scene::read_toml_file(manifest.scene_file);
}

/// Lists the files of the scene of a run that have changed since it was made.
std::vector<std::string> changed_files(const fs::path& run_folder) {
  std::vector<std::string> changed;
  const Json run = record::read_run_json(run_folder);
  const Json files = run.is_object() ? run.value("scene_files", Json()) : Json();
  if (!files.is_object()) return changed;
  for (const auto& [file, hash] : files.items())
    if (hash.is_string() && !record::has_hash(run_folder / file, hash.get<std::string>()))
      changed.push_back(file);
  return changed;
}

fs::path path_of(const PromoteOptions& options, const Manifest& manifest) {
  if (!options.out.empty()) return options.out;
  const fs::path scene = manifest.scene_file;
  return scene.parent_path() / fmt::format("{}_{}.toml", scene.stem().string(), options.run);
}

}  // namespace

void describe(options::Command& visit, PromoteOptions& o) {
  visit.about("sweep promote",
              "Write the scene of a tile in its own resolution, with the comments of its file");
  visit.other_place = "name another file with --out";
  visit("DIR", o.folder, options::text(""), "Output folder of a sweep").required();
  visit("RUN", o.run, options::number<int>("N", 0, 1e9, "the number of a run, from 0"),
        "Number of the tile, as the sheet and the report have it")
      .required();
  visit("--out", o.out, options::text("FILE", "shot.toml"),
        "Write to this file instead of SCENE_N.toml beside the scene of the sweep");
  visit("--json", o.is_json, options::json_help);
}

int run_promote(const PromoteOptions& options) {
  const Manifest manifest = read_manifest(options.folder);
  const Run& run = chosen_run(options, manifest);
  const std::string text = scene_text(options.folder, manifest, run);
  std::vector<scene::Override> changes = manifest.fixed;
  changes.insert(changes.end(), run.settings.begin(), run.settings.end());
  std::string values;
  for (const scene::Override& setting : run.settings)
    values += (values.empty() ? ": " : ", ") + setting.address + " = " + setting.value;
  const fs::path out = path_of(options, manifest);
  const std::string made = scene::with_header(
      scene::changed_scene_text(text, changes, manifest.scene_file, out.string()),
      "# Run " + std::to_string(run.index) + " of " + line_text(options.folder) +
          line_text(values) + ".\n");
  std::error_code error;
  if (fs::exists(out, error) && scene::read_toml_file(out.string()) != made)
    throw UsageError("sweep promote", out.string() + " exists, and is another scene",
                     "name another file with --out, or move that one away");
  output::write_among_others(out, made);
  const bool is_other_text =
      !manifest.scene_hash.empty() && manifest.scene_hash != record::hash_of(text);
  const std::vector<std::string> files = changed_files(runs_folder(options.folder) / run.folder);
  const bool has_changed = is_other_text || !files.empty();
  for (const std::string& file : files)
    std::cerr << "neve: warning: " << file
              << " has changed since the sweep: this scene takes it as it is now\n";
  if (is_other_text)
    std::cerr << "neve: warning: " << manifest.scene_file
              << " has changed since the sweep: the rest of this scene is as it is now\n";
  if (options.is_json)
    std::cout << to_text({{"scene", out.string()},
                          {"run", run.index},
                          {"scene_has_changed", has_changed}})
              << "\n";
  else
    std::cout << "wrote " << out.string() << "; next:\n  neve render " << shell_path(out.string())
              << "\n";
  return exit_ok;
}

}  // namespace neve::app::sweep::store
