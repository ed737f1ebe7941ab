#include "sim/seeding/seeding.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/hash.h"
#include "sim/seeding/sampling.h"
#include "sim/shapes/solid.h"

namespace neve::sim::seeding {
namespace {

double expected_count(const Body& body, const shapes::Solid& solid, double spacing) {
  const double by_volume = solid.volume() / (spacing * spacing * spacing);
  if (body.sampling != Sampling::lattice) return by_volume;
  // The grid gets a whole layer of a sheet thinner than the spacing.
  const shapes::Bounds b = solid.local_bounds();
  const Vec3d size = b.max - b.min;
  return lattice_size(size, spacing).prod() * (solid.volume() / size.prod());
}

std::size_t saturated(double count) {
  constexpr auto max = std::numeric_limits<std::size_t>::max();
  return count < static_cast<double>(max) ? static_cast<std::size_t>(count) : max;
}

SeededBody seed_points(const Body& body, const shapes::Points& points) {
  shapes::PlacedPoints placed(points);
  const Mat3d R = rotation_from_degrees(body.shape.rotation);
  SeededBody seeded{std::move(placed), points.center, placed.volume};
  for (Vec3d& x : seeded.x) x = seeded.center + R * x;
  for (Vec3d& v : seeded.v) v = R * v;
  // The undeformed snow is not turned: F maps it to the snow that is.
  for (Mat3d& F_E : seeded.F_E) F_E = R * F_E;
  for (Mat3d& C : seeded.C) C = R * C * R.transpose();
  return seeded;
}

}  // namespace

double expected_particles(const Body& body, double cell_size) {
  if (const auto* points = std::get_if<shapes::Points>(&body.shape.form))
    return shapes::summary_of(*points, rotation_from_degrees(body.shape.rotation)).expected_count;
  return shapes::Solid(body.shape).volume() /
         std::pow(particle_spacing(body.particles_per_cell, cell_size), 3);
}

SeedingPlan plan_seeding(const Body& body, double cell_size) {
  if (const auto* points = std::get_if<shapes::Points>(&body.shape.form)) {
    const shapes::PointsSummary p =
        shapes::summary_of(*points, rotation_from_degrees(body.shape.rotation));
    return {p.volume,    p.count, {points->center + p.bounds.min, points->center + p.bounds.max},
            p.max_speed, p.V0,    p.mass};
  }
  const shapes::Solid solid(body.shape);
  const double count =
      expected_count(body, solid, particle_spacing(body.particles_per_cell, cell_size));
  return {solid.volume(), saturated(std::max(1.0, std::ceil(count))), solid.bounds(), 0, 0};
}

SeededBody seed_body(const Body& body, std::uint64_t body_index, std::uint64_t seed,
                     double cell_size) {
  if (const auto* points = std::get_if<shapes::Points>(&body.shape.form))
    return seed_points(body, *points);
  const shapes::Solid solid(body.shape);
  const double spacing = particle_spacing(body.particles_per_cell, cell_size);
  if (!(expected_count(body, solid, spacing) < max_particles))
    throw ShapeError("body " + body.name + ": more than 2^32 particles fit into it");

  const std::uint64_t key = mix64(mix64(seed), body_index);
  SeededBody seeded;
  seeded.center = solid.center();
  seeded.volume = solid.volume();
  switch (body.sampling) {
    case Sampling::jittered:
      seeded.x = sample_jittered(solid, spacing, key);
      break;
    case Sampling::poisson:
      seeded.x = sample_poisson(solid, spacing, key);
      break;
    case Sampling::lattice:
      seeded.x = sample_lattice(solid, spacing);
      break;
  }
  if (seeded.x.empty()) seeded.x.push_back(solid.inner_point());
  for (Vec3d& x : seeded.x) x = seeded.center + solid.rotation() * x;
  return seeded;
}

}  // namespace neve::sim::seeding
