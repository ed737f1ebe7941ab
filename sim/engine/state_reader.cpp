#include "sim/engine/state_reader.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/base/hash.h"
#include "sim/health/limits.h"
#include "sim/laws/law.h"

namespace neve::sim::engine {

namespace {

/// Sums are taken over chunks of particles and added in order: the same bits at any number of
/// threads.
constexpr std::size_t chunk = 4096;

/// Ids per particle beyond which most are of particles that left: no list has a place for each.
constexpr std::uint64_t max_ids_per_particle = 16;

constexpr std::size_t chunks_of(std::size_t count) {
  return (count + chunk - 1) / chunk;
}

template <class Real>
Mat3d kirchhoff_of(const kernels::Particle<Real>& p) {
  const Real* t = p.tau;
  const Real full[9] = {t[0], t[3], t[4], t[3], t[1], t[5], t[4], t[5], t[2]};
  return matrix(full);
}

/// Pressure of a particle on a surface with that normal, Pa: -n (tau / J) n.
template <class Real>
double pressure(const kernels::Particle<Real>& p, const Vec3d& n) {
  const double J = matrix(p.F_E).determinant() * static_cast<double>(p.J_P);
  return J > 0 ? -n.dot(kirchhoff_of(p) * n) / J : 0;
}

}  // namespace

template <class Real>
Ranks StateReader<Real>::ranks() const {
  const std::uint64_t ids = state_.progress.next_id;
  // Ids grow: where none is left out they are ranks themselves.
  if (ids == state_.particles.size()) return {};
  if (ids / max_ids_per_particle > state_.particles.size()) return ranks_among_few();
  std::vector<std::uint32_t> rank(ids, 0);
  for (const kernels::Particle<Real>& p : state_.particles.records)
    rank[static_cast<std::size_t>(p.id)] = 1;
  std::uint32_t sum = 0;
  for (std::uint32_t& r : rank) {
    const std::uint32_t own = r;
    r = sum;
    sum += own;
  }
  return Ranks::by_id(std::move(rank));
}

template <class Real>
Ranks StateReader<Real>::ranks_among_few() const {
  std::vector<std::uint32_t> ids;
  ids.reserve(state_.particles.size());
  for (const kernels::Particle<Real>& p : state_.particles.records)
    ids.push_back(static_cast<std::uint32_t>(p.id));
  std::sort(ids.begin(), ids.end());
  return Ranks::among(std::move(ids));
}

template <class Real>
ParticleArrays StateReader<Real>::particles() const {
  ParticleArrays out;
  const std::size_t count = state_.particles.size();
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
  for (const kernels::Particle<Real>& p : state_.particles.records) {
    const std::size_t id = rank[p];
    if (!out.id.empty()) out.id[id] = static_cast<std::uint32_t>(p.id);
    is_varied = is_varied || p.stiffness != Real(1) || p.threshold != Real(1);
    out.x[id] = state_.position(p);
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
  for (const kernels::Particle<Real>& p : state_.particles.records) {
    out.stiffness[rank[p]] = static_cast<double>(p.stiffness);
    out.threshold[rank[p]] = static_cast<double>(p.threshold);
  }
  return out;
}

template <class Real>
std::vector<Mat3d> StateReader<Real>::kirchhoff() const {
  std::vector<Mat3d> out(state_.particles.size());
  const Ranks rank = ranks();
  for (const kernels::Particle<Real>& p : state_.particles.records) out[rank[p]] = kirchhoff_of(p);
  return out;
}

template <class Real>
std::vector<Vec3i> StateReader<Real>::cells() const {
  std::vector<Vec3i> out(state_.particles.size());
  const Ranks rank = ranks();
  for (const kernels::Particle<Real>& p : state_.particles.records)
    out[rank[p]] = Eigen::Matrix<Integer<Real>, 3, 1>(p.cell).template cast<int>();
  return out;
}

template <class Real>
std::uint64_t StateReader<Real>::state_hash() const {
  std::uint64_t sum = 0;
  for (const kernels::Particle<Real>& p : state_.particles.records) {
    std::int32_t cell[3];
    for (int a = 0; a < 3; ++a)
      cell[a] = static_cast<int>(p.cell[a]) - kernels::block_side * state_.method.lattice.origin[a];
    std::uint64_t hash = hash_bytes(cell, sizeof cell);
    hash = hash_bytes(p.offset, sizeof p.offset, hash);
    hash = hash_bytes(p.v, sizeof p.v, hash);
    hash = hash_bytes(&p.m, sizeof p.m, hash);
    hash = hash_bytes(&p.V0, sizeof p.V0, hash);
    hash = hash_bytes(p.F_E, sizeof p.F_E, hash);
    hash = hash_bytes(&p.J_P, sizeof p.J_P, hash);
    hash = hash_bytes(p.C, sizeof p.C, hash);
    // Most particles have the numbers of the first material as they are.
    if (p.stiffness != 1 || p.threshold != 1) {
      const Real factors[] = {p.stiffness, p.threshold};
      hash = hash_bytes(factors, sizeof factors, hash);
    }
    if (const auto material = p.material(); material != 0)
      hash = hash_bytes(&material, sizeof material, hash);
    sum += mix64(static_cast<std::uint64_t>(p.id), hash);
  }
  const rigid::RigidBodies& bodies = state_.colliders.bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const std::size_t k = bodies.collider(b);
    const shapes::Collider& body = state_.colliders.list()[k];
    const shapes::Pose pose = shapes::pose_at(body, state_.progress.colliders_time);
    std::uint64_t hash = hash_bytes(pose.velocity.data(), sizeof(Vec3d));
    hash = hash_bytes(pose.angular_velocity.data(), sizeof(Vec3d), hash);
    hash = hash_bytes(body.pose_offset.moved.data(), sizeof(Vec3d), hash);
    hash = hash_bytes(body.pose_offset.turned.data(), sizeof(Mat3d), hash);
    // The angle within a turn is said by the rotation.
    const double turns = std::round(body.pose_offset.joint_angle / (2 * std::numbers::pi));
    if (turns != 0) hash = hash_bytes(&turns, sizeof turns, hash);
    // Ids of particles have 32 bits.
    sum += mix64(~static_cast<std::uint64_t>(k), hash);
  }
  return sum;
}

template <class Real>
typename StateReader<Real>::Sums StateReader<Real>::sum_of(std::size_t begin,
                                                           std::size_t end) const {
  const Method<Real>& method = state_.method;
  const bool has_C = method.settings.has_affine_velocity();
  const double inertia = method.affine_inertia();
  const std::vector<kernels::Particle<Real>>& records = state_.particles.records;
  Sums s;
  std::array<double, 4> elastic_energy{};
  for (std::size_t q = begin; q < end; ++q) {
    const kernels::Particle<Real>& p = records[q];
    const std::size_t lane = (q - begin) % 4;
    if (lane == 0)
      elastic_energy = method.elastic_energies({&p, &records[std::min(q + 1, end - 1)],
                                                &records[std::min(q + 2, end - 1)],
                                                &records[std::min(q + 3, end - 1)]});
    const double m = static_cast<double>(p.m), J_P = static_cast<double>(p.J_P);
    const Vec3d x = state_.position(p), v = vector(p.v);
    s.mass += m;
    s.kinetic_energy += method.kinetic_energy(p);
    s.affine_energy += method.affine_energy(p);
    s.momentum += m * v;
    s.centre_of_mass += m * x;
    s.angular_momentum += m * x.cross(v);
    if (has_C) {
      const Mat3d C = matrix(p.C);
      s.angular_momentum +=
          m * inertia * Vec3d(C(2, 1) - C(1, 2), C(0, 2) - C(2, 0), C(1, 0) - C(0, 1));
    }
    s.elastic_energy += elastic_energy[lane];
    s.max_speed = std::max(s.max_speed, v.norm());
    s.min_J_P = q == begin ? J_P : std::min(s.min_J_P, J_P);
    s.max_J_P = q == begin ? J_P : std::max(s.max_J_P, J_P);
    const Material& material = method.materials[static_cast<std::size_t>(p.material())];
    if (laws::of(material).is_snow) {
      s.snow_mass += m;
      if (!laws::counts_volume(material)) continue;  // a hardening, and no packing
      if (J_P <= health::packed_J_P) s.packed += m;
      if (m > ice_density * J_P * static_cast<double>(p.V0)) s.denser_than_ice += m;
    }
  }
  return s;
}

template <class Real>
Summary StateReader<Real>::summary() const {
  const std::size_t count = state_.particles.size();
  std::vector<Sums> parts(chunks_of(count));
  state_.pool->ranges(parts.size(), state_.active_threads(),
                      [&](std::size_t begin, std::size_t end) {
                        for (std::size_t c = begin; c < end; ++c)
                          parts[c] = sum_of(c * chunk, std::min(count, (c + 1) * chunk));
                      });
  Summary all;
  double snow_mass = 0;
  for (std::size_t c = 0; c < parts.size(); ++c) {
    const Sums& s = parts[c];
    snow_mass += s.snow_mass;
    all.mass += s.mass;
    all.kinetic_energy += s.kinetic_energy;
    all.affine_energy += s.affine_energy;
    all.elastic_energy += s.elastic_energy;
    all.momentum += s.momentum;
    all.centre_of_mass += s.centre_of_mass;
    all.angular_momentum += s.angular_momentum;
    all.max_speed = std::max(all.max_speed, s.max_speed);
    all.min_J_P = c == 0 ? s.min_J_P : std::min(all.min_J_P, s.min_J_P);
    all.max_J_P = c == 0 ? s.max_J_P : std::max(all.max_J_P, s.max_J_P);
    all.packed += s.packed;
    all.denser_than_ice += s.denser_than_ice;
  }
  const AtSurfaces surfaces = at_surfaces();
  all.max_depth = surfaces.max_depth;
  all.max_pressure = surfaces.max_pressure;
  all.time = state_.progress.time;
  all.particles = count;
  all.grid_blocks = state_.particles.partition.reached_node_blocks(state_.particles.keys);
  all.emitted = state_.progress.flow.emitted;
  all.removed = state_.progress.flow.removed;
  all.withheld = state_.progress.flow.withheld;
  if (all.mass > 0) all.centre_of_mass /= all.mass;
  if (snow_mass > 0) {
    all.packed /= snow_mass;
    all.denser_than_ice /= snow_mass;
  }
  return all;
}

template <class Real>
typename StateReader<Real>::AtSurfaces StateReader<Real>::at_surfaces() const {
  const Lattice& lattice = state_.method.lattice;
  const std::size_t count = state_.particles.size();
  const int origin[3] = {kernels::block_side * lattice.origin[0],
                         kernels::block_side * lattice.origin[1],
                         kernels::block_side * lattice.origin[2]};
  std::vector<kernels::LocalCollider<double>> colliders;
  for (const kernels::ColliderPose& pose : state_.colliders.poses())
    colliders.push_back(kernels::localize<double>(pose, origin, lattice.cell_size));
  AtSurfaces all{0, std::vector<double>(state_.colliders.list().size(), 0.0)};
  if (colliders.empty()) return all;
  std::vector<AtSurfaces> found(chunks_of(count), all);
  state_.pool->ranges(
      found.size(), state_.active_threads(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c)
          look_at_surfaces(c * chunk, std::min(count, (c + 1) * chunk), colliders, found[c]);
      });
  for (const AtSurfaces& part : found) {
    all.max_depth = std::max(all.max_depth, part.max_depth);
    for (std::size_t k = 0; k < all.max_pressure.size(); ++k)
      all.max_pressure[k] = std::max(all.max_pressure[k], part.max_pressure[k]);
  }
  return all;
}

