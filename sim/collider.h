#pragma once
/// Rigid obstacles: signed distance, normal and velocity at a time, and the contact law.

#include <string>

#include "sim/shape.h"

namespace neve::sim {

enum class Contact { separate, slip, sticky };

struct Collider {
  std::string name;
  Shape shape;  ///< plane, sphere or box
  Contact contact = Contact::separate;
  double friction = 0.5;    ///< Coulomb, of separate contact
  Vec3d velocity{0, 0, 0};  ///< m/s
  Vec3d angular_velocity{
      0, 0, 0};  ///< rad/s about the shape's centre; a plane's only adds surface velocity
};

/// Where a collider is at a time, moved from its place in the scene at t = 0.
struct Pose {
  Vec3d point;     ///< centre, or the point of a plane
  Mat3d rotation;  ///< columns are the shape's axes
};
Pose pose_at(const Collider& collider, double time);

/// A collider as seen from a point.
struct Surface {
  double distance;  ///< m; Euclidean outside, to the nearest face inside a box; < 0 inside
  Vec3d normal;     ///< outward unit vector; of a box its nearest face's (outside: the face that is
                    ///< furthest below the point), on a tie the lowest axis; (0, 1, 0) in the
                    ///< middle of a sphere
  Vec3d velocity;   ///< m/s, of the rigid motion at the point
};

/// For the host: tests, warnings, planning. The solver's kernels have their own.
/// @throws std::invalid_argument when the shape is neither plane, sphere nor box
Surface surface_at(const Collider& collider, double time, const Vec3d& x);
double signed_distance(const Collider& collider, double time, const Vec3d& x);

}  // namespace neve::sim
