#pragma once
/// Rigid obstacles: signed distance, normal and velocity at a time, and the contact law.

#include <string>

#include "sim/shape.h"

namespace neve::sim {

enum class Contact { separate, slip, sticky };

/// How a collider came to be elsewhere than its shape and motion say: a run that went on with
/// another velocity, or with a collider that was not there before.
struct Travel {
  double since = 0;                  ///< s; from then on it moves with its present velocity
  Vec3d moved{0, 0, 0};              ///< m, until then
  Mat3d turned = Mat3d::Identity();  ///< until then, after the rotation of the shape
};

struct Collider {
  std::string name;
  Shape shape;  ///< plane, sphere or box
  Contact contact = Contact::separate;
  double friction = 0.5;    ///< Coulomb, of separate contact
  Vec3d velocity{0, 0, 0};  ///< m/s
  Vec3d angular_velocity{
      0, 0, 0};  ///< rad/s about the shape's centre; a plane's only adds surface velocity
  Travel travel{};
};

/// Where a collider is at a time, moved from its place in the scene at t = 0, or as its travel
/// says.
struct Pose {
  Vec3d point;     ///< centre, or the point of a plane
  Mat3d rotation;  ///< columns are the shape's axes
};
Pose pose_at(const Collider& collider, double time);

/// The travel of a collider that is changed at a time: with another velocity or spin it goes on
/// from where it is; one whose place, shape or contact was edited moves by the edit alone.
Travel travel_after(const Collider& before, const Collider& after, double time);

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
