#include "sim/state/state.h"

#include <algorithm>
#include <cmath>

namespace neve::sim::engine {

namespace {

/// Waking a thread costs more than it saves below this many particles per thread.
constexpr std::size_t particles_per_thread = 1000;

/// Sorting the storage costs more than it gains every step.
constexpr std::uint64_t steps_between_sorts = 32;

}  // namespace

template <class Real>
State<Real>::State(const SolverSettings& settings, const std::vector<Material>& materials,
                   const std::vector<shapes::Collider>& given, int threads,
                   const Vec3i& lattice_origin)
    : method(settings, materials, lattice_origin),
      pool(std::make_shared<ThreadPool>(threads)),
      colliders(given, method.lattice, 0, *pool) {
  particles.partition.set_period(settings.period);
  method.limit_hardening(progress.limits);
}

template <class Real>
void State<Real>::sort_into_blocks() {
  ParticleStorage<Real>& p = particles;
  p.partition.wrap(p.keys, *pool, active_threads());
  p.partition.build(p.keys, p.locals, *pool, active_threads());
}

template <class Real>
void State<Real>::partition() {
  sort_into_blocks();
  particles.partition.put_on_grid(*pool, active_threads());
}

template <class Real>
void State<Real>::partition_but_spray(double dt) {
  sort_into_blocks();
  colliders.look_ahead(method.lattice, progress.colliders_time, dt);
  const auto is_free = [&](std::uint64_t key) {
    return colliders.is_free(key, progress.limits.max_speed);
  };
  particles.partition.put_on_grid_but_spray(method.kernel_nodes, is_free, *pool, active_threads());
}

template <class Real>
void State<Real>::sort_storage() {
  if (progress.steps % steps_between_sorts != 0) return;
  ParticleStorage<Real>& p = particles;
  p.contacts.reorder(p.partition.order());
  p.partition.sort_storage(p.records, p.reordering, p.keys, p.locals, *pool, active_threads());
}

template <class Real>
kernels::SweepArgs<Real> State<Real>::sweep_args(double dt, int channels) {
  kernels::SweepArgs<Real> a{};
  a.constants = method.step_constants(dt);
  show_colliders(a);
  a.particles = particles.records.data();
  a.particle_count = static_cast<std::uint32_t>(particles.size());
  a.keys = particles.keys.data();
  a.locals = particles.locals.data();
  const Partition& blocks = particles.partition;
  a.order = blocks.order().data();
  a.blocks = blocks.blocks().data();
  a.node_blocks = blocks.node_blocks().data();
  a.spray = blocks.spray().data();
  a.channels = channels;
  const auto planes = static_cast<std::size_t>(channels);
  const std::size_t block_count = blocks.blocks().size();
  const std::size_t node_block_count = blocks.node_blocks().size();
  a.tiles = grid.tiles.at_least(block_count * planes * method.tile_nodes());
  a.nodes = grid.nodes.at_least(node_block_count * planes * kernels::block_nodes);
  const int spray_parts = blocks.spray().empty() ? 0 : parts();
  grid.reports.resize(block_count + static_cast<std::size_t>(spray_parts));
  grid.node_contact_work.resize(node_block_count);
  a.reports = grid.reports.data();
  a.node_contact_work = grid.node_contact_work.data();
  grid.loads.assign(colliders.list().size(), kernels::LoadSum{});
  grid.moved = colliders.moved();
  a.loads = grid.loads.data();
  a.load_count = static_cast<int>(grid.loads.size());
  a.load_unit = method.load_unit;
  return a;
}

/// Shows the colliders in reach where they are now; their number changes as they move.
template <class Real>
void State<Real>::show_colliders(kernels::SweepArgs<Real>& a) const {
  a.constants.colliders = colliders.poses().data();
  a.constants.collider_count = static_cast<int>(colliders.poses().size());
}

template <class Real>
void State<Real>::step_spray(const kernels::SweepArgs<Real>& a) const {
  const std::size_t clusters = particles.partition.spray().size();
  if (clusters == 0) return;
  kernels::BlockReport<Real>* reports = a.reports + particles.partition.blocks().size();
  const auto first = [&](int part) {
    return static_cast<std::uint32_t>(clusters * static_cast<std::size_t>(part) /
                                      static_cast<std::size_t>(parts()));
  };
  pool->run(active_threads(), parts(), [&](int part) {
    method.sweeps->spray(a, first(part), first(part + 1), reports[part]);
  });
}

template <class Real>
kernels::BlockReport<Real> State<Real>::refresh(std::size_t begin, std::size_t end) {
  kernels::BlockReport<Real> report;
  method.sweeps->refresh(sweep_args(0, kernels::all_channels), static_cast<std::uint32_t>(begin),
                         static_cast<std::uint32_t>(end), false, report);
  for (std::size_t q = begin; q < end; ++q)
    particles.largest_mass = std::max(particles.largest_mass, particles.records[q].m);
  return report;
}

template <class Real>
void State<Real>::advance_time(double dt) {
  progress.time += dt;
  ++progress.steps;
  if (method.settings.skips(Stage::colliders)) return;
  move_bodies(dt);
  progress.colliders_time = progress.time;
  colliders.place(method.lattice, progress.time, *pool);
  note_near_colliders();
}

/// Loads are impulses on the snow, about the points of the colliders.
template <class Real>
void State<Real>::move_bodies(double dt) {
  const rigid::RigidBodies& bodies = colliders.bodies();
  if (bodies.empty()) return;
  std::vector<rigid::Push> pushes(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const std::size_t k = bodies.collider(b);
    if (particles.size() == 0 || k >= grid.loads.size()) continue;
    const auto moment = [&](int a) { return static_cast<double>(grid.loads[k].moment[a]); };
    const auto impulse = [&](int a) { return static_cast<double>(grid.loads[k].impulse[a]); };
    pushes[b] = {-method.load_unit * Vec3d(impulse(0), impulse(1), impulse(2)),
                 -method.load_unit * Vec3d(moment(0), moment(1), moment(2))};
  }
  colliders.move_bodies(progress.colliders_time, dt, method.settings.gravity, pushes);
}

template <class Real>
void State<Real>::note_near_colliders() {
  progress.limits.max_collider_speed = fastest_near(particles.partition.all_blocks());
}

template <class Real>
double State<Real>::fastest_near(std::size_t begin, std::size_t end) const {
  if (colliders.list().empty()) return 0;
  return fastest_near(particles.partition.blocks_of(particles.keys, begin, end));
}

template <class Real>
double State<Real>::fastest_near(const std::vector<kernels::BlockRange>& blocks) const {
  return colliders.fastest_near(blocks, method.lattice, progress.colliders_time,
                                method.settings.max_dt, progress.limits.max_speed);
}

/// Computes in double, as the kernels see it: four particles at a time.
template <class Real>
void State<Real>::note_touching(std::size_t begin, std::size_t end) {
  using V = Quad<double>;
  if (!method.settings.is_contact_at_particles() || colliders.poses().empty()) return;
  const double h = method.settings.cell_size;
  const Vec3i origin = kernels::block_side * method.lattice.origin;
  particles.contacts.resize(particles.size());
  for (const kernels::ColliderPose& pose : colliders.poses()) {
    const auto collider = kernels::localize<double>(pose, origin.data(), h);
    for (std::size_t q = begin; q < end; q += 4) {
      Vec3<V> r, normal;
      for (std::size_t l = 0; l < 4; ++l) {
        const kernels::Particle<Real>& p = particles.records[std::min(q + l, end - 1)];
        for (int a = 0; a < 3; ++a)
          r[a][l] =
              (static_cast<double>(p.cell[a] - origin[a]) + static_cast<double>(p.offset[a])) * h;
      }
      const V distance = kernels::surface_distance(collider, r, normal);
      const bool holds = collider.contact != kernels::ContactLaw::separate;
      const double slack = holds ? kernels::touching_slack * h : 0;
      for (std::size_t l = 0; l < 4 && q + l < end; ++l)
        if (distance[l] < touching_distance(particles.records[q + l]) + slack)
          particles.contacts.add({0,
                                  {0, 0, 0},
                                  static_cast<Real>(std::max(distance[l], 0.0)),
                                  static_cast<std::uint32_t>(q + l),
                                  collider.index,
                                  kernels::no_contact});
    }
  }
}

template <class Real>
double State<Real>::touching_distance(const kernels::Particle<Real>& p) const {
  const Real half = method.half_spacing[static_cast<std::size_t>(p.material())];
  return std::min(
      kernels::touching_share * static_cast<double>(half) * std::cbrt(static_cast<double>(p.m)),
      kernels::max_touching * method.settings.cell_size);
}

template <class Real>
void State<Real>::push_out(kernels::SweepArgs<Real> a) const {
  if (!method.settings.push_out) return;
  show_colliders(a);
  over_particle_blocks(method.sweeps->push_out, a);
}

template <class Real>
int State<Real>::active_threads() const {
  const std::size_t wanted = particles.size() / particles_per_thread;
  return static_cast<int>(
      std::clamp<std::size_t>(wanted, 1, static_cast<std::size_t>(pool->thread_count())));
}

template struct State<float>;
template struct State<double>;

}  // namespace neve::sim::engine
