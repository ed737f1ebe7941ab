#pragma once
/// The sweeps of contact at particles; instantiated once per instruction set.

#include "sim/kernels/particle_contact.h"
#include "sim/kernels/sweeps.h"

namespace neve::sim::kernels {

/// A particle inside is brought out by these shares of its depth, per step and per second at most.
inline constexpr double out_per_step = 0.2, out_per_second = 50;
/// The depth that counts for this, in cells.
inline constexpr double max_out = 0.1;
/// x^(1/3) of positive numbers.
template <class V>
NEVE_INLINE V cube_root_lanes(V x) {
  return exponential_lanes(logarithm_lanes(x) * ElementOf<V>(1.0 / 3.0));
}

template <class Real, int K, class Set>
struct ContactSweepsFor {
  using Args = ContactArgs<Real>;
  using Base = SweepsFor<Real, K, TransferKind::flip, Set>;
  using Index = typename Base::Index;
  using V = typename Base::V;
  using I = typename Base::I;
  using R = typename Base::R;
  using Batch = typename Base::Batch;
  static constexpr int W = Base::W;
  using Lanes = ContactRecord<V, I>;

  // ---- particles near surfaces ------------------------------------------------------------------

  /// Colliders that particles of a block can come to touch in a step, and their indices.
  struct Near {
    NearColliders<Real> colliders;
    Integer<Real> index[max_colliders];
  };

  /// Particles may come nearer by twice what they and the collider move in a step.
  NEVE_NOINLINE static void find_near(Near& near, const Args& a, std::uint64_t key) {
    const StepConstants<Real>& c = a.step.constants;
    int cell[3];
    for (int axis = 0; axis < 3; ++axis) cell[axis] = block_coordinate(key, axis) * block_side;
    const Real centre = static_cast<Real>(particle_middle<K>) * c.h;
    const Vec3<Real> middle{centre, centre, centre};
    const Real half = static_cast<Real>(particle_reach) * c.h;
    const Real still = a.max_touching_gap + static_cast<Real>(touching_slack) * c.h;
    int& count = near.colliders.count;
    for (int k = 0; k < c.collider_count; ++k) {
      const LocalCollider<Real> candidate = localize<Real>(c.colliders[k], cell, c.h_double);
      const Vec3<Real> arm = candidate.to_block + middle;
      const Real turning = square_root(dot(candidate.omega, candidate.omega)) *
                           (square_root(dot(arm, arm)) + Real(1.7321) * half);
      const Real speed = square_root(dot(candidate.velocity, candidate.velocity)) + turning +
                         candidate.shape_speed;
      const Real closing = 2 * (speed + a.max_speed) * c.dt;
      if (is_cube_out_of_reach(candidate, middle, half, still + closing)) continue;
      near.index[count] = k;
      near.colliders.local[count++] = candidate;
    }
  }

  /// Distance from a collider at which particles touch it, m.
  NEVE_INLINE static V touching_distance(const Args& a, const Batch& p) {
    V half{};
    for (int l = 0; l < W; ++l) half[l] = a.half_spacing[p.kind[l] & 0xffff];
    return smaller_lanes(half * cube_root_lanes(p.m) * static_cast<Real>(touching_share),
                         all<V>(static_cast<Real>(max_touching) * a.step.constants.h));
  }

  /// The lanes of a batch that may come to touch a collider in this step.
  NEVE_INLINE static unsigned coming(const Args& a, const Batch& p, const Vec3<V>& r,
                                     const LocalCollider<Real>& collider) {
    const Real h = a.step.constants.h;
    Vec3<V> normal;
    const V distance = surface_distance(collider, r, normal);
    const V room = room_before(a, p, distance, normal, surface_velocity(collider, r));
    // Most are further away than any particle touches.
    if (!any_lane(room <= all<V>(static_cast<Real>(max_touching) * h))) return 0;
    return lane_bits(room <= touching_distance(a, p));
  }
  /// Distance that is left after a step in which particles come nearer by twice what they fly.
  NEVE_INLINE static V room_before(const Args& a, const Batch& p, const V& distance,
                                   const Vec3<V>& normal, const Vec3<V>& surface) {
    const StepConstants<Real>& c = a.step.constants;
    const Vec3<V> v{p.v[0], p.v[1], p.v[2]};
    const V closing = larger_lanes(-dot(v - surface, normal), V{});
    return distance - closing * (2 * c.dt) - static_cast<Real>(touching_slack) * c.h;
  }

  static void find(const Args& a, Index begin, Index end) {
    const StepConstants<Real>& c = a.step.constants;
    for (Index b = begin; b < end; ++b) {
      const ParticleBlock& block = a.step.blocks[b];
      Index found = 0, pairs = 0;
      Near near;
      find_near(near, a, block.key);
      const int colliders = near.colliders.count;
      if (colliders > 0)
        Base::template each_group<gather_group>(a.step, block, [&](const auto& group) {
          for (int q = 0; q < group.count; q += W) {
            Batch p;
            RecordReader<V, I> read(group.record + q, p);
            read.place();
            read.motion();
            const unsigned used = group.used(q);
            unsigned any = 0;
            const Vec3<V> r = places_in_block(p, block.key, c.h);
            for (int k = 0; k < colliders; ++k) {
              const unsigned bits = coming(a, p, r, near.colliders.local[k]) & used;
              pairs += static_cast<Index>(__builtin_popcount(bits));
              any |= bits;
            }
            for (; any != 0; any &= any - 1)
              a.candidates[block.begin + found++] =
                  static_cast<Index>(group.storage - a.step.order) +
                  static_cast<Index>(q + __builtin_ctz(any));
          }
        });
      a.near_counts[b] = found;
      a.counts[b] = pairs;
    }
  }

