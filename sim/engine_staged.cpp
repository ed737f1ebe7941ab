/// The staged driver: the list of stages as the paper has it, on a copy that is thrown away.

#include <algorithm>

#include "sim/engine.h"
#include "sim/engine_records.h"

namespace neve::sim {

template <class Real>
StagedStep Engine<Real>::staged_step(double dt) const {
  Engine copy(*this);
  StagedStep out;
  if (particles_.empty()) return out;
  copy.partition();
  if (copy.steps_ % steps_between_sorts == 0) copy.sort_storage();
  SweepArgs<Real> a = copy.args(dt, all_channels);
  std::vector<StagedNodes<Real>> staged(copy.partition_.node_blocks().size());
  std::vector<Gathered<Real>> gathered(particles_.size());
  std::vector<Real> F_trial(9 * particles_.size());
  std::vector<Real> v_before(3 * particles_.size());
  a.staged = staged.data();
  a.gathered = gathered.data();
  a.F_trial = F_trial.data();
  a.v_before_collision = v_before.data();
  const Sweeps<Real>& s = *sweeps_;
  copy.over_particle_blocks(s.rasterize, a);  // 1  mass, momentum, v_old
  copy.over_node_blocks(s.collect_momentum, a);
  copy.over_particle_blocks(s.volumes, a);         // 2  of bodies in their first step
  copy.over_particle_blocks(s.elastic_forces, a);  // 3
  copy.over_node_blocks(s.collect_force, a);
  copy.over_node_blocks(s.grid_velocities, a);  // 4  v_free
  copy.over_node_blocks(s.grid_collisions, a);  // 5  v_star
  copy.over_node_blocks(s.keep_velocities, a);  // 6  v_new = v_star: explicit
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
        node[axis] =
            block_side * (block_coordinate(key, axis) - lattice_origin_[axis]) + place[axis];
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
    const auto id = static_cast<std::size_t>(particles_[q].id);
    out.grad_v[id] = matrix(a.gathered[q].grad_v);
    out.F_E_trial[id] = matrix(a.F_trial + 9 * q);
    out.v_before_collision[id] = sim::vector(a.v_before_collision + 3 * q);
  }
  out.after = particles();
  out.state_hash = state_hash();
}

template StagedStep Engine<float>::staged_step(double) const;
template StagedStep Engine<double>::staged_step(double) const;

}  // namespace neve::sim
