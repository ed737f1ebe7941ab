#pragma once
/// The sweeps of the solve for v_new; instantiated once per instruction set. An application of the
/// Hessian takes particles once: gather the gradient of the nodes' displacements, change of stress,
/// scatter of the forces.

#include "sim/kernels/held.h"
#include "sim/kernels/implicit.h"
#include "sim/kernels/sweeps.h"

namespace neve::sim::kernels {

template <class Real, int K, bool is_mls, class Set>
struct SolveSweepsFor {
  using Args = SolveArgs<Real>;
  using Base = SweepsFor<Real, K, is_mls ? TransferKind::mls : TransferKind::flip, Set>;
  using Index = typename Base::Index;
  using V = typename Base::V;
  using I = typename Base::I;
  using Batch = typename Base::Batch;
  using Rows = typename Base::ScatterRows;
  using Products = Lanes<double, 4>;
  static constexpr int W = Base::W;
  /// Scale of a gradient: 1/h, and 1/D of MLS in units of h.
  static constexpr Real gradient_scale = is_mls ? Real(1 / apic_inertia<K>) : Real(1);

  NEVE_INLINE static Quad<Real>* vector(const Args& a, Index block, SolveVector which) {
    return a.vectors +
           (static_cast<std::size_t>(block) * solve_vectors + static_cast<std::size_t>(which)) *
               block_nodes;
  }

  // ---- particles --------------------------------------------------------------------------------

  template <class Group>
  NEVE_INLINE static Quad<Real>* elasticity_of(const Args& a, const Group& group, int q) {
    return a.elasticity + elasticity_quads * (group.storage - a.step.order + q);
  }

  template <class Group>
  NEVE_INLINE static const LawKernels<Real, Set>& law_of(const Group& group) {
    return LawSet<Set>::kernels(static_cast<int>(group.record[0]->model()), Real());
  }

  static void keep_elasticity(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b)
      Base::each_batch(a.step, a.step.blocks[b], [&](const auto& group, int q, const Batch& p) {
        Elasticity<V> e;
        law_of(group).elasticity(p, a.step.constants.materials, e);
        Quad<Real>* to = elasticity_of(a, group, q);
        const int count = group.count - q;
        const auto put = [&](int word, V x, V y, V z, V w) NEVE_INLINE_BODY {
          scatter_words(FourWords<V>{{x, y, z, w}}, [&](int l, Quad<Real> quad) NEVE_INLINE_BODY {
            if (l < count) to[elasticity_quads * l + word] = quad;
          });
        };
        put(0, e.shape.xx, e.shape.yy, e.shape.zz, e.shape.xy);
        put(1, e.shape.xz, e.shape.yz, e.V0_mu, e.V0_lambda);
      });
  }

  /// Lanes without a particle repeat the last.
  NEVE_INLINE static Elasticity<V> load_elasticity(const Quad<Real>* from, int last) {
    FourWords<V> part[elasticity_quads];
    unrolled<elasticity_quads>([&](auto word) NEVE_INLINE_BODY {
      part[word] = gather_words<V>(
          [&](int l) NEVE_INLINE_BODY { return from[elasticity_quads * smaller(l, last) + word]; });
    });
    const V *a = part[0].w, *b = part[1].w;
    return {{a[0], a[1], a[2], a[3], b[0], b[1]}, b[2], b[3]};
  }

  static void apply(const Args& a, Index begin, Index end) {
    Quad<Real> u[Tile<K>::nodes];
    Rows rows;
    auto& s = rows.s;
    for (Index b = begin; b < end; ++b) {
      const ParticleBlock& block = a.step.blocks[b];
      load_tile<Real, K, Set>(
          block, [&](Index n) { return a.u + n * a.u_stride; }, u);
      Quad<Real>* tile = tile_of<Real, K>(a.step, b, 0);
      Base::clear(block, tile);
      Base::template each_group<scatter_group>(a.step, block, [&](const auto& group) {
        for (int q = 0; q < group.count; q += W) apply_to(a, group, q, u, rows);
        each_cell(s, group.count, [&](int first, int last) {
          scatter_tensor<Real, K, scatter_group, Set>(s, is_mls ? s.arm : s.dw, rows.force, first,
                                                      last, tile);
        });
      });
    }
  }

