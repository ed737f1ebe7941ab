#pragma once
/// Collider response on nodes and particles, for kernels.
/// Source: the paper, section 8 (collisions with friction and stickiness).

#include "sim/base/lanes.h"
#include "sim/base/vec.h"

namespace neve::sim {

/// A simulation with more colliders is refused when it is built.
inline constexpr int max_colliders = 64;

enum class ColliderShape : int { plane, sphere, box };
enum class ContactLaw : int { separate, slip, sticky };

/// A collider at one time. The point is cell and offset, like a particle's position.
struct ColliderPose {
  ColliderShape shape;
  ContactLaw contact;
  double friction;
  int cell[3];
  double offset[3];
  double axes[9];    ///< columns are the box's axes
  double normal[3];  ///< of a plane
  double half[3];    ///< m, of a box
  double radius;     ///< m, of a sphere
  double velocity[3], omega[3];
};

/// The same, seen from a block: distances inside the block keep full precision wherever it is.
template <class Real>
struct LocalCollider {
  ColliderShape shape;
  ContactLaw contact;
  Real friction;
  Vec3<Real> to_block;  ///< from the collider's point to the block's first node, m
  Real plane_distance;  ///< of the block's first node, m
  Vec3<Real> axis[3], normal, half, velocity, omega;
  Real radius;
};

template <class Real>
NEVE_INLINE LocalCollider<Real> localize(const ColliderPose& c, const int* block_cell, double h) {
  LocalCollider<Real> out;
  out.shape = c.shape;
  out.contact = c.contact;
  out.friction = static_cast<Real>(c.friction);
  double plane_distance = 0;
  for (int a = 0; a < 3; ++a) {
    const double d = ((static_cast<double>(block_cell[a]) - c.cell[a]) - c.offset[a]) * h;
    plane_distance += d * c.normal[a];
    out.to_block[a] = static_cast<Real>(d);
    out.normal[a] = static_cast<Real>(c.normal[a]);
    out.half[a] = static_cast<Real>(c.half[a]);
    out.velocity[a] = static_cast<Real>(c.velocity[a]);
    out.omega[a] = static_cast<Real>(c.omega[a]);
    for (int b = 0; b < 3; ++b) out.axis[a][b] = static_cast<Real>(c.axes[3 * b + a]);
  }
  out.plane_distance = static_cast<Real>(plane_distance);
  out.radius = static_cast<Real>(c.radius);
  return out;
}

/// Nothing within `reach` metres of the place `centre` in the block can touch the collider.
template <class Real>
NEVE_INLINE bool is_out_of_reach(const LocalCollider<Real>& c, const Vec3<Real>& centre,
                                 Real reach) {
  if (c.shape == ColliderShape::plane) return c.plane_distance + dot(centre, c.normal) > reach;
  const Real extent = c.shape == ColliderShape::sphere ? c.radius : length(c.half);
  return length(c.to_block + centre) > extent + reach;
}

template <class V, class Real>
NEVE_INLINE Vec3<V> widened(const Vec3<Real>& a) {
  return {all<V>(a.x), all<V>(a.y), all<V>(a.z)};
}
template <class V>
NEVE_INLINE Vec3<V> select(MaskOf<V> mask, const Vec3<V>& a, const Vec3<V>& b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

/// The lanes inside (phi <= 0, the surface counts as inside), and the outward normal there.
/// @param r from the block's first node, m
template <class V, class Real>
NEVE_INLINE MaskOf<V> touch(const LocalCollider<Real>& c, const Vec3<V>& r, Vec3<V>& normal) {
  const V zero{};
  if (c.shape == ColliderShape::plane) {
    normal = widened<V>(c.normal);
    return c.plane_distance + dot(r, normal) <= zero;
  }
  const Vec3<V> d = widened<V>(c.to_block) + r;
  if (c.shape == ColliderShape::sphere) {
    const V distance = square_root_lanes(dot(d, d));
    const Vec3<V> up{zero, all<V>(1), zero};
    normal = select(distance > zero, d / distance, up);
    return distance <= all<V>(c.radius);
  }
  // Box: the nearest face is the one of largest signed distance, the lowest axis on a tie.
  V deepest{};
  for (int a = 0; a < 3; ++a) {
    const Vec3<V> axis = widened<V>(c.axis[a]);
    const V along = dot(d, axis);
    const V q = absolute_lanes(along) - c.half[a];
    const MaskOf<V> is_nearest = a == 0 ? zero <= zero : q > deepest;
    normal = select(is_nearest, select(along >= zero, axis, -axis), normal);
    deepest = is_nearest ? q : deepest;
  }
  return deepest <= zero;
}

/// Velocity of the collider's surface at a place.
template <class V, class Real>
NEVE_INLINE Vec3<V> surface_velocity(const LocalCollider<Real>& c, const Vec3<V>& r) {
  return widened<V>(c.velocity) + cross(widened<V>(c.omega), widened<V>(c.to_block) + r);
}

/// Velocity after contact.
/// sticky: v_co. slip: no motion along the normal, free sliding. separate: leaves freely, otherwise
/// slides with Coulomb friction, v_t (1 + mu v_n / |v_t|), or sticks where friction would reverse
/// it.
template <class V, class Real>
NEVE_INLINE Vec3<V> respond(const LocalCollider<Real>& c, const Vec3<V>& r, const Vec3<V>& v) {
  Vec3<V> n;
  const MaskOf<V> is_inside = touch(c, r, n);
  if (!any_lane(is_inside)) return v;
  const Vec3<V> v_co = surface_velocity(c, r);
  if (c.contact == ContactLaw::sticky) return select(is_inside, v_co, v);
  const Vec3<V> v_rel = v - v_co;
  const V v_n = dot(v_rel, n);
  if (c.contact == ContactLaw::slip) return select(is_inside, v - n * v_n, v);
  const Vec3<V> v_t = v_rel - n * v_n;
  const V speed_t = square_root_lanes(dot(v_t, v_t));
  const MaskOf<V> sticks = speed_t <= -c.friction * v_n;
  const Vec3<V> slides = v_t * (Real(1) + c.friction * v_n / speed_t) + v_co;
  return select(is_inside & (v_n < V{}), select(sticks, v_co, slides), v);
}

}  // namespace neve::sim
