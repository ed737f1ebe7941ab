#pragma once
/// The rules of a healthy run: checked after every step; a broken one stops the run.

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/state/progress.h"
#include "sim/types/energy_account.h"
#include "sim/types/particle_arrays.h"
#include "sim/types/reports.h"
#include "sim/types/settings.h"

namespace neve::sim::engine {

/// Extremes over all particles and nodes of a step.
struct StepReport {
  double max_speed = 0, max_sound_speed = 0;  ///< m/s
  double max_strain_rate = 0;                 ///< 1/s
  double min_J_P = 1, max_J_P = 1;
  double contact_work = 0;  ///< J
  std::uint32_t inverted = 0, inverted_unprojected = 0, not_finite = 0, overflowed = 0;
};

/// A rule that a step broke.
struct BrokenRule {
  const char* rule;
  const char* stage;
  double dt, dt_that_holds;  ///< s; of the step, and the largest that speed and sound allowed
  double value, limit;
};

class HealthWatch {
 public:
  StartState start;  ///< of the particles that the run was given

  /// Particles are summed this often, and whenever a frame ends.
  static constexpr std::uint64_t steps_between_sums = 256;

  /// Sets the limit that rules the next step; its record says so.
  void set_limit(DtLimit limit) { limit_ = limit; }

  /// Updates the limits of the next dt, warnings and the record of last steps.
  /// @param stretch  acoustic_stretch of the step, which may be an explicit one in place of another
  /// @return the rule that the step of dt broke, the first one of a run
  std::optional<BrokenRule> check_step(const SolverSettings& settings, double dt, double stretch,
                                       const StepReport& report, Progress& progress);

  /// Kinetic plus elastic energy may exceed the energy at the start plus the work of gravity and
  /// colliders only by the share that the law of energy allows, and only so much of the snow may be
  /// packed to the limit.
  std::optional<BrokenRule> check_sums(const SolverSettings& settings, const Summary& now,
                                       Progress& progress) const;

  /// Ends the run with a report about the rule, its culprits and the last steps.
  void diverge(const BrokenRule& broken, const Progress& progress, const SolverSettings& settings,
               const std::vector<Material>& materials, const ParticleArrays& particles);

  /// True if the run continues past the rule, which is noted for its pictures and records.
  static bool may_ignore(const BrokenRule& broken, const SolverSettings& settings,
                         Progress& progress);

  /// A run that is restored has neither diverged nor a history.
  void forget();

  const std::optional<Divergence>& divergence() const { return divergence_; }

 private:
  void record_step(double dt, const StepReport& report, const Progress& progress);
  std::vector<StepRecord> last_steps(std::uint64_t step) const;

  DtLimit limit_ = DtLimit::fixed;
  std::vector<StepRecord> ring_;  ///< step n is at n modulo its size
  std::optional<Divergence> divergence_;
};

/// Energy that the run has, and that gravity and colliders explain.
EnergyAccount energy_account(const SolverSettings& settings, const Progress& progress,
                             const Summary& now);

/// Returns the moment of a budget, kg m, see EnergyBudget.
inline Vec3d moment_of(const EnergyBudget& budget) {
  return Vec3d::Map(budget.moment.data());
}

}  // namespace neve::sim::engine
