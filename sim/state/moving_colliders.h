#pragma once
/// The colliders of a run, and their poses as kernels read them.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "sim/base/thread_pool.h"
#include "sim/kernels/blocks.h"
#include "sim/kernels/contact.h"
#include "sim/rigid/rigid_bodies.h"
#include "sim/shapes/collider.h"
#include "sim/shapes/deforming_field.h"
#include "sim/shapes/height_field.h"
#include "sim/state/kernel_pose.h"
#include "sim/state/lattice.h"

namespace neve::sim::engine {

class MovingColliders {
 public:
  /// Makes the distances of meshes, and places all colliders.
  /// @throws ShapeError, std::invalid_argument for what cannot be a collider
  MovingColliders(const std::vector<shapes::Collider>& colliders, const Lattice& lattice,
                  double time, ThreadPool& pool);

  /// @param pool  makes the distances of meshes that deform
  void place(const Lattice& lattice, double time, ThreadPool& pool);
  void set_offset(std::size_t k, const shapes::PoseOffset& offset) {
    list_[k].pose_offset = offset;
  }
  /// Bodies that move by themselves, at the beginning of a step.
  /// @param time  of their poses  @return nothing where there is none
  rigid::RigidBodies* begin_bodies(double time);
  /// They take a step of dt. @param pushes  as in RigidBodies::respond, but with moments about the
  /// points of the colliders
  void move_bodies(double time, double dt, const Vec3d& gravity,
                   const std::vector<rigid::Push>& pushes);
  const rigid::RigidBodies& bodies() const { return bodies_; }

  /// Largest speed of a surface that snow may meet in a step of dt from `time`, m/s; 0 if those
  /// within reach rest.
  /// @param blocks      of the snow
  /// @param snow_speed  m/s, of the fastest particle
  double fastest_near(const std::vector<kernels::BlockRange>& blocks, const Lattice& lattice,
                      double time, double dt, double snow_speed) const;

  /// Looks where colliders are in a step of dt from `time`, for is_free().
  void look_ahead(const Lattice& lattice, double time, double dt);
  /// True if no collider comes near the nodes and the particles of a block in that step.
  bool is_free(std::uint64_t key, double snow_speed) const;

  const std::vector<shapes::Collider>& list() const { return list_; }
  /// Poses of the colliders in reach of the lattice.
  const std::vector<kernels::ColliderPose>& poses() const { return poses_; }
  /// Returns the way of each collider from its own point to its pose's, which loads are about, m.
  const std::vector<Vec3d>& moved() const { return moved_; }
  /// True if one of them has a mesh that may deform.
  bool deform() const;
  std::uint64_t memory_bytes() const;

 private:
  /// The distances of a mesh, or of one that deforms, or a terrain; nothing of other shapes.
  struct Field {
    std::shared_ptr<const shapes::DistanceField> rigid;
    std::optional<shapes::DeformingField> deforming;
    std::shared_ptr<const shapes::HeightField> terrain;

    shapes::DistanceSamples samples() const;
    shapes::HeightSamples heights() const;
  };
  static Field make_field(const shapes::Collider& collider, const Lattice& lattice,
                          ThreadPool& pool);
  /// @param until  end of the span of time over which its shape may be as fast as the pose says
  std::optional<KernelPose> pose_at(std::size_t k, const Lattice& lattice, double time,
                                    double until) const;
  /// Speed of the fastest place of a shape that deforms, at any time from one to another, m/s.
  double shape_speed(std::size_t k, double from, double to) const;

  std::vector<shapes::Collider> list_;
  rigid::RigidBodies bodies_;
  bool has_begun_ = false;  ///< the step of the bodies
  std::vector<Field> fields_;
  std::vector<kernels::ColliderPose> poses_;
  std::vector<Vec3d> moved_;
  std::vector<kernels::LocalCollider<double>> ahead_;  ///< seen from cell 0
  double cell_size_ = 0, dt_ = 0;                      ///< of look_ahead
};

}  // namespace neve::sim::engine
