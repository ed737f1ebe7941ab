#include "app/setup/auto_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/setup/camera_path.h"
#include "app/setup/framing.h"
#include "app/setup/push_in.h"
#include "app/setup/subject.h"
#include "app/support/round_number.h"
#include "sim/rigid/mass.h"

namespace neve::app::setup {

namespace {

using sim::Vec3d;

constexpr double filled = 0.62;  // share of the picture that the subject takes
constexpr double filled_by_plane = 0.72;
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

/// Returns the times at which planes are looked at: keyframes may move and tilt them.
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

/// Comes nearer if the snow of one moment would be small beside that of others: what is thrown far
/// leaves the picture then, not what is dense.
Framing near_the_smallest(const scene::Scene& scene, const std::vector<CoarseMoment>& moments,
                          const Shot& whole, const Lens& lens) {
  constexpr double min_width = 0.36;  // of the picture's; a quarter is what a tile has to have
  double smallest = min_width;
  for (const CoarseMoment& moment : moments) {
    const Extent seen = extent_of(core_of_moment(scene, moment), whole, lens);
    smallest = std::min(smallest, 0.5 * (seen.right - seen.left));
  }
  if (smallest >= min_width) return whole.framing;
  const std::vector<Vec3d> dense = dense_snow(scene, moments);
  const Framing nearest = fit(dense, box_of(dense).center(), whole.towards_eye, lens);
  const double way = whole.framing.distance - nearest.distance;
  if (way <= 0) return whole.framing;
  const double wanted = whole.framing.distance * (1 - smallest / min_width);
  const Framing near = between(whole.framing, nearest, std::min(1.0, wanted / way));
  return is_clear(scene, near, whole.towards_eye, lens) ? near : whole.framing;
}

/// Returns the centre of the body or collider that a camera follows, at the start.
Vec3d place_of(const scene::Scene& scene, const std::string& name) {
  for (const sim::seeding::Body& body : scene.bodies)
    if (body.name == name) {
      sim::shapes::Collider solid;
      solid.shape = body.shape;
      return sim::rigid::centre_at(solid, 0);
    }
  for (const sim::shapes::Collider& collider : scene.colliders)
    if (collider.name == name) return sim::rigid::centre_at(collider, 0);
  return Vec3d::Zero();
}

struct Place {
  Vec3d eye, target;
};

/// Returns the place of a camera in round numbers.
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
                                       const std::optional<Vec3d>& normal, Shown shown) {
  const bool is_following = !settings.follow.empty();
  std::vector<Vec3d> points = subject_of(scene, moments, settings.follow, normal, shown);
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

  if (shown == Shown::moments && !normal && !is_following && !lens.is_turning())
    framing = near_the_smallest(scene, moments, {framing, towards_eye}, lens);

  scene::CameraSettings camera = settings;
  const Vec3d origin = is_following ? place_of(scene, settings.follow) : Vec3d::Zero();
  const Place place = rounded_place(framing, towards_eye, origin);
  camera.eye = place.eye;
  camera.target = place.target;
  if (settings.push_in && !normal)
    add_push_in(scene, moments, {framing, towards_eye}, lens, camera);
  camera.push_in = false;
  camera.found = scene::FoundCamera::place;
  return camera;
}

}  // namespace neve::app::setup
