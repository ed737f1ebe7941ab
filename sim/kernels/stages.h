#pragma once
/// Each stage of the step once, as an inline kernel over lanes or rows. Both drivers call these, so
/// a stage cannot differ between them. Numbers are the paper's steps (section 4).

#include "sim/kernels/kernels.h"
#include "sim/kernels/particle_lanes.h"
#include "sim/kernels/row.h"

namespace neve::sim::kernels {

// ---- stencils -----------------------------------------------------------------------------------

/// Weights of up to G particles of one block, laid out for row kernels: numbers to multiply a row
/// with along x and y, quads along z. w_ip is the product over the axes.
template <class Real, int K, int G>
struct Stencils {
  Real w[3][K][G];    ///< N
  Real dw[3][K][G];   ///< N' in grid units: times 1/h is the derivative by x_p
  Real arm[3][K][G];  ///< N (x_i - x_p)/h
  Quad<Real> z[G], dz[G], arm_z[G];
  Integer<Real> first[G];  ///< node of the tile that the stencil starts at

  /// Particles [q, q + W). @param offset, cell  x, y, z of the records
  template <bool needs_dw, bool needs_arm, class V, class I>
  NEVE_INLINE void set(int q, const V* offset, const I* cell) {
    I base[3];
    for (int axis = 0; axis < 3; ++axis) {
      base[axis] = stencil_base<K, Real>(cell[axis], offset[axis]);
      const V place = offset[axis] + __builtin_convertvector(cell[axis] - base[axis], V);
      V N[K], dN[K], N_arm[K];
      spline<Real>(place, N, dN);
      for (int k = 0; k < K; ++k) {
        N_arm[k] = N[k] * (static_cast<Real>(k) - place);
        store_lanes(N[k], w[axis][k] + q);
        if constexpr (needs_dw) store_lanes(dN[k], dw[axis][k] + q);
        if constexpr (needs_arm) store_lanes(N_arm[k], arm[axis][k] + q);
      }
      if (axis < 2) continue;
      store_quads(along_z(N), z + q);
      if constexpr (needs_dw) store_quads(along_z(dN), dz + q);
      if constexpr (needs_arm) store_quads(along_z(N_arm), arm_z + q);
    }
    const I node =
        ((base[0] & 3) * Tile<K>::side + (base[1] & 3)) * Tile<K>::side_z + (base[2] & 3);
    __builtin_memcpy(first + q, &node, sizeof node);
  }

