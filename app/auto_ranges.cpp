#include "app/auto_ranges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/attributes.h"
#include "app/round_number.h"
#include "app/snow_pieces.h"
#include "sim/placed_points.h"

namespace neve::app {

namespace {

using sim::Vec3d;

/// How far a point moves along a unit direction until it meets a collider; negative: never.
double distance_to(const sim::Collider& collider, const Vec3d& point, const Vec3d& direction) {
  if (const auto* plane = std::get_if<sim::Plane>(&collider.shape.form)) {
    const sim::Pose pose = sim::pose_at(collider, 0);
    const Vec3d normal = pose.rotation * plane->normal;
    const double approach = -direction.dot(normal);
    const double height = (point - pose.point).dot(normal);
    return approach > 1e-9 && height > 0 ? height / approach : -1;
  }
  // Any other shape by the box around it: an estimate is all that is needed.
  const sim::Bounds box = sim::bounds_at(collider, 0);
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

/// Of points that have velocities in their file.
double own_speed(const sim::Shape& shape) {
  const auto* points = std::get_if<sim::Points>(&shape.form);
  if (!points) return 0;
  return sim::summary_of(*points, sim::rotation_from_degrees(shape.rotation)).max_speed;
}

/// Speed of snow when it meets what is below it, or at the end of the scene when nothing is.
double impact_speed(const Scene& scene, const SnowPiece& piece) {
  const sim::Bounds box = sim::bounds(*piece.shape);
  const double radius = 0.5 * (box.max - box.min).norm();
  const double start =
      piece.velocity.norm() + piece.angular_velocity.norm() * radius + own_speed(*piece.shape);
  const double g = scene.solver.gravity.norm();
  if (g == 0) return start;
  const Vec3d down = scene.solver.gravity / g;
  double fall = -1;
  for (const sim::Collider& collider : scene.colliders) {
    const double distance = distance_to(collider, sim::center(*piece.shape), down);
    if (distance >= 0 && (fall < 0 || distance < fall)) fall = distance;
  }
  const double duration = scene.frames / scene.fps;
  const double free_fall = 0.5 * g * duration * duration;
  // Snow at rest still slumps by about its own size.
  fall = std::max(fall < 0 ? free_fall : fall, radius);
  return std::sqrt(start * start + 2 * g * fall);
}

double largest(const std::vector<sim::Material>& materials, double (*of)(const sim::Material&)) {
  double value = 0;
  for (const sim::Material& material : materials) value = std::max(value, of(material));
  return value;
}

/// Compression by theta_c in each direction, the elastic limit of undeformed snow.
double yield_pressure(const sim::Material& m) {
  const sim::Lame l = sim::lame(m.youngs_modulus, m.poisson_ratio);
  const double theta = std::clamp(m.critical_compression, 0.001, 0.5);
  return (3 * l.lambda + 2 * l.mu) * theta;
}

double yield_shear(const sim::Material& m) {
  const sim::Lame l = sim::lame(m.youngs_modulus, m.poisson_ratio);
  const double theta = std::clamp(m.critical_compression + m.critical_stretch, 0.001, 0.5);
  return 2 * l.mu * theta;
}

/// Of snow that meets something, rho v^2: below the elastic limit, and well above its own weight.
double stagnation_pressure(const Scene& scene) {
  const double speed = impact_speed(scene);
  const double density = largest(scene.materials, [](const sim::Material& m) { return m.density; });
  return speed > 0 ? density * speed * speed : std::numeric_limits<double>::infinity();
}

Range density_range(const Scene& scene) {
  double low = 1e300, high = 0;
  for (const sim::Material& m : scene.materials) {
    low = std::min(low, m.density);
    high = std::max(high, m.density);
  }
  return {round_down(0.5 * low), round_up(1.5 * high)};
}

}  // namespace

double impact_speed(const Scene& scene) {
  double speed = 0;
  for (const SnowPiece& piece : snow_places(scene))
    speed = std::max(speed, impact_speed(scene, piece));
  return speed;
}

double energy_of_impact(const Scene& scene) {
  double energy = 0;
  for (const SnowPiece& piece : snow_pieces(scene)) {
    const double speed = impact_speed(scene, piece);
    energy += 0.5 * piece.mass * speed * speed;
  }
  return energy;
}

Range automatic_range(const Scene& scene, ColorBy color_by, std::size_t particle_count) {
  // Packed snow is stiffer than the rest by about this factor.
  constexpr double hardened = 2;
  switch (color_by) {
    case ColorBy::snow:
      break;
    case ColorBy::speed: {
      const double speed = impact_speed(scene);
      return {0, speed > 0 ? round_up(speed) : 1};
    }
    case ColorBy::density:
      return density_range(scene);
    case ColorBy::J_E: {
      // Three directions at the threshold, as in J = (1 + theta)^3.
      const double compression = 3 * largest(scene.materials, [](const sim::Material& m) {
                                   return m.critical_compression;
                                 });
      const double stretch =
          3 * largest(scene.materials, [](const sim::Material& m) { return m.critical_stretch; });
      const double reach = std::clamp(round_up(std::max(compression, stretch)), 0.01, 0.8);
      return {1 - reach, 1 + reach};
    }
    case ColorBy::J_P:
      return {0.8, 1.2};  // about 1, so that diverging maps have their middle there
    case ColorBy::pressure: {
      const double yield = hardened * largest(scene.materials, yield_pressure);
      const double pressure = round_up(std::min(yield, stagnation_pressure(scene)));
      return {-pressure, pressure};
    }
    case ColorBy::von_mises:
      return {0, round_up(std::min(hardened * largest(scene.materials, yield_shear),
                                   stagnation_pressure(scene)))};
    case ColorBy::id:
      return {0, static_cast<double>(std::max<std::size_t>(particle_count, 2) - 1)};
  }
  return {0, 1};
}

Range automatic_range(const Scene& scene, ScalarField field) {
  if (field == ScalarField::mass) return {0, density_range(scene).max};
  return automatic_range(scene, attribute_of(field), 0);
}

Range automatic_range(const Scene& scene, VectorField field) {
  const double h = scene.solver.cell_size;
  const Range speeds = automatic_range(scene, ColorBy::speed, 0);
  switch (field) {
    case VectorField::momentum:
      // A node of packed snow has the mass of a cell.
      return {0, round_up(density_range(scene).max * h * h * h * speeds.max)};
    case VectorField::force:
      // Stress on the face of a cell.
      return {0, round_up(automatic_range(scene, ColorBy::pressure, 0).max * h * h)};
    default:
      return speeds;
  }
}

}  // namespace neve::app
