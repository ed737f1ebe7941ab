#pragma once
/// Checkpoints of a run, and resuming from them.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/record/picture_record.h"
#include "app/run/resumed_run.h"
#include "app/support/progress.h"
#include "sim/simulation.h"

namespace neve::app::run {

/// The way back into a run.
struct Resumption {
  ResumedRun run;
  /// Frames before its checkpoint with pictures that are missing or damaged, in order. They are
  /// made again first: from `repair` on, or from the start without one.
  std::vector<int> flawed;
  std::optional<ResumedRun> repair;
};

class Checkpoints {
 public:
  /// @param picture of any view and frame: its record makes the run again
  /// @param player  of the changes that the picture lists
  Checkpoints(std::filesystem::path folder, const record::PictureRecord& picture,
              sim::Simulation& simulation, ChangePlayer& player, Progress& progress);

  /// @param advance steps since the frame
  /// @throws IoError
  /// @param record of the run so far: its frames and files are kept too
  void write(int frame, const sim::AdvanceReport& advance,
             std::span<const picture::PlotSample> history, const record::RunRecord& record);

  /// Finds the newest checkpoint that is whole; damaged ones are named and passed over. Compares
  /// the pictures up to it with the run's own list. Nothing without a checkpoint: the run starts at
  /// its beginning.
  /// @param record  of this run, for the views that have pictures @param frames  that are to have
  /// some
  /// @throws UsageError when the run in the folder is another one
  std::optional<Resumption> find(const record::RunRecord& record, setup::FrameRange frames);

  /// Brings the simulation to a checkpoint that was found.
  /// @throws IoError when no healthy run has such a state
  void go_to(const ResumedRun& run);

 private:
  void check_identity(const output::Checkpoint& checkpoint);

  std::filesystem::path folder_;
  record::PictureRecord picture_;
  std::string identity_;
  sim::Simulation& simulation_;
  ChangePlayer& player_;
  Progress& progress_;
};

}  // namespace neve::app::run