 private:
  template <class V>
  NEVE_INLINE static FourWords<V> along_z(const V (&weights)[K]) {
    FourWords<V> out{};
    for (int k = 0; k < K; ++k) out.w[k] = weights[k];
    return out;
  }
};

/// body(begin, end) for every run of particles that share a cell.
template <class Real, int K, int G, class Body>
NEVE_INLINE void each_cell(const Stencils<Real, K, G>& s, int count, const Body& body) {
  for (int begin = 0; begin < count;) {
    int end = begin + 1;
    while (end < count && s.first[end] == s.first[begin]) ++end;
    body(begin, end);
    begin = end;
  }
}

// ---- transfers: reusable scatter and gather -----------------------------------------------------

/// Number of slabs of a stencil (nodes of the same x) accumulated at once: as many as fit into
/// registers.
template <class Real, int K, class Set>
inline constexpr int slabs_at_once = Set::template lanes<Real> == 16 ? K : 1;

/// tile += what add(i, q, rows) adds to the K rows of slab i, over the particles [begin, end) of
/// one cell: kept in registers until the cell is done.
template <class Set, class Real, int K, int G, class Add>
NEVE_INLINE void scatter_slabs(const Stencils<Real, K, G>& s, int begin, int end, Quad<Real>* tile,
                               const Add& add) {
  using R = Row<Real, Set>;
  constexpr int slabs = slabs_at_once<Real, K, Set>;
  for (int i0 = 0; i0 < K; i0 += slabs) {
    R sum[slabs][K];
    unrolled<slabs>([&](auto i) NEVE_INLINE_BODY {
      unrolled<K>([&](auto j) NEVE_INLINE_BODY { sum[i][j] = R::zero(); });
    });
    for (int q = begin; q < end; ++q)
      unrolled<slabs>([&](auto i) NEVE_INLINE_BODY { add(i0 + i, q, sum[i]); });
    unrolled<slabs>([&](auto i) NEVE_INLINE_BODY {
      unrolled<K>([&](auto j) NEVE_INLINE_BODY {
        sum[i][j].add_to(tile + s.first[begin] + Tile<K>::node(i0 + i, j, 0));
      });
    });
  }
}

/// tile += sum over the particles [begin, end) of one cell of w_ip value_p.
/// @param along  per particle: its value times the weights along z
template <class Real, int K, int G, class Set>
NEVE_INLINE void scatter_value(const Stencils<Real, K, G>& s, const Row<Real, Set>* along,
                               int begin, int end, Quad<Real>* tile) {
  using R = Row<Real, Set>;
  scatter_slabs<Set>(s, begin, end, tile, [&](int i, int q, R(&sum)[K]) NEVE_INLINE_BODY {
    const R across = along[q] * s.w[0][i][q];
    unrolled<K>([&](auto j) NEVE_INLINE_BODY { sum[j] = fused(across, s.w[1][j][q], sum[j]); });
  });
}

/// A tensor A of one particle, by columns, as rows: A_x and A_y times the weights along z, and A_z
/// times g along z. A value times the weights along z may be added to `z`.
template <class Real, class Set>
struct TensorRows {
  Row<Real, Set> x, y, z;
};

/// tile += sum over the particles [begin, end) of one cell of A_p g_ip, with g_ip the product
/// weights in which one axis takes g instead of w: the gradient of w_ip (g = dw) or w_ip (x_i -
/// x_p) (arm).
template <class Real, int K, int G, class Set>
NEVE_INLINE void scatter_tensor(const Stencils<Real, K, G>& s, const Real (&g)[3][K][G],
                                const TensorRows<Real, Set>* A, int begin, int end,
                                Quad<Real>* tile) {
  using R = Row<Real, Set>;
  scatter_slabs<Set>(s, begin, end, tile, [&](int i, int q, R(&sum)[K]) NEVE_INLINE_BODY {
    const R with_w = fused(A[q].x, g[0][i][q], A[q].z * s.w[0][i][q]);
    const R with_g = A[q].y * s.w[0][i][q];
    unrolled<K>([&](auto j) NEVE_INLINE_BODY {
      sum[j] = fused(with_w, s.w[1][j][q], fused(with_g, g[1][j][q], sum[j]));
    });
  });
}

/// sum w_ip value_i, then the columns of sum value_i g_ip^T, over the stencil of particle q.
template <class Set, class Real, int K, int G>
NEVE_INLINE void gather_tensor(const Stencils<Real, K, G>& s, const Real (&g)[3][K][G],
                               const Quad<Real>* g_z, int q, const Quad<Real>* tile,
                               Quad<Real>* value_and_columns) {
  using R = Row<Real, Set>;
  R sum = R::zero(), sum_x = R::zero(), sum_y = R::zero();
  unrolled<K>([&](auto i) NEVE_INLINE_BODY {
    R plane = R::zero(), plane_y = R::zero();
    unrolled<K>([&](auto j) NEVE_INLINE_BODY {
      const R row = R::load(tile + s.first[q] + Tile<K>::node(i, j, 0));
      plane = fused(row, s.w[1][j][q], plane);
      plane_y = fused(row, g[1][j][q], plane_y);
    });
    sum = fused(plane, s.w[0][i][q], sum);
    sum_x = fused(plane, g[0][i][q], sum_x);
    sum_y = fused(plane_y, s.w[0][i][q], sum_y);
  });
  const R z = R::spread(s.z[q]), with_g = R::spread(g_z[q]);
  sums_of(sum * z, sum_x * z, sum_y * z, sum * with_g, value_and_columns);
}

/// sum w_ip value_i over the stencil of particle q.
template <class Set, class Real, int K, int G>
NEVE_INLINE Quad<Real> gather_value(const Stencils<Real, K, G>& s, int q, const Quad<Real>* tile) {
  using R = Row<Real, Set>;
  R sum = R::zero();
  unrolled<K>([&](auto i) NEVE_INLINE_BODY {
    R plane = R::zero();
    unrolled<K>([&](auto j) NEVE_INLINE_BODY {
      plane = fused(R::load(tile + s.first[q] + Tile<K>::node(i, j, 0)), s.w[1][j][q], plane);
    });
    sum = fused(plane, s.w[0][i][q], sum);
  });
  return (sum * R::spread(s.z[q])).sum();
}

// ---- particle to node ---------------------------------------------------------------------------

/// Columns of a tensor, four channels each; the fourth is 0.
template <class V>
struct Columns {
  FourWords<V> column[3];
};

/// Step 3: f_i = -sum V0 tau grad_w_ip (the paper, equation 6, with J cancelled). MLS replaces
/// grad_w_ip by w_ip (x_i - x_p) / D (Hu et al. 2018).
/// @param scale  1, or dt for the change of momentum
template <int K, TransferKind transfer, class V>
NEVE_INLINE Columns<V> elastic_force(V V0, const V* tau, ElementOf<V> inv_h, ElementOf<V> scale) {
  using Real = ElementOf<V>;
  constexpr Real inertia = transfer == TransferKind::mls ? Real(1 / apic_inertia<K>) : Real(1);
  const V factor = V0 * (-inv_h * inertia * scale);
  const V xx = tau[0], yy = tau[1], zz = tau[2], xy = tau[3], xz = tau[4], yz = tau[5];
  return {{{{factor * xx, factor * xy, factor * xz, V{}}},
           {{factor * xy, factor * yy, factor * yz, V{}}},
           {{factor * xz, factor * yz, factor * zz, V{}}}}};
}

/// Step 1, all transfers but FLIP: the momentum of v_p + C (x_i - x_p) besides that of v_p.
template <class V>
NEVE_INLINE Columns<V> affine_momentum(V m, const V* C, ElementOf<V> h) {
  const V factor = m * h;
  return {{{{factor * C[0], factor * C[3], factor * C[6], V{}}},
           {{factor * C[1], factor * C[4], factor * C[7], V{}}},
           {{factor * C[2], factor * C[5], factor * C[8], V{}}}}};
}

template <class V>
NEVE_INLINE Columns<V> operator+(const Columns<V>& a, const Columns<V>& b) {
  Columns<V> sum;
  for (int c = 0; c < 3; ++c)
    for (int w = 0; w < 4; ++w) sum.column[c].w[w] = a.column[c].w[w] + b.column[c].w[w];
  return sum;
}

/// Step 2, once per body: rho_p = sum m_i w_ip / h^3, the volume m_p / rho_p; over J_P it is V0.
template <class Set, class Real, int K, int G>
NEVE_INLINE Real estimated_volume(Real m, const Stencils<Real, K, G>& s, int q, Real h,
                                  const Quad<Real>* momentum) {
  return m * (h * h * h) / gather_value<Set>(s, q, momentum)[3];
}

// ---- nodes --------------------------------------------------------------------------------------

/// The fourth number of every quad, in all of its lanes.
template <class V, int... I>
NEVE_INLINE V fourth_of_quads(V v, Indices<I...>) {
  return __builtin_shufflevector(v, v, (I | 3)...);
}

/// A row of nodes that gets velocities v(part, mass) where it has mass, and zeros elsewhere. The
/// fourth number of a node stays its mass.
template <class Real, class Set, class Velocity>
NEVE_INLINE Row<Real, Set> velocities_with_mass(const Row<Real, Set>& row, const Velocity& v) {
  using R = Row<Real, Set>;
  using V = typename R::V;
  MaskOf<V> is_mass{};
  for (int l = 3; l < R::width; l += 4) is_mass[l] = -1;
  R out;
  unrolled<R::parts>([&](auto p) NEVE_INLINE_BODY {
    const V mass = fourth_of_quads(row.part[p], Counted<R::width>{});
    const MaskOf<V> has_mass = mass > V{};
    const V velocity = v(p, has_mass ? mass : all<V>(1));
    out.part[p] = has_mass ? (is_mass ? mass : velocity) : V{};
  });
  return out;
}

/// v_old = momentum / mass; 0 where no mass arrived.
template <class Real, class Set>
NEVE_INLINE Row<Real, Set> row_v_old(const Row<Real, Set>& momentum) {
  return velocities_with_mass(
      momentum, [&](auto p, auto mass) NEVE_INLINE_BODY { return momentum.part[p] / mass; });
}

/// Step 4: v_free = v_old + dt (f / m + g). @param force  0 without `has_force`
template <bool has_force, class Real, class Set>
NEVE_INLINE Row<Real, Set> row_v_free(const Row<Real, Set>& v_old, const Row<Real, Set>& force,
                                      const StepConstants<Real>& c) {
  const Quad<Real> g{c.gravity[0], c.gravity[1], c.gravity[2], Real(0)};
  const auto gravity = repeat_quad<Row<Real, Set>::width>(g);
  return velocities_with_mass(v_old, [&](auto p, auto mass) NEVE_INLINE_BODY {
    if constexpr (has_force) return v_old.part[p] + (force.part[p] / mass + gravity) * c.dt;
    return v_old.part[p] + (decltype(mass){} + gravity) * c.dt;
  });
}

// ---- contact ------------------------------------------------------------------------------------

/// Steps 5 and 9: contact at places r in the block, collider after collider.
/// @param is_used  lanes that count
/// @param depth    from which contact acts, m
/// @param work     gets the work of the colliders, impulse times the speed of their surface, J
/// @param loads    impulses of the colliders
/// @param note     called with the Response of each collider
template <class Set, class V, class Real, class Note>
NEVE_NOINLINE void collide(Vec3<V>& v, const V& mass, const Vec3<V>& r, const MaskOf<V>& is_used,
                           const LocalCollider<Real>* colliders, int count, Real depth,
                           double& work, BlockLoads<Set>& loads, const Note& note) {
  V done{};
  for (int k = 0; k < count; ++k) {
    const Vec3<V> before = v;
    const Response<V> response = respond(colliders[k], r, v, depth);
    v = response.v;
    note(response);
    if (const unsigned acted = lane_bits(is_used & response.acts); acted != 0)
      loads.add(colliders[k], (v - before) * mass, r, acted);
    done += mass * dot(v - before, surface_velocity(colliders[k], r));
  }
  const MaskOf<V> counts = is_used & (done != V{});
  if (!any_lane(counts)) return;
  for (int l = 0; l < lane_count<V>; ++l)
    if (counts[l]) work += static_cast<double>(done[l]);
}

/// Colliders that a block can touch, placed relative to it.
template <class Real>
struct NearColliders {
  union {
    LocalCollider<Real> local[max_colliders];  ///< only the first `count` are there
  };
  int count = 0;
  NEVE_INLINE NearColliders() {}
};

/// Keeps the colliders of the scene, beside a block, that are not too far away.
template <class Set, class Real, class IsFar>
NEVE_INLINE void keep_near(NearColliders<Real>& near, const StepConstants<Real>& c,
                           std::uint64_t key, const IsFar& is_far) {
  int cell[3];
  for (int a = 0; a < 3; ++a) cell[a] = block_coordinate(key, a) * block_side;
  for (int k = 0; k < c.collider_count; ++k) {
    const LocalCollider<Real> candidate = localize<Real>(c.colliders[k], cell, c.h_double);
    if (!is_far(c.colliders[k], candidate)) near.local[near.count++] = candidate;
  }
}

/// @param centre, reach  places in the block lie within `reach` cells of (centre, centre, centre)
template <class Set, class Real>
NEVE_NOINLINE void find_near(NearColliders<Real>& near, const StepConstants<Real>& c,
                             std::uint64_t key, Real centre, Real reach) {
  const Vec3<Real> middle{centre * c.h, centre * c.h, centre * c.h};
  keep_near<Set>(near, c, key, [&](const ColliderPose&, const LocalCollider<Real>& candidate) {
    return is_out_of_reach(candidate, middle, reach * c.h);
  });
}

/// Particles of a block lie within these cells of this place, along each axis.
template <int K>
inline constexpr double particle_middle = 0.5 * (K + 2);
inline constexpr double particle_reach = 2.01;  ///< and rounding

/// Nodes lie in [0, 3] cells from the block's first node, particles of the block in [0.5, 5), and
/// after a step less than a cell further.
template <class Set, class Real>
NEVE_INLINE void find_near_nodes(NearColliders<Real>& near, const StepConstants<Real>& c,
                                 std::uint64_t key) {
  if (c.collider_count > 0) find_near<Set>(near, c, key, Real(1.5), Real(2.7));
}
/// Finds colliders that a particle of the block may be inside of, and whose velocity is known. A
/// body has another one after the step: what stopped here against that of before would push it once
/// more, and a light one beyond all measure. Contact at particles knows it.
template <class Set, int K, class Real>
NEVE_NOINLINE void find_near_particles(NearColliders<Real>& near, const StepConstants<Real>& c,
                                       std::uint64_t key) {
  const Real centre = static_cast<Real>(particle_middle<K>) * c.h;
  const Real half = static_cast<Real>(particle_reach) * c.h;
  keep_near<Set>(near, c, key, [&](const ColliderPose& pose, const LocalCollider<Real>& candidate) {
    return pose.moves_by_itself ||
           is_cube_out_of_reach(candidate, Vec3<Real>{centre, centre, centre}, half, Real(0));
  });
}
template <class Set, class Real>
NEVE_INLINE void find_near_moved(NearColliders<Real>& near, const StepConstants<Real>& c,
                                 std::uint64_t key) {
  if (c.collider_count > 0) find_near<Set>(near, c, key, Real(2.75), Real(5.7));
}

/// Step 5 on the nodes of a block: v_star from v_free.
/// @param note  called with the first node of some lanes and the Response of each collider
template <class Set, class Real, class Note>
NEVE_INLINE void collide_nodes(Quad<Real>* v, const StepConstants<Real>& c,
                               const NearColliders<Real>& near, double& work,
                               BlockLoads<Set>& loads, const Note& note) {
  constexpr int W = Set::template lanes<Real>;
  using V = Lanes<Real, W>;
  if (near.count == 0) return;
  for (int n = 0; n < block_nodes; n += W) {
    FourWords<V> words = load_quads<V>(v + n);
    Vec3<V> velocity{words.w[0], words.w[1], words.w[2]};
    Real place[3][W];
    for (int l = 0; l < W; ++l) {
      place[0][l] = static_cast<Real>((n + l) >> 4);
      place[1][l] = static_cast<Real>((n + l) >> 2 & 3);
      place[2][l] = static_cast<Real>((n + l) & 3);
    }
    const Vec3<V> r{load_lanes<V>(place[0]), load_lanes<V>(place[1]), load_lanes<V>(place[2])};
    const MaskOf<V> has_mass = words.w[3] > V{};
    collide<Set>(velocity, words.w[3], r * all<V>(c.h), has_mass, near.local, near.count,
                 static_cast<Real>(node_depth) * c.h, work, loads,
                 [&](const Response<V>& response) NEVE_INLINE_BODY { note(n, response); });
    for (int a = 0; a < 3; ++a) words.w[a] = has_mass ? velocity[a] : V{};
    store_quads(words, v + n);
  }
}
template <class Set, class Real>
NEVE_INLINE void collide_nodes(Quad<Real>* v, const StepConstants<Real>& c,
                               const NearColliders<Real>& near, double& work,
                               BlockLoads<Set>& loads) {
  collide_nodes<Set>(v, c, near, work, loads, [](int, const auto&) NEVE_INLINE_BODY {});
}

// ---- node to particle ---------------------------------------------------------------------------

/// True for transfers whose affine velocity is not their gradient of v, as that of MLS is.
constexpr bool has_own_C(TransferKind transfer) {
  return has_affine(transfer) && transfer != TransferKind::mls;
}

/// Sums over the nodes of up to G particles: a value and the columns of its tensor each.
template <class Real, TransferKind transfer, int G>
struct GatheredSums {
  Quad<Real> gradient[4 * G];
  Quad<Real> affine[has_own_C(transfer) ? 4 * G : 1];
  Quad<Real> moved[keeps_own(transfer) ? G : 1];

