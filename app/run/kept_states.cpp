#include "app/run/kept_states.h"

#include <new>

#include "app/output/checkpoint.h"
#include "app/output/report_json.h"
#include "app/record/picture_record.h"
#include "app/scene/read.h"
#include "app/support/errors.h"
#include "app/support/version.h"
#include "sim/base/hash.h"

namespace neve::app::run {

namespace {

std::string state_identity(const RenderJob& job, const sim::Simulation& simulation) {
  std::string text = simulation_text(job.scene) + to_text(scene::to_json(job.changes)) + version +
                     build().sources + simulation.simd();
  for (const auto& [file, hash] : record::hash_files(job.scene)) text += "\n" + file + " " + hash;
  return record::hash_text(hash_bytes(text.data(), text.size()));
}

}  // namespace

std::string simulation_text(const scene::Scene& scene) {
  // All of it but what only pictures, exports and the length of a run read.
  const scene::Scene plain;
  scene::Scene simulated = scene;
  simulated.title.clear();
  simulated.frames = plain.frames;
  simulated.limits = plain.limits;
  simulated.camera = plain.camera;
  simulated.light = plain.light;
  simulated.views = plain.views;
  simulated.mosaics = plain.mosaics;
  simulated.exports = plain.exports;
  simulated.size = plain.size;
  simulated.background = plain.background;
  for (scene::Collider& collider : simulated.colliders) collider.style = scene::Collider{}.style;
  return scene::write_scene(simulated);
}

KeptStates::KeptStates(const RenderJob& job, const sim::Simulation& simulation, Progress& progress)
    : job_(job), simulation_(simulation), progress_(progress) {}

void KeptStates::begin() {
  identity_ = state_identity(job_, simulation_);
  const std::vector<int> frames = output::kept_states(job_.folder);
  bool is_other = false;
  for (const int frame : frames)
    if (const auto found = output::read_state(job_.folder, frame).checkpoint) {
      is_other = found->identity != identity_;
      break;
    }
  if (is_other)
    output::remove_states(job_.folder);
  else if (!job_.validate)  // laws are checked between steps
    known_ = {frames.begin(), frames.end()};
  is_keeping_ = job_.keeps_states || (!is_other && !frames.empty());
}

int KeptStates::skip_to(int first, int last) {
  for (auto frame = known_.upper_bound(last); frame != known_.begin();) {
    if (*--frame <= first) break;
    if (output::read_state(job_.folder, *frame).checkpoint) return *frame;
  }
  return first;
}

std::optional<KeptState> KeptStates::find(int frame) {
  if (!has(frame)) return std::nullopt;
  const output::FoundState found = output::read_state(job_.folder, frame);
  if (found.checkpoint && found.checkpoint->identity == identity_) {
    try {
      KeptState kept;
      kept.run = read_resumed_run(*found.checkpoint);
      kept.advance = output::advance_report(found.checkpoint->progress.at("advance_of_frame"));
      if (kept.run.frames.empty()) return kept;
      kept.seconds = kept.run.frames.back().seconds_sim;
      kept.grid_blocks = kept.run.frames.back().summary.grid_blocks;
      return kept;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      progress_.warning(std::string(error.what()) + "; the frame is simulated again");
    }
  } else if (!found.damage.empty()) {
    progress_.warning(found.damage + "; the frame is simulated again");
  }
  known_.erase(frame);
  return std::nullopt;
}

void KeptStates::write(int frame, const sim::AdvanceReport& advance,
                       std::span<const picture::PlotSample> history,
                       const record::RunRecord& record) {
  if (!needs_state(frame)) return;
  record::RunRecord brief;
  brief.retries = record.retries;
  if (!record.frames.empty()) brief.frames = {record.frames.back()};
  output::Checkpoint checkpoint = checkpoint_of(simulation_, frame, identity_);
  checkpoint.progress = progress_json(frame, {}, history, brief);
  checkpoint.progress["advance_of_frame"] = output::to_json(advance);
  output::write_state(job_.folder, checkpoint);
}

}  // namespace neve::app::run
