#pragma once
/// A sweep that forks from the shown frame: `neve sweep --from`, in a process of its own.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/sweep/jobs/background.h"
#include "app/sweep/store/manifest.h"
#include "app/timeline/moment.h"

namespace neve::app::view::session {

/// A parameter and its values, as -p takes them: "5, 10, 20".
struct SweepAxis {
  std::string address, values;
};

struct SweepRequest {
  std::vector<SweepAxis> axes;
  int last_frame = 0;
  bool has_longer_steps = false;  ///< of forecast::longer_steps, for a quick look
};

/// The folder, the cores and the backend that the view was started with, also for its sweeps.
struct SweepPlace {
  std::filesystem::path folder;  ///< of the view
  int threads = 0;               ///< cores in all; 0: as many as there are
  std::string backend = "auto";  ///< that draws
};

/// State of a sweep, and its files.
struct ViewSweepProgress {
  enum class State { none, running, done, stopped, failed };
  State state = State::none;
  int runs = 0, ok = 0, failed = 0;
  double share = 0;  ///< of the frames of all runs, 0 to 1
  std::string error;
  std::filesystem::path folder;  ///< of the sweep
  std::string command;           ///< that makes it again, or continues it

  std::filesystem::path sheet() const { return folder / "sheet.png"; }
  std::filesystem::path report() const { return folder / "report.html"; }
};

class ViewSweep {
 public:
  /// @param program  whose `sweep` makes the runs
  explicit ViewSweep(std::filesystem::path program) : program_(std::move(program)) {}

  /// Writes the moment and starts the sweep beside it, in a new folder.
  /// @param run  of the moment, with its scene and changes
  /// @throws UsageError for parameters or values that cannot be varied there, with those that can;
  ///         IoError
  void start(const SweepPlace& place, record::RunRecord run, timeline::Moment moment, double fps,
             const SweepRequest& request, const std::vector<std::string>& longer_steps);

  /// Looks how far it is, a few times a second. @return whether something is new
  bool poll();

  /// Asks the sweep to end; its files stay, and the command continues from there.
  void stop();

  /// Packs the sweep into one file beside its folder: the report with all pictures that it shows.
  /// @throws IoError
  std::filesystem::path pack() const;

  const ViewSweepProgress& progress() const { return progress_; }
  bool is_running() const { return progress_.state == ViewSweepProgress::State::running; }

 private:
  void look();
  void end(int code);

  std::filesystem::path program_;
  ViewSweepProgress progress_;
  std::optional<sweep::jobs::BackgroundSweep> sweep_;
  sweep::jobs::Child::Clock::time_point looked_at_{};
};

}  // namespace neve::app::view::session
