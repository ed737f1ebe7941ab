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

/// Nothing within `reach` metres of the block's first node can touch the collider.
template <class Real>
NEVE_INLINE bool is_out_of_reach(const LocalCollider<Real>& c, Real reach) {
  if (c.shape == ColliderShape::plane) return c.plane_distance > reach;
  const Real extent = c.shape == ColliderShape::sphere ? c.radius : length(c.half);
  return length(c.to_block) > extent + reach;
}

/// Is the place inside (phi <= 0, the surface counts as inside), and the outward normal there.
/// @param r from the block's first node, m
template <class Real>
NEVE_INLINE bool touch(const LocalCollider<Real>& c, const Vec3<Real>& r, Vec3<Real>& normal) {
  if (c.shape == ColliderShape::plane) {
    normal = c.normal;
    return c.plane_distance + dot(r, c.normal) <= Real(0);
  }
  const Vec3<Real> d = c.to_block + r;
  if (c.shape == ColliderShape::sphere) {
    const Real distance = square_root(dot(d, d));
    normal = distance > Real(0) ? d / distance : Vec3<Real>{0, 1, 0};
    return distance <= c.radius;
  }
  // Box: the nearest face is the one of largest signed distance, the lowest axis on a tie.
  int face = 0;
  Real deepest = 0;
  bool is_positive = true;
  for (int a = 0; a < 3; ++a) {
    const Real along = dot(d, c.axis[a]);
    const Real q = absolute(along) - c.half[a];
    if (a == 0 || q > deepest) {
      face = a;
      deepest = q;
      is_positive = along >= Real(0);
    }
  }
  normal = is_positive ? c.axis[face] : -c.axis[face];
  return deepest <= Real(0);
}

/// Velocity after contact.
/// sticky: v_co. slip: no motion along the normal, free sliding. separate: leaves freely, otherwise
/// slides with Coulomb friction, v_t (1 + mu v_n / |v_t|), or sticks where friction would reverse
/// it.
template <class Real>
NEVE_INLINE Vec3<Real> respond(const LocalCollider<Real>& c, const Vec3<Real>& r,
                               const Vec3<Real>& v) {
  Vec3<Real> n;
  if (!touch(c, r, n)) return v;
  const Vec3<Real> v_co = c.velocity + cross(c.omega, c.to_block + r);
  if (c.contact == ContactLaw::sticky) return v_co;
  const Vec3<Real> v_rel = v - v_co;
  const Real v_n = dot(v_rel, n);
  if (c.contact == ContactLaw::slip) return v - n * v_n;
  if (v_n >= Real(0)) return v;
  const Vec3<Real> v_t = v_rel - n * v_n;
  const Real speed_t = square_root(dot(v_t, v_t));
  if (speed_t <= -c.friction * v_n) return v_co;
  return v_t * (Real(1) + c.friction * v_n / speed_t) + v_co;
}

}  // namespace neve::sim
