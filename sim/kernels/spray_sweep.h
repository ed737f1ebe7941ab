#pragma once
/// The step of particles that share no node with others, without a grid in memory: their nodes are
/// on the stack. It is made of the same functions as the sweeps over blocks, in the same order, so
/// its results have the same bits.

#include "sim/kernels/sweeps.h"

namespace neve::sim::kernels {

template <class Real, int K, TransferKind transfer, class Set>
struct SprayFor {
  using Base = SweepsFor<Real, K, transfer, Set>;
  using Args = typename Base::Args;
  using Index = typename Base::Index;
  using V = typename Base::V;
  using I = typename Base::I;
  using R = typename Base::R;
  using Batch = typename Base::Batch;
  static constexpr int W = Base::W, most = scatter_group;
  static constexpr bool has_change = Base::has_change, is_aflip = Base::is_aflip;
  static constexpr int jobs = Base::momentum_job | Base::force_job;

  /// Clusters that are taken through the step together.
  struct Flight {
    typename Base::template Group<gather_group> group;
    Index storage[most];
    Integer<Real> has_copies[most];  ///< -1: see note_copies
    typename Base::ScatterRows rows;
    Batch batch[most / W];
    Vec3<V> carrier[most / W];
    GatheredSums<Real, transfer, most> sums;
    static constexpr int changes = has_change ? Tile<K>::nodes : 4;
    Quad<Real> v_new[Tile<K>::nodes], change[changes];
    Quad<Real> other[Tile<K>::nodes], other_force[changes];  ///< from the second block
  };

  static void step(const Args& a, Index begin, Index end, BlockReport<Real>& sum) {
    const StepConstants<Real>& c = a.constants;
    LawSpace<Real, W> space;
    typename Base::ReportLanes report;
    Flight f;
    for (Index cluster = begin; cluster < end;) {
      const Index first = cluster;
      cluster = board(a, first, end, f);
      to_rows(c, f);
      int q = 0;
      for (Index k = first; k < cluster; ++k) q = fly(c, a.spray[k], q, f);
      while (q % W != 0) f.sums.repeat(f.group.count - 1, q++);
      land(a, f, space, report);
    }
    sum = report.reduced();
  }

 private:
  /// Takes clusters of one model, as many as there is room for.
  /// @return the first that is left
  NEVE_INLINE static Index board(const Args& a, Index begin, Index end, Flight& f) {
    int count = 0;
    Index k = begin;
    for (; k < end; ++k) {
      const SprayCluster& cluster = a.spray[k];
      const int next = count + cluster.count[0] + cluster.count[1];
      if (next > most || cluster.model != a.spray[begin].model) break;
      for (int part = 0; part < 2; ++part) {
        for (int n = 0; n < cluster.count[part]; ++n) {
          f.has_copies[count] = 0;
          f.storage[count++] = a.order[cluster.begin[part] + static_cast<Index>(n)];
        }
        if (cluster.count[part] % W != 0) f.has_copies[count - 1] = -1;
      }
      fetch(a, k + most, end);
    }
    f.group.storage = f.storage;
    f.group.count = count;
    for (int q = 0; q < count; ++q) f.group.record[q] = a.particles + f.storage[q];
    for (int q = count; q % W != 0; ++q) {
      f.group.record[q] = f.group.record[count - 1];
      f.has_copies[q] = 0;
    }
    return k;
  }

  /// Asks for the first record of a cluster, which often is its only one.
  NEVE_INLINE static void fetch(const Args& a, Index cluster, Index end) {
    if (cluster >= end) return;
    const char* record =
        reinterpret_cast<const char*>(a.particles + a.order[a.spray[cluster].begin[0]]);
    for (std::size_t byte = 0; byte < sizeof(Particle<Real>); byte += 64)
      __builtin_prefetch(record + byte);
  }

  NEVE_INLINE static void to_rows(const StepConstants<Real>& c, Flight& f) {
    for (int q = 0; q < f.group.count; q += W) {
      Batch& p = f.batch[q / W];
      RecordReader<V, I> read(f.group.record + q, p);
      read.place();
      read.motion();
      read.deformation();
      read.volume();
      read.stress();
      read.factors();
      if constexpr (Base::is_affine) read.affine();
      Base::template prepare<jobs>(c, p, q, f.group.count, f.rows);
    }
  }

  /// Steps 1 to 6 of a cluster that begins at particle q of the flight, and what it gathers.
  /// @return the first particle after it
  NEVE_INLINE static int fly(const StepConstants<Real>& c, const SprayCluster& cluster, int q,
                             Flight& f) {
    auto& s = f.rows.s;
    const int begin = q;
    for (int part = 0; part < 2; ++part) {
      const std::int8_t* by = cluster.shift[part];
      const int shift = Tile<K>::node(by[0], by[1], by[2]);
      for (int n = 0; n < cluster.count[part]; ++n) s.first[q++] += shift;
    }
    const int middle = begin + cluster.count[0];
    if (cluster.size[0] == K && cluster.size[1] == K && cluster.rows == 1 && middle == q)
      update(c, Constant<K>{}, Constant<K>{}, Constant<1>{}, begin, q, q, f);
    else
      update(c, static_cast<int>(cluster.size[0]), static_cast<int>(cluster.size[1]),
             static_cast<int>(cluster.rows), begin, middle, q, f);
    for (int p = begin; p < q; ++p) f.sums.template take<Set>(s, p, f.v_new, f.change, p);
    return q;
  }

