#pragma once
/// Points of a coarse sweep that are made at full resolution once its runs have ended, and their
/// cost.

#include <cstddef>
#include <string>
#include <vector>

#include "app/sweep/plan/sweep_forecast.h"
#include "app/sweep/plan/sweep_options.h"
#include "app/sweep/plan/sweep_plan.h"

namespace neve::app::sweep::plan {

struct Refinement {
  std::vector<int> named{};  ///< first runs of the points of --refine-runs
  int chosen = 0;            ///< points of --refine: which, is known when all runs have ended
  double memory = 0;         ///< bytes, of the largest run that may be among them
  double state_bytes = 0;    ///< on disk, of all of them at most, where states are kept

  bool is_wanted() const { return chosen > 0 || !named.empty(); }
};

/// Returns what --refine and --refine-runs ask for, never more points than the sweep has.
/// @throws UsageError for a run that there is not
Refinement refinement_of(const SweepOptions& options, const SweepPlan& plan);

struct RefinementCost {
  int points = 0;      ///< at most: a point that is named may be among the chosen
  int runs = 0;        ///< with all seeds
  double seconds = 0;  ///< of one thread; chosen points are taken to cost as the mean of all
};
/// @param plan  its runs, or those of them that are wanted
RefinementCost cost_of(const Refinement& refinement, const SweepPlan& plan,
                       const SweepForecast& forecast);

/// "then 2 points at full resolution, 8 runs with their seeds, about 3 min more if they cost as
/// most"
std::string refinement_text(const Refinement& refinement, const SweepPlan& plan,
                            const SweepForecast& forecast, int cores);

}  // namespace neve::app::sweep::plan
