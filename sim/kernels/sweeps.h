#pragma once
/// The sweeps over blocks that the drivers are made of; instantiated once per instruction set.

#include "sim/kernels/shock.h"
#include "sim/kernels/stages.h"

namespace neve::sim::kernels {

template <class Real, int K>
NEVE_INLINE Quad<Real>* tile_of(const SweepArgs<Real>& a, std::uint32_t block, int channel) {
  const std::size_t tile = static_cast<std::size_t>(block) * static_cast<std::size_t>(a.channels);
  return a.tiles + (tile + static_cast<std::size_t>(channel)) * Tile<K>::nodes;
}
template <class Real>
NEVE_INLINE Quad<Real>* nodes_of(const SweepArgs<Real>& a, std::uint32_t block, int channel) {
  const std::size_t first = static_cast<std::size_t>(block) * static_cast<std::size_t>(a.channels);
  return a.nodes + (first + static_cast<std::size_t>(channel)) * block_nodes;
}

/// The nodes of a block get a velocity, and FLIP and AFLIP its change. @param v  with the mass of
/// the nodes
template <class Set, class Real>
NEVE_INLINE void set_velocities(const SweepArgs<Real>& a, std::uint32_t block,
                                const Quad<Real>* v) {
  using R = Row<Real, Set>;
  Quad<Real>* v_new = nodes_of(a, block, channel_v_new);
  Quad<Real>* change = a.channels > channel_change ? nodes_of(a, block, channel_change) : nullptr;
  for (int n = 0; n < block_nodes; n += block_side) {
    const R row = R::load(v + n);
    if (change) (R::load(change + n) + (row - R::load(v_new + n))).store(change + n);
    row.store(v_new + n);
  }
}

/// The used rows of the tiles that reach a node block, always in the order of NodeBlock::tile.
/// Listed first, and asked for: most tiles have left the cache, and how many rows one has cannot be
/// guessed. Rows go beyond the tile's overlap along z, filled with 0.
template <class Real, int K>
struct RowsOfTiles {
  const Quad<Real>* from[8 * block_side * block_side];  ///< of the first channel
  std::uint8_t to[8 * block_side * block_side];         ///< row of the block, 4 x + y
  int count = 0;
  unsigned written = 0;  ///< rows of the block that get something, as bits

  /// @param channels  that will be collected, from `channel` on
  /// @param takes     which particle blocks
  template <class Takes>
  NEVE_INLINE RowsOfTiles(const SweepArgs<Real>& a, std::uint32_t block, int channel, int channels,
                          const Takes& takes) {
    for (int o = 0; o < 8; ++o) {
      const std::int32_t source = a.node_blocks[block].tile[o];
      if (source < 0 || !takes(source)) continue;
      const int ox = o >> 2, oy = o >> 1 & 1, oz = o & 1;
      int i, nx, first, ny;
      used_rows<K>(a.blocks[source], 0, ox, i, nx);
      used_rows<K>(a.blocks[source], 1, oy, first, ny);
      const Quad<Real>* tile = tile_of<Real, K>(a, static_cast<std::uint32_t>(source), channel) +
                               Tile<K>::node(4 * ox, 4 * oy, 4 * oz);
      for (; i < nx; ++i)
        for (int j = first; j < ny; ++j) {
          const Quad<Real>* row = tile + Tile<K>::node(i, j, 0);
          for (int k = 0; k < channels; ++k)
            for (std::size_t byte = 0; byte < block_side * sizeof(Quad<Real>); byte += 64)
              __builtin_prefetch(reinterpret_cast<const char*>(row + k * Tile<K>::nodes) + byte);
          from[count] = row;
          to[count++] = static_cast<std::uint8_t>(i * block_side + j);
          written |= 1u << (i * block_side + j);
        }
    }
  }

