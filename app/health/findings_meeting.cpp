/// Findings about the flight of the snow: what it meets, and where down is.

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "app/health/findings.h"
#include "app/health/point_findings.h"
#include "app/scene/coarsen.h"
#include "app/setup/curves.h"
#include "app/setup/snow_pieces.h"
#include "app/support/interrupt.h"
#include "app/support/text.h"
#include "sim/shapes/solid.h"

namespace neve::app::health {

namespace {

using sim::Vec3d;

constexpr double never_met = std::numeric_limits<double>::infinity();
/// Particles of a body that stand for all of them.
constexpr std::size_t max_sampled = 400;
/// Bodies and colliders; more of them fill a scene, and some meet.
constexpr std::size_t max_compared = 1000;
constexpr int min_looks = 24, max_looks = 240;

using Box = sim::shapes::Bounds;

/// Returns the distance from face to face of two boxes; 0 where they overlap.
double distance_of_boxes(const Box& a, const Box& b) {
  return (b.min - a.max).cwiseMax(a.min - b.max).cwiseMax(Vec3d::Zero()).norm();
}

/// Free fall by gravity, to which a curve gives another value in each frame.
class Fall {
 public:
  explicit Fall(const scene::Scene& scene) : frame_(never_met) {
    parts_.push_back({scene.solver.gravity});
    if (!setup::curve_of(scene, "solver.gravity")) return;
    frame_ = 1 / scene.fps;
    parts_.clear();
    Vec3d velocity = Vec3d::Zero(), way = Vec3d::Zero();
    for (int k = 1; k <= std::max(1, scene::last_frame(scene)); ++k) {
      const std::vector<double> g = *setup::curve_value(scene, "solver.gravity", k);
      parts_.push_back({{g[0], g[1], g[2]}, velocity, way});
      velocity = velocity_at(k * frame_);
      way = way_at(k * frame_);
    }
  }

  bool acts() const {
    return std::ranges::any_of(parts_, [](const Part& p) { return p.gravity.norm() > 0; });
  }
  /// m/s and m since the start.
  Vec3d velocity_at(double time) const {
    const auto [part, t] = at(time);
    return part.velocity + t * part.gravity;
  }
  Vec3d way_at(double time) const {
    const auto [part, t] = at(time);
    return part.way + t * part.velocity + 0.5 * t * t * part.gravity;
  }

 private:
  struct Part {
    Vec3d gravity;
    Vec3d velocity = Vec3d::Zero(), way = Vec3d::Zero();  ///< when it begins
  };
  /// The part that a time lies in, and the time in it.
  std::pair<const Part&, double> at(double time) const {
    const double last = static_cast<double>(parts_.size() - 1);
    const double k = std::clamp(std::floor(time / frame_), 0.0, last);
    return {parts_[static_cast<std::size_t>(k)], k > 0 ? time - k * frame_ : time};
  }

  double frame_;  ///< s
  std::vector<Part> parts_;
};

/// m/s, of all particles of a body together, beyond its own: the points of a file may move.
Vec3d drift_of(const sim::seeding::Body& body, const Vec3d& center,
               const sim::ParticleArrays& particles, std::size_t first, std::size_t end) {
  Vec3d momentum = Vec3d::Zero();
  double mass = 0;
  for (std::size_t p = first; p < end; ++p) {
    const Vec3d spin = body.angular_velocity.cross(Vec3d(particles.x[p] - center));
    momentum += particles.m[p] * (particles.v[p] - body.velocity - spin);
    mass += particles.m[p];
  }
  return mass > 0 ? Vec3d(momentum / mass) : momentum;
}

/// A body in free flight until it meets a collider; there it stays.
class Flight {
 public:
  Flight(const scene::Scene& scene, const setup::SeededScene& seeded, const Fall& fall,
         std::size_t index)
      : body_(&scene.bodies[index]), fall_(&fall) {
    const std::size_t first = seeded.body_begin(index), end = seeded.body_end[index];
    const std::size_t stride = (end - first) / max_sampled + 1;
    for (std::size_t p = first; p < end; p += stride) start_.push_back(seeded.particles.x[p]);
    center_ = sim::shapes::center(body_->shape);
    velocity_ = body_->velocity;
    if (is_from_points(*body_))
      velocity_ += drift_of(*body_, center_, seeded.particles, first, end);
    for (const Vec3d& x : start_) box_.add(x);
    const double volume = (box_.max - box_.min).prod();
    spacing_ = start_.empty() ? 0 : std::cbrt(volume / static_cast<double>(start_.size()));
  }

  const sim::seeding::Body& body() const { return *body_; }
  bool is_empty() const { return start_.empty(); }
  /// m, between the particles that are looked at.
  double spacing() const { return spacing_; }
  bool moves() const {
    return fall_->acts() || velocity_.norm() > 0 || body_->angular_velocity.norm() > 0;
  }
  /// m/s, at the end of a flight.
  double speed_at(double time) const { return (velocity_ + fall_->velocity_at(time)).norm(); }
  /// m
  double size() const { return box_.diagonal(); }