  // ---- contacts ---------------------------------------------------------------------------------

  /// The candidates [q, q + W) of a block; lanes without one repeat the last.
  /// @return the share of their own velocity that they move with
  NEVE_INLINE static V load_candidates(const Args& a, const ParticleBlock& block, Index q,
                                       Index count, Batch& p, Index* storage) {
    const Particle<Real>* record[W];
    for (int l = 0; l < W; ++l) {
      const Index at = smaller<Index>(q + static_cast<Index>(l), count - 1);
      storage[l] = a.step.order[a.candidates[block.begin + at]];
      record[l] = a.step.particles + storage[l];
    }
    RecordReader<V, I> read(record, p);
    read.place();
    read.motion();
    const StepConstants<Real>& c = a.step.constants;
    if (c.beta_min == c.beta_max && c.whole_laws == 0) return all<V>(c.beta_max * c.alpha);
    read.deformation();
    read.volume();
    return separation_share(p, c) * c.alpha;
  }

  template <int G>
  NEVE_INLINE static FourWords<V> gathered(const Stencils<Real, K, G>& s, const Quad<Real>* tile) {
    Quad<Real> sums[W];
    for (int l = 0; l < W; ++l) sums[l] = gather_value<Set>(s, l, tile);
    return load_quads<V>(sums);
  }

  /// tile += w value of the first `count` lanes.
  template <int G>
  NEVE_INLINE static void scatter(const Stencils<Real, K, G>& s, const FourWords<V>& value,
                                  int count, Quad<Real>* tile) {
    Quad<Real> of[W];
    store_quads(value, of);
    R along[W];
    for (int l = 0; l < count; ++l) along[l] = R::repeat(of[l]) * R::spread(s.z[l]);
    each_cell(s, count, [&](int first, int last) {
      scatter_value<Real, K, G, Set>(s, along, first, last, tile);
    });
  }

  static void start(const Args& a, Index begin, Index end) {
    const StepConstants<Real>& c = a.step.constants;
    const bool keeps = c.alpha > Real(0) && (c.beta_min > Real(0) || c.beta_max > Real(0));
    Quad<Real> v_free[Tile<K>::nodes], change[Tile<K>::nodes];
    Stencils<Real, K, W> s;
    for (Index n = begin; n < end; ++n) {
      const Index b = a.blocks[n];
      const ParticleBlock& block = a.step.blocks[b];
      load_tile<Real, K, Set>(
          block, [&](Index m) { return nodes_of(a.step, m, channel_v_new); }, v_free);
      if (keeps)
        load_tile<Real, K, Set>(
            block, [&](Index m) { return nodes_of(a.step, m, channel_change); }, change);
      Quad<Real>* tile = tile_of<Real, K>(a.step, b, 0);
      Base::clear(block, tile);
      Near near;
      find_near(near, a, block.key);
      Contact<Real>* to = a.contacts + a.first[b];
      const Index count = a.near_counts[b];
      for (Index q = 0; q < count; q += W) {
        Batch p;
        Index storage[W];
        const V kept = load_candidates(a, block, q, count, p, storage);
        s.template set<false, false>(0, p.offset, p.cell);
        const FourWords<V> on_grid = gathered(s, v_free);
        Velocities v{{on_grid.w[0], on_grid.w[1], on_grid.w[2]}, {}, {}, kept};
        if (keeps) {
          const FourWords<V> changed = gathered(s, change);
          for (int x = 0; x < 3; ++x) v.own[x] = p.v[x] - (on_grid.w[x] - changed.w[x]);
        }
        v.came = v.own;
        FourWords<V> given{};  // impulses to begin with, and 1 per contact
        const I is_used = first_lanes<I>(static_cast<int>(count - q));
        Contact<Real>* const first = to;
        for (int k = 0; k < near.colliders.count; ++k)
          add_contacts(a, p, storage, block.key, v, is_used, near.colliders.local[k], near.index[k],
                       to, given);
        if (any_lane(given.w[3] > all<V>(1))) give_own(v, storage, first, to);
        scatter(s, given, static_cast<int>(smaller<Index>(W, count - q)), tile);
      }
      a.counts[b] = static_cast<Index>(to - (a.contacts + a.first[b]));
    }
  }

  struct Velocities {
    Vec3<V> of_grid, own;
    Vec3<V> came;  ///< own, before colliders took of it
    V kept;        ///< share of its own that the particle moves with beside that of the grid
  };

  /// A particle at several surfaces moves with one velocity: its contacts get what all of them
  /// left.
  /// @param first, end  contacts of the particles `storage`
  NEVE_NOINLINE static void give_own(const Velocities& v, const Index* storage,
                                     Contact<Real>* first, const Contact<Real>* end) {
    const Vec3<V> own = v.own * v.kept;
    for (; first != end; ++first) {
      int l = 0;
      while (storage[l] != static_cast<Index>(first->particle)) ++l;
      for (int x = 0; x < 3; ++x) first->own[x] = own[x][l];
    }
  }

