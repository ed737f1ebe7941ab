#pragma once
/// Plan of a sweep: the scene, the cost and the order of every run.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/forecast/fast.h"
#include "app/run/render_job.h"
#include "app/setup/plan.h"
#include "app/sweep/read/sweep.h"

namespace neve::app::sweep::plan {

struct SweepOptions;

/// Bytes that the process of a run takes before it has a particle: program, GL driver, shaders.
/// Measured with a software renderer: a run that was planned with 22 MiB peaked at 93 MiB; others
/// took 75 to 100 MiB.
constexpr std::uint64_t program_memory = std::uint64_t{80} << 20;

/// A run and its scene.
struct PlannedRun {
  Run run;
  scene::Scene scene;  ///< with the shared camera and ranges once these were found
  setup::Plan plan;
};

/// A point of the sweep once more, with cells of another size.
struct PlannedVariant {
  std::size_t of = 0;  ///< the run that it is at full resolution; of a copy the first of the point
  double coarsening = 1;
  PlannedRun item;
  std::string failure;  ///< why there can be none, a sentence; the item is empty then
};

struct SweepPlan {
  read::Sweep sweep;
  std::filesystem::path folder;
  std::string title;
  std::string view;   ///< that the tiles show
  scene::Scene base;  ///< with the fixed settings alone
  std::vector<PlannedRun> runs;
  /// Coarse copies for predictions, then runs at full resolution; their numbers follow those of the
  /// runs.
  std::vector<PlannedVariant> variants{};
  double coarsening = 1;  ///< of the runs
  /// Common starts of forked runs, one for each seed, up to the last frame before the fork; none
  /// without a fork. The frames and the work of the runs begin after them.
  std::vector<PlannedRun> beginnings{};
  const PlannedRun& beginning_of(const Run& run) const {
    return beginnings[static_cast<std::size_t>(run.index) % beginnings.size()];
  }
  /// The run or picture in which the beginning is found; without it is simulated from the start.
  std::optional<run::RenderJob> source;
  bool keeps_states = false;
  /// Tiles have legends of their own, because the sheet's one is not that of all runs.
  bool have_tiles_legends = false;
  setup::Quality quality = setup::Quality::preview;
  int columns = -1, rows = -1;  ///< axes of the sheet that were asked for; -1: automatic
  double fork = 0;              ///< s, the time of the fork
  std::optional<forecast::FastLook>
      fast;  ///< of --fast; its overrides are among the fixed settings
};

/// Reads the scene of every run; starts nothing.
/// @throws SceneError, UsageError, LimitError, sim::ShapeError
SweepPlan plan_sweep(const SweepOptions& options);

/// Plans a run at full resolution for each seed of these points, among the variants, with the
/// camera and ranges that all runs share.
/// @param points  their first runs
void add_full_runs(const SweepOptions& options, const std::vector<std::size_t>& points,
                   SweepPlan& plan);

/// The work of a point with cells coarsened so, over that of its run.
double work_ratio(const SweepPlan& plan, double coarsening);

/// Values on each axis.
std::vector<int> axis_sizes(const SweepPlan& plan);

/// ", 4 seeds of each point", "" without seeds.
std::string seeds_text(const read::Sweep& sweep);

/// The place of each run among the seeds of its point; see coarse_first().
std::vector<int> draws_of(const SweepPlan& plan);

/// Estimates the bytes on disk if the states of all drawn frames of a run, or of all runs and their
/// variants, are kept.
double bytes_of_states(const PlannedRun& item);
double bytes_of_states(const SweepPlan& plan);

}  // namespace neve::app::sweep::plan
