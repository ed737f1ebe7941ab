#pragma once
/// Meshes of the scene, also those that deform, as bodies that move by themselves meet them.

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim/rigid/rigid_shape.h"
#include "sim/shapes/deforming_mesh.h"

namespace neve::sim::rigid {

/// The triangles of a mesh, which have no inside.
class Triangles : public RigidShape {
 public:
  /// @param all  bounds of all places where its vertices will ever be
  /// @param unit  m, Bullet's unit of length
  Triangles(const shapes::SolidMesh& mesh, const shapes::Bounds& all, double unit);
  btCollisionShape* get() override { return shape_.get(); }
  std::vector<Face> faces_at(int triangle, const Vec3d& place, double reach) const override;

 protected:
  /// Bullet's tree of them stays that of the mesh they were made of, and its boxes follow: which
  /// triangles are found first does not depend on the moments that were asked for.
  void move(const std::vector<Vec3d>& vertices);

 private:
  void write(const std::vector<Vec3d>& vertices);
  std::array<Vec3d, 3> corners_of(std::size_t triangle) const;

  const double unit_;
  btVector3 min_, max_;
  std::vector<double> vertices_;
  std::vector<int> corners_;
  /// Neighbours of each triangle across the edges from its corners 0, 1 and 2; itself without one.
  std::vector<std::array<std::uint32_t, 3>> neighbours_;
  std::unique_ptr<btTriangleIndexVertexArray> triangles_;
  std::unique_ptr<btBvhTriangleMeshShape> shape_;
};

class Deforming final : public Triangles {
 public:
  /// @param unit  m, Bullet's unit of length @throws ShapeError
  Deforming(const shapes::MeshSequence& sequence, double unit)
      : Deforming(shapes::deforming_mesh(sequence), unit) {}

  /// @param time  s, of its shape
  void move_to(double time);
  /// Returns a bound for the speed of all of its places between times of its shape, m/s.
  double fastest(double from, double to) const { return mesh_->fastest(from, to); }
  /// Returns the velocity of a place of the surface, in its axes about its origin, m/s.
  Vec3d velocity(int triangle, const Vec3d& place) const;

 private:
  Deforming(std::shared_ptr<const shapes::DeformingMesh> mesh, double unit);

  std::shared_ptr<const shapes::DeformingMesh> mesh_;
  shapes::DeformingMesh::Moment moment_{};
  shapes::SolidMesh now_;
};

/// A rigid motion.
struct Twist {
  Vec3d velocity{0, 0, 0};  ///< m/s, of a point
  Vec3d spin{0, 0, 0};      ///< rad/s
};

/// Returns the motion nearest to velocities at places, by least squares; of several that of least
/// spin.
/// @param point  whose velocity is wanted
Twist twist_of(const std::vector<Vec3d>& places, const std::vector<Vec3d>& velocities,
               const Vec3d& point);

}  // namespace neve::sim::rigid