  /// The contact with a collider that particles remember.
  struct Memory {
    V impulse{}, touches;
    Vec3<V> sliding{};
  };
  /// @param touches  where particles touch that remember nothing
  /// @param holds  the collider holds on to what it touches, also where it was seeded beyond that
  NEVE_INLINE static Memory recall(const Args& a, const Index* storage, int list, bool holds,
                                   const V& touches) {
    Memory memory;
    memory.touches = touches;
    if (a.kept_count == 0) return memory;
    for (int l = 0; l < W; ++l) {
      Index at = a.head[storage[l]];
      if (!is_contact_of(a.kept, a.kept_count, at, storage[l])) continue;
      for (; at != no_contact; at = a.kept[at].next) {
        const KeptContact<Real>& k = a.kept[at];
        if (k.collider != list) continue;
        memory.impulse[l] = k.impulse * a.carried;
        memory.touches[l] = holds ? k.touches : smaller(k.touches, touches[l]);
        for (int x = 0; x < 3; ++x) memory.sliding[x][l] = k.sliding[x] * a.carried;
        break;
      }
    }
    return memory;
  }

  /// The least speed from the surface that contact leaves a particle, m/s.
  /// @param touches  distance at which it touches
  NEVE_INLINE static V speed_away(const Args& a, bool lets_go, const V& distance,
                                  const V& touches) {
    const StepConstants<Real>& c = a.step.constants;
    const V gap = distance - touches;
    const Real out = smaller(static_cast<Real>(out_per_step) / c.dt, Real(out_per_second));
    // A deeper particle was put there, and is let out as slowly as one that is a little inside.
    const V depth = smaller_lanes(-distance, all<V>(static_cast<Real>(max_out) * c.h));
    const V apart = (depth + touches) * a.apart;
    // A surface that does not let go stops what is inside where it is: there is no way out.
    const V inside = lets_go ? larger_lanes(depth * out, apart) : V{};
    return gap > V{} ? -gap / c.dt : distance > V{} ? apart : inside;
  }

  /// Returns what a surface that lets go takes of a particle's own velocity: as much of its way in
  /// as brings it past what it may not, and the friction of that. The grid must not stop it, which
  /// throws its neighbours back: n of them at rest would fly as fast as it came, with n times its
  /// energy.
  NEVE_INLINE static Vec3<V> lost_at_impact(const Velocities& v, const Vec3<V>& n,
                                            const Vec3<V>& surface, const V& least,
                                            const V& friction) {
    const Vec3<V> u = v.of_grid + v.own * v.kept - surface;
    const V own = dot(v.own, n) * v.kept, u_n = dot(u, n);
    const V impact = smaller_lanes(larger_lanes(-own, V{}), larger_lanes(least - u_n, V{}));
    const Vec3<V> along = u - n * u_n;
    const V speed = square_root_lanes(dot(along, along)), most = friction * impact;
    const V share = speed > most ? most / speed : all<V>(1);
    const I keeps = v.kept > V{};
    const V inverse = all<V>(1) / (keeps ? v.kept : all<V>(1));
    return select(keeps & (impact > V{}), (along * share - n * impact) * inverse, Vec3<V>{});
  }

  /// Finds the particles of a batch that would come nearer to a collider than they may, and those
  /// that it pressed or held in the last step.
  /// @param v  loses what the collider takes: the next one finds the rest
  /// @param given  gets what they begin with, and 1 in their lanes
  NEVE_INLINE static void add_contacts(const Args& a, const Batch& p, const Index* storage,
                                       std::uint64_t key, Velocities& v, const I& is_used,
                                       const LocalCollider<Real>& collider, Integer<Real> index,
                                       Contact<Real>*& to, FourWords<V>& given) {
    const StepConstants<Real>& c = a.step.constants;
    const Vec3<V> r = places_in_block(p, key, c.h);
    Vec3<V> normal;
    const V distance = surface_distance(collider, r, normal);
    const V touching = touching_distance(a, p);
    const int list = a.poses[index].index;
    const bool lets_go = collider.contact == ContactLaw::separate;
    const Memory memory = recall(a, storage, list, !lets_go, touching);
    const V gap = distance - memory.touches;
    const Vec3<V> surface = surface_velocity(collider, r);
    const V least = speed_away(a, lets_go, distance, memory.touches);
    const Vec3<V> lost =
        collider.contact == ContactLaw::sticky ? v.own
        : lets_go ? lost_at_impact(v, normal, surface, least, all<V>(friction_of(collider)))
                  : normal * dot(v.own, normal);
    const Vec3<V> own = (v.own - lost) * v.kept;
    // A particle that is stopped by its own velocity alone has a contact, too.
    const V v_n = dot(v.of_grid + (lets_go ? v.came * v.kept : own) - surface, normal);
    const I is_seeded = memory.touches != touching;
    const I is_near = gap <= all<V>(static_cast<Real>(touching_slack) * c.h);
    // Elasticity may yet bring to it what is near, in the solve.
    const I is_likely = is_seeded | (memory.impulse > V{}) | all<I>(a.is_before_solve ? -1 : 0);
    // There is a place for those that were found to come near, whatever forces do to the others.
    const I is_coming = room_before(a, p, distance, normal, surface) <= touching;
    I is_contact = is_used & is_coming & ((v_n < least) | (is_near & is_likely));
    I number = all<I>(index);
    if (!lets_go) {
      is_contact = is_contact | (is_used & is_coming & is_near);
      number = is_near ? -1 - number : number;
    }
    const unsigned bits = lane_bits(is_contact);
    if (bits == 0) return;
    Lanes contact{};
    for (int x = 0; x < 3; ++x) {
      contact.offset[x] = p.offset[x];
      contact.cell[x] = p.cell[x];
      contact.normal[x] = normal[x];
      contact.surface[x] = surface[x];
      contact.own[x] = own[x];
      contact.lost[x] = lost[x];
      for (int l = 0; l < W; ++l) contact.particle[l] = static_cast<Integer<Real>>(storage[l]);
    }
    contact.least = least;
    contact.friction = all<V>(friction_of(collider));
    contact.collider = number;
    contact.touches = memory.touches;
    contact.is_seeded = is_seeded ? all<V>(1) : V{};
    contact.list = all<I>(list);
    contact.mass = p.m;
    begin_with(memory, contact);
    if (a.is_before_solve) guess(a, p, contact);
    store(contact, bits, to);
    for (int x = 0; x < 3; ++x) {
      v.own[x] = is_contact ? v.own[x] - lost[x] : v.own[x];
      const V impulse = contact.normal[x] * contact.impulse + contact.sliding[x];
      given.w[x] += is_contact ? impulse : V{};
    }
    given.w[3] += is_contact ? all<V>(1) : V{};
  }

