#include "app/picture/snow_volume.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "app/picture/collider_looks.h"
#include "app/picture/to_float.h"
#include "sim/shapes/collider.h"

namespace neve::app::picture {

namespace {

/// Volume of the loosest snow that is a solid, over its volume at rest: a share of the surface's
/// level is left of it then.
constexpr double loosest = 2;

using sim::Vec3d;

/// A collider that snow may rest on.
class Solid {
 public:
  /// @param reach  m, from where it matters
  Solid(const scene::Collider& collider, double time, double reach)
      : at_(collider, time),
        box_(sim::shapes::bounds_at(collider, time)),
        is_terrain_(std::holds_alternative<sim::shapes::Terrain>(collider.shape.form)),
        reach_(reach) {}

  /// m, from a place near it to its surface; 0: it is far, inside, or its mirror image would not be
  /// as deep in the solid as the place is above it. Terrain has any depth, beyond its posts too.
  Vec3d way_from(const Vec3d& x) const {
    const bool is_beyond_box =
        ((box_.min - x).array() > reach_).any() || ((x - box_.max).array() > reach_).any();
    if (is_beyond_box && !is_terrain_) return Vec3d::Zero();
    const sim::shapes::Surface surface = at_.surface(x);
    if (!(surface.distance > 0 && surface.distance < reach_)) return Vec3d::Zero();
    const Vec3d way = -surface.distance * surface.normal;
    constexpr double as_deep = 0.98;
    return is_terrain_ || at_.surface(x + 2 * way).distance < -as_deep * way.norm() ? way
                                                                                    : Vec3d::Zero();
  }

 private:
  sim::shapes::ColliderAt at_;
  sim::shapes::Bounds box_;
  bool is_terrain_;
  double reach_;
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
