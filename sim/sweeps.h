#pragma once
/// The sweeps over blocks that the drivers are made of; instantiated once per instruction set.

#include "sim/stages.h"

namespace neve::sim {

/// Colliders that a block can touch, placed relative to it.
template <class Real>
struct NearColliders {
  LocalCollider<Real> local[max_colliders];
  int count = 0;

  NEVE_INLINE NearColliders(const StepConstants<Real>& c, std::uint64_t key) {
    int cell[3];
    for (int a = 0; a < 3; ++a) cell[a] = block_coordinate(key, a) * block_side;
    // Nodes reach 3 cells from the first node, particles up to 6: sqrt(3) * 6 < 11.
    const Real reach = Real(11) * c.h;
    for (int k = 0; k < c.collider_count; ++k) {
      const LocalCollider<Real> candidate = localize<Real>(c.colliders[k], cell, c.h_double);
      if (!is_out_of_reach(candidate, reach)) local[count++] = candidate;
    }
  }
};

template <class Real, int K>
NEVE_INLINE int first_node(const Weights<Real, K>& s) {
  return Tile<K>::node(s.base[0] & 3, s.base[1] & 3, s.base[2] & 3);
}

template <class Real, int K>
NEVE_INLINE Quad<Real>* tile_of(const SweepArgs<Real>& a, std::uint32_t block, int channel) {
  return a.tiles + (static_cast<std::size_t>(block) * tile_channels + channel) * Tile<K>::nodes;
}

/// Adds the tiles that reach a node block, always in the order of NodeBlock::tile.
template <class Real, int K>
NEVE_INLINE void collect(const SweepArgs<Real>& a, std::uint32_t block, int channel,
                         Quad<Real>* sum) {
  for (int n = 0; n < block_nodes; ++n) sum[n] = Quad<Real>{};
  for (int o = 0; o < 8; ++o) {
    const std::int32_t source = a.node_blocks[block].tile[o];
    if (source < 0) continue;
    const int ox = o >> 2, oy = o >> 1 & 1, oz = o & 1;
    const int nx = ox ? Tile<K>::overlap : block_side, ny = oy ? Tile<K>::overlap : block_side;
    const int nz = oz ? Tile<K>::overlap : block_side;
    const Quad<Real>* tile = tile_of<Real, K>(a, static_cast<std::uint32_t>(source), channel) +
                             Tile<K>::node(4 * ox, 4 * oy, 4 * oz);
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j)
        for (int k = 0; k < nz; ++k)
          sum[(i * block_side + j) * block_side + k] += tile[Tile<K>::node(i, j, k)];
  }
}

/// The inverse: a particle block's tile, filled from the node blocks around it.
template <class Real, int K, class Source>
NEVE_INLINE void load_tile(const ParticleBlock& block, const Source& source, Quad<Real>* tile) {
  for (int o = 0; o < 8; ++o) {
    const Quad<Real>* nodes = source(block.node_block[o]);
    const int ox = o >> 2, oy = o >> 1 & 1, oz = o & 1;
    const int nx = ox ? Tile<K>::overlap : block_side, ny = oy ? Tile<K>::overlap : block_side;
    Quad<Real>* to = tile + Tile<K>::node(4 * ox, 4 * oy, 4 * oz);
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j)
        for (int k = 0; k < block_side; ++k)
          to[Tile<K>::node(i, j, k)] = nodes[(i * block_side + j) * block_side + k];
  }
}

template <class Real, int K, TransferKind transfer>
struct SweepsFor {
  using Args = SweepArgs<Real>;
  using Index = std::uint32_t;

  template <class Body>
  NEVE_INLINE static void each_particle(const Args& a, const ParticleBlock& block,
                                        const Body& body) {
    for (Index q = block.begin; q < block.end; ++q) body(a.order[q], a.particles[a.order[q]]);
  }

  template <class Body>
  NEVE_INLINE static void each_group(const Args& a, const ParticleBlock& block, const Body& body) {
    for (Index begin = block.begin; begin < block.end; begin += group_size) {
      const int count = static_cast<int>(smaller<Index>(group_size, block.end - begin));
      Particle<Real>* group[group_size];
      for (int q = 0; q < count; ++q)
        group[q] = a.particles + a.order[begin + static_cast<Index>(q)];
      body(a.order + begin, group, count);
    }
  }

