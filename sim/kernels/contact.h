#pragma once
/// Collider response on nodes and particles, for kernels.
/// Source: the paper, section 8 (collisions with friction and stickiness).

#include "sim/base/lanes.h"
#include "sim/base/scalar.h"
#include "sim/base/vec.h"
#include "sim/shapes/distance_samples.h"
#include "sim/shapes/height_samples.h"

namespace neve::sim::kernels {

/// A simulation with more colliders is refused when it is built.
inline constexpr int max_colliders = 64;

enum class ColliderShape : int {
  plane,
  sphere,
  box,
  capsule,
  cylinder,
  cone,
  torus,
  field,
  heights
};
enum class ContactLaw : int { separate, slip, sticky };

/// A collider at one time. The point is cell and offset, like a particle's position. A round one is
/// so about the second of its axes.
struct ColliderPose {
  int index;  ///< in the list of colliders; those out of reach have no pose
  ColliderShape shape;
  ContactLaw contact;
  double friction;
  int cell[3];
  double offset[3];
  double axes[9];    ///< columns are the shape's axes
  double normal[3];  ///< of a plane
  double half[3];    ///< m, of a box; [1]: half the axis of a capsule, cylinder or cone
  double radius;     ///< m: of a sphere, capsule, cylinder, a cone's base, a torus's tube
  double ring;       ///< m, of a torus: from its centre to the middle of the tube
  shapes::DistanceSamples samples;  ///< of a field
  shapes::HeightSamples heights;    ///< of a terrain
  double shape_speed;               ///< m/s, of the fastest place of a shape that deforms
  double velocity[3], omega[3];
  bool moves_by_itself;  ///< a body: velocities are those before the step
};

/// The same, seen from a block: distances inside the block keep full precision wherever it is.
template <class Real>
struct LocalCollider {
  int index;
  ColliderShape shape;
  ContactLaw contact;
  Real friction;
  Vec3<Real> to_block;  ///< from the collider's point to the block's first node, m
  Real plane_distance;  ///< of the block's first node, m
  Vec3<Real> axis[3], normal, half, velocity, omega;
  Real radius, ring;
  Real slope_out, slope_up;  ///< of a cone: the normal of its wall, outward and along the axis
  const float *samples, *velocities;
  Real shape_speed;
  int size[3];
  Real spacing;
  Vec3<Real> first;
  // Numbers of a terrain. Posts are counted from that of the cell below the block's first node:
  // `first` is the place of that post from the node, in the axes of the terrain.
  const float* posts;
  int columns, rows, column, row;
  Real post_height;            ///< of that post, m above the datum; 0 where it has no data
  Real post_spacing, highest;  ///< m, highest: above the block's first node
  Real flattest;               ///< see HeightSamples
};

/// Numbers are small near the block, however far the first post is.
template <class Real>
NEVE_INLINE void localize_heights(const ColliderPose& c, const double* to_block,
                                  LocalCollider<Real>& out) {
  const shapes::HeightSamples& s = c.heights;
  double at[3];
  for (int a = 0; a < 3; ++a)
    at[a] = to_block[0] * c.axes[a] + to_block[1] * c.axes[3 + a] + to_block[2] * c.axes[6 + a];
  const auto cell = [](double place, int count) {
    const double last = count - 2;
    return static_cast<int>(place > 0 ? (place < last ? place : last) : 0);
  };
  out.posts = s.height;
  out.columns = s.columns;
  out.rows = s.rows;
  out.column = cell((at[0] - s.first[0]) / s.spacing, s.columns);
  out.row = cell((at[2] - s.first[1]) / s.spacing, s.rows);
  const float height = s.height[static_cast<long>(out.row) * s.columns + out.column];
  out.post_height = static_cast<Real>(height == height ? height : 0);
  out.first = {static_cast<Real>(s.first[0] + out.column * s.spacing - at[0]),
               static_cast<Real>(s.datum + static_cast<double>(out.post_height) - at[1]),
               static_cast<Real>(s.first[1] + out.row * s.spacing - at[2])};
  out.post_spacing = static_cast<Real>(s.spacing);
  out.highest = static_cast<Real>(s.datum + s.highest - at[1]);
  out.flattest = static_cast<Real>(s.flattest);
}

template <class Real>
NEVE_INLINE LocalCollider<Real> localize(const ColliderPose& c, const int* block_cell, double h) {
  LocalCollider<Real> out;
  out.index = c.index;
  out.shape = c.shape;
  out.contact = c.contact;
  out.friction = static_cast<Real>(c.friction);
  double plane_distance = 0, to_block[3];
  for (int a = 0; a < 3; ++a) {
    const double d = to_block[a] =
        ((static_cast<double>(block_cell[a]) - c.cell[a]) - c.offset[a]) * h;
    plane_distance += d * c.normal[a];
    out.to_block[a] = static_cast<Real>(d);
    out.normal[a] = static_cast<Real>(c.normal[a]);
    out.half[a] = static_cast<Real>(c.half[a]);
    out.velocity[a] = static_cast<Real>(c.velocity[a]);
    out.omega[a] = static_cast<Real>(c.omega[a]);
    for (int b = 0; b < 3; ++b) out.axis[a][b] = static_cast<Real>(c.axes[3 * b + a]);
    out.size[a] = c.samples.size[a];
    out.first[a] = static_cast<Real>(c.samples.first[a]);
  }
  out.plane_distance = static_cast<Real>(plane_distance);
  out.radius = static_cast<Real>(c.radius);
  out.ring = static_cast<Real>(c.ring);
  // A wall falls from the apex by the height over the radius.
  const double height = 2 * c.half[1], slant = square_root(height * height + c.radius * c.radius);
  out.slope_out = static_cast<Real>(slant > 0 ? height / slant : 0);
  out.slope_up = static_cast<Real>(slant > 0 ? c.radius / slant : 0);
  out.samples = c.samples.distance;
  out.velocities = c.samples.velocity;
  out.shape_speed = static_cast<Real>(c.shape_speed);
  out.spacing = static_cast<Real>(c.samples.spacing);
  if (c.shape == ColliderShape::heights) localize_heights(c, to_block, out);
  return out;
}

template <class V, class Real>
NEVE_INLINE Vec3<V> widened(const Vec3<Real>& a) {
  return {all<V>(a.x), all<V>(a.y), all<V>(a.z)};
}
template <class V>
NEVE_INLINE Vec3<V> select(MaskOf<V> mask, const Vec3<V>& a, const Vec3<V>& b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

// ---- one function per shape ---------------------------------------------------------------------
//
// @param d  from the shape's point, m
// @return signed distance in m: exact inside and on the surface; outside a bound from below that
//         is above 0, and falls by no more than what a place moves
// @param normal  outward unit vector of the surface that the distance is to; where several are as
//         near, the first of them in the order below

/// The middle looks up.
template <class V, class Real>
NEVE_INLINE V sphere_distance(const LocalCollider<Real>& c, const Vec3<V>& d, Vec3<V>& normal) {
  const V zero{};
  const V distance = square_root_lanes(dot(d, d));
  const Vec3<V> up{zero, all<V>(1), zero};
  normal = select(distance > zero, d / distance, up);
  return distance - all<V>(c.radius);
}

/// The nearest face is the one of largest signed distance, the lowest axis on a tie.
template <class V, class Real>
NEVE_INLINE V box_distance(const LocalCollider<Real>& c, const Vec3<V>& d, Vec3<V>& normal) {
  const V zero{};
  V deepest{};
  for (int a = 0; a < 3; ++a) {
    const Vec3<V> axis = widened<V>(c.axis[a]);
    const V along = dot(d, axis);
    const V q = absolute_lanes(along) - c.half[a];
    const MaskOf<V> is_nearest = a == 0 ? zero <= zero : q > deepest;
    normal = select(is_nearest, select(along >= zero, axis, -axis), normal);
    deepest = is_nearest ? q : deepest;
  }
  return deepest;
}

/// A place beside the axis of a round shape.
template <class V>
struct Meridian {
  V along, out;           ///< m: along the axis, and away from it
  Vec3<V> axis, outward;  ///< unit vectors; on the axis itself outward is the shape's first axis
};
template <class V, class Real>
NEVE_INLINE Meridian<V> meridian(const LocalCollider<Real>& c, const Vec3<V>& d) {
  Meridian<V> m;
  m.axis = widened<V>(c.axis[1]);
  m.along = dot(d, m.axis);
  const Vec3<V> away = d - m.axis * m.along;
  m.out = square_root_lanes(dot(away, away));
  m.outward = select(m.out > V{}, away / m.out, widened<V>(c.axis[0]));
  return m;
}

template <class V, class Real>
NEVE_INLINE V capsule_distance(const LocalCollider<Real>& c, const Vec3<V>& d, Vec3<V>& normal) {
  const Meridian<V> m = meridian(c, d);
  const V end = all<V>(c.half.y);
  const Vec3<V> away = d - m.axis * larger_lanes(smaller_lanes(m.along, end), -end);
  const V distance = square_root_lanes(dot(away, away));
  normal = select(distance > V{}, away / distance, widened<V>(c.axis[0]));
  return distance - all<V>(c.radius);
}

/// The wall, then the ends.
template <class V, class Real>
NEVE_INLINE V cylinder_distance(const LocalCollider<Real>& c, const Vec3<V>& d, Vec3<V>& normal) {
  const Meridian<V> m = meridian(c, d);
  const V wall = m.out - c.radius, end = absolute_lanes(m.along) - c.half.y;
  const MaskOf<V> is_wall = wall >= end;
  normal = select(is_wall, m.outward, select(m.along >= V{}, m.axis, -m.axis));
  return is_wall ? wall : end;
}

/// The wall, then the base.
template <class V, class Real>
NEVE_INLINE V cone_distance(const LocalCollider<Real>& c, const Vec3<V>& d, Vec3<V>& normal) {
  const Meridian<V> m = meridian(c, d);
  const V wall = m.out * c.slope_out + (m.along - c.half.y) * c.slope_up;
  const V base = -(m.along + c.half.y);
  const MaskOf<V> is_wall = wall >= base;
  normal = select(is_wall, m.outward * all<V>(c.slope_out) + m.axis * all<V>(c.slope_up), -m.axis);
  return is_wall ? wall : base;
}

/// The middle of the tube looks along the axis.
template <class V, class Real>
NEVE_INLINE V torus_distance(const LocalCollider<Real>& c, const Vec3<V>& d, Vec3<V>& normal) {
  const Meridian<V> m = meridian(c, d);
  const V out = m.out - c.ring;
  const V distance = square_root_lanes(out * out + m.along * m.along);
  normal =
      select(distance > V{}, m.outward * (out / distance) + m.axis * (m.along / distance), m.axis);
  return distance - all<V>(c.radius);
}

/// The place in the lattice of a field that is nearest to a point.
template <class V>
struct FieldPlace {
  MaskOf<V> index{};  ///< of the first sample of its cell
  V part[3];          ///< where in the cell
  V beyond{};         ///< squared distance to the lattice, in spacings
};
template <class V, class Real>
NEVE_INLINE FieldPlace<V> field_place(const LocalCollider<Real>& c, const Vec3<V>& d) {
  using I = MaskOf<V>;
  const V zero{};
  FieldPlace<V> at;
  for (int a = 0; a < 3; ++a) {
    const V place = (dot(d, widened<V>(c.axis[a])) - c.first[a]) / c.spacing;
    const V last = all<V>(static_cast<Real>(c.size[a] - 1));
    // NaN becomes 0.
    V held = place > zero ? place : zero;
    held = held < last ? held : last;
    at.beyond += (place - held) * (place - held);
    I cell = __builtin_convertvector(held, I);
    const I before_last = all<I>(c.size[a] - 2);
    cell = cell < before_last ? cell : before_last;
    at.part[a] = held - __builtin_convertvector(cell, V);
    at.index = at.index * c.size[a] + cell;
  }
  return at;
}

/// The values at the corners of cells, z fastest, then y.
/// @param stride  numbers of a sample, of which the first is taken
template <class V, class Real>
NEVE_INLINE void load_corners(const LocalCollider<Real>& c, const MaskOf<V>& index,
                              const float* values, int stride, Real (*corner)[lane_count<V>]) {
  const int row = c.size[2], slab = c.size[1] * c.size[2];
  for (int l = 0; l < lane_count<V>; ++l) {
    const float* at = values + static_cast<long>(stride) * index[l];
    for (int k = 0; k < 8; ++k)
      corner[k][l] =
          static_cast<Real>(at[stride * ((k >> 2) * slab + (k >> 1 & 1) * row + (k & 1))]);
  }
}

/// Interpolates between eight samples; the normal is the gradient of that. A place beyond the
/// lattice takes the nearest place in it and the way there.
template <class V, class Real>
NEVE_INLINE V field_distance(const LocalCollider<Real>& c, const Vec3<V>& d, Vec3<V>& normal) {
  const V zero{};
  const FieldPlace<V> at = field_place(c, d);
  const V *part = at.part, beyond = at.beyond;
  Real corner[8][lane_count<V>];
  load_corners<V>(c, at.index, c.samples, 1, corner);
  V value[4], along_z[4];
  for (int k = 0; k < 4; ++k) {
    const V low = load_lanes<V>(corner[2 * k]);
    along_z[k] = load_lanes<V>(corner[2 * k + 1]) - low;
    value[k] = low + part[2] * along_z[k];
  }
  V along_y[2];
  for (int k = 0; k < 2; ++k) {
    along_y[k] = value[2 * k + 1] - value[2 * k];
    value[k] = value[2 * k] + part[1] * along_y[k];
    along_z[k] = along_z[2 * k] + part[1] * (along_z[2 * k + 1] - along_z[2 * k]);
  }
  const V along_x = value[1] - value[0];
  const V distance = value[0] + part[0] * along_x;
  const Vec3<V> gradient =
      widened<V>(c.axis[0]) * along_x +
      widened<V>(c.axis[1]) * (along_y[0] + part[0] * (along_y[1] - along_y[0])) +
      widened<V>(c.axis[2]) * (along_z[0] + part[0] * (along_z[1] - along_z[0]));
  const V steepness = square_root_lanes(dot(gradient, gradient));
  normal = select(steepness > zero, gradient / steepness, widened<V>(c.axis[1]));
  const V way = larger_lanes(distance, zero);
  const V outside = square_root_lanes(beyond * (c.spacing * c.spacing) + way * way);
  return beyond > zero ? outside : distance;
}

/// Velocity of the nearest place of a mesh that deforms, between eight samples.
template <class V, class Real>
NEVE_INLINE Vec3<V> field_velocity(const LocalCollider<Real>& c, const Vec3<V>& d) {
  const FieldPlace<V> at = field_place(c, d);
  Vec3<V> velocity{};
  for (int a = 0; a < 3; ++a) {
    Real corner[8][lane_count<V>];
    load_corners<V>(c, at.index, c.velocities + a, 3, corner);
    V value[8];
    for (int k = 0; k < 8; ++k) value[k] = load_lanes<V>(corner[k]);
    for (int axis = 2, count = 4; axis >= 0; --axis, count /= 2)
      for (int k = 0; k < count; ++k)
        value[k] = value[2 * k] + at.part[axis] * (value[2 * k + 1] - value[2 * k]);
    velocity = velocity + widened<V>(c.axis[a]) * value[0];
  }
  return velocity;
}

/// The cell of a place along one side of a terrain, from that of the block, and where in it; beyond
/// the posts, the nearest place.
/// @param before  posts before that of the block
template <class V>
struct PostPlace {
  MaskOf<V> cell;
  V part;
  MaskOf<V> is_beyond;
};
template <class V>
NEVE_INLINE PostPlace<V> post_place(V place, int before, int count) {
  using Real = ElementOf<V>;
  using I = MaskOf<V>;
  PostPlace<V> out;
  const V low = all<V>(static_cast<Real>(-before)),
          high = all<V>(static_cast<Real>(count - 1 - before));
  // NaN becomes the first post.
  V held = place > low ? place : low;
  held = held < high ? held : high;
  out.is_beyond = held != place;
  I cell = __builtin_convertvector(held, I);
  // Conversion rounds towards 0: one less below it. True is -1.
  cell += __builtin_convertvector(cell, V) > held;
  const I before_last = all<I>(count - 2 - before);
  out.cell = cell < before_last ? cell : before_last;
  out.part = held - __builtin_convertvector(out.cell, V);
  return out;
}

/// A place above or below the surface of a terrain.
template <class V>
struct OverGround {
  V above;             ///< m, along its second axis
  V along_x, along_z;  ///< slope of the surface there
  MaskOf<V> is_hole;   ///< nothing of the above is known
};
template <class V, class Real>
NEVE_INLINE OverGround<V> over_ground(const LocalCollider<Real>& c, const Vec3<V>& r) {
  const auto along = [&](int a) { return dot(r, widened<V>(c.axis[a])); };
  const PostPlace<V> x = post_place<V>((along(0) - c.first.x) / c.post_spacing, c.column,
                                       c.columns),
                     z = post_place<V>((along(2) - c.first.z) / c.post_spacing, c.row, c.rows);
  Real corner[4][lane_count<V>];
  for (int l = 0; l < lane_count<V>; ++l) {
    const float* at =
        c.posts + (static_cast<long>(c.row) + z.cell[l]) * c.columns + c.column + x.cell[l];
    corner[0][l] = static_cast<Real>(at[0]) - c.post_height;
    corner[1][l] = static_cast<Real>(at[1]) - c.post_height;
    corner[2][l] = static_cast<Real>(at[c.columns]) - c.post_height;
    corner[3][l] = static_cast<Real>(at[c.columns + 1]) - c.post_height;
  }
  const V nw = load_lanes<V>(corner[0]), sw = load_lanes<V>(corner[2]);
  const V north = load_lanes<V>(corner[1]) - nw, south = load_lanes<V>(corner[3]) - sw;
  const V north_edge = nw + x.part * north, way = sw + x.part * south - north_edge;
  const V height = north_edge + z.part * way;
  OverGround<V> out;
  out.is_hole = height != height;
  out.above = along(1) - c.first.y - height;
  out.along_x = x.is_beyond ? V{} : (north + z.part * (south - north)) / c.post_spacing;
  out.along_z = z.is_beyond ? V{} : way / c.post_spacing;
  return out;
}

/// Returns the distance across the tangent plane of the surface above or below a place: exact on
/// even ground, and to first order near any other.
/// @param r from the block's first node, m
template <class V, class Real>
NEVE_INLINE V heights_distance(const LocalCollider<Real>& c, const Vec3<V>& r, Vec3<V>& normal) {
  const OverGround<V> at = over_ground(c, r);
  const V steepness =
      square_root_lanes(at.along_x * at.along_x + at.along_z * at.along_z + Real(1));
  const Vec3<V> up = widened<V>(c.axis[1]);
  normal =
      (up - widened<V>(c.axis[0]) * at.along_x - widened<V>(c.axis[2]) * at.along_z) / steepness;
  normal = select(at.is_hole, up, normal);
  return at.is_hole ? all<V>(static_cast<Real>(shapes::no_ground)) : at.above / steepness;
}

/// A bound from below of the distance to all of a terrain.
template <class V, class Real>
NEVE_INLINE V heights_clearance(const LocalCollider<Real>& c, const Vec3<V>& r) {
  const OverGround<V> at = over_ground(c, r);
  const V bound = at.is_hole ? V{} : at.above * c.flattest;
  return larger_lanes(bound, dot(r, widened<V>(c.axis[1])) - c.highest);
}

/// Distance from the collider's shape, as in the functions above, but for a terrain: see there.
/// @param r from the block's first node, m
template <class V, class Real>
NEVE_INLINE V surface_distance(const LocalCollider<Real>& c, const Vec3<V>& r, Vec3<V>& normal) {
  if (c.shape == ColliderShape::plane) {
    normal = widened<V>(c.normal);
    return c.plane_distance + dot(r, normal);
  }
  if (c.shape == ColliderShape::heights) return heights_distance(c, r, normal);
  const Vec3<V> d = widened<V>(c.to_block) + r;
  switch (c.shape) {
    case ColliderShape::sphere:
      return sphere_distance(c, d, normal);
    case ColliderShape::capsule:
      return capsule_distance(c, d, normal);
    case ColliderShape::cylinder:
      return cylinder_distance(c, d, normal);
    case ColliderShape::cone:
      return cone_distance(c, d, normal);
    case ColliderShape::torus:
      return torus_distance(c, d, normal);
    case ColliderShape::field:
      return field_distance(c, d, normal);
    default:
      return box_distance(c, d, normal);
  }
}

/// The lanes for which nothing within `reach` metres of the place `centre` in the block can touch
/// the collider.
template <class V, class Real>
NEVE_INLINE MaskOf<V> are_out_of_reach(const LocalCollider<Real>& c, const Vec3<V>& centre,
                                       const V& reach) {
  Vec3<V> normal;
  if (c.shape == ColliderShape::heights) return heights_clearance(c, centre) > reach;
  // A field is off by less than the diagonal of a cell between samples, here and there.
  return surface_distance(c, centre, normal) > reach + all<V>(2 * c.spacing);
}
template <class Real>
NEVE_INLINE bool is_out_of_reach(const LocalCollider<Real>& c, const Vec3<Real>& centre,
                                 Real reach) {
  using V = Quad<Real>;
  return are_out_of_reach(c, widened<V>(centre), all<V>(reach))[0] != 0;
}

/// True if no place of a cube comes within `reach` of a collider, m. @param half  of its edge
template <class Real>
NEVE_INLINE bool is_cube_out_of_reach(const LocalCollider<Real>& c, const Vec3<Real>& middle,
                                      Real half, Real reach) {
  const auto along = [&](const Vec3<Real>& axis) {
    return half * (absolute(axis.x) + absolute(axis.y) + absolute(axis.z));
  };
  Real corner = half * Real(1.7321);
  if (c.shape == ColliderShape::plane) corner = along(c.normal);
  if (c.shape == ColliderShape::box)
    corner = larger(along(c.axis[0]), larger(along(c.axis[1]), along(c.axis[2])));
  return is_out_of_reach(c, middle, corner + reach);
}

/// A node this far inside is held, in cells. The nodes of a floor that lies on a plane of nodes are
/// on its surface and not in it, however the distance is rounded.
inline constexpr double node_depth = 1e-6;

/// The lanes at least `depth` metres inside (of 0, the surface counts as inside), and the outward
/// normal there.
/// @param r from the block's first node, m
template <class V, class Real>
NEVE_INLINE MaskOf<V> touch(const LocalCollider<Real>& c, const Vec3<V>& r, Vec3<V>& normal,
                            Real depth = 0) {
  return surface_distance(c, r, normal) <= all<V>(-depth);
}

/// Velocity of the collider's surface at a place.
template <class V, class Real>
NEVE_INLINE Vec3<V> surface_velocity(const LocalCollider<Real>& c, const Vec3<V>& r) {
  const Vec3<V> d = widened<V>(c.to_block) + r;
  const Vec3<V> rigid = widened<V>(c.velocity) + cross(widened<V>(c.omega), d);
  return c.velocities ? rigid + field_velocity(c, d) : rigid;
}

/// Contact with one collider, a value per lane.
template <class V>
struct Response {
  Vec3<V> v;         ///< after it
  MaskOf<V> acts;    ///< v is held along the normal
  MaskOf<V> sticks;  ///< v is held along the surface as well
  Vec3<V> n;         ///< outward normal
};

/// Velocity after contact.
/// sticky: v_co. slip: no motion along the normal, free sliding. separate: leaves freely, otherwise
/// slides with Coulomb friction, v_t (1 + mu v_n / |v_t|), or sticks where friction would reverse
/// it.
/// @param depth  from which contact acts, m
template <class V, class Real>
NEVE_INLINE Response<V> respond(const LocalCollider<Real>& c, const Vec3<V>& r, const Vec3<V>& v,
                                Real depth = 0) {
  Response<V> out{v, {}, {}, {}};
  const MaskOf<V> is_inside = touch(c, r, out.n, depth);
  if (!any_lane(is_inside)) return out;
  const Vec3<V> n = out.n, v_co = surface_velocity(c, r);
  out.acts = is_inside;
  if (c.contact == ContactLaw::sticky) {
    out.v = select(is_inside, v_co, v);
    out.sticks = is_inside;
    return out;
  }
  const Vec3<V> v_rel = v - v_co;
  const V v_n = dot(v_rel, n);
  if (c.contact == ContactLaw::slip) {
    out.v = select(is_inside, v - n * v_n, v);
    return out;
  }
  const Vec3<V> v_t = v_rel - n * v_n;
  const V speed_t = square_root_lanes(dot(v_t, v_t));
  const MaskOf<V> sticks = speed_t <= -c.friction * v_n;
  const Vec3<V> slides = v_t * (Real(1) + c.friction * v_n / speed_t) + v_co;
  out.acts = is_inside & (v_n < V{});
  out.v = select(out.acts, select(sticks, v_co, slides), v);
  if (c.friction > Real(0)) out.sticks = out.acts & sticks;
  return out;
}

}  // namespace neve::sim::kernels
