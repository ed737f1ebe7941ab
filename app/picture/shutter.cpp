#include "app/picture/shutter.h"

#include <algorithm>
#include <cmath>

#include "app/picture/collider_looks.h"
#include "render/frame/ground_place.h"
#include "render/frame/view.h"
#include "sim/base/hash.h"

namespace neve::app::picture {

namespace {

using render::channels::Thing;

/// Moments of which each has one sample of a pixel instead of four: as many take less time than
/// half as many with all samples, and show less noise than can be seen.
constexpr int enough_to_share = 8;

/// Moments for a motion of so many pixels.
int count_of(float pixels, int supersampling) {
  const int count = std::clamp(static_cast<int>(std::ceil(pixels)), 2, max_moments);
  const bool is_dearer = supersampling > 1 && count >= enough_to_share / 2;
  return is_dearer ? std::max(count, enough_to_share) : count;
}

/// The colliders of a frame at another time.
render::Frame colliders_after(const MotionSource& source, double seconds,
                              const render::Frame& frame) {
  const float spacing = !frame.grounds.empty()         ? frame.grounds.front().line_spacing
                        : !frame.ghost_grounds.empty() ? frame.ghost_grounds.front().line_spacing
                                                       : 1.0f;
  render::Frame moved;
  add_colliders(source.scene, source.view, source.snapshot.time + seconds, spacing, moved);
  return moved;
}

/// Moves the colliders and the camera of a frame to another time.
void move_solids(const MotionSource& source, double seconds, render::Frame& frame) {
  render::Frame moved = colliders_after(source, seconds, frame);
  frame.meshes = std::move(moved.meshes);
  frame.grounds = std::move(moved.grounds);
  frame.ghosts = std::move(moved.ghosts);
  frame.ghost_grounds = std::move(moved.ghost_grounds);
  // Wires and edges of ghosts are the first lines of a frame.
  std::ranges::move(moved.lines, frame.lines.begin());
  frame.camera = camera_after(source, seconds);
}

/// Returns the place of a particle between two moments, 0 to 1. It differs from particle to
/// particle, and is the same in all frames.
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

/// Moves labels to where the frame's camera sees them as another one did: words stay sharp.
void keep_labels(const render::Camera& camera, render::Frame& frame) {
  const render::View from = make_view(camera, frame.width, frame.height),
                     to = make_view(frame.camera, frame.width, frame.height);
  for (render::Label& label : frame.labels) {
    const Vec3f ahead = label.position - from.eye;
    label.position = to.eye + to.right * dot(ahead, from.right) + to.up * dot(ahead, from.up) +
                     to.forward * dot(ahead, from.forward);
  }
}

/// Turns a camera by parts of a pixel, and leaves labels where they are in the picture.
void turn_by_pixels(double right, double up, render::Frame& frame) {
  render::Camera& camera = frame.camera;
  const render::Camera before = camera;
  const render::View view = make_view(camera, frame.width, frame.height);
  const float pixel = length(camera.target - camera.eye) / view.pixels_per_slope;
  camera.target =
      camera.target +
      (view.right * static_cast<float>(right) + view.up * static_cast<float>(up)) * pixel;
  keep_labels(before, frame);
}

/// The views of the camera at both ends of an interval.
class Ends {
 public:
  Ends(const MotionSource& source, const render::Frame& frame, double open)
      : width_(static_cast<float>(frame.width)),
        height_(static_cast<float>(frame.height)),
        half_(static_cast<float>(0.5 * open)) {
    const auto view_at = [&](double seconds) {
      return make_view(camera_after(source, seconds), frame.width, frame.height);
    };
    before_ = view_at(-0.5 * open);
    after_ = view_at(0.5 * open);
  }
  /// A way across the picture; none beside it.
  struct Way {
    float pixels = 0, metres = 0;
  };
  Way way(Vec3f before, Vec3f after) const {
    const Vec3f from = before_.project(before), to = after_.project(after);
    if (!is_inside(from) && !is_inside(to)) return {};
    const float pixels = std::hypot(to.x - from.x, to.y - from.y);
    return {pixels, pixels * 0.5f * (from.z + to.z) / before_.pixels_per_slope};
  }
  Way way_of(Vec3f position, Vec3f velocity) const {
    return way(position - velocity * half_, position + velocity * half_);
  }

