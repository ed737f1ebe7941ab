/// Findings about colliders that move by themselves.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "app/health/findings.h"
#include "app/health/places.h"
#include "app/scene/coarsen.h"
#include "app/setup/auto_ranges.h"
#include "app/setup/curves.h"
#include "app/support/text.h"
#include "sim/rigid/mass.h"
#include "sim/rigid/rigid_bodies.h"

namespace neve::app::health {

namespace {

using sim::Vec3d;
using sim::shapes::Collider;
using sim::shapes::HeldAxis;
using sim::shapes::Joint;

std::string address_of(const Collider& body) {
  return "collider." + body.name;
}

std::vector<Vec3d> places_in_solid(const sim::shapes::Shape& shape) {
  return sim::shapes::is_rigid_solid(shape) ? places_in(shape) : std::vector<Vec3d>{};
}

/// Warns of a body that overlaps a collider at the start. Things that touch have no place of one in
/// the other; joined things may overlap, and do not meet.
void check_starts(const scene::Scene& scene, const Collider& body, std::vector<Finding>& findings) {
  if (body.body.joint != Joint::none) return;
  const std::vector<Vec3d> places = places_in(body.shape);
  for (const Collider& other : scene.colliders) {
    // The first of two bodies reports both.
    if (other.name == body.name || (other.body.moves() && &other < &body) ||
        other.body.joint != Joint::none)
      continue;
    const double share = share_inside(places, other);
    if (share == 0 && share_inside(places_in_solid(other.shape), body) == 0) continue;
    const std::string name = display_name("collider", body.name),
                      other_name = display_name("collider", other.name);
    const std::string found =
        share > 0 ? fmt::format("{} of {} starts inside {}", percent_text(share), name, other_name)
                  : fmt::format("{} and {} overlap at the start", name, other_name);
    findings.push_back({Severity::warning, address_of(body) + ".shape",
                        found + ": contact pushes them apart",
                        "move one of them so that they touch at most"});
  }
}

void check_density(const Collider& body, std::vector<Finding>& findings) {
  // The range has foam and gold, with some room; a gas or a star is a mistake of units.
  constexpr double lightest = 10, heaviest = 23000, grams_per_cm3 = 1000;
  const double volume = sim::rigid::mass_properties(body.shape, 1).mass;
  const double density = body.body.mass > 0 ? body.body.mass / volume : body.body.density;
  if (!(density < lightest || density > heaviest)) return;
  const bool has_mass = body.body.mass > 0;
  const std::string found =
      has_mass ? fmt::format("{} kg in {} m3 are {} kg/m3", rough_text(body.body.mass),
                             rough_text(volume), rough_text(density))
               : fmt::format("a density of {} kg/m3", rough_text(density));
  const bool looks_like_grams = !has_mass && density >= 0.1 && density < 23;
  findings.push_back(
      {Severity::warning, address_of(body) + (has_mass ? ".mass" : ".density"),
       fmt::format("{}, {} than anything that lies in snow", found,
                   density < lightest ? "lighter" : "heavier"),
       looks_like_grams ? fmt::format("g/cm3 are {} kg/m3 here; ice has 917, wood about 600, steel "
                                      "7850",
                                      rough_text(grams_per_cm3 * density))
                        : "ice has 917, wood about 600, steel 7850; lengths are in metres"});
}

void check_size(const scene::Scene& scene, const Collider& body, double coarsening,
                std::vector<Finding>& findings) {
  constexpr double fewest_cells = 2;
  const sim::shapes::Bounds box = sim::shapes::bounds_at(body, 0);
  const double cells = (box.max - box.min).maxCoeff() / scene.solver.cell_size;
  if (cells >= fewest_cells) return;
  findings.push_back(
      {Severity::warning, address_of(body) + ".shape",
       fmt::format("{} is {} cells large: a few particles move it, by chance",
                   display_name("collider", body.name), rough_text(cells)),
       "make it larger, or " +
           scene::setting_text("solver.cell_size",
                               (box.max - box.min).maxCoeff() / (2 * fewest_cells), coarsening)});
}

void check_hold(const Collider& body, std::vector<Finding>& findings) {
  constexpr HeldAxis all[] = {HeldAxis::x,      HeldAxis::y,      HeldAxis::z,
                              HeldAxis::turn_x, HeldAxis::turn_y, HeldAxis::turn_z};
  const std::vector<HeldAxis>& hold = body.body.hold;
  if (std::all_of(std::begin(all), std::end(all), [&](HeldAxis axis) {
        return std::find(hold.begin(), hold.end(), axis) != hold.end();
      }))
    findings.push_back({Severity::warning, address_of(body) + ".hold",
                        fmt::format("{} is held in all directions and never moves",
                                    display_name("collider", body.name)),
                        "omit a direction, or the density"});
}

void check_joint(const Collider& body, std::vector<Finding>& findings) {
  if (body.body.joint != Joint::ball && body.body.joint != Joint::hinge) return;
  const sim::shapes::Bounds box = sim::shapes::bounds_at(body, 0);
  const Vec3d middle = 0.5 * (box.min + box.max);
  const double size = (box.max - box.min).norm(), away = (body.body.joint_point - middle).norm();
  constexpr double far = 3;  // times the size: a pendulum has a shorter rod
  if (away <= far * size) return;
  findings.push_back(
      {Severity::warning, address_of(body) + ".joint_point",
       fmt::format("the joint of {} is {} m away from it, {} times its size",
                   display_name("collider", body.name), rough_text(away), rough_text(away / size)),
       fmt::format("joint_point is a place in the scene; the body is at {}", vector_text(middle))});
}

/// Six digits, and nothing of what rounding leaves.
std::string rough(const Vec3d& v) {
  constexpr double nothing = 1e-9;
  const auto digits = [&](double x) {
    return std::abs(x) <= nothing * v.norm() ? std::string("0") : fmt::format("{:.6g}", x);
  };
  return "[" + digits(v.x()) + ", " + digits(v.y()) + ", " + digits(v.z()) + "]";
}

/// A joint turns the motion of a free body into one that it allows as an impact does: a body that
/// is to swing needs the velocity of its centre too.
void check_start_of_held(const Collider& body, std::vector<Finding>& findings) {
  if (body.body.hold.empty() && body.body.joint == Joint::none) return;
  const sim::rigid::Motion given = sim::rigid::motion_at(body, 0),
                           start = sim::rigid::motion_at_start(body);
  constexpr double notable = 1e-3;
  const auto differs = [&](const Vec3d& a, const Vec3d& b) {
    return (a - b).norm() > notable * std::max(a.norm(), b.norm());
  };
  const bool turns = differs(given.spin, start.spin);
  if (!turns && !differs(given.velocity, start.velocity)) return;
  const bool swings = body.body.joint == Joint::ball || body.body.joint == Joint::hinge;
  Vec3d spin = body.angular_velocity;
  if (body.body.joint == Joint::hinge) {
    const Vec3d axis = body.body.joint_axis.stableNormalized();
    spin = axis.dot(spin) * axis;
  }
  const Vec3d round = spin.cross(sim::shapes::center(body.shape) - body.body.joint_point);
  findings.push_back(
      {Severity::warning, address_of(body) + (turns ? ".angular_velocity" : ".velocity"),
       fmt::format(
           "the scene gives {} {} m/s and {} rad/s, and what holds it lets it start with {} "
           "m/s and {} rad/s",
           display_name("collider", body.name), rough(given.velocity), rough(given.spin),
           rough(start.velocity), rough(start.spin)),
       swings && !spin.isZero(0)
           ? fmt::format("to swing about its joint with {} rad/s it needs velocity = {} as well",
                         rough(spin), rough(round))
           : "omit what its joint or hold takes away"});
}

bool falls_freely(const scene::Scene& scene, const Collider& body) {
  return scene.solver.gravity.norm() > 0 && body.body.joint == Joint::none &&
         body.body.hold.empty() && body.body.spring_stiffness == 0 && body.body.spring_damping == 0;
}

/// A body of the coarse run that is at the end where one is that nothing has touched.
/// @param index  of the body in the moments
void check_fall(const scene::Scene& scene, const Collider& body,
                const std::vector<setup::CoarseMoment>& moments, std::size_t index,
                std::vector<Finding>& findings) {
  constexpr double whole = 0.9, alike = 0.02;
  const double end = scene::duration(scene);
  if (!falls_freely(scene, body) || moments.empty()) return;
  const setup::CoarseMoment& last = moments.back();
  if (!(end > 0) || last.time < whole * end || index >= last.bodies.size()) return;
  const auto middle = [](const sim::shapes::Bounds& box) {
    return Vec3d(0.5 * (box.min + box.max));
  };
  const sim::shapes::Bounds start = sim::shapes::bounds_at(body, 0);
  const Vec3d fall = 0.5 * last.time * last.time * scene.solver.gravity;
  const Vec3d expected = middle(start) + last.time * body.velocity + fall;
  const double size = (start.max - start.min).norm();
  if (fall.norm() < size || (middle(last.bodies[index]) - expected).norm() > alike * fall.norm())
    return;
  findings.push_back(
      {Severity::warning, address_of(body),
       fmt::format("nothing carries or stops {}: it falls freely and has {} m/s when the scene "
                   "ends, at {} s",
                   display_name("collider", body.name),
                   rough_text((body.velocity + end * scene.solver.gravity).norm()),
                   rough_text(end)),
       "put a floor below it, snow in its way, or give it a joint or a spring"});
}

void check_rest(const scene::Scene& scene, const Collider& body, std::vector<Finding>& findings) {
  const bool is_pulled = setup::largest_gravity(scene) > 0 || body.body.spring_stiffness > 0 ||
                         setup::curve_of(scene, address_of(body) + ".spring_stiffness");
  if (is_pulled || !body.velocity.isZero(0) || !body.angular_velocity.isZero(0)) return;
  findings.push_back({Severity::note, address_of(body),
                      fmt::format("solver.gravity is 0: {} rests until snow hits it",
                                  display_name("collider", body.name)),
                      "give it a velocity, or gravity"});
}

}  // namespace

void check_starts_of_held(const scene::Scene& scene, std::vector<Finding>& findings) {
  for (const Collider& body : scene.colliders)
    if (body.body.moves()) check_start_of_held(body, findings);
}

void check_moving_bodies(const scene::Scene& scene, const std::vector<setup::CoarseMoment>& moments,
                         double coarsening, std::vector<Finding>& findings) {
  check_starts_of_held(scene, findings);
  std::size_t index = 0;
  for (const Collider& body : scene.colliders) {
    if (!body.body.moves()) continue;
    check_starts(scene, body, findings);
    check_density(body, findings);
    check_size(scene, body, coarsening, findings);
    check_hold(body, findings);
    check_joint(body, findings);
    check_rest(scene, body, findings);
    check_fall(scene, body, moments, index++, findings);
  }
}

}  // namespace neve::app::health
