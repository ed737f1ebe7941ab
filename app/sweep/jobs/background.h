#pragma once
/// A `neve sweep` in a process of its own, so that a screen stays responsive meanwhile.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/support/progress.h"
#include "app/sweep/jobs/child.h"
#include "app/sweep/plan/sweep_options.h"
#include "app/sweep/store/manifest.h"
#include "app/sweep/store/store.h"

namespace neve::app::sweep::jobs {

/// A run as it is on disk.
struct RunProgress {
  store::RunState state = store::RunState::pending;
  std::string reason;  ///< of a failed run, in few words
  int frames = 0;      ///< of the whole run
  int made = 0;        ///< pictures that exist, from the first on

  bool has_ended() const { return store::is_finished(state); }
  bool has_failed() const { return store::has_failed(state); }
};

struct SweepProgress {
  store::Manifest manifest;
  std::vector<RunProgress> runs;

  RunCounts counts() const;
  bool have_all_ended() const { return !runs.empty() && counts().finished == counts().all; }
  /// @return share of the frames of all runs that are done, 0 to 1
  double share() const;
};

/// Reads how far the runs in the folder of a sweep are. @throws Error where it has none
SweepProgress progress_of(const std::filesystem::path& folder);

/// The process ends with this object. One thread starts it, asks for it and ends it.
class BackgroundSweep {
 public:
  /// Starts it. @param log  takes all it says, one JSON object a line @param grace  s that it has
  /// to end when it is asked to @throws IoError
  BackgroundSweep(plan::SweepOptions options, const std::filesystem::path& program,
                  const std::filesystem::path& log, double grace);

  /// @return exit code, once it has ended
  std::optional<int> poll();
  /// Asks the sweep to end: the same command continues with the runs that are not finished.
  void stop() { child_.stop(); }

  /// Reads how far it is. @return empty before the folder has the runs of these options @throws
  /// Error
  std::optional<SweepProgress> progress() const;
  /// The error that it ended with; "" without one.
  std::string error() const;

 private:
  std::filesystem::path folder_, log_;
  std::filesystem::file_time_type before_;  ///< time of the manifest of an earlier sweep
  Child child_;
  std::optional<int> code_;
};

}  // namespace neve::app::sweep::jobs
