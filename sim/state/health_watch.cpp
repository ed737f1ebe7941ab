#include "sim/state/health_watch.h"

#include <algorithm>
#include <string_view>

#include "sim/health/diagnostics.h"
#include "sim/health/limits.h"

namespace neve::sim::engine {

namespace {

using health::Law;

/// Steps that a report of trouble looks back.
constexpr std::size_t steps_recorded = 64;
/// Cells that a particle may cross in a step while rules are ignored: faster, the next step takes
/// for ever, and there is nothing to see.
constexpr double hopeless_cells = 100;

/// The first rule of a healthy step that its own report says is broken.
/// @param before  limits that the dt of the step was chosen by
std::optional<BrokenRule> broken_rule(const SolverSettings& settings, double dt, double stretch,
                                      const StateLimits& before, const StepReport& report,
                                      Progress& progress) {
  const double h = settings.cell_size;
  const double speed_cfl = progress.limits.max_speed * dt / h;
  // The CFL number is that of an explicit step.
  const double acoustic_cfl = progress.limits.max_sound_speed * dt / h / stretch;
  double& worst_cfl = progress.warnings.worst_acoustic_cfl;
  worst_cfl = std::max(worst_cfl, acoustic_cfl);
  const bool is_adaptive = settings.time_step == TimeStep::adaptive;
  const auto broken = [&](const char* rule, const char* stage, double value, double limit) {
    return BrokenRule{rule, stage, dt, stable_dt(settings, before), value, limit};
  };
  const auto stop = [](Law law) { return health::limits_of(law).stop; };
  const auto next_dt = [&] {
    return choose_dt(settings, progress.limits, 1, progress.dt_scale).dt;
  };
  if (report.not_finite > stop(Law::not_finite))
    return broken("not_finite", "deformation", report.not_finite, stop(Law::not_finite));
  if (report.overflowed > stop(Law::overflow))
    return broken("overflow", "advection", report.overflowed, stop(Law::overflow));
  if (speed_cfl > stop(Law::speed_cfl))
    return broken("speed_cfl", "particle_velocities", speed_cfl, stop(Law::speed_cfl));
  if (report.inverted_unprojected > stop(Law::inverted))
    return broken("inverted", "deformation", report.inverted_unprojected, stop(Law::inverted));
  if (report.min_J_P < stop(Law::compaction))
    return broken("J_P", "deformation", report.min_J_P, stop(Law::compaction));
  if (is_adaptive && acoustic_cfl > stop(Law::acoustic_cfl))
    return broken("acoustic_cfl", "deformation", acoustic_cfl, stop(Law::acoustic_cfl));
  if (is_adaptive && next_dt() < stop(Law::time_step) * progress.rest_dt)
    return broken("time_step", "deformation", next_dt(), stop(Law::time_step) * progress.rest_dt);
  return std::nullopt;
}

}  // namespace

std::optional<BrokenRule> HealthWatch::check_step(const SolverSettings& settings, double dt,
                                                  double stretch, const StepReport& report,
                                                  Progress& progress) {
  const StateLimits before = progress.limits;
  progress.limits.max_speed = report.max_speed;
  progress.limits.max_sound_speed = report.max_sound_speed;
  progress.limits.max_strain_rate = report.max_strain_rate;
  progress.warnings.inverted_trials += report.inverted;
  progress.warnings.least_J_P = std::min(progress.warnings.least_J_P, report.min_J_P);
  // Stages that are skipped leave nodes without velocities.
  if (settings.bypass.empty()) progress.energy.contact_work += report.contact_work;
  progress.last_dt = dt;
  record_step(dt, report, progress);
  if (divergence_) return std::nullopt;
  return broken_rule(settings, dt, stretch, before, report, progress);
}

void HealthWatch::record_step(double dt, const StepReport& report, const Progress& progress) {
  ring_.resize(steps_recorded);
  ring_[progress.steps % steps_recorded] = {progress.steps,
                                            progress.time,
                                            dt,
                                            limit_,
                                            report.max_speed,
                                            report.max_sound_speed,
                                            report.max_strain_rate,
                                            report.min_J_P,
                                            report.max_J_P,
                                            report.inverted};
}

/// Returns the last steps, oldest first.
std::vector<StepRecord> HealthWatch::last_steps(std::uint64_t step) const {
  std::vector<StepRecord> records;
  for (std::size_t k = 1; k <= ring_.size(); ++k) {
    const StepRecord& record = ring_[(step + k) % ring_.size()];
    // An interrupted or repeated run has taken fewer than the ring holds.
    if (record.step > 0 && record.step <= step && record.step + ring_.size() > step)
      records.push_back(record);
  }
  return records;
}

EnergyAccount energy_account(const SolverSettings& settings, const Progress& progress,
                             const Summary& now) {
  const EnergyBudget& budget = progress.energy;
  const double gravity_work =
      settings.gravity.dot(now.mass * now.centre_of_mass - moment_of(budget));
  EnergyAccount account;
  account.found = now.kinetic_energy + now.elastic_energy;
  account.explained = budget.start + gravity_work + budget.contact_work;
  if (settings.has_affine_and_own_velocity())
    account.traded = health::traded_share * now.affine_energy;
  // Scale of the changes that rounding and the first contact, whose work is known a step late, may
  // make to snow that starts at rest: a cell's fall; without gravity, a strain that single
  // precision knows to a thousandth.
  constexpr double strain = 1e-4;
  const double fall = settings.gravity.norm() * settings.cell_size,
               moved = strain * progress.limits.max_sound_speed;
  account.scale =
      std::max({budget.largest, account.explained, now.mass * std::max(fall, 0.5 * moved * moved)});
  return account;
}

std::optional<BrokenRule> HealthWatch::check_sums(const SolverSettings& settings,
                                                  const Summary& now, Progress& progress) const {
  const auto broken = [&](const char* rule, const char* stage, double value, double limit) {
    const double holds = stable_dt(settings, progress.limits);
    return BrokenRule{rule, stage, progress.last_dt, holds, value, limit};
  };
  const EnergyAccount account = energy_account(settings, progress, now);
  progress.energy.largest = std::max(progress.energy.largest, account.explained);
  const double allowed = account.explained + account.traded +
                         (health::limits_of(Law::energy).stop - 1) * account.scale;
  if (!(account.found <= allowed))
    return broken("energy", "particle_velocities", account.found, allowed);
  const double max_packed = health::limits_of(Law::packed).stop;
  if (now.packed > max_packed) return broken("packed", "deformation", now.packed, max_packed);
  return std::nullopt;
}

void HealthWatch::diverge(const BrokenRule& broken, const Progress& progress,
                          const SolverSettings& settings, const std::vector<Material>& materials,
                          const ParticleArrays& particles) {
  Divergence d;
  d.step = progress.steps;
  d.time = progress.time;
  d.rule = broken.rule;
  d.stage = broken.stage;
  d.dt = broken.dt;
  d.dt_that_holds = broken.dt_that_holds;
  d.value = broken.value;
  d.limit = broken.limit;
  d.start = start;
  d.start.max_speed = std::max(start.max_speed, progress.flow.max_speed);
  d.start.max_sound_speed = std::max(start.max_sound_speed, progress.flow.max_sound_speed);
  d.last_steps = last_steps(progress.steps);
  health::find_culprits(particles, settings, materials, d);
  divergence_ = d;
}

bool HealthWatch::may_ignore(const BrokenRule& broken, const SolverSettings& settings,
                             Progress& progress) {
  if (settings.on_divergence != OnDivergence::ignore) return false;
  const auto rule = static_cast<std::size_t>(
      std::find(stop_rules.begin(), stop_rules.end(), std::string_view(broken.rule)) -
      stop_rules.begin());
  if (is_final_rule(broken.rule)) return false;
  if (std::string_view(broken.rule) == "speed_cfl" && broken.value > hopeless_cells) return false;
  Warnings& warnings = progress.warnings;
  if (warnings.rules_ignored++ > 0) return true;
  warnings.first_ignored = progress.steps;
  warnings.first_ignored_rule = rule;
  return true;
}

void HealthWatch::forget() {
  divergence_.reset();
  ring_.clear();
}

}  // namespace neve::sim::engine
