#include "app/setup/auto_ranges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/scene/coarsen.h"
#include "app/setup/curves.h"
#include "app/setup/snow_pieces.h"
#include "app/support/round_number.h"
#include "sim/health/diagnostics.h"
#include "sim/laws/law.h"
#include "sim/laws/threshold_cell.h"
#include "sim/rigid/mass.h"
#include "sim/rigid/rigid_bodies.h"
#include "sim/shapes/height_samples.h"
#include "sim/shapes/placed_points.h"
#include "sim/types/time_step.h"

namespace neve::app::setup {

namespace {

using sim::Vec3d;

/// Distance from a point along a unit direction to a collider; negative: no collider there.
double distance_to(const sim::shapes::Collider& collider, const Vec3d& point,
                   const Vec3d& direction) {
  if (const auto* plane = std::get_if<sim::shapes::Plane>(&collider.shape.form)) {
    const sim::shapes::Pose pose = sim::shapes::pose_at(collider, 0);
    const Vec3d normal = pose.rotation * plane->normal;
    const double approach = -direction.dot(normal);
    const double height = (point - pose.point).dot(normal);
    return approach > 1e-9 && height > 0 ? height / approach : -1;
  }
  // A terrain is the tangent plane of its ground below; snow on it may be in the ground a little.
  if (std::holds_alternative<sim::shapes::Terrain>(collider.shape.form)) {
    const sim::shapes::Surface below = sim::shapes::surface_at(collider, 0, point);
    const double approach = -direction.dot(below.normal);
    return approach > 1e-9 && below.distance < 0.5 * sim::shapes::no_ground
               ? std::max(below.distance, 0.0) / approach
               : -1;
  }
  // Any other shape counts as the box around it: an estimate is all that is needed.
  const sim::shapes::Bounds box = sim::shapes::bounds_at(collider, 0);
  double enter = 0, leave = 1e300;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(direction[axis]) < 1e-9) {
      if (point[axis] < box.min[axis] || point[axis] > box.max[axis]) return -1;
      continue;
    }
    const double a = (box.min[axis] - point[axis]) / direction[axis];
    const double b = (box.max[axis] - point[axis]) / direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : -1;
}

/// Unit vector; without gravity that of the pictures.
Vec3d down_in(const scene::Scene& scene) {
  const double g = scene.solver.gravity.norm();
  return g > 0 ? Vec3d(scene.solver.gravity / g) : Vec3d(-Vec3d::UnitY());
}

/// m, from the middle of a box to its surface, straight down.
double half_height(const sim::shapes::Bounds& box, const Vec3d& down) {
  const Vec3d half = 0.5 * (box.max - box.min);
  double height = half.norm();
  for (int axis = 0; axis < 3; ++axis)
    height = std::min(height, half[axis] / std::max(std::abs(down[axis]), 1e-9));
  return height;
}

/// Speed of snow when it meets the surface below it, or at the end of the scene when nothing is.
double impact_speed(const scene::Scene& scene, const SnowPiece& piece) {
  const sim::shapes::Bounds box = sim::shapes::bounds(*piece.shape);
  const double start =
      piece.velocity.norm() + speed_of_spin(piece) + setup::own_speed(*piece.shape);
  const double g = scene.solver.gravity.norm();
  if (g == 0) return start;
  const Vec3d down = down_in(scene);
  const bool is_cover = std::holds_alternative<sim::shapes::Cover>(piece.shape->form);
  const Vec3d middle =
      is_cover ? Vec3d(0.5 * (box.min + box.max)) : sim::shapes::center(*piece.shape);
  double fall = -1;
  for (const sim::shapes::Collider& collider : scene.colliders) {
    const double distance = distance_to(collider, middle, down);
    if (distance >= 0 && (fall < 0 || distance < fall)) fall = distance;
  }
  const double duration = scene::duration(scene);
  const double free_fall = 0.5 * g * duration * duration;
  // Snow at rest still slumps by about its own height.
  fall = std::max(fall < 0 ? free_fall : fall, half_height(box, down));
  return std::sqrt(start * start + 2 * g * fall);
}

/// Returns the largest value over the materials of the snow in cells of the scene, at all moments.
double largest(const scene::Scene& given, double (*of)(const sim::Material&)) {
  return largest_at_moments(given, [&](const scene::Scene& scene) {
    double value = 0;
    for (const sim::Material& material :
         sim::laws::in_cells(scene::materials_of_snow(scene), scene.solver))
      value = std::max(value, of(material));
    return value;
  });
}

/// These values are what undeformed material of any law bears.
double yield_pressure(const sim::Material& m) {
  return sim::laws::of(m).scale(m).pressure;
}
double yield_shear(const sim::Material& m) {
  return sim::laws::of(m).scale(m).shear;
}
double elastic_reach(const sim::Material& m) {
  return sim::laws::of(m).scale(m).strain;
}

/// Pressure of snow at impact, rho v^2: below the elastic limit, and well above its own weight.
double stagnation_pressure(const scene::Scene& scene) {
  const double speed = setup::impact_speed(scene);
  const double density = largest(scene, [](const sim::Material& m) { return m.density; });
  return speed > 0 ? density * speed * speed : std::numeric_limits<double>::infinity();
}

scene::Range density_range(const scene::Scene& given) {
  double low = 1e300, high = 0;
  at_each_moment(given, [&](const scene::Scene& scene) {
    for (const sim::Material& m : scene::materials_of_snow(scene)) {
      low = std::min(low, m.density);
      high = std::max(high, m.density);
    }
  });
  return {round_down(0.5 * low), round_up(1.5 * high)};
}

/// Heights of bodies until they fall on something, m.
struct BodyHeights {
  double low = 1e300, high = -1e300;
};

/// Keeps of a vector what is along the ways that a body may go; about a ball joint or a hinge it
/// may swing to all sides.
Vec3d along_free_ways(const sim::shapes::RigidBody& body, Vec3d v) {
  using sim::shapes::HeldAxis;
  if (body.joint == sim::shapes::Joint::slider) {
    const Vec3d axis = body.joint_axis.stableNormalized();
    v = axis.dot(v) * axis;
  }
  constexpr HeldAxis ways[] = {HeldAxis::x, HeldAxis::y, HeldAxis::z};
  for (int a = 0; a < 3; ++a)
    if (std::ranges::find(body.hold, ways[a]) != body.hold.end()) v[a] = 0;
  return v;
}

/// A spring that pulls a body to a place.
struct Spring {
  double rate = 0;      ///< 1/s2, stiffness over mass; 0: there is none
  Vec3d away{0, 0, 0};  ///< m, from the body at the start to that place
};

Spring spring_of(const sim::shapes::Collider& collider) {
  const sim::shapes::RigidBody& body = collider.body;
  const bool is_sprung_slider =
      body.joint == sim::shapes::Joint::slider && body.joint_stiffness > 0;
  if (!(body.spring_stiffness > 0) && !is_sprung_slider) return {};
  const double mass = sim::rigid::mass_properties(collider).mass;
  if (!(body.spring_stiffness > 0)) return {body.joint_stiffness / mass, Vec3d::Zero()};
  return {body.spring_stiffness / mass,
          along_free_ways(body, body.spring_place - sim::rigid::motion_at(collider, 0).centre)};
}

/// The direction and the length of the fall of a body.
struct Fall {
  Vec3d gravity{0, 0, 0};  ///< m/s2, what of it the body may follow
  double way = 0;          ///< m, along it
  Spring spring{};
};

/// Returns the fall to what is below, or to the turn of the spring; it lasts to the end of the
/// scene if nothing is. Ball joints and hinges hold.
Fall fall_of(const scene::Scene& scene, const sim::shapes::Collider& body) {
  using sim::shapes::Joint;
  Fall fall{along_free_ways(body.body, scene.solver.gravity), 0, spring_of(body)};
  const double g = fall.gravity.norm();
  if (g == 0 || body.body.joint == Joint::ball || body.body.joint == Joint::hinge) return fall;
  const Vec3d down = fall.gravity / g;
  const double duration = scene::duration(scene);
  fall.way = 0.5 * g * duration * duration;
  for (const sim::shapes::Collider& collider : scene.colliders) {
    if (collider.body.moves()) continue;
    const double distance = distance_to(collider, sim::shapes::center(body.shape), down);
    if (distance >= 0) fall.way = std::min(fall.way, distance);
  }
  if (const Spring& spring = fall.spring; spring.rate > 0) {
    // It swings about the place where the spring carries it, as far as it starts from there.
    const double to_rest = spring.away.dot(down) + g / spring.rate,
                 speed = body.velocity.dot(down) / std::sqrt(spring.rate);
    fall.way = std::min(fall.way, std::max(0.0, to_rest + std::hypot(to_rest, speed)));
  }
  return fall;
}

/// m, from the middle of a body to its corners.
double radius_around(const sim::shapes::Bounds& box) {
  return 0.5 * (box.max - box.min).norm();
}

BodyHeights body_heights(const scene::Scene& scene) {
  BodyHeights heights;
  const double g = scene.solver.gravity.norm();
  const Vec3d down = down_in(scene);
  for (const sim::shapes::Collider& body : scene.colliders) {
    if (!body.body.moves()) continue;
    const sim::shapes::Bounds box = sim::shapes::bounds_at(body, 0);
    const double size = radius_around(box), y = 0.5 * (box.min + box.max).y();
    const double up = std::max(0.0, -body.velocity.dot(down));
    const double rise = g > 0 ? 0.5 * up * up / g : up * scene::duration(scene);
    const Fall fall = fall_of(scene, body);
    const double lower = g > 0 ? -fall.way * fall.gravity.y() / g : 0;
    heights.low = std::min(heights.low, y - std::max(lower, size));
    heights.high = std::max(heights.high, y + std::max(rise, size));
  }
  return heights;
}

/// Ends that are multiples of a round step.
scene::Range rounded_range(double low, double high) {
  const double step = round_up(0.1 * std::max(high - low, 1e-6));
  return {step * std::floor(low / step), step * std::ceil(high / step)};
}

/// m/s, of a collider that moves by itself
double body_speed(const scene::Scene& scene, const sim::shapes::Collider& body) {
  const double size = radius_around(sim::shapes::bounds_at(body, 0));
  const Fall fall = fall_of(scene, body);
  const double falling =
      std::sqrt(body.velocity.squaredNorm() + 2 * fall.gravity.norm() * std::max(fall.way, size) +
                fall.spring.rate * fall.spring.away.squaredNorm());
  return std::max(setup::impact_speed(scene), falling);
}

/// m/s, that snow gains on the steepest plane until the end of the scene; 0: none is steep.
double sliding_speed(const scene::Scene& scene) {
  const double g = scene.solver.gravity.norm();
  if (g == 0) return 0;
  double steepest = 0;
  for (const sim::shapes::Collider& collider : scene.colliders) {
    const auto* plane = std::get_if<sim::shapes::Plane>(&collider.shape.form);
    if (!plane || collider.contact == sim::shapes::Contact::sticky) continue;
    const Vec3d normal =
        sim::rotation_from_degrees(collider.shape.rotation) * plane->normal.normalized();
    const double across = -normal.dot(scene.solver.gravity) / g,
                 along = std::sqrt(std::max(0.0, 1 - across * across));
    const bool slips = collider.contact == sim::shapes::Contact::slip;
    if (across > 0) steepest = std::max(steepest, along - (slips ? 0 : collider.friction) * across);
  }
  return g * steepest * scene::duration(scene);
}

/// m/s, of what sets snow in motion, wherever it is: planes that it slides down, colliders.
struct Drive {
  double sliding = 0, pushing = 0;
};

Drive drive_of(const scene::Scene& scene) {
  Drive drive{sliding_speed(scene), 0};
  for (const sim::shapes::Collider& collider : scene.colliders)
    drive.pushing = std::max(drive.pushing, setup::collider_speed(scene, collider.name));
  return drive;
}

/// m/s, of a piece as a whole.
double speed_of(const scene::Scene& scene, const SnowPiece& piece, const Drive& drive) {
  return std::max(
      {impact_speed(scene, piece), piece.velocity.norm() + drive.sliding, drive.pushing});
}

/// m/s, of the top of a piece, which falls further than its middle.
double speed_of_top(const scene::Scene& scene, const SnowPiece& piece) {
  const sim::shapes::Bounds box = sim::shapes::bounds(*piece.shape);
  const Vec3d half = 0.5 * (box.max - box.min), down = down_in(scene);
  const double impact = impact_speed(scene, piece),
               above = half.dot(Vec3d(down.cwiseAbs())) * scene.solver.gravity.norm();
  return std::sqrt(impact * impact + 2 * above);
}

}  // namespace