  /// The sum of a channel after the first; the rows that get nothing are 0.
  template <class Set>
  NEVE_INLINE void add_up(int channel, Quad<Real>* sum) const {
    using R = Row<Real, Set>;
    for (int n = 0; n < block_nodes; n += block_side) R::zero().store(sum + n);
    for (int k = 0; k < count; ++k)
      R::load(from[k] + channel * Tile<K>::nodes).add_to(sum + to[k] * block_side);
  }
};

/// Adds up one channel, only of the particle blocks that `takes` accepts.
/// @return the rows of the block that got something, as bits 4 x + y; the others are 0
template <class Real, int K, class Set, class Takes>
NEVE_INLINE unsigned collect(const SweepArgs<Real>& a, std::uint32_t block, int channel,
                             Quad<Real>* sum, const Takes& takes) {
  const RowsOfTiles<Real, K> rows(a, block, channel, 1, takes);
  rows.template add_up<Set>(0, sum);
  return rows.written;
}
inline constexpr auto takes_all = [](std::int32_t) NEVE_INLINE_BODY { return true; };
template <class Real, int K, class Set>
NEVE_INLINE unsigned collect(const SweepArgs<Real>& a, std::uint32_t block, int channel,
                             Quad<Real>* sum) {
  return collect<Real, K, Set>(a, block, channel, sum, takes_all);
}

/// The inverse: the used rows of a particle block's tile, filled from the node blocks around it.
template <class Real, int K, class Set, class Source>
NEVE_INLINE void load_tile(const ParticleBlock& block, const Source& source, Quad<Real>* tile) {
  for (int o = 0; o < 8; ++o) {
    const Quad<Real>* nodes = source(block.node_block[o]);
    const int ox = o >> 2, oy = o >> 1 & 1, oz = o & 1;
    int i, nx, first, ny;
    used_rows<K>(block, 0, ox, i, nx);
    used_rows<K>(block, 1, oy, first, ny);
    Quad<Real>* to = tile + Tile<K>::node(4 * ox, 4 * oy, 4 * oz);
    for (; i < nx; ++i)
      for (int j = first; j < ny; ++j)
        Row<Real, Set>::load(nodes + (i * block_side + j) * block_side)
            .store(to + Tile<K>::node(i, j, 0));
  }
}

template <class Real, int K, TransferKind transfer, class Set>
struct SprayFor;

template <class Real, int K, TransferKind transfer, class Set>
struct SweepsFor {
  using Args = SweepArgs<Real>;
  using Index = std::uint32_t;
  static constexpr int W = Set::template lanes<Real>;
  using V = Lanes<Real, W>;
  using I = Lanes<Integer<Real>, W>;
  using R = Row<Real, Set>;
  using Batch = ParticleLanes<Real, W>;
  static constexpr bool is_affine = has_affine(transfer);
  static constexpr bool is_mls = transfer == TransferKind::mls;
  static constexpr bool is_aflip = transfer == TransferKind::aflip;
  static constexpr bool has_change = keeps_own(transfer);
  static constexpr int fused_channels = has_change ? 2 : 1;

  /// Some particles of a block, in its order; records beyond the last repeat it, so that batches
  /// are always full.
  template <int G>
  struct Group {
    Particle<Real>* record[G];
    const Index* storage;
    int count;

    NEVE_INLINE unsigned used(int q) const { return lane_bits(used_lanes(q)); }
    NEVE_INLINE I used_lanes(int q) const { return first_lanes<I>(count - q); }
  };

  /// Asks for the records that come a group after particles [q, q + W) of this one. Blocks stand
  /// one after the other in the order, so this also looks into the next one.
  template <int G>
  NEVE_INLINE static void fetch_ahead(const Args& a, const Group<G>& group, int q) {
    const Index at = static_cast<Index>(group.storage - a.order) + static_cast<Index>(q + G);
    for (Index l = 0; l < W && at + l < a.particle_count; ++l) {
      const char* record = reinterpret_cast<const char*>(a.particles + a.order[at + l]);
      for (std::size_t byte = 0; byte < sizeof(Particle<Real>); byte += 64)
        __builtin_prefetch(record + byte);
    }
  }

  /// body(group) for groups of at most G particles, all of one model.
  template <int G, class Body>
  NEVE_INLINE static void each_group(const Args& a, const ParticleBlock& block, const Body& body) {
    Group<G> group;
    for (Index begin = block.begin; begin < block.end;) {
      group.storage = a.order + begin;
      Index count = smaller<Index>(G, block.end - begin);
      for (Index q = 0; q < count; ++q) group.record[q] = a.particles + group.storage[q];
      // The block is sorted by model.
      while (group.record[count - 1]->model() != group.record[0]->model()) --count;
      group.count = static_cast<int>(count);
      for (Index q = count; q % W != 0; ++q) group.record[q] = group.record[count - 1];
      body(static_cast<const Group<G>&>(group));
      begin += count;
    }
  }

  /// body(q, batch, stencils) for every batch of the block's particles.
  template <class Body>
  NEVE_INLINE static void each_batch(const Args& a, const ParticleBlock& block, const Body& body) {
    each_group<gather_group>(a, block, [&](const Group<gather_group>& group) {
      for (int q = 0; q < group.count; q += W) {
        Batch batch;
        load(batch, group.record + q);
        body(group, q, batch);
      }
    });
  }

  /// The used rows.
  NEVE_INLINE static void clear(const ParticleBlock& block, Quad<Real>* tile) {
    for (int i = block.first_cell[0]; i < block.last_cell[0] + K; ++i)
      for (int n = Tile<K>::node(i, block.first_cell[1], 0);
           n < Tile<K>::node(i, block.last_cell[1] + K, 0); n += block_side)
        R::zero().store(tile + n);
  }

  // ---- particles to tiles -----------------------------------------------------------------------

