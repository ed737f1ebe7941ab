#include "sim/engine/still_grid.h"

#include <algorithm>
#include <cstddef>

namespace neve::sim::engine {

namespace {

/// Fits of affine velocities. The first one is exact inside a body. Each comes nearer at its
/// surface: nodes beyond the surface only know what the particles tell them.
constexpr int fits = 4;

template <class Real>
bool has_affine_velocity(const kernels::Particle<Real>& p) {
  return std::any_of(std::begin(p.C), std::end(p.C), [](Real entry) { return entry != Real(0); });
}

}  // namespace

template <class Real>
StillGrid<Real>::StillGrid(State<Real>& state) : state_(state) {
  state.partition();
  a_ = state.sweep_args(0, kernels::all_channels);
  nodes_.resize(state.particles.partition.node_blocks().size());
  gathered_.resize(state.particles.size());
  a_.staged = nodes_.data();
  a_.gathered = gathered_.data();
}

template <class Real>
void StillGrid<Real>::rasterize() {
  const kernels::Sweeps<Real>& sweeps = *state_.method.sweeps;
  state_.over_particle_blocks(sweeps.rasterize, a_);
  state_.over_node_blocks(sweeps.collect_momentum, a_);
}

template <class Real>
void StillGrid<Real>::estimate_volumes() {
  using Particle = kernels::Particle<Real>;
  std::vector<Particle>& records = state_.particles.records;
  const auto is_wanted = [](const Particle& p) { return (p.flags() & kernels::needs_volume) != 0; };
  if (std::none_of(records.begin(), records.end(), is_wanted)) return;
  const auto room_of_mass = [&](const Particle& p) {
    const Material& material = state_.method.materials[static_cast<std::size_t>(p.material())];
    return p.J_P / static_cast<Real>(material.density);
  };
  const Real first = room_of_mass(records.front());
  const bool is_mixed = std::any_of(records.begin(), records.end(),
                                    [&](const Particle& p) { return room_of_mass(p) != first; });
  std::vector<Real> masses;
  if (is_mixed) {
    for (Particle& p : records) {
      masses.push_back(p.m);
      p.m *= room_of_mass(p) / first;
    }
    rasterize();
  }
  state_.over_particle_blocks(state_.method.sweeps->volumes, a_);
  if (!is_mixed) return;
  for (std::size_t q = 0; q < records.size(); ++q) records[q].m = masses[q];
  rasterize();
}

template <class Real>
const std::vector<kernels::Gathered<Real>>& StillGrid<Real>::gather() {
  const kernels::Sweeps<Real>& sweeps = *state_.method.sweeps;
  for (kernels::StagedNodes<Real>& nodes : nodes_)
    std::copy(std::begin(nodes.v_old), std::end(nodes.v_old), std::begin(nodes.v_new));
  state_.over_node_blocks(sweeps.lay_out_velocities, a_);
  state_.over_particle_blocks(sweeps.gather, a_);
  return gathered_;
}

template <class Real>
void StillGrid<Real>::fit_affine_velocities() {
  std::vector<kernels::Particle<Real>>& records = state_.particles.records;
  std::vector<std::size_t> fitted;
  for (std::size_t q = 0; q < records.size(); ++q)
    if (!has_affine_velocity(records[q])) fitted.push_back(q);
  if (fitted.empty()) return;
  for (int fit = 0; fit < fits; ++fit) {
    rasterize();
    gather();
    for (const std::size_t q : fitted)
      std::copy(std::begin(gathered_[q].C), std::end(gathered_[q].C), std::begin(records[q].C));
  }
}

template class StillGrid<float>;
template class StillGrid<double>;

}  // namespace neve::sim::engine
