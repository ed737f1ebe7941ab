#include "sim/engine.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/base/hash.h"
#include "sim/diagnostics.h"

namespace neve::sim {

namespace {

/// Storage is put into block order this often: sorting costs more than it gains every step.
constexpr std::size_t steps_between_sorts = 32;
/// Below this many particles per thread, waking a thread costs more than it saves.
constexpr std::size_t particles_per_thread = 2000;
/// Energy is added up this often, and whenever a frame ends.
constexpr std::size_t steps_between_energy_checks = 64;

TransferKind transfer_kind(Transfer transfer) {
  switch (transfer) {
    case Transfer::apic: return TransferKind::apic;
    case Transfer::mls: return TransferKind::mls;
    default: return TransferKind::flip;
  }
}

ModelKind model_kind(Model model) {
  switch (model) {
    case Model::corotated: return ModelKind::corotated;
    case Model::neo_hookean: return ModelKind::neo_hookean;
    default: return ModelKind::snow;
  }
}

ColliderShape collider_shape(const Collider& c) {
  if (std::holds_alternative<Plane>(c.shape.form)) return ColliderShape::plane;
  if (std::holds_alternative<Sphere>(c.shape.form)) return ColliderShape::sphere;
  if (std::holds_alternative<Box>(c.shape.form)) return ColliderShape::box;
  throw std::invalid_argument("collider \"" + c.name + "\" must be a plane, a sphere or a box");
}

/// Splits a coordinate in cells into the cell and the offset in it; the offset is below 1 also after
/// rounding to Real.
template <class Real>
void split(double in_cells, int& cell, Real& offset) {
  const double whole = std::floor(in_cells);
  cell = static_cast<int>(whole);
  offset = static_cast<Real>(in_cells - whole);
  if (offset >= Real(1)) {
    ++cell;
    offset = 0;
  }
}

template <class Real>
Mat3d matrix(const Real* row_by_row) {
  Mat3d m;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) m(a, b) = static_cast<double>(row_by_row[3 * a + b]);
  return m;
}

template <class Real>
void store_matrix(const Mat3d& m, Real* row_by_row) {
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) row_by_row[3 * a + b] = static_cast<Real>(m(a, b));
}

template <class Real>
void require_length(const std::vector<Real>& array, std::size_t count, const char* what) {
  if (!array.empty() && array.size() != count)
    throw std::invalid_argument(std::string(what) + " has another length than x");
}

}  // namespace

template <class Real>
Engine<Real>::Engine(const SolverSettings& settings, const std::vector<Material>& materials,
                     const std::vector<Collider>& colliders, const ParticleArrays& particles,
                     int threads, const Vec3i& lattice_origin)
    : settings_(settings),
      material_list_(materials),
      colliders_(colliders),
      lattice_origin_(lattice_origin),
      pool_(std::make_shared<ThreadPool>(threads)) {
  if (materials.empty()) throw std::invalid_argument("a simulation needs a material");
  if (colliders.size() > max_colliders)
    throw std::invalid_argument("at most " + std::to_string(max_colliders) + " colliders");
  for (const Material& m : materials) {
    const Lame rest = lame(m.youngs_modulus, m.poisson_ratio);
    materials_.push_back({static_cast<Real>(rest.mu), static_cast<Real>(rest.lambda),
                          static_cast<Real>(m.hardening),
                          static_cast<Real>(m.critical_compression),
                          static_cast<Real>(m.critical_stretch)});
  }
  kernel_nodes_ = settings.kernel == Kernel::cubic ? cubic_nodes : quadratic_nodes;
  sweeps_ = &baseline_sweeps(kernel_nodes_, transfer_kind(settings.transfer), Real());
  poses_.resize(colliders_.size());
  place_colliders();
  load(particles);
  prepare();
}

