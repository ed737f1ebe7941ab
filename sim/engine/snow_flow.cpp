#include "sim/engine/snow_flow.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>

#include "sim/engine/room.h"
#include "sim/state/records.h"

namespace neve::sim::engine {

namespace {

/// Steps after which particles leave, if the fastest has not moved by a cell before. They leave
/// together, as the whole partition is built again.
constexpr std::uint64_t steps_between_sink_checks = 8;

std::size_t index_of(const std::vector<Material>& materials, const seeding::Emitter& emitter) {
  const auto found = std::find_if(materials.begin(), materials.end(),
                                  [&](const Material& m) { return m.name == emitter.material; });
  if (found == materials.end())
    throw std::invalid_argument("emitter " + emitter.name + ": no material is called \"" +
                                emitter.material + "\"");
  return static_cast<std::size_t>(found - materials.begin());
}

bool is_sink_check_due(const Progress& progress, double cell_size) {
  return progress.steps_since_sink_check >= steps_between_sink_checks ||
         progress.distance_since_sink_check >= cell_size;
}

/// The affine velocity of what turns.
Mat3d affine_velocity(const Vec3d& spin) {
  Mat3d C;
  for (int a = 0; a < 3; ++a) C.col(a) = spin.cross(Vec3d::Unit(a));
  return C;
}

/// The record of a particle at rest in its own deformation.
/// @param spin  of the snow that it is born with, rad/s
template <class Real>
kernels::Particle<Real> born_record(const seeding::Birth& birth, std::uint16_t material,
                                    const Vec3d& spin, const Method<Real>& method) {
  kernels::Particle<Real> p{};
  if (!method.lattice.locate(birth.x, p))
    throw std::invalid_argument("an emitter is outside the lattice");
  for (int a = 0; a < 3; ++a) p.v[a] = static_cast<Real>(birth.v[a]);
  p.m = static_cast<Real>(birth.m);
  p.V0 = static_cast<Real>(birth.V0);
  p.kind = kernels::kind_of<Real>(material, method.materials[material].model, 0);
  store_matrix(Mat3d(Mat3d::Identity()), p.F_E);
  if (method.fits_affine_velocity()) store_matrix(affine_velocity(spin), p.C);
  p.J_P = static_cast<Real>(birth.J_P);
  p.stiffness = static_cast<Real>(birth.stiffness);
  p.threshold = static_cast<Real>(birth.threshold);
  return p;
}

/// Adds what a particle brings (sign 1) or takes away (-1) to the energy that the run may have.
template <class Real>
void account_for(const kernels::Particle<Real>& p, double sign, State<Real>& state) {
  const double m = static_cast<double>(p.m);
  EnergyBudget& energy = state.progress.energy;
  Vec3d::Map(energy.moment.data()) += sign * m * state.position(p);
  energy.start += sign * (state.method.kinetic_energy(p) + state.method.elastic_energy(p));
}

/// Lets the next dt be short enough for particles [begin, end) that came, and for the colliders
/// that they may meet.
template <class Real>
void include_limits(const kernels::BlockReport<Real>& report, std::size_t begin, std::size_t end,
                    State<Real>& state) {
  const SolverSettings& settings = state.method.settings;
  Progress& progress = state.progress;
  StateLimits& limits = progress.limits;
  StateLimits born = limits;
  born.max_speed = std::sqrt(static_cast<double>(report.max_speed_squared));
  born.max_sound_speed = std::sqrt(static_cast<double>(report.max_sound_squared));
  born.max_strain_rate = 0;
  limits.max_speed = std::max(limits.max_speed, born.max_speed);
  limits.max_sound_speed = std::max(limits.max_sound_speed, born.max_sound_speed);
  limits.max_collider_speed = std::max(limits.max_collider_speed, state.fastest_near(begin, end));
  born.max_collider_speed = limits.max_collider_speed;
  const double rest = std::min(settings.max_dt, stable_dt(settings, born));
  progress.rest_dt = progress.rest_dt > 0 ? std::min(progress.rest_dt, rest) : rest;
  seeding::FlowTotals& flow = progress.flow;
  flow.max_speed = std::max(flow.max_speed, born.max_speed);
  flow.max_sound_speed = std::max(flow.max_sound_speed, born.max_sound_speed);
}

}  // namespace

template <class Real>
SnowFlow<Real>::SnowFlow(const seeding::Flow& flow, const Method<Real>& method) {
  for (std::size_t k = 0; k < flow.emitters.size(); ++k) {
    const seeding::Emitter& emitter = flow.emitters[k];
    const std::size_t material = index_of(method.materials, emitter);
    if (!(emitter.particles_per_cell > 0) || !(emitter.rate >= 0))
      throw std::invalid_argument("emitter " + emitter.name +
                                  ": particles per cell or rate is not positive");
    emitters_.push_back({seeding::EmitterStream(emitter, k, method.materials[material], flow.seed,
                                                method.settings.cell_size),
                         static_cast<std::uint16_t>(material), emitter.angular_velocity});
  }
  for (const seeding::Sink& sink : flow.sinks)
    sinks_.push_back({shapes::Solid(sink.shape), sink.outside});
}

template <class Real>
void SnowFlow<Real>::open(State<Real>& state) {
  if (!sinks_.empty()) remove_in_sinks(state);
  emit(state);
}

template <class Real>
void SnowFlow<Real>::run(State<Real>& state) {
  emit(state);  // first: after particles left, the blocks of the step are not known
  if (!sinks_.empty() && is_sink_check_due(state.progress, state.method.settings.cell_size))
    remove_in_sinks(state);
}

template <class Real>
void SnowFlow<Real>::emit(State<Real>& state) {
  Progress& progress = state.progress;
  const std::size_t before = state.particles.size();
  std::vector<seeding::Birth> births;
  std::optional<Room<Real>> room;
  progress.flow.withheld = 0;
  for (Emitter& emitter : emitters_) {
    births.clear();
    const auto has_room = [&](const seeding::Birth& birth) {
      if (!room) room.emplace(state);
      if (!room->has_room(birth)) return false;
      if (!emitter.births.fills_whole()) room->take(birth);
      return true;
    };
    emitter.births.advance_to(progress.time, births, has_room, state.method.settings.gravity);
    if (emitter.births.fills_whole())
      for (const seeding::Birth& birth : births) room->take(birth);
    progress.flow.withheld += emitter.births.state().withheld;
    for (const seeding::Birth& birth : births) {
      kernels::Particle<Real> p = born_record(birth, emitter.material, emitter.spin, state.method);
      if (progress.next_id >= max_ids)
        throw std::length_error("a simulation has at most 2^31 particles");
      p.id = static_cast<Integer<Real>>(progress.next_id++);
      account_for(p, 1, state);
      progress.flow.emitted_mass += static_cast<double>(p.m);
      state.particles.records.push_back(p);
    }
  }
  const std::size_t after = state.particles.size();
  if (after == before) return;
  progress.flow.emitted += after - before;
  state.particles.resize(after);
  const kernels::BlockReport<Real> report = state.refresh(before, after);
  if (report.overflowed > 0) throw std::invalid_argument("an emitter is outside the lattice");
  state.note_touching(before, after);
  include_limits(report, before, after, state);
}

/// True if a block may hold particles that go. Blocks are those at the beginning of the last step,
/// by where stencils start: its particles were within [0.5, 5) cells, and went a cell since, see
/// find_near_moved.
template <class Real>
bool SnowFlow<Real>::may_remove(const Sink& sink, std::uint64_t block, const Lattice& lattice) {
  const double h = lattice.cell_size;
  const Vec3i first = lattice.first_cell(block);
  Vec3d centre;
  for (int a = 0; a < 3; ++a) centre[a] = h * (first[a] + 2.75);
  const double reach = 5.7 * h;
  const shapes::Solid& solid = sink.solid;
  const double clearance =
      solid.clearance(solid.rotation().transpose() * (centre - solid.center()));
  return sink.outside ? clearance > -reach : clearance < reach;
}

template <class Real>
void SnowFlow<Real>::remove_in_sinks(State<Real>& state) const {
  ParticleStorage<Real>& particles = state.particles;
  Progress& progress = state.progress;
  progress.steps_since_sink_check = 0;
  progress.distance_since_sink_check = 0;
  std::vector<std::uint32_t> gone;
  for (const kernels::BlockRange& block : particles.partition.all_blocks()) {
    for (const Sink& sink : sinks_) {
      if (!may_remove(sink, block.key, state.method.lattice)) continue;
      for (std::uint32_t k = block.begin; k < block.end; ++k) {
        const std::uint32_t q = particles.partition.order()[k];
        if (sink.solid.contains(state.position(particles.records[q])) != sink.outside)
          gone.push_back(q);
      }
    }
  }
  if (gone.empty()) return;
  std::sort(gone.begin(), gone.end(), std::greater<>());
  gone.erase(std::unique(gone.begin(), gone.end()), gone.end());
  for (const std::uint32_t q : gone) {
    account_for(particles.records[q], -1, state);
    progress.flow.removed_mass += static_cast<double>(particles.records[q].m);
    particles.remove(q);
  }
  progress.flow.removed += gone.size();
  particles.partition.invalidate();
}

template <class Real>
std::vector<seeding::EmitterStream::State> SnowFlow<Real>::emitter_states() const {
  std::vector<seeding::EmitterStream::State> states;
  for (const Emitter& emitter : emitters_) states.push_back(emitter.births.state());
  return states;
}

template <class Real>
void SnowFlow<Real>::restore(const std::vector<seeding::EmitterStream::State>& states) {
  for (std::size_t k = 0; k < states.size(); ++k) emitters_[k].births.restore(states[k]);
}

template class SnowFlow<float>;
template class SnowFlow<double>;

}  // namespace neve::sim::engine
