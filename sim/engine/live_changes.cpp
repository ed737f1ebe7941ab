#include "sim/engine/live_changes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "sim/engine/state_reader.h"
#include "sim/engine/still_grid.h"
#include "sim/laws/law.h"
#include "sim/state/records.h"

namespace neve::sim::engine {

namespace {

[[noreturn]] void refuse(const std::string& parameter) {
  throw std::invalid_argument(parameter + " cannot change during a run: start the run again");
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

/// Parameters that the law does not use change nothing.
bool same_law(const Material& a, const Material& b) {
  const auto is_same = [&](const laws::Parameter& p) { return p.of(a) == p.of(b); };
  return a.model == b.model && a.youngs_modulus == b.youngs_modulus &&
         a.poisson_ratio == b.poisson_ratio && a.min_J_P == b.min_J_P && a.max_J_P == b.max_J_P &&
         a.max_hardening == b.max_hardening && std::ranges::all_of(laws::of(a).parameters, is_same);
}

/// The collider that continues as `after`, which has number k: the one of its name, of several the
/// one of its number.
const shapes::Collider* earlier(const std::vector<shapes::Collider>& before,
                                const shapes::Collider& after, std::size_t k) {
  if (k < before.size() && before[k].name == after.name) return &before[k];
  const auto found =
      std::find_if(before.begin(), before.end(),
                   [&](const shapes::Collider& collider) { return collider.name == after.name; });
  return found == before.end() ? nullptr : &*found;
}

/// The colliders of `after`, each from where it is at a time.
std::vector<shapes::Collider> with_offsets(const std::vector<shapes::Collider>& before,
                                           const std::vector<shapes::Collider>& after,
                                           double time) {
  std::vector<shapes::Collider> colliders = after;
  for (std::size_t k = 0; k < colliders.size(); ++k) {
    const shapes::Collider* same = earlier(before, after[k], k);
    if (!same)
      colliders[k].pose_offset = {.since = time};
    else
      colliders[k].pose_offset = same->body.moves() && after[k].body.moves()
                                     ? shapes::body_offset_after(*same, after[k], time)
                                     : shapes::offset_after(*same, after[k], time);
  }
  return colliders;
}

/// True if numbers of colliders mean the same ones, so that contacts with them stay.
bool are_the_same(const std::vector<shapes::Collider>& before,
                  const std::vector<shapes::Collider>& after) {
  return std::equal(before.begin(), before.end(), after.begin(), after.end(),
                    [](const auto& a, const auto& b) { return a.name == b.name; });
}

/// Steps that skip the colliders leave them where they were.
void delay(std::vector<shapes::Collider>& colliders, const Progress& progress) {
  for (shapes::Collider& collider : colliders)
    collider.pose_offset =
        shapes::delayed(collider.pose_offset, progress.time - progress.colliders_time);
}

/// Longest step by what the settings limit; not the end of a frame, and not fixed steps.
double longest_step(const SolverSettings& settings, const StateLimits& limits) {
  const auto allowed = limits_on_dt(settings, limits);
  return *std::min_element(allowed.begin(), allowed.end());
}

/// Tells of each material if its stress is another one.
std::vector<bool> new_laws(const std::vector<Material>& before,
                           const std::vector<Material>& after) {
  std::vector<bool> is_changed(after.size());
  for (std::size_t k = 0; k < after.size(); ++k) is_changed[k] = !same_law(before[k], after[k]);
  return is_changed;
}

bool contains_true(const std::vector<bool>& list) {
  return std::find(list.begin(), list.end(), true) != list.end();
}

/// Finds the pressure that the last step added to that of snow, by the parameters of that step:
/// stress follows from F_E and J_P, and this from the velocities of a moment that is past.
template <class Real>
void find_shock_pressure(State<Real>& state) {
  ParticleStorage<Real>& particles = state.particles;
  if (particles.shock_pressure.size() == particles.size() &&
      particles.shock_step == state.progress.steps)
    return;
  particles.shock_step = state.progress.steps;
  particles.shock_pressure.assign(particles.size(), Real(0));
  if (!(state.method.settings.shock_viscosity > 0)) return;
  std::vector<kernels::Particle<Real>> stressed = particles.records;
  state.refresh(0, particles.size());
  for (std::size_t q = 0; q < stressed.size(); ++q) {
    const kernels::Particle<Real>& p = stressed[q];
    if (!laws::of(state.method.materials[static_cast<std::size_t>(p.material())]).is_plastic)
      continue;
    Real sum = 0;
    for (int axis = 0; axis < 3; ++axis) sum += particles.records[q].tau[axis] - p.tau[axis];
    particles.shock_pressure[q] = std::max(sum / 3, Real(0));
  }
  particles.records = std::move(stressed);
}

/// Stress of the particles whose material changed, keys and groups of all: a kernel has its own
/// blocks, a model its own groups.
template <class Real>
void recompute_stress(const std::vector<bool>& is_changed, State<Real>& state) {
  std::vector<kernels::Particle<Real>>& records = state.particles.records;
  if (records.empty()) return;
  for (kernels::Particle<Real>& p : records)
    p.kind =
        kernels::kind_of<Real>(static_cast<std::uint16_t>(p.material()),
                               state.method.materials[static_cast<std::size_t>(p.material())].model,
                               static_cast<unsigned>(p.flags()));
  // The sweep writes whole records, of materials that stayed perhaps with another last bit.
  std::vector<kernels::Particle<Real>> kept = records;
  const kernels::BlockReport<Real> report = state.refresh(0, records.size());
  for (std::size_t q = 0; q < kept.size(); ++q) {
    const auto material = static_cast<std::size_t>(kept[q].material());
    if (!is_changed[material]) continue;
    std::copy(std::begin(records[q].tau), std::end(records[q].tau), std::begin(kept[q].tau));
    if (!laws::of(state.method.materials[material]).is_plastic) continue;
    for (int axis = 0; axis < 3; ++axis) kept[q].tau[axis] -= state.particles.shock_pressure[q];
  }
  std::copy(kept.begin(), kept.end(), records.begin());
  if (contains_true(is_changed))
    state.progress.limits.max_sound_speed =
        std::sqrt(static_cast<double>(report.max_sound_squared));
}

/// Makes the energy that the change put in or took out part of what the run may have. The scale of
/// the rule never shrinks by a change: what was within it stays within it.
template <class Real>
void rebase_energy(const SolverSettings& before, const EnergyAccount& account, const Summary& found,
                   State<Real>& state) {
  const Summary now = StateReader<Real>(state).summary();
  EnergyBudget& budget = state.progress.energy;
  const double energy = now.kinetic_energy + now.elastic_energy;
  const double change = energy - (found.kinetic_energy + found.elastic_energy);
  // The next step will report energy that is not finite, with its particle.
  if (!std::isfinite(change)) return;
  // Steps that skip stages are not watched; they may have left any energy behind.
  const double explained = before.bypass.empty() ? account.explained + change : energy;
  budget.start = explained - budget.contact_work;
  Vec3d::Map(budget.moment.data()) = now.mass * now.centre_of_mass;
  budget.largest = std::max({budget.largest, account.scale, explained});
}

/// Colliders of a run whose settings change too.
template <class Real>
MovingColliders changed_colliders(const SolverSettings& settings,
                                  const std::vector<shapes::Collider>& colliders,
                                  const State<Real>& state, double& colliders_time) {
  const Progress& progress = state.progress;
  std::vector<shapes::Collider> list =
      with_offsets(state.colliders.list(), colliders, progress.colliders_time);
  colliders_time = progress.colliders_time;
  if (state.method.settings.skips(Stage::colliders) && !settings.skips(Stage::colliders)) {
    // They move again, from where they waited.
    delay(list, progress);
    colliders_time = progress.time;
  }
  return MovingColliders(list, state.method.lattice, colliders_time, *state.pool);
}

}  // namespace

template <class Real>
std::vector<shapes::Collider> colliders_now(const State<Real>& state) {
  std::vector<shapes::Collider> now = state.colliders.list();
  if (state.method.settings.skips(Stage::colliders)) delay(now, state.progress);
  return now;
}

template <class Real>
void apply(const SolverSettings& settings, const std::vector<Material>& materials,
           const std::vector<shapes::Collider>& colliders, State<Real>& state) {
  const SolverSettings before = state.method.settings;
  Progress& progress = state.progress;
  require_live(before, settings);
  require_live(state.method.materials, materials);
  // Both throw for what cannot be.
  double colliders_time = 0;
  MovingColliders moving = changed_colliders(settings, colliders, state, colliders_time);
  Method<Real> method = state.method;
  method.change(settings, materials);

  const std::vector<bool> is_changed = new_laws(state.method.materials, materials);
  const bool has_new_stress = contains_true(is_changed) || before.kernel != settings.kernel ||
                              before.transfer != settings.transfer;
  const bool has_new_accounts =
      has_new_stress || before.gravity != settings.gravity || before.bypass != settings.bypass;
  const Summary found = has_new_accounts ? StateReader<Real>(state).summary() : Summary{};
  const EnergyAccount account =
      has_new_accounts ? energy_account(before, progress, found) : EnergyAccount{};
  const double longest_before = longest_step(before, progress.limits);
  const double met_before = state.fastest_near(0, state.particles.size());

  if (!settings.is_contact_at_particles() || !are_the_same(state.colliders.list(), colliders))
    state.particles.contacts.forget();
  // A later change of a material at this moment asks for it, whatever the viscosity is then.
  if (contains_true(is_changed) || before.shock_viscosity != settings.shock_viscosity)
    find_shock_pressure(state);
  state.method = std::move(method);
  state.colliders = std::move(moving);
  progress.colliders_time = colliders_time;
  state.method.limit_hardening(progress.limits);
  if (before.has_affine_velocity() != settings.has_affine_velocity())
    state.particles.affine_step = progress.steps;
  // Changes at one moment are one change: the last of them says how C is fitted.
  const bool has_new_affine = state.particles.affine_step == progress.steps;
  if (has_new_affine)
    for (kernels::Particle<Real>& p : state.particles.records)
      std::fill(std::begin(p.C), std::end(p.C), Real(0));
  if (has_new_stress) recompute_stress(is_changed, state);
  if (has_new_affine && state.method.fits_affine_velocity() && state.particles.size() > 0)
    StillGrid<Real>(state).fit_affine_velocities();
  if (has_new_accounts) rebase_energy(before, account, found, state);
  // The limit of a too short step follows the settings alone: other colliders do not move it.
  const double ratio = longest_step(settings, progress.limits) / longest_before;
  if (std::isfinite(ratio) && ratio > 0) progress.rest_dt *= ratio;
  // The speed that the step has found stays, unless the change alone gives another one.
  const double met = state.fastest_near(0, state.particles.size());
  if (met != met_before) progress.limits.max_collider_speed = met;
}

#define NEVE_LIVE_CHANGES(Real)                                             \
  template std::vector<shapes::Collider> colliders_now(const State<Real>&); \
  template void apply(const SolverSettings&, const std::vector<Material>&,  \
                      const std::vector<shapes::Collider>&, State<Real>&);
NEVE_LIVE_CHANGES(float)
NEVE_LIVE_CHANGES(double)
#undef NEVE_LIVE_CHANGES

}  // namespace neve::sim::engine
