#include "app/run/resume.h"

#include <algorithm>
#include <new>

#include "app/output/atomic_file.h"
#include "app/output/sequence.h"
#include "app/run/verify.h"
#include "app/scene/flat.h"
#include "app/scene/read.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "app/support/version.h"
#include "sim/base/hash.h"

namespace neve::app::run {

namespace {

/// Everything that bits of states and pictures depend on, but the machine.
std::string identity_of(PictureRecord picture) {
  picture.frame = 0;
  picture.view.clear();
  picture.state_hash.clear();
  picture.build.clear();
  const std::string text = to_text(to_json(picture));
  return hash_text(hash_bytes(text.data(), text.size()));
}

std::string value_or_none(const std::optional<scene::toml::Value>& value) {
  return value ? scene::toml::toml_literal(*value, 60) : "none";
}

/// First difference between the run of a folder and this one, with both values; values that may
/// differ where run.json cannot tell.
std::string other_thing(const std::filesystem::path& folder, const PictureRecord& picture) {
  try {
    const Json run = parse_json(output::read_file(output::run_json_path(folder)));
    const scene::Scene before =
        scene::read_scene_text(run.at("scene").get<std::string>(), "run.json");
    const scene::Scene after = scene::read_scene_text(picture.scene, "the scene");
    const std::vector<scene::Difference> list = scene::differences(before, after);
    if (!list.empty()) {
      const std::size_t more = list.size() - 1;
      return list.front().address + " was " + value_or_none(list.front().before) + " and is " +
             value_or_none(list.front().after) +
             (more > 0 ? ", and " + std::to_string(more) + " more differ" : "");
    }
    const auto version = run.at("version").get<std::string>();
    if (version != picture.version) return "it was made by version " + version;
    if (run.at("changes") != scene::to_json(picture.changes)) return "it had other changes";
    if (run.at("coarsen") != picture.coarsening)
      return "--coarsen was " + rough_text(run.at("coarsen").get<double>());
    if (run.at("overrides") != Json(picture.overrides)) return "it had other --set";
    const Json passes = run.value("passes", Json::array());
    if (passes != Json(picture.passes))
      return passes.empty() ? "it had no --passes"
                            : "--passes was " + joined(passes.get<std::vector<std::string>>(), ",");
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    // An unreadable scene changes nothing here: the identity alone says that the run differs.
  }
  return "its scene, changes, views, quality or version differ";
}

/// Adds the frames that run.json lists and the checkpoint does not: those after it, and all of an
/// earlier version. Their pictures stay listed until they are made again.
void add_listed(const Json& run_json, ResumedRun& run) {
  const bool has_none = run.frames.empty();
  if (has_none && run_json.is_object()) run.exports = run_json.value("exports", Json());
  for (const FrameRecord& frame : frame_records(run_json))
    if (has_none || frame.frame > run.frame) add_frame(run.frames, frame);
  for (const auto& [file, hash] : file_hashes(run_json)) run.files.emplace(file, hash);
  // Movies are made again at the end: only pictures are in folders.
  std::erase_if(run.files,
                [](const auto& file) { return file.first.find('/') == std::string::npos; });
}

}  // namespace

Checkpoints::Checkpoints(std::filesystem::path folder, const PictureRecord& picture,
                         sim::Simulation& simulation, ChangePlayer& player, Progress& progress)
    : folder_(std::move(folder)),
      picture_(picture),
      identity_(identity_of(picture)),
      simulation_(simulation),
      player_(player),
      progress_(progress) {}

void Checkpoints::write(int frame, const sim::AdvanceReport& advance,
                        std::span<const picture::PlotSample> history, const RunRecord& record) {
  output::Checkpoint checkpoint = checkpoint_of(simulation_, frame, identity_);
  checkpoint.progress = progress_json(frame, advance, history, record);
  output::write_checkpoint(folder_, checkpoint);
}

void Checkpoints::check_identity(const output::Checkpoint& checkpoint) {
  if (checkpoint.identity != identity_)
    throw UsageError(
        "--resume",
        "the run in " + folder_.string() + " is a different run: " + other_thing(folder_, picture_),
        "remove --resume to replace it, or choose another folder with --out");
  if (checkpoint.sources != build().sources)
    progress_.warning(
        "the earlier part of the run was made by a program with other sources: this "
        "part may not be what that program would make; leave --resume out to make "
        "all of it again");
  if (checkpoint.simd != simulation_.simd())
    progress_.warning("the earlier part of the run used " + checkpoint.simd +
                      " instructions, this part uses " + simulation_.simd() +
                      ": the last bits will differ; use NEVE_SIMD=" + checkpoint.simd +
                      " if this machine has it");
}

std::optional<Resumption> Checkpoints::find(const RunRecord& record, setup::FrameRange frames) {
  const output::FoundCheckpoint found = output::find_checkpoint(folder_);
  for (const std::string& damaged : found.damaged)
    progress_.warning(damaged + "; using an older checkpoint");
  if (!found.checkpoint) {
    progress_.note("no checkpoint in " + folder_.string() + ": the run starts at frame 0");
    return std::nullopt;
  }
  check_identity(*found.checkpoint);
  Resumption resumption{read_resumed_run(*found.checkpoint), {}, {}};
  ResumedRun& run = resumption.run;
  add_listed(read_run_json(folder_), run);
  const int last = std::min(run.frame, frames.last);
  Pictures pictures{record.views, record.views_of_passes, run.frames, run.files};
  std::erase_if(pictures.frames, [&](const FrameRecord& made) { return made.frame > run.frame; });
  std::vector<Flaw> flaws = picture_flaws(folder_, pictures, frames.first, last, resumption.flawed);
  try {
    for (Flaw& flaw : export_flaws(folder_, run.exports, run.files, run.frame, resumption.flawed))
      flaws.push_back(std::move(flaw));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    refuse_checkpoint(run.file, error);
  }
  std::sort(resumption.flawed.begin(), resumption.flawed.end());
  if (flaws.empty()) return resumption;
  run.state.clear();  // read again when the pictures are whole: it may be large
  const int before = resumption.flawed.front();
  if (const auto older = output::find_checkpoint(folder_, before).checkpoint;
      older && older->identity == identity_)
    resumption.repair = read_resumed_run(*older);
  progress_.warning(folder_.string() + ": " + flaw_text(flaws) + "; made again from frame " +
                    std::to_string(resumption.repair ? resumption.repair->frame : 0) + " on");
  return resumption;
}

void Checkpoints::go_to(const ResumedRun& run) {
  try {
    player_.go_to(run.steps);
    if (!run.state.empty()) return restore_frame(run, player_.scene().fps, simulation_);
    const std::optional<output::Checkpoint> again = output::find_checkpoint(folder_).checkpoint;
    if (!again || again->identity != identity_ || again->steps != run.steps)
      throw std::runtime_error("it has changed");
    ResumedRun whole = run;
    whole.state = again->state;
    restore_frame(whole, player_.scene().fps, simulation_);
  } catch (const UnreadableError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    refuse_checkpoint(run.file, error);
  }
}

}  // namespace neve::app::run