  double stopped = never_met;  ///< s; at a collider

  std::vector<Vec3d> at(double time, Box& box) const {
    const double t = std::min(time, stopped);
    const Vec3d& spin = body_->angular_velocity;
    const sim::Mat3d turn =
        spin.norm() > 0 ? Eigen::AngleAxisd(spin.norm() * t, spin.normalized()).toRotationMatrix()
                        : sim::Mat3d::Identity();
    const Vec3d moved = center_ + t * velocity_ + fall_->way_at(t);
    std::vector<Vec3d> places;
    places.reserve(start_.size());
    for (const Vec3d& x : start_) {
      places.push_back(moved + turn * (x - center_));
      box.add(places.back());
    }
    return places;
  }

 private:
  const sim::seeding::Body* body_;
  const Fall* fall_;
  Vec3d center_, velocity_;
  double spacing_ = 0;
  std::vector<Vec3d> start_;
  Box box_;
};

/// The nearest that something came to a body, and when.
struct Nearest {
  double distance = never_met, time = 0;
  std::string name;
  void note(double other, double when, const std::string& who) {
    if (other < distance) distance = other, time = when, name = who;
  }
};

double distance_to(const sim::shapes::Collider& collider, double time, const Box& box,
                   const std::vector<Vec3d>& places, double reach) {
  if (!std::holds_alternative<sim::shapes::Plane>(collider.shape.form)) {
    const double apart = distance_of_boxes(box, sim::shapes::bounds_at(collider, time));
    if (apart > reach) return apart;
  }
  const sim::shapes::ColliderAt at(collider, time);
  double least = never_met;
  for (const Vec3d& x : places) least = std::min(least, at.surface(x).distance);
  return least;
}

double distance_between(const std::vector<Vec3d>& a, const Box& box_a, const std::vector<Vec3d>& b,
                        const Box& box_b, double reach) {
  const double apart = distance_of_boxes(box_a, box_b);
  if (apart > reach) return apart;
  double least = never_met;
  for (const Vec3d& x : a)
    for (const Vec3d& y : b) least = std::min(least, (x - y).squaredNorm());
  return std::sqrt(least);
}

/// Times at which bodies are looked at: none crosses another between two.
std::vector<double> times_of(const std::vector<Flight>& flights, double end) {
  double looks = min_looks;
  for (const Flight& flight : flights) {
    double fastest = 0;
    for (int k = 0; k <= min_looks; ++k)
      fastest = std::max(fastest, flight.speed_at(end * k / min_looks));
    looks = std::max(looks, 3 * fastest * end / std::max(1e-6, flight.size()));
  }
  const int count = static_cast<int>(std::min<double>(looks, max_looks));
  std::vector<double> times;
  for (int k = 0; k <= count; ++k) times.push_back(end * k / count);
  return times;
}

/// Distance from which one touches the next: snow reaches over cells, and colliders are
/// crossed between two looks.
double reach_of(const scene::Scene& scene, const Flight& flight, double time, double between) {
  return scene.solver.cell_size + 0.5 * flight.spacing() + 0.5 * flight.speed_at(time) * between;
}

/// True where a sink takes some of the places.
bool meets_sink(const std::vector<sim::seeding::Sink>& sinks, const std::vector<Vec3d>& places) {
  return std::ranges::any_of(sinks, [&](const sim::seeding::Sink& sink) {
    const sim::shapes::Solid solid(sink.shape);
    return std::ranges::any_of(places,
                               [&](const Vec3d& x) { return solid.contains(x) != sink.outside; });
  });
}

void fly_to_colliders(const scene::Scene& scene, const std::vector<double>& times, Flight& flight,
                      Nearest& nearest) {
  const double between = times.size() > 1 ? times[1] - times[0] : 0;
  for (const double time : times) {
    Box box;
    const std::vector<Vec3d> places = flight.at(time, box);
    if (meets_sink(scene.sinks, places)) {
      flight.stopped = time;
      return;
    }
    const double reach = reach_of(scene, flight, time, between);
    for (const sim::shapes::Collider& collider : scene.colliders) {
      const double distance = distance_to(collider, time, box, places, reach);
      nearest.note(distance, time, display_name("collider", collider.name));
      if (distance > reach) continue;
      flight.stopped = time;
      return;
    }
  }
}

/// All bodies at one time.
struct Moment {
  double time = 0;
  std::vector<Box> box;
  std::vector<std::vector<Vec3d>> places;

