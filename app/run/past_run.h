#pragma once
/// A run that exists, as a source of states.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/record/run_json.h"
#include "app/run/changes.h"
#include "app/run/resumed_run.h"
#include "app/support/progress.h"
#include "sim/simulation.h"

namespace neve::app::run {

struct RenderJob;
struct RenderOptions;

struct PastRun {
  std::filesystem::path folder;             ///< empty: there is no such run
  std::vector<record::FrameRecord> frames;  ///< that it lists
};

/// True for the path of a folder that exists.
bool is_folder(const std::string& path);

/// The job of the run in a folder, from its run.json.
/// @throws UsageError for flags that would make another run; Error for a broken run.json
RenderJob job_from_run(const RenderOptions& options);

/// The newest checkpoint of a run that is not later than a time, for a program and instructions
/// that make the same bits.
std::optional<ResumedRun> checkpoint_before(const PastRun& past, double time, double fps,
                                            const sim::Simulation& simulation);

/// Brings a simulation and its player to a checkpoint.
/// @throws IoError when no healthy run has such a state
void go_to_checkpoint(const ResumedRun& checkpoint, double fps, ChangePlayer& player,
                      sim::Simulation& simulation);

/// Warns where a frame that a run lists has another state than the same frame made now.
void compare_with_past(const PastRun& past, int frame, std::uint64_t hash, Progress& progress);

}  // namespace neve::app::run
