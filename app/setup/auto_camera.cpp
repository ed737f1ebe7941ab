#include "app/setup/auto_camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "app/setup/camera_path.h"
#include "app/setup/framing.h"
#include "app/setup/push_in.h"
#include "app/setup/snow_pieces.h"
#include "app/support/round_number.h"

namespace neve::app::setup {

namespace {

using sim::Vec3d;

constexpr double filled = 0.62;  // share of the picture that the subject takes
constexpr double filled_by_plane = 0.72;
constexpr double spread = 1.7;     // snow of many small cells scatters wider than its coarse copy
constexpr double outliers = 0.02;  // share of particles that may leave the picture
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
    const Vec3d center = 0.5 * (box.min + box.max);
    for (const Vec3d& corner : corners(box.min, box.max))
      points.push_back(center + room * (corner - center));
  };
  for (const sim::seeding::Body& body : scene.bodies)
    if (body.name == name) add(sim::shapes::bounds(body.shape));
  for (const sim::shapes::Collider& collider : scene.colliders)
    if (points.empty() && collider.name == name) add(sim::shapes::bounds_at(collider, 0));
  return points;
}

/// Bodies and emitters before the first step.
Box start_of(const scene::Scene& scene) {
  std::vector<Vec3d> points;
  for (const SnowPiece& piece : snow_places(scene)) {
    const sim::shapes::Bounds bounds = sim::shapes::bounds(*piece.shape);
    points.push_back(bounds.min);
    points.push_back(bounds.max);
  }
  return box_of(points);
}

/// Everything that should be seen at some time.
std::vector<Vec3d> subject(const scene::Scene& scene, const std::vector<CoarseMoment>& moments) {
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

/// What snow moves is as much the subject, until it is so far away that all else would be small.
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
    const Vec3d up = plane->normal.normalized();
    if (up.y() < 0.9) continue;
    for (const Vec3d& corner : corners(box.min, box.max)) {
      const double height = (corner - plane->point).dot(up);
      if (height > 0 && height < box.diagonal()) points.push_back(corner - height * up);
    }
  }
}

/// The points laid into a plane through their middle: snow before and behind it is not seen.
std::vector<Vec3d> flattened(std::vector<Vec3d> points, const Vec3d& normal) {
  const Vec3d middle = median(points);
  for (Vec3d& x : points) x -= normal.dot(x - middle) * normal;
  return points;
}

/// Degrees about y, from +z towards +x, that look across the longer horizontal side.
double best_azimuth(const std::vector<Vec3d>& points) {
  Vec3d mean = Vec3d::Zero();
  for (const Vec3d& x : points) mean += x / static_cast<double>(points.size());
  double xx = 0, zz = 0, xz = 0;
  for (const Vec3d& point : points) {
    const Vec3d q = point - mean;
    xx += q.x() * q.x(), zz += q.z() * q.z(), xz += q.x() * q.z();
  }
  const double root = std::hypot(xx - zz, 2 * xz);
  const bool is_long = xx + zz + root > 2 * (xx + zz - root);
  if (!is_long) return 30;
  // The axis makes this angle with +x; the camera looks across it, turned a little for depth.
  const double axis = 0.5 * std::atan2(2 * xz, xx - zz) * 180 / std::numbers::pi;
  double azimuth = -axis;
  if (azimuth > 90) azimuth -= 180;
  if (azimuth < -90) azimuth += 180;
  return azimuth + 20;
}

