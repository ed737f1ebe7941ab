#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>

#include "app/cli/command_line.h"
#include "app/cli/commands.h"
#include "app/output/folder_lock.h"
#include "app/output/sequence.h"
#include "app/record/verify.h"
#include "app/support/errors.h"
#include "app/support/out_folder.h"
#include "app/support/text.h"
#include "app/sweep/store/manifest.h"
#include "app/sweep/store/store.h"

namespace neve::app::cli {

namespace {

namespace fs = std::filesystem;

struct Findings : record::Verification {
  /// Why a folder without flaws is not finished; "" if it is.
  std::string unfinished{};
  bool is_in_use = false;  ///< by a process that still runs
  bool is_run = true;      ///< or a sweep: they can be resumed

  bool is_whole() const { return flaws.empty() && unfinished.empty(); }
};

record::Verification verify_whole_run(const fs::path& folder) {
  record::Verification found = record::verify_run(folder);
  record::verify_kept(folder, found);
  return found;
}

Findings verify_run_folder(const fs::path& folder) {
  Findings findings{verify_whole_run(folder)};
  if (findings.status == "ok" || findings.status == "diverged" || findings.status.empty())
    return findings;
  findings.is_in_use = output::FolderLock::is_held(folder);
  findings.unfinished =
      "the run is not finished: " +
      (findings.is_in_use
           ? "it is in use by " + output::FolderLock::holder_of(folder) + "; wait for it"
           : "its status is " + findings.status);
  return findings;
}

/// The folder of `neve export --out`, or of `neve compare --out`.
Findings verify_listed_folder(const record::Verification& found, const char* what) {
  Findings findings{found};
  findings.is_run = false;
  if (found.status == "interrupted") findings.unfinished = std::string(what) + " is not finished";
  return findings;
}

/// Lists of files of a folder that no run has made, and what made them.
std::array<std::pair<fs::path, const char*>, 2> lists_of(const fs::path& folder) {
  return {{{output::export_list_path(folder), "the export"},
           {output::comparison_list_path(folder), "the comparison"}}};
}

Findings verify_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(output::run_json_path(folder), error)) return verify_run_folder(folder);
  for (const auto& [list, what] : lists_of(folder))
    if (const std::optional<record::Verification> found = record::verify_list(list))
      return verify_listed_folder(*found, what);
  return verify_run_folder(folder);
}

/// The runs of a sweep, each at its path in the folder.
Findings verify_sweep_folder(const fs::path& folder) {
  const sweep::store::Manifest manifest = sweep::store::read_manifest(folder);
  Findings findings;
  std::size_t left = 0;
  for (int index = 0; index <= manifest.last_index(); ++index) {
    const sweep::Run* run = manifest.run_of(index);
    if (!run) continue;
    const sweep::Run& item = *run;
    const fs::path place = fs::path("runs") / item.folder;
    const sweep::store::RunStatus status = sweep::store::read_status(folder / place);
    if (status.key != item.key || !sweep::store::is_finished(status.state)) ++left;
    if (status.is_damaged)
      findings.flaws.push_back({(place / "status.json").generic_string(), "is damaged"});
    if (status.key != item.key || !sweep::store::has_record(status)) continue;
    const record::Verification found = verify_whole_run(folder / place);
    findings.files += found.files;
    for (const record::Flaw& flaw : found.flaws)
      findings.flaws.push_back({(place / flaw.file).generic_string(), flaw.what});
    for (const std::string& note : found.notes)
      findings.notes.push_back((place / note).generic_string());
    if (const std::string other =
            sweep::store::difference_of_record(status, record::read_run_json(folder / place));
        found.flaws.empty() && !other.empty())
      findings.flaws.push_back({(place / "run.json").generic_string(), other});
    if (status.state == sweep::store::RunState::ok && found.flaws.empty() &&
        found.last_frame < item.frames.last)
      findings.flaws.push_back({(place / "run.json").generic_string(),
                                fmt::format("ends before frame {}", item.frames.last)});
  }
  std::error_code error;
  for (const sweep::Run& beginning :
       manifest.beginning ? manifest.beginning->runs : std::vector<sweep::Run>{}) {
    const fs::path place = sweep::store::beginning_folder("", beginning);
    if (!fs::exists(folder / place, error)) continue;
    const sweep::store::RunStatus status = sweep::store::read_status(folder / place);
    // A beginning that was refused, for example, wrote no record.
    if (sweep::store::has_failed(status.state) && !sweep::store::has_record(status)) continue;
    for (const record::Flaw& flaw : verify_whole_run(folder / place).flaws)
      findings.flaws.push_back({(place / flaw.file).generic_string(), flaw.what});
  }
  if (left > 0)
    findings.unfinished =
        fmt::format("{} of {} runs are not finished", left, manifest.last_index() + 1);
  findings.status = left > 0 ? "unfinished" : "ok";
  return findings;
}

