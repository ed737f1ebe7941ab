#pragma once
/// Pose of a camera at a time, from its place, keyframes and turning. It depends on the time alone.

#include "app/scene/scene.h"

namespace neve::app::setup {

struct CameraPlace {
  sim::Vec3d eye, target;  ///< m
  double fov;              ///< vertical, degrees
};

/// Each coordinate and the angle of view pass through the keyframes on monotone cubics, at rest at
/// the first and the last: nothing swings beyond a keyframe, and two equal ones hold the camera
/// still. Then the eye is turned around the target.
/// @param settings resolved: values that keyframes leave out are filled in
/// @param duration s, of the whole scene
CameraPlace camera_at(const scene::CameraSettings& settings, double time, double duration);

/// True if nothing about it is left to be framed: it has a place, or all its keyframes have one.
bool has_place(const scene::CameraSettings& camera);

/// Degrees that the eye has turned about `up` at a time, counter-clockwise seen from above.
double turned(const scene::CameraSettings& settings, double time, double duration);

/// A direction or offset turned about `up` by degrees.
sim::Vec3d turn_about(const sim::Vec3d& up, double degrees, const sim::Vec3d& vector);

}  // namespace neve::app::setup
