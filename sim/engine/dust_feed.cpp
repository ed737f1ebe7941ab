#include "sim/engine/dust_feed.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "sim/base/hash.h"
#include "sim/kernels/contact.h"
#include "sim/state/records.h"

namespace neve::sim::engine {

namespace {

/// Snow that fills less of a cell of air is spray, and feels all of the drag in the limit of none.
constexpr double spray_fill = 0.1;

/// The colliders as the kernels have them.
class ColliderSolids final : public dust::Solids {
 public:
  ColliderSolids(const MovingColliders& colliders, const Lattice& lattice)
      : deforms_(colliders.deform()) {
    constexpr int cell_0[3] = {0, 0, 0};
    to_cell_0_ = kernels::block_side * lattice.cell_size * lattice.origin.cast<double>();
    for (const kernels::ColliderPose& pose : colliders.poses()) {
      seen_.push_back(kernels::localize<double>(pose, cell_0, lattice.cell_size));
      add_key(pose);
    }
  }

  dust::Surface at(const Vec3d& x) const override {
    using V = Quad<double>;
    dust::Surface nearest;
    const Vec3d from = x + to_cell_0_;
    const Vec3<V> r{all<V>(from.x()), all<V>(from.y()), all<V>(from.z())};
    for (const kernels::LocalCollider<double>& c : seen_) {
      Vec3<V> normal;
      const double distance = kernels::surface_distance(c, r, normal)[0];
      if (!(distance < nearest.distance)) continue;
      const Vec3<V> velocity = kernels::surface_velocity(c, r);
      nearest = {distance,
                 {normal.x[0], normal.y[0], normal.z[0]},
                 {velocity.x[0], velocity.y[0], velocity.z[0]}};
    }
    return nearest;
  }
  bool are_none() const override { return seen_.empty(); }
  std::uint64_t pose_key() const override { return deforms_ ? 0 : key_; }

 private:
  void add_key(const kernels::ColliderPose& pose) {
    const auto add = [&](const auto& numbers) { key_ = hash_bytes(numbers, sizeof numbers, key_); };
    add(pose.cell);
    add(pose.offset);
    add(pose.axes);
    add(pose.normal);
    add(pose.half);
    add(pose.velocity);
    add(pose.omega);
    const double sizes[] = {static_cast<double>(pose.index), static_cast<double>(pose.shape),
                            pose.radius, pose.ring};
    add(sizes);
    key_ |= 1;  // never 0
  }

  std::vector<kernels::LocalCollider<double>> seen_;
  Vec3d to_cell_0_;
  std::uint64_t key_ = 0x2545f4914f6cdd1dull;
  bool deforms_;  ///< also of one that rests now: it may have moved since the air saw it
};

template <class Real>
std::vector<dust::SnowGrain> grains_of(const State<Real>& state) {
  const std::vector<kernels::Particle<Real>>& records = state.particles.records;
  std::vector<dust::SnowGrain> grains(records.size());
  state.pool->ranges(
      records.size(), state.active_threads(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t q = begin; q < end; ++q) {
          const kernels::Particle<Real>& p = records[q];
          const Material& material = state.method.materials[static_cast<std::size_t>(p.material())];
          const auto m = static_cast<double>(p.m);
          grains[q] = {state.position(p),
                       vector(p.v),
                       m,
                       m / material.density,
                       static_cast<double>(p.J_P),
                       material.dust,
                       static_cast<std::uint32_t>(p.id)};
        }
      });
  return grains;
}

/// dv/dt = k |u - v| (u - v), implicit in the difference: never past the speed of the air.
template <class Real>
void drag_spray(double dt, const dust::Air& air, State<Real>& state) {
  const DustSettings& settings = state.method.settings.dust;
  std::vector<kernels::Particle<Real>>& records = state.particles.records;
  std::vector<double> work(records.size(), 0.0), speed(records.size(), 0.0);
  state.pool->ranges(
      records.size(), state.active_threads(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t q = begin; q < end; ++q) {
          kernels::Particle<Real>& p = records[q];
          const Vec3d x = state.position(p), v = vector(p.v);
          const double loose = 1 - air.fill(x) / spray_fill;
          if (!(loose > 0) || !air.box().contains(air.box().place(x))) continue;
          const Vec3d away = air.velocity(x, settings.wind) - v;
          const double share = loose * settings.spray_drag * away.norm() * dt;
          const Vec3d now = v + away * (share / (1 + share));
          for (int a = 0; a < 3; ++a) p.v[a] = static_cast<Real>(now[a]);
          work[q] = 0.5 * static_cast<double>(p.m) * (vector(p.v).squaredNorm() - v.squaredNorm());
          speed[q] = now.norm();
        }
      });
  // Sorted by size, the sum has the same bits in any order of storage.
  std::erase(work, 0.0);
  std::sort(work.begin(), work.end());
  EnergyBudget& energy = state.progress.energy;
  double sum = 0;
  for (const double w : work) sum += w;
  energy.contact_work += sum;
  double& fastest = state.progress.limits.max_speed;
  for (const double s : speed) fastest = std::max(fastest, s);
}

}  // namespace

template <class Real>
bool wants_dust(const Method<Real>& method) {
  return method.settings.dust.spray_drag > 0 ||
         std::any_of(method.materials.begin(), method.materials.end(),
                     [](const Material& material) { return material.dust > 0; });
}

template <class Real>
void advance_dust(double time, State<Real>& state, dust::Dust& dust) {
  const SolverSettings& settings = state.method.settings;
  const double dt = time - dust.time();
  const ColliderSolids solids(state.colliders, state.method.lattice);
  dust.advance(time, grains_of(state),
               {settings.dust, settings.cell_size, settings.gravity, solids, *state.pool});
  if (settings.dust.spray_drag > 0 && dt > 0 && !dust.air().box().is_empty())
    drag_spray(dt, dust.air(), state);
}

template bool wants_dust(const Method<float>&);
template bool wants_dust(const Method<double>&);
template void advance_dust(double, State<float>&, dust::Dust&);
template void advance_dust(double, State<double>&, dust::Dust&);

}  // namespace neve::sim::engine