  /// The impulse of the last step as this one lets it be: the normal may have turned.
  NEVE_INLINE static void begin_with(const Memory& memory, Lanes& c) {
    const Vec3<V> n{c.normal[0], c.normal[1], c.normal[2]};
    const I is_held = c.collider < I{};
    c.impulse = is_held ? memory.impulse : larger_lanes(memory.impulse, V{});
    const Vec3<V> sliding = within_friction(memory.sliding - n * dot(memory.sliding, n), c);
    for (int x = 0; x < 3; ++x) c.sliding[x] = sliding[x];
  }

  /// Chooses contacts that act in the first solution: those of the last step, and of the others
  /// those that would stop the particle as it flies. The effect of a stiff force on it in the step
  /// is beside the point: the solve does not let it.
  NEVE_INLINE static void guess(const Args& a, const Batch& p, Lanes& c) {
    const Vec3<V> n{c.normal[0], c.normal[1], c.normal[2]};
    Vec3<V> v;
    for (int x = 0; x < 3; ++x)
      v[x] = p.v[x] + all<V>(a.step.constants.gravity[x] * a.step.constants.dt) - c.surface[x];
    const V v_n = dot(v, n);
    const I is_held = c.collider < I{}, was_there = c.impulse != V{};
    const I goes = v_n > larger_lanes(c.least, V{});
    const I acts = was_there | (v_n < c.least) | (is_held & goes);
    const Vec3<V> along = v - n * v_n;
    const V speed = square_root_lanes(dot(along, along));
    const Vec3<V> sliding{c.sliding[0], c.sliding[1], c.sliding[2]};
    const I stuck = square_root_lanes(dot(sliding, sliding)) < friction_bound(c);
    const I stops = speed <= c.friction * (c.least - v_n);
    const I sticks = (c.friction > V{}) & (is_held | (was_there ? stuck : acts & stops));
    c.holds = (acts ? all<V>(holds_normal) : V{}) + (sticks ? all<V>(holds_surface) : V{});
  }

  /// An impulse along the surface, no larger than friction.
  NEVE_INLINE static Vec3<V> within_friction(const Vec3<V>& sliding, const Lanes& c) {
    const V size = square_root_lanes(dot(sliding, sliding)), most = friction_bound(c);
    return select(size > most, sliding * (most / size), sliding);
  }

  NEVE_INLINE static Real friction_of(const LocalCollider<Real>& collider) {
    constexpr Real without_bound = sizeof(Real) == 4 ? Real(1e30) : Real(1e300);
    switch (collider.contact) {
      case ContactLaw::sticky:
        return without_bound;
      case ContactLaw::slip:
        return 0;
      default:
        return collider.friction;
    }
  }

  /// Appends the lanes of some bits.
  NEVE_INLINE static void store(const Lanes& contact, unsigned bits, Contact<Real>*& to) {
    Contact<Real> each[W];
    Contact<Real>* records[W];
    for (int l = 0; l < W; ++l) records[l] = each + l;
    write(contact, records, W);
    for (; bits != 0; bits &= bits - 1) *to++ = each[__builtin_ctz(bits)];
  }

  NEVE_INLINE static void write(const Lanes& c, Contact<Real>* const* records, int count) {
    const auto put = [&](int quad, V x, V y, V z, V w) NEVE_INLINE_BODY {
      store_words(FourWords<V>{{x, y, z, w}}, records, 4 * quad * static_cast<int>(sizeof(Real)),
                  count);
    };
    put(0, c.offset[0], c.offset[1], c.offset[2], c.least);
    put(1, c.normal[0], c.normal[1], c.normal[2], c.impulse);
    put(2, c.surface[0], c.surface[1], c.surface[2], c.friction);
    put(3, c.sliding[0], c.sliding[1], c.sliding[2], c.row);
    put(4, c.own[0], c.own[1], c.own[2], c.holds);
    put(5, reinterpret_cast<V>(c.cell[0]), reinterpret_cast<V>(c.cell[1]),
        reinterpret_cast<V>(c.cell[2]), reinterpret_cast<V>(c.collider));
    put(6, c.touches, c.is_seeded, reinterpret_cast<V>(c.particle), reinterpret_cast<V>(c.list));
    put(7, c.lost[0], c.lost[1], c.lost[2], c.mass);
    put(8, c.give, c.give_along, V{}, V{});
  }

