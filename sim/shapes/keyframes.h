#pragma once
/// Places and attitudes that a rigid thing passes through at given times.

#include <optional>
#include <vector>

#include "sim/types/math.h"

namespace neve::sim::shapes {

/// Absent values are inherited from the shape.
struct PoseKeyframe {
  double time = 0;                ///< s
  std::optional<Vec3d> position;  ///< m, of the shape's centre (a plane's point)
  std::optional<Vec3d> rotation;  ///< degrees, R = Rz Ry Rx, instead of the shape's
};

/// Place and attitude with the velocities that belong to them.
struct RigidMotion {
  Vec3d point{0, 0, 0};                ///< m
  Mat3d rotation = Mat3d::Identity();  ///< columns are the shape's axes
  Vec3d velocity{0, 0, 0};             ///< m/s, of the point
  Vec3d angular_velocity{0, 0, 0};     ///< rad/s
};

/// Each coordinate runs on a monotone cubic (sim/shapes/curve.h). The attitude runs on a cubic
/// Hermite curve of unit quaternions, from keyframe to keyframe the shorter way round, with angular
/// velocities at keyframes chosen like the slopes of the coordinates. So position and attitude and
/// their velocities are continuous, at rest at the first and last keyframe and beyond, and a thing
/// held by two equal keyframes does not move. Source: Kim, Kim and Shin, A general construction
/// scheme for unit quaternion curves with simple high order derivatives, SIGGRAPH 1995, section 5
/// (Hermite curves).
/// @param keyframes  times increase; at least one
/// @param position, degrees  of the shape, for values that keyframes leave out
/// Check: Keyframes.VelocitiesAreTheDerivativesOfThePose
RigidMotion motion_at(const std::vector<PoseKeyframe>& keyframes, const Vec3d& position,
                      const Vec3d& degrees, double time);

/// Degrees between the attitudes of two keyframes as their angles are written: what the shorter way
/// round covers only below 180.
double written_turn(const Vec3d& degrees, const Vec3d& next);

}  // namespace neve::sim::shapes
