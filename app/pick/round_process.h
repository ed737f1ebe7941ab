#pragma once
/// The runs of a round, made by `neve sweep` in a process of its own, so that a screen stays
/// responsive meanwhile.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/sweep/jobs/child.h"
#include "app/sweep/plan/sweep_options.h"

namespace neve::app::pick {

/// The words after `neve` that make these runs.
std::vector<std::string> round_arguments(const sweep::plan::SweepOptions& options);

/// The process ends with this object. One thread starts it, asks for it and ends it.
class RoundProcess {
 public:
  /// Starts it; all it says goes to DIR/round.log. @throws IoError
  explicit RoundProcess(const sweep::plan::SweepOptions& options);

  /// @return exit code, once it has ended
  std::optional<int> poll();
  /// Asks it to end: runs that are not finished continue the next time. poll() tells when.
  void stop() { child_.stop(); }

  /// True once the folder has the runs of this round, finished or not.
  bool has_begun() const;

  /// The error that it ended with; "" without one.
  std::string error() const;

 private:
  std::filesystem::path folder_;
  std::filesystem::file_time_type before_;  ///< time of the manifest of the round before
  sweep::jobs::Child child_;
  std::optional<int> code_;
};

}  // namespace neve::app::pick