  NEVE_INLINE static void read(Lanes& c, Contact<Real>* const* records) {
    const auto get = [&](int quad) NEVE_INLINE_BODY {
      return load_words<V>(records, 4 * quad * static_cast<int>(sizeof(Real)));
    };
    const FourWords<V> q[contact_quads] = {get(0), get(1), get(2), get(3), get(4),
                                           get(5), get(6), get(7), get(8)};
    for (int x = 0; x < 3; ++x) {
      c.offset[x] = q[0].w[x];
      c.normal[x] = q[1].w[x];
      c.surface[x] = q[2].w[x];
      c.sliding[x] = q[3].w[x];
      c.own[x] = q[4].w[x];
      c.cell[x] = reinterpret_cast<I>(q[5].w[x]);
    }
    c.least = q[0].w[3];
    c.impulse = q[1].w[3];
    c.friction = q[2].w[3];
    c.row = q[3].w[3];
    c.holds = q[4].w[3];
    c.collider = reinterpret_cast<I>(q[5].w[3]);
    c.touches = q[6].w[0];
    c.is_seeded = q[6].w[1];
    c.particle = reinterpret_cast<I>(q[6].w[2]);
    c.list = reinterpret_cast<I>(q[6].w[3]);
    for (int x = 0; x < 3; ++x) c.lost[x] = q[7].w[x];
    c.mass = q[7].w[3];
    c.give = q[8].w[0];
    c.give_along = q[8].w[1];
  }

  // ---- passes -----------------------------------------------------------------------------------

  /// Contacts of a block that are worked on together.
  struct Group {
    Lanes contact;
    Contact<Real>* record[W];
    int used;
    Stencils<Real, K, W> s;
  };

  /// body(group) for the contacts of a block.
  template <class Body>
  NEVE_INLINE static void each_group(const Args& a, Index b, const Body& body) {
    Group group;
    Contact<Real>* first = a.contacts + a.first[b];
    const Index count = a.counts[b];
    for (Index q = 0; q < count; q += W) {
      for (int l = 0; l < W; ++l)
        group.record[l] = first + smaller<Index>(q + static_cast<Index>(l), count - 1);
      group.used = static_cast<int>(smaller<Index>(W, count - q));
      read(group.contact, group.record);
      group.s.template set<false, false>(0, group.contact.offset, group.contact.cell);
      body(group);
    }
  }

  static void press(const Args& a, Index begin, Index end) {
    const bool is_final = a.is_last && !a.is_before_solve;
    Quad<Real> v[Tile<K>::nodes];
    for (Index n = begin; n < end; ++n) {
      const Index b = a.blocks[n];
      load_v(a, b, v);
      Quad<Real>* tile = tile_of<Real, K>(a.step, b, 0);
      Base::clear(a.step.blocks[b], tile);
      Account account(a);
      Keeper keeper(a, b);
      each_group(a, b, [&](Group& group) NEVE_INLINE_BODY {
        const FourWords<V> v_and_row = gathered(group.s, v);
        const Vec3<V> change =
            a.only_closes ? close(v_and_row, group.contact) : respond_to(v_and_row, group.contact);
        write(group.contact, group.record, group.used);
        scatter(group.s, FourWords<V>{{change.x, change.y, change.z, V{}}}, group.used, tile);
        if (!is_final) return;
        account.add(group.contact, group.used);
        keeper.add(group.contact, group.used);
      });
      if (!is_final) continue;
      account.give(b);
      keeper.end();
    }
  }

  NEVE_INLINE static void load_v(const Args& a, Index b, Quad<Real>* v) {
    load_tile<Real, K, Set>(
        a.step.blocks[b], [&](Index m) { return a.nodes[m].velocity; }, v);
  }

  /// Velocity of particles relative to the surface. @param on_grid  their part of the grid's
  NEVE_INLINE static Vec3<V> relative(const FourWords<V>& on_grid, const Lanes& c) {
    Vec3<V> v;
    for (int x = 0; x < 3; ++x) v[x] = on_grid.w[x] + c.own[x] - c.surface[x];
    return v;
  }

  /// A pass for a batch. @return how much its impulses changed
  NEVE_INLINE static Vec3<V> respond_to(const FourWords<V>& v_and_row, Lanes& c) {
    c.row = v_and_row.w[3];
    const Vec3<V> n{c.normal[0], c.normal[1], c.normal[2]};
    const Vec3<V> v_rel = relative(v_and_row, c);
    const V v_n = dot(v_rel, n), inverse = all<V>(1) / (c.row + c.give);
    // Nearer it may come, away it may not.
    const V push = c.impulse + (c.least - v_n) * inverse;
    const V pull = c.impulse + (larger_lanes(c.least, V{}) - v_n) * inverse;
    const Vec3<V> before{c.sliding[0], c.sliding[1], c.sliding[2]};
    const Vec3<V> sliding = before - (v_rel - n * v_n) * (all<V>(1) / (c.row + c.give_along));
    return project(push, pull, sliding, c);
  }

