#pragma once
/// Forks: runs that start from a moment of an existing run, with changes.

#include "app/run/render_job.h"
#include "app/support/progress.h"
#include "app/timeline/timeline.h"

namespace neve::app::run {

/// @throws UsageError where a run that repeats frames with smaller steps would fork inside a frame
void require_whole_frame(const scene::Scene& scene, double time, const char* flag);

/// Makes a job a fork at options.from, with the overrides of the options as changes.
/// @throws UsageError for parameters that cannot change during a run, with those that can
void set_fork(const RenderOptions& options, RenderJob& job);

/// The scene of a job as its run has it at the fork: with the changes of that run, as far as its
/// frames tell which they are, and without those of the fork.
scene::Scene scene_before_fork(const RenderJob& job);

/// Brings the run of a job to its fork, from the nearest moment that is kept or from the start;
/// later changes are forgotten. The fork then has its start.
/// @throws UsageError, IoError, Error when the run does not get there
void walk_to_fork(RenderJob& job, timeline::Timeline& timeline, Progress& progress);

/// The same, and makes the changes there. The job then has them in its list, with their step, and
/// says where it left.
void go_to_fork(RenderJob& job, timeline::Timeline& timeline, Progress& progress);

}  // namespace neve::app::run
