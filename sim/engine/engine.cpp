#include "sim/engine/engine.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "sim/engine/engine_records.h"

namespace neve::sim::engine {

namespace {

/// Below this many particles per thread, waking a thread costs more than it saves.
constexpr std::size_t particles_per_thread = 1000;

kernels::TransferKind transfer_kind(Transfer transfer) {
  switch (transfer) {
    case Transfer::apic:
      return kernels::TransferKind::apic;
    case Transfer::mls:
      return kernels::TransferKind::mls;
    default:
      return kernels::TransferKind::flip;
  }
}

/// Time since the last call.
class PhaseTimer {
 public:
  void add_to(double& seconds) {
    const auto now = std::chrono::steady_clock::now();
    seconds += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

template <class Real>
std::uint64_t Engine<Real>::memory_bytes() const {
  const std::size_t record = sizeof(kernels::Particle<Real>);
  std::size_t fields = 0;
  for (const auto& field : fields_) fields += field ? field->bytes() : 0;
  return fields + record * particles_.capacity() + reordering_.memory_bytes() +
         8 * keys_.capacity() + 2 * locals_.capacity() + partition_.memory_bytes() +
         tiles_.bytes() + nodes_.bytes() + elasticity_.bytes() + solve_vectors_.bytes() +
         8 * products_.capacity() + sizeof(kernels::BlockReport<Real>) * reports_.capacity() +
         8 * node_contact_work_.capacity();
}

template <class Real>
Engine<Real>::Engine(const SolverSettings& settings, const std::vector<Material>& materials,
                     const std::vector<shapes::Collider>& colliders,
                     const ParticleArrays& particles, int threads, const Vec3i& lattice_origin,
                     const seeding::Flow& flow)
    : settings_(settings),
      material_list_(materials),
      colliders_(colliders),
      lattice_origin_(lattice_origin),
      pool_(std::make_shared<ThreadPool>(threads)) {
  if (materials.empty()) throw std::invalid_argument("a simulation needs a material");
  if (colliders.size() > kernels::max_colliders)
    throw std::invalid_argument("at most " + std::to_string(kernels::max_colliders) + " colliders");
  use_materials();
  simd_ = kernels::chosen_simd_level();
  use_sweeps();
  if (settings.period.minCoeff() < 0 || settings.period.maxCoeff() > kernels::block_limit)
    throw std::invalid_argument("a period of the lattice is negative or too long");
  partition_.set_period(settings.period);
  fields_ = fields_of(colliders_);
  place_colliders();
  load(particles);
  prepare();
  open(flow);
}

template <class Real>
void Engine<Real>::use_materials() {
  materials_.clear();
  limits_.max_hardening = 0;
  for (const Material& m : material_list_) {
    if (m.yields && material_list_.size() > 1)
      throw std::invalid_argument("material " + m.name +
                                  " yields besides snow: it must be the only material");
    const Lame rest = lame(m.youngs_modulus, m.poisson_ratio);
    materials_.push_back({static_cast<Real>(rest.mu), static_cast<Real>(rest.lambda),
                          static_cast<Real>(m.hardening), static_cast<Real>(m.critical_compression),
                          static_cast<Real>(m.critical_stretch)});
    limits_.max_hardening = std::max(limits_.max_hardening, m.hardening);
  }
}

template <class Real>
void Engine<Real>::use_sweeps() {
  kernel_nodes_ =
      settings_.kernel == Kernel::cubic ? kernels::cubic_nodes : kernels::quadratic_nodes;
  sweeps_ = &kernels::sweeps_for(simd_, kernel_nodes_, transfer_kind(settings_.transfer), Real());
  solve_sweeps_ =
      &kernels::solve_sweeps_for(simd_, kernel_nodes_, settings_.transfer == Transfer::mls, Real());
}

/// Everything the first step relies on: stress, keys, volumes of new bodies, and the limits on dt.
template <class Real>
void Engine<Real>::prepare() {
  kernels::SweepArgs<Real> a = args(0, kernels::all_channels);
  kernels::BlockReport<Real> report;
  const auto count = static_cast<std::uint32_t>(particles_.size());
  sweeps_->refresh(a, 0, count, false, report);
  if (report.overflowed > 0) throw std::invalid_argument("a particle starts outside the lattice");
  if (count == 0) return;

  // Volumes and the velocity gradient want the rasterised mass and velocity.
  partition();
  a = args(0, kernels::all_channels);
  std::vector<kernels::StagedNodes<Real>> staged(partition_.node_blocks().size());
  std::vector<kernels::Gathered<Real>> gathered(particles_.size());
  a.staged = staged.data();
  a.gathered = gathered.data();
  over_particle_blocks(sweeps_->rasterize, a);
  over_node_blocks(sweeps_->collect_momentum, a);
  if (!settings_.skips(Stage::volumes)) over_particle_blocks(sweeps_->volumes, a);
  for (kernels::StagedNodes<Real>& nodes : staged)
    std::copy(std::begin(nodes.v_old), std::end(nodes.v_old), std::begin(nodes.v_star));
  over_node_blocks(sweeps_->keep_velocities, a);
  over_particle_blocks(sweeps_->gather, a);

  report = {};
  sweeps_->refresh(a, 0, count, false, report);
  for (const kernels::Gathered<Real>& g : gathered)
    for (const Real entry : g.grad_v)
      report.max_strain_rate = std::max(report.max_strain_rate, std::abs(entry));
  limits_.max_speed = std::sqrt(static_cast<double>(report.max_speed_squared));
  limits_.max_sound_speed = std::sqrt(static_cast<double>(report.max_sound_squared));
  limits_.max_strain_rate = static_cast<double>(report.max_strain_rate);
  StateLimits at_rest = limits_;
  at_rest.max_strain_rate = 0;
  start_.max_speed = limits_.max_speed;
  start_.max_sound_speed = limits_.max_sound_speed;
  rest_dt_ = std::min(settings_.max_dt, stable_dt(settings_, at_rest));
  const Summary start = summary();
  energy_.start = start.kinetic_energy + start.elastic_energy;
  energy_.largest = energy_.start;
  energy_.moment = start.mass * start.centre_of_mass;
}

template <class Real>
kernels::SweepArgs<Real> Engine<Real>::args(double dt, int channels) {
  const double h = settings_.cell_size;
  kernels::SweepArgs<Real> a{};
  kernels::StepConstants<Real>& c = a.constants;
  c.h = static_cast<Real>(h);
  c.inv_h = static_cast<Real>(1 / h);
  c.dt = static_cast<Real>(dt);
  c.dt_over_h = static_cast<Real>(dt / h);
  c.alpha = static_cast<Real>(flip_share(settings_, dt));
  for (int axis = 0; axis < 3; ++axis) c.gravity[axis] = static_cast<Real>(settings_.gravity[axis]);
  c.moves_with_grid = settings_.advect == Advect::pic;
  c.h_double = h;
  c.materials = materials_.data();
  c.colliders = poses_.data();
  c.collider_count = static_cast<int>(poses_.size());
  a.particles = particles_.data();
  a.particle_count = static_cast<std::uint32_t>(particles_.size());
  a.keys = keys_.data();
  a.locals = locals_.data();
  a.order = partition_.order().data();
  a.blocks = partition_.blocks().data();
  a.node_blocks = partition_.node_blocks().data();
  const std::size_t block_count = partition_.blocks().size();
  const std::size_t node_block_count = partition_.node_blocks().size();
  const std::size_t tile = static_cast<std::size_t>(
      kernel_nodes_ == kernels::cubic_nodes ? kernels::Tile<kernels::cubic_nodes>::nodes
                                            : kernels::Tile<kernels::quadratic_nodes>::nodes);
  a.channels = channels;
  const auto planes = static_cast<std::size_t>(channels);
  a.tiles = tiles_.at_least(block_count * planes * tile);
  a.nodes = nodes_.at_least(node_block_count * planes * kernels::block_nodes);
  reports_.resize(block_count);
  node_contact_work_.resize(node_block_count);
  a.reports = reports_.data();
  a.node_contact_work = node_contact_work_.data();
  return a;
}

template <class Real>
int Engine<Real>::active_threads() const {
  const std::size_t wanted = particles_.size() / particles_per_thread;
  return static_cast<int>(
      std::clamp<std::size_t>(wanted, 1, static_cast<std::size_t>(pool_->thread_count())));
}

template <class Real>
void Engine<Real>::partition() {
  partition_.wrap(keys_, *pool_, active_threads());
  partition_.build(keys_, locals_, *pool_, active_threads());
}

template <class Real>
void Engine<Real>::sort_storage() {
  partition_.sort_storage(particles_, reordering_, keys_, locals_, *pool_, active_threads());
}

template <class Real>
void Engine<Real>::step(double dt) {
  take_step(dt);
  if (!divergence_) exchange();
}

template <class Real>
void Engine<Real>::take_step(double dt) {
  if (particles_.empty()) {
    time_ += dt;
    ++steps_;
    move_colliders();
    return;
  }
  if (takes_stages()) {
    step_by_stages(dt);
    return;
  }
  if (take_fused(dt, settings_.is_implicit())) return;
  const int parts = explicit_parts(dt);
  for (int part = 0; part < parts && !divergence_; ++part) take_fused(dt / parts, false);
}

template <class Real>
bool Engine<Real>::take_fused(double dt, bool is_implicit) {
  PhaseSeconds& seconds = phase_seconds_;
  PhaseTimer timer;
  partition();
  if (steps_ % steps_between_sorts == 0) sort_storage();
  const kernels::SweepArgs<Real> a = args(dt, sweeps_->fused_channels);
  timer.add_to(seconds.partition);
  over_particle_blocks(sweeps_->particles_to_grid, a);
  timer.add_to(seconds.particles_to_grid);
  over_node_blocks(sweeps_->grid_update, a);
  timer.add_to(seconds.grid_update);
  if (is_implicit) {
    const bool is_solved = solve_velocities(a, dt);
    timer.add_to(seconds.solve);
    if (!is_solved) return false;
  }
  over_particle_blocks(sweeps_->grid_to_particles, a);
  timer.add_to(seconds.grid_to_particles);
  end_step(dt, a);
  note(dt);
  timer.add_to(seconds.checks);
  return true;
}

template <class Real>
StepLimits Engine<Real>::step_limits() const {
  return {limits_on_dt(settings_, limits_), limits_.max_speed, limits_.max_sound_speed,
          limits_.max_strain_rate};
}

template <class Real>
DtChoice Engine<Real>::choose_dt(double remaining) const {
  return engine::choose_dt(settings_, limits_, remaining, dt_scale_);
}

template <class Real>
AdvanceReport Engine<Real>::advance_to(double time, bool (*interrupted)(), std::size_t last_step) {
  AdvanceReport report;
  if (!(frame_end_ == time && time_ == frame_start_ + frame_done_)) {
    frame_start_ = time_;
    frame_done_ = 0;
    frame_end_ = time;
  }
  // Counting from the start of the frame keeps the end of the frame exact.
  const double start = frame_start_, whole = time - start;
  double& done = frame_done_;
  while (done < whole && !divergence_ && steps_ < last_step) {
    const DtChoice choice = choose_dt(whole - done);
    last_limit_ = choice.limit;
    const std::size_t steps_before = steps_;
    step(choice.dt);
    done += choice.dt;
    if (settings_.is_implicit()) {
      if (!report.solve) report.solve.emplace();
      report.solve->add(last_solve_);
    }
    const bool is_last = choice.limit == DtLimit::frame_end && !(done < whole * (1 - 1e-12));
    if (is_last) done = whole;
    time_ = start + done;
    // Explicit steps may have taken the place of one.
    const std::size_t steps = steps_ - steps_before;
    const double dt = steps > 1 ? last_dt_ : choice.dt;
    report.dt_min = report.steps == 0 ? dt : std::min(report.dt_min, dt);
    report.dt_max = std::max(report.dt_max, dt);
    const DtLimit limit = steps > 1 ? explicit_limit() : choice.limit;
    report.ruled[static_cast<std::size_t>(limit)] += steps;
    report.steps += steps;
    if (interrupted && interrupted()) break;
  }
  if (done >= whole) {
    time_ = time;
    if (!divergence_) check_energy();
  }
  return report;
}

template class Engine<float>;
template class Engine<double>;

}  // namespace neve::sim::engine
