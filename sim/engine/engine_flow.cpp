/// Particles that come and go between steps.

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include "sim/engine/engine.h"
#include "sim/engine/engine_records.h"
#include "sim/health/diagnostics.h"

namespace neve::sim::engine {

namespace {

/// Particles that left make the partition start anew, so they go together: after so many steps, or
/// when the fastest has gone a cell.
constexpr std::uint64_t steps_between_looks = 8;

std::size_t index_of(const std::vector<Material>& materials, const seeding::Emitter& emitter) {
  const auto found = std::find_if(materials.begin(), materials.end(),
                                  [&](const Material& m) { return m.name == emitter.material; });
  if (found == materials.end())
    throw std::invalid_argument("emitter " + emitter.name + ": no material is called \"" +
                                emitter.material + "\"");
  return static_cast<std::size_t>(found - materials.begin());
}

}  // namespace

template <class Real>
void Engine<Real>::open(const seeding::Flow& flow) {
  for (std::size_t k = 0; k < flow.emitters.size(); ++k) {
    const seeding::Emitter& emitter = flow.emitters[k];
    const std::size_t material = index_of(material_list_, emitter);
    if (!(emitter.particles_per_cell > 0) || !(emitter.rate >= 0))
      throw std::invalid_argument("emitter " + emitter.name +
                                  ": particles per cell or rate is not positive");
    streams_.push_back({seeding::EmitterStream(emitter, k, material_list_[material], flow.seed,
                                               settings_.cell_size),
                        static_cast<std::uint16_t>(material)});
  }
  for (const seeding::Sink& sink : flow.sinks)
    sinks_.push_back({shapes::Solid(sink.shape), sink.outside});
  if (!sinks_.empty()) remove_gone();
  emit();
}

template <class Real>
void Engine<Real>::exchange() {
  if (!sinks_.empty() && is_time_to_look()) remove_gone();
  emit();
}

/// The record of a particle at rest in its own deformation.
template <class Real>
kernels::Particle<Real> Engine<Real>::record_of(const seeding::Birth& birth,
                                                std::uint16_t material) const {
  kernels::Particle<Real> p{};
  for (int a = 0; a < 3; ++a) {
    const double in_cells = birth.x[a] / settings_.cell_size;
    if (!(std::abs(in_cells) < 4.0 * kernels::block_limit))
      throw std::invalid_argument("an emitter is outside the lattice");
    int cell = 0;
    split(in_cells, cell, p.offset[a]);
    p.cell[a] = cell + kernels::block_side * lattice_origin_[a];
    p.v[a] = static_cast<Real>(birth.v[a]);
  }
  p.m = static_cast<Real>(birth.m);
  p.V0 = static_cast<Real>(birth.V0);
  p.kind = kernels::kind_of<Real>(material, model_kind(material_list_[material].model), 0);
  store_matrix(Mat3d(Mat3d::Identity()), p.F_E);
  p.J_P = 1;
  p.stiffness = static_cast<Real>(birth.stiffness);
  p.threshold = static_cast<Real>(birth.threshold);
  return p;
}

/// What a particle adds to the energy that the run may have.
template <class Real>
void Engine<Real>::account_for(const kernels::Particle<Real>& p, double sign) {
  const double m = static_cast<double>(p.m);
  energy_.moment += sign * m * place(p);
  energy_.start += sign * (kinetic_energy_of(p) + elastic_energy_of(p));
}

template <class Real>
void Engine<Real>::emit() {
  const std::size_t before = particles_.size();
  std::vector<seeding::Birth> births;
  for (Stream& stream : streams_) {
    births.clear();
    stream.births.advance_to(time_, births);
    for (const seeding::Birth& birth : births) {
      kernels::Particle<Real> p = record_of(birth, stream.material);
      if (next_id_ >= max_ids) throw std::length_error("a simulation has at most 2^31 particles");
      p.id = static_cast<Integer<Real>>(next_id_++);
      account_for(p, 1);
      totals_.emitted_mass += static_cast<double>(p.m);
      particles_.push_back(p);
    }
  }
  const std::size_t count = particles_.size() - before;
  if (count == 0) return;
  totals_.emitted += count;
  keys_.resize(particles_.size());
  locals_.resize(particles_.size());
  kernels::BlockReport<Real> report;
  sweeps_->refresh(args(0, sweeps_->fused_channels), static_cast<std::uint32_t>(before),
                   static_cast<std::uint32_t>(particles_.size()), false, report);
  if (report.overflowed > 0) throw std::invalid_argument("an emitter is outside the lattice");
  StateLimits born = limits_;
  born.max_speed = std::sqrt(static_cast<double>(report.max_speed_squared));
  born.max_sound_speed = std::sqrt(static_cast<double>(report.max_sound_squared));
  born.max_strain_rate = 0;
  const double rest = std::min(settings_.max_dt, stable_dt(settings_, born));
  rest_dt_ = rest_dt_ > 0 ? std::min(rest_dt_, rest) : rest;
  start_.max_speed = std::max(start_.max_speed, born.max_speed);
  start_.max_sound_speed = std::max(start_.max_sound_speed, born.max_sound_speed);
  limits_.max_speed = std::max(limits_.max_speed, born.max_speed);
  limits_.max_sound_speed = std::max(limits_.max_sound_speed, born.max_sound_speed);
}

template <class Real>
bool Engine<Real>::is_time_to_look() const {
  return steps_since_look_ >= steps_between_looks || way_since_look_ >= settings_.cell_size;
}

/// Whether a block may hold particles that go. Blocks are those at the beginning of the last step,
/// by where stencils start: its particles were within [0.5, 5) cells, and went a cell since, see
/// find_near_moved.
template <class Real>
bool Engine<Real>::may_remove(const OpenSink& sink, std::uint64_t block) const {
  const double h = settings_.cell_size;
  Vec3d centre;
  for (int a = 0; a < 3; ++a)
    centre[a] =
        h *
        (kernels::block_side * (kernels::block_coordinate(block, a) - lattice_origin_[a]) + 2.75);
  const double reach = 5.7 * h;
  const shapes::Solid& solid = sink.solid;
  const double clearance =
      solid.clearance(solid.rotation().transpose() * (centre - solid.center()));
  return sink.outside ? clearance > -reach : clearance < reach;
}

template <class Real>
void Engine<Real>::remove_gone() {
  std::vector<std::uint32_t> gone;
  steps_since_look_ = 0;
  way_since_look_ = 0;
  for (const kernels::ParticleBlock& block : partition_.blocks()) {
    for (const OpenSink& sink : sinks_) {
      if (!may_remove(sink, block.key)) continue;
      for (std::uint32_t k = block.begin; k < block.end; ++k) {
        const std::uint32_t q = partition_.order()[k];
        if (sink.solid.contains(place(particles_[q])) != sink.outside) gone.push_back(q);
      }
    }
  }
  if (gone.empty()) return;
  std::sort(gone.begin(), gone.end(), std::greater<>());
  gone.erase(std::unique(gone.begin(), gone.end()), gone.end());
  for (const std::uint32_t q : gone) {
    account_for(particles_[q], -1);
    totals_.removed_mass += static_cast<double>(particles_[q].m);
    particles_[q] = particles_.back();
    keys_[q] = keys_.back();
    locals_[q] = locals_.back();
    particles_.pop_back();
    keys_.pop_back();
    locals_.pop_back();
  }
  totals_.removed += gone.size();
  partition_.forget();
}

template <class Real>
Ranks Engine<Real>::ranks() const {
  // Ids grow: where none is left out they are places themselves.
  if (next_id_ == particles_.size()) return Ranks({});
  std::vector<std::uint32_t> rank(next_id_, 0);
  for (const kernels::Particle<Real>& p : particles_) rank[static_cast<std::size_t>(p.id)] = 1;
  std::uint32_t sum = 0;
  for (std::uint32_t& r : rank) {
    const std::uint32_t own = r;
    r = sum;
    sum += own;
  }
  return Ranks(std::move(rank));
}

template void Engine<float>::open(const seeding::Flow&);
template void Engine<float>::exchange();
template Ranks Engine<float>::ranks() const;
template void Engine<double>::open(const seeding::Flow&);
template void Engine<double>::exchange();
template Ranks Engine<double>::ranks() const;

}  // namespace neve::sim::engine
