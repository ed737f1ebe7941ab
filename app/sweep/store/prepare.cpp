#include "app/sweep/store/prepare.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>

#include "app/output/atomic_file.h"
#include "app/run/picture_record.h"
#include "app/run/run_json.h"
#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/setup/command_text.h"
#include "app/support/errors.h"
#include "app/support/version.h"
#include "app/sweep/store/store.h"
#include "sim/base/hash.h"

namespace neve::app::sweep::store {

namespace fs = std::filesystem;

namespace {

/// Each run's folder: the one that has its key, or that of its number, or a new number.
std::vector<std::string> assign_folders(const plan::SweepPlan& plan,
                                        const std::vector<std::string>& keys) {
  std::map<std::string, std::string> folder_of = known_runs(plan.folder);
  std::set<std::string> taken;
  for (const auto& [key, folder] : folder_of) taken.insert(folder);
  std::vector<std::string> folders;
  int next = 0;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (!folder_of.contains(keys[k])) {
      std::string folder = run_folder_name(static_cast<int>(k));
      while (taken.contains(folder)) folder = run_folder_name(next++);
      taken.insert(folder);
      folder_of[keys[k]] = folder;
    }
    folders.push_back(folder_of[keys[k]]);
  }
  return folders;
}

bool has_text(const fs::path& file, const std::string& text) {
  try {
    const std::vector<std::uint8_t> bytes = output::read_file(file);
    return std::equal(bytes.begin(), bytes.end(), text.begin(), text.end());
  } catch (const IoError&) {
    return false;
  }
}

/// The scene of a branch is that of the beginning; its own values are changes on the way.
std::string text_of_run(const plan::SweepPlan& plan, const plan::PlannedRun& item) {
  if (!plan.beginning) return scene::write_scene(item.scene);
  setup::RenderCommand command;
  command.scene_file = "../../beginning";
  command.overrides = item.run.settings;
  return "# A run that parts from the common beginning. In this folder:\n# " +
         setup::command_line(command) + " --from " + fmt::format("{}", plan.fork) + "\n" +
         scene::write_scene(plan.beginning->scene);
}

/// The key is that of the planned scene: one that was edited by hand is written again.
void write_run(const fs::path& folder, const std::string& text, const std::string& key) {
  output::make_folder(folder);
  if (!has_text(folder / "scene.toml", text)) output::write_file(folder / "scene.toml", text);
  if (read_status(folder).key == key) return;
  RunStatus status;
  status.key = key;
  write_status(folder, status);
}

}  // namespace

std::string key_of(const plan::PlannedRun& item) {
  std::string text = scene::write_scene(item.scene) + "\nversion " + version + "\nsources " +
                     build().sources + "\nframes " + std::to_string(item.run.frames.first) + "-" +
                     std::to_string(item.run.frames.last);
  for (const auto& [file, hash] : run::hash_files(item.scene)) text += "\n" + file + " " + hash;
  return run::hash_text(hash_bytes(text.data(), text.size()));
}

std::string key_of(const plan::SweepPlan& plan, const plan::PlannedRun& item) {
  if (!plan.beginning) return key_of(item);
  const std::string text =
      key_of(item) + fmt::format("\nfrom {} of {}", plan.fork, key_of(*plan.beginning));
  return run::hash_text(hash_bytes(text.data(), text.size()));
}

Manifest prepare_sweep(const plan::SweepPlan& plan) {
  output::make_folder(runs_folder(plan.folder));
  std::vector<std::string> keys;
  for (const plan::PlannedRun& item : plan.runs) keys.push_back(key_of(plan, item));
  const std::vector<std::string> folders = assign_folders(plan, keys);
  const Manifest manifest = make_manifest(plan, keys, folders);
  for (std::size_t k = 0; k < plan.runs.size(); ++k)
    write_run(runs_folder(plan.folder) / folders[k], text_of_run(plan, plan.runs[k]), keys[k]);
  if (plan.beginning)
    write_run(beginning_folder(plan.folder), scene::write_scene(plan.beginning->scene),
              key_of(*plan.beginning));
  if (!plan.sweep.file.empty())
    output::write_file(plan.folder / "sweep.toml", scene::read_toml_file(plan.sweep.file));
  write_manifest(plan.folder, manifest);
  return manifest;
}

}  // namespace neve::app::sweep::store