  /// A pass after the solve: impulses of particles that still come too near only. Bodies, which the
  /// solve does not know, get a whole one.
  NEVE_INLINE static Vec3<V> close(const FourWords<V>& v_and_row, Lanes& c) {
    const Vec3<V> n{c.normal[0], c.normal[1], c.normal[2]};
    const V more = larger_lanes((c.least - dot(relative(v_and_row, c), n)) / c.row, V{});
    const I is_body = c.give > V{};
    if (!any_lane(is_body)) {
      c.impulse += more;
      return n * more;
    }
    Lanes whole = c;
    const Vec3<V> answer = respond_to(v_and_row, whole);
    c.impulse = is_body ? whole.impulse : c.impulse + more;
    c.holds = is_body ? whole.holds : c.holds;
    for (int x = 0; x < 3; ++x) c.sliding[x] = is_body ? whole.sliding[x] : c.sliding[x];
    return select(is_body, answer, n * more);
  }

  /// The impulses become the nearest that contact can have, and `holds` says how. A contact that
  /// holds on to the particle pulls where it need not push.
  /// @param push, pull  impulse along the normal
  /// @return how much it changed
  NEVE_INLINE static Vec3<V> project(const V& push, const V& pull, const Vec3<V>& sliding,
                                     Lanes& c) {
    const Vec3<V> n{c.normal[0], c.normal[1], c.normal[2]};
    const V before = c.impulse;
    const I is_held = c.collider < I{};
    c.impulse = (is_held & (push <= V{})) ? smaller_lanes(pull, V{}) : larger_lanes(push, V{});
    const V size = square_root_lanes(dot(sliding, sliding)), most = friction_bound(c);
    const Vec3<V> bounded = select(size > most, sliding * (most / size), sliding);
    const I sticks = (is_held | (c.impulse > V{})) & (c.friction > V{}) & (size <= most);
    c.holds =
        (c.impulse != V{} ? all<V>(holds_normal) : V{}) + (sticks ? all<V>(holds_surface) : V{});
    Vec3<V> change = n * (c.impulse - before);
    for (int x = 0; x < 3; ++x) {
      change[x] += bounded[x] - c.sliding[x];
      c.sliding[x] = bounded[x];
    }
    return change;
  }

  /// Largest impulse along the surface.
  NEVE_INLINE static V friction_bound(const Lanes& c) {
    return c.collider < I{} ? c.friction : c.friction * c.impulse;
  }

  // ---- in the semi-implicit solve ---------------------------------------------------------------

  static void hold(const Args& a, Index begin, Index end) {
    const Real stiffness = a.hold / a.beta_dt_squared;
    Quad<Real> u[Tile<K>::nodes];
    for (Index n = begin; n < end; ++n) {
      const Index b = a.blocks[n];
      load_u(a, b, u);
      each_group(a, b, [&](Group& group) NEVE_INLINE_BODY {
        const Vec3<V> force =
            spring_of(a, gathered(group.s, u), group.contact, a.is_first) * all<V>(stiffness);
        scatter(group.s, FourWords<V>{{force.x, force.y, force.z, V{}}}, group.used,
                tile_of<Real, K>(a.step, b, 0));
      });
    }
  }

  static void rows(const Args& a, Index begin, Index end) {
    Quad<Real> v[Tile<K>::nodes];
    for (Index n = begin; n < end; ++n) {
      const Index b = a.blocks[n];
      load_v(a, b, v);
      each_group(a, b, [&](Group& group) NEVE_INLINE_BODY {
        Lanes& c = group.contact;
        c.row = gathered(group.s, v).w[3];
        write(c, group.record, group.used);
      });
    }
  }

  static void measure(const Args& a, Index begin, Index end) {
    Quad<Real> u[Tile<K>::nodes];
    for (Index n = begin; n < end; ++n) {
      const Index b = a.blocks[n];
      load_u(a, b, u);
      double sums[contact_sums] = {};
      each_group(a, b, [&](Group& group) NEVE_INLINE_BODY {
        Lanes& c = group.contact;
        const FourWords<V> on_grid = gathered(group.s, u);
        const Vec3<V> spring = spring_of(a, on_grid, c, true) * all<V>(-a.hold);
        feel(c, spring);
        // The change that a pass would still make, by its mass.
        FourWords<V> v_and_row = on_grid;
        v_and_row.w[3] = c.row;
        const Vec3<V> missing = respond_to(v_and_row, c);
        const V energy = dot(missing, missing) * c.row;
        for (int l = 0; l < group.used; ++l) {
          sums[0] += static_cast<double>(energy[l]);
          for (int x = 0; x < 3; ++x) sums[1 + x] += static_cast<double>(spring[x][l]);
        }
      });
      for (int k = 0; k < contact_sums; ++k) a.sums[contact_sums * n + k] = sums[k];
    }
  }

  /// The impulses of the springs are added.
  NEVE_INLINE static void feel(Lanes& c, const Vec3<V>& spring) {
    const Vec3<V> n{c.normal[0], c.normal[1], c.normal[2]};
    const V along = dot(spring, n);
    c.impulse += along;
    for (int x = 0; x < 3; ++x) c.sliding[x] += spring[x] - n[x] * along;
  }

  static void renew(const Args& a, Index begin, Index end) {
    Quad<Real> u[Tile<K>::nodes];
    for (Index n = begin; n < end; ++n) {
      const Index b = a.blocks[n];
      load_u(a, b, u);
      Quad<Real>* tile = tile_of<Real, K>(a.step, b, 0);
      Base::clear(a.step.blocks[b], tile);
      each_group(a, b, [&](Group& group) NEVE_INLINE_BODY {
        Lanes& c = group.contact;
        const Lanes before = c;
        FourWords<V> v_and_row = gathered(group.s, u);
        v_and_row.w[3] = c.row;
        feel(c, spring_of(a, v_and_row, c, true) * all<V>(-a.hold));
        respond_to(v_and_row, c);
        write(c, group.record, group.used);
        FourWords<V> change{};
        for (int x = 0; x < 3; ++x)
          change.w[x] =
              c.normal[x] * (c.impulse - before.impulse) + c.sliding[x] - before.sliding[x];
        scatter(group.s, change, group.used, tile);
      });
    }
  }

