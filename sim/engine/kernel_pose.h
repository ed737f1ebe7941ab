#pragma once
/// A collider at a time as kernels want it.

#include <Eigen/Geometry>
#include <optional>

#include "sim/kernels/contact.h"
#include "sim/shapes/collider.h"
#include "sim/shapes/distance_samples.h"

namespace neve::sim::engine {

/// @param cell_size  m
/// @param lattice_origin  blocks
/// @param samples  of a mesh, otherwise not looked at; what they point to has to live as long as
/// the
///                 pose is used
/// @return nothing for a collider whose point left the lattice: out of reach. Of a plane any point
///         of its surface does.
std::optional<kernels::ColliderPose> kernel_pose(const shapes::Collider& collider, double time,
                                                 double cell_size, const Vec3i& lattice_origin,
                                                 const shapes::DistanceSamples& samples);

}  // namespace neve::sim::engine
