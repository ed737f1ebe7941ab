/// The staged driver: the list of stages as the paper has it, on a copy that is thrown away.

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <vector>

#include "sim/engine/engine.h"
#include "sim/engine/engine_records.h"

namespace neve::sim::engine {

namespace {

/// Adds the time from one stage to the next.
class StageClock {
 public:
  explicit StageClock(std::array<double, stage_names.size()>& seconds) : seconds_(seconds) {}
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;
  ~StageClock() { stop(); }

  void enter(Stage stage) {
    stop();
    stage_ = stage;
    since_ = Clock::now();
  }

 private:
  using Clock = std::chrono::steady_clock;
  void stop() {
    if (stage_)
      seconds_[static_cast<std::size_t>(*stage_)] +=
          std::chrono::duration<double>(Clock::now() - since_).count();
  }

  std::array<double, stage_names.size()>& seconds_;
  std::optional<Stage> stage_;
  Clock::time_point since_{};
};

}  // namespace

/// The list of stages but those that the settings skip: what they would have changed stays.
template <class Real>
void Engine<Real>::take_stages(double dt, Traces& traces) {
  partition();
  if (steps_ % steps_between_sorts == 0) sort_storage();
  kernels::SweepArgs<Real> a = args(dt, kernels::all_channels);
  traces.nodes.resize(partition_.node_blocks().size());
  traces.gathered.resize(particles_.size());
  traces.F_trial.resize(9 * particles_.size());
  traces.v_before_collision.resize(3 * particles_.size());
  a.staged = traces.nodes.data();
  a.gathered = traces.gathered.data();
  a.F_trial = traces.F_trial.data();
  a.v_before_collision = traces.v_before_collision.data();
  const auto takes = [this](Stage stage) { return !settings_.skips(stage); };
  const auto each_node = [&](auto&& change) {
    for (kernels::StagedNodes<Real>& nodes : traces.nodes)
      for (int n = 0; n < kernels::block_nodes; ++n) change(nodes, n);
  };
  const kernels::Sweeps<Real>& s = *sweeps_;
  StageClock clock(traces.seconds);
  clock.enter(Stage::rasterize);
  over_particle_blocks(s.rasterize, a);
  over_node_blocks(s.collect_momentum, a);
  if (!takes(Stage::rasterize))
    each_node([](auto& nodes, int n) { nodes.momentum[n] = nodes.v_old[n] = Quad<Real>{}; });
  clock.enter(Stage::volumes);
  if (takes(Stage::volumes)) over_particle_blocks(s.volumes, a);
  if (settings_.resting_mass > 0)
    each_node([this](auto& nodes, int n) {
      if (static_cast<double>(nodes.momentum[n][3]) <= settings_.resting_mass)
        nodes.momentum[n] = nodes.v_old[n] = Quad<Real>{};
    });
  clock.enter(Stage::elastic_forces);
  if (takes(Stage::elastic_forces)) {
    over_particle_blocks(s.elastic_forces, a);
    over_node_blocks(s.collect_force, a);
  } else {
    each_node([](auto& nodes, int n) { nodes.force[n] = Quad<Real>{}; });
  }
  clock.enter(Stage::grid_velocities);
  if (takes(Stage::grid_velocities))
    over_node_blocks(s.grid_velocities, a);
  else
    each_node([](auto& nodes, int n) { nodes.v_free[n] = nodes.v_old[n]; });
  clock.enter(Stage::grid_collisions);
  if (takes(Stage::grid_collisions)) {
    over_node_blocks(s.grid_collisions, a);
  } else {
    each_node([](auto& nodes, int n) { nodes.v_star[n] = nodes.v_free[n]; });
    std::fill(node_contact_work_.begin(), node_contact_work_.end(), 0.0);
  }
  clock.enter(Stage::implicit_solve);
  over_node_blocks(s.keep_velocities, a);  // v_new = v_star, also where a solve fails
  if (settings_.is_implicit()) {
    solve_velocities(a, dt);
    for (std::size_t b = 0; b < traces.nodes.size(); ++b)
      std::copy_n(a.nodes + b * kernels::all_channels * kernels::block_nodes, kernels::block_nodes,
                  traces.nodes[b].v_new);
  }
  clock.enter(Stage::deformation);
  over_particle_blocks(s.gather, a);
  if (takes(Stage::deformation))
    deform(a);
  else
    std::fill(reports_.begin(), reports_.end(), kernels::BlockReport<Real>{});
  clock.enter(Stage::particle_velocities);
  if (takes(Stage::particle_velocities)) over_particle_blocks(s.particle_velocities, a);
  clock.enter(Stage::particle_collisions);
  if (takes(Stage::particle_collisions)) over_particle_blocks(s.particle_collisions, a);
  clock.enter(Stage::advection);
  // It also finds speeds and lost particles: skipped, particles move by nothing.
  if (!takes(Stage::advection)) a.constants.dt_over_h = 0;
  over_particle_blocks(s.advection, a);
  end_step(dt, a);
}

/// Step 7. Neo-Hookean particles that yield are projected as snow, then take their own stress.
template <class Real>
void Engine<Real>::deform(const kernels::SweepArgs<Real>& a) {
  const bool yields_apart =
      material_list_[0].yields && material_list_[0].model == Model::neo_hookean;
  const auto become = [&](kernels::ModelKind model) {
    for (kernels::Particle<Real>& p : particles_)
      p.kind = (p.kind & ~Integer<Real>(0xff0000)) | static_cast<Integer<Real>>(model) << 16;
  };
  if (yields_apart) become(kernels::ModelKind::snow);
  over_particle_blocks(sweeps_->deformation, a);
  if (!yields_apart) return;
  become(kernels::ModelKind::neo_hookean);
  kernels::BlockReport<Real> report;
  sweeps_->refresh(a, 0, static_cast<std::uint32_t>(particles_.size()), false, report);
  for (kernels::BlockReport<Real>& block : reports_)
    block.max_sound_squared = report.max_sound_squared;
}

/// A step of the run itself, for settings that skip stages and for comparisons.
template <class Real>
void Engine<Real>::step_by_stages(double dt) {
  Traces traces;
  take_stages(dt, traces);
  const double sound_speed = limits_.max_sound_speed;
  note(dt);
  // Nothing has looked at the stress; it is what it was.
  if (settings_.skips(Stage::deformation)) limits_.max_sound_speed = sound_speed;
}

template <class Real>
StagedStep Engine<Real>::staged_step(double dt) const {
  StagedStep out;
  if (particles_.empty()) return out;
  Engine copy(*this);
  Traces traces;
  copy.take_stages(dt, traces);
  copy.read_back(traces, out);
  out.seconds = traces.seconds;
  return out;
}

template <class Real>
void Engine<Real>::read_back(const Traces& traces, StagedStep& out) const {
  const auto vector = [](Quad<Real> q) {
    return Vec3d(static_cast<double>(q[0]), static_cast<double>(q[1]), static_cast<double>(q[2]));
  };
  for (std::size_t b = 0; b < partition_.node_blocks().size(); ++b) {
    const kernels::StagedNodes<Real>& nodes = traces.nodes[b];
    const std::uint64_t key = partition_.node_blocks()[b].key;
    for (int n = 0; n < kernels::block_nodes; ++n) {
      const double mass = static_cast<double>(nodes.momentum[n][3]);
      if (!(mass > 0)) continue;
      const int place[3] = {n >> 4, n >> 2 & 3, n & 3};
      Vec3i node;
      for (int axis = 0; axis < 3; ++axis)
        node[axis] =
            kernels::block_side * (kernels::block_coordinate(key, axis) - lattice_origin_[axis]) +
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
  const Ranks rank = ranks();
  for (std::size_t q = 0; q < count; ++q) {
    const std::size_t id = rank[particles_[q]];
    out.grad_v[id] = matrix(traces.gathered[q].grad_v);
    out.F_E_trial[id] = matrix(traces.F_trial.data() + 9 * q);
    out.v_before_collision[id] = engine::vector(traces.v_before_collision.data() + 3 * q);
  }
  out.after = particles();
  out.state_hash = state_hash();
}

template StagedStep Engine<float>::staged_step(double) const;
template void Engine<float>::step_by_stages(double);
template void Engine<double>::step_by_stages(double);
template StagedStep Engine<double>::staged_step(double) const;

}  // namespace neve::sim::engine