/// Looks in double, as the kernels see it: four particles at a time.
template <class Real>
void StateReader<Real>::look_at_surfaces(
    std::size_t begin, std::size_t end,
    const std::vector<kernels::LocalCollider<double>>& colliders, AtSurfaces& found) const {
  using V = Quad<double>;
  const std::vector<kernels::Particle<Real>>& records = state_.particles.records;
  const double near = state_.method.lattice.cell_size;
  V least{};
  for (std::size_t q = begin; q < end; q += 4) {
    const kernels::Particle<Real>* p[4];
    Vec3<V> r;
    for (int l = 0; l < 4; ++l) {
      p[l] = &records[std::min(q + static_cast<std::size_t>(l), end - 1)];
      const Vec3d x = state_.position(*p[l]);
      for (int a = 0; a < 3; ++a) r[a][l] = x[a];
    }
    for (const kernels::LocalCollider<double>& collider : colliders) {
      Vec3<V> normal;
      const V distance = kernels::surface_distance(collider, r, normal);
      least = smaller_lanes(least, distance);
      double& most = found.max_pressure[static_cast<std::size_t>(collider.index)];
      for (int l = 0; l < 4; ++l)
        if (distance[l] < near)
          most = std::max(most, pressure(*p[l], {normal.x[l], normal.y[l], normal.z[l]}));
    }
  }
  // A depth of nothing is 0, and not -0 as -smallest would be.
  found.max_depth = 0 - smallest_lane(least);
}

template class StateReader<float>;
template class StateReader<double>;

}  // namespace neve::sim::engine
