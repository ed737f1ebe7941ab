#include "app/run/moment.h"

#include "app/output/atomic_file.h"
#include "app/output/checkpoint.h"
#include "app/scene/read.h"
#include "app/support/version.h"
#include "sim/base/hash.h"

namespace neve::app::run {

Moment moment_of(const RenderJob& job, const ResumedRun& run, const ChangePlayer& player,
                 const sim::Simulation& simulation) {
  Moment moment;
  moment.record.scene = scene::write_scene(job.scene);
  moment.record.scene_file = job.scene_file;
  moment.record.overrides = job.overrides;
  moment.record.changes = player.changes();
  moment.record.coarsening = job.coarsening;
  moment.record.threads = simulation.threads();
  moment.record.simd = simulation.simd();
  moment.frame = run.frame;
  moment.steps = simulation.steps();
  moment.advance = run.advance;
  moment.history = run.history;
  moment.retries = run.retries;
  moment.state = simulation.save();
  return moment;
}

void write_moment(const std::filesystem::path& folder, const Moment& moment) {
  record::RunRecord record = moment.record;
  record.status = record::RunStatus::ok;
  record.retries = moment.retries;
  output::Checkpoint checkpoint;
  const std::string text = record.scene + to_text(scene::to_json(record.changes));
  checkpoint.identity = record::hash_text(hash_bytes(text.data(), text.size()));
  checkpoint.simd = record.simd;
  checkpoint.sources = build().sources;
  checkpoint.frame = moment.frame;
  checkpoint.steps = moment.steps;
  checkpoint.progress = progress_json(moment.frame, moment.advance, moment.history, record);
  checkpoint.state = moment.state;
  output::make_folder(folder);
  output::remove_checkpoints(folder);
  output::write_checkpoint(folder, checkpoint);
  record::write_run_json(folder, record);
}

}  // namespace neve::app::run
