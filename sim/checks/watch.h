#pragma once
/// Checks at run time: laws of every correct step, measured between steps. A measurement takes a
/// staged step of a copy, so it never changes the run.

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "sim/health/limits.h"
#include "sim/simulation.h"
#include "sim/types/energy_account.h"
#include "sim/types/settings.h"

namespace neve::sim::checks {

/// The laws that are watched, the first ones of the table.
using WatchCheck = health::Law;
inline constexpr int watch_check_count = health::watched_laws;
using health::meaning;
using health::name;
using health::quantity;

/// Values of one measurement, by check; 0 if a check had no data.
struct WatchValues {
  std::array<double, watch_check_count> value{};
  double& operator[](WatchCheck check) { return value[static_cast<std::size_t>(check)]; }
  double operator[](WatchCheck check) const { return value[static_cast<std::size_t>(check)]; }
};

/// The history of one check.
struct WatchRecord {
  WatchCheck check;
  bool is_below = false;       ///< broken below its thresholds, not above
  double threshold = 0;        ///< worth a warning
  double error = 0;            ///< wrong; infinite for checks that only warn
  double worst = 0;            ///< found so far
  std::size_t times = 0;       ///< looks that broke the threshold
  std::size_t errors = 0;      ///< looks that broke the error level
  std::size_t first_step = 0;  ///< where it was broken first, with times > 0
  double first_time = 0;       ///< s

  bool breaks(double value, double limit) const;
};

/// One line for the user: step, value, threshold, meaning and remedy.
std::string sentence(const WatchRecord& record, double value, double dt);

/// Steps between two looks of a long run. A look costs about as much as 25 steps on one thread (a
/// staged step, copies, stress and energy in double), and is not shared among threads: so this
/// keeps it near a tenth of the run, a fifth on two threads.
inline constexpr std::size_t watch_interval = 256;

/// True if the state after `steps` steps is measured: the first ones, where wrong numbers show at
/// once, then fewer and fewer down to the interval.
bool is_watch_due(std::size_t steps);

class Watch {
 public:
  Watch(const SolverSettings& settings, const std::vector<Material>& materials);

  /// Continues with the settings that Simulation::apply changed. Earlier findings stay.
  void use(const SolverSettings& settings, const std::vector<Material>& materials);

  /// Looks at the state as it is and at the step that would come next.
  /// @return one sentence for each check that was broken for the first time
  std::vector<std::string> look(const Simulation& simulation);

  /// Measures as look() does, without recording.
  WatchValues measure(const Simulation& simulation) const;

  std::size_t looks() const { return looks_; }
  const std::vector<WatchRecord>& records() const { return records_; }
  /// True if a value was beyond its error level.
  bool has_errors() const;

 private:
  SolverSettings settings_;
  std::vector<Material> materials_;
  std::vector<WatchRecord> records_;
  std::size_t looks_ = 0;
};

}  // namespace neve::sim::checks
