/// Other parameters while a run goes on: what may change between two steps, and what follows from
/// it.

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sim/engine/engine.h"
#include "sim/engine/engine_records.h"

namespace neve::sim::engine {

namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument(what + " cannot change during a run: start the run again");
}

void require_live(const SolverSettings& before, const SolverSettings& after) {
  if (before.cell_size != after.cell_size) refuse("the cell size");
  if (before.precision != after.precision) refuse("the precision");
  if (before.period != after.period) refuse("the period of the lattice");
}

void require_live(const std::vector<Material>& before, const std::vector<Material>& after) {
  if (before.size() != after.size()) refuse("the number of materials");
  for (std::size_t k = 0; k < before.size(); ++k)
    if (before[k].density != after[k].density) refuse("the density of " + before[k].name);
}

bool same_law(const Material& a, const Material& b) {
  return a.model == b.model && a.youngs_modulus == b.youngs_modulus &&
         a.poisson_ratio == b.poisson_ratio && a.hardening == b.hardening &&
         a.critical_compression == b.critical_compression &&
         a.critical_stretch == b.critical_stretch;
}

/// The collider that goes on as `after`, which has number k: the one of its name, of several the
/// one of its number.
const shapes::Collider* earlier(const std::vector<shapes::Collider>& before,
                                const shapes::Collider& after, std::size_t k) {
  if (k < before.size() && before[k].name == after.name) return &before[k];
  const auto found =
      std::find_if(before.begin(), before.end(),
                   [&](const shapes::Collider& collider) { return collider.name == after.name; });
  return found == before.end() ? nullptr : &*found;
}

std::vector<shapes::Collider> going_on(const std::vector<shapes::Collider>& before,
                                       const std::vector<shapes::Collider>& after, double time) {
  std::vector<shapes::Collider> colliders = after;
  for (std::size_t k = 0; k < colliders.size(); ++k) {
    const shapes::Collider* same = earlier(before, after[k], k);
    colliders[k].travel =
        same ? shapes::travel_after(*same, after[k], time) : shapes::Travel{.since = time};
  }
  return colliders;
}

/// Longest step by what the settings limit; not the end of a frame, and not fixed steps.
double longest_step(const SolverSettings& settings, const StateLimits& limits) {
  const auto allowed = limits_on_dt(settings, limits);
  return *std::min_element(allowed.begin(), allowed.end());
}

}  // namespace

template <class Real>
std::vector<shapes::Collider> Engine<Real>::colliders() const {
  std::vector<shapes::Collider> now = colliders_;
  // Where they stood when steps stopped moving them is where they still are.
  if (settings_.skips(Stage::colliders))
    for (shapes::Collider& collider : now)
      collider.travel = shapes::waited(collider.travel, time_ - colliders_time_);
  return now;
}

template <class Real>
void Engine<Real>::apply(const SolverSettings& settings, const std::vector<Material>& materials,
                         const std::vector<shapes::Collider>& colliders) {
  require_live(settings_, settings);
  require_live(material_list_, materials);
  if (colliders.size() > kernels::max_colliders)
    throw std::invalid_argument("at most " + std::to_string(kernels::max_colliders) + " colliders");
  if (divergence_)
    throw std::logic_error(
        "this run has diverged: reset it, or go back to an earlier frame, for the change to take "
        "effect");
  std::vector<shapes::Collider> moving = going_on(colliders_, colliders, colliders_time_);
  // Both throw for what cannot be.
  Fields fields = fields_of(moving);
  for (std::size_t k = 0; k < moving.size(); ++k) pose_of(moving[k], fields[k].get());
  if (settings_.skips(Stage::colliders) && !settings.skips(Stage::colliders)) {
    // They go on from where they waited.
    for (shapes::Collider& collider : moving)
      collider.travel = shapes::waited(collider.travel, time_ - colliders_time_);
    colliders_time_ = time_;
  }

  std::vector<bool> is_changed(materials.size());
  for (std::size_t k = 0; k < materials.size(); ++k)
    is_changed[k] = !same_law(material_list_[k], materials[k]);
  const bool has_new_law =
      std::find(is_changed.begin(), is_changed.end(), true) != is_changed.end();
  const bool has_new_sweeps =
      settings_.kernel != settings.kernel || settings_.transfer != settings.transfer;
  const bool has_new_accounts = has_new_law || has_new_sweeps ||
                                settings_.gravity != settings.gravity ||
                                settings_.bypass != settings.bypass;
  const SolverSettings before = settings_;
  const EnergyAccount account = has_new_accounts ? energy_account() : EnergyAccount{};
  const Summary found = has_new_accounts ? summary() : Summary{};
  const double longest_before = longest_step(settings_, limits_);

  settings_ = settings;
  material_list_ = materials;
  colliders_ = std::move(moving);
  fields_ = std::move(fields);
  place_colliders();
  use_materials();
  use_sweeps();
  if ((before.transfer == Transfer::flip) != (settings.transfer == Transfer::flip))
    for (kernels::Particle<Real>& p : particles_)
      std::fill(std::begin(p.C), std::end(p.C), Real(0));
  if (has_new_law || has_new_sweeps) stress_anew(is_changed);
  if (has_new_accounts) rebase_energy(before, account, found);
  // What is too short a step was said by the parameters of the start.
  const double ratio = longest_step(settings_, limits_) / longest_before;
  if (std::isfinite(ratio) && ratio > 0) rest_dt_ *= ratio;
}