  NEVE_INLINE static void clear(Quad<Real>* tile) {
    for (int n = 0; n < Tile<K>::nodes; ++n) tile[n] = Quad<Real>{};
  }

  // ---- fused driver -----------------------------------------------------------------------------

  static void particles_to_grid(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      Quad<Real>* momentum = tile_of<Real, K>(a, b, channel_momentum);
      Quad<Real>* force = tile_of<Real, K>(a, b, channel_force);
      clear(momentum);
      clear(force);
      each_particle(a, a.blocks[b], [&](Index, const Particle<Real>& p) {
        const Weights<Real, K> s = weights_of<K>(p);
        const int first = first_node(s);
        sim::rasterize<Real, K, transfer>(p, s, first, a.constants.h, momentum);
        sim::elastic_forces<Real, K, transfer>(p, s, first, a.constants.inv_h, force);
      });
    }
  }

  static void grid_update(const Args& a, Index begin, Index end) {
    const StepConstants<Real>& c = a.constants;
    Quad<Real> momentum[block_nodes], force[block_nodes];
    for (Index b = begin; b < end; ++b) {
      collect<Real, K>(a, b, channel_momentum, momentum);
      collect<Real, K>(a, b, channel_force, force);
      const NearColliders<Real> near(c, a.node_blocks[b].key);
      Quad<Real>* out = a.nodes + static_cast<std::size_t>(b) * node_channels * block_nodes;
      double work = 0;
      for (int n = 0; n < block_nodes; ++n) {
        const Quad<Real> v_old = node_v_old<Real>(momentum[n]);
        const Quad<Real> v_free = node_v_free(v_old, force[n], c);
        const Quad<Real> v_new = collide_node(v_free, n, c, near, work);
        out[channel_v_new * block_nodes + n] = v_new;
        out[channel_change * block_nodes + n] = v_new - v_old;
      }
      a.node_contact_work[b] = work;
    }
  }

  static void grid_to_particles(const Args& a, Index begin, Index end) {
    const StepConstants<Real>& c = a.constants;
    Quad<Real> v_new[Tile<K>::nodes], change[Tile<K>::nodes];
    for (Index b = begin; b < end; ++b) {
      const ParticleBlock& block = a.blocks[b];
      load_tile<Real, K>(block, channel_source(a, channel_v_new), v_new);
      if constexpr (transfer == TransferKind::flip)
        load_tile<Real, K>(block, channel_source(a, channel_change), change);
      const NearColliders<Real> near(c, block.key);
      BlockReport<Real> report;
      each_group(a, block, [&](const Index* storage, Particle<Real>* const* group, int count) {
        Gathered<Real> g[group_size];
        for (int q = 0; q < count; ++q) {
          const Weights<Real, K> s = weights_of<K>(*group[q]);
          g[q] = sim::gather<Real, K, transfer>(s, first_node(s), c.inv_h, v_new, change);
          note_strain_rate(g[q], report);
          strain(*group[q], g[q].grad_v, c.dt);
        }
        project(group, count, c, report);
        for (int q = 0; q < count; ++q) {
          Particle<Real>& p = *group[q];
          Quad<Real> v = particle_velocity<Real, transfer>(p, g[q], c.alpha);
          v = collide_particle(p, v, block.key, c, near, report);
          finish(a, storage[q], p, v, g[q], report);
        }
      });
      a.reports[b] = report;
    }
  }

  // ---- one stage at a time ----------------------------------------------------------------------

  static void rasterize(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      Quad<Real>* tile = tile_of<Real, K>(a, b, channel_momentum);
      clear(tile);
      each_particle(a, a.blocks[b], [&](Index, const Particle<Real>& p) {
        const Weights<Real, K> s = weights_of<K>(p);
        sim::rasterize<Real, K, transfer>(p, s, first_node(s), a.constants.h, tile);
      });
    }
  }

  static void collect_momentum(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      StagedNodes<Real>& nodes = a.staged[b];
      collect<Real, K>(a, b, channel_momentum, nodes.momentum);
      for (int n = 0; n < block_nodes; ++n) nodes.v_old[n] = node_v_old<Real>(nodes.momentum[n]);
    }
  }

  static void volumes(const Args& a, Index begin, Index end) {
    Quad<Real> momentum[Tile<K>::nodes];
    for (Index b = begin; b < end; ++b) {
      load_tile<Real, K>(
          a.blocks[b], [&](Index n) { return a.staged[n].momentum; }, momentum);
      each_particle(a, a.blocks[b], [&](Index, Particle<Real>& p) {
        if (!(p.flags & needs_volume)) return;
        const Weights<Real, K> s = weights_of<K>(p);
        p.V0 = estimated_volume(p, s, first_node(s), a.constants.h, momentum);
        p.flags = static_cast<std::uint8_t>(p.flags & ~needs_volume);
      });
    }
  }

  static void elastic_forces(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      Quad<Real>* tile = tile_of<Real, K>(a, b, channel_force);
      clear(tile);
      each_particle(a, a.blocks[b], [&](Index, const Particle<Real>& p) {
        const Weights<Real, K> s = weights_of<K>(p);
        sim::elastic_forces<Real, K, transfer>(p, s, first_node(s), a.constants.inv_h, tile);
      });
    }
  }

  static void collect_force(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) collect<Real, K>(a, b, channel_force, a.staged[b].force);
  }

  static void grid_velocities(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      StagedNodes<Real>& nodes = a.staged[b];
      for (int n = 0; n < block_nodes; ++n)
        nodes.v_free[n] = node_v_free(nodes.v_old[n], nodes.force[n], a.constants);
    }
  }

  static void grid_collisions(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      const NearColliders<Real> near(a.constants, a.node_blocks[b].key);
      StagedNodes<Real>& nodes = a.staged[b];
      double work = 0;
      for (int n = 0; n < block_nodes; ++n)
        nodes.v_star[n] = collide_node(nodes.v_free[n], n, a.constants, near, work);
      a.node_contact_work[b] = work;
    }
  }

  /// Explicit steps take v_new = v_star; what particles gather is laid out as the fused driver
  /// does.
  static void keep_velocities(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      StagedNodes<Real>& nodes = a.staged[b];
      Quad<Real>* out = a.nodes + static_cast<std::size_t>(b) * node_channels * block_nodes;
      for (int n = 0; n < block_nodes; ++n) {
        nodes.v_new[n] = nodes.v_star[n];
        out[channel_v_new * block_nodes + n] = nodes.v_new[n];
        out[channel_change * block_nodes + n] = nodes.v_new[n] - nodes.v_old[n];
      }
    }
  }

  static void gather(const Args& a, Index begin, Index end) {
    Quad<Real> v_new[Tile<K>::nodes], change[Tile<K>::nodes];
    for (Index b = begin; b < end; ++b) {
      load_tile<Real, K>(a.blocks[b], channel_source(a, channel_v_new), v_new);
      load_tile<Real, K>(a.blocks[b], channel_source(a, channel_change), change);
      each_particle(a, a.blocks[b], [&](Index q, const Particle<Real>& p) {
        const Weights<Real, K> s = weights_of<K>(p);
        a.gathered[q] =
            sim::gather<Real, K, transfer>(s, first_node(s), a.constants.inv_h, v_new, change);
      });
    }
  }

  static void deformation(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      BlockReport<Real> report;
      each_group(a, a.blocks[b],
                 [&](const Index* storage, Particle<Real>* const* group, int count) {
                   for (int q = 0; q < count; ++q) {
                     Particle<Real>& p = *group[q];
                     note_strain_rate(a.gathered[storage[q]], report);
                     strain(p, a.gathered[storage[q]].grad_v, a.constants.dt);
                     Real* trial = a.F_trial + 9 * static_cast<std::size_t>(storage[q]);
                     for (int k = 0; k < 9; ++k) trial[k] = p.F_E[k];
                   }
                   project(group, count, a.constants, report);
                 });
      a.reports[b] = report;
    }
  }

  static void particle_velocities(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b)
      each_particle(a, a.blocks[b], [&](Index q, Particle<Real>& p) {
        const Quad<Real> v = particle_velocity<Real, transfer>(p, a.gathered[q], a.constants.alpha);
        a.v_before_collision[q] = v;
        for (int axis = 0; axis < 3; ++axis) p.v[axis] = v[axis];
      });
  }

  static void particle_collisions(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      const NearColliders<Real> near(a.constants, a.blocks[b].key);
      each_particle(a, a.blocks[b], [&](Index, Particle<Real>& p) {
        const Quad<Real> v =
            collide_particle(p, quad(p.v), a.blocks[b].key, a.constants, near, a.reports[b]);
        for (int axis = 0; axis < 3; ++axis) p.v[axis] = v[axis];
      });
    }
  }

  static void advection(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b)
      each_particle(a, a.blocks[b], [&](Index q, Particle<Real>& p) {
        finish(a, q, p, quad(p.v), a.gathered[q], a.reports[b]);
      });
  }

  static void refresh(const Args& a, Index begin, Index end, BlockReport<Real>& report) {
    for (Index first = begin; first < end; first += group_size) {
      const int count = static_cast<int>(smaller<Index>(group_size, end - first));
      Particle<Real>* group[group_size];
      MaterialResponse<Real> responses[group_size];
      for (int q = 0; q < count; ++q) group[q] = a.particles + first + q;
      update_materials(group, count, a.constants.materials, false, responses);
      for (int q = 0; q < count; ++q) {
        const Particle<Real>& p = *group[q];
        const Index storage = first + static_cast<Index>(q);
        report.max_sound_squared =
            larger(report.max_sound_squared, responses[q].wave_modulus * p.V0 / p.m);
        report.max_speed_squared =
            larger(report.max_speed_squared, p.v[0] * p.v[0] + p.v[1] * p.v[1] + p.v[2] * p.v[2]);
        if (!locate<Real, K>(p, a.keys[storage], a.locals[storage])) report.overflowed += 1;
      }
    }
  }

  static constexpr Sweeps<Real> table{particles_to_grid,
                                      grid_update,
                                      grid_to_particles,
                                      rasterize,
                                      collect_momentum,
                                      volumes,
                                      elastic_forces,
                                      collect_force,
                                      grid_velocities,
                                      grid_collisions,
                                      keep_velocities,
                                      gather,
                                      deformation,
                                      particle_velocities,
                                      particle_collisions,
                                      advection,
                                      refresh};

 private:
  NEVE_INLINE static auto channel_source(const Args& a, int channel) {
    return [&a, channel](Index n) {
      return a.nodes + (static_cast<std::size_t>(n) * node_channels + channel) * block_nodes;
    };
  }

  NEVE_INLINE static Quad<Real> collide_node(Quad<Real> v, int n, const StepConstants<Real>& c,
                                             const NearColliders<Real>& near, double& work) {
    if (near.count == 0 || !(v[3] > Real(0))) return v;
    const Vec3<Real> r{static_cast<Real>(n >> 4) * c.h, static_cast<Real>(n >> 2 & 3) * c.h,
                       static_cast<Real>(n & 3) * c.h};
    return sim::collide(v, v[3], r, near.local, near.count, work);
  }

  NEVE_INLINE static Quad<Real> collide_particle(const Particle<Real>& p, Quad<Real> v,
                                                 std::uint64_t key, const StepConstants<Real>& c,
                                                 const NearColliders<Real>& near,
                                                 BlockReport<Real>& report) {
    if (near.count == 0) return v;
    int cell[3];
    for (int axis = 0; axis < 3; ++axis) cell[axis] = block_coordinate(key, axis) * block_side;
    return sim::collide(v, p.m, place_in_block(p, cell, c.h), near.local, near.count,
                        report.contact_work);
  }

  NEVE_INLINE static void note_strain_rate(const Gathered<Real>& g, BlockReport<Real>& report) {
    for (int q = 0; q < 9; ++q)
      report.max_strain_rate = larger(report.max_strain_rate, absolute(g.grad_v[q]));
  }

  /// Step 10 and the checks of a finished particle.
  NEVE_INLINE static void finish(const Args& a, Index q, Particle<Real>& p, Quad<Real> v,
                                 const Gathered<Real>& g, BlockReport<Real>& report) {
    for (int axis = 0; axis < 3; ++axis) p.v[axis] = v[axis];
    const Real speed_squared = p.v[0] * p.v[0] + p.v[1] * p.v[1] + p.v[2] * p.v[2];
    report.max_speed_squared = larger(report.max_speed_squared, speed_squared);
    // NaN passes through neither max nor min, so it is looked for by itself.
    Real sum = speed_squared + p.J_P;
    for (int k = 0; k < 6; ++k) sum += p.tau[k];
    for (int k = 0; k < 9; ++k) sum += p.F_E[k];
    if (!is_finite(sum)) report.not_finite += 1;
    const Quad<Real> carrier = a.constants.moves_with_grid ? g.v : v;
    sim::move<Real, K>(p, carrier, a.constants.dt_over_h, report, a.keys[q], a.locals[q]);
  }
};

}  // namespace neve::sim
