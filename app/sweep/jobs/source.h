#pragma once
/// The common beginning of runs that leave a run or a picture that is there.

#include <filesystem>

#include "app/support/progress.h"
#include "app/sweep/plan/sweep_plan.h"
#include "app/sweep/store/manifest.h"

namespace neve::app::sweep::jobs {

/// Brings the run of plan.source to the time at which the runs part, from its newest checkpoint
/// that is early enough or from its start, and writes that moment into DIR/beginning, unless it is
/// there.
/// @throws IoError, UsageError, Error when the run does not get there
void take_beginning(const plan::SweepPlan& plan, const store::Beginning& beginning, int threads,
                    Progress& progress);

}  // namespace neve::app::sweep::jobs
