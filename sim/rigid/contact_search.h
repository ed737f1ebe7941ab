#pragma once
/// Contact of bodies with each other, planes and surfaces: Bullet's search and what it leaves out.

#include <BulletCollision/CollisionDispatch/btConvexConvexAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include "sim/rigid/rigid_shape.h"

namespace neve::sim::rigid {

/// Bodies with edges touch in the corners of what two faces share, round ones in one point unless
/// they stand on an end.
class ContactSearch final : public btDefaultCollisionConfiguration {
 public:
  ContactSearch();
  btCollisionAlgorithmCreateFunc* getCollisionAlgorithmCreateFunc(int a, int b) override;

 private:
  struct CreatePair final : btConvexConvexAlgorithm::CreateFunc {
    using btConvexConvexAlgorithm::CreateFunc::CreateFunc;
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override;
  };
  CreatePair pair_;
};

/// A body that passes from face to face of a surface meets the edge of the next one, which its
/// neighbours hide: such contact pushed bodies back that slid over flat ground, or threw them up. A
/// contact whose normal no face and no ridge has gets that of the nearest face.
/// @param shape  of the first or the second of the two that touch
void turn_to_face(const RigidShape& shape, bool is_first, const btPersistentManifold& manifold,
                  btManifoldPoint& point);

}  // namespace neve::sim::rigid