template <class Real>
void Engine<Real>::load(const ParticleArrays& in) {
  const std::size_t count = in.x.size();
  require_length(in.v, count, "v");
  require_length(in.m, count, "m");
  require_length(in.V0, count, "V0");
  require_length(in.F_E, count, "F_E");
  require_length(in.J_P, count, "J_P");
  require_length(in.C, count, "C");
  require_length(in.material, count, "material");
  if (in.m.size() != count) throw std::invalid_argument("every particle needs a mass");
  particles_.resize(count);
  keys_.resize(count);
  locals_.resize(count);
  for (std::size_t q = 0; q < count; ++q) {
    Particle<Real>& p = particles_[q];
    p = Particle<Real>{};
    p.id = static_cast<std::uint32_t>(q);
    const int material = in.material.empty() ? 0 : in.material[q];
    if (material < 0 || static_cast<std::size_t>(material) >= material_list_.size())
      throw std::invalid_argument("a particle names a material that does not exist");
    p.material = static_cast<std::uint16_t>(material);
    p.model = static_cast<std::uint8_t>(
        model_kind(material_list_[static_cast<std::size_t>(material)].model));
    for (int a = 0; a < 3; ++a) {
      const double in_cells = in.x[q][a] / settings_.cell_size;
      if (!(std::abs(in_cells) < 4.0 * block_limit))
        throw std::invalid_argument("a particle starts outside the lattice");
      split(in_cells, p.cell[a], p.offset[a]);
      p.cell[a] += block_side * lattice_origin_[a];
      p.v[a] = in.v.empty() ? Real(0) : static_cast<Real>(in.v[q][a]);
    }
    p.m = static_cast<Real>(in.m[q]);
    p.V0 = in.V0.empty() ? Real(0) : static_cast<Real>(in.V0[q]);
    if (!(p.m > Real(0)) || !(p.V0 >= Real(0)))
      throw std::invalid_argument("a particle's mass or volume is not positive");
    if (p.V0 == Real(0)) p.flags |= needs_volume;
    store_matrix(in.F_E.empty() ? Mat3d(Mat3d::Identity()) : in.F_E[q], p.F_E);
    store_matrix(in.C.empty() ? Mat3d(Mat3d::Zero()) : in.C[q], p.C);
    p.J_P = in.J_P.empty() ? Real(1) : static_cast<Real>(in.J_P[q]);
    p.stiffness = 1;
    p.threshold = 1;
  }
}

/// Everything the first step relies on: stress, keys, volumes of new bodies, and the limits on dt.
template <class Real>
void Engine<Real>::prepare() {
  SweepArgs<Real> a = args(0);
  BlockReport<Real> report;
  const auto count = static_cast<std::uint32_t>(particles_.size());
  sweeps_->refresh(a, 0, count, report);
  if (report.overflowed > 0) throw std::invalid_argument("a particle starts outside the lattice");
  if (count == 0) return;

  // Volumes and the velocity gradient want the rasterised mass and velocity.
  partition();
  a = args(0);
  std::vector<StagedNodes<Real>> staged(partition_.node_blocks().size());
  std::vector<Gathered<Real>> gathered(particles_.size());
  a.staged = staged.data();
  a.gathered = gathered.data();
  over_particle_blocks(sweeps_->rasterize, a);
  over_node_blocks(sweeps_->collect_momentum, a);
  over_particle_blocks(sweeps_->volumes, a);
  for (StagedNodes<Real>& nodes : staged)
    std::copy(std::begin(nodes.v_old), std::end(nodes.v_old), std::begin(nodes.v_star));
  over_node_blocks(sweeps_->keep_velocities, a);
  over_particle_blocks(sweeps_->gather, a);

  report = {};
  sweeps_->refresh(a, 0, count, report);
  for (const Gathered<Real>& g : gathered)
    for (const Real entry : g.grad_v)
      report.max_strain_rate = std::max(report.max_strain_rate, std::abs(entry));
  limits_.max_speed = std::sqrt(static_cast<double>(report.max_speed_squared));
  limits_.max_sound_speed = std::sqrt(static_cast<double>(report.max_sound_squared));
  limits_.max_strain_rate = static_cast<double>(report.max_strain_rate);
  for (const Material& m : material_list_)
    limits_.max_hardening = std::max(limits_.max_hardening, m.hardening);
  StateLimits at_rest = limits_;
  at_rest.max_strain_rate = 0;
  rest_dt_ = std::min(settings_.max_dt, stable_dt(settings_, at_rest));
  const Summary start = summary();
  energy_.start = start.kinetic_energy + start.elastic_energy;
  energy_.largest = energy_.start;
  energy_.centre_of_mass = start.centre_of_mass;
}