  /// The group's values and tensors as rows.
  struct ScatterRows {
    Stencils<Real, K, scatter_group> s;
    R value[scatter_group];
    TensorRows<Real, Set> affine[scatter_group], force[scatter_group];
  };

  enum Job { momentum_job = 1, force_job = 2 };

  /// Steps 1 and 3 for the particles of a block. Jobs that share a tile are added in the order of
  /// the steps.
  template <int jobs>
  NEVE_INLINE static void scatter(const Args& a, const ParticleBlock& block, Quad<Real>* momentum,
                                  Quad<Real>* force) {
    constexpr bool with_affine = is_affine && (jobs & momentum_job) != 0;
    constexpr bool has_force = (jobs & force_job) != 0;
    ScatterRows rows;
    each_group<scatter_group>(a, block, [&](const Group<scatter_group>& group) {
      for (int q = 0; q < group.count; q += W) {
        Batch p;
        fetch_ahead(a, group, q);
        load_for_scatter<with_affine, has_force>(p, group.record + q);
        prepare<jobs>(a.constants, p, q, group.count, rows);
      }
      each_cell(rows.s, group.count,
                [&](int begin, int end) { scatter_cell<jobs>(rows, begin, end, momentum, force); });
    });
  }

  /// Particles [begin, end) of the rows, all in one cell.
  template <int jobs>
  NEVE_INLINE static void scatter_cell(const ScatterRows& rows, int begin, int end,
                                       Quad<Real>* momentum, Quad<Real>* force) {
    // MLS carries both tensors on the same weights: one row for both, where both go to one tile.
    constexpr bool is_joined = is_mls && jobs == (momentum_job | force_job);
    const auto& s = rows.s;
    if constexpr (is_affine && (jobs & momentum_job) != 0)
      scatter_tensor<Real, K, scatter_group, Set>(s, s.arm, rows.affine, begin, end, momentum);
    else if constexpr ((jobs & momentum_job) != 0)
      scatter_value<Real, K, scatter_group, Set>(s, rows.value, begin, end, momentum);
    if constexpr ((jobs & force_job) != 0 && !is_joined)
      scatter_tensor<Real, K, scatter_group, Set>(s, is_mls ? s.arm : s.dw, rows.force, begin, end,
                                                  force);
  }

  /// Rows of particles [q, q + W) of `count`.
  template <int jobs>
  NEVE_INLINE static void prepare(const StepConstants<Real>& c, const Batch& p, int q, int count,
                                  ScatterRows& rows) {
    constexpr bool both = jobs == (momentum_job | force_job);
    constexpr bool with_affine = is_affine && (jobs & momentum_job) != 0;
    constexpr bool has_force = (jobs & force_job) != 0;
    constexpr bool is_joined = is_mls && both;
    auto& s = rows.s;
    s.template set<!is_mls, is_affine>(q, p.offset, p.cell);
    Quad<Real> value[W], affine[3][W], force[3][W];
    if constexpr ((jobs & momentum_job) != 0)
      store_quads(FourWords<V>{{p.v[0] * p.m, p.v[1] * p.m, p.v[2] * p.m, p.m}}, value);
    const auto keep = [](const Columns<V>& A, Quad<Real>(&to)[3][W]) NEVE_INLINE_BODY {
      unrolled<3>([&](auto k) NEVE_INLINE_BODY { store_quads(A.column[k], to[k]); });
    };
    // Added to the momentum, a force acts for dt.
    const Real duration = both && !has_change ? c.dt : Real(1);
    if constexpr (is_joined) {
      keep(affine_momentum(p.m, p.C, c.h) +
               elastic_force<K, transfer>(p.V0, p.tau, c.inv_h, duration),
           affine);
    } else {
      if constexpr (with_affine) keep(affine_momentum(p.m, p.C, c.h), affine);
      if constexpr (has_force)
        keep(elastic_force<K, transfer>(p.V0, p.tau, c.inv_h, duration), force);
    }
    const int last = smaller(W, count - q);
    for (int l = 0; l < last; ++l) {
      const R z = R::spread(s.z[q + l]);
      if constexpr ((jobs & momentum_job) != 0) rows.value[q + l] = R::repeat(value[l]) * z;
      if constexpr (with_affine) {
        rows.affine[q + l] = tensor_rows(affine, l, z, s.arm_z[q + l]);
        rows.affine[q + l].z = rows.affine[q + l].z + rows.value[q + l];
      }
      if constexpr (has_force && !is_joined)
        rows.force[q + l] = tensor_rows(force, l, z, is_mls ? s.arm_z[q + l] : s.dz[q + l]);
    }
  }

  NEVE_INLINE static TensorRows<Real, Set> tensor_rows(const Quad<Real> (&column)[3][W], int l,
                                                       const R& z, Quad<Real> g_z) {
    return {R::repeat(column[0][l]) * z, R::repeat(column[1][l]) * z,
            R::repeat(column[2][l]) * R::spread(g_z)};
  }

