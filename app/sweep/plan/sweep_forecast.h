#pragma once
/// Forecast of the cost of each run of a sweep, by coarse copies of the runs.

#include <cstddef>
#include <string>
#include <vector>

#include "app/forecast/forecast.h"
#include "app/sweep/plan/sweep_plan.h"

namespace neve::app::sweep::plan {

/// Bounds the cost of a forecast, in steps of a particle: these are the same on every machine.
struct ForecastEffort {
  double particle_steps = 0;  ///< of all copies
};

/// Returns the effort for --dry-run: tens of seconds where a sweep has many runs.
ForecastEffort whole_effort(int cores);

/// Returns the effort before a sweep starts: about three per cent of its cost, and seconds at most.
/// @param chosen  runs that will be made, by their places in the plan
ForecastEffort small_effort(const SweepPlan& plan, const std::vector<std::size_t>& chosen,
                            int cores);

/// Costs are in explicit steps of one particle.
struct SweepForecast {
  std::vector<forecast::Cost> work;  ///< of every run of the plan, after the common beginning
  std::vector<double> drawing;       ///< s, of its tiles and of the start of its process
  forecast::Cost beginning;          ///< of all common beginnings, unless taken from a run
  double seconds_per_work = 0;       ///< s of one thread on this machine, now; 0: not known
  std::vector<std::size_t> own;      ///< runs with a copy of their own

  /// Returns the time of a run on one thread.
  forecast::Cost seconds(std::size_t run) const;
  /// A cost by which runs are put in order: of drawing, too, as on a usual machine, so that it is
  /// the same on each.
  double cost(std::size_t run) const;
  /// Returns the time to the end of all of these runs, if long ones start first.
  forecast::Cost seconds_of_all(const std::vector<std::size_t>& chosen, int cores) const;
};

/// Copies as many of the chosen runs as the effort allows, ends of axes first. Any other run is
/// taken to cost as the copied one that is nearest to it, in proportion to the steps that both take
/// at rest. An interrupt leaves the forecast of snow at rest.
SweepForecast foresee_sweep(const SweepPlan& plan, const std::vector<std::size_t>& chosen,
                            const ForecastEffort& effort, int cores);

/// "the longest: run 4, 3 min; run 7, 2 min; most take about 20 s": those that take much longer
/// than most, "" without.
std::string longest_text(const SweepPlan& plan, const std::vector<std::size_t>& chosen,
                         const SweepForecast& forecast);

/// The forecast in one or two lines, for a sweep that starts. @param budget  s; 0: none
std::string forecast_text(const SweepPlan& plan, const std::vector<std::size_t>& chosen,
                          const SweepForecast& forecast, int cores, double budget);

/// True of a run that no limit of its scene refuses.
bool is_possible(const PlannedRun& item);

}  // namespace neve::app::sweep::plan