  Moment(const std::vector<Flight>& flights, double when) : time(when), box(flights.size()) {
    for (std::size_t k = 0; k < flights.size(); ++k) places.push_back(flights[k].at(when, box[k]));
  }
};

/// @return whether another body is met
bool meets_another(const scene::Scene& scene, const std::vector<Flight>& flights,
                   const Moment& moment, double between, std::size_t k, Nearest& nearest) {
  for (std::size_t other = 0; other < flights.size(); ++other) {
    if (other == k || flights[other].is_empty()) continue;
    const double reach =
        reach_of(scene, flights[k], moment.time, between) + flights[other].spacing();
    const double distance = distance_between(moment.places[k], moment.box[k], moment.places[other],
                                             moment.box[other], reach);
    if (distance < nearest.distance)
      nearest.note(distance, moment.time, display_name("body", flights[other].body().name));
    if (distance <= reach) return true;
  }
  return false;
}

/// Whether each of the bodies meets another one, of those that fly.
std::vector<bool> fly_past_bodies(const scene::Scene& scene, const std::vector<double>& times,
                                  const std::vector<Flight>& flights,
                                  const std::vector<bool>& flies, std::vector<Nearest>& nearest) {
  const double between = times.size() > 1 ? times[1] - times[0] : 0;
  std::vector<bool> meets(flights.size(), false);
  for (const double time : times) {
    if (is_interrupted()) return std::vector<bool>(flights.size(), true);
    const Moment moment(flights, time);
    for (std::size_t k = 0; k < flights.size(); ++k)
      if (flies[k] && !meets[k])
        meets[k] = meets_another(scene, flights, moment, between, k, nearest[k]);
  }
  return meets;
}

constexpr const char* floor_advice =
    "a floor is [[collider]] with shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }";

Finding free_fall(const scene::Scene& scene, const Flight& flight, const Nearest& nearest,
                  double end) {
  const std::string name = display_name("body", flight.body().name);
  if (nearest.name.empty()) {
    // Loose snow that the air slows down or takes along has another speed than its fall.
    const std::string speed =
        scene::has_spray_drag(scene)
            ? "until the scene ends"
            : fmt::format("and has {} m/s when the scene ends", rough_text(flight.speed_at(end)));
    return {
        Severity::warning, "body." + flight.body().name,
        fmt::format("nothing stops {}: it flies freely {}, at {} s", name, speed, rough_text(end)),
        floor_advice};
  }
  return {Severity::warning, "body." + flight.body().name,
          fmt::format("{} meets nothing until the scene ends, at {} s; nearest is {}, {} m away at "
                      "{} s",
                      name, rough_text(end), nearest.name, rough_text(nearest.distance),
                      rough_text(nearest.time)),
          "change its place or velocity, make frames larger, or put something in its way"};
}

}  // namespace

void check_meetings(const scene::Scene& scene, const setup::SeededScene& seeded,
                    std::vector<Finding>& findings) {
  const double end = scene::duration(scene);
  // A stream of snow fills the way of others.
  if (end <= 0 || !scene.emitters.empty()) return;
  // Each is compared with each.
  if (scene.bodies.size() + scene.colliders.size() > max_compared) return;
  const Fall fall(scene);
  std::vector<Flight> flights;
  for (std::size_t k = 0; k < scene.bodies.size(); ++k)
    flights.emplace_back(scene, seeded, fall, k);
  const std::vector<double> times = times_of(flights, end);
  std::vector<Nearest> nearest(flights.size());
  std::vector<bool> flies(flights.size(), false);
  for (std::size_t k = 0; k < flights.size() && !is_interrupted(); ++k) {
    if (flights[k].is_empty()) continue;
    fly_to_colliders(scene, times, flights[k], nearest[k]);
    flies[k] = flights[k].moves() && flights[k].stopped == never_met;
  }
  if (std::find(flies.begin(), flies.end(), true) == flies.end()) return;
  const std::vector<bool> meets = fly_past_bodies(scene, times, flights, flies, nearest);
  for (std::size_t k = 0; k < flights.size(); ++k)
    if (flies[k] && !meets[k]) findings.push_back(free_fall(scene, flights[k], nearest[k], end));
}

void check_gravity(const scene::Scene& scene, std::vector<Finding>& findings) {
  const Vec3d& g = scene.solver.gravity;
  if (g.norm() == 0) return;
  const Vec3d up =
      scene.camera ? scene.camera->up.normalized() : scene::CameraSettings{}.up.normalized();
  // A slope may be made by tilted gravity.
  constexpr double steepest = 0.5;
  if (-g.dot(up) > steepest * g.norm()) return;
  int axis = 0;
  g.cwiseAbs().maxCoeff(&axis);
  const std::string along = std::string(g[axis] < 0 ? "-" : "+") + "xyz"[axis];
  findings.push_back(
      {Severity::warning, "solver.gravity",
       fmt::format("gravity points along {}, and up is {} in the pictures", along,
                   up.isApprox(Vec3d::UnitY()) ? "+y" : "another way"),
       axis == 1 ? "on earth it is [0, -9.81, 0]"
                 : fmt::format("turn the scene so that y is up and gravity = [0, {}, 0], or set "
                               "camera.up",
                               rough_text(-g.norm()))});
}

bool has_something_to_hit(const scene::Scene& scene) {
  return !scene.colliders.empty() || setup::snow_places(scene).size() > 1;
}

}  // namespace neve::app::health