Vec3d direction(double azimuth, double elevation) {
  const double a = radians(azimuth), e = radians(elevation);
  return {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
}

/// Degrees; arrows seen exactly from the front have no depth.
constexpr double askew = 7;

double azimuth_of(const Vec3d& normal) {
  return std::atan2(normal.x(), normal.z()) * 180 / std::numbers::pi;
}

/// Angles of the camera, in steps so small that nothing leaves the picture between them.
std::vector<double> turns_of(const scene::CameraSettings& settings, double duration) {
  constexpr double step = 20;
  const double all = std::clamp(turned(settings, duration, duration), -360.0, 360.0);
  const int count = static_cast<int>(std::ceil(std::abs(all) / step));
  std::vector<double> turns{0};
  for (int k = 1; k <= count; ++k) turns.push_back(all * k / count);
  return turns;
}

/// When to look where planes are: keyframes may move and tilt them.
std::vector<double> times_of(const sim::shapes::Collider& collider, double duration) {
  constexpr int parts = 12;
  if (collider.keyframes.empty()) return {0};
  std::vector<double> times;
  for (int k = 0; k <= parts; ++k) times.push_back(duration * k / parts);
  return times;
}

/// True if the eye is well above a terrain and nothing of it is between the eye and its target.
bool is_clear_of_terrain(const sim::shapes::Collider& terrain, const Framing& framing,
                         const Vec3d& eye) {
  constexpr int looks = 32;
  if (sim::shapes::signed_distance(terrain, 0, eye) < 0.08 * framing.distance) return false;
  for (int k = looks / 4; k < looks; ++k)
    if (sim::shapes::signed_distance(terrain, 0,
                                     framing.target + (eye - framing.target) * k / looks) < 0)
      return false;
  return true;
}

/// True if no plane is between the eye and its target.
bool is_clear_at(const scene::Scene& scene, const Framing& framing, const Vec3d& towards_eye) {
  const Vec3d eye = framing.target + framing.distance * towards_eye;
  return std::all_of(scene.colliders.begin(), scene.colliders.end(), [&](const auto& collider) {
    if (std::holds_alternative<sim::shapes::Terrain>(collider.shape.form))
      return is_clear_of_terrain(collider, framing, eye);
    const auto* plane = std::get_if<sim::shapes::Plane>(&collider.shape.form);
    if (!plane) return true;
    const std::vector<double> times = times_of(collider, scene::duration(scene));
    return std::all_of(times.begin(), times.end(), [&](double time) {
      const sim::shapes::Pose pose = sim::shapes::pose_at(collider, time);
      const Vec3d normal = (pose.rotation * plane->normal).normalized();
      return (eye - pose.point).dot(normal) > 0.08 * framing.distance;
    });
  });
}

bool is_clear(const scene::Scene& scene, const Framing& framing, const Vec3d& towards_eye,
              const Lens& lens) {
  return std::all_of(lens.turns.begin(), lens.turns.end(), [&](double turn) {
    return is_clear_at(scene, framing, turn_about(lens.up, turn, towards_eye));
  });
}

struct Place {
  Vec3d eye, target;
};

/// In round numbers.
/// @param origin  what both are relative to
Place rounded_place(const Framing& framing, const Vec3d& towards_eye, const Vec3d& origin) {
  Place place{framing.target + framing.distance * towards_eye - origin, framing.target - origin};
  for (int axis = 0; axis < 3; ++axis) {
    place.target[axis] = round_to(place.target[axis], framing.distance, 3);
    place.eye[axis] = round_to(place.eye[axis], framing.distance, 3);
  }
  return place;
}

/// The move to the settled snow as two keyframes, unless the way there is not clear.
void add_push_in(const scene::Scene& scene, const std::vector<CoarseMoment>& moments,
                 const Shot& whole, const Lens& lens, scene::CameraSettings& camera) {
  const std::optional<PushIn> move = push_in(moments, whole, lens, scene::duration(scene));
  if (!move) return;
  for (const double part : {0.25, 0.5, 0.75, 1.0})
    if (!is_clear(scene, between(whole.framing, move->framing, part), whole.towards_eye, lens))
      return;
  const Place place = rounded_place(move->framing, whole.towards_eye, Vec3d::Zero());
  camera.keyframes = {{move->begin, camera.eye, camera.target, {}},
                      {move->end, place.eye, place.target, {}}};
}

}  // namespace

scene::CameraSettings automatic_camera(const scene::Scene& scene,
                                       const std::vector<CoarseMoment>& moments,
                                       const scene::CameraSettings& settings, double aspect,
                                       const std::optional<Vec3d>& normal) {
  const bool is_following = !settings.follow.empty();
  std::vector<Vec3d> points =
      is_following ? followed(scene, settings.follow) : subject(scene, moments);
  if (!is_following && !normal) points = without_flown(points, start_of(scene));
  if (!is_following) add_small_colliders(scene, points);
  if (!is_following) add_bodies(moments, points);
  // On a plane there is room for the few that fly, since those beside it are not seen.
  const bool is_upright = normal && std::abs(normal->normalized().y()) < 0.1;
  if (is_upright && !is_following) add_floor(scene, points);
  if (normal) points = flattened(points, normal->normalized());
  const Lens lens{settings.up.normalized(), std::tan(radians(settings.fov / 2)), aspect,
                  normal ? filled_by_plane : filled, turns_of(settings, scene::duration(scene))};

  const double preferred = normal ? azimuth_of(*normal) + askew : best_azimuth(points);
  const Vec3d middle = box_of(points).center();
  points = turned_backwards(points, middle, lens);
  // A level plane is looked at from well above it.
  const bool is_level = normal && std::abs(normal->normalized().y()) > 0.7;
  Vec3d towards_eye = direction(preferred, is_level ? 60 : normal ? askew : 14);
  Framing framing = fit(points, middle, towards_eye, lens);
  bool is_found = is_clear(scene, framing, towards_eye, lens);
  for (const double elevation : {14.0, 30.0, 50.0, -14.0})
    for (const double turn : {0.0, -40.0, 150.0, 180.0, 70.0, -110.0}) {
      if (is_found) break;
      const Vec3d candidate = direction(preferred + turn, elevation);
      const Framing fitted = fit(points, middle, candidate, lens);
      if (!is_clear(scene, fitted, candidate, lens)) continue;
      towards_eye = candidate, framing = fitted, is_found = true;
    }

  scene::CameraSettings camera = settings;
  const Vec3d origin = is_following ? middle : Vec3d::Zero();
  const Place place = rounded_place(framing, towards_eye, origin);
  camera.eye = place.eye;
  camera.target = place.target;
  if (settings.push_in && !normal)
    add_push_in(scene, moments, {framing, towards_eye}, lens, camera);
  camera.push_in = false;
  return camera;
}

}  // namespace neve::app::setup
