#include "app/setup/subject.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/setup/framing.h"
#include "app/setup/snow_pieces.h"

namespace neve::app::setup {

namespace {

using sim::Vec3d;

constexpr double spread = 1.7;     // snow of many small cells scatters wider than its coarse copy
constexpr double outliers = 0.02;  // share of particles that may leave the picture
constexpr double crumbs = 0.1;     // share that is no part of the heap that it lies around
constexpr double loose = 0.4;      // share outside of what has to stay in the picture
constexpr double largest_growth = 16;  // of the subject's size: snow that falls for ever is let go
// A small part of the snow that flies away is let go where the picture would have to grow so much
// for it; the rest is the subject.
constexpr double growth_for_few = 2.2, share_of_few = 0.45;

/// Share of the way to the corners of a box: about the extent of a sphere in it.
constexpr double towards_sphere = 0.8;

std::array<Vec3d, 8> corners(const Vec3d& min, const Vec3d& max) {
  std::array<Vec3d, 8> result;
  for (unsigned k = 0; k < 8; ++k)
    result[k] = {k & 1 ? max.x() : min.x(), k & 2 ? max.y() : min.y(), k & 4 ? max.z() : min.z()};
  return result;
}

/// The snow that stays within its own size of where all of it was, if most of it does and the rest
/// would make it small in the picture; otherwise all of it.
std::vector<Vec3d> without_flown(const std::vector<Vec3d>& points, const Box& start) {
  const Vec3d reach = Vec3d::Constant(start.diagonal());
  std::vector<Vec3d> near;
  for (const Vec3d& x : points)
    if (((x - start.min + reach).array() >= 0).all() &&
        ((start.max + reach - x).array() >= 0).all())
      near.push_back(x);
  const double far_share = 1 - static_cast<double>(near.size()) /
                                   static_cast<double>(std::max<std::size_t>(1, points.size()));
  const bool is_few = far_share > 0 && far_share < share_of_few;
  const bool is_large = box_of(points).diagonal() > growth_for_few * box_of(near).diagonal();
  return is_few && is_large ? near : points;
}

/// The start of what the camera moves along with, and room for it to burst.
std::vector<Vec3d> followed(const scene::Scene& scene, const std::string& name) {
  constexpr double room = 1.6;
  std::vector<Vec3d> points;
  const auto add = [&](const sim::shapes::Bounds& box) {
    for (const Vec3d& corner : corners(box.min, box.max))
      points.push_back(box.center() + room * (corner - box.center()));
  };
  for (const sim::seeding::Body& body : scene.bodies)
    if (body.name == name) add(sim::shapes::bounds(body.shape));
  for (const sim::shapes::Collider& collider : scene.colliders)
    if (points.empty() && collider.name == name) add(sim::shapes::bounds_at(collider, 0));
  return points;
}

/// Bodies and emitters before the first step.
Box start_of(const scene::Scene& scene) {
  Box box;
  for (const SnowPiece& piece : snow_places(scene)) box.add(sim::shapes::bounds(*piece.shape));
  return box;
}

/// Everything that should be seen at some time.
std::vector<Vec3d> whole_fall(const scene::Scene& scene, const std::vector<CoarseMoment>& moments) {
  const Box start = start_of(scene);
  std::vector<Vec3d> points{start.min, start.max};
  const double first_size = std::max(start.diagonal(), 1e-6);
  Box seen;
  for (const CoarseMoment& moment : moments) {
    const std::vector<Vec3d> kept =
        moment.time > 0 ? scattered(without_outliers(moment.x, outliers), spread) : moment.x;
    Box grown = seen;
    for (const Vec3d& x : kept) grown.add(x);
    if (moment.time > 0 && grown.diagonal() > largest_growth * first_size) break;
    seen = grown;
    points.insert(points.end(), kept.begin(), kept.end());
  }
  return points;
}

/// Obstacles that the snow meets belong in the picture unless they would dwarf it.
void add_small_colliders(const scene::Scene& scene, std::vector<Vec3d>& points) {
  const Box snow = box_of(points);
  const Vec3d margin = Vec3d::Constant(0.25 * snow.diagonal());
  for (const sim::shapes::Collider& collider : scene.colliders) {
    if (std::holds_alternative<sim::shapes::Plane>(collider.shape.form) ||
        std::holds_alternative<sim::shapes::Terrain>(collider.shape.form))
      continue;
    const sim::shapes::Bounds bounds = sim::shapes::bounds_at(collider, 0);
    const bool is_near = ((bounds.min - margin).array() <= snow.max.array()).all() &&
                         ((bounds.max + margin).array() >= snow.min.array()).all();
    if (!is_near || (bounds.max - bounds.min).norm() > 1.5 * snow.diagonal()) continue;
    const Vec3d center = 0.5 * (bounds.min + bounds.max),
                half = towards_sphere * (bounds.max - center);
    for (const Vec3d& corner : corners(center - half, center + half)) points.push_back(corner);
  }
}

/// Adds bodies that snow moves, unless they are so far away that all else would be small.
void add_bodies(const std::vector<CoarseMoment>& moments, std::vector<Vec3d>& points) {
  constexpr double largest_growth_for_bodies = 3;
  const double largest = largest_growth_for_bodies * box_of(points).diagonal();
  Box seen = box_of(points);
  for (const CoarseMoment& moment : moments)
    for (const sim::shapes::Bounds& body : moment.bodies) {
      if (!body.min.allFinite() || !body.max.allFinite()) continue;
      const Vec3d center = 0.5 * (body.min + body.max), half = towards_sphere * (body.max - center);
      Box grown = seen;
      grown.add(center - half);
      grown.add(center + half);
      if (grown.diagonal() > largest) continue;
      seen = grown;
      for (const Vec3d& corner : corners(center - half, center + half)) points.push_back(corner);
    }
}

/// The floor below the subject, unless it is farther below than the subject is large: snow falls
/// there after the coarse run has ended, and what stands on it has its foot in the picture.
void add_floor(const scene::Scene& scene, std::vector<Vec3d>& points) {
  const Box box = box_of(points);
  for (const sim::shapes::Collider& collider : scene.colliders) {
    const auto* plane = std::get_if<sim::shapes::Plane>(&collider.shape.form);
    if (!plane || !collider.keyframes.empty()) continue;
    const sim::shapes::Pose pose = sim::shapes::pose_at(collider, 0);
    const Vec3d up = pose.rotation * plane->normal.normalized();
    if (up.y() < 0.9) continue;
    for (const Vec3d& corner : corners(box.min, box.max)) {
      const double height = (corner - pose.point).dot(up);
      if (height > 0 && height < box.diagonal()) points.push_back(corner - height * up);
    }
  }
}

/// Scatters a coarse copy as snow of many small cells is, without crumbs that have flown off.
std::vector<Vec3d> scattered_core(const std::vector<Vec3d>& x) {
  return scattered(without_outliers(x, crumbs), spread);
}

/// Returns the places of most of the snow at each moment.
std::vector<Vec3d> cores_at_moments(const std::vector<CoarseMoment>& moments) {
  std::vector<Vec3d> points;
  for (const CoarseMoment& moment : moments) {
    const std::vector<Vec3d> core = moment.time > 0 ? scattered_core(moment.x) : moment.x;
    points.insert(points.end(), core.begin(), core.end());
  }
  return points;
}

}  // namespace

std::vector<Vec3d> heap_of(const std::vector<Vec3d>& x) {
  constexpr double settled_spread = 1.25;  // of snow of many small cells, beside its coarse copy
  return scattered(without_outliers(x, crumbs), settled_spread);
}

std::vector<Vec3d> core_of_moment(const scene::Scene& scene, const CoarseMoment& moment) {
  std::vector<Vec3d> points = scattered_core(moment.x);
  if (points.empty()) return points;
  add_small_colliders(scene, points);
  add_bodies({moment}, points);
  return points;
}

std::vector<Vec3d> dense_snow(const scene::Scene& scene, const std::vector<CoarseMoment>& moments) {
  std::vector<Vec3d> points;
  for (const CoarseMoment& moment : moments) {
    const std::vector<Vec3d> dense = without_outliers(moment.x, loose);
    points.insert(points.end(), dense.begin(), dense.end());
  }
  add_small_colliders(scene, points);
  add_bodies(moments, points);
  return points;
}

std::vector<Vec3d> subject_of(const scene::Scene& scene, const std::vector<CoarseMoment>& moments,
                              const std::string& follow, const std::optional<Vec3d>& normal,
                              Shown shown) {
  const bool is_following = !follow.empty();
  std::vector<Vec3d> points;
  if (shown == Shown::moments && !is_following) points = cores_at_moments(moments);
  const bool is_of_moments = !points.empty();
  if (!is_of_moments) points = is_following ? followed(scene, follow) : whole_fall(scene, moments);
  // A view of a plane has room for the few that fly: those beside the plane are not seen.
  if (!is_following && !normal && !is_of_moments) points = without_flown(points, start_of(scene));
  if (!is_following) add_small_colliders(scene, points);
  if (!is_following) add_bodies(moments, points);
  const bool is_upright = normal && std::abs(normal->normalized().y()) < 0.1;
  if (is_upright && !is_following) add_floor(scene, points);
  return points;
}

}  // namespace neve::app::setup
