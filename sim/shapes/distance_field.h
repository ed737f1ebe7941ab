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

/// Places of samples: around a mesh, so that the lattice ends where all is outside.
class FieldLattice {
 public:
  FieldLattice() = default;
  /// @param spacing  m, so large that the samples can be counted
  FieldLattice(const Bounds& bounds, double spacing);

  const Vec3i& size() const { return size_; }
  double spacing() const { return spacing_; }
  std::size_t rows() const {
    return static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]);
  }
  std::size_t count() const { return rows() * static_cast<std::size_t>(size_[2]); }
  /// Returns the place of sample k of a row.
  Vec3d place(std::size_t row, std::size_t k) const;
  /// @param distance  of each sample, z fastest, then y
  DistanceSamples samples(const float* distance) const;

 private:
  double spacing_ = 0;    ///< m
  Vec3d first_{0, 0, 0};  ///< m
  Vec3i size_{0, 0, 0};
};

/// Samples along each axis, as numbers that may be absurdly large.
Eigen::Array3d sample_counts(const Bounds& bounds, double spacing);

/// visit(index, signed distance, nearest place) for each sample of a lattice, by all threads of the
/// pool. The bits do not depend on their number.
template <class Visit>
void visit_samples(const MeshSurface& surface, const FieldLattice& lattice, ThreadPool& pool,
                   const Visit& visit) {
  const auto nx = static_cast<std::size_t>(lattice.size()[0]),
             ny = static_cast<std::size_t>(lattice.size()[1]),
             nz = static_cast<std::size_t>(lattice.size()[2]);
  std::vector<std::uint8_t> is_inside(lattice.count());
  pool.ranges(ny * nz, pool.thread_count(), [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint8_t> line(nx);
    for (std::size_t l = begin; l < end; ++l) {
      surface.inside_along_x(lattice.place(l / nz, l % nz), lattice.spacing(), line);
      for (std::size_t i = 0; i < nx; ++i) is_inside[i * ny * nz + l] = line[i];
    }
  });
  pool.ranges(lattice.rows(), pool.thread_count(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      double before = INFINITY;
      for (std::size_t k = 0; k < nz; ++k) {
        const Vec3d y = lattice.place(row, k);
        // No further than from the sample before and then here; a hair more, for its rounding.
        const MeshSurface::Place nearest =
            surface.nearest_place(y, (before + lattice.spacing()) * (1 + 1e-12));
        before = nearest.distance;
        visit(row * nz + k, is_inside[row * nz + k] ? -before : before, nearest);
      }
    }
  });
}

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

  /// Returns samples in the axes of the mesh, about the origin of its file, valid as long as this.
  DistanceSamples samples() const;
  std::size_t bytes() const { return values_.size() * sizeof(float); }

 private:
  FieldLattice lattice_;
  std::vector<float> values_;
};

/// Returns the spacing of the samples, m: half a cell; less where that leaves fewer than 64 along
/// the mesh's largest extent or 8 along its smallest, and more are not too many to keep.
double field_spacing(const MeshSurface& surface, double cell_size);

/// The field of a mesh for cells of that size. Made once: later calls while it is in use or was
/// lately, has the same one (another simulation of the scene, a reset).
/// @throws ShapeError
std::shared_ptr<const DistanceField> distance_field(const Mesh& mesh, double cell_size,
                                                    ThreadPool& pool);

}  // namespace neve::sim::shapes
