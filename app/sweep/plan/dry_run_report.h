#pragma once
/// `neve sweep --dry-run`: the runs, their time and their memory.

#include "app/sweep/plan/refinement.h"
#include "app/sweep/plan/sweep_plan.h"

namespace neve::app::sweep::plan {

/// Prints the plan on stdout; measures some steps of the costliest run to foresee seconds.
/// @param refinement  points that are made at full resolution as well, counted apart
/// @param rounds      of a search, each of so many runs
void print_sweep_plan(const SweepPlan& plan, const Refinement& refinement, int rounds, int cores,
                      bool is_json);

}  // namespace neve::app::sweep::plan
