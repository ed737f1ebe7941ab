#include "sim/simulation.h"

#include <algorithm>
#include <variant>

#include "sim/engine/engine.h"
#include "sim/rasterize.h"
#include "sim/staged.h"

namespace neve::sim {

struct Simulation::Impl {
  std::variant<engine::Engine<float>, engine::Engine<double>> engine;

  template <class Call>
  decltype(auto) visit(Call&& call) {
    return std::visit(call, engine);
  }
};

namespace {

std::variant<engine::Engine<float>, engine::Engine<double>> make_engine(
    const SolverSettings& settings, const std::vector<Material>& materials,
    const std::vector<shapes::Collider>& colliders, const ParticleArrays& particles, int threads,
    const Vec3i& lattice_origin, const seeding::Flow& flow) {
  if (settings.precision == Precision::real64)
    return engine::Engine<double>(settings, materials, colliders, particles, threads,
                                  lattice_origin, flow);
  return engine::Engine<float>(settings, materials, colliders, particles, threads, lattice_origin,
                               flow);
}

}  // namespace

Simulation::Simulation(const SolverSettings& settings, const std::vector<Material>& materials,
                       const std::vector<shapes::Collider>& colliders,
                       const ParticleArrays& particles, int threads, const Vec3i& lattice_origin,
                       const seeding::Flow& flow)
    : impl_(new Impl{
          make_engine(settings, materials, colliders, particles, threads, lattice_origin, flow)}) {}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

double Simulation::time() const {
  return impl_->visit([](const auto& e) { return e.time(); });
}
std::size_t Simulation::steps() const {
  return impl_->visit([](const auto& e) { return e.steps(); });
}
std::size_t Simulation::particle_count() const {
  return impl_->visit([](const auto& e) { return e.particle_count(); });
}
seeding::FlowTotals Simulation::flow_totals() const {
  return impl_->visit([](const auto& e) { return e.flow_totals(); });
}
int Simulation::threads() const {
  return impl_->visit([](const auto& e) { return e.threads(); });
}
const char* Simulation::simd() const {
  return kernels::name(impl_->visit([](const auto& e) { return e.simd(); }));
}
PhaseSeconds Simulation::phase_seconds() const {
  return impl_->visit([](const auto& e) { return e.phase_seconds(); });
}
std::uint64_t Simulation::memory_bytes() const {
  return impl_->visit([](const auto& e) { return e.memory_bytes(); });
}

void Simulation::step(double dt) {
  impl_->visit([&](auto& e) { e.step(dt); });
}
AdvanceReport Simulation::advance_to(double time, bool (*interrupted)(), std::size_t last_step) {
  return impl_->visit([&](auto& e) { return e.advance_to(time, interrupted, last_step); });
}
void Simulation::apply(const SolverSettings& settings, const std::vector<Material>& materials,
                       const std::vector<shapes::Collider>& colliders) {
  impl_->visit([&](auto& e) { e.apply(settings, materials, colliders); });
}
std::vector<shapes::Collider> Simulation::colliders() const {
  return impl_->visit([](const auto& e) { return e.colliders(); });
}
DtChoice Simulation::choose_dt(double remaining) const {
  return impl_->visit([&](const auto& e) { return e.choose_dt(remaining); });
}
StepLimits Simulation::step_limits() const {
  return impl_->visit([](const auto& e) { return e.step_limits(); });
}
const std::optional<Divergence>& Simulation::divergence() const {
  return impl_->visit(
      [](const auto& e) -> const std::optional<Divergence>& { return e.divergence(); });
}
const Warnings& Simulation::warnings() const {
  return impl_->visit([](const auto& e) -> const Warnings& { return e.warnings(); });
}
SolveReport Simulation::last_solve() const {
  return impl_->visit([](const auto& e) { return e.last_solve(); });
}
Summary Simulation::summary() const {
  return impl_->visit([](const auto& e) { return e.summary(); });
}
ParticleArrays Simulation::particles() const {
  return impl_->visit([](const auto& e) { return e.particles(); });
}
std::vector<Mat3d> Simulation::kirchhoff() const {
  return impl_->visit([](const auto& e) { return e.kirchhoff(); });
}
std::vector<Vec3i> Simulation::cells() const {
  return impl_->visit([](const auto& e) { return e.cells(); });
}
std::uint64_t Simulation::state_hash() const {
  return impl_->visit([](const auto& e) { return e.state_hash(); });
}

std::vector<std::uint8_t> Simulation::save() const {
  return impl_->visit([](const auto& e) { return e.save(); });
}
void Simulation::restore(std::span<const std::uint8_t> bytes) {
  impl_->visit([&](auto& e) { e.restore(bytes); });
}

void Simulation::set_dt_scale(double scale) {
  impl_->visit([&](auto& e) { e.set_dt_scale(scale); });
}
double Simulation::dt_scale() const {
  return impl_->visit([](const auto& e) { return e.dt_scale(); });
}

/// For looking inside: what works on copies and is no part of a run.
struct InsideAccess {
  template <class Call>
  static decltype(auto) visit(const Simulation& simulation, Call&& call) {
    return simulation.impl_->visit(call);
  }
};

StagedStep staged_step(const Simulation& simulation, double dt) {
  return InsideAccess::visit(simulation, [&](const auto& e) { return e.staged_step(dt); });
}

EnergyAccount energy_account(const Simulation& simulation) {
  return InsideAccess::visit(simulation, [](const auto& e) { return e.energy_account(); });
}

RasterizedNodes rasterize(const Simulation& simulation,
                          const std::vector<std::vector<double>>& values) {
  return InsideAccess::visit(simulation, [&](const auto& e) { return e.rasterize(values); });
}

std::uint64_t estimate_memory(std::size_t particles, double particles_per_cell,
                              const SolverSettings& settings, int threads) {
  const bool is_double = settings.precision == Precision::real64;
  const double real = is_double ? 8 : 4;
  const double record = static_cast<double>(is_double ? sizeof(kernels::Particle<double>)
                                                      : sizeof(kernels::Particle<float>));
  // Record, key, local, order and its neighbours in Partition, and what prepare() gathers.
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