  static void settle(const Args& a, Index begin, Index end) {
    Quad<Real> u[Tile<K>::nodes];
    for (Index n = begin; n < end; ++n) {
      const Index b = a.blocks[n];
      load_u(a, b, u);
      each_group(a, b, [&](Group& group) NEVE_INLINE_BODY {
        Lanes& c = group.contact;
        feel(c, spring_of(a, gathered(group.s, u), c, true) * all<V>(-a.hold));
        write(c, group.record, group.used);
      });
    }
  }

  static void book(const Args& a, Index begin, Index end) {
    for (Index n = begin; n < end; ++n) {
      const Index b = a.blocks[n];
      Account account(a);
      Keeper keeper(a, b);
      each_group(a, b, [&](Group& group) NEVE_INLINE_BODY {
        keeper.add(group.contact, group.used);
        account.add(group.contact, group.used);
      });
      account.give(b);
      keeper.end();
    }
  }

  NEVE_INLINE static void load_u(const Args& a, Index b, Quad<Real>* u) {
    load_tile<Real, K, Set>(
        a.step.blocks[b], [&](Index m) { return a.u + m * a.u_stride; }, u);
  }

  /// The part of u that each contact holds, over D. A contact that pulls wants the particle no
  /// further away. A body is a mass behind its springs: they give way as it does.
  NEVE_INLINE static Vec3<V> spring_of(const Args& a, const FourWords<V>& on_grid, const Lanes& c,
                                       bool is_first) {
    const Vec3<V> n{c.normal[0], c.normal[1], c.normal[2]};
    const Vec3<V> u =
        is_first ? relative(on_grid, c) : Vec3<V>{on_grid.w[0], on_grid.w[1], on_grid.w[2]};
    const V closest = c.impulse < V{} ? larger_lanes(c.least, V{}) : c.least;
    const V u_n = dot(u, n), wanted = is_first ? closest : V{};
    const V inverse = all<V>(1) / (c.row + c.give * a.hold);
    const I holds_n = (c.holds == all<V>(holds_normal)) | (c.holds > all<V>(holds_surface));
    const V normal = holds_n ? (u_n - wanted) * inverse : V{};
    const V surface =
        c.holds >= all<V>(holds_surface) ? all<V>(1) / (c.row + c.give_along * a.hold) : V{};
    return n * normal + (u - n * u_n) * surface;
  }

  /// Loads and work of the contacts of a block.
  class Account {
   public:
    NEVE_INLINE explicit Account(const Args& a) : a_(a), loads_(a.step.load_count) {}

    /// The first `count` lanes.
    NEVE_INLINE void add(const Lanes& c, int count) {
      work_ += work_of(c, count);
      add_loads(c, count);
    }

    NEVE_INLINE void give(Index b) const {
      a_.step.node_contact_work[a_.step.blocks[b].node_block[0]] += work_;
      loads_.give(a_.step.loads, a_.step.load_unit);
    }

   private:
    /// Adds loads, and takes from particles the own velocity that contact takes.
    NEVE_NOINLINE void add_loads(const Lanes& c, int count) {
      for (int l = 0; l < count; ++l) {
        const auto number = c.collider[l] < 0 ? -1 - c.collider[l] : c.collider[l];
        const ColliderPose& pose = a_.poses[number];
        Particle<Real>& particle = a_.step.particles[c.particle[l]];
        const Real lost = c.mass[l] * a_.step.constants.alpha;
        double impulse[3], arm[3];
        for (int x = 0; x < 3; ++x) {
          particle.v[x] -= c.lost[x][l];
          const Real of_contact = c.normal[x][l] * c.impulse[l] + c.sliding[x][l];
          const Real of_solve = a_.per_impulse[x] * absolute(c.impulse[l]) + a_.per_contact[x];
          impulse[x] = static_cast<double>(of_contact + of_solve - lost * c.lost[x][l]);
          arm[x] = (static_cast<double>(c.cell[x][l] - pose.cell[x]) +
                    (static_cast<double>(c.offset[x][l]) - pose.offset[x])) *
                   a_.step.constants.h_double;
        }
        loads_.add(pose.index, impulse, arm);
      }
    }

    /// Returns the work of the colliders, J.
    NEVE_INLINE double work_of(const Lanes& c, int count) const {
      V done = c.impulse * larger_lanes(c.least, V{});
      const V lost = c.mass * a_.step.constants.alpha;
      for (int x = 0; x < 3; ++x)
        done += (c.normal[x] * c.impulse + c.sliding[x] - lost * c.lost[x]) * c.surface[x];
      double work = 0;
      for (int l = 0; l < count; ++l) work += static_cast<double>(done[l]);
      return work;
    }

    const Args& a_;
    BlockLoads<Set> loads_;
    double work_ = 0;
  };

  /// Remembers the contacts of a block until the next step.
  class Keeper {
   public:
    NEVE_INLINE Keeper(const Args& a, Index b)
        : a_(a), begin_(a.first_to_keep[b]), end_(begin_), limit_(begin_ + a.counts[b]) {}

