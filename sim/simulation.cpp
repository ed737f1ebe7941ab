#include "sim/simulation.h"

#include <algorithm>

#include "sim/engine/engine.h"
#include "sim/engine/saved_state.h"
#include "sim/laws/threshold_cell.h"
#include "sim/rasterize.h"
#include "sim/staged.h"

namespace neve::sim {

Simulation::Simulation(const SolverSettings& settings, const std::vector<Material>& materials,
                       const std::vector<shapes::Collider>& colliders,
                       const ParticleArrays& particles, int threads, const Vec3i& lattice_origin,
                       const seeding::Flow& flow) {
  const auto make = [&]<class Real>(Real) {
    stepper_ =
        std::make_unique<engine::Engine<Real>>(settings, laws::in_cells(materials, settings),
                                               colliders, particles, threads, lattice_origin, flow);
  };
  if (settings.precision == Precision::real64)
    make(double());
  else
    make(float());
}

std::vector<std::uint64_t> Simulation::withheld() const {
  std::vector<std::uint64_t> counts;
  for (const seeding::EmitterStream::State& emitter : emitter_states())
    counts.push_back(emitter.withheld);
  return counts;
}

void Simulation::apply(const SolverSettings& settings, const std::vector<Material>& materials,
                       const std::vector<shapes::Collider>& colliders) {
  stepper_->apply(settings, laws::in_cells(materials, settings), colliders);
}

bool Simulation::can_read(std::span<const std::uint8_t> saved) {
  return engine::has_this_layout(saved);
}

StagedStep staged_step(const Simulation& simulation, double dt) {
  return simulation.stepper().staged_step(dt);
}

EnergyAccount energy_account(const Simulation& simulation) {
  return simulation.stepper().energy_account();
}

RasterizedNodes rasterize(const Simulation& simulation,
                          const std::vector<std::vector<double>>& values) {
  return simulation.stepper().rasterize(values);
}

RasterizedNodes rasterize_some(const Simulation& simulation, const std::vector<std::size_t>& rows) {
  return simulation.stepper().rasterize_some(rows);
}

std::uint64_t estimate_memory(std::size_t particles, double particles_per_cell,
                              const SolverSettings& settings, int threads) {
  const bool is_double = settings.precision == Precision::real64;
  const double real = is_double ? 8 : 4;
  const double record = static_cast<double>(is_double ? sizeof(kernels::Particle<double>)
                                                      : sizeof(kernels::Particle<float>));
  // Record, key, local, order and its neighbours in Partition, and the data that prepare() gathers.
  const double gathered = static_cast<double>(is_double ? sizeof(kernels::Gathered<double>)
                                                        : sizeof(kernels::Gathered<float>));
  const double kept = settings.is_implicit() ? kernels::elasticity_quads * 4 * real : 0;
  const double per_particle = record + 8 + 2 + 2 * (4 + 2) + 1 + gathered + kept;
  // Snow fills about half of the blocks that it touches; each has a tile, and about two node
  // blocks.
  const double cells = static_cast<double>(particles) / particles_per_cell;
  const double blocks =
      std::min(2.0 * cells / kernels::block_nodes + 64, static_cast<double>(particles));
  const double tile = kernels::all_channels * kernels::Tile<kernels::cubic_nodes>::nodes * 4 * real;
  const int fields =
      kernels::all_channels + 6 + (settings.is_implicit() ? int(kernels::solve_vectors) : 0);
  const double nodes = 2 * fields * kernels::block_nodes * 4 * real;
  const double total = static_cast<double>(particles) * per_particle + blocks * (tile + nodes) +
                       static_cast<double>(threads) * 1e6 + 8e6;
  return total < 1e18 ? static_cast<std::uint64_t>(total) : std::uint64_t(1e18);
}

}  // namespace neve::sim
