#pragma once
/// `neve render --validate`: checks of the laws during a run, and their summary at its end.

#include <string>
#include <vector>

#include "app/support/progress.h"
#include "sim/checks/watch.h"

namespace neve::app::run {

class Validation {
 public:
  /// @param simulation, progress outlive it
  Validation(const sim::SolverSettings& settings, const std::vector<sim::Material>& materials,
             const sim::Simulation& simulation, Progress& progress);

  /// Continues with settings that were changed between steps.
  void use(const sim::SolverSettings& settings, const std::vector<sim::Material>& materials) {
    watch_.use(settings, materials);
  }

  /// Between steps: looks if it is time to, and warns of laws that were broken for the first time.
  void after_step();

  const std::vector<sim::checks::WatchRecord>& records() const { return watch_.records(); }
  /// Something is wrong, not only worth a warning.
  bool has_errors() const { return watch_.has_errors(); }
  bool has_held() const;

  /// "validation: 19 checks at 12 steps, all held", or which did not.
  std::string summary() const;

 private:
  const sim::Simulation& simulation_;
  Progress& progress_;
  sim::checks::Watch watch_;
};

}  // namespace neve::app::run
