/// The rules of a healthy run: what is looked at after every step, and what stops it.

#include <algorithm>
#include <cmath>

#include "sim/engine/engine.h"
#include "sim/health/diagnostics.h"
#include "sim/health/limits.h"

namespace neve::sim::engine {

namespace {

using health::Law;

/// Energy is added up this often, and whenever a frame ends.
constexpr std::size_t steps_between_energy_checks = 256;
/// What a report of trouble looks back at.
constexpr std::size_t steps_remembered = 64;

}  // namespace

/// Extremes of all blocks.
template <class Real>
kernels::BlockReport<Real> Engine<Real>::combined_report() const {
  kernels::BlockReport<Real> all;
  for (const kernels::BlockReport<Real>& r : reports_) {
    all.max_speed_squared = std::max(all.max_speed_squared, r.max_speed_squared);
    all.max_sound_squared = std::max(all.max_sound_squared, r.max_sound_squared);
    all.max_strain_rate = std::max(all.max_strain_rate, r.max_strain_rate);
    all.min_J_P = std::min(all.min_J_P, r.min_J_P);
    all.max_J_P = std::max(all.max_J_P, r.max_J_P);
    all.contact_work += r.contact_work;
    all.inverted += r.inverted;
    all.inverted_unprojected += r.inverted_unprojected;
    all.not_finite += r.not_finite;
    all.overflowed += r.overflowed;
  }
  for (const double work : node_contact_work_) all.contact_work += work;
  return all;
}

template <class Real>
void Engine<Real>::note(double dt) {
  const kernels::BlockReport<Real> report = combined_report();
  const StateLimits before = limits_;
  limits_.max_speed = std::sqrt(static_cast<double>(report.max_speed_squared));
  limits_.max_sound_speed = std::sqrt(static_cast<double>(report.max_sound_squared));
  limits_.max_strain_rate = static_cast<double>(report.max_strain_rate);
  ++steps_since_look_;
  way_since_look_ += dt * std::max(before.max_speed, limits_.max_speed);
  warnings_.inverted_trials += report.inverted;
  energy_.contact_work += report.contact_work;
  last_dt_ = dt;
  remember(dt, report);
  if (!divergence_) check(dt, before, report);
  if (!divergence_ && steps_ % steps_between_energy_checks == 0) check_energy();
}

template <class Real>
void Engine<Real>::remember(double dt, const kernels::BlockReport<Real>& report) {
  last_steps_.resize(steps_remembered);
  last_steps_[steps_ % steps_remembered] = {steps_,
                                            time_,
                                            dt,
                                            last_limit_,
                                            limits_.max_speed,
                                            limits_.max_sound_speed,
                                            limits_.max_strain_rate,
                                            static_cast<double>(report.min_J_P),
                                            static_cast<double>(report.max_J_P),
                                            report.inverted};
}

/// The rules of a healthy step that its own report can answer.
template <class Real>
void Engine<Real>::check(double dt, const StateLimits& before,
                         const kernels::BlockReport<Real>& report) {
  const double h = settings_.cell_size;
  const double speed_cfl = limits_.max_speed * dt / h;
  // As an explicit step would feel it.
  const double acoustic_cfl = limits_.max_sound_speed * dt / h / acoustic_stretch(settings_);
  warnings_.worst_acoustic_cfl = std::max(warnings_.worst_acoustic_cfl, acoustic_cfl);
  const double holds = stable_dt(settings_, before);
  const auto stop = [](Law law) { return health::limits_of(law).stop; };
  const bool is_adaptive = settings_.time_step == TimeStep::adaptive;
  if (report.not_finite > stop(Law::not_finite)) {
    diverge("not_finite", "deformation", {dt, holds}, report.not_finite, stop(Law::not_finite));
  } else if (report.overflowed > stop(Law::overflow)) {
    diverge("overflow", "advection", {dt, holds}, report.overflowed, stop(Law::overflow));
  } else if (speed_cfl > stop(Law::speed_cfl)) {
    diverge("speed_cfl", "particle_velocities", {dt, holds}, speed_cfl, stop(Law::speed_cfl));
  } else if (report.inverted_unprojected > stop(Law::inverted)) {
    diverge("inverted", "deformation", {dt, holds}, report.inverted_unprojected,
            stop(Law::inverted));
  } else if (report.min_J_P < Real(stop(Law::compaction))) {
    diverge("J_P", "deformation", {dt, holds}, static_cast<double>(report.min_J_P),
            stop(Law::compaction));
  } else if (is_adaptive && acoustic_cfl > stop(Law::acoustic_cfl)) {
    diverge("acoustic_cfl", "deformation", {dt, holds}, acoustic_cfl, stop(Law::acoustic_cfl));
  } else if (is_adaptive && choose_dt(1).dt < stop(Law::time_step) * rest_dt_) {
    diverge("time_step", "deformation", {dt, holds}, choose_dt(1).dt,
            stop(Law::time_step) * rest_dt_);
  }
}

template <class Real>
EnergyAccount Engine<Real>::energy_account() const {
  const Summary now = summary();
  const double gravity_work = settings_.gravity.dot(now.mass * now.centre_of_mass - energy_.moment);
  EnergyAccount account;
  account.found = now.kinetic_energy + now.elastic_energy;
  account.explained = energy_.start + gravity_work + energy_.contact_work;
  // A cell's fall: what rounding and the first contact may do to snow that starts at rest.
  const double floor = now.mass * settings_.gravity.norm() * settings_.cell_size;
  account.scale = std::max({energy_.largest, account.explained, floor}) + 1e-11 * now.mass;
  return account;
}

/// Kinetic plus elastic energy may exceed what the run started with plus the work of gravity and
/// colliders only by the share that the law of energy allows.
template <class Real>
void Engine<Real>::check_energy() {
  if (particles_.empty() || !settings_.bypass.empty()) return;
  const EnergyAccount account = energy_account();
  energy_.largest = std::max(energy_.largest, account.explained);
  const double allowed =
      account.explained + (health::limits_of(Law::energy).stop - 1) * account.scale;
  if (account.found <= allowed) return;
  diverge("energy", "particle_velocities", {last_dt_, stable_dt(settings_, limits_)}, account.found,
          allowed);
}

template <class Real>
void Engine<Real>::diverge(const char* rule, const char* stage, const StepSizes& step, double value,
                           double limit) {
  Divergence d;
  d.step = steps_;
  d.time = time_;
  d.rule = rule;
  d.stage = stage;
  d.dt = step.taken;
  d.dt_that_holds = step.stable;
  d.value = value;
  d.limit = limit;
  d.start = start_;
  for (std::size_t k = 1; k <= last_steps_.size(); ++k) {
    const StepRecord& record = last_steps_[(steps_ + k) % last_steps_.size()];
    // An interrupted or repeated run has taken fewer than the ring holds.
    if (record.step > 0 && record.step <= steps_ && record.step + last_steps_.size() > steps_)
      d.last_steps.push_back(record);
  }
  health::find_culprits(particles(), settings_, material_list_, d);
  divergence_ = d;
}

template void Engine<float>::note(double);
template void Engine<float>::check_energy();
template EnergyAccount Engine<float>::energy_account() const;
template void Engine<double>::note(double);
template void Engine<double>::check_energy();
template EnergyAccount Engine<double>::energy_account() const;

}  // namespace neve::sim::engine
