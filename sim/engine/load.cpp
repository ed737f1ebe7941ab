#include "sim/engine/load.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "sim/engine/state_reader.h"
#include "sim/engine/still_grid.h"
#include "sim/state/records.h"

namespace neve::sim::engine {

namespace {

/// Distance from rest, in logarithms of volume; infinite where something is no number.
double distance_from_rest(const ParticleArrays& in, std::size_t q, StartState& start) {
  const double J_E = in.F_E.empty() ? 1 : in.F_E[q].determinant();
  const double J_P = in.J_P.empty() ? 1 : in.J_P[q];
  const bool is_finite = in.x[q].allFinite() && (in.v.empty() || in.v[q].allFinite()) &&
                         std::isfinite(J_E) && std::isfinite(J_P);
  if (!is_finite) return std::numeric_limits<double>::infinity();
  start.min_J_E = std::min(start.min_J_E, J_E);
  start.max_J_E = std::max(start.max_J_E, J_E);
  start.min_J_P = std::min(start.min_J_P, J_P);
  start.max_J_P = std::max(start.max_J_P, J_P);
  if (!(J_E > 0 && J_P > 0)) return std::numeric_limits<double>::infinity();
  return std::max(std::abs(std::log(J_E)), std::abs(std::log(J_P)));
}

StartState start_state(const ParticleArrays& in) {
  StartState start;
  double most = 1e-6;  // rounding of states that were saved in float
  for (std::size_t q = 0; q < in.x.size(); ++q) {
    const double found = distance_from_rest(in, q, start);
    if (found <= most) continue;
    most = found;
    start.worst_particle = static_cast<std::int64_t>(q);
  }
  return start;
}

template <class T>
void require_length(const std::vector<T>& array, std::size_t count, const char* name) {
  if (!array.empty() && array.size() != count)
    throw std::invalid_argument(std::string(name) + " has a different length than x");
}

void require_lengths(const ParticleArrays& in) {
  const std::size_t count = in.x.size();
  require_length(in.v, count, "v");
  require_length(in.m, count, "m");
  require_length(in.V0, count, "V0");
  require_length(in.F_E, count, "F_E");
  require_length(in.J_P, count, "J_P");
  require_length(in.C, count, "C");
  require_length(in.material, count, "material");
  require_length(in.stiffness, count, "stiffness");
  require_length(in.threshold, count, "threshold");
  require_length(in.id, count, "id");
  if (in.m.size() != count) throw std::invalid_argument("every particle needs a mass");
}

/// Fills all of a record but the id.
template <class Real>
kernels::Particle<Real> loaded_record(const ParticleArrays& in, std::size_t q,
                                      const Method<Real>& method) {
  kernels::Particle<Real> p{};
  const int material = in.material.empty() ? 0 : in.material[q];
  if (material < 0 || static_cast<std::size_t>(material) >= method.materials.size())
    throw std::invalid_argument("a particle names a material that does not exist");
  if (!method.lattice.locate(in.x[q], p))
    throw std::invalid_argument("a particle starts outside the lattice");
  for (int a = 0; a < 3; ++a) p.v[a] = in.v.empty() ? Real(0) : static_cast<Real>(in.v[q][a]);
  p.m = static_cast<Real>(in.m[q]);
  p.V0 = in.V0.empty() ? Real(0) : static_cast<Real>(in.V0[q]);
  if (!(p.m > Real(0)) || !(p.V0 >= Real(0)))
    throw std::invalid_argument("the mass or volume of a particle is not positive");
  const Model model = method.materials[static_cast<std::size_t>(material)].model;
  p.kind = kernels::kind_of<Real>(static_cast<std::uint16_t>(material), model,
                                  p.V0 == Real(0) ? unsigned(kernels::needs_volume) : 0u);
  store_matrix(in.F_E.empty() ? Mat3d(Mat3d::Identity()) : in.F_E[q], p.F_E);
  store_matrix(in.C.empty() ? Mat3d(Mat3d::Zero()) : in.C[q], p.C);
  p.J_P = in.J_P.empty() ? Real(1) : static_cast<Real>(in.J_P[q]);
  p.stiffness = in.stiffness.empty() ? Real(1) : static_cast<Real>(in.stiffness[q]);
  p.threshold = in.threshold.empty() ? Real(1) : static_cast<Real>(in.threshold[q]);
  if (!(p.stiffness > Real(0)) || !(p.threshold > Real(0)))
    throw std::invalid_argument("a particle's factor on stiffness or thresholds is not positive");
  return p;
}

}  // namespace

template <class Real>
StartState load(const ParticleArrays& in, State<Real>& state) {
  require_lengths(in);
  const std::size_t count = in.x.size();
  std::uint64_t& next_id = state.progress.next_id;
  state.particles.resize(count);
  for (std::size_t q = 0; q < count; ++q) {
    const std::uint64_t id = in.id.empty() ? q : in.id[q];
    if (id < next_id || id >= max_ids)
      throw std::invalid_argument("ids of particles must increase, up to 2^31");
    kernels::Particle<Real>& p = state.particles.records[q];
    p = loaded_record(in, q, state.method);
    p.id = static_cast<Integer<Real>>(id);
    next_id = id + 1;
  }
  return start_state(in);
}

template <class Real>
void prepare(State<Real>& state, StartState& start) {
  const std::size_t count = state.particles.size();
  if (state.refresh(0, count).overflowed > 0)
    throw std::invalid_argument("a particle starts outside the lattice");
  if (count == 0) return;

  // Volumes and the velocity gradient need the rasterised mass and velocity.
  StillGrid<Real> grid(state);
  grid.rasterize();
  if (!state.method.settings.skips(Stage::volumes)) grid.estimate_volumes();
  Real max_strain_rate = 0;
  for (const kernels::Gathered<Real>& g : grid.gather())
    for (const Real entry : g.grad_v) max_strain_rate = std::max(max_strain_rate, std::abs(entry));
  if (state.method.fits_affine_velocity()) grid.fit_affine_velocities();

  const kernels::BlockReport<Real> report = state.refresh(0, count);
  Progress& progress = state.progress;
  StateLimits& limits = progress.limits;
  limits.max_speed = std::sqrt(static_cast<double>(report.max_speed_squared));
  limits.max_sound_speed = std::sqrt(static_cast<double>(report.max_sound_squared));
  limits.max_strain_rate = static_cast<double>(std::max(report.max_strain_rate, max_strain_rate));
  state.note_near_colliders();
  state.note_touching(0, count);
  StateLimits at_rest = limits;
  at_rest.max_strain_rate = 0;
  start.max_speed = limits.max_speed;
  start.max_sound_speed = limits.max_sound_speed;
  const SolverSettings& settings = state.method.settings;
  progress.rest_dt = std::min(settings.max_dt, stable_dt(settings, at_rest));
  const Summary now = StateReader<Real>(state).summary();
  progress.energy.start = now.kinetic_energy + now.elastic_energy;
  progress.energy.largest = progress.energy.start;
  Vec3d::Map(progress.energy.moment.data()) = now.mass * now.centre_of_mass;
  // Fused steps may need fewer channels than the stages above, and no blocks for spray.
  state.particles.partition.release_grid();
  state.grid.release();
}

template StartState load(const ParticleArrays&, State<float>&);
template StartState load(const ParticleArrays&, State<double>&);
template void prepare(State<float>&, StartState&);
template void prepare(State<double>&, StartState&);

}  // namespace neve::sim::engine