  /// Particle q of the stencils as number `to`. @param change  see gather
  template <class Set, int K, int S>
  NEVE_INLINE void take(const Stencils<Real, K, S>& s, int q, const Quad<Real>* v_new,
                        const Quad<Real>* change, int to) {
    if constexpr (transfer == TransferKind::mls)
      gather_tensor<Set>(s, s.arm, s.arm_z, q, v_new, gradient + 4 * to);
    else
      gather_tensor<Set>(s, s.dw, s.dz, q, v_new, gradient + 4 * to);
    if constexpr (keeps_own(transfer)) moved[to] = gather_value<Set>(s, q, change);
    if constexpr (has_own_C(transfer))
      gather_tensor<Set>(s, s.arm, s.arm_z, q, v_new, affine + 4 * to);
  }
  NEVE_INLINE void repeat(int q, int to) {
    for (int k = 0; k < 4; ++k) gradient[4 * to + k] = gradient[4 * q + k];
    if constexpr (keeps_own(transfer)) moved[to] = moved[q];
    if constexpr (has_own_C(transfer))
      for (int k = 0; k < 4; ++k) affine[4 * to + k] = affine[4 * q + k];
  }
};

/// Particles [q, q + W) of the sums, as lanes.
template <TransferKind transfer, int K, class V, class Real, int G>
NEVE_INLINE void lanes_of(const GatheredSums<Real, transfer, G>& sums, int q, Real inv_h,
                          Gathered<V>& out) {
  constexpr bool is_mls = transfer == TransferKind::mls;
  constexpr Real arm_scale = Real(1 / apic_inertia<K>);
  const Quad<Real>*gradient = sums.gradient + 4 * q, *affine = sums.affine;
  if constexpr (has_own_C(transfer)) affine += 4 * q;
  const auto take = [](const Quad<Real>* from, Real scale, V* to, int stride) NEVE_INLINE_BODY {
    const FourWords<V> words = gather_words<V>([&](int l) NEVE_INLINE_BODY { return from[4 * l]; });
    for (int a = 0; a < 3; ++a) to[stride * a] = words.w[a] * scale;
  };
  take(gradient, Real(1), out.v, 1);
  if constexpr (keeps_own(transfer)) {
    const FourWords<V> words = load_quads<V>(sums.moved + q);
    for (int a = 0; a < 3; ++a) out.change[a] = words.w[a];
  }
  for (int c = 0; c < 3; ++c) {
    take(gradient + 1 + c, is_mls ? inv_h * arm_scale : inv_h, out.grad_v + c, 3);
    if constexpr (has_own_C(transfer)) take(affine + 1 + c, inv_h * arm_scale, out.C + c, 3);
    if constexpr (is_mls)
      for (int a = 0; a < 3; ++a) out.C[3 * a + c] = out.grad_v[3 * a + c];
  }
}

/// Gathers the input of steps 7 and 8 from the grid, for particles [q, q + W) of the stencils.
/// @param change  v_new - v_old on the tile; FLIP and AFLIP only
template <class Set, TransferKind transfer, class V, class Real, int K, int G>
NEVE_INLINE void gather(const Stencils<Real, K, G>& s, int q, int count, Real inv_h,
                        const Quad<Real>* v_new, const Quad<Real>* change, Gathered<V>& out) {
  constexpr int W = lane_count<V>;
  GatheredSums<Real, transfer, W> sums;
  for (int l = 0; l < W; ++l)
    sums.template take<Set>(s, q + smaller(l, count - 1), v_new, change, l);
  lanes_of<transfer, K>(sums, 0, inv_h, out);
}

/// Step 7, first half: trial F_E = (I + dt grad_v) F_E.
template <class V>
NEVE_INLINE void strain(V* F_E, const V* grad_v, ElementOf<V> dt) {
  V F[9];
  const V step = all<V>(dt);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      const V* g = grad_v + 3 * a;
      const V rate = fused(g[0], F_E[b], fused(g[1], F_E[3 + b], g[2] * F_E[6 + b]));
      F[3 * a + b] = fused(step, rate, F_E[3 * a + b]);
    }
  for (int q = 0; q < 9; ++q) F_E[q] = F[q];
}

