/// Particles in and out of an engine, sums over them, and their hash.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sim/base/hash.h"
#include "sim/engine/engine.h"
#include "sim/engine/engine_records.h"
#include "sim/health/diagnostics.h"

namespace neve::sim::engine {

namespace {

/// How far from rest, in logarithms of volume; infinite where something is no number.
double strangeness(const ParticleArrays& in, std::size_t q, StartState& start) {
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
    const double found = strangeness(in, q, start);
    if (found <= most) continue;
    most = found;
    start.strangest = static_cast<std::int64_t>(q);
  }
  return start;
}

template <class Real>
void require_length(const std::vector<Real>& array, std::size_t count, const char* what) {
  if (!array.empty() && array.size() != count)
    throw std::invalid_argument(std::string(what) + " has a different length than x");
}

}  // namespace

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
  require_length(in.stiffness, count, "stiffness");
  require_length(in.threshold, count, "threshold");
  require_length(in.id, count, "id");
  if (in.m.size() != count) throw std::invalid_argument("every particle needs a mass");
  particles_.resize(count);
  keys_.resize(count);
  locals_.resize(count);
  for (std::size_t q = 0; q < count; ++q) {
    kernels::Particle<Real>& p = particles_[q];
    p = kernels::Particle<Real>{};
    const std::uint64_t id = in.id.empty() ? q : in.id[q];
    if (id < next_id_ || id >= max_ids)
      throw std::invalid_argument("ids of particles must increase, up to 2^31");
    p.id = static_cast<Integer<Real>>(id);
    next_id_ = id + 1;
    const int material = in.material.empty() ? 0 : in.material[q];
    if (material < 0 || static_cast<std::size_t>(material) >= material_list_.size())
      throw std::invalid_argument("a particle names a material that does not exist");
    const Model model = material_list_[static_cast<std::size_t>(material)].model;
    for (int a = 0; a < 3; ++a) {
      const double in_cells = in.x[q][a] / settings_.cell_size;
      if (!(std::abs(in_cells) < 4.0 * kernels::block_limit))
        throw std::invalid_argument("a particle starts outside the lattice");
      int cell = 0;
      split(in_cells, cell, p.offset[a]);
      p.cell[a] = cell + kernels::block_side * lattice_origin_[a];
      p.v[a] = in.v.empty() ? Real(0) : static_cast<Real>(in.v[q][a]);
    }
    p.m = static_cast<Real>(in.m[q]);
    p.V0 = in.V0.empty() ? Real(0) : static_cast<Real>(in.V0[q]);
    if (!(p.m > Real(0)) || !(p.V0 >= Real(0)))
      throw std::invalid_argument("the mass or volume of a particle is not positive");
    p.kind = kernels::kind_of<Real>(static_cast<std::uint16_t>(material), model_kind(model),
                                    p.V0 == Real(0) ? unsigned(kernels::needs_volume) : 0u);
    store_matrix(in.F_E.empty() ? Mat3d(Mat3d::Identity()) : in.F_E[q], p.F_E);
    store_matrix(in.C.empty() ? Mat3d(Mat3d::Zero()) : in.C[q], p.C);
    p.J_P = in.J_P.empty() ? Real(1) : static_cast<Real>(in.J_P[q]);
    p.stiffness = in.stiffness.empty() ? Real(1) : static_cast<Real>(in.stiffness[q]);
    p.threshold = in.threshold.empty() ? Real(1) : static_cast<Real>(in.threshold[q]);
    if (!(p.stiffness > Real(0)) || !(p.threshold > Real(0)))
      throw std::invalid_argument("a particle's factor on stiffness or thresholds is not positive");
  }
  start_ = start_state(in);
}

template <class Real>
Vec3d Engine<Real>::place(const kernels::Particle<Real>& p) const {
  Vec3d x;
  for (int a = 0; a < 3; ++a)
    x[a] = (static_cast<double>(p.cell[a] - kernels::block_side * lattice_origin_[a]) +
            static_cast<double>(p.offset[a])) *
           settings_.cell_size;
  return x;
}

/// m2, of the weights around a particle.
template <class Real>
double Engine<Real>::affine_inertia() const {
  return settings_.cell_size * settings_.cell_size *
         (kernel_nodes_ == kernels::cubic_nodes ? kernels::apic_inertia<kernels::cubic_nodes>
                                                : kernels::apic_inertia<kernels::quadratic_nodes>);
}

template <class Real>
double Engine<Real>::kinetic_energy_of(const kernels::Particle<Real>& p) const {
  const double m = static_cast<double>(p.m), energy = 0.5 * m * vector(p.v).squaredNorm();
  if (settings_.transfer == Transfer::flip) return energy;
  return energy + 0.5 * m * affine_inertia() * matrix(p.C).squaredNorm();
}

template <class Real>
double Engine<Real>::elastic_energy_of(const kernels::Particle<Real>& p) const {
  return static_cast<double>(p.V0) * static_cast<double>(p.stiffness) *
         health::energy_density(material_list_[static_cast<std::size_t>(p.material())],
                                matrix(p.F_E), static_cast<double>(p.J_P));
}