  /// Rows of the forces of particles [q, q + W) of a group.
  template <class Group>
  NEVE_INLINE static void apply_to(const Args& a, const Group& group, int q, const Quad<Real>* u,
                                   Rows& rows) {
    auto& s = rows.s;
    const int count = smaller(W, group.count - q);
    Batch p;
    RecordReader<V, I>(group.record + q, p).place();
    s.template set<!is_mls, is_mls>(q, p.offset, p.cell);
    const Real scale = a.step.constants.inv_h * gradient_scale;
    V G[9], D[9];
    gather_gradient(s, q, count, scale, u, G);
    law_of(group).stress_change(load_elasticity(elasticity_of(a, group, q), count - 1), G, D);
    Quad<Real> column[3][W];
    unrolled<3>([&](auto k) NEVE_INLINE_BODY {
      store_quads(FourWords<V>{{D[k] * scale, D[3 + k] * scale, D[6 + k] * scale, V{}}}, column[k]);
    });
    for (int l = 0; l < count; ++l)
      rows.force[q + l] = Base::tensor_rows(column, l, Row<Real, Set>::spread(s.z[q + l]),
                                            is_mls ? s.arm_z[q + l] : s.dz[q + l]);
  }

  NEVE_INLINE static void gather_gradient(const decltype(Rows::s)& s, int q, int count, Real scale,
                                          const Quad<Real>* u, V* G) {
    Quad<Real> sums[4 * W];
    for (int l = 0; l < W; ++l)
      gather_tensor<Set>(s, is_mls ? s.arm : s.dw, is_mls ? s.arm_z : s.dz,
                         q + smaller(l, count - 1), u, sums + 4 * l);
    for (int c = 0; c < 3; ++c) {
      const FourWords<V> words =
          gather_words<V>([&](int l) NEVE_INLINE_BODY { return sums[4 * l + 1 + c]; });
      for (int r = 0; r < 3; ++r) G[3 * r + c] = words.w[r] * scale;
    }
  }

  // ---- nodes ------------------------------------------------------------------------------------

  /// Sums are taken in double: thousands of nodes, and differences of products decide.
  NEVE_INLINE static Products product(Quad<Real> x, Quad<Real> y) {
    return __builtin_convertvector(x, Products) * __builtin_convertvector(y, Products);
  }
  NEVE_INLINE static Quad<Real> with_fourth(Quad<Real> x, Real fourth) {
    x[3] = fourth;
    return x;
  }

  NEVE_INLINE static double total(Products sum) { return (sum[0] + sum[1]) + sum[2]; }
  NEVE_INLINE static double* sums_of(const Args& a, Index block) {
    return a.sums + static_cast<std::size_t>(block) * solve_sums;
  }

  /// body(n, sum) for the nodes of a block, whose first sum it is.
  template <class Body>
  NEVE_INLINE static void each_node(const Args& a, Index block, const Body& body) {
    Products sum{};
    for (int n = 0; n < block_nodes; ++n) body(n, sum);
    sums_of(a, block)[0] = total(sum);
  }

  static void start(const Args& a, Index begin, Index end) {
    Quad<Real> v_star[block_nodes];
    for (Index b = begin; b < end; ++b) {
      const Quad<Real>* v_free = nodes_of(a.step, b, channel_v_new);
      for (int n = 0; n < block_nodes; ++n) v_star[n] = v_free[n];
      Quad<Real>* held = vector(a, b, solve_held);
      collide_and_hold(a, b, v_star, held);
      Quad<Real>*y = vector(a, b, solve_y), *u = vector(a, b, solve_u);
      Quad<Real>*q = vector(a, b, solve_q), *Aq = vector(a, b, solve_Aq);
      for (int n = 0; n < block_nodes; ++n) {
        const Real root = root_mass(v_star[n]);
        y[n] = free_part(held[n], with_fourth(v_star[n] * root, 0));
        u[n] = with_fourth(v_star[n], root > Real(0) ? Real(1) / root : Real(0));
        q[n] = Aq[n] = Quad<Real>{};
      }
      set_velocities<Set>(a.step, b, v_star);
    }
  }

