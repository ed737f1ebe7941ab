#include "sim/engine/saved_numbers.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "sim/health/limits.h"
#include "sim/state/records.h"
#include "sim/types/errors.h"
#include "sim/types/number_text.h"
#include "sim/types/time_step.h"

namespace neve::sim::engine {

namespace {

/// More steps than any run takes; counters can still grow without end.
constexpr std::uint64_t max_count = std::uint64_t(1) << 53;

[[noreturn]] void refuse_number(const std::string& name, const std::string& value,
                                const std::string& expected) {
  throw SavedStateError("the saved state has " + name + " = " + value + "; expected " + expected);
}

void require(bool is_right, const std::string& name, double value, const char* expected) {
  if (!is_right) refuse_number(name, number_text(value, 6), expected);
}

void require_not_negative(const char* name, double value) {
  require(std::isfinite(value) && value >= 0, name, value, "a finite number from 0 on");
}

void require_finite(const char* name, double value) {
  require(std::isfinite(value), name, value, "a finite number");
}

void require_at_most(const char* name, std::uint64_t value, std::uint64_t most) {
  if (value > most)
    refuse_number(name, std::to_string(value), "a number up to " + std::to_string(most));
}

// ---- places in memory ---------------------------------------------------------------------------

/// @param ids  all, in any order
void require_once(std::vector<std::uint32_t> ids) {
  std::sort(ids.begin(), ids.end());
  const auto twice = std::adjacent_find(ids.begin(), ids.end());
  if (twice != ids.end())
    throw SavedStateError("the saved state has two particles with id " + std::to_string(*twice));
}

template <class Real>
void require_place(const kernels::Particle<Real>& p, const Method<Real>& method,
                   std::uint64_t next_id) {
  for (const Integer<Real> cell : p.cell)
    if (cell <= -4 * kernels::block_limit || cell >= 4 * kernels::block_limit)
      throw SavedStateError("the saved state has particles outside of the lattice");
  if (p.id < 0 || static_cast<std::uint64_t>(p.id) >= next_id)
    refuse_number("a particle with id", std::to_string(p.id),
                  "an id below next_id, " + std::to_string(next_id));
  const auto material = static_cast<std::size_t>(p.material());
  if (material >= method.materials.size())
    refuse_number("a particle with material", std::to_string(material),
                  "one of " + std::to_string(method.materials.size()) + " materials");
  const Model model = method.materials[material].model;
  if (p.model() != static_cast<Integer<Real>>(model))
    refuse_number("a particle with model", std::to_string(p.model()),
                  std::to_string(static_cast<int>(model)) + ", as its material has");
  const unsigned flags = static_cast<unsigned>(p.flags()) & kernels::needs_volume;
  if (p.kind != kernels::kind_of<Real>(static_cast<std::uint16_t>(material), model, flags))
    refuse_number("a particle with flags", std::to_string(p.flags()), "0 or 1");
}

template <class Real>
void require_place(const kernels::KeptContact<Real>& contact, std::size_t particles,
                   std::size_t colliders) {
  if (contact.particle >= particles)
    refuse_number("a contact of particle", std::to_string(contact.particle),
                  "one of " + std::to_string(particles) + " particles");
  if (contact.collider < 0 || static_cast<std::size_t>(contact.collider) >= colliders)
    refuse_number("a contact with collider", std::to_string(contact.collider),
                  "one of " + std::to_string(colliders) + " colliders");
}

// ---- numbers of healthy runs --------------------------------------------------------------------

template <class T, std::size_t Count>
bool are_finite(const T (&values)[Count]) {
  return std::all_of(values, values + Count, [](T value) { return std::isfinite(value); });
}

template <class Real>
void require_healthy_particle(const kernels::Particle<Real>& p) {
  const auto value = [](Real x) { return static_cast<double>(x); };
  for (const Real offset : p.offset)
    require(offset >= 0 && offset <= 1, "a particle with offset", value(offset),
            "a place in its cell, from 0 to 1");
  const auto positive = [&](const char* name, Real x) {
    require(std::isfinite(x) && x > 0, name, value(x), "a positive number");
  };
  positive("a particle with m", p.m);
  positive("a particle with J_P", p.J_P);
  positive("a particle with stiffness", p.stiffness);
  positive("a particle with threshold", p.threshold);
  require_not_negative("a particle with V0", value(p.V0));
  if (!are_finite(p.v) || !are_finite(p.F_E) || !are_finite(p.tau) || !are_finite(p.C))
    throw SavedStateError(
        "the saved state has a particle with v, F_E, tau or C that is not finite");
}

/// Times are sums of steps.
double rounded_up(double time) {
  return time * (1 + 1e-9);
}

void require_healthy_times(const Progress& p) {
  require_not_negative("time", p.time);
  require(p.colliders_time >= 0 && p.colliders_time <= rounded_up(p.time), "colliders_time",
          p.colliders_time, "a time of the run");
  require_not_negative("last_dt", p.last_dt);
  require_not_negative("rest_dt", p.rest_dt);
  require(p.dt_scale > 0 && p.dt_scale <= 1, "dt_scale", p.dt_scale, "a factor from 0 to 1");
  require_not_negative("frame.start", p.frame.start);
  require_not_negative("frame.end", p.frame.end);
  const double whole = p.frame.end - p.frame.start;
  require(p.frame.done >= 0 && p.frame.done <= rounded_up(whole), "frame.done", p.frame.done,
          "a part of the frame");
}

/// The rule of the shortest step holds after each step: no run continues with shorter ones.
void require_healthy_limits(const Progress& p, const SolverSettings& settings) {
  require_not_negative("max_speed", p.limits.max_speed);
  require_not_negative("max_sound_speed", p.limits.max_sound_speed);
  require_not_negative("max_strain_rate", p.limits.max_strain_rate);
  require_not_negative("max_xi", p.limits.max_xi);
  require_not_negative("max_hardened_speed", p.limits.max_hardened_speed);
  require_not_negative("max_collider_speed", p.limits.max_collider_speed);
  if (settings.time_step == TimeStep::fixed) return;
  const double dt = choose_dt(settings, p.limits, 1, p.dt_scale).dt;
  // Births and changes may ask for shorter steps than the last one.
  const double least = 1e-3 * health::limits_of(health::Law::time_step).stop * p.rest_dt;
  require(dt > 1e-15 && dt >= least, "limits with dt", dt, "a step that a run can take");
}

void require_healthy_counters(const Progress& p) {
  require_at_most("steps", p.steps, max_count);
  require_at_most("rules_ignored", p.warnings.rules_ignored, max_count);
  require_at_most("first_ignored", p.warnings.first_ignored, p.steps);
  require_at_most("first_ignored_rule", p.warnings.first_ignored_rule, stop_rules.size() - 1);
  require_at_most("inverted_trials", p.warnings.inverted_trials, max_count);
  require_at_most("solves_cut_short", p.warnings.solves_cut_short, max_count);
  require_at_most("solves_given_up", p.warnings.solves_given_up, max_count);
  require_not_negative("worst_acoustic_cfl", p.warnings.worst_acoustic_cfl);
  require_finite("least_J_P", p.warnings.least_J_P);
  require_at_most("emitted", p.flow.emitted, p.next_id);
  require_at_most("removed", p.flow.removed, p.next_id);
  require_at_most("withheld", p.flow.withheld, max_count);
  require_not_negative("emitted_mass", p.flow.emitted_mass);
  require_not_negative("removed_mass", p.flow.removed_mass);
  require_not_negative("flow.max_speed", p.flow.max_speed);
  require_not_negative("flow.max_sound_speed", p.flow.max_sound_speed);
  require_at_most("steps_since_sink_check", p.steps_since_sink_check, max_count);
  require_not_negative("distance_since_sink_check", p.distance_since_sink_check);
  require_finite("energy.start", p.energy.start);
  require_finite("energy.contact_work", p.energy.contact_work);
  require_finite("energy.largest", p.energy.largest);
  for (const double moment : p.energy.moment) require_finite("energy.moment", moment);
}

void require_healthy_offset(const shapes::PoseOffset& offset) {
  require_not_negative("a collider with since", offset.since);
  require_not_negative("a collider with delay", offset.delay);
  require_finite("a collider with joint_angle", offset.joint_angle);
  for (const double moved : offset.moved) require_finite("a collider with moved", moved);
  const Mat3d gram = offset.turned.transpose() * offset.turned;
  if (!(gram - Mat3d::Identity()).isZero(1e-6) || !(offset.turned.determinant() > 0))
    throw SavedStateError("the orientation of a collider in the saved state is not a rotation");
}

template <class Real>
void require_healthy_contact(const kernels::KeptContact<Real>& contact) {
  if (!std::isfinite(contact.impulse) || !are_finite(contact.sliding))
    throw SavedStateError("the saved state has a contact whose impulse is not finite");
  require_not_negative("a contact with touches", static_cast<double>(contact.touches));
}

void require_healthy_emitter(const seeding::EmitterStream::State& emitter) {
  require_at_most("an emitter with born", emitter.born, max_count);
  require_at_most("an emitter with candidate", emitter.candidate, max_count);
  require_at_most("an emitter with withheld", emitter.withheld, max_count);
  require(std::isfinite(emitter.waited) && emitter.waited >= 0, "an emitter with waited",
          emitter.waited, "0 s or more");
}

}  // namespace

template <class Real>
void require_consistent(const SavedNumbers<Real>& saved, const Method<Real>& method) {
  const std::uint64_t next_id = saved.progress.next_id;
  if (next_id < saved.records.size() || next_id > max_ids)
    refuse_number("next_id", std::to_string(next_id),
                  "a number from " + std::to_string(saved.records.size()) + " to 2^31");
  std::vector<std::uint32_t> ids;
  ids.reserve(saved.records.size());
  for (const kernels::Particle<Real>& p : saved.records) {
    require_place(p, method, next_id);
    ids.push_back(static_cast<std::uint32_t>(p.id));
  }
  require_once(std::move(ids));
  for (const kernels::KeptContact<Real>& contact : saved.contacts)
    require_place(contact, saved.records.size(), saved.offsets.size());
}

template <class Real>
void require_healthy(const SavedNumbers<Real>& saved, const Method<Real>& method) {
  require_consistent(saved, method);
  require_healthy_times(saved.progress);
  require_healthy_limits(saved.progress, method.settings);
  require_healthy_counters(saved.progress);
  for (const kernels::Particle<Real>& p : saved.records) require_healthy_particle(p);
  for (const shapes::PoseOffset& offset : saved.offsets) require_healthy_offset(offset);
  for (const auto& motion : saved.motions)
    for (const Vec3d& velocity : motion)
      for (const double v : velocity) require_finite("a body that moves with velocity", v);
  for (const kernels::KeptContact<Real>& contact : saved.contacts) require_healthy_contact(contact);
  for (const seeding::EmitterStream::State& emitter : saved.emitters)
    require_healthy_emitter(emitter);
  for (const Real pressure : saved.shock_pressure)
    require_not_negative("a shock pressure", static_cast<double>(pressure));
}

template void require_consistent(const SavedNumbers<float>&, const Method<float>&);
template void require_consistent(const SavedNumbers<double>&, const Method<double>&);
template void require_healthy(const SavedNumbers<float>&, const Method<float>&);
template void require_healthy(const SavedNumbers<double>&, const Method<double>&);

}  // namespace neve::sim::engine
