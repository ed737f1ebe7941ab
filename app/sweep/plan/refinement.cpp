#include "app/sweep/plan/refinement.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "app/support/progress.h"
#include "app/sweep/plan/selection.h"

namespace neve::app::sweep::plan {

namespace {

std::size_t place(int run) {
  return static_cast<std::size_t>(run);
}

/// First run of the point of a run. @param seeds  runs of each point
int point_of(int run, int seeds) {
  return run - run % seeds;
}

/// Returns the points of these runs, in order.
std::vector<int> points_of_runs(const std::vector<int>& runs, int seeds) {
  std::set<int> points;
  for (const int run : runs) points.insert(point_of(run, seeds));
  return {points.begin(), points.end()};
}

/// Plans the runs at full resolution of the named points, and of the point whose coarse runs are
/// the largest, as if all that may be chosen were like it.
void take_needs(const SweepOptions& options, SweepPlan plan, Refinement& refinement) {
  std::vector<std::size_t> points;
  for (const int run : refinement.named) points.push_back(place(run));
  if (refinement.chosen > 0) {
    const auto largest =
        std::max_element(plan.runs.begin(), plan.runs.end(),
                         [](const auto& a, const auto& b) { return a.run.memory < b.run.memory; });
    points.push_back(place(point_of(largest->run.index, plan.sweep.runs_per_point())));
  }
  plan.variants.clear();
  add_full_runs(options, points, plan);
  for (std::size_t k = 0; k < plan.variants.size(); ++k) {
    const PlannedRun& full = plan.variants[k].item;
    const bool is_like_chosen = k % points.size() >= refinement.named.size();
    refinement.memory = std::max(refinement.memory, full.run.memory);
    refinement.state_bytes += (is_like_chosen ? refinement.chosen : 1) * bytes_of_states(full);
  }
}

}  // namespace

Refinement refinement_of(const SweepOptions& options, const SweepPlan& plan) {
  const int seeds = plan.sweep.runs_per_point();
  Refinement refinement;
  if (!options.refine_runs.empty())
    refinement.named = points_of_runs(
        parse_selection("--refine-runs", options.refine_runs, plan.runs.back().run.index), seeds);
  refinement.chosen = std::min(options.refine, static_cast<int>(plan.runs.size()) / seeds);
  if (options.is_dry_run && refinement.is_wanted()) take_needs(options, plan, refinement);
  return refinement;
}

RefinementCost cost_of(const Refinement& refinement, const SweepPlan& plan,
                       const SweepForecast& forecast) {
  const int seeds = plan.sweep.runs_per_point();
  const std::set<int> named(refinement.named.begin(), refinement.named.end());
  std::set<int> others;
  double of_all = 0, of_named = 0;
  std::size_t counted = 0;
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    const int point = point_of(plan.runs[k].run.index, seeds);
    const double seconds = forecast.seconds(k).expected;
    of_all += seconds;
    if (named.contains(point)) {
      of_named += seconds;
      ++counted;
    } else {
      others.insert(point);
    }
  }
  const double mean = of_all / static_cast<double>(std::max<std::size_t>(1, plan.runs.size()));
  RefinementCost cost;
  const int chosen = std::min(refinement.chosen, static_cast<int>(others.size()));
  cost.points = static_cast<int>(named.size()) + chosen;
  cost.runs = cost.points * seeds;
  // Runs of --only that are omitted cost as most.
  const double unknown = cost.runs - static_cast<double>(counted);
  cost.seconds = work_ratio(plan, 1) * (of_named + mean * unknown);
  return cost;
}

std::string refinement_text(const Refinement& refinement, const SweepPlan& plan,
                            const SweepForecast& forecast, int cores) {
  const RefinementCost cost = cost_of(refinement, plan, forecast);
  const bool is_one = cost.points == 1,
             has_both = refinement.chosen > 0 && !refinement.named.empty();
  std::string text = fmt::format("then {}{} {} at full resolution", has_both ? "at most " : "",
                                 cost.points, is_one ? "point" : "points");
  if (!refinement.named.empty())
    text += fmt::format(", {} {} {}", has_both ? "with" : "of",
                        refinement.named.size() == 1 ? "run" : "runs",
                        fmt::join(refinement.named, ", "));
  if (cost.runs > cost.points) text += fmt::format(", {} runs with their seeds", cost.runs);
  if (forecast.seconds_per_work > 0)
    text += fmt::format(", about {} more", duration_text(cost.seconds / cores));
  if (refinement.chosen > 0) text += is_one ? " if it costs as most" : " if they cost as most";
  return text;
}

}  // namespace neve::app::sweep::plan
