/// One step, as section 4 of the paper lists it. Numbers are the paper's steps; the kernels that
/// the functions below call are in sim/kernels/stages.h, one function a stage.

#include "sim/engine/step.h"

#include <algorithm>

#include "sim/laws/law.h"

namespace neve::sim::engine {

namespace {

/// Returns arguments without colliders, for contact that is not at the nodes.
template <class Real>
kernels::SweepArgs<Real> without_colliders(kernels::SweepArgs<Real> a) {
  a.constants.collider_count = 0;
  return a;
}

}  // namespace

/// The paper's list, one stage after the other.
template <class Real>
void StagedDriver<Real>::step() {
  sort_particles();              //     into blocks of 4x4x4 cells
  rasterize();                   //  1  m_i and v_old
  estimate_volumes();            //  2  V0_p of bodies in their first step
  add_elastic_forces();          //  3  f_i
  update_grid_velocities();      //  4  v_free
  collide_grid();                //  5  v_star
  solve_velocities();            //  6  v_new
  update_deformation();          //  7  F_E and J_P
  update_particle_velocities();  //  8  v_p
  collide_particles();           //  9  v_p
  move_particles();              // 10  x_p
  move_colliders();              // 11
}

/// The same list in two sweeps over particles and one over nodes. Volumes (2) are estimated before
/// the first step, see load.h.
template <class Real>
bool FusedDriver<Real>::step(bool is_implicit) {
  sort_particles(is_implicit);                           //         into blocks of 4x4x4 cells
  particles_to_grid();                                   //  1, 3   m_i, v_old, f_i
  update_grid(is_implicit);                              //  4, 5   v_free, v_star
  if (is_implicit && !solve_velocities()) return false;  //  5, 6   v_star, v_new
  grid_to_particles();                                   //  7-10   F_E, J_P, v_p, x_p
  move_colliders();                                      // 11
  return true;
}

// ---- stages -------------------------------------------------------------------------------------

template <class Real>
void StagedDriver<Real>::sort_particles() {
  state_.partition();
  state_.sort_storage();
  a_ = state_.sweep_args(dt_, kernels::all_channels);
  const std::size_t count = state_.particles.size();
  fields_.nodes.resize(state_.particles.partition.node_blocks().size());
  fields_.gathered.resize(count);
  fields_.F_trial.resize(9 * count);
  fields_.v_before_collision.resize(3 * count);
  fields_.carrier.resize(3 * count);
  a_.staged = fields_.nodes.data();
  a_.gathered = fields_.gathered.data();
  a_.F_trial = fields_.F_trial.data();
  a_.v_before_collision = fields_.v_before_collision.data();
  a_.carrier = fields_.carrier.data();
  fields_.momentum = momentum();
}

/// Stage rasterize. It leaves a grid without mass where it is skipped.
template <class Real>
void StagedDriver<Real>::rasterize() {
  stage(Stage::rasterize, [&] {
    over_particle_blocks(state_.method.sweeps->rasterize);
    over_node_blocks(state_.method.sweeps->collect_momentum);
  });
}

template <class Real>
void StagedDriver<Real>::estimate_volumes() {
  stage(Stage::volumes, [&] { over_particle_blocks(state_.method.sweeps->volumes); });
}

/// Stage elastic_forces. It leaves no force where it is skipped.
template <class Real>
void StagedDriver<Real>::add_elastic_forces() {
  rest_light_nodes();
  stage(Stage::elastic_forces, [&] {
    over_particle_blocks(state_.method.sweeps->elastic_forces);
    over_node_blocks(state_.method.sweeps->collect_force);
  });
}

template <class Real>
void StagedDriver<Real>::update_grid_velocities() {
  const auto keep_v_old = [&] {
    each_node([](auto& nodes, int n) { nodes.v_free[n] = nodes.v_old[n]; });
  };
  stage(
      Stage::grid_velocities, [&] { over_node_blocks(state_.method.sweeps->grid_velocities); },
      keep_v_old);
}

template <class Real>
void StagedDriver<Real>::collide_grid() {
  const auto keep_v_free = [&] {
    each_node([](auto& nodes, int n) { nodes.v_star[n] = nodes.v_free[n]; });
    clear_node_contact_work();
    state_.particles.contacts.keep_none();
  };
  const auto collide = [&] {
    // Nodes without masses take no impulses.
    if (state_.method.settings.skips(Stage::rasterize))
      keep_v_free();
    else if (state_.method.settings.is_contact_at_particles())
      collide_at_particles();
    else
      over_node_blocks(state_.method.sweeps->grid_collisions);
  };
  stage(Stage::grid_collisions, collide, keep_v_free);
}

/// Explicit steps take v_star, and so do steps whose solve fails. The solve starts at v_free: it
/// has to know what contact holds.
template <class Real>
void StagedDriver<Real>::solve_velocities() {
  const SolverSettings& settings = state_.method.settings;
  const bool skips_contact =
      settings.skips(Stage::grid_collisions) || settings.skips(Stage::rasterize);
  const bool has_channels = settings.is_contact_at_particles() && !skips_contact;
  const auto keep_v_star = [&] {
    if (has_channels)
      each_node([](auto& nodes, int n) { nodes.v_new[n] = nodes.v_star[n]; });
    else
      write_velocities(&kernels::StagedNodes<Real>::v_star);
  };
  const auto solve = [&] {
    if (!settings.is_implicit()) return keep_v_star();
    if (has_channels) {
      if (!parts_.solver.solve(state_, without_colliders(a_), dt_, &parts_.contact))
        parts_.contact.settle_without(state_);
    } else {
      write_velocities(&kernels::StagedNodes<Real>::v_free);
      clear_node_contact_work();
      parts_.solver.solve(state_, skips_contact ? without_colliders(a_) : a_, dt_, nullptr);
    }
    read_velocities(&kernels::StagedNodes<Real>::v_new);
  };
  stage(Stage::implicit_solve, solve, keep_v_star);
}

/// Particles gather here what the stages after this one need, too.
template <class Real>
void StagedDriver<Real>::update_deformation() {
  const auto gather = [&] { over_particle_blocks(state_.method.sweeps->gather); };
  const auto deform_gathered = [&] {
    gather();
    deform();
  };
  const auto only_gather = [&] {
    gather();
    std::vector<kernels::BlockReport<Real>>& reports = state_.grid.reports;
    std::fill(reports.begin(), reports.end(), kernels::BlockReport<Real>{});
  };
  stage(Stage::deformation, deform_gathered, only_gather);
}

template <class Real>
void StagedDriver<Real>::update_particle_velocities() {
  fields_.own_taken = static_cast<double>(a_.constants.alpha) * (fields_.momentum - momentum());
  stage(Stage::particle_velocities,
        [&] { over_particle_blocks(state_.method.sweeps->particle_velocities); });
}

template <class Real>
void StagedDriver<Real>::collide_particles() {
  stage(Stage::particle_collisions,
        [&] { over_particle_blocks(state_.method.sweeps->particle_collisions); });
}

/// The sweep also finds speeds and lost particles: if the stage is skipped, they move by nothing.
template <class Real>
void StagedDriver<Real>::move_particles() {
  const auto move = [&] { over_particle_blocks(state_.method.sweeps->advection); };
  const auto move_by_nothing = [&] {
    a_.constants.dt_over_h = 0;
    move();
  };
  stage(Stage::advection, move, move_by_nothing);
}

/// Time passes. Particles leave the colliders where the settings ask for it.
template <class Real>
void StagedDriver<Real>::move_colliders() {
  state_.advance_time(dt_);
  state_.push_out(a_);
}

// ---- sweeps -------------------------------------------------------------------------------------

template <class Real>
void FusedDriver<Real>::sort_particles(bool is_implicit) {
  timed(seconds_.partition, [&] {
    if (is_implicit || parts_.keeps_spray_on_grid)
      state_.partition();
    else
      state_.partition_but_spray(dt_);
    state_.sort_storage();
    a_ = state_.sweep_args(dt_, state_.method.sweeps->fused_channels);
  });
}

template <class Real>
void FusedDriver<Real>::particles_to_grid() {
  timed(seconds_.particles_to_grid,
        [&] { state_.over_particle_blocks(state_.method.sweeps->particles_to_grid, a_); });
}

/// Contact is at the nodes, at particles, or a part of the solve, which starts at v_free.
template <class Real>
void FusedDriver<Real>::update_grid(bool is_implicit) {
  timed(seconds_.grid_update, [&] {
    const bool at_particles = state_.method.settings.is_contact_at_particles();
    state_.over_node_blocks(state_.method.sweeps->grid_update,
                            at_particles || is_implicit ? without_colliders(a_) : a_);
    if (at_particles) parts_.contact.act(state_, a_, is_implicit);
  });
}

template <class Real>
bool FusedDriver<Real>::solve_velocities() {
  const bool at_particles = state_.method.settings.is_contact_at_particles();
  bool is_solved = false;
  timed(seconds_.solve, [&] {
    is_solved = parts_.solver.solve(state_, at_particles ? without_colliders(a_) : a_, dt_,
                                    at_particles ? &parts_.contact : nullptr);
  });
  return is_solved;
}

/// Spray takes all of its step here.
template <class Real>
void FusedDriver<Real>::grid_to_particles() {
  timed(seconds_.grid_to_particles, [&] {
    state_.over_particle_blocks(state_.method.sweeps->grid_to_particles, a_);
    state_.step_spray(a_);
  });
}

/// Time passes. Particles leave the colliders where the settings ask for it.
template <class Real>
void FusedDriver<Real>::move_colliders() {
  timed(seconds_.checks, [&] {
    state_.advance_time(dt_);
    state_.push_out(a_);
  });
}

// ---- parts of stages ----------------------------------------------------------------------------

template <class Real>
template <class Work, class Instead>
void StagedDriver<Real>::stage(Stage stage, const Work& work, const Instead& instead) {
  timed(fields_.seconds[static_cast<std::size_t>(stage)], [&] {
    if (state_.method.settings.skips(stage))
      instead();
    else
      work();
  });
}

template <class Real>
template <class Change>
void StagedDriver<Real>::each_node(const Change& change) {
  for (kernels::StagedNodes<Real>& nodes : fields_.nodes)
    for (int n = 0; n < kernels::block_nodes; ++n) change(nodes, n);
}

/// Works on the nodes as the fused driver has them: what particles gather.
template <class Real>
void StagedDriver<Real>::collide_at_particles() {
  state_.over_node_blocks(state_.method.sweeps->grid_collisions, without_colliders(a_));
  write_velocities(&kernels::StagedNodes<Real>::v_free);
  parts_.contact.act(state_, a_, state_.method.settings.is_implicit());
  read_velocities(&kernels::StagedNodes<Real>::v_star);
}

template <class Real>
void StagedDriver<Real>::write_velocities(NodeVelocities field) {
  each_node([field](auto& nodes, int n) { nodes.v_new[n] = (nodes.*field)[n]; });
  over_node_blocks(state_.method.sweeps->lay_out_velocities);
}

template <class Real>
void StagedDriver<Real>::read_velocities(NodeVelocities field) {
  const std::size_t nodes_per_block = kernels::all_channels * kernels::block_nodes;
  for (std::size_t b = 0; b < fields_.nodes.size(); ++b)
    std::copy_n(a_.nodes + b * nodes_per_block, kernels::block_nodes, fields_.nodes[b].*field);
}

template <class Real>
Vec3d StagedDriver<Real>::momentum() const {
  Vec3d sum = Vec3d::Zero();
  for (const kernels::Particle<Real>& p : state_.particles.records)
    for (int x = 0; x < 3; ++x) sum[x] += static_cast<double>(p.m) * static_cast<double>(p.v[x]);
  return sum;
}

template <class Real>
void StagedDriver<Real>::clear_node_contact_work() {
  std::vector<double>& work = state_.grid.node_contact_work;
  std::fill(work.begin(), work.end(), 0.0);
}

/// See SolverSettings::resting_mass.
template <class Real>
void StagedDriver<Real>::rest_light_nodes() {
  const double resting_mass = state_.method.settings.resting_mass;
  if (!(resting_mass > 0)) return;
  each_node([&](auto& nodes, int n) {
    if (static_cast<double>(nodes.momentum[n][3]) <= resting_mass)
      nodes.momentum[n] = nodes.v_old[n] = Quad<Real>{};
  });
}

/// Elastic particles that yield are projected as the paper's snow, then take their own stress.
template <class Real>
void StagedDriver<Real>::deform() {
  std::vector<kernels::Particle<Real>>& records = state_.particles.records;
  const Material& material = state_.method.materials[0];
  const bool yields_apart = material.yields && !laws::of(material).is_plastic;
  const auto become = [&](Model model) {
    for (kernels::Particle<Real>& p : records)
      p.kind = (p.kind & ~Integer<Real>(0xff0000)) | static_cast<Integer<Real>>(model) << 16;
  };
  if (yields_apart) become(Model{});
  over_particle_blocks(state_.method.sweeps->deformation);
  if (!yields_apart) return;
  become(material.model);
  kernels::BlockReport<Real> report;
  state_.method.sweeps->refresh(a_, 0, static_cast<std::uint32_t>(records.size()), false, report);
  for (kernels::BlockReport<Real>& block : state_.grid.reports)
    block.max_sound_squared = report.max_sound_squared;
}

template class FusedDriver<float>;
template class FusedDriver<double>;
template class StagedDriver<float>;
template class StagedDriver<double>;

}  // namespace neve::sim::engine
