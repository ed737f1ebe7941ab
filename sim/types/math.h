#pragma once
/// Eigen types of the solver's interface. Kernels use sim/base instead.

#include <Eigen/Core>

namespace neve::sim {

using Vec3d = Eigen::Vector3d;
using Vec3i = Eigen::Vector3i;
using Mat3d = Eigen::Matrix3d;

/// R = Rz Ry Rx from angles in degrees: x turns first.
Mat3d rotation_from_degrees(const Vec3d& degrees);

/// The angles of a rotation, in degrees: y between -90 and 90; where that is one of these, x is 0.
Vec3d degrees_from_rotation(const Mat3d& rotation);

/// exp([w]x): the rotation by |w| radians about w.
Mat3d rotation_from_vector(const Vec3d& w);

}  // namespace neve::sim
