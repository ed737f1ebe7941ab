#pragma once
/// Everything that a step reads and changes. A copy shares only the threads.

#include <memory>

#include "sim/base/thread_pool.h"
#include "sim/state/grid_storage.h"
#include "sim/state/method.h"
#include "sim/state/moving_colliders.h"
#include "sim/state/particle_storage.h"
#include "sim/state/progress.h"

namespace neve::sim::engine {

/// A sweep over blocks [begin, end).
template <class Args>
using BlockSweep = void (*)(const Args&, std::uint32_t begin, std::uint32_t end);

template <class Real>
struct State {
  State(const SolverSettings& settings, const std::vector<Material>& materials,
        const std::vector<shapes::Collider>& colliders, int threads, const Vec3i& lattice_origin);

  /// Brings particles into the order of blocks, all of them on the grid.
  void partition();
  /// The same for an explicit step of dt, without the spray.
  void partition_but_spray(double dt);
  /// Brings storage into that order too, once in a while.
  void sort_storage();
  /// Returns arguments of sweeps for a step of dt, with room for the grid: earlier ones are void.
  /// @param channels of tiles and nodes
  kernels::SweepArgs<Real> sweep_args(double dt, int channels);
  /// Calls a sweep over particle blocks (weighted by particles) or node blocks, on all threads.
  template <class Args>
  void over_particle_blocks(BlockSweep<Args> sweep, const Args& a) const;
  template <class Args>
  void over_node_blocks(BlockSweep<Args> sweep, const Args& a) const;
  /// The step of the spray. @param a  of sweep_args
  void step_spray(const kernels::SweepArgs<Real>& a) const;
  /// Stress, keys and limits of records [begin, end) as they are, all that come among them.
  kernels::BlockReport<Real> refresh(std::size_t begin, std::size_t end);

  /// Time passes, and colliders move unless the settings skip that: bodies by what the loads of the
  /// step say.
  void advance_time(double dt);
  /// Makes the speed of colliders that snow may meet a limit of the next step.
  void note_near_colliders();
  /// Speed of the colliders that particles [begin, end) may meet in the next step, where they are
  /// now, m/s.
  double fastest_near(std::size_t begin, std::size_t end) const;
  /// Lets new particles [begin, end) touch colliders where they are: those that lie nearer than
  /// snow rests are not pushed away.
  void note_touching(std::size_t begin, std::size_t end);
  /// Distance from a surface at which snow rests, m.
  double touching_distance(const kernels::Particle<Real>& p) const;
  /// Brings particles out of colliders, if the settings ask for it.
  void push_out(kernels::SweepArgs<Real> a) const;

  int active_threads() const;
  int parts() const { return ThreadPool::parts_for(active_threads()); }
  Vec3d position(const kernels::Particle<Real>& p) const { return method.lattice.position(p); }

  Method<Real> method;
  std::shared_ptr<ThreadPool> pool;
  MovingColliders colliders;
  ParticleStorage<Real> particles;
  GridStorage<Real> grid;
  Progress progress;

 private:
  void sort_into_blocks();
  double fastest_near(const std::vector<kernels::BlockRange>& blocks) const;
  void show_colliders(kernels::SweepArgs<Real>& a) const;
  void move_bodies(double dt);
};

template <class Real>
template <class Args>
void State<Real>::over_particle_blocks(BlockSweep<Args> sweep, const Args& a) const {
  pool->run(active_threads(), parts(), [&](int part) {
    sweep(a, particles.partition.first_block(part, parts()),
          particles.partition.first_block(part + 1, parts()));
  });
}

template <class Real>
template <class Args>
void State<Real>::over_node_blocks(BlockSweep<Args> sweep, const Args& a) const {
  pool->ranges(particles.partition.node_blocks().size(), active_threads(),
               [&](std::size_t begin, std::size_t end) {
                 sweep(a, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end));
               });
}

}  // namespace neve::sim::engine