/// alpha (v_p - sum w_ip v_old): what a particle of AFLIP keeps beside the velocity of the grid.
/// @param p  with v_p as before the step
template <class V, class I>
NEVE_INLINE Vec3<V> own_velocity(const Record<V, I>& p, const Gathered<V>& g, ElementOf<V> alpha) {
  Vec3<V> own;
  for (int a = 0; a < 3; ++a) own[a] = (p.v[a] - (g.v[a] - g.change[a])) * alpha;
  return own;
}

/// beta of particles: of the paper below, between beta_min in compressed snow and beta_max. The
/// paper asks whether det F grows in the step; here J_E before the step decides, so that contact,
/// which comes before the deformation, knows how particles will move. Laws that never yield have
/// none: what moves by a velocity of its own is not strained by it, and only what breaks may part.
template <class V, class I>
NEVE_INLINE V separation_share(const Record<V, I>& p, const StepConstants<ElementOf<V>>& c) {
  const V beta =
      determinant(p.F_E) >= all<V>(c.separating_J_E) ? all<V>(c.beta_max) : all<V>(c.beta_min);
  const I is_whole = ((all<I>(c.whole_laws) >> p.model()) & 1) != 0;
  return is_whole ? V{} : beta;
}

/// Step 10, AFLIP and ASFLIP: the velocity that moves a particle, sum w_ip v_new + beta own.
/// Source: Fei, Guo, Wu, Huang, Gao 2021, Revisiting Integration in the Material Point Method: A
/// Scheme for Easier Separation and Less Dissipation, ACM Transactions on Graphics 40 (4). AFLIP is
/// beta = 0.
/// @param p  as before the step
template <class V, class I>
NEVE_INLINE Vec3<V> carrier_velocity(const Record<V, I>& p, const Gathered<V>& g,
                                     const StepConstants<ElementOf<V>>& c) {
  const V beta = separation_share(p, c);
  const Vec3<V> own = own_velocity(p, g, c.alpha);
  Vec3<V> v;
  for (int a = 0; a < 3; ++a) v[a] = fused(beta, own[a], g.v[a]);
  return v;
}

