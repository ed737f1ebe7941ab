#pragma once
/// Holds of a body: axes that it may not move along or turn about, and a joint with the world.

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <optional>
#include <vector>

#include "sim/rigid/mass.h"

namespace neve::sim::rigid {

/// Returns the angle about the axis of a hinge, rad; a rotation says it but for whole turns.
/// @param turned  since the start, about the axis  @param near  what the angle is nearest to
double hinge_angle(const Vec3d& axis, const Mat3d& turned, double near);

/// Rows of Bullet's solver, all of them rigid. Errors of place are taken back by the share `erp` of
/// the solver, step by step.
class Held final : public btTypedConstraint {
 public:
  /// @param rotation  of the pose of the collider in the scene, times the axes of its form
  /// @param unit  m, Bullet's unit of length
  Held(btRigidBody& body, const shapes::Collider& collider, const MassProperties& mass,
       const Mat3d& rotation, double unit);
  /// False where nothing holds the body: it has no row.
  static bool holds(const shapes::RigidBody& body);
  /// True where no row is about a turn.
  static bool turns_freely(const shapes::RigidBody& body);
  /// The body turns about a ball joint, or about the axis of a hinge or of a ball joint with two
  /// turns held. There is no pivot where `hold` takes more of the motion, or without such a joint.
  struct Pivot {
    std::optional<Vec3d> axis;
  };
  static std::optional<Pivot> pivot_of(const shapes::RigidBody& body);

  struct Speeds {
    Vec3d velocity, spin;
  };

  /// Returns the rest of a motion once the rows hold: all that they take comes from impulses along
  /// them, so where a body has products of inertia, to hold one turn changes the others.
  /// @param inertia  kg m2, about the centre of mass in the axes of the world
  Speeds allowed(const Speeds& given, const Mat3d& inertia) const;

  /// Sets the place of the body, before the rows are asked for.
  /// @param rotation  as in the constructor, now  @param angle  rad, of a hinge, with whole turns
  void set_place(const Vec3d& centre, const Mat3d& rotation, double angle);

  /// Adds the impulse of the springs in a step of dt, and its moment about the centre of mass:
  /// exact where a period has 12 steps or more and the force is linear in the freedom that the
  /// joint leaves, damped and stable where it has less. A spring across a hinge or a ball joint
  /// swings as a pendulum, to the square of the step.
  /// @param before  the step @param pushed  by all else in it
  /// @return the speeds at the end of the step beyond those of its way, which impulses give
  Speeds add_springs(double dt, const Speeds& before, const Speeds& pushed, const Mat3d& inertia,
                     Vec3d& impulse, Vec3d& moment) const;

  void getInfo1(btConstraintInfo1* info) override;
  void getInfo2(btConstraintInfo2* info) override;
  void setParam(int, btScalar, int = -1) override {}
  btScalar getParam(int, int = -1) const override { return 0; }

 private:
  struct Row {
    Vec3d along, about;
    double error;
  };
  std::vector<Row> rows() const;
  void add_joint(std::vector<Row>& rows) const;
  /// Adds the springs of what turns about a joint, as add_springs() does.
  Speeds add_turns(double dt, const Speeds& before, const Speeds& pushed, const Mat3d& inertia,
                   Vec3d& impulse, Vec3d& moment) const;

  const shapes::RigidBody held_;
  const double mass_, size_;  ///< m, the radius of gyration
  const double unit_;
  Vec3d start_;     ///< m, of the centre of mass
  Mat3d rotation_;  ///< in the scene
  Vec3d arm_;       ///< of the joint's point, in the axes of the form from the centre of mass
  Vec3d axis_;      ///< of the joint, in the axes of the world
  Vec3d centre_;
  Mat3d now_;
  double angle_ = 0;
};

}  // namespace neve::sim::rigid