    /// The first `count` lanes.
    NEVE_INLINE void add(const Lanes& c, int count) {
      V pressed = absolute_lanes(c.impulse) + c.is_seeded;
      for (int x = 0; x < 3; ++x) pressed += absolute_lanes(c.sliding[x]);
      for (int l = 0; l < count; ++l)
        if (pressed[l] > Real(0)) add_lane(c, l);
    }

    /// Places that are left must not name particles.
    NEVE_INLINE void end() const {
      for (Index at = end_; at < limit_; ++at) a_.keep[at].particle = no_contact;
    }

   private:
    NEVE_INLINE void add_lane(const Lanes& c, int l) {
      const auto particle = static_cast<Index>(c.particle[l]);
      Index& head = a_.head[particle];
      const bool has_more = head >= begin_ && is_contact_of(a_.keep, end_, head, particle);
      a_.keep[end_] = {c.impulse[l],
                       {c.sliding[0][l], c.sliding[1][l], c.sliding[2][l]},
                       c.touches[l],
                       particle,
                       static_cast<std::int32_t>(c.list[l]),
                       has_more ? head : no_contact};
      head = end_++;
    }

    const Args& a_;
    const Index begin_;
    Index end_;
    const Index limit_;
  };

  // ---- nodes ------------------------------------------------------------------------------------

  /// The tiles of blocks in contact that reach a node block.
  /// @return as collect
  NEVE_INLINE static unsigned collect_pressed(const Args& a, Index block, Quad<Real>* sum) {
    return collect<Real, K, Set>(a.step, block, 0, sum, [&](std::int32_t source) NEVE_INLINE_BODY {
      return a.counts[source] != 0;
    });
  }

  /// sum over the mass of each node, 0 where there is none.
  NEVE_INLINE static R over_mass(const R& sum, const R& with_mass) {
    R out;
    unrolled<R::parts>([&](auto p) NEVE_INLINE_BODY {
      const typename R::V mass = fourth_of_quads(with_mass.part[p], Counted<R::width>{});
      const auto has_mass = mass > typename R::V{};
      out.part[p] =
          has_mass ? sum.part[p] / (has_mass ? mass : all<typename R::V>(1)) : typename R::V{};
    });
    return out;
  }
  /// The fourth numbers of the second row beside the others of the first.
  NEVE_INLINE static R with_fourths(const R& row, const R& fourths) {
    MaskOf<typename R::V> is_fourth{};
    for (int l = 3; l < R::width; l += 4) is_fourth[l] = -1;
    R out;
    unrolled<R::parts>(
        [&](auto p) NEVE_INLINE_BODY { out.part[p] = is_fourth ? fourths.part[p] : row.part[p]; });
    return out;
  }

  static void weigh(const Args& a, Index begin, Index end) {
    Quad<Real> sum[block_nodes];
    for (Index k = begin; k < end; ++k) {
      const Index b = a.node_blocks[k];
      const unsigned rows = collect_pressed(a, b, sum);
      const Quad<Real>* v_free = nodes_of(a.step, b, channel_v_new);
      Quad<Real>* v = a.nodes[b].velocity;
      for (int n = 0; n < block_nodes; n += block_side) {
        const R free = R::load(v_free + n);
        const bool is_pressed = (rows >> (n / block_side) & 1) != 0;
        const R given = is_pressed ? over_mass(R::load(sum + n), free) : R::zero();
        with_fourths(free + given, given).store(v + n);
        if (a.is_before_solve) with_fourths(free + given, free).store(sum + n);
      }
      if (a.is_before_solve) set_velocities<Set>(a.step, b, sum);
    }
  }

  static void take(const Args& a, Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      const Index b = a.node_blocks[k];
      const Quad<Real>* v_new = nodes_of(a.step, b, channel_v_new);
      Quad<Real>* v = a.nodes[b].velocity;
      for (int n = 0; n < block_nodes; n += block_side)
        with_fourths(R::load(v_new + n), R::load(v + n)).store(v + n);
    }
  }

  static void yield(const Args& a, Index begin, Index end) {
    Quad<Real> sum[block_nodes];
    for (Index k = begin; k < end; ++k) {
      const Index b = a.node_blocks[k];
      const unsigned rows = collect_pressed(a, b, sum);
      const Quad<Real>* v_new = nodes_of(a.step, b, channel_v_new);
      Quad<Real>* v = a.nodes[b].velocity;
      for (int n = 0; n < block_nodes; n += block_side) {
        const R with_mass = R::load(v_new + n);
        const bool is_pressed = (rows >> (n / block_side) & 1) != 0;
        // The fourth of sum is 0.
        const R row =
            R::load(v + n) + (is_pressed ? over_mass(R::load(sum + n), with_mass) : R::zero());
        row.store(v + n);
        if (a.is_last) with_fourths(row, with_mass).store(sum + n);
      }
      if (a.is_last) set_velocities<Set>(a.step, b, sum);
    }
  }

  static constexpr ContactSweeps<Real> table{find, start,   weigh, press,  yield, rows,
                                             hold, measure, renew, settle, take,  book};
};

template <class Real, class Set>
const ContactSweeps<Real>& choose_contact_sweeps(int nodes) {
  if (nodes == cubic_nodes) return ContactSweepsFor<Real, cubic_nodes, Set>::table;
  return ContactSweepsFor<Real, quadratic_nodes, Set>::table;
}

}  // namespace neve::sim::kernels
