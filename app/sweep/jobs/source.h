#pragma once
/// The common beginning of runs that fork from an existing run or picture.

#include <filesystem>

#include "app/support/progress.h"
#include "app/sweep/plan/sweep_plan.h"
#include "app/sweep/store/manifest.h"

namespace neve::app::sweep::jobs {

/// Brings the run of plan.source to the time of the fork, from its newest checkpoint that is early
/// enough or from its start, and writes that moment into DIR/beginning, unless it exists.
/// @throws IoError, UsageError, Error when the run does not get there
void take_beginning(const plan::SweepPlan& plan, const store::Beginning& beginning, int threads,
                    Progress& progress);

}  // namespace neve::app::sweep::jobs
