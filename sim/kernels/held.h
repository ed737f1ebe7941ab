#pragma once
/// Directions of a node that contact holds in the semi-implicit solve: there the node keeps the
/// velocity that it has after the collision, the others are free.
/// Source: the paper, section 8 (degrees of freedom of colliding nodes are projected out).

#include "sim/kernels/contact.h"

namespace neve::sim::kernels {

/// A normal of which less than this lies outside the held directions adds none.
inline constexpr double same_direction = 1e-3;

/// Held directions of some nodes, a value per lane.
template <class V>
struct Held {
  Vec3<V> axis{};  ///< the held direction if there is one, the free one if there are two held
  V count{};       ///< of held directions: 0 to 3

  /// Adds the directions that the next collider holds.
  NEVE_INLINE void add(const Response<V>& contact) {
    using Real = ElementOf<V>;
    const V one = all<V>(1), two = all<V>(2), three = all<V>(3);
    const Vec3<V>&n = contact.n, before = axis;
    const V along = dot(n, before);
    const V was = count;
    // Twice: to rounding.
    Vec3<V> rest = n - before * along;
    rest = rest - before * dot(rest, before);
    const V size = square_root_lanes(dot(rest, rest));
    const MaskOf<V> adds = contact.acts;
    const MaskOf<V> first = adds & (was == V{});
    const MaskOf<V> second = adds & (was == one) & (size > static_cast<Real>(same_direction));
    const MaskOf<V> third =
        adds & (was == two) & (absolute_lanes(along) > static_cast<Real>(same_direction));
    axis = select(first, n, axis);
    axis = select(second, cross(before, rest / size), axis);
    count = first ? one : count;
    count = second ? two : count;
    count = (third | contact.sticks) ? three : count;
  }
};

/// The part of a node's vector along its free directions.
/// @param held  Held of the node: axis, and count in the fourth number
template <class Node>
NEVE_INLINE Node free_part(const Node& held, const Node& x) {
  using Real = ElementOf<Node>;
  const Real count = held[3];
  if (count == Real(0)) return x;
  if (count == Real(3)) return Node{};
  const Real along = held[0] * x[0] + held[1] * x[1] + held[2] * x[2];
  const Node on_axis{held[0] * along, held[1] * along, held[2] * along, Real(0)};
  return count == Real(2) ? on_axis : x - on_axis;
}

}  // namespace neve::sim::kernels