template <class Real>
void Engine<Real>::place_colliders() {
  const double h = settings_.cell_size;
  for (std::size_t k = 0; k < colliders_.size(); ++k) {
    const Collider& c = colliders_[k];
    const Pose pose = pose_at(c, time_);
    ColliderPose& out = poses_[k];
    out = ColliderPose{};
    out.shape = collider_shape(c);
    out.contact = static_cast<ContactLaw>(c.contact);
    out.friction = c.friction;
    for (int a = 0; a < 3; ++a) {
      const double in_cells = pose.point[a] / h;
      if (!(std::abs(in_cells) < 4.0 * block_limit))
        throw std::invalid_argument("collider \"" + c.name + "\" is outside the lattice");
      split(in_cells, out.cell[a], out.offset[a]);
      out.cell[a] += block_side * lattice_origin_[a];
      out.velocity[a] = c.velocity[a];
      out.omega[a] = c.angular_velocity[a];
      for (int b = 0; b < 3; ++b) out.axes[3 * a + b] = pose.rotation(a, b);
    }
    if (const auto* plane = std::get_if<Plane>(&c.shape.form)) {
      const Vec3d n = pose.rotation * plane->normal.normalized();
      for (int a = 0; a < 3; ++a) out.normal[a] = n[a];
    } else if (const auto* sphere = std::get_if<Sphere>(&c.shape.form)) {
      out.radius = sphere->radius;
    } else if (const auto* box = std::get_if<Box>(&c.shape.form)) {
      for (int a = 0; a < 3; ++a) out.half[a] = 0.5 * box->size[a];
    }
  }
}

template <class Real>
SweepArgs<Real> Engine<Real>::args(double dt) {
  const double h = settings_.cell_size;
  SweepArgs<Real> a{};
  StepConstants<Real>& c = a.constants;
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
  a.keys = keys_.data();
  a.locals = locals_.data();
  a.order = partition_.order().data();
  a.blocks = partition_.blocks().data();
  a.node_blocks = partition_.node_blocks().data();
  const std::size_t block_count = partition_.blocks().size();
  const std::size_t node_block_count = partition_.node_blocks().size();
  const std::size_t tile = static_cast<std::size_t>(
      kernel_nodes_ == cubic_nodes ? Tile<cubic_nodes>::nodes : Tile<quadratic_nodes>::nodes);
  a.tiles = tiles_.at_least(block_count * tile_channels * tile);
  a.nodes = nodes_.at_least(node_block_count * node_channels * block_nodes);
  reports_.resize(block_count);
  node_contact_work_.resize(node_block_count);
  a.reports = reports_.data();
  a.node_contact_work = node_contact_work_.data();
  return a;
}

template <class Real>
int Engine<Real>::active_threads() const {
  const std::size_t wanted = particles_.size() / particles_per_thread;
  return static_cast<int>(std::clamp<std::size_t>(wanted, 1,
                                                  static_cast<std::size_t>(pool_->thread_count())));
}

template <class Real>
void Engine<Real>::partition() {
  partition_.build(keys_, locals_, *pool_, active_threads());
}

template <class Real>
void Engine<Real>::sort_storage() {
  const std::vector<std::uint32_t>& order = partition_.order();
  sorted_.resize(particles_.size());
  pool_->ranges(order.size(), active_threads(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) sorted_[q] = particles_[order[q]];
  });
  particles_.swap(sorted_);
  partition_.storage_was_sorted();
}

template <class Real>
void Engine<Real>::over_particle_blocks(Sweep<Real> sweep, const SweepArgs<Real>& a) {
  const int threads = active_threads();
  pool_->run(threads, [&](int t) {
    sweep(a, partition_.first_block(t, threads), partition_.first_block(t + 1, threads));
  });
}

template <class Real>
void Engine<Real>::over_node_blocks(Sweep<Real> sweep, const SweepArgs<Real>& a) {
  pool_->ranges(partition_.node_blocks().size(), active_threads(),
                [&](std::size_t begin, std::size_t end) {
                  sweep(a, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end));
                });
}