double own_speed(const sim::shapes::Shape& shape) {
  const auto* points = std::get_if<sim::shapes::Points>(&shape.form);
  if (!points) return 0;
  return sim::shapes::summary_of(*points, sim::rotation_from_degrees(shape.rotation)).max_speed;
}

double impact_speed(const scene::Scene& given) {
  return largest_at_moments(given, [](const scene::Scene& scene) {
    double speed = 0;
    for (const SnowPiece& piece : snow_places(scene))
      speed = std::max(speed, impact_speed(scene, piece));
    return speed;
  });
}

Impact hardest_impact(const scene::Scene& given) {
  Impact hardest;
  double worst = 0;
  at_each_moment(given, [&](const scene::Scene& scene) {
    for (const SnowPiece& piece : snow_places(scene)) {
      const double speed = impact_speed(scene, piece), sound = sound_speed(piece);
      if (speed <= worst * sound) continue;
      worst = speed / sound;
      hardest = {piece.address, speed, sound};
    }
  });
  // A curve may make snow stiffer than any is at the start.
  const scene::Scene start = with_curves(given, 0);
  double fastest_at_start = 0;
  for (const SnowPiece& piece : snow_places(start))
    fastest_at_start = std::max(fastest_at_start, sound_speed(piece));
  if (fastest_at_start > 0) hardest.share_of_sound /= fastest_at_start;
  return hardest;
}

