#pragma once
/// Signed distances and velocities of a deforming mesh at a time, for the solver's kernels.
///
/// Distances of two files are not blended: a plate that moves further than its thickness would have
/// no inside half way. Instead each interval between two files is cut into parts in which no vertex
/// moves further than half a spacing; distances are exact at the ends of a part and blended within
/// it. Fields of a part are made when a step reaches it, two are kept.

#include <memory>
#include <string>
#include <vector>

#include "sim/base/thread_pool.h"
#include "sim/shapes/deforming_mesh.h"
#include "sim/shapes/distance_field.h"

namespace neve::sim::shapes {

/// A copy shares what was made, and moves by itself.
class DeformingField {
 public:
  /// Samples around the mesh between two files at most: 96 MiB with what is kept.
  static constexpr double max_samples = 128.0 * 128.0 * 128.0;

  /// @param name  of the mesh in messages
  /// @throws ShapeError if the samples would be too many, or the mesh is thinner than their spacing
  DeformingField(std::shared_ptr<const DeformingMesh> mesh, const std::string& name,
                 double cell_size);

  const DeformingMesh& mesh() const { return *mesh_; }

  /// Moves the samples to a time. The bits depend on nothing else: not on earlier times, not on the
  /// number of threads.
  void move_to(double time, ThreadPool& pool);

  /// Returns samples in the axes of the mesh, about the origin of its files, valid until it moves.
  DistanceSamples samples() const;
  std::size_t bytes() const;

 private:
  /// The end of a part of an interval.
  struct Cut {
    std::size_t interval = 0;
    int number = 0;
    bool operator==(const Cut&) const = default;
  };
  struct Values {
    Cut cut;
    std::vector<float> distance;  ///< m
    std::vector<float> velocity;  ///< m/s, three of each sample
  };

  FieldLattice lattice(std::size_t interval) const;
  int parts(std::size_t interval) const;
  void require(const Cut& cut, ThreadPool& pool, std::shared_ptr<const Values>& values) const;
  void blend(float part, ThreadPool& pool);

  std::shared_ptr<const DeformingMesh> mesh_;
  double spacing_;        ///< m
  FieldLattice lattice_;  ///< of the values now
  bool moves_ = false;
  std::shared_ptr<const Values> before_, after_;
  std::shared_ptr<Values> now_;
};

/// Returns the spacing of the samples of such a field, m: half a cell, or a third of its thickness
/// where that is less and the samples do not become more than 64^3.
double field_spacing(const DeformingMesh& mesh, double cell_size);

/// Bytes of the largest field and of its mesh, for estimates.
double memory_of(const DeformingMesh& mesh, double cell_size);

}  // namespace neve::sim::shapes