/// Step 8: FLIP v_p = (1 - alpha) PIC + alpha (v_p + change). APIC and MLS take v and C. AFLIP
/// takes C too, and v_p = PIC + alpha (v_p - sum w_ip v_old), which is FLIP's v_p.
template <TransferKind transfer, class V, class I>
NEVE_INLINE Vec3<V> particle_velocity(Record<V, I>& p, const Gathered<V>& g, ElementOf<V> alpha) {
  using Real = ElementOf<V>;
  Vec3<V> v;
  if constexpr (transfer == TransferKind::aflip) {
    v = own_velocity(p, g, alpha);
    for (int a = 0; a < 3; ++a) v[a] += g.v[a];
  } else {
    for (int a = 0; a < 3; ++a) {
      v[a] = g.v[a];
      if constexpr (transfer == TransferKind::flip)
        v[a] = g.v[a] * (Real(1) - alpha) + (p.v[a] + g.change[a]) * alpha;
    }
  }
  if constexpr (has_affine(transfer))
    for (int q = 0; q < 9; ++q) p.C[q] = g.C[q];
  return v;
}

/// Places of particles from the first node of a block, m.
template <class V, class I, class Real>
NEVE_INLINE Vec3<V> places_in_block(const Record<V, I>& p, std::uint64_t key, Real h) {
  Vec3<V> r;
  for (int a = 0; a < 3; ++a) {
    const auto cell = p.cell[a] - block_coordinate(key, a) * block_side;
    r[a] = (__builtin_convertvector(cell, V) + p.offset[a]) * h;
  }
  return r;
}