 private:
  bool is_inside(Vec3f p) const {
    return p.z > 0 && p.x >= 0 && p.y >= 0 && p.x <= width_ && p.y <= height_;
  }
  float width_, height_, half_;
  render::View before_, after_;
};

/// Pixels that what is seen of a ground moves by, where it has not faded out.
float ground_motion(const Ends& ends, const render::Frame& frame, render::GroundPlane ground,
                    const Thing& thing, bool is_ghost) {
  constexpr int parts = 16;       // of each side of the picture
  constexpr float has_faded = 2;  // fade distances
  const render::View view = make_view(frame.camera, frame.width, frame.height);
  if (!render::is_seen_from_above(ground, view)) {
    if (!is_ghost) return 0;
    ground.normal = -ground.normal;
  }
  const render::GroundPlace place = place_ground(ground, frame, view);
  const float height = dot(place.point, place.normal);
  const auto slope = [&](int part, int side) {
    return (static_cast<float>(part) / parts - 0.5f) * static_cast<float>(side) /
           view.pixels_per_slope;
  };
  float largest = 0;
  for (int j = 0; j <= parts; ++j)
    for (int i = 0; i <= parts; ++i) {
      const Vec3f ray =
          view.forward + view.right * slope(i, view.width) + view.up * slope(j, view.height);
      const float distance = height / dot(ray, place.normal);
      if (!(distance > view.near_distance) ||
          !(length(ray * distance - place.fade_center) < has_faded * place.fade_distance))
        continue;
      const Vec3f p = view.eye + ray * distance;
      largest = std::max(largest, ends.way(thing.before(p), thing.after(p)).pixels);
    }
  return largest;
}

/// Pixels that colliders move by, also where they deform.
float collider_motion(const MotionSource& source, const Ends& ends, const render::Frame& frame,
                      double open) {
  if (source.scene.colliders.empty()) return 0;
  const render::Frame before = colliders_after(source, -0.5 * open, frame),
                      after = colliders_after(source, 0.5 * open, frame);
  float largest = 0;
  const auto add = [&](const auto& from, const auto& to) {
    if (from.size() != to.size()) return;  // lines at creases, which come and go
    for (std::size_t k = 0; k < from.size(); ++k)
      largest = std::max(largest, ends.way(from[k], to[k]).pixels);
  };
  for (std::size_t m = 0; m < before.meshes.size(); ++m)
    add(before.meshes[m].position, after.meshes[m].position);
  for (std::size_t g = 0; g < before.ghosts.size(); ++g)
    add(before.ghosts[g].position, after.ghosts[g].position);
  for (std::size_t l = 0; l < before.lines.size(); ++l)
    add(before.lines[l].ends, after.lines[l].ends);
  const auto add_grounds = [&](const std::vector<Thing>& things,
                               const std::vector<render::GroundPlane>& grounds, bool are_ghosts) {
    for (std::size_t g = 0; g < things.size(); ++g)
      largest = std::max(largest, ground_motion(ends, frame, grounds[g], things[g], are_ghosts));
  };
  add_grounds(moving_grounds(source, 0.5 * open), frame.grounds, false);
  add_grounds(moving_ghost_grounds(source, 0.5 * open), frame.ghost_grounds, true);
  return largest;
}

/// Pixels that anything moves by in the picture while the shutter is open.
float largest_motion(const MotionSource& source, const Ends& ends, const render::Frame& frame,
                     const std::vector<Vec3f>& velocity, double open) {
  float largest = collider_motion(source, ends, frame, open);
  for (std::size_t p = 0; p < frame.points.position.size(); ++p)
    largest = std::max(largest, ends.way_of(frame.points.position[p], velocity[p]).pixels);
  return largest;
}

/// Says of points by how much they are blurred.
void add_blur(const Ends& ends, const std::vector<Vec3f>& velocity, auto& points) {
  std::vector<float> blur;
  blur.reserve(velocity.size());
  for (std::size_t p = 0; p < velocity.size(); ++p)
    blur.push_back(std::max(ends.way_of(points.position[p], velocity[p]).metres, 0.0f));
  points.blur = std::move(blur);
}

}  // namespace

render::Moments shutter_moments(const MotionSource& source, const render::Frame& frame,
                                double degrees) {
  const double open = degrees / 360 / source.scene.fps;
  std::vector<Vec3f> velocity = velocities(source, frame.points.id);
  std::vector<Vec3f> cut_velocity =
      frame.points.cut ? velocities(source, frame.points.cut->id) : std::vector<Vec3f>{};
  const Ends ends(source, frame, open);
  const float pixels = largest_motion(source, ends, frame, velocity, open);
  if (!(pixels >= 0.5f)) return {};
  render::Frame blurred = frame;
  add_blur(ends, velocity, blurred.points);
  if (blurred.points.cut) add_blur(ends, cut_velocity, *blurred.points.cut);
  const int count = count_of(pixels, frame.supersampling);
  return {count, [=, velocity = std::move(velocity), cut_velocity = std::move(cut_velocity),
                  blurred = std::move(blurred)](int k) {
            render::Frame moment = blurred;
            move_solids(source, open * time_of_share((k + 0.5) / count), moment);
            keep_labels(blurred.camera, moment);
            const auto move = [&](const std::vector<Vec3f>& by, auto& points) {
              std::vector<Vec3f>& position = points.position.edit();
              for (std::size_t p = 0; p < by.size(); ++p) {
                const double share = (k + static_cast<double>(phase_of(points.id[p]))) / count;
                position[p] = position[p] + by[p] * static_cast<float>(open * time_of_share(share));
              }
            };
            move(velocity, moment.points);
            if (moment.points.cut) move(cut_velocity, *moment.points.cut);
            return moment;
          }};
}

render::Moments with_shared_samples(render::Moments moments) {
  if (moments.count < enough_to_share) return moments;
  return {moments.count, [at = std::move(moments.at)](int k) {
            render::Frame moment = at(k);
            if (moment.supersampling == 1) return moment;
            moment.grain_detail = moment.supersampling;
            moment.supersampling = 1;
            if (moment.smoke.samples_per_ray > 0) moment.smoke.samples_per_ray = 1;
            turn_by_pixels(radical_inverse(k + 1, 2) - 0.5, radical_inverse(k + 1, 3) - 0.5,
                           moment);
            return moment;
          }};
}

}  // namespace neve::app::picture
