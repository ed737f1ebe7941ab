#pragma once
/// Bodies that move by themselves, and snow for them.

#include <Eigen/Geometry>

#include "sim/rigid/rigid_bodies.h"
#include "tests/support/snow.h"

namespace neve::test {

inline sim::shapes::Collider ball_of(double density, const Vec3d& centre, double radius,
                                     const Vec3d& velocity = Vec3d::Zero()) {
  sim::shapes::Collider c;
  c.name = "ball";
  c.shape.form = sim::shapes::Sphere{centre, radius};
  c.velocity = velocity;
  c.body.density = density;
  return c;
}

inline sim::shapes::Collider box_of(double density, const Vec3d& centre, const Vec3d& size,
                                    const Vec3d& degrees = Vec3d::Zero()) {
  sim::shapes::Collider c;
  c.name = "box";
  c.shape.form = sim::shapes::Box{centre, size};
  c.shape.rotation = degrees;
  c.body.density = density;
  return c;
}

/// How a collider of a simulation moves now.
inline sim::shapes::Pose motion_of(const sim::Simulation& simulation, std::size_t k) {
  return sim::shapes::pose_at(simulation.colliders()[k], simulation.time());
}

/// Momentum of a body, and its moment of momentum about the origin.
struct BodyMomentum {
  Vec3d linear, angular;
  double kinetic;  ///< J
};
inline BodyMomentum momentum_of(const sim::shapes::Collider& body, double time) {
  const sim::rigid::MassProperties mass = sim::rigid::mass_properties(body);
  const sim::shapes::Pose pose = sim::shapes::pose_at(body, time);
  const Mat3d axes = pose.rotation * sim::shapes::form_axes(body.shape);
  const Vec3d arm = axes * mass.centre, centre = pose.point + arm;
  const Vec3d velocity = pose.velocity + pose.angular_velocity.cross(arm);
  const Vec3d spin = axes * mass.inertia * axes.transpose() * pose.angular_velocity;
  return {mass.mass * velocity, centre.cross(mass.mass * velocity) + spin,
          0.5 * mass.mass * velocity.squaredNorm() + 0.5 * pose.angular_velocity.dot(spin)};
}

}  // namespace neve::test