  /// body(node) for rows of nodes from the first of a tile.
  template <class Size, class Body>
  NEVE_INLINE static void each_row(Size nx, Size ny, int rows, const Body& body) {
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j)
        for (int k = 0; k < rows; ++k) body(Tile<K>::node(i, j, 4 * k));
  }

  /// Velocities of the nodes that particles [begin, end) reach; from `middle` on, they are of
  /// another block. As on the grid, a block is added up before it is added to the other.
  template <class Size, class Rows>
  NEVE_INLINE static void update(const StepConstants<Real>& c, Size nx, Size ny, Rows rows,
                                 int begin, int middle, int end, Flight& f) {
    const bool is_pair = middle < end;
    each_row(nx, ny, rows, [&](int n) NEVE_INLINE_BODY {
      R::zero().store(f.v_new + n);
      if constexpr (has_change) R::zero().store(f.change + n);
      if (is_pair) R::zero().store(f.other + n);
      if (has_change && is_pair) R::zero().store(f.other_force + n);
    });
    scatter(f, begin, middle, f.v_new, has_change ? f.change : f.v_new);
    if (is_pair) scatter(f, middle, end, f.other, has_change ? f.other_force : f.other);
    each_row(nx, ny, rows, [&](int n) NEVE_INLINE_BODY {
      R momentum = R::load(f.v_new + n), force = has_change ? R::load(f.change + n) : R::zero();
      if (is_pair) momentum = momentum + R::load(f.other + n);
      if (has_change && is_pair) force = force + R::load(f.other_force + n);
      const R v_old = row_v_old(momentum), v_new = row_v_free<has_change>(v_old, force, c);
      v_new.store(f.v_new + n);
      if constexpr (has_change) (v_new - v_old).store(f.change + n);
    });
  }

  /// Steps 1 and 3 of particles of one block.
  NEVE_INLINE static void scatter(Flight& f, int begin, int end, Quad<Real>* momentum,
                                  Quad<Real>* force) {
    const auto& first = f.rows.s.first;
    for (int p = begin; p < end;) {
      int next = p + 1;
      while (next < end && first[next] == first[p]) ++next;
      Base::template scatter_cell<jobs>(f.rows, p, next, momentum, force);
      p = next;
    }
  }

  /// Notes copies: batches of a block on the grid are filled up with copies of its last particle.
  /// They are not projected, and reports know no better.
  NEVE_INLINE static void note_copies(const I& has_copies, const Batch& p, const FirstLook<V>& look,
                                      typename Base::ReportLanes& report) {
    Batch copies;
    copies.J_P = has_copies ? look.J_P : all<V>(1);
    report.note_material(copies, (has_copies ? look.wave_modulus : V{}) * p.V0 / p.m);
  }

  /// Steps 7 to 10.
  NEVE_INLINE static void land(const Args& a, Flight& f, LawSpace<Real, W>& space,
                               typename Base::ReportLanes& report) {
    const StepConstants<Real>& c = a.constants;
    Gathered<V> gathered[most / W];
    for (int q = 0; q < f.group.count; q += W) {
      Batch& p = f.batch[q / W];
      Gathered<V>& g = gathered[q / W];
      lanes_of<transfer, K>(f.sums, q, c.inv_h, g);
      report.note_strain_rate(g);
      if constexpr (is_aflip) f.carrier[q / W] = carrier_velocity(p, g, c);
      strain(p.F_E, g.grad_v, c.dt);
    }
    FirstLook<V> looks[gather_group / W];
    Base::project(f.group, f.batch, gathered, c, space, report, true, looks);
    for (int q = 0; q < f.group.count; q += W)
      note_copies(load_lanes<I>(f.has_copies + q), f.batch[q / W], looks[q / W], report);
    for (int q = 0; q < f.group.count; q += W) {
      Batch& p = f.batch[q / W];
      const Gathered<V>& g = gathered[q / W];
      const Vec3<V> v = particle_velocity<transfer>(p, g, c.alpha);
      if constexpr (!is_aflip) f.carrier[q / W] = Base::carrier_of(c, v, g);
      const Location<I> at = Base::finish_records(a, f.group, q, p, v, f.carrier[q / W], report);
      Base::each_lane(f.group, q,
                      [&](int l, Index storage) { Base::write_location(a, storage, at, l); });
    }
  }
};

}  // namespace neve::sim::kernels
