#include "app/sweep/jobs/background.h"

#include "app/options/arguments.h"
#include "app/output/atomic_file.h"
#include "app/support/errors.h"
#include "app/sweep/jobs/outcome.h"

namespace neve::app::sweep::jobs {

namespace fs = std::filesystem;

namespace {

fs::file_time_type manifest_time(const fs::path& folder) {
  std::error_code error;
  return fs::last_write_time(folder / "manifest.json", error);
}

Child started(plan::SweepOptions options, const fs::path& program, const fs::path& log,
              double grace) {
  output::make_folder(options.out);
  output::write_file(log, std::string_view{});
  options.verbosity = Verbosity::quiet;
  options.progress.is_json = true;
  ChildLimits limits;
  limits.grace = grace;
  return {{program, options::words_of(options), fs::current_path()}, log, limits};
}

RunProgress progress_of_run(const fs::path& folder, const store::Manifest& manifest,
                            const Run& run) {
  RunProgress progress;
  progress.frames = run.frames.count();
  const fs::path run_folder = store::runs_folder(folder) / run.folder;
  const store::RunStatus status = store::read_status(run_folder);
  // The folder may still have a run of another sweep.
  if (status.key != run.key) return progress;
  progress.state = status.state;
  progress.reason = status.short_reason.empty() ? status.reason : status.short_reason;
  // Pictures of a run that has not begun are of an earlier drawing.
  if (status.state != store::RunState::pending)
    progress.made = store::frames_made(run_folder, manifest.view, run.frames);
  return progress;
}

}  // namespace

RunCounts SweepProgress::counts() const {
  RunCounts counts;
  counts.all = static_cast<int>(runs.size());
  for (const RunProgress& run : runs) {
    counts.finished += run.has_ended();
    counts.failed += run.has_failed();
    counts.running += run.state == store::RunState::running;
  }
  return counts;
}

double SweepProgress::share() const {
  double made = 0, all = 0;
  for (const RunProgress& run : runs) {
    all += run.frames;
    made += run.has_ended() ? run.frames : run.made;
  }
  return all > 0 ? made / all : 0;
}

SweepProgress progress_of(const fs::path& folder) {
  SweepProgress progress{store::read_manifest(folder), {}};
  for (const Run& run : progress.manifest.runs)
    progress.runs.push_back(progress_of_run(folder, progress.manifest, run));
  return progress;
}

BackgroundSweep::BackgroundSweep(plan::SweepOptions options, const fs::path& program,
                                 const fs::path& log, double grace)
    : folder_(options.out),
      log_(log),
      before_(manifest_time(folder_)),
      child_(started(std::move(options), program, log, grace)) {}

std::optional<int> BackgroundSweep::poll() {
  if (code_) return code_;
  const std::optional<ChildResult> result = child_.poll();
  if (!result) return std::nullopt;
  code_ = result->ending == Ending::exited    ? result->code
          : result->ending == Ending::stopped ? exit_resumable
                                              : exit_internal;
  return code_;
}

std::optional<SweepProgress> BackgroundSweep::progress() const {
  const bool has_begun =
      code_ == exit_ok || code_ == exit_runs_failed || manifest_time(folder_) != before_;
  return has_begun ? std::optional(progress_of(folder_)) : std::nullopt;
}

std::string BackgroundSweep::error() const {
  const std::string found = last_error(log_);
  if (!found.empty() || code_ != exit_internal) return found;
  return "neve sweep ended without a message; see " + log_.string();
}

}  // namespace neve::app::sweep::jobs
