#pragma once
/// Signed distances of a mesh on a dense lattice, for the solver's kernels.
///
/// Dense, and no narrow band, and not OpenVDB: a lane wants the eight samples around its place by
/// one index and no search through a tree; points deep in a press or a boot must still find their
/// way out, which a band says nothing about; and the lattice of an obstacle is small (a boot of 30
/// cells takes 2 MB). OpenVDB (Debian: libopenvdb-dev, 200 MB with TBB, Boost, Blosc and Imath)
/// would bring its own tree, its own threads and an accessor per lane instead of one array.

#include <memory>

#include "sim/base/thread_pool.h"
#include "sim/shapes/distance_samples.h"
#include "sim/shapes/mesh_surface.h"

namespace neve::sim::shapes {

class DistanceField {
 public:
  /// 64 MiB.
  static constexpr double max_samples = 256.0 * 256.0 * 256.0;

  /// Exact distances at the samples, the sign by the winding number. The bits do not depend on the
  /// number of threads.
  /// @param name  of the mesh in messages
  /// @throws ShapeError if the samples would be too many, or no sample is inside
  DistanceField(const MeshSurface& surface, const std::string& name, double spacing,
                ThreadPool& pool);

  /// In the axes of the mesh, about the origin of its file. Valid as long as this.
  DistanceSamples samples() const;
  std::size_t bytes() const { return values_.size() * sizeof(float); }

 private:
  void fill(const MeshSurface& surface, ThreadPool& pool);

  double spacing_;  ///< m
  Vec3d first_;     ///< m
  Vec3i size_;
  std::vector<float> values_;
};

/// m, from sample to sample: half a cell; less where that leaves fewer than 64 along the mesh's
/// largest extent or 8 along its smallest, and more are not too many to keep.
double field_spacing(const MeshSurface& surface, double cell_size);

/// The field of a mesh for cells of that size. Made once: later calls while it is in use or was
/// lately, has the same one (another simulation of the scene, a reset).
/// @throws ShapeError
std::shared_ptr<const DistanceField> distance_field(const Mesh& mesh, double cell_size,
                                                    ThreadPool& pool);

}  // namespace neve::sim::shapes
