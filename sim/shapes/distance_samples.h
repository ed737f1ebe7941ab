#pragma once
/// Distances to a mesh, and its velocities, as kernels read them: no standard header, plain data.

namespace neve::sim::shapes {

/// Signed distances on a regular lattice, in the axes of a shape that has no formula. Plain data.
struct DistanceSamples {
  const float* distance = nullptr;  ///< m, < 0 inside; z runs fastest, then y
  const float* velocity = nullptr;  ///< m/s, three of each sample: of the nearest place of the mesh
                                    ///< as it deforms; null: it keeps its shape
  int size[3] = {0, 0, 0};          ///< samples along each axis, at least 2
  double spacing = 0;               ///< m
  double first[3] = {0, 0, 0};      ///< m: place of the first sample from the shape's point
};

}  // namespace neve::sim::shapes