double step_at_rest(const scene::Scene& scene) {
  const sim::SolverSettings& solver = scene.solver;
  if (solver.time_step == sim::TimeStep::fixed) return solver.dt;
  double step = solver.max_dt;
  for (const sim::Material& material : scene::materials_of_snow(scene))
    step = std::min(step, sim::acoustic_stretch(solver) * solver.acoustic_cfl * solver.cell_size /
                              sim::sound_speed(material));
  return step;
}

double largest_gravity(const scene::Scene& given) {
  return largest_at_moments(given,
                            [](const scene::Scene& scene) { return scene.solver.gravity.norm(); });
}

double collider_speed(const scene::Scene& given, const std::string& name) {
  return largest_at_moments(given, [&](const scene::Scene& scene) {
    const scene::Collider& collider =
        *std::ranges::find(scene.colliders, name, &scene::Collider::name);
    const double speed = sim::shapes::largest_speed(collider);
    return collider.body.moves() ? std::max(speed, body_speed(scene, collider)) : speed;
  });
}

double largest_speed(const scene::Scene& given) {
  return largest_at_moments(given, [](const scene::Scene& scene) {
    const Drive drive = drive_of(scene);
    double speed = drive.pushing;
    for (const SnowPiece& piece : snow_places(scene))
      speed = std::max({speed, speed_of(scene, piece, drive), speed_of_top(scene, piece)});
    return speed;
  });
}

