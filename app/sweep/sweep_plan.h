#pragma once
/// What a sweep will do: the scene of every run, what it costs, and in which order they start.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/plan.h"
#include "app/sweep/sweep.h"

namespace neve::app {

struct SweepOptions;

struct RunPlan {
  PlannedRun run;
  Scene scene;  ///< with the shared camera and ranges once these were found
  FrameRange frames;
  Plan plan;
  double work = 0;  ///< particles times foreseen steps: costs in proportion
};

struct SweepPlan {
  Sweep sweep;
  std::filesystem::path folder;
  std::string title;
  std::string view;  ///< that the tiles show
  Scene base;        ///< with the fixed settings alone
  std::vector<RunPlan> runs;
};

/// Reads the scene of every run; starts nothing.
/// @throws SceneError, UsageError, LimitError, sim::ShapeError
SweepPlan plan_sweep(const SweepOptions& options);

/// Particles times steps that the limits on dt allow snow at rest that then meets the ground.
double foreseen_work(const Scene& scene, const Plan& plan);

}  // namespace neve::app
