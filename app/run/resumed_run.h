#pragma once
/// A run as a checkpoint holds it, with every number checked: a right checksum only says that
/// nobody changed the file by accident.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "app/output/checkpoint.h"
#include "app/picture/plots.h"
#include "app/record/run_json.h"
#include "sim/retry.h"
#include "sim/simulation.h"

namespace neve::app::run {

/// A run as it was when the checkpoint was written.
struct ResumedRun {
  std::filesystem::path file;
  int frame = 0;  ///< the last one that was reached
  std::size_t steps = 0;
  std::vector<std::uint8_t> state;           ///< of the simulation; empty: as the newest checkpoint
  sim::AdvanceReport advance;                ///< steps taken since then
  std::vector<picture::PlotSample> history;  ///< of all frames reached
  std::vector<sim::Retry> retries;           ///< so far
  /// That the run has made, with the hashes of its files. Those up to the checkpoint are from it,
  /// so that a damaged run.json loses none.
  std::vector<record::FrameRecord> frames;
  record::FileHashes files;
  Json exports = Json::array();  ///< as run.json lists them
};

/// The state of a simulation at the end of a frame, without the progress of its run.
output::Checkpoint checkpoint_of(const sim::Simulation& simulation, int frame,
                                 const std::string& identity);

/// The part of a checkpoint beside the state of the simulation.
Json progress_json(int frame, const sim::AdvanceReport& advance,
                   std::span<const picture::PlotSample> history, const record::RunRecord& record);

/// @throws IoError that names the value that no run has written
ResumedRun read_resumed_run(const output::Checkpoint& checkpoint);

/// Brings a simulation to the state of a checkpoint of this frame.
/// @throws std::runtime_error when no healthy run has such a state, or at another time
void restore_frame(const ResumedRun& run, double fps, sim::Simulation& simulation);

/// @param file  that cannot be used, whatever its checksum says
[[noreturn]] void refuse_checkpoint(const std::filesystem::path& file, const std::exception& why);

}  // namespace neve::app::run
