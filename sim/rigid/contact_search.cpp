#include "sim/rigid/contact_search.h"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <BulletCollision/CollisionShapes/btPolyhedralConvexShape.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace neve::sim::rigid {

namespace {

/// Bullet looks for more points beside the first one in so many directions, turned by 0.02 units
/// over its size, where a body with edges touches a plane, and where the end of a cylinder or a
/// cone lies on a face. Other pairs with edges are clipped face against face (rigid_shape.cpp), and
/// other round ones have one point: further ones, a little beside it, would let a cylinder that
/// lies still roll away, and turn one that comes down on its edge round the vertical by 90 degrees.
constexpr int perturbations = 8, wanted_points = 4;
/// Cosine of 2 degrees.
constexpr double is_parallel = 0.9994;

bool has_end(int shape) {
  return shape == CYLINDER_SHAPE_PROXYTYPE || shape == CONE_SHAPE_PROXYTYPE;
}

btVector3 axis_of(const btCollisionObjectWrapper& round) {
  return round.getWorldTransform().getBasis().getColumn(1);
}

/// True if a face of b is across the axis of the round shape a, which is beyond it.
bool faces_end(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b) {
  const btCollisionShape* shape = b.getCollisionShape();
  const btVector3 axis = b.getWorldTransform().getBasis().transpose() * axis_of(a);
  const btVector3 centre = b.getWorldTransform().invXform(a.getWorldTransform().getOrigin());
  if (has_end(shape->getShapeType()))
    return std::abs(axis.y()) > is_parallel &&
           std::abs(centre.y()) > std::hypot(centre.x(), centre.z());
  if (!shape->isPolyhedral()) return false;
  if (shape->getShapeType() == TRIANGLE_SHAPE_PROXYTYPE) {
    const btVector3* corner = static_cast<const btTriangleShape*>(shape)->m_vertices1;
    const btVector3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
    bool is_above = std::abs(axis.dot(normal)) > is_parallel;
    for (int k = 0; k < 3; ++k) {
      const btVector3 along = corner[(k + 1) % 3] - corner[k];
      is_above = is_above && along.cross(centre - corner[k]).dot(normal) > 0;
    }
    return is_above;
  }
  const auto* faces = static_cast<const btPolyhedralConvexShape*>(shape)->getConvexPolyhedron();
  if (!faces) return false;
  for (int k = 0; k < faces->m_faces.size(); ++k) {
    const btScalar* plane = faces->m_faces[k].m_plane;
    const btVector3 normal(plane[0], plane[1], plane[2]);
    if (std::abs(axis.dot(normal)) > is_parallel && normal.dot(centre) + plane[3] > 0) return true;
  }
  return false;
}

bool lies_on_end(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b) {
  return (has_end(a.getCollisionShape()->getShapeType()) && faces_end(a, b)) ||
         (has_end(b.getCollisionShape()->getShapeType()) && faces_end(b, a));
}

/// Two convex shapes, or one and a triangle. Faces are clipped against a triangle as large as the
/// body, which touches it in one point otherwise, and would rock. That looks at all pairs of edges:
/// a body of many faces is nearly round, and on many small triangles each one has a point.
class Pair final : public btConvexConvexAlgorithm {
 public:
  using btConvexConvexAlgorithm::btConvexConvexAlgorithm;

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo& info, btManifoldResult* result) override {
    btDispatcherInfo clipping = info;
    clipping.m_enableSatConvex = clips(a->getCollisionShape(), b->getCollisionShape());
    btConvexConvexAlgorithm::processCollision(a, b, clipping, result);
  }

 private:
  static bool clips(const btCollisionShape* shape, const btCollisionShape* other) {
    constexpr int max_faces = 256;
    if (other->getShapeType() != TRIANGLE_SHAPE_PROXYTYPE || !shape->isPolyhedral()) return false;
    const auto* body = static_cast<const btPolyhedralConvexShape*>(shape)->getConvexPolyhedron();
    if (!body || body->m_faces.size() > max_faces) return false;
    const btVector3* corner = static_cast<const btTriangleShape*>(other)->m_vertices1;
    const double edge = std::max({corner[0].distance(corner[1]), corner[1].distance(corner[2]),
                                  corner[2].distance(corner[0])});
    return edge > shape->getAngularMotionDisc();
  }
};

/// The face that has the place of a contact whose normal is of none of them, and of no ridge
/// between two; nothing where it is, or where the contact is from behind.
const Face* hidden_by(const std::vector<Face>& faces, const Vec3d& normal) {
  constexpr double near = 1e-4, behind = -0.5;
  if (faces.empty() || normal.dot(faces[0].normal) < behind) return nullptr;
  const Face* best = &faces[0];
  for (const Face& face : faces) {
    if (normal.dot(face.normal) > normal.dot(best->normal)) best = &face;
    for (const Face& next : faces) {
      const double both = face.normal.dot(next.normal);
      const bool is_ridge = face.normal.dot(next.middle - face.middle) < 0;
      if (is_ridge && std::min(normal.dot(face.normal), normal.dot(next.normal)) > both - near)
        return nullptr;
    }
  }
  return normal.dot(best->normal) > 1 - near ? nullptr : best;
}

}  // namespace

ContactSearch::ContactSearch() : pair_(m_pdSolver) {
  setPlaneConvexMultipointIterations(perturbations, wanted_points);
}

btCollisionAlgorithmCreateFunc* ContactSearch::getCollisionAlgorithmCreateFunc(int a, int b) {
  btCollisionAlgorithmCreateFunc* found =
      btDefaultCollisionConfiguration::getCollisionAlgorithmCreateFunc(a, b);
  return found == m_convexConvexCreateFunc ? &pair_ : found;
}

btCollisionAlgorithm* ContactSearch::CreatePair::CreateCollisionAlgorithm(
    btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
    const btCollisionObjectWrapper* b) {
  return new (info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(Pair)))
      Pair(info.m_manifold, info, a, b, m_pdSolver, lies_on_end(*a, *b) ? perturbations : 0,
           wanted_points);
}

void turn_to_face(const RigidShape& shape, bool is_first, const btPersistentManifold& manifold,
                  btManifoldPoint& point) {
  const btTransform& at =
      (is_first ? manifold.getBody0() : manifold.getBody1())->getWorldTransform();
  btVector3& own = is_first ? point.m_positionWorldOnA : point.m_positionWorldOnB;
  const btVector3& other = is_first ? point.m_positionWorldOnB : point.m_positionWorldOnA;
  const double side = is_first ? -1 : 1;
  const std::vector<Face> faces =
      shape.faces_at(is_first ? point.m_index0 : point.m_index1, from_bullet(at.invXform(own)),
                     manifold.getContactBreakingThreshold() + std::abs(point.getDistance()));
  const Vec3d normal =
      side * (from_bullet(at.getBasis()).transpose() * from_bullet(point.m_normalWorldOnB));
  const Face* face = hidden_by(faces, normal);
  if (!face) return;
  const Vec3d body = from_bullet(at.invXform(other));
  const double gap = face->normal.dot(body - face->middle);
  point.m_normalWorldOnB = side * (at.getBasis() * to_bullet(face->normal));
  point.setDistance(gap);
  own = at * to_bullet(Vec3d(body - gap * face->normal));
}

}  // namespace neve::sim::rigid