  // ---- fused driver -----------------------------------------------------------------------------

  static void particles_to_grid(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      Quad<Real>* momentum = tile_of<Real, K>(a, b, channel_momentum);
      Quad<Real>* force = has_change ? tile_of<Real, K>(a, b, channel_force) : momentum;
      clear(a.blocks[b], momentum);
      if constexpr (has_change) clear(a.blocks[b], force);
      scatter<momentum_job | force_job>(a, a.blocks[b], momentum, force);
    }
  }

  static void grid_update(const Args& a, Index begin, Index end) {
    const StepConstants<Real>& c = a.constants;
    Quad<Real> v_old[block_nodes], force[has_change ? block_nodes : 4];
    for (Index b = begin; b < end; ++b) {
      const RowsOfTiles<Real, K> tiles(a, b, channel_momentum, fused_channels, takes_all);
      tiles.template add_up<Set>(0, v_old);
      if constexpr (has_change) tiles.template add_up<Set>(channel_force - channel_momentum, force);
      Quad<Real>* v_new = nodes_of(a, b, channel_v_new);
      for (int n = 0; n < block_nodes; n += 4)
        if (tiles.written >> (n / 4) & 1)
          update_row(v_old + n, force + (has_change ? n : 0), v_new + n, c);
        else
          R::zero().store(v_new + n);
      double work = 0;
      NearColliders<Real> near;
      find_near_nodes<Set>(near, c, a.node_blocks[b].key);
      BlockLoads<Set> loads(near.count > 0 ? a.load_count : 0);
      collide_nodes<Set>(v_new, c, near, work, loads);
      loads.give(a.loads, a.load_unit);
      if constexpr (has_change) {
        Quad<Real>* change = nodes_of(a, b, channel_change);
        for (int n = 0; n < block_nodes; ++n) change[n] = v_new[n] - v_old[n];
      }
      a.node_contact_work[b] = work;
    }
  }

  /// Steps 1 and 4 of four nodes. @param v  momentum, and then v_old
  NEVE_INLINE static void update_row(Quad<Real>* v, const Quad<Real>* f, Quad<Real>* v_free,
                                     const StepConstants<Real>& c) {
    const R v_old = row_v_old(R::load(v)), force = has_change ? R::load(f) : R::zero();
    if constexpr (has_change) v_old.store(v);
    row_v_free<has_change>(v_old, force, c).store(v_free);
  }

  static void grid_to_particles(const Args& a, Index begin, Index end) {
    const StepConstants<Real>& c = a.constants;
    Quad<Real> v_new[Tile<K>::nodes], change[has_change ? Tile<K>::nodes : 1];
    LawSpace<Real, W> space;
    Stencils<Real, K, W> s;
    Batch batch[gather_group / W];
    Gathered<V> gathered[gather_group / W];
    Vec3<V> carrier[is_aflip ? gather_group / W : 1];
    for (Index b = begin; b < end; ++b) {
      const ParticleBlock& block = a.blocks[b];
      load_tile<Real, K, Set>(block, channel_source(a, channel_v_new), v_new);
      if constexpr (has_change)
        load_tile<Real, K, Set>(block, channel_source(a, channel_change), change);
      NearColliders<Real> near;
      find_near_particles<Set, K>(near, c, block.key);
      BlockLoads<Set> loads(near.count > 0 ? a.load_count : 0);
      ReportLanes report;
      each_group<gather_group>(a, block, [&](const Group<gather_group>& group) {
        for (int q = 0; q < group.count; q += W) {
          Batch& p = batch[q / W];
          Gathered<V>& g = gathered[q / W];
          fetch_ahead(a, group, q);
          load(p, group.record + q);
          s.template set<!is_mls, is_affine>(0, p.offset, p.cell);
          kernels::gather<Set, transfer>(s, 0, smaller(W, group.count - q), c.inv_h, v_new, change,
                                         g);
          report.note_strain_rate(g);
          if constexpr (is_aflip) carrier[q / W] = carrier_velocity(p, g, c);
          strain(p.F_E, g.grad_v, c.dt);
        }
        project(group, batch, gathered, c, space, report);
        for (int q = 0; q < group.count; q += W) {
          Batch& p = batch[q / W];
          const Gathered<V>& g = gathered[q / W];
          Vec3<V> v = particle_velocity<transfer>(p, g, c.alpha);
          collide_particles<Set>(p, v, group.used_lanes(q), block.key, c, near,
                                 report.sum.contact_work, loads);
          if constexpr (!is_aflip)
            carrier[0] = carrier_of(c, v, g);
          else if (near.count > 0)
            collide_carriers<Set>(p, carrier[q / W], block.key, c, near);
          finish(a, group, q, p, v, carrier[is_aflip ? q / W : 0], block.key, report);
        }
      });
      loads.give(a.loads, a.load_unit);
      a.reports[b] = report.reduced();
    }
  }