template <class Real>
void Engine<Real>::step(double dt) {
  if (particles_.empty()) {
    time_ += dt;
    ++steps_;
    return;
  }
  partition();
  if (steps_ % steps_between_sorts == 0) sort_storage();
  const SweepArgs<Real> a = args(dt);
  over_particle_blocks(sweeps_->particles_to_grid, a);
  over_node_blocks(sweeps_->grid_update, a);
  over_particle_blocks(sweeps_->grid_to_particles, a);
  time_ += dt;
  ++steps_;
  place_colliders();
  note(dt);
}

template <class Real>
Simulation::Choice Engine<Real>::choose_dt(double remaining) const {
  return sim::choose_dt(settings_, limits_, remaining);
}

template <class Real>
AdvanceReport Engine<Real>::advance_to(double time, bool (*interrupted)()) {
  AdvanceReport report;
  const double start = time_;
  // Counting from the start of the frame keeps the end of the frame exact.
  double done = 0;
  const double whole = time - start;
  while (done < whole && !divergence_) {
    const Simulation::Choice choice = choose_dt(whole - done);
    step(choice.dt);
    done += choice.dt;
    const bool is_last = choice.limit == DtLimit::frame_end && !(done < whole * (1 - 1e-12));
    if (is_last) done = whole;
    time_ = start + done;
    report.dt_min = report.steps == 0 ? choice.dt : std::min(report.dt_min, choice.dt);
    report.dt_max = std::max(report.dt_max, choice.dt);
    ++report.ruled[static_cast<std::size_t>(choice.limit)];
    ++report.steps;
    if (interrupted && interrupted()) break;
  }
  if (done >= whole) {
    time_ = time;
    if (!divergence_) check_energy();
  }
  return report;
}

/// Extremes of all blocks.
template <class Real>
BlockReport<Real> Engine<Real>::combined_report() const {
  BlockReport<Real> all;
  for (const BlockReport<Real>& r : reports_) {
    all.max_speed_squared = std::max(all.max_speed_squared, r.max_speed_squared);
    all.max_sound_squared = std::max(all.max_sound_squared, r.max_sound_squared);
    all.max_strain_rate = std::max(all.max_strain_rate, r.max_strain_rate);
    all.min_J_P = std::min(all.min_J_P, r.min_J_P);
    all.max_J_P = std::max(all.max_J_P, r.max_J_P);
    all.contact_work += r.contact_work;
    all.inverted += r.inverted;
    all.inverted_unprojected += r.inverted_unprojected;
    all.not_finite += r.not_finite;
    all.overflowed += r.overflowed;
  }
  for (const double work : node_contact_work_) all.contact_work += work;
  return all;
}

template <class Real>
void Engine<Real>::note(double dt) {
  const BlockReport<Real> report = combined_report();
  const StateLimits before = limits_;
  limits_.max_speed = std::sqrt(static_cast<double>(report.max_speed_squared));
  limits_.max_sound_speed = std::sqrt(static_cast<double>(report.max_sound_squared));
  limits_.max_strain_rate = static_cast<double>(report.max_strain_rate);
  warnings_.inverted_trials += report.inverted;
  energy_.contact_work += report.contact_work;
  if (!divergence_) check(dt, before, report);
  if (!divergence_ && steps_ % steps_between_energy_checks == 0) check_energy();
}

