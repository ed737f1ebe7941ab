#pragma once
/// Shapes as Bullet wants them.

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include <memory>
#include <vector>

#include "sim/rigid/mass.h"

namespace neve::sim::rigid {

/// A face of a surface, in Bullet's unit.
struct Face {
  Vec3d normal;  ///< outward
  Vec3d middle;
};

/// A shape with the memory that it reads.
class RigidShape {
 public:
  virtual ~RigidShape() = default;
  virtual btCollisionShape* get() = 0;
  /// The faces of a surface at a place of one of its triangles, that one first, in the axes of the
  /// form. None at the rim of an open surface, and of a shape that is not made of triangles.
  /// @param triangle  as contacts name it @param place, reach  in Bullet's unit: all nearer than
  /// `reach`
  virtual std::vector<Face> faces_at([[maybe_unused]] int triangle,
                                     [[maybe_unused]] const Vec3d& place,
                                     [[maybe_unused]] double reach) const {
    return {};
  }
};

/// A collider that the scene moves, in the axes of its form about the shape's centre. Meshes and
/// terrain are their triangles.
/// @param unit  m, Bullet's unit of length
/// @throws ShapeError, std::invalid_argument for points and for what deforms (triangles.h)
std::unique_ptr<RigidShape> fixed_shape(const shapes::Shape& shape, double unit);

/// True unless a body of it has hollows: a mesh that is not convex.
/// @throws ShapeError for one with hollows and more faces than a step has time for: each is a shape
bool is_convex(const shapes::Shape& shape);

/// A body, in principal axes about its centre of mass. A convex mesh is its hull, any other one its
/// faces.
/// @param principal  columns are those axes in the axes of the form
/// @param is_convex  as is_convex() says, which looks at all faces of a mesh
/// @param unit  m, Bullet's unit of length
std::unique_ptr<RigidShape> body_shape(const shapes::Shape& shape, const MassProperties& mass,
                                       const Mat3d& principal, bool is_convex, double unit);

btVector3 to_bullet(const Vec3d& v);
btMatrix3x3 to_bullet(const Mat3d& m);
Vec3d from_bullet(const btVector3& v);
Mat3d from_bullet(const btMatrix3x3& m);

}  // namespace neve::sim::rigid
