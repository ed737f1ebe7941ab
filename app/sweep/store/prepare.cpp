#include "app/sweep/store/prepare.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>

#include "app/options/arguments.h"
#include "app/output/atomic_file.h"
#include "app/output/checkpoint.h"
#include "app/output/temporary.h"
#include "app/record/picture_files.h"
#include "app/record/picture_record.h"
#include "app/record/run_json.h"
#include "app/run/identity.h"
#include "app/scene/edit_text.h"
#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/support/errors.h"
#include "app/sweep/store/store.h"

namespace neve::app::sweep::store {

namespace fs = std::filesystem;

namespace {

/// Runs, then variants; null in the place of one that cannot be.
std::vector<const plan::PlannedRun*> all_of(const plan::SweepPlan& plan) {
  std::vector<const plan::PlannedRun*> all;
  for (const plan::PlannedRun& item : plan.runs) all.push_back(&item);
  for (const plan::PlannedVariant& variant : plan.variants)
    all.push_back(variant.failure.empty() ? &variant.item : nullptr);
  return all;
}

/// A finished run of the same simulation that is no run of the sweep any more: its drawing was
/// another. One with kept states where there is any; null if there is none.
const KnownRun* other_drawing(const std::vector<KnownRun>& known, const std::string& simulation,
                              const std::set<std::string>& wanted_keys,
                              const std::set<std::string>& used) {
  const KnownRun* found = nullptr;
  for (const KnownRun& run : known) {
    const bool is_free = !wanted_keys.contains(run.key) && !used.contains(run.folder);
    if (!is_free || run.simulation != simulation || !(run.is_finished || run.has_states)) continue;
    if (!found || (run.has_states && !found->has_states)) found = &run;
  }
  return found;
}

/// Assigns each run's folder: the one that has its key, or states of its simulation, or that of its
/// number, or a new number.
/// @param items  see all_of()
std::vector<std::string> assign_folders(const plan::SweepPlan& plan,
                                        const std::vector<const plan::PlannedRun*>& items,
                                        const std::vector<std::string>& keys, Redrawn* redrawn) {
  const std::vector<KnownRun> known = known_runs(plan.folder);
  const std::set<std::string> wanted(keys.begin(), keys.end());
  std::map<std::string, std::string> folder_of;
  std::set<std::string> taken, used;
  for (const KnownRun& run : known) {
    folder_of.emplace(run.key, run.folder);
    taken.insert(run.folder);
  }
  std::vector<std::string> folders;
  int next = 0;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (items[k] && !folder_of.contains(keys[k])) {
      std::string folder = run_folder_name(static_cast<int>(k));
      const KnownRun* other =
          other_drawing(known, simulation_key_of(plan, *items[k]), wanted, used);
      if (other) used.insert(other->folder);
      if (other && redrawn)
        (other->has_states ? redrawn->from_states : redrawn->made_again)
            .push_back(items[k]->run.index);
      if (other && other->has_states)
        folder = other->folder;
      else
        while (taken.contains(folder)) folder = run_folder_name(next++);
      taken.insert(folder);
      folder_of[keys[k]] = folder;
    }
    folders.push_back(items[k] ? folder_of[keys[k]] : "");
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

/// The scene of a branch is that of the beginning; its own values are changes on the way. Views
/// that a run does not draw are in it: its record has them by name.
std::string text_of_run(const plan::SweepPlan& plan, const plan::PlannedRun& item) {
  if (plan.beginnings.empty()) return scene::text_with_all_views(item.scene);
  const plan::PlannedRun& beginning = plan.beginning_of(item.run);
  const run::RenderOptions options =
      Beginning{plan.fork, {beginning.run}}.fork_of(item.run, "../..");
  return "# A run that forks from the common beginning. In this folder:\n# " +
         options::shell_line(options::words_of(options)) + "\n" +
         scene::text_with_all_views(beginning.scene);
}

/// The keys of a run, and its scene as text.
struct RunFiles {
  std::string text, key, simulation;
};

/// The key is that of the planned scene: one that was edited by hand is written again. A run that
/// is drawn again keeps the time that its simulation took.
void write_run(const fs::path& folder, const RunFiles& files) {
  output::make_own_folder(folder);
  const RunStatus before = read_status(folder);
  const bool has_scene = has_text(folder / "scene.toml", files.text);
  const bool has_status = before.key == files.key;
  if (!has_scene || !has_status) output::remove_abandoned(folder);
  if (!has_scene) output::write_file(folder / "scene.toml", files.text);
  if (has_status) return;
  RunStatus status;
  status.key = files.key;
  status.simulation = files.simulation;
  if (before.simulation == files.simulation && !output::kept_states(folder).empty())
    status.seconds = before.seconds;
  write_status(folder, status);
}

/// Changes before the fork, of the run that is forked, with the files that they name.
std::string changes_of_source(const plan::SweepPlan& plan) {
  if (!plan.source) return "";
  const std::vector<scene::LiveChange>& changes = plan.source->changes;
  return to_text(scene::to_json(changes)) + record::file_lines({}, changes);
}

}  // namespace

std::string key_of(const plan::PlannedRun& item) {
  return record::hash_of(scene::write_scene(item.scene) + run::surroundings_of(item.scene) +
                         "\nframes " + std::to_string(item.run.frames.first) + "-" +
                         std::to_string(item.run.frames.last));
}

std::string key_of_beginning(const plan::SweepPlan& plan, const plan::PlannedRun& beginning) {
  const std::string key = key_of(beginning);
  return plan.source ? record::hash_of(fmt::format("{} at {} after {}", key, plan.fork,
                                                   changes_of_source(plan)))
                     : key;
}

std::string key_of(const plan::SweepPlan& plan, const plan::PlannedRun& item) {
  const std::string own = key_of(item);
  std::string more;
  if (plan.quality != setup::Quality::preview)
    more += fmt::format("\nquality {}", setup::name(plan.quality));
  if (!plan.beginnings.empty())
    more += fmt::format("\nfrom {} of {}", plan.fork,
                        key_of_beginning(plan, plan.beginning_of(item.run)));
  return more.empty() ? own : record::hash_of(own + more);
}

std::string simulation_key_of(const plan::SweepPlan& plan, const plan::PlannedRun& item) {
  std::string text = run::simulation_text(item.scene) + run::surroundings_of(item.scene);
  if (!plan.beginnings.empty())
    text += fmt::format("\nfrom {} of {} after {}", plan.fork,
                        run::simulation_text(plan.beginning_of(item.run).scene),
                        changes_of_source(plan));
  return record::hash_of(text);
}

Manifest prepare_sweep(const plan::SweepPlan& plan, Redrawn* redrawn) {
  output::make_own_folder(runs_folder(plan.folder));
  std::vector<std::string> keys;
  const std::vector<const plan::PlannedRun*> items = all_of(plan);
  for (const plan::PlannedRun* item : items) keys.push_back(item ? key_of(plan, *item) : "");
  const std::vector<std::string> folders = assign_folders(plan, items, keys, redrawn);
  const Manifest manifest = make_manifest(plan, keys, folders);
  for (std::size_t k = 0; k < items.size(); ++k)
    if (items[k])
      write_run(runs_folder(plan.folder) / folders[k],
                {text_of_run(plan, *items[k]), keys[k], simulation_key_of(plan, *items[k])});
  for (const plan::PlannedRun& item : plan.beginnings)
    write_run(beginning_folder(plan.folder, item.run),
              {scene::text_with_all_views(item.scene), key_of_beginning(plan, item),
               simulation_key_of(plan, item)});
  if (!plan.sweep.file.empty())
    output::write_file(plan.folder / "sweep.toml", scene::read_toml_file(plan.sweep.file));
  write_manifest(plan.folder, manifest);
  return manifest;
}

}  // namespace neve::app::sweep::store
