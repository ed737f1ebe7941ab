#pragma once
/// A collider at a time as kernels want it.

#include <Eigen/Geometry>
#include <optional>

#include "sim/kernels/contact.h"
#include "sim/shapes/collider.h"
#include "sim/shapes/distance_samples.h"
#include "sim/shapes/height_samples.h"

namespace neve::sim::engine {

struct KernelPose : kernels::ColliderPose {
  Vec3d moved{0, 0, 0};  ///< m, from the collider's own point to the one that kernels count from
};

/// @param cell_size  m
/// @param lattice_origin  blocks
/// @param samples  of a mesh, otherwise not looked at; the pose points to the same memory
/// @param heights  of a terrain, likewise
/// @return nothing for a collider whose point left the lattice: out of reach. Any point of a
/// plane's
///         surface keeps the plane within reach.
std::optional<KernelPose> kernel_pose(const shapes::Collider& collider, double time,
                                      double cell_size, const Vec3i& lattice_origin,
                                      const shapes::DistanceSamples& samples,
                                      const shapes::HeightSamples& heights = {});

}  // namespace neve::sim::engine
