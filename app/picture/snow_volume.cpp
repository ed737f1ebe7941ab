#include "app/picture/snow_volume.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "app/picture/collider_looks.h"
#include "app/picture/to_float.h"
#include "sim/shapes/collider.h"
#include "sim/shapes/height_field.h"

namespace neve::app::picture {

namespace {

/// Volume of the loosest snow that is a solid, over its volume at rest: a share of the surface's
/// level is left of it then.
constexpr double loosest = 2;

using sim::Vec3d;

/// A collider at a moment.
class Solid {
 public:
  /// @param reach  m, from where it matters
  Solid(const scene::Collider& collider, double time, double reach)
      : collider_(collider),
        time_(time),
        reach_(reach),
        box_(sim::shapes::bounds_at(collider, time)),
        pose_(sim::shapes::pose_at(collider, time)) {
    if (const auto* terrain = std::get_if<sim::shapes::Terrain>(&collider.shape.form))
      field_ = sim::shapes::height_field(*terrain);
  }

  /// m, from a place near it to its surface; 0: it is far, inside, or its mirror image would not be
  /// as deep in the solid as the place is above it.
  Vec3d way_from(const Vec3d& x) const {
    if (field_) return way_to_terrain(x);
    if (((box_.min - x).array() > reach_).any() || ((x - box_.max).array() > reach_).any())
      return Vec3d::Zero();
    const sim::shapes::Surface surface = sim::shapes::surface_at(collider_, time_, x);
    if (!(surface.distance > 0 && surface.distance < reach_)) return Vec3d::Zero();
    const Vec3d way = -surface.distance * surface.normal;
    constexpr double as_deep = 0.98;
    return sim::shapes::signed_distance(collider_, time_, x + 2 * way) < -as_deep * way.norm()
               ? way
               : Vec3d::Zero();
  }

 private:
  Vec3d way_to_terrain(const Vec3d& x) const {
    const Vec3d y = pose_.rotation.transpose() * (x - pose_.point);
    const auto place = field_->at(y.x(), y.z());
    const double distance = place ? (y.y() - place->height) * place->normal.y() : -1;
    if (!(distance > 0 && distance < reach_)) return Vec3d::Zero();
    return pose_.rotation * (-distance * place->normal);
  }

  const scene::Collider& collider_;
  double time_, reach_;
  sim::shapes::Bounds box_;
  sim::shapes::Pose pose_;
  std::shared_ptr<const sim::shapes::HeightField> field_;  ///< of a terrain
};

/// The nearest of several.
template <class List>
void find_ways(const std::vector<Solid>& solids, List& points) {
  std::vector<Vec3f>& ways = points.to_solid.edit();
  ways.assign(points.position.size(), {});
  for (std::size_t p = 0; p < ways.size(); ++p) {
    const Vec3f& at = points.position[p];
    Vec3d nearest = Vec3d::Zero();
    for (const Solid& solid : solids) {
      const Vec3d way = solid.way_from(Vec3d(at.x, at.y, at.z));
      if (way.norm() > 0 && (nearest.norm() == 0 || way.norm() < nearest.norm())) nearest = way;
    }
    ways[p] = to_float(nearest);
  }
}

}  // namespace

double snow_volume(const scene::Scene& scene, const sim::ParticleArrays& particles, std::size_t p) {
  const double J = particles.F_E[p].determinant() * particles.J_P[p];
  const double at_rest = particles.m[p] / scene.materials[particles.material[p]].density;
  return at_rest * std::min(J, loosest);
}

void find_solids_below(const scene::Scene& scene, const scene::View& view, double time,
                       render::Points& points) {
  const double reach = static_cast<double>(render::mirror_reach * points.spacing);
  std::vector<Solid> solids;
  for (const scene::Collider& collider : scene.colliders)
    if (!std::holds_alternative<sim::shapes::Plane>(collider.shape.form) && hides(collider.style) &&
        scene::has_layer(view, layer_of(collider)))
      solids.emplace_back(collider, time, reach);
  if (solids.empty()) return;
  find_ways(solids, points);
  if (points.cut) find_ways(solids, *points.cut);
}

}  // namespace neve::app::picture