double energy_of_impact(const scene::Scene& given) {
  return largest_at_moments(given, [](const scene::Scene& scene) {
    const Drive drive = drive_of(scene);
    double energy = 0;
    for (const SnowPiece& piece : snow_pieces(scene)) {
      const double speed = speed_of(scene, piece, drive);
      energy += 0.5 * piece.mass * speed * speed;
    }
    return energy;
  });
}

double force_of_impact(const scene::Scene& given) {
  return largest_at_moments(given, [](const scene::Scene& scene) {
    const Drive drive = drive_of(scene);
    double force = 0;
    for (const SnowPiece& piece : snow_pieces(scene))
      force +=
          piece.mass * (scene.solver.gravity.norm() + speed_of(scene, piece, drive) * scene.fps);
    return force;
  });
}

scene::Range automatic_range(const scene::Scene& scene, scene::ColorBy color_by,
                             std::size_t particle_count) {
  // Packed snow is stiffer than the rest by about this factor.
  constexpr double hardened = 2;
  switch (color_by) {
    case scene::ColorBy::snow:
      break;
    case scene::ColorBy::speed: {
      const double speed = largest_speed(scene);
      return {0, speed > 0 ? round_up(speed) : 1};
    }
    case scene::ColorBy::density:
      return density_range(scene);
    case scene::ColorBy::J_E: {
      const double reach = std::clamp(round_up(largest(scene, elastic_reach)), 0.01, 0.8);
      return {1 - reach, 1 + reach};
    }
    case scene::ColorBy::J_P:
      return {0.8, 1.2};  // about 1, so that diverging maps have their middle there
    case scene::ColorBy::pressure: {
      const double yield = hardened * largest(scene, yield_pressure);
      const double pressure = round_up(std::min(yield, stagnation_pressure(scene)));
      return {-pressure, pressure};
    }
    case scene::ColorBy::von_mises:
      return {0, round_up(
                     std::min(hardened * largest(scene, yield_shear), stagnation_pressure(scene)))};
    case scene::ColorBy::p0: {
      const double p0 = hardened * largest(scene, [](const sim::Material& m) {
                          return sim::health::consolidation_pressure(m, 1);
                        });
      return {0, p0 > 0 ? round_up(p0) : 1};
    }
    case scene::ColorBy::yield:
      return {0, 1};
    case scene::ColorBy::id:
      return {0, static_cast<double>(std::max<std::size_t>(particle_count, 2) - 1)};
  }
  return {0, 1};
}