  // ---- one stage at a time ----------------------------------------------------------------------

  static void rasterize(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      Quad<Real>* tile = tile_of<Real, K>(a, b, channel_momentum);
      clear(a.blocks[b], tile);
      scatter<momentum_job>(a, a.blocks[b], tile, nullptr);
    }
  }

  static void collect_momentum(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      StagedNodes<Real>& nodes = a.staged[b];
      collect<Real, K, Set>(a, b, channel_momentum, nodes.momentum);
      for (int n = 0; n < block_nodes; n += 4)
        row_v_old(R::load(nodes.momentum + n)).store(nodes.v_old + n);
    }
  }

  static void volumes(const Args& a, Index begin, Index end) {
    Quad<Real> momentum[Tile<K>::nodes];
    Stencils<Real, K, W> s;
    for (Index b = begin; b < end; ++b) {
      load_tile<Real, K, Set>(
          a.blocks[b], [&](Index n) { return a.staged[n].momentum; }, momentum);
      each_batch(a, a.blocks[b], [&](const auto& group, int q, const Batch& p) {
        s.template set<false, false>(0, p.offset, p.cell);
        for (int l = 0; l < W && q + l < group.count; ++l) {
          Particle<Real>& record = *group.record[q + l];
          if (!(record.flags() & needs_volume)) continue;
          record.V0 = estimated_volume<Set>(record.m, s, l, a.constants.h, momentum) / record.J_P;
          record.kind &= ~(Integer<Real>(needs_volume) << 24);
        }
      });
    }
  }

  static void elastic_forces(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      Quad<Real>* tile = tile_of<Real, K>(a, b, channel_force);
      clear(a.blocks[b], tile);
      scatter<force_job>(a, a.blocks[b], nullptr, tile);
    }
  }

  static void collect_force(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b)
      collect<Real, K, Set>(a, b, channel_force, a.staged[b].force);
  }

  static void grid_velocities(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      StagedNodes<Real>& nodes = a.staged[b];
      for (int n = 0; n < block_nodes; n += 4)
        row_v_free<true>(R::load(nodes.v_old + n), R::load(nodes.force + n), a.constants)
            .store(nodes.v_free + n);
    }
  }

  static void grid_collisions(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      StagedNodes<Real>& nodes = a.staged[b];
      double work = 0;
      for (int n = 0; n < block_nodes; ++n) nodes.v_star[n] = nodes.v_free[n];
      NearColliders<Real> near;
      find_near_nodes<Set>(near, a.constants, a.node_blocks[b].key);
      BlockLoads<Set> loads(near.count > 0 ? a.load_count : 0);
      collide_nodes<Set>(nodes.v_star, a.constants, near, work, loads);
      loads.give(a.loads, a.load_unit);
      a.node_contact_work[b] = work;
    }
  }

  /// v_new as particles gather it, laid out as the fused driver does.
  static void lay_out_velocities(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      const StagedNodes<Real>& nodes = a.staged[b];
      for (int n = 0; n < block_nodes; ++n) {
        nodes_of(a, b, channel_v_new)[n] = nodes.v_new[n];
        nodes_of(a, b, channel_change)[n] = nodes.v_new[n] - nodes.v_old[n];
      }
    }
  }

  static void gather(const Args& a, Index begin, Index end) {
    Quad<Real> v_new[Tile<K>::nodes], change[Tile<K>::nodes];
    Stencils<Real, K, W> s;
    for (Index b = begin; b < end; ++b) {
      load_tile<Real, K, Set>(a.blocks[b], channel_source(a, channel_v_new), v_new);
      load_tile<Real, K, Set>(a.blocks[b], channel_source(a, channel_change), change);
      each_batch(a, a.blocks[b], [&](const auto& group, int q, const Batch& p) {
        s.template set<!is_mls, is_affine>(0, p.offset, p.cell);
        Gathered<V> g{};
        kernels::gather<Set, transfer>(s, 0, smaller(W, group.count - q), a.constants.inv_h, v_new,
                                       change, g);
        if constexpr (is_aflip)
          if (a.carrier) keep_carrier(a, group, q, carrier_velocity(p, g, a.constants));
        each_lane(group, q, [&](int l, Index storage) {
          Gathered<Real>& to = a.gathered[storage];
          for (int x = 0; x < 3; ++x) to.v[x] = g.v[x][l], to.change[x] = g.change[x][l];
          for (int x = 0; x < 9; ++x) to.grad_v[x] = g.grad_v[x][l], to.C[x] = g.C[x][l];
        });
      });
    }
  }

  static void deformation(const Args& a, Index begin, Index end) {
    LawSpace<Real, W> space;
    Batch batch[gather_group / W];
    Gathered<V> gathered[gather_group / W];
    for (Index b = begin; b < end; ++b) {
      ReportLanes report;
      each_group<gather_group>(a, a.blocks[b], [&](const Group<gather_group>& group) {
        for (int q = 0; q < group.count; q += W) {
          Batch& p = batch[q / W];
          load_whole(p, group.record + q);
          Gathered<V>& g = gathered[q / W];
          g = gathered_lanes(a, group, q);
          report.note_strain_rate(g);
          strain(p.F_E, g.grad_v, a.constants.dt);
          each_lane(group, q, [&](int l, Index storage) {
            for (int k = 0; k < 9; ++k)
              a.F_trial[9 * static_cast<std::size_t>(storage) + static_cast<std::size_t>(k)] =
                  p.F_E[k][l];
          });
        }
        project(group, batch, gathered, a.constants, space, report);
        for (int q = 0; q < group.count; q += W) keep(batch[q / W], group, q);
      });
      a.reports[b] = report.reduced();
    }
  }

  static void particle_velocities(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b)
      each_batch(a, a.blocks[b], [&](const auto& group, int q, Batch& p) {
        load_whole(p, group.record + q);
        const Vec3<V> v =
            particle_velocity<transfer>(p, gathered_lanes(a, group, q), a.constants.alpha);
        for (int axis = 0; axis < 3; ++axis) p.v[axis] = v[axis];
        each_lane(group, q, [&](int l, Index storage) {
          for (int axis = 0; axis < 3; ++axis)
            a.v_before_collision[3 * static_cast<std::size_t>(storage) +
                                 static_cast<std::size_t>(axis)] = v[axis][l];
        });
        keep(p, group, q);
      });
  }

  static void particle_collisions(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      const std::uint64_t key = a.blocks[b].key;
      NearColliders<Real> near;
      find_near_particles<Set, K>(near, a.constants, key);
      BlockLoads<Set> loads(near.count > 0 ? a.load_count : 0);
      each_batch(a, a.blocks[b], [&](const auto& group, int q, Batch& p) {
        load_whole(p, group.record + q);
        Vec3<V> v{p.v[0], p.v[1], p.v[2]};
        collide_particles<Set>(p, v, group.used_lanes(q), key, a.constants, near,
                               a.reports[b].contact_work, loads);
        for (int axis = 0; axis < 3; ++axis) p.v[axis] = v[axis];
        keep(p, group, q);
        if constexpr (is_aflip) {
          Vec3<V> carrier = carrier_lanes(a, group, q);
          collide_carriers<Set>(p, carrier, key, a.constants, near);
          keep_carrier(a, group, q, carrier);
        }
      });
      loads.give(a.loads, a.load_unit);
    }
  }

  static void advection(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      ReportLanes report;
      report.sum = a.reports[b];
      each_batch(a, a.blocks[b], [&](const auto& group, int q, Batch& p) {
        load_whole(p, group.record + q);
        const Vec3<V> v{p.v[0], p.v[1], p.v[2]};
        Vec3<V> carrier;
        if constexpr (is_aflip)
          carrier = carrier_lanes(a, group, q);
        else
          carrier = carrier_of(a.constants, v, gathered_lanes(a, group, q));
        finish(a, group, q, p, v, carrier, a.blocks[b].key, report);
      });
      a.reports[b] = report.reduced();
    }
  }

  // ---- both -------------------------------------------------------------------------------------

  /// Pushes particles out of colliders after the step, where these are then; blocks are those from
  /// before it. Velocities stay; the work of lifting particles is work of the colliders.
  static void push_out(const Args& a, Index begin, Index end) {
    const StepConstants<Real>& c = a.constants;
    const Vec3<V> gravity{all<V>(c.gravity[0]), all<V>(c.gravity[1]), all<V>(c.gravity[2])};
    for (Index b = begin; b < end; ++b) {
      const std::uint64_t key = a.blocks[b].key;
      NearColliders<Real> near;
      find_near_moved<Set>(near, c, key);
      if (near.count == 0) continue;
      each_batch(a, a.blocks[b], [&](const auto& group, int q, Batch& p) {
        const Vec3<V> before = places_in_block(p, key, c.h);
        Vec3<V> r = before;
        const auto is_moved =
            kernels::push_out<Set>(r, static_cast<Real>(depth_left) * c.h, near.local, near.count);
        if ((lane_bits(is_moved) & group.used(q)) == 0) return;
        load_whole(p, group.record + q);
        const Vec3<V> shift = r - before;
        const V work = -(p.m * dot(gravity, shift));
        Location<I> at;
        move<K>(p, shift, c.inv_h, group.used(q), a.reports[b], at);
        keep(p, group, q);
        each_lane(group, q, [&](int l, Index storage) {
          a.reports[b].contact_work += static_cast<double>(work[l]);
          write_location(a, storage, at, l);
        });
      });
    }
  }

  static void refresh(const Args& a, Index begin, Index end, bool is_projected,
                      BlockReport<Real>& sums) {
    LawSpace<Real, W> space;
    Batch batch[gather_group / W];
    ReportLanes report;
    report.sum = sums;
    Group<gather_group> group;
    for (Index first = begin; first < end; first += static_cast<Index>(group.count)) {
      group.count = 0;
      const auto model = a.particles[first].model();
      while (group.count < gather_group && first + static_cast<Index>(group.count) < end &&
             a.particles[first + static_cast<Index>(group.count)].model() == model) {
        group.record[group.count] = a.particles + first + group.count;
        ++group.count;
      }
      for (int q = group.count; q % W != 0; ++q) group.record[q] = group.record[group.count - 1];
      for (int q = 0; q < group.count; q += W) load_whole(batch[q / W], group.record + q);
      project(group, batch, nullptr, a.constants, space, report, is_projected);
      for (int q = 0; q < group.count; q += W) {
        Batch& p = batch[q / W];
        keep(p, group, q);
        report.note_speed(Vec3<V>{p.v[0], p.v[1], p.v[2]});
        Location<I> at;
        const unsigned outside = group.used(q) & ~lane_bits(locate<K>(p, at));
        report.sum.overflowed += static_cast<std::uint32_t>(__builtin_popcount(outside));
        for (int l = 0; l < W && q + l < group.count; ++l)
          if (!(outside >> l & 1)) write_location(a, first + static_cast<Index>(q + l), at, l);
      }
    }
    sums = report.reduced();
  }

 private:
  friend SprayFor<Real, K, transfer, Set>;

  /// A block's report while it is being written.
  struct ReportLanes {
    BlockReport<Real> sum;
    V speed_squared{}, sound_squared{}, strain_rate{}, min_J_P = all<V>(1), max_J_P = all<V>(1);

    NEVE_INLINE void note_material(const Batch& p, const V& sound_squared_now) {
      sound_squared = larger_lanes(sound_squared, sound_squared_now);
      min_J_P = smaller_lanes(min_J_P, p.J_P);
      max_J_P = larger_lanes(max_J_P, p.J_P);
    }
    NEVE_INLINE void note_strain_rate(const Gathered<V>& g) {
      for (int q = 0; q < 9; ++q)
        strain_rate = larger_lanes(strain_rate, absolute_lanes(g.grad_v[q]));
    }
    NEVE_INLINE void note_speed(const Vec3<V>& v) {
      speed_squared = larger_lanes(speed_squared, dot(v, v));
    }
    NEVE_INLINE BlockReport<Real> reduced() const {
      BlockReport<Real> out = sum;
      out.max_speed_squared = larger(out.max_speed_squared, largest_lane(speed_squared));
      out.max_sound_squared = larger(out.max_sound_squared, largest_lane(sound_squared));
      out.max_strain_rate = larger(out.max_strain_rate, largest_lane(strain_rate));
      out.min_J_P = smaller(out.min_J_P, smallest_lane(min_J_P));
      out.max_J_P = larger(out.max_J_P, largest_lane(max_J_P));
      return out;
    }
  };

  NEVE_INLINE static auto channel_source(const Args& a, int channel) {
    return [&a, channel](Index n) { return nodes_of(a, n, channel); };
  }

  /// body(lane, storage) for the lanes in use.
  template <class G, class Body>
  NEVE_INLINE static void each_lane(const G& group, int q, const Body& body) {
    for (int l = 0; l < W && q + l < group.count; ++l) body(l, group.storage[q + l]);
  }

  template <class G>
  NEVE_INLINE static Gathered<V> gathered_lanes(const Args& a, const G& group, int q) {
    Gathered<V> g{};
    each_lane(group, q, [&](int l, Index storage) {
      const Gathered<Real>& from = a.gathered[storage];
      for (int x = 0; x < 3; ++x) g.v[x][l] = from.v[x], g.change[x][l] = from.change[x];
      for (int x = 0; x < 9; ++x) g.grad_v[x][l] = from.grad_v[x], g.C[x][l] = from.C[x];
    });
    return g;
  }

  template <class G>
  NEVE_INLINE static Vec3<V> carrier_lanes(const Args& a, const G& group, int q) {
    Vec3<V> carrier{};
    each_lane(group, q, [&](int l, Index storage) {
      for (int x = 0; x < 3; ++x)
        carrier[x][l] =
            a.carrier[3 * static_cast<std::size_t>(storage) + static_cast<std::size_t>(x)];
    });
    return carrier;
  }
  template <class G>
  NEVE_INLINE static void keep_carrier(const Args& a, const G& group, int q,
                                       const Vec3<V>& carrier) {
    each_lane(group, q, [&](int l, Index storage) {
      for (int x = 0; x < 3; ++x)
        a.carrier[3 * static_cast<std::size_t>(storage) + static_cast<std::size_t>(x)] =
            carrier[x][l];
    });
  }

  /// The velocity that moves particles, of all transfers but AFLIP.
  NEVE_INLINE static Vec3<V> carrier_of(const StepConstants<Real>& c, const Vec3<V>& v,
                                        const Gathered<V>& g) {
    return c.moves_with_grid ? Vec3<V>{g.v[0], g.v[1], g.v[2]} : v;
  }

  template <class G>
  NEVE_INLINE static void keep(const Batch& p, const G& group, int q) {
    store<true>(p, group.record + q, group.count - q);
  }

  /// Step 7, second half: projection and stress of a group, and what the report wants to know of
  /// them.
  /// @param gathered  of the step, for the viscosity of snow; null: the stress of a state
  /// @param looks     see LawKernels::update
  NEVE_INLINE static void project(const Group<gather_group>& group, Batch* batch,
                                  const Gathered<V>* gathered, const StepConstants<Real>& c,
                                  LawSpace<Real, W>& space, ReportLanes& report,
                                  bool is_projected = true, FirstLook<V>* looks = nullptr) {
    V wave_modulus[gather_group / W];
    unsigned inverted[gather_group / W];
    const auto& law = LawSet<Set>::kernels(static_cast<int>(group.record[0]->model()), Real());
    law.update(batch, group.count, c.materials, is_projected, space, wave_modulus, inverted, looks);
    const bool is_viscous = gathered && law.is_plastic && c.shock_linear > 0;
    for (int k = 0; k * W < group.count; ++k) {
      Batch& p = batch[k];
      const V sound_squared = wave_modulus[k] * p.V0 / p.m;
      report.note_material(p, sound_squared);
      if (is_viscous) {
        const V pressure = shock_pressure(p, gathered[k].grad_v, sound_squared, c);
        for (int axis = 0; axis < 3; ++axis) p.tau[axis] -= pressure;
      }
      if (inverted[k] == 0) continue;
      const auto count = static_cast<std::uint32_t>(__builtin_popcount(inverted[k]));
      report.sum.inverted += count;
      if (!law.is_plastic) report.sum.inverted_unprojected += count;
    }
  }

  NEVE_INLINE static void write_location(const Args& a, Index storage, const Location<I>& at,
                                         int l) {
    a.keys[storage] = block_key(static_cast<int>(at.block[0][l]), static_cast<int>(at.block[1][l]),
                                static_cast<int>(at.block[2][l]));
    a.locals[storage] = static_cast<std::uint16_t>(at.local[l]);
  }

  /// Step 10 and the checks of finished particles, and the records written.
  template <class G>
  NEVE_INLINE static Location<I> finish_records(const Args& a, const G& group, int q, Batch& p,
                                                const Vec3<V>& v, const Vec3<V>& carrier,
                                                ReportLanes& report) {
    for (int axis = 0; axis < 3; ++axis) p.v[axis] = v[axis];
    report.note_speed(v);
    // NaN passes through neither max nor min, so it is looked for by itself.
    V sum = dot(v, v) + p.J_P;
    for (int k = 0; k < 6; ++k) sum += p.tau[k];
    for (int k = 0; k < 9; ++k) sum += p.F_E[k];
    const unsigned used = group.used(q);
    const unsigned lost = used & ~lane_bits(sum - sum == V{});
    report.sum.not_finite += static_cast<std::uint32_t>(__builtin_popcount(lost));
    Location<I> at;
    move<K>(p, carrier, a.constants.dt_over_h, used, report.sum, at);
    store<is_affine>(p, group.record + q, group.count - q);
    return at;
  }

  /// The same, and the block that each is in now.
  template <class G>
  NEVE_INLINE static void finish(const Args& a, const G& group, int q, Batch& p, const Vec3<V>& v,
                                 const Vec3<V>& carrier, std::uint64_t key, ReportLanes& report) {
    const Location<I> at = finish_records(a, group, q, p, v, carrier, report);
    const unsigned used = group.used(q);
    // Most particles stay in their block.
    I has_left{};
    for (int axis = 0; axis < 3; ++axis)
      has_left = has_left | (at.block[axis] != block_coordinate(key, axis));
    const unsigned left = lane_bits(has_left);
    Integer<Real> local[W];
    __builtin_memcpy(local, &at.local, sizeof local);
    each_lane(group, q, [&](int l, Index storage) {
      a.keys[storage] = key;
      a.locals[storage] = static_cast<std::uint16_t>(local[l]);
    });
    if ((left & used) == 0) return;
    each_lane(group, q, [&](int l, Index storage) {
      if (left >> l & 1) write_location(a, storage, at, l);
    });
  }
};

}  // namespace neve::sim::kernels
