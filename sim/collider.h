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
  double friction = 0.5;            ///< Coulomb, of separate contact
  Vec3d velocity{0, 0, 0};          ///< m/s
  Vec3d angular_velocity{0, 0, 0};  ///< rad/s about the shape's centre; a plane's only adds surface velocity
};

/// Where a collider is at a time, moved from its place in the scene at t = 0.
struct Pose {
  Vec3d point;     ///< centre, or the point of a plane
  Mat3d rotation;  ///< columns are the shape's axes
};
Pose pose_at(const Collider& collider, double time);

}  // namespace neve::sim
