#include "app/sweep/jobs/source.h"

#include <fmt/core.h>

#include <chrono>
#include <optional>
#include <thread>

#include "app/output/folder_lock.h"
#include "app/run/fork.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/text.h"
#include "app/sweep/jobs/local.h"
#include "app/sweep/store/store.h"

namespace neve::app::sweep::jobs {

void take_beginning(const plan::SweepPlan& plan, const store::Beginning& beginning, int threads,
                    Progress& progress) {
  const Run& run = beginning.runs.front();
  const std::filesystem::path folder = store::beginning_folder(plan.folder, run);
  if (has_beginning(run, folder)) return;
  // Shards of a sweep work side by side: one takes it.
  std::optional<output::FolderLock> lock;
  while (!(lock = output::FolderLock::try_lock(folder, "neve sweep",
                                               output::FolderLock::Kind::alone, store::run_lock))) {
    if (is_interrupted()) throw Error(exit_interrupted, "interrupted before the first run");
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  if (has_beginning(run, folder)) return;
  run::RenderJob job = *plan.source;
  job.scene = plan.beginnings.front().scene;
  progress.note(
      fmt::format("the runs fork from {} at {} s", job.scene_file, rough_text(beginning.time)));
  timeline::Timeline timeline = timeline::open(job, threads, progress);
  run::walk_to_fork(job, timeline, progress);
  record::RunRecord record = run::run_record(job, timeline.simulation());
  record.changes = timeline.changes();
  record.start = job.fork->start;
  timeline::write_origin(folder, std::move(record), timeline.moment());
  store::RunStatus status = store::read_status(folder);
  status.state = store::RunState::ok;
  store::write_status(folder, status);
}

}  // namespace neve::app::sweep::jobs
