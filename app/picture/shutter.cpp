#include "app/picture/shutter.h"

#include <algorithm>
#include <cmath>

#include "app/picture/collider_looks.h"
#include "render/frame/view.h"
#include "sim/base/hash.h"

namespace neve::app::picture {

namespace {

using render::channels::Thing;

/// Moves the colliders and the camera of a frame to another time.
void move_solids(const MotionSource& source, double seconds, render::Frame& frame) {
  const float spacing = !frame.grounds.empty()         ? frame.grounds.front().line_spacing
                        : !frame.ghost_grounds.empty() ? frame.ghost_grounds.front().line_spacing
                                                       : 1.0f;
  render::Frame moved;
  add_colliders(source.scene, source.view, source.snapshot.time + seconds, spacing, moved);
  frame.meshes = std::move(moved.meshes);
  frame.grounds = std::move(moved.grounds);
  frame.ghosts = std::move(moved.ghosts);
  frame.ghost_grounds = std::move(moved.ghost_grounds);
  frame.camera = camera_after(source, seconds);
}

/// Where a particle is between two moments, 0 to 1: another one for each, and the same in all
/// frames.
float phase_of(std::uint32_t id) {
  return static_cast<float>(hash_bytes(&id, sizeof id) >> 40) * 0x1p-24f;
}

/// The time at which a share of the light has arrived, from the middle of the exposure, in
/// shutters. The shutter opens and closes slowly: streaks of grains along an edge would end
/// together, and look like bristles.
double time_of_share(double share) {
  constexpr double ramp = 0.5;  // shutters; half of it is before the nominal opening
  const double width = 1 + ramp;
  const double time = share < 0.5 * ramp       ? std::sqrt(2 * ramp * share)
                      : share > 1 - 0.5 * ramp ? width - std::sqrt(2 * ramp * (1 - share))
                                               : share + 0.5 * ramp;
  return time - 0.5 * width;
}

/// A number of the sequence of van der Corput, 0 to 1: any first ones are all over the interval.
/// Source: van der Corput 1935; two bases together are Halton's points.
double radical_inverse(int n, int base) {
  double value = 0, digit = 1;
  for (; n > 0; n /= base) value += (digit /= base) * (n % base);
  return value;
}

/// Turns a camera by parts of a pixel.
void turn_by_pixels(double right, double up, render::Frame& frame) {
  render::Camera& camera = frame.camera;
  const render::View view = make_view(camera, frame.width, frame.height);
  const float pixel = length(camera.target - camera.eye) / view.pixels_per_slope;
  camera.target =
      camera.target +
      (view.right * static_cast<float>(right) + view.up * static_cast<float>(up)) * pixel;
}

/// Pixels that anything moves by in the picture while the shutter is open.
float largest_motion(const MotionSource& source, const render::Frame& frame,
                     const std::vector<Vec3f>& velocity, double open) {
  const auto view_at = [&](double seconds) {
    return make_view(camera_after(source, seconds), frame.width, frame.height);
  };
  const render::View before = view_at(-0.5 * open), after = view_at(0.5 * open);
  float largest = 0;
  const auto take = [&](Vec3f a, Vec3f b) {
    const Vec3f from = before.project(a), to = after.project(b);
    const auto is_inside = [&](Vec3f p) {
      return p.z > 0 && p.x >= 0 && p.y >= 0 && p.x <= static_cast<float>(frame.width) &&
             p.y <= static_cast<float>(frame.height);
    };
    if (is_inside(from) || is_inside(to))
      largest = std::max(largest, std::hypot(to.x - from.x, to.y - from.y));
  };
  const auto half = static_cast<float>(0.5 * open);
  for (std::size_t p = 0; p < frame.points.position.size(); ++p)
    take(frame.points.position[p] - velocity[p] * half,
         frame.points.position[p] + velocity[p] * half);
  const std::vector<Thing> things = moving_meshes(source, 0.5 * open);
  for (std::size_t m = 0; m < things.size(); ++m)
    for (const Vec3f& p : frame.meshes[m].position) take(things[m].before(p), things[m].after(p));
  return largest;
}

}  // namespace

std::vector<render::Frame> shutter_moments(const MotionSource& source, const render::Frame& frame,
                                           double degrees) {
  const double open = degrees / 360 / source.scene.fps;
  const std::vector<Vec3f> velocity = velocities(source, frame.points.id);
  const std::vector<Vec3f> cut_velocity =
      frame.points.cut ? velocities(source, frame.points.cut->id) : std::vector<Vec3f>{};
  const float pixels = largest_motion(source, frame, velocity, open);
  std::vector<render::Frame> moments;
  if (!(pixels >= 0.5f)) return moments;
  const int count = std::clamp(static_cast<int>(std::ceil(pixels)), 2, max_moments);
  for (int k = 0; k < count; ++k) {
    render::Frame& moment = moments.emplace_back(frame);
    move_solids(source, open * time_of_share((k + 0.5) / count), moment);
    const auto move = [&](const std::vector<Vec3f>& by, auto& points) {
      std::vector<Vec3f>& position = points.position.edit();
      for (std::size_t p = 0; p < by.size(); ++p) {
        const double share = (k + static_cast<double>(phase_of(points.id[p]))) / count;
        position[p] = position[p] + by[p] * static_cast<float>(open * time_of_share(share));
      }
    };
    move(velocity, moment.points);
    if (moment.points.cut) move(cut_velocity, *moment.points.cut);
  }
  return moments;
}

std::vector<render::Frame> with_shared_samples(std::vector<render::Frame> moments) {
  constexpr std::size_t enough = 8;
  if (moments.size() < enough) return moments;
  int n = 0;
  for (render::Frame& moment : moments) {
    if (moment.supersampling == 1) return moments;
    moment.supersampling = 1;
    if (moment.smoke.samples_per_ray > 0) moment.smoke.samples_per_ray = 1;
    ++n;
    turn_by_pixels(radical_inverse(n, 2) - 0.5, radical_inverse(n, 3) - 0.5, moment);
  }
  return moments;
}

}  // namespace neve::app::picture