/// The rules of a healthy step that its own report can answer.
template <class Real>
void Engine<Real>::check(double dt, const StateLimits& before, const BlockReport<Real>& report) {
  const double h = settings_.cell_size;
  const double speed_cfl = limits_.max_speed * dt / h;
  const double acoustic_cfl = limits_.max_sound_speed * dt / h;
  warnings_.worst_speed_cfl = std::max(warnings_.worst_speed_cfl, speed_cfl);
  warnings_.worst_acoustic_cfl = std::max(warnings_.worst_acoustic_cfl, acoustic_cfl);
  const double holds = stable_dt(settings_, before);
  const bool is_adaptive = settings_.time_step == TimeStep::adaptive;
  if (report.not_finite > 0) {
    diverge("not_finite", "deformation", dt, report.not_finite, 0);
  } else if (report.overflowed > 0) {
    diverge("overflow", "advection", dt, report.overflowed, 0);
  } else if (speed_cfl > 1) {
    diverge("speed_cfl", "particle_velocities", dt, speed_cfl, 1);
  } else if (report.inverted_unprojected > 0) {
    diverge("inverted", "deformation", dt, report.inverted_unprojected, 0);
  } else if (report.min_J_P < Real(0.1)) {
    diverge("J_P", "deformation", dt, static_cast<double>(report.min_J_P), 0.1);
  } else if (is_adaptive && acoustic_cfl > 1.5) {
    diverge("acoustic_cfl", "deformation", dt, acoustic_cfl, 1.5);
  } else if (is_adaptive && choose_dt(1).dt < 1e-4 * rest_dt_) {
    // Not a rule of stability: without it a run that hardens without end would never end.
    diverge("time_step", "deformation", dt, choose_dt(1).dt, 1e-4 * rest_dt_);
  }
  if (divergence_) divergence_->dt_that_holds = holds;
}

/// Kinetic plus elastic energy may not exceed by more than 10 % what the run started with plus the
/// work of gravity and colliders.
template <class Real>
void Engine<Real>::check_energy() {
  if (particles_.empty()) return;
  const Summary now = summary();
  const double gravity_work =
      now.mass * settings_.gravity.dot(now.centre_of_mass - energy_.centre_of_mass);
  const double budget = energy_.start + gravity_work + energy_.contact_work;
  energy_.largest = std::max(energy_.largest, budget);
  // A cell's fall: what rounding and the first contact may do to snow that starts at rest.
  const double floor = now.mass * settings_.gravity.norm() * settings_.cell_size;
  const double found = now.kinetic_energy + now.elastic_energy;
  const double allowed = budget + 0.1 * std::max(energy_.largest, floor) + 1e-12 * now.mass;
  if (found <= allowed) return;
  diverge("energy", "particle_velocities", 0, found, allowed);
  divergence_->dt_that_holds = stable_dt(settings_, limits_);
}

template <class Real>
void Engine<Real>::diverge(const char* rule, const char* stage, double dt, double value,
                           double limit) {
  Divergence d;
  d.step = steps_;
  d.time = time_;
  d.rule = rule;
  d.stage = stage;
  d.dt = dt;
  d.value = value;
  d.limit = limit;
  find_culprits(particles(), settings_, material_list_, d);
  divergence_ = d;
}

template <class Real>
Summary Engine<Real>::summary() const {
  // Sums over fixed chunks, added in order: the same bits at any number of threads.
  constexpr std::size_t chunk = 4096;
  const std::size_t chunks = (particles_.size() + chunk - 1) / chunk;
  std::vector<Summary> parts(chunks);
  const bool has_C = settings_.transfer != Transfer::flip;
  const double inertia = settings_.cell_size * settings_.cell_size *
                         (kernel_nodes_ == cubic_nodes ? apic_inertia<cubic_nodes>
                                                       : apic_inertia<quadratic_nodes>);
  pool_->ranges(chunks, active_threads(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const std::size_t last = std::min(particles_.size(), (c + 1) * chunk);
      for (std::size_t q = c * chunk; q < last; ++q) {
        const Particle<Real>& p = particles_[q];
        Summary& s = parts[c];
        const double m = static_cast<double>(p.m), J_P = static_cast<double>(p.J_P);
        Vec3d x, v;
        for (int a = 0; a < 3; ++a) {
          x[a] = (static_cast<double>(p.cell[a] - block_side * lattice_origin_[a]) +
                  static_cast<double>(p.offset[a])) * settings_.cell_size;
          v[a] = static_cast<double>(p.v[a]);
        }
        const Mat3d C = matrix(p.C);
        s.mass += m;
        s.kinetic_energy += 0.5 * m * v.squaredNorm();
        s.momentum += m * v;
        s.centre_of_mass += m * x;
        s.angular_momentum += m * x.cross(v);
        if (has_C) {
          s.kinetic_energy += 0.5 * m * inertia * C.squaredNorm();
          s.angular_momentum += m * inertia * Vec3d(C(2, 1) - C(1, 2), C(0, 2) - C(2, 0),
                                                    C(1, 0) - C(0, 1));
        }
        s.elastic_energy += static_cast<double>(p.V0) * static_cast<double>(p.stiffness) *
                            energy_density(material_list_[p.material], matrix(p.F_E), J_P);
        s.max_speed = std::max(s.max_speed, v.norm());
        s.min_J_P = q == c * chunk ? J_P : std::min(s.min_J_P, J_P);
        s.max_J_P = q == c * chunk ? J_P : std::max(s.max_J_P, J_P);
      }
    }
  });
  Summary all;
  for (std::size_t c = 0; c < chunks; ++c) {
    const Summary& s = parts[c];
    all.mass += s.mass;
    all.kinetic_energy += s.kinetic_energy;
    all.elastic_energy += s.elastic_energy;
    all.momentum += s.momentum;
    all.centre_of_mass += s.centre_of_mass;
    all.angular_momentum += s.angular_momentum;
    all.max_speed = std::max(all.max_speed, s.max_speed);
    all.min_J_P = c == 0 ? s.min_J_P : std::min(all.min_J_P, s.min_J_P);
    all.max_J_P = c == 0 ? s.max_J_P : std::max(all.max_J_P, s.max_J_P);
  }
  all.time = time_;
  all.particles = particles_.size();
  if (all.mass > 0) all.centre_of_mass /= all.mass;
  return all;
}

