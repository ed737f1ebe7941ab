#include "sim/engine/staged_step.h"

#include "sim/engine/state_reader.h"
#include "sim/engine/step.h"
#include "sim/state/records.h"

namespace neve::sim::engine {

namespace {

/// Fields of the nodes that carry mass.
template <class Real>
NodeFields node_fields(const State<Real>& state, const StageFields<Real>& fields) {
  const auto first_three = [](Quad<Real> q) {
    return Vec3d(static_cast<double>(q[0]), static_cast<double>(q[1]), static_cast<double>(q[2]));
  };
  NodeFields out;
  const std::vector<kernels::NodeBlock>& blocks = state.particles.partition.node_blocks();
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const kernels::StagedNodes<Real>& nodes = fields.nodes[b];
    const Vec3i first = state.method.lattice.first_cell(blocks[b].key);
    for (int n = 0; n < kernels::block_nodes; ++n) {
      const double mass = static_cast<double>(nodes.momentum[n][3]);
      if (!(mass > 0)) continue;
      out.node.push_back(first + Vec3i(n >> 4, n >> 2 & 3, n & 3));
      out.mass.push_back(mass);
      out.momentum.push_back(first_three(nodes.momentum[n]));
      out.force.push_back(first_three(nodes.force[n]));
      out.v_old.push_back(first_three(nodes.v_old[n]));
      out.v_free.push_back(first_three(nodes.v_free[n]));
      out.v_star.push_back(first_three(nodes.v_star[n]));
      out.v_new.push_back(first_three(nodes.v_new[n]));
    }
  }
  return out;
}

template <class Real>
void read_particle_fields(const State<Real>& state, const StageFields<Real>& fields,
                          StagedStep& out) {
  const std::size_t count = state.particles.size();
  out.grad_v.resize(count);
  out.F_E_trial.resize(count);
  out.v_before_collision.resize(count);
  const Ranks rank = StateReader<Real>(state).ranks();
  for (std::size_t q = 0; q < count; ++q) {
    const std::size_t id = rank[state.particles.records[q]];
    out.grad_v[id] = matrix(fields.gathered[q].grad_v);
    out.F_E_trial[id] = matrix(fields.F_trial.data() + 9 * q);
    out.v_before_collision[id] = vector(fields.v_before_collision.data() + 3 * q);
  }
}

}  // namespace

template <class Real>
StagedStep staged_step(State<Real> copy, double dt) {
  StagedStep out;
  if (copy.particles.size() == 0) return out;
  StepParts<Real> parts;
  StageFields<Real> fields;
  StagedDriver<Real>(copy, parts, fields, dt).step();
  out.nodes = node_fields(copy, fields);
  read_particle_fields(copy, fields, out);
  out.own_taken = fields.own_taken;
  const StateReader<Real> reader(copy);
  out.after = reader.particles();
  copy.grid.add_loads(copy.method.load_unit, out.loads);
  out.state_hash = reader.state_hash();
  out.is_given_up = parts.solver.last_solve().given_up > 0;
  out.seconds = fields.seconds;
  return out;
}

template StagedStep staged_step(State<float>, double);
template StagedStep staged_step(State<double>, double);

}  // namespace neve::sim::engine
