#include "app/run/resume.h"

#include "app/output/atomic_file.h"
#include "app/output/checkpoint.h"
#include "app/output/sequence.h"
#include "app/scene/flat.h"
#include "app/scene/read.h"
#include "app/scene/toml/error.h"
#include "app/support/text.h"
#include "sim/base/hash.h"

namespace neve::app::run {

namespace {

/// Everything that bits of states and pictures depend on, but the machine.
std::string identity_of(PictureRecord picture) {
  picture.frame = 0;
  picture.view.clear();
  picture.state_hash.clear();
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
  } catch (const std::exception&) {
    // An unreadable scene changes nothing here: the identity alone says that the run differs.
  }
  return "its scene, changes, views, quality or version differ";
}

Json history_json(std::span<const picture::PlotSample> history) {
  Json rows = Json::array();
  for (const picture::PlotSample& s : history)
    rows.push_back({number_or_null(s.time), number_or_null(s.kinetic_energy),
                    number_or_null(s.elastic_energy), number_or_null(s.max_speed), s.steps,
                    static_cast<int>(s.limit)});
  return rows;
}

std::vector<picture::PlotSample> history_of(const Json& rows) {
  std::vector<picture::PlotSample> history;
  for (const Json& row : rows) {
    picture::PlotSample s;
    s.time = row.at(0).get<double>();
    s.kinetic_energy = row.at(1).get<double>();
    s.elastic_energy = row.at(2).get<double>();
    s.max_speed = row.at(3).get<double>();
    s.steps = row.at(4).get<std::size_t>();
    s.limit = static_cast<sim::DtLimit>(row.at(5).get<int>());
    history.push_back(s);
  }
  return history;
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
                        std::span<const picture::PlotSample> history,
                        std::span<const sim::Retry> retries) {
  output::Checkpoint checkpoint;
  checkpoint.identity = identity_;
  checkpoint.simd = simulation_.simd();
  checkpoint.frame = frame;
  checkpoint.steps = simulation_.steps();
  checkpoint.progress = {{"advance", output::to_json(advance)},
                         {"history", history_json(history)},
                         {"retries", Json::array()}};
  for (const sim::Retry& retry : retries)
    checkpoint.progress["retries"].push_back(output::to_json(retry));
  checkpoint.state = simulation_.save();
  output::write_checkpoint(folder_, checkpoint);
}

std::optional<ResumedRun> Checkpoints::resume() {
  const output::FoundCheckpoint found = output::find_checkpoint(folder_);
  for (const std::string& damaged : found.damaged)
    progress_.warning(damaged + "; using an older checkpoint");
  if (!found.checkpoint) {
    progress_.note("no checkpoint in " + folder_.string() + ": the run starts at frame 0");
    return std::nullopt;
  }
  const output::Checkpoint& checkpoint = *found.checkpoint;
  if (checkpoint.identity != identity_)
    throw scene::toml::UsageError(
        "--resume",
        "the run in " + folder_.string() + " is a different run: " + other_thing(folder_, picture_),
        "remove --resume to replace it, or choose another folder with --out");
  if (checkpoint.simd != simulation_.simd())
    progress_.warning("the earlier part of the run used " + checkpoint.simd +
                      " instructions, this part uses " + simulation_.simd() +
                      ": the last bits will differ; use NEVE_SIMD=" + checkpoint.simd +
                      " if this machine has it");
  ResumedRun run;
  try {
    player_.go_to(checkpoint.steps);
    simulation_.restore(checkpoint.state);
    run.frame = checkpoint.frame;
    run.advance = output::advance_report(checkpoint.progress.at("advance"));
    run.history = history_of(checkpoint.progress.at("history"));
    for (const Json& retry : checkpoint.progress.at("retries"))
      run.retries.push_back(output::retry_record(retry));
  } catch (const std::exception& error) {
    // Its checksum is right, so it was written so.
    throw scene::toml::UsageError("--resume", std::string("cannot resume: ") + error.what(),
                                  "remove --resume to start the run again");
  }
  run.frames = read_frame_records(folder_);
  progress_.note("resumed after frame " + std::to_string(run.frame) + ", step " +
                 std::to_string(checkpoint.steps));
  return run;
}

}  // namespace neve::app::run
