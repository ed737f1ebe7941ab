#pragma once
/// Bodies that move by themselves, and snow for them.

#include <Eigen/Geometry>
#include <cmath>
#include <utility>
#include <vector>

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

/// Returns the place and motion of a collider of a simulation at its time.
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

/// Steps of bodies alone.
class BodiesAlone {
 public:
  explicit BodiesAlone(std::vector<sim::shapes::Collider> colliders,
                       const Vec3d& gravity = {0, -9.81, 0})
      : list(std::move(colliders)), bodies_(list), gravity_(gravity) {}

  void run(double seconds, double dt) {
    const auto steps = static_cast<int>(std::lround(seconds / dt));
    for (int k = 0; k < steps; ++k) step(dt);
  }
  void step(double dt, const std::vector<sim::rigid::Push>& pushes = {}) {
    bodies_.begin(list, time);
    bodies_.respond(dt, gravity_,
                    pushes.empty() ? std::vector<sim::rigid::Push>(bodies_.size()) : pushes);
    time += dt;
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      bodies_.move(b, dt, time, list[bodies_.collider(b)]);
  }
  sim::shapes::Pose pose(std::size_t k) const { return sim::shapes::pose_at(list[k], time); }

  std::vector<sim::shapes::Collider> list;
  double time = 0;

 private:
  sim::rigid::RigidBodies bodies_;
  Vec3d gravity_;
};

}  // namespace neve::test