/// A run that lost its run.json still has pictures or a checkpoint.
bool has_rest_of_run(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder / "checkpoint", error)) return true;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (fs::exists(output::frame_path(folder, at->path().filename().string(), 0), error))
      return true;
  return false;
}

/// @throws IoError for a folder that no run has written to
void require_run(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(output::run_json_path(folder), error)) return;
  for (const auto& [list, what] : lists_of(folder))
    if (fs::exists(list, error)) return;
  if (has_rest_of_run(folder)) return;
  const FolderAdvice advice = advice_on_folder(folder);
  throw IoError(folder.string() + " " + advice.what + "; " + advice.hint, folder.string(),
                advice.hint);
}

void print_json(const std::string& folder, const Findings& findings) {
  Json json;
  json["folder"] = folder;
  json["status"] = findings.status;
  json["whole"] = findings.is_whole();
  json["files"] = findings.files;
  json["flaws"] = Json::array();
  for (const record::Flaw& flaw : findings.flaws)
    json["flaws"].push_back({{"file", flaw.file}, {"what", flaw.what}});
  json["notes"] = findings.notes;
  std::cout << to_text(json) << "\n";
}

/// True for states and checkpoints: --resume makes all else again, since it follows from the scene.
bool is_of_kept_file(const record::Flaw& flaw) {
  return flaw.file.ends_with(".ckpt");
}

/// True for the list of a neve export in the folder of a run: --resume of the run does not end it.
bool is_of_export_list(const record::Flaw& flaw) {
  return fs::path(flaw.file).filename() == output::export_list_path({}).filename();
}

void print_text(const std::string& folder, bool is_sweep, bool is_quiet, const Findings& findings) {
  for (const record::Flaw& flaw : findings.flaws)
    std::cout << printable_text((fs::path(folder) / flaw.file).string()) << " "
              << printable_text(flaw.what) << "\n";
  if (!findings.unfinished.empty())
    std::cout << printable_text(folder + ": " + findings.unfinished) << "\n";
  if (is_quiet) return;
  for (const std::string& note : findings.notes)
    std::cout << printable_text((fs::path(folder) / note).string()) << "\n";
  const bool is_made = !findings.flaws.empty() && findings.unfinished.empty() &&
                       std::ranges::all_of(findings.flaws, is_of_kept_file);
  const bool is_of_export = !findings.flaws.empty() && findings.unfinished.empty() &&
                            std::ranges::all_of(findings.flaws, is_of_export_list);
  if (is_of_export)
    std::cout << "repeat the neve export that was interrupted\n";
  else if (is_made)
    std::cout << "no picture, film or export is damaged: remove the folder states, and what is "
                 "damaged in the folder checkpoint; a command that needs them simulates again\n";
  else if (findings.is_whole())
    std::cout << folder << ": complete, " << findings.files << " files unchanged\n";
  else if (!findings.is_in_use)
    std::cout << (is_sweep ? "repeat the command of the sweep to make the rest\n"
                  : findings.is_run
                      ? "repeat the command that made it, with --resume, to make the rest, and "
                        "without --replace\n"
                      : "repeat the command that made it\n");
}

}  // namespace

int run_verify(const PlainOptions& options) {
  const std::string& folder = options.name;
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw IoError(folder + ": is not a folder", folder,
                  "name the output folder of a run or a sweep");
  const bool is_sweep = is_sweep_folder(folder);
  if (!is_sweep) require_run(folder);
  const Findings findings = is_sweep ? verify_sweep_folder(folder) : verify_folder(folder);
  if (options.is_json)
    print_json(folder, findings);
  else
    print_text(folder, is_sweep, options.is_quiet, findings);
  return findings.is_whole() ? exit_ok : exit_check_failed;
}

}  // namespace neve::app::cli
