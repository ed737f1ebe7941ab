#pragma once
/// Forks: runs that take another way from a moment of a run that exists.

#include <memory>
#include <vector>

#include "app/run/changes.h"
#include "app/run/render_job.h"
#include "app/run/resumed_run.h"
#include "app/support/progress.h"
#include "sim/simulation.h"

namespace neve::app::run {

/// The moment at which a run takes another way.
struct ForkPoint {
  ResumedRun run;  ///< as far as the fork; without a state, which the simulation has
  std::shared_ptr<const scene::Scene> scene;  ///< after the changes
  Json record;                                ///< for run.json
};

/// @throws UsageError for differences that cannot arise while a simulation runs, with the
/// parameters
///         that can change
void require_live(const scene::Scene& before, const scene::Scene& after, const char* flag);

/// @throws UsageError where a run that repeats frames with smaller steps would part inside a frame
void require_whole_frame(const scene::Scene& scene, double time, const char* flag);

/// The last frame that ends at a time or before it.
int frame_before(double time, double fps);

/// Makes a job a fork at options.from, with the overrides of the options as changes.
/// @throws UsageError for parameters that cannot change during a run, with those that can
void set_fork(const RenderOptions& options, RenderJob& job);

/// The scene of a job as its run has it at the fork: with the changes of that run, as far as its
/// frames tell which they are, and without those of the fork.
scene::Scene scene_before_fork(const RenderJob& job);

/// Brings a new simulation of the job's scene to the fork, as go_to_fork() does, and makes no
/// change there. @param player  of the run that is forked; forgets its later changes
ResumedRun walk_to_fork(const RenderJob& job, ChangePlayer& player, sim::Simulation& simulation,
                        Progress& progress);

/// Brings a new simulation of the job's scene to the fork, from the newest checkpoint that is early
/// enough or from the start, and makes the changes there. The job then has them in its list, with
/// their step; later changes of the run that it leaves are forgotten.
/// @throws UsageError, IoError, Error when the run does not get there
ForkPoint go_to_fork(RenderJob& job, sim::Simulation& simulation, Progress& progress);

}  // namespace neve::app::run
