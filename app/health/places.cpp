#include "app/health/places.h"

#include <algorithm>

#include "sim/shapes/deforming_mesh.h"

namespace neve::app::health {

using sim::Vec3d;

std::vector<Vec3d> places_in(const sim::shapes::Shape& shape) {
  constexpr int parts = 12;  // even: a plane through the middle has a half on either side
  std::vector<Vec3d> places;
  const sim::shapes::Solid solid(shape);
  const sim::shapes::Bounds box = solid.bounds();
  for (int i = 0; i < parts; ++i)
    for (int j = 0; j < parts; ++j)
      for (int k = 0; k < parts; ++k) {
        const Vec3d part = (Vec3d(i, j, k) + Vec3d::Constant(0.5)) / parts;
        const Vec3d x = box.min + part.cwiseProduct(box.max - box.min);
        if (solid.contains(x)) places.push_back(x);
      }
  return places;
}

double share_inside(const std::vector<Vec3d>& places, const sim::shapes::Collider& collider,
                    double time) {
  if (places.empty()) return 0;
  const Inside is_inside(collider, time);
  const auto inside =
      std::count_if(places.begin(), places.end(), [&](const Vec3d& x) { return is_inside(x); });
  return static_cast<double>(inside) / static_cast<double>(places.size());
}

Inside::Inside(const sim::shapes::Collider& collider, double time)
    : pose_(sim::shapes::pose_at(collider, time)),
      start_(sim::rotation_from_degrees(collider.shape.rotation)),
      center_(sim::shapes::center(collider.shape)) {
  if (const auto* plane = std::get_if<sim::shapes::Plane>(&collider.shape.form))
    normal_ = pose_.rotation * plane->normal;
  else if (const auto* sequence = std::get_if<sim::shapes::MeshSequence>(&collider.shape.form))
    surface_ = sim::shapes::surface_at(*sequence, sim::shapes::shape_time(collider, time));
  else
    solid_ = std::make_unique<sim::shapes::Solid>(collider.shape);
}

bool Inside::operator()(const Vec3d& x) const {
  if (surface_) return surface_->contains(pose_.rotation.transpose() * (x - pose_.point));
  if (!solid_) return (x - pose_.point).dot(normal_) < 0;
  // Keyframes may have moved it: where the place is from the shape as it is written.
  return solid_->contains(center_ + start_ * (pose_.rotation.transpose() * (x - pose_.point)));
}

}  // namespace neve::app::health