/// Step 9 on particles of a block, where they are before they move.
template <class Set, class V, class I, class Real>
NEVE_INLINE void collide_particles(const Record<V, I>& p, Vec3<V>& v, MaskOf<V> is_used,
                                   std::uint64_t key, const StepConstants<Real>& c,
                                   const NearColliders<Real>& near, double& work,
                                   BlockLoads<Set>& loads) {
  if (near.count == 0) return;
  const Vec3<V> r = places_in_block(p, key, c.h);
  collide<Set>(v, p.m, r, is_used, near.local, near.count, Real(0), work, loads,
               [](const Response<V>&) NEVE_INLINE_BODY {});
}

/// Step 9 on the velocities that move particles of AFLIP: neither impulse nor work, they are those
/// of v_p.
template <class Set, class V, class I, class Real>
NEVE_NOINLINE void collide_carriers(const Record<V, I>& p, Vec3<V>& carrier, std::uint64_t key,
                                    const StepConstants<Real>& c, const NearColliders<Real>& near) {
  const Vec3<V> r = places_in_block(p, key, c.h);
  for (int k = 0; k < near.count; ++k) carrier = respond(near.local[k], r, carrier, Real(0)).v;
}

/// push_out moves particles deeper than this back to this depth, cells. Slightly less than the
/// documented tenth, so that rounding does not exceed it.
inline constexpr double depth_left = 0.0999;
/// Out of one collider may be into another: as often as a corner of three needs with room to spare.
inline constexpr int push_rounds = 8;