template <class Real>
ParticleArrays Engine<Real>::particles() const {
  ParticleArrays out;
  const std::size_t count = particles_.size();
  out.x.resize(count);
  out.v.resize(count);
  out.m.resize(count);
  out.V0.resize(count);
  out.F_E.resize(count);
  out.J_P.resize(count);
  out.C.resize(count);
  out.material.resize(count);
  for (const Particle<Real>& p : particles_) {
    const std::size_t id = p.id;
    for (int a = 0; a < 3; ++a) {
      out.x[id][a] = (static_cast<double>(p.cell[a] - block_side * lattice_origin_[a]) +
                      static_cast<double>(p.offset[a])) * settings_.cell_size;
      out.v[id][a] = static_cast<double>(p.v[a]);
    }
    out.m[id] = static_cast<double>(p.m);
    out.V0[id] = static_cast<double>(p.V0);
    out.F_E[id] = matrix(p.F_E);
    out.J_P[id] = static_cast<double>(p.J_P);
    out.C[id] = matrix(p.C);
    out.material[id] = p.material;
  }
  return out;
}

template <class Real>
std::vector<Mat3d> Engine<Real>::kirchhoff() const {
  std::vector<Mat3d> out(particles_.size());
  for (const Particle<Real>& p : particles_) {
    const Real* t = p.tau;
    const Real full[9] = {t[0], t[3], t[4], t[3], t[1], t[5], t[4], t[5], t[2]};
    out[p.id] = matrix(full);
  }
  return out;
}

template <class Real>
std::vector<Vec3i> Engine<Real>::cells() const {
  std::vector<Vec3i> out(particles_.size());
  for (const Particle<Real>& p : particles_) out[p.id] = Vec3i(p.cell[0], p.cell[1], p.cell[2]);
  return out;
}

template <class Real>
std::uint64_t Engine<Real>::state_hash() const {
  std::uint64_t sum = 0;
  for (const Particle<Real>& p : particles_) {
    std::int32_t cell[3];
    for (int a = 0; a < 3; ++a) cell[a] = p.cell[a] - block_side * lattice_origin_[a];
    std::uint64_t hash = hash_bytes(cell, sizeof cell);
    hash = hash_bytes(p.offset, sizeof p.offset, hash);
    hash = hash_bytes(p.v, sizeof p.v, hash);
    hash = hash_bytes(&p.m, sizeof p.m, hash);
    hash = hash_bytes(&p.V0, sizeof p.V0, hash);
    hash = hash_bytes(p.F_E, sizeof p.F_E, hash);
    hash = hash_bytes(&p.J_P, sizeof p.J_P, hash);
    hash = hash_bytes(p.C, sizeof p.C, hash);
    sum += mix64(p.id, hash);
  }
  return sum;
}

