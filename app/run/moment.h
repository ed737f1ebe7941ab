#pragma once
/// A moment of a run as a folder of its own, from which forks and studies start: run.json with the
/// scene and the changes so far, and one checkpoint.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "app/record/run_json.h"
#include "app/run/changes.h"
#include "app/run/render_job.h"
#include "app/run/resumed_run.h"

namespace neve::app::run {

struct Moment {
  record::RunRecord record;  ///< without frames; its changes are those made until then
  int frame = 0;             ///< the last one that was passed
  std::size_t steps = 0;
  sim::AdvanceReport advance;                ///< since that frame
  std::vector<picture::PlotSample> history;  ///< of all frames, 0 to this one
  std::vector<sim::Retry> retries;           ///< so far
  std::vector<std::uint8_t> state;           ///< sim::Simulation::save
};

/// The moment that walk_to_fork() has brought a simulation to.
/// @param job  with a resolved scene
Moment moment_of(const RenderJob& job, const ResumedRun& run, const ChangePlayer& player,
                 const sim::Simulation& simulation);

/// Checkpoints that the folder had are removed. @throws IoError
void write_moment(const std::filesystem::path& folder, const Moment& moment);

}  // namespace neve::app::run