template <class Real>
Summary Engine<Real>::summary() const {
  // Sums over fixed chunks, added in order: the same bits at any number of threads.
  constexpr std::size_t chunk = 4096;
  const std::size_t chunks = (particles_.size() + chunk - 1) / chunk;
  std::vector<Summary> parts(chunks);
  const bool has_C = settings_.transfer != Transfer::flip;
  const double inertia = affine_inertia();
  pool_->ranges(chunks, active_threads(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const std::size_t last = std::min(particles_.size(), (c + 1) * chunk);
      for (std::size_t q = c * chunk; q < last; ++q) {
        const kernels::Particle<Real>& p = particles_[q];
        Summary& s = parts[c];
        const double m = static_cast<double>(p.m), J_P = static_cast<double>(p.J_P);
        const Vec3d x = place(p), v = vector(p.v);
        s.mass += m;
        s.kinetic_energy += kinetic_energy_of(p);
        s.momentum += m * v;
        s.centre_of_mass += m * x;
        s.angular_momentum += m * x.cross(v);
        if (has_C) {
          const Mat3d C = matrix(p.C);
          s.angular_momentum +=
              m * inertia * Vec3d(C(2, 1) - C(1, 2), C(0, 2) - C(2, 0), C(1, 0) - C(0, 1));
        }
        s.elastic_energy += elastic_energy_of(p);
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
  all.max_depth = max_depth();
  all.time = time_;
  all.particles = particles_.size();
  all.emitted = totals_.emitted;
  all.removed = totals_.removed;
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
  const Ranks rank = ranks();
  if (!rank.are_ids()) out.id.resize(count);
  bool is_varied = false;
  for (const kernels::Particle<Real>& p : particles_) {
    const std::size_t id = rank[p];
    if (!out.id.empty()) out.id[id] = static_cast<std::uint32_t>(p.id);
    is_varied = is_varied || p.stiffness != Real(1) || p.threshold != Real(1);
    out.x[id] = place(p);
    out.v[id] = vector(p.v);
    out.m[id] = static_cast<double>(p.m);
    out.V0[id] = static_cast<double>(p.V0);
    out.F_E[id] = matrix(p.F_E);
    out.J_P[id] = static_cast<double>(p.J_P);
    out.C[id] = matrix(p.C);
    out.material[id] = static_cast<int>(p.material());
  }
  if (!is_varied) return out;
  out.stiffness.resize(count);
  out.threshold.resize(count);
  for (const kernels::Particle<Real>& p : particles_) {
    out.stiffness[rank[p]] = static_cast<double>(p.stiffness);
    out.threshold[rank[p]] = static_cast<double>(p.threshold);
  }
  return out;
}

template <class Real>
std::vector<Mat3d> Engine<Real>::kirchhoff() const {
  std::vector<Mat3d> out(particles_.size());
  const Ranks rank = ranks();
  for (const kernels::Particle<Real>& p : particles_) {
    const Real* t = p.tau;
    const Real full[9] = {t[0], t[3], t[4], t[3], t[1], t[5], t[4], t[5], t[2]};
    out[rank[p]] = matrix(full);
  }
  return out;
}

template <class Real>
std::vector<Vec3i> Engine<Real>::cells() const {
  std::vector<Vec3i> out(particles_.size());
  const Ranks rank = ranks();
  for (const kernels::Particle<Real>& p : particles_)
    out[rank[p]] = Eigen::Matrix<Integer<Real>, 3, 1>(p.cell).template cast<int>();
  return out;
}

template <class Real>
std::uint64_t Engine<Real>::state_hash() const {
  std::uint64_t sum = 0;
  for (const kernels::Particle<Real>& p : particles_) {
    std::int32_t cell[3];
    for (int a = 0; a < 3; ++a)
      cell[a] = static_cast<int>(p.cell[a]) - kernels::block_side * lattice_origin_[a];
    std::uint64_t hash = hash_bytes(cell, sizeof cell);
    hash = hash_bytes(p.offset, sizeof p.offset, hash);
    hash = hash_bytes(p.v, sizeof p.v, hash);
    hash = hash_bytes(&p.m, sizeof p.m, hash);
    hash = hash_bytes(&p.V0, sizeof p.V0, hash);
    hash = hash_bytes(p.F_E, sizeof p.F_E, hash);
    hash = hash_bytes(&p.J_P, sizeof p.J_P, hash);
    hash = hash_bytes(p.C, sizeof p.C, hash);
    sum += mix64(static_cast<std::uint64_t>(p.id), hash);
  }
  return sum;
}

template void Engine<float>::load(const ParticleArrays&);
template Vec3d Engine<float>::place(const kernels::Particle<float>&) const;
template double Engine<float>::kinetic_energy_of(const kernels::Particle<float>&) const;
template double Engine<float>::elastic_energy_of(const kernels::Particle<float>&) const;
template Summary Engine<float>::summary() const;
template ParticleArrays Engine<float>::particles() const;
template std::vector<Mat3d> Engine<float>::kirchhoff() const;
template std::vector<Vec3i> Engine<float>::cells() const;
template std::uint64_t Engine<float>::state_hash() const;
template void Engine<double>::load(const ParticleArrays&);
template Vec3d Engine<double>::place(const kernels::Particle<double>&) const;
template double Engine<double>::kinetic_energy_of(const kernels::Particle<double>&) const;
template double Engine<double>::elastic_energy_of(const kernels::Particle<double>&) const;
template Summary Engine<double>::summary() const;
template ParticleArrays Engine<double>::particles() const;
template std::vector<Mat3d> Engine<double>::kirchhoff() const;
template std::vector<Vec3i> Engine<double>::cells() const;
template std::uint64_t Engine<double>::state_hash() const;

}  // namespace neve::sim::engine
