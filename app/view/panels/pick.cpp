#include "app/view/panels/pick.h"

#include <cmath>
#include <limits>

#include "app/picture/cut.h"

namespace neve::app::view::panels {

namespace {

using sim::Vec3d;

/// Particles are small: this much of the picture's height beside them still hits.
constexpr double reach = 0.006;

}  // namespace

std::optional<std::size_t> pick_particle(const Orbit& orbit, double x, double y,
                                         const session::LiveFrame& live,
                                         const std::optional<scene::ClipPlane>& clip) {
  const Vec3d eye = orbit.eye(), ray = orbit.ray(x, y);
  const double radius = 0.6 * live.seeded->spacing;
  std::optional<std::size_t> hit;
  double nearest = std::numeric_limits<double>::infinity();
  const std::vector<Vec3d>& places = live.snapshot.particles.x;
  const picture::Cut cut(clip, places);
  for (std::size_t p = 0; p < places.size(); ++p) {
    if (!places[p].allFinite() || cut.removes(places[p])) continue;
    const Vec3d offset = places[p] - eye;
    const double along = offset.dot(ray);
    if (!(along > 0) || along >= nearest) continue;
    const double wide = std::max(radius, reach * along * 2 * std::tan(orbit.fov() * 0.00872665));
    if ((offset - along * ray).squaredNorm() > wide * wide) continue;
    nearest = along;
    hit = p;
  }
  return hit;
}

namespace {

/// m, along the ray to a collider. A sphere around a place that reaches to the surface has nothing
/// of it inside.
std::optional<double> distance_along(const sim::shapes::Collider& collider, double time,
                                     const Vec3d& eye, const Vec3d& ray, double most) {
  constexpr int max_looks = 200;
  double along = 0;
  for (int look = 0; look < max_looks && along < most; ++look) {
    const double distance = sim::shapes::signed_distance(collider, time, eye + along * ray);
    if (!std::isfinite(distance)) return std::nullopt;
    if (distance < 1e-4 * most) return along;
    along += distance;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Vec3d> pick_surface(const Orbit& orbit, double x, double y,
                                  const session::LiveFrame& live) {
  const Vec3d eye = orbit.eye(), ray = orbit.ray(x, y);
  constexpr double furthest = 20;  // times as far as what is looked at
  double most = furthest * orbit.distance();
  bool is_hit = false;
  if (const auto particle = pick_particle(orbit, x, y, live)) {
    most = (live.snapshot.particles.x[*particle] - eye).dot(ray);
    is_hit = true;
  }
  for (const sim::shapes::Collider& collider : live.scene->colliders)
    if (const auto along = distance_along(collider, live.snapshot.time, eye, ray, most)) {
      most = *along;
      is_hit = true;
    }
  return is_hit ? std::optional(Vec3d(eye + most * ray)) : std::nullopt;
}

std::optional<Vec3d> pick_plane(const Orbit& orbit, double x, double y,
                                const picture::SlicePlane& plane) {
  const Vec3d eye = orbit.eye(), ray = orbit.ray(x, y);
  const double across = ray.dot(plane.normal);
  if (std::abs(across) < 1e-9) return std::nullopt;
  const double along = (plane.point - eye).dot(plane.normal) / across;
  if (!(along > 0)) return std::nullopt;
  return Vec3d(eye + along * ray);
}

}  // namespace neve::app::view::panels