scene::Range automatic_range(const scene::Scene& scene, scene::ScalarField field) {
  if (field == scene::ScalarField::mass) return {0, density_range(scene).max};
  return automatic_range(scene, attribute_of(field), 0);
}

scene::Range automatic_range(const scene::Scene& scene, scene::VectorField field) {
  const double h = scene.solver.cell_size;
  const scene::Range speeds = automatic_range(scene, scene::ColorBy::speed, 0);
  switch (field) {
    case scene::VectorField::momentum:
      // A node of packed snow has the mass of a cell.
      return {0, round_up(density_range(scene).max * h * h * h * speeds.max)};
    case scene::VectorField::force:
      // Stress on the face of a cell.
      return {0, round_up(automatic_range(scene, scene::ColorBy::pressure, 0).max * h * h)};
    default:
      return speeds;
  }
}

scene::ColorBy attribute_of(scene::ScalarField field) {
  switch (field) {
    case scene::ScalarField::mass:
    case scene::ScalarField::density:
      return scene::ColorBy::density;
    case scene::ScalarField::speed:
      return scene::ColorBy::speed;
    case scene::ScalarField::J_E:
      return scene::ColorBy::J_E;
    case scene::ScalarField::J_P:
      return scene::ColorBy::J_P;
    case scene::ScalarField::pressure:
      return scene::ColorBy::pressure;
    case scene::ScalarField::von_mises:
      return scene::ColorBy::von_mises;
    case scene::ScalarField::p0:
      return scene::ColorBy::p0;
    case scene::ScalarField::yield:
      return scene::ColorBy::yield;
  }
  return scene::ColorBy::density;
}

void resolve_plot_ranges(const scene::Scene& scene, scene::PlotRanges& ranges) {
  const auto from_zero = [](double largest) {
    return scene::Range{0, largest > 0 ? round_up(largest) : 1};
  };
  if (!ranges.energy) ranges.energy = from_zero(energy_of_impact(scene));
  if (!ranges.speed) ranges.speed = automatic_range(scene, scene::ColorBy::speed, 0);
  if (!ranges.force) ranges.force = from_zero(force_of_impact(scene));
  if (scene::has_moving_bodies(scene)) {
    BodyHeights heights;
    at_each_moment(scene, [&](const scene::Scene& each) {
      const BodyHeights more = body_heights(each);
      heights = {std::min(heights.low, more.low), std::max(heights.high, more.high)};
    });
    if (!ranges.body_height) ranges.body_height = rounded_range(heights.low, heights.high);
    if (!ranges.body_speed) ranges.body_speed = from_zero(largest_speed(scene));
  }
  if (!ranges.dt) ranges.dt = from_zero(1.05 * largest_at_moments(scene, step_at_rest));
}

}  // namespace neve::app::setup
