#pragma once
/// Colliders that move by themselves: pushed by snow, pulled by gravity, stopped by each other.
///
/// The place and the motion of a body are those of its collider (its pose offset): nothing else
/// lasts from step to step, so a run that is resumed takes the same steps to the bit. A step is
/// staggered: snow meets the surfaces where they are at its start, at velocities that answer to its
/// impulses pass by pass (sim/engine/body_contact.h); then the bodies get exactly the impulses that
/// the snow got, and move. Contact of bodies with each other and with colliders, and what holds
/// them, is Bullet's.

#include <memory>
#include <vector>

#include "sim/rigid/mass.h"
#include "sim/shapes/collider.h"

namespace neve::sim::rigid {

/// Impulses on a body in a step. The moment is about its centre of mass, N m s.
struct Push {
  Vec3d impulse{0, 0, 0};
  Vec3d moment{0, 0, 0};
};

/// Place and motion of a body. Velocities are those of its centre of mass.
struct Motion {
  Vec3d centre{0, 0, 0};               ///< m, centre of mass
  Mat3d rotation = Mat3d::Identity();  ///< of its collider's pose
  Vec3d velocity{0, 0, 0};             ///< m/s
  Vec3d spin{0, 0, 0};                 ///< rad/s
};

/// Returns the motion of a collider that moves by itself. @throws as mass_properties
Motion motion_at(const shapes::Collider& body, double time);

/// Returns the motion of a collider that moves by itself at the start: that of the scene, less what
/// its joint and `hold` take away as an impact would. @throws as mass_properties
Motion motion_at_start(const shapes::Collider& body);

class RigidBodies {
 public:
  RigidBodies() = default;
  /// @throws std::invalid_argument for a collider that cannot have a body, ShapeError
  explicit RigidBodies(const std::vector<shapes::Collider>& colliders);
  ~RigidBodies();
  RigidBodies(const RigidBodies& other);
  RigidBodies& operator=(const RigidBodies& other);
  RigidBodies(RigidBodies&&) noexcept;
  RigidBodies& operator=(RigidBodies&&) noexcept;

  bool empty() const { return bodies_.empty(); }
  std::size_t size() const { return bodies_.size(); }
  /// Numbers of their colliders, increasing.
  std::size_t collider(std::size_t body) const { return bodies_[body].collider; }
  const MassProperties& mass(std::size_t body) const { return bodies_[body].mass; }

  /// Takes from the motions that the scene gives what the holds of bodies do not allow, where
  /// bodies have none of their own yet.
  void start(std::vector<shapes::Collider>& colliders) const;
  /// Places everything as it is at a time, and finds what touches.
  void begin(const std::vector<shapes::Collider>& colliders, double time);
  /// Finds the motion of bodies at the end of a step of dt that gives them these impulses and
  /// gravity. They have not moved yet.
  /// @param pushes  per body
  void respond(double dt, const Vec3d& gravity, const std::vector<Push>& pushes);
  /// Returns the motion before the step; after() returns the one that respond() found.
  const Motion& before(std::size_t body) const { return bodies_[body].before; }
  const Motion& after(std::size_t body) const { return bodies_[body].after; }
  /// Returns the way from its centre of mass to its collider's point before the step, m.
  const Vec3d& point(std::size_t body) const { return bodies_[body].point; }
  /// Returns the inertia about the centre of mass in the axes of the world before the step, kg m2.
  Mat3d inertia(std::size_t body) const;
  /// Returns the number of parts of a step of dt in which no body, nor what it may meet in the
  /// step, moves by more than a quarter of the body's thickness: none passes through another, or
  /// through a thin wall. Call it after begin(), with what that had.
  int parts_of_step(const std::vector<shapes::Collider>& colliders, double time, double dt,
                    const Vec3d& gravity) const;
  /// The collider moves on: over dt, as found by respond().
  void move(std::size_t body, double dt, double time, shapes::Collider& collider) const;

 private:
  struct Body {
    std::size_t collider;
    MassProperties mass;
    Mat3d axes;        ///< of its form
    double thickness;  ///< m, the least, of its bounds
    double furthest;   ///< m, of its places from the centre of mass
    bool is_convex;
    Motion before, after;
    Vec3d point{0, 0, 0};    ///< see point()
    double joint_angle = 0;  ///< rad, before the step; see PoseOffset
    /// Speeds that springs add after the way of the step: `after` has the speeds of the way.
    Vec3d later_velocity{0, 0, 0}, later_spin{0, 0, 0};
  };
  class World;

  std::vector<Body> bodies_;
  std::unique_ptr<World> world_;  ///< of this step; made when it is needed
};

}  // namespace neve::sim::rigid
