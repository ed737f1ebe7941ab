#pragma once
/// Checkpoints of a run, and resuming from them.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/picture/plots.h"
#include "app/run/picture_record.h"
#include "app/run/run_json.h"
#include "app/support/progress.h"
#include "sim/simulation.h"

namespace neve::app::run {

/// A run as it was when the checkpoint was written.
struct ResumedRun {
  int frame = 0;                             ///< the last one that was reached
  sim::AdvanceReport advance;                ///< steps taken since then
  std::vector<picture::PlotSample> history;  ///< of all frames reached
  std::vector<sim::Retry> retries;           ///< so far
  std::vector<FrameRecord> frames;           ///< that run.json lists
};

class Checkpoints {
 public:
  /// @param picture of any view and frame: its record makes the run again
  /// @param player  of the changes that the picture lists
  Checkpoints(std::filesystem::path folder, const PictureRecord& picture,
              sim::Simulation& simulation, ChangePlayer& player, Progress& progress);

  /// @param advance steps since the frame
  /// @throws IoError
  void write(int frame, const sim::AdvanceReport& advance,
             std::span<const picture::PlotSample> history, std::span<const sim::Retry> retries);

  /// Brings the simulation to the newest checkpoint that is whole; damaged ones are named and
  /// passed over. Nothing without a checkpoint: the run starts at its beginning.
  /// @throws UsageError when the run in the folder is another one
  std::optional<ResumedRun> resume();

 private:
  std::filesystem::path folder_;
  PictureRecord picture_;
  std::string identity_;
  sim::Simulation& simulation_;
  ChangePlayer& player_;
  Progress& progress_;
};

}  // namespace neve::app::run