  NEVE_INLINE static Real root_mass(const Quad<Real>& v) {
    return v[3] > Real(0) ? square_root(v[3]) : Real(0);
  }

  static void motion(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      const Quad<Real>* v_star = nodes_of(a.step, b, channel_v_new);
      Products squares{}, momentum{};
      for (int n = 0; n < block_nodes; ++n) {
        const Real root = root_mass(v_star[n]);
        const Quad<Real> whole = with_fourth(v_star[n] * root, 0);
        squares += product(whole, whole);
        momentum += product(with_fourth(whole, root), with_fourth(Quad<Real>{} + root, root));
      }
      double* sums = sums_of(a, b);
      sums[0] = total(squares);
      for (int k = 0; k < 4; ++k) sums[1 + k] = momentum[k];
    }
  }

  /// Step 5: v_star of a block's nodes from v_free, and the directions that it holds.
  NEVE_INLINE static void collide_and_hold(const Args& a, Index block, Quad<Real>* v,
                                           Quad<Real>* held) {
    const StepConstants<Real>& c = a.step.constants;
    for (int n = 0; n < block_nodes; ++n) held[n] = Quad<Real>{};
    NearColliders<Real> near;
    find_near_nodes<Set>(near, c, a.step.node_blocks[block].key);
    if (near.count == 0) return;
    Held<V> of[block_nodes / W];
    double work = 0;
    BlockLoads<Set> loads(a.step.load_count);
    collide_nodes<Set>(v, c, near, work, loads,
                       [&](int n, const Response<V>& response)
                           NEVE_INLINE_BODY { of[n / W].add(response); });
    for (int n = 0; n < block_nodes; n += W) {
      const Held<V>& h = of[n / W];
      store_quads(FourWords<V>{{h.axis.x, h.axis.y, h.axis.z, h.count}}, held + n);
      if (any_lane(h.count > V{})) a.is_held[block] = 1;
    }
    loads.give(a.step.loads, a.step.load_unit);
    a.step.node_contact_work[block] += work;
  }

  /// beta dt^2 M^-1/2 H u of a block's nodes, from the tiles.
  NEVE_INLINE static void collect_change(const Args& a, Index block, const Quad<Real>* u,
                                         Quad<Real>* change) {
    collect<Real, K, Set>(a.step, block, 0, change);
    for (int n = 0; n < block_nodes; ++n)
      change[n] = with_fourth(change[n] * (a.beta_dt_squared * u[n][3]), 0);
  }

  /// Nodes without mass stay at rest.
  static void show(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      const Quad<Real>* y = vector(a, b, solve_y);
      Quad<Real>* u = vector(a, b, solve_u);
      for (int n = 0; n < block_nodes; ++n) u[n] = with_fourth(y[n] * u[n][3], u[n][3]);
    }
  }

  static void residual(const Args& a, Index begin, Index end) {
    Quad<Real> change[block_nodes];
    for (Index b = begin; b < end; ++b) {
      Quad<Real>*r = vector(a, b, solve_r), *u = vector(a, b, solve_u);
      const Quad<Real>*held = vector(a, b, solve_held), *y = vector(a, b, solve_y);
      const Quad<Real>* v_star = nodes_of(a.step, b, channel_v_new);
      collect_change(a, b, u, change);
      each_node(a, b, [&](int n, Products& sum) {
        const Quad<Real> whole = with_fourth(v_star[n] * root_mass(v_star[n]), 0);
        const Quad<Real> wanted = free_part(held[n], whole);
        r[n] = (wanted - y[n]) - free_part(held[n], change[n]);
        u[n] = with_fourth(r[n] * u[n][3], u[n][3]);
        sum += product(r[n], r[n]);
      });
    }
  }

  static void image(const Args& a, Index begin, Index end) {
    Quad<Real> change[block_nodes];
    for (Index b = begin; b < end; ++b) {
      const Quad<Real>*r = vector(a, b, solve_r), *u = vector(a, b, solve_u);
      const Quad<Real>* held = vector(a, b, solve_held);
      Quad<Real>* Ar = vector(a, b, solve_Ar);
      const Quad<Real>* Aq = vector(a, b, solve_Aq);
      collect_change(a, b, u, change);
      Products rAr{}, ArAr{}, ArAq{};
      for (int n = 0; n < block_nodes; ++n) {
        Ar[n] = r[n] + free_part(held[n], change[n]);
        rAr += product(r[n], Ar[n]);
        ArAr += product(Ar[n], Ar[n]);
        ArAq += product(Ar[n], Aq[n]);
      }
      double* sums = sums_of(a, b);
      sums[0] = total(rAr);
      sums[1] = total(ArAr);
      sums[2] = total(ArAq);
    }
  }

  static void advance(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      const Quad<Real>* Ar = vector(a, b, solve_Ar);
      Quad<Real>*q = vector(a, b, solve_q), *Aq = vector(a, b, solve_Aq);
      Quad<Real>*y = vector(a, b, solve_y), *r = vector(a, b, solve_r);
      Quad<Real>* u = vector(a, b, solve_u);
      each_node(a, b, [&](int n, Products& sum) {
        q[n] = r[n] + q[n] * a.turn;
        Aq[n] = Ar[n] + Aq[n] * a.turn;
        y[n] += q[n] * a.along;
        r[n] -= Aq[n] * a.along;
        u[n] = with_fourth(r[n] * u[n][3], u[n][3]);
        sum += product(r[n], r[n]);
      });
    }
  }

  static void size(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      const Quad<Real>*y = vector(a, b, solve_y), *u = vector(a, b, solve_u);
      each_node(a, b, [&](int n, Products& sum) {
        const Quad<Real> v = y[n] * u[n][3];
        sum += product(y[n], y[n]) + __builtin_convertvector(v - v, Products);
      });
    }
  }

  static void finish(const Args& a, Index begin, Index end) {
    const StepConstants<Real>& c = a.step.constants;
    Quad<Real> v[block_nodes];
    for (Index b = begin; b < end; ++b) {
      const Quad<Real>*y = vector(a, b, solve_y), *u = vector(a, b, solve_u);
      const Quad<Real>*held = vector(a, b, solve_held),
            *v_star = nodes_of(a.step, b, channel_v_new);
      Products gained{};
      for (int n = 0; n < block_nodes; ++n) {
        const Quad<Real> v_held = v_star[n] - free_part(held[n], v_star[n]);
        v[n] = with_fourth(v_held + y[n] * u[n][3], v_star[n][3]);
        gained += product(v[n] - v_star[n], Quad<Real>{} + v_star[n][3]);
      }
      for (int k = 0; k < 3; ++k) sums_of(a, b)[k] = gained[k];
      double work = 0;
      if (a.collides) {
        NearColliders<Real> near;
        find_near_nodes<Set>(near, c, a.step.node_blocks[b].key);
        BlockLoads<Set> loads(a.step.load_count);
        collide_nodes<Set>(v, c, near, work, loads);
        loads.give(a.step.loads, a.step.load_unit);
      }
      a.step.node_contact_work[b] += work;
      set_velocities<Set>(a.step, b, v);
    }
  }

  /// Held directions keep their momentum in the solve: what acts there is beta dt^2 H v_new.
  /// body(n, impulse, size) for the held nodes of a block, from the tiles.
  template <class Body>
  NEVE_INLINE static void each_reaction(const Args& a, Index block, const Body& body) {
    Quad<Real> force[block_nodes];
    collect<Real, K, Set>(a.step, block, 0, force);
    const Quad<Real>*held = vector(a, block, solve_held),
          *v_new = nodes_of(a.step, block, channel_v_new);
    for (int n = 0; n < block_nodes; ++n) {
      if (!(v_new[n][3] > Real(0)) || held[n][3] == Real(0)) continue;
      const Quad<Real> impulse = with_fourth(force[n] * a.beta_dt_squared, 0);
      const Quad<Real> on_held = impulse - free_part(held[n], impulse);
      const Quad<Real> squares = on_held * on_held;
      body(n, on_held, square_root(squares[0] + squares[1] + squares[2]));
    }
  }

  static void reaction(const Args& a, Index begin, Index end) {
    for (Index b = begin; b < end; ++b) {
      double* sums = sums_of(a, b);
      for (int k = 0; k < 4; ++k) sums[k] = 0;
      each_reaction(a, b, [&](int, const Quad<Real>& impulse, Real size) NEVE_INLINE_BODY {
        for (int k = 0; k < 3; ++k) sums[k] += static_cast<double>(impulse[k]);
        sums[3] += static_cast<double>(size);
      });
    }
  }

  /// It is the doing of the collider that the node is deepest in.
  static void react(const Args& a, Index begin, Index end) {
    const Quad<Real> more{a.per_impulse[0], a.per_impulse[1], a.per_impulse[2], Real(0)};
    for (Index b = begin; b < end; ++b) {
      NearColliders<Real> near;
      find_near_nodes<Set>(near, a.step.constants, a.step.node_blocks[b].key);
      BlockLoads<Set> loads(a.step.load_count);
      const Quad<Real>* v_new = nodes_of(a.step, b, channel_v_new);
      double work = 0;
      each_reaction(a, b, [&](int n, const Quad<Real>& reaction, Real size) NEVE_INLINE_BODY {
        const Quad<Real> impulse = reaction + more * size, done = impulse * v_new[n];
        work += static_cast<double>(done[0] + done[1] + done[2]);
        add_load(near, n, a.step.constants.h, impulse, loads);
      });
      loads.give(a.step.loads, a.step.load_unit);
      a.step.node_contact_work[b] += work;
    }
  }

  NEVE_INLINE static void add_load(const NearColliders<Real>& near, int n, Real h,
                                   const Quad<Real>& impulse, BlockLoads<Set>& loads) {
    using One = Lanes<Real, 4>;
    const Vec3<One> r{all<One>(static_cast<Real>(n >> 4) * h),
                      all<One>(static_cast<Real>(n >> 2 & 3) * h),
                      all<One>(static_cast<Real>(n & 3) * h)};
    const LocalCollider<Real>* deepest = nullptr;
    Real least = 0;
    for (int k = 0; k < near.count; ++k) {
      Vec3<One> normal;
      const Real distance = surface_distance(near.local[k], r, normal)[0];
      if (deepest && !(distance < least)) continue;
      deepest = near.local + k;
      least = distance;
    }
    if (deepest)
      loads.add(*deepest,
                Vec3<One>{all<One>(impulse[0]), all<One>(impulse[1]), all<One>(impulse[2])}, r, 1u);
  }

  static constexpr SolveSweeps<Real> table{keep_elasticity, apply, start,   motion, show,
                                           residual,        image, advance, size,   finish,
                                           reaction,        react};
};

template <class Real, class Set>
const SolveSweeps<Real>& choose_solve_sweeps(int nodes, bool is_mls) {
  if (nodes == cubic_nodes)
    return is_mls ? SolveSweepsFor<Real, cubic_nodes, true, Set>::table
                  : SolveSweepsFor<Real, cubic_nodes, false, Set>::table;
  return is_mls ? SolveSweepsFor<Real, quadratic_nodes, true, Set>::table
                : SolveSweepsFor<Real, quadratic_nodes, false, Set>::table;
}

}  // namespace neve::sim::kernels
