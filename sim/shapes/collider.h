#pragma once
/// Obstacles, rigid or deforming: signed distance, normal and velocity at a time, and the contact
/// law.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/shapes/keyframes.h"
#include "sim/shapes/shape.h"

namespace neve::sim::shapes {

enum class Contact { separate, slip, sticky };

/// Displacement of a collider by changes during a run: another velocity, or a collider that was
/// added.
struct PoseOffset {
  double since = 0;                  ///< s; from then on it moves with its present velocity
  Vec3d moved{0, 0, 0};              ///< m, until then
  Mat3d turned = Mat3d::Identity();  ///< until then, after the rotation of the shape
  double delay = 0;                  ///< s that steps did not move it: keyframes are so much later
  /// m/s and rad/s from then on, of a body that moves by itself; absent: as the collider says.
  std::optional<std::array<Vec3d, 2>> motion{};
  /// rad, of a body that hangs from a hinge: since the start, with its whole turns, which `turned`
  /// cannot say.
  double joint_angle = 0;
};

/// Directions of the world that a body may not move along or turn about.
enum class HeldAxis { x, y, z, turn_x, turn_y, turn_z };

/// Joint of a body with the world: a point that stays, an axis that it turns about, or one that it
/// slides along.
enum class Joint { none, ball, hinge, slider };

/// A collider with a mass moves by itself (sim/rigid/rigid_bodies.h).
struct RigidBody {
  double density = 0;      ///< kg/m3; 0: not given
  double mass = 0;         ///< kg, before the density; 0: not given
  Vec3d inertia{0, 0, 0};  ///< kg m2, about the axes of the form; 0: of the shape
  std::vector<HeldAxis> hold;
  Joint joint = Joint::none;
  Vec3d joint_point{0, 0, 0};  ///< m, where the body is at the start
  Vec3d joint_axis{0, 1, 0};
  double joint_stiffness = 0;   ///< N m/rad of a hinge, N/m of a slider, back to the start
  double joint_damping = 0;     ///< N m s/rad, N s/m
  Vec3d spring_place{0, 0, 0};  ///< m, to which a spring pulls the centre of mass
  double spring_stiffness = 0;  ///< N/m
  double spring_damping = 0;    ///< N s/m
  double restitution = 0;       ///< speed after a bounce over that before it; not of snow

  bool moves() const { return density > 0 || mass > 0; }
};

struct Collider {
  std::string name;
  Shape shape;
  Contact contact = Contact::separate;
  double friction = 0.5;    ///< Coulomb, of separate contact
  Vec3d velocity{0, 0, 0};  ///< m/s; of a body that moves by itself, at the start
  Vec3d angular_velocity{
      0, 0, 0};  ///< rad/s about the shape's centre; a plane's only adds surface velocity
  std::vector<PoseKeyframe> keyframes;  ///< times increase; the velocities above are 0 then
  PoseOffset pose_offset{};
  RigidBody body{};
};

/// Pose and motion of a collider at a time: from its place in the scene at t = 0 with constant
/// velocities, displaced by its offset; along its keyframes if it has any. Point: centre, or the
/// point of a plane.
using Pose = RigidMotion;
Pose pose_at(const Collider& collider, double time);

/// The time at which a collider has its shape: other than the scene's where steps did not move it.
/// Only a deforming mesh has another shape at another time.
double shape_time(const Collider& collider, double time);

/// Offset of a collider that is changed at a time: with another velocity or spin, or without its
/// keyframes, it continues from its place; one whose place, shape or contact was edited moves by
/// the edit alone. Keyframes say themselves where it is.
PoseOffset offset_after(const Collider& before, const Collider& after, double time);

/// The same for a body that moves by itself: it continues as it does, unless it is given another
/// velocity to start with.
PoseOffset body_offset_after(const Collider& before, const Collider& after, double time);

/// Offset of a collider that steps did not move for a while.
PoseOffset delayed(PoseOffset offset, double seconds);

/// Axis-aligned bounds at a time. @throws std::invalid_argument for a plane, ShapeError
Bounds bounds_at(const Collider& collider, double time);

/// A bound of how fast places of the collider move, over all of its keyframes, m/s. Its spin counts
/// where it changes what space the collider fills: not of spheres, about the axis of round shapes,
/// and of planes, which have no furthest place.
/// A deforming mesh adds the speed of its fastest vertex.
/// @throws ShapeError when a mesh that turns or deforms cannot be read
double largest_speed(const Collider& collider);

/// A collider as seen from a point.
struct Surface {
  double distance;  ///< m; Euclidean outside, to the nearest face inside; < 0 inside; of a
                    ///< terrain, see HeightField::distance
  Vec3d normal;  ///< outward unit vector of the nearest face; of a box, cylinder or cone, outside:
                 ///< of the face that is furthest below the point. On a tie the lowest axis,
                 ///< wall before ends; (0, 1, 0) in the middle of a sphere, the first axis of
                 ///< the shape on the axis of a round one, its second in the middle of a tube
  Vec3d velocity;  ///< m/s, of the rigid motion at the point; of a deforming mesh also that of its
                   ///< nearest place
};

class MeshSurface;
class DeformingMesh;
class HeightField;

/// A collider at a moment, for many places: where it is and what its files hold is found once. For
/// the host: tests, warnings, pictures. The solver's kernels have their own; of a mesh this is
/// exact, theirs is interpolated (sim/shapes/distance_field.h).
class ColliderAt {
 public:
  /// @param collider  outlives this
  /// @throws ShapeError when a mesh cannot be read or is open
  ColliderAt(const Collider& collider, double time);
  Surface surface(const Vec3d& x) const;

 private:
  struct Touching;

  const Shape& shape_;
  Pose pose_;
  double time_;                                       ///< s, see shape_time
  std::shared_ptr<const MeshSurface> mesh_{};         ///< of a mesh, also of one that deforms
  std::shared_ptr<const DeformingMesh> deforming_{};  ///< of that one
  std::shared_ptr<const HeightField> field_{};        ///< of a terrain
};

/// The same at one place.
Surface surface_at(const Collider& collider, double time, const Vec3d& x);
double signed_distance(const Collider& collider, double time, const Vec3d& x);

}  // namespace neve::sim::shapes
