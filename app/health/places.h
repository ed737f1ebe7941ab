#pragma once
/// Places in shapes, and whether places are in colliders.

#include <memory>
#include <vector>

#include "sim/shapes/collider.h"
#include "sim/shapes/mesh_surface.h"
#include "sim/shapes/solid.h"

namespace neve::app::health {

/// Some hundred places in a shape, regularly.
std::vector<sim::Vec3d> places_in(const sim::shapes::Shape& shape);

/// Share of places that are in a collider at a time; 0 of none.
double share_inside(const std::vector<sim::Vec3d>& places, const sim::shapes::Collider& collider,
                    double time = 0);

/// Tests if a place is in a collider at a time.
class Inside {
 public:
  Inside(const sim::shapes::Collider& collider, double time);
  bool operator()(const sim::Vec3d& x) const;

 private:
  sim::shapes::Pose pose_;
  sim::Mat3d start_;
  sim::Vec3d center_, normal_{0, 1, 0};
  std::unique_ptr<sim::shapes::Solid> solid_;
  std::shared_ptr<const sim::shapes::MeshSurface> surface_;  ///< of a mesh that deforms
};

}  // namespace neve::app::health