/// Moves places that are too deep out along the normal, collider after collider.
/// @param deepest  m
/// @return what was moved
template <class Set, class V, class Real>
NEVE_NOINLINE MaskOf<V> push_out(Vec3<V>& r, Real deepest, const LocalCollider<Real>* colliders,
                                 int count) {
  MaskOf<V> moved{};
  for (int round = 0; round < push_rounds; ++round) {
    MaskOf<V> found{};
    for (int k = 0; k < count; ++k) {
      Vec3<V> normal;
      const V missing = -deepest - surface_distance(colliders[k], r, normal);
      const MaskOf<V> is_deep = missing > all<V>(Real(1e-5) * deepest);
      r = r + select(is_deep, normal * missing, Vec3<V>{});
      found = found | is_deep;
    }
    if (!any_lane(found)) break;
    moved = moved | found;
  }
  return moved;
}

/// The block that a stencil starts in and the code of its cell and the particle's model.
template <class I>
struct Location {
  I block[3], local;
};
/// @return the lanes inside the lattice
template <int K, class V, class I>
NEVE_INLINE I locate(const Record<V, I>& p, Location<I>& at) {
  using Real = ElementOf<V>;
  I is_inside = I{} == I{}, cell{};
  for (int a = 0; a < 3; ++a) {
    const I base = stencil_base<K, Real>(p.cell[a], p.offset[a]);
    at.block[a] = base >> 2;
    is_inside = is_inside & (at.block[a] > -block_limit) & (at.block[a] < block_limit);
    cell = cell << 2 | (base & 3);
  }
  at.local = p.model() << 6 | cell;
  return is_inside;
}