template <class Real>
StagedStep Engine<Real>::staged_step(double dt) const {
  Engine copy(*this);
  StagedStep out;
  if (particles_.empty()) return out;
  copy.partition();
  if (copy.steps_ % steps_between_sorts == 0) copy.sort_storage();
  SweepArgs<Real> a = copy.args(dt);
  std::vector<StagedNodes<Real>> staged(copy.partition_.node_blocks().size());
  std::vector<Gathered<Real>> gathered(particles_.size());
  std::vector<Real> F_trial(9 * particles_.size());
  LaneBuffer<Real> v_before;
  a.staged = staged.data();
  a.gathered = gathered.data();
  a.F_trial = F_trial.data();
  a.v_before_collision = v_before.at_least(particles_.size());
  const Sweeps<Real>& s = *sweeps_;
  copy.over_particle_blocks(s.rasterize, a);            // 1  mass, momentum, v_old
  copy.over_node_blocks(s.collect_momentum, a);
  copy.over_particle_blocks(s.volumes, a);              // 2  of bodies in their first step
  copy.over_particle_blocks(s.elastic_forces, a);       // 3
  copy.over_node_blocks(s.collect_force, a);
  copy.over_node_blocks(s.grid_velocities, a);          // 4  v_free
  copy.over_node_blocks(s.grid_collisions, a);          // 5  v_star
  copy.over_node_blocks(s.keep_velocities, a);          // 6  v_new = v_star: explicit
  copy.over_particle_blocks(s.gather, a);
  copy.over_particle_blocks(s.deformation, a);          // 7  F_E, J_P
  copy.over_particle_blocks(s.particle_velocities, a);  // 8
  copy.over_particle_blocks(s.particle_collisions, a);  // 9
  copy.over_particle_blocks(s.advection, a);            // 10
  copy.read_back(a, out);
  return out;
}

template <class Real>
void Engine<Real>::read_back(const SweepArgs<Real>& a, StagedStep& out) const {
  const auto vector = [](Quad<Real> q) {
    return Vec3d(static_cast<double>(q[0]), static_cast<double>(q[1]), static_cast<double>(q[2]));
  };
  for (std::size_t b = 0; b < partition_.node_blocks().size(); ++b) {
    const StagedNodes<Real>& nodes = a.staged[b];
    const std::uint64_t key = partition_.node_blocks()[b].key;
    for (int n = 0; n < block_nodes; ++n) {
      const double mass = static_cast<double>(nodes.momentum[n][3]);
      if (!(mass > 0)) continue;
      const int place[3] = {n >> 4, n >> 2 & 3, n & 3};
      Vec3i node;
      for (int axis = 0; axis < 3; ++axis)
        node[axis] = block_side * (block_coordinate(key, axis) - lattice_origin_[axis]) +
                     place[axis];
      out.nodes.node.push_back(node);
      out.nodes.mass.push_back(mass);
      out.nodes.momentum.push_back(vector(nodes.momentum[n]));
      out.nodes.force.push_back(vector(nodes.force[n]));
      out.nodes.v_old.push_back(vector(nodes.v_old[n]));
      out.nodes.v_free.push_back(vector(nodes.v_free[n]));
      out.nodes.v_star.push_back(vector(nodes.v_star[n]));
      out.nodes.v_new.push_back(vector(nodes.v_new[n]));
    }
  }
  const std::size_t count = particles_.size();
  out.grad_v.resize(count);
  out.F_E_trial.resize(count);
  out.v_before_collision.resize(count);
  for (std::size_t q = 0; q < count; ++q) {
    const std::size_t id = particles_[q].id;
    out.grad_v[id] = matrix(a.gathered[q].grad_v);
    out.F_E_trial[id] = matrix(a.F_trial + 9 * q);
    out.v_before_collision[id] = vector(a.v_before_collision[q]);
  }
  out.after = particles();
  out.state_hash = state_hash();
}

template class Engine<float>;
template class Engine<double>;

}  // namespace neve::sim
