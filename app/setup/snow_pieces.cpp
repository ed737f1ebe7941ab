#include "app/setup/snow_pieces.h"

#include <algorithm>

#include "app/setup/seed_scene.h"
#include "sim/health/diagnostics.h"
#include "sim/health/limits.h"
#include "sim/shapes/solid.h"

namespace neve::app::setup {

namespace {

const sim::Material& material_of(const scene::Scene& scene, const std::string& name) {
  return scene.materials[material_index(scene, name)];
}

double emission(const scene::Scene& scene, const sim::seeding::Emitter& emitter, double time) {
  return static_cast<double>(sim::seeding::count_emitted(
      emitter, material_of(scene, emitter.material), scene.solver.cell_size, time));
}

}  // namespace

std::vector<SnowPiece> snow_places(const scene::Scene& scene) {
  std::vector<SnowPiece> pieces;
  for (const sim::seeding::Body& body : scene.bodies)
    pieces.push_back({"body." + body.name, &body.shape, &material_of(scene, body.material),
                      body.velocity, body.angular_velocity, body.J_P});
  for (const sim::seeding::Emitter& emitter : scene.emitters)
    pieces.push_back({"emitter." + emitter.name, &emitter.shape,
                      &material_of(scene, emitter.material), emitter.velocity,
                      emitter.angular_velocity, emitter.J_P});
  return pieces;
}

std::vector<SnowPiece> snow_pieces(const scene::Scene& scene) {
  const double h = scene.solver.cell_size, cell = h * h * h;
  std::vector<SnowPiece> pieces = snow_places(scene);
  auto piece = pieces.begin();
  for (const sim::seeding::Body& body : scene.bodies) {
    const sim::seeding::SeedingPlan plan = sim::seeding::plan_seeding(body, h);
    piece->volume = plan.volume;
    const double V0 = plan.V0 > 0 ? plan.V0 : plan.volume / body.J_P;
    piece->mass = plan.mass > 0 ? plan.mass : piece->material->density * V0;
    piece->particles = sim::seeding::expected_particles(body, h);
    ++piece;
  }
  for (const sim::seeding::Emitter& emitter : scene.emitters) {
    piece->particles = emission(scene, emitter, scene::duration(scene));
    piece->volume = piece->particles * cell / emitter.particles_per_cell;
    piece->mass = density_at_birth(emitter, *piece->material) * piece->volume;
    ++piece;
  }
  return pieces;
}

double largest_extent(const scene::Scene& scene) {
  double largest = 0;
  for (const SnowPiece& piece : snow_places(scene)) {
    const sim::shapes::Bounds box = sim::shapes::bounds(*piece.shape);
    largest = std::max(largest, (box.max - box.min).maxCoeff());
  }
  return largest;
}

bool is_too_large(const scene::Scene& scene) {
  // Maps are in metres.
  const auto is_terrain = [](const sim::shapes::Collider& collider) {
    return std::holds_alternative<sim::shapes::Terrain>(collider.shape.form);
  };
  return !std::ranges::any_of(scene.colliders, is_terrain) &&
         largest_extent(scene) > sim::health::limits_of(sim::health::Law::extent).check_warning;
}

double sound_speed(const SnowPiece& piece) {
  const sim::Material& m = *piece.material;
  return sim::health::wave_speed(m, sim::Mat3d::Identity(), piece.J_P, m.density);
}

double speed_of_spin(const SnowPiece& piece) {
  const sim::shapes::Bounds box = sim::shapes::bounds(*piece.shape);
  const sim::Vec3d half = 0.5 * (box.max - box.min);
  if (std::holds_alternative<sim::shapes::Sphere>(piece.shape->form))
    return piece.angular_velocity.norm() * half.x();
  double speed = 0;
  for (const double y : {half.y(), -half.y()})
    for (const double z : {half.z(), -half.z()})
      speed = std::max(speed, piece.angular_velocity.cross(sim::Vec3d(half.x(), y, z)).norm());
  return speed;
}

double planned_emission(const scene::Scene& scene, double time) {
  double count = 0;
  for (const sim::seeding::Emitter& emitter : scene.emitters)
    count += emission(scene, emitter, time);
  return count;
}

sim::seeding::Flow flow_of(const scene::Scene& scene) {
  return {scene.emitters, scene.sinks, scene.seed};
}

}  // namespace neve::app::setup