/// Step 10: x_p += dt v, in cells and offsets. A particle that would leave the lattice or whose
/// velocity is no number stays where it is and is reported.
template <int K, class V, class I, class Real>
NEVE_INLINE void move(Record<V, I>& p, const Vec3<V>& v, Real dt_over_h, unsigned used,
                      BlockReport<Real>& report, Location<I>& at) {
  const V farthest = all<V>(Real(1 << 20));
  V x[3];
  I is_near = I{} == I{};
  for (int a = 0; a < 3; ++a) {
    x[a] = p.offset[a] + v[a] * dt_over_h;
    is_near = is_near & (absolute_lanes(x[a]) < farthest);
  }
  Record<V, I> moved;
  moved.kind = p.kind;
  for (int a = 0; a < 3; ++a) {
    const V safe = is_near ? x[a] : V{};
    I whole = __builtin_convertvector(safe, I);
    whole += __builtin_convertvector(whole, V) > safe;  // a mask is -1 where true
    V rest = safe - __builtin_convertvector(whole, V);
    const I is_carried = rest >= all<V>(1);  // a tiny negative x rounds up to the next cell
    whole -= is_carried;
    rest = is_carried ? V{} : rest;
    moved.cell[a] = p.cell[a] + whole;
    moved.offset[a] = rest;
  }
  const I is_inside = is_near & locate<K>(moved, at);
  for (int a = 0; a < 3; ++a) {
    p.cell[a] = is_inside ? moved.cell[a] : p.cell[a];
    p.offset[a] = is_inside ? moved.offset[a] : p.offset[a];
  }
  if ((used & ~lane_bits(is_inside)) == 0) return;
  const V sum = x[0] + x[1] + x[2];
  const unsigned numbers = lane_bits(sum - sum == V{});
  report.overflowed +=
      static_cast<std::uint32_t>(__builtin_popcount(used & ~lane_bits(is_inside) & numbers));
  locate<K>(p, at);
}

}  // namespace neve::sim::kernels