/// Stress of the particles whose material changed, keys and groups of all: a kernel has its own
/// blocks, a model its own groups.
template <class Real>
void Engine<Real>::stress_anew(const std::vector<bool>& is_changed) {
  if (particles_.empty()) return;
  const auto changed = [&](const kernels::Particle<Real>& p) {
    return is_changed[static_cast<std::size_t>(p.material())];
  };
  for (kernels::Particle<Real>& p : particles_)
    p.kind = kernels::kind_of<Real>(
        static_cast<std::uint16_t>(p.material()),
        model_kind(material_list_[static_cast<std::size_t>(p.material())].model),
        static_cast<unsigned>(p.flags()));
  // The sweep writes whole records, of materials that stayed perhaps with another last bit.
  std::vector<kernels::Particle<Real>> records = particles_;
  kernels::SweepArgs<Real> a = args(0, kernels::all_channels);
  kernels::BlockReport<Real> report;
  sweeps_->refresh(a, 0, static_cast<std::uint32_t>(particles_.size()), false, report);
  for (std::size_t q = 0; q < records.size(); ++q)
    if (changed(records[q]))
      std::copy(std::begin(particles_[q].tau), std::end(particles_[q].tau),
                std::begin(records[q].tau));
  std::copy(records.begin(), records.end(), particles_.begin());
  if (std::find(is_changed.begin(), is_changed.end(), true) != is_changed.end())
    limits_.max_sound_speed = std::sqrt(static_cast<double>(report.max_sound_squared));
}

/// What the change put in or took out is part of what the run may have. The scale of the rule never
/// shrinks by a change: what was within it stays within it.
template <class Real>
void Engine<Real>::rebase_energy(const SolverSettings& before, const EnergyAccount& account,
                                 const Summary& found) {
  const Summary now = summary();
  const double energy = now.kinetic_energy + now.elastic_energy;
  const double change = energy - (found.kinetic_energy + found.elastic_energy);
  // Not finite: the next step will say so, with its particle.
  if (!std::isfinite(change)) return;
  // Steps that skip stages are not watched; they may have left any energy behind.
  const double explained = before.bypass.empty() ? account.explained + change : energy;
  energy_.start = explained - energy_.contact_work;
  energy_.moment = now.mass * now.centre_of_mass;
  energy_.largest = std::max({energy_.largest, account.scale, explained});
}

template std::vector<shapes::Collider> Engine<float>::colliders() const;
template void Engine<float>::apply(const SolverSettings&, const std::vector<Material>&,
                                   const std::vector<shapes::Collider>&);
template std::vector<shapes::Collider> Engine<double>::colliders() const;
template void Engine<double>::apply(const SolverSettings&, const std::vector<Material>&,
                                    const std::vector<shapes::Collider>&);

}  // namespace neve::sim::engine
