#include "app/dry_run.h"

#include <algorithm>
#include <cmath>

#include "app/interrupt.h"
#include "app/seed_scene.h"

namespace neve::app {

namespace {

constexpr double particles_wanted = 1000;
constexpr double work_budget = 1.2e6;  // steps x particles, a fraction of a second
constexpr int moments = 24;

/// The poll of a simulation has no argument; each thread runs at most one dry run.
thread_local long steps_left = 0;

bool is_out_of_steps() {
  return --steps_left <= 0 || is_interrupted();
}

double planned_particles(const Scene& scene) {
  const double h = scene.solver.cell_size;
  double count = 0;
  for (const sim::Body& body : scene.bodies)
    count += sim::plan_seeding(body, h).volume / (h * h * h) * body.particles_per_cell;
  return count;
}

/// The scene with cells so large, and snow so soft, that the budget lasts. Soft snow spreads a
/// little more, which only widens the frame.
Scene coarsened(const Scene& scene) {
  Scene coarse = scene;
  coarse.solver.precision = sim::Precision::single;
  coarse.solver.time_step = sim::TimeStep::adaptive;
  const double growth = std::max(1.0, planned_particles(scene) / particles_wanted);
  coarse.solver.cell_size *= std::cbrt(growth);
  const double duration = scene.frames / scene.fps;
  // Twice what the budget would pay for: no estimate of the hardened stiffness is exact.
  const double dt = std::max(2 * duration * particles_wanted / work_budget, 1e-4);
  coarse.solver.max_dt = std::max(scene.solver.max_dt, dt);
  const double hardened = 3;  // of the sound speed, where snow is packed
  const double c = coarse.solver.acoustic_cfl * coarse.solver.cell_size / (hardened * dt);
  for (sim::Material& material : coarse.materials) {
    material.hardening = std::min(material.hardening, 4.0);
    material.youngs_modulus = std::min(material.youngs_modulus, 0.9 * material.density * c * c);
  }
  return coarse;
}

/// Bodies too thin for the coarse cells are left out of the motion.
sim::ParticleArrays seed_what_fits(const Scene& coarse) {
  sim::ParticleArrays particles;
  for (std::size_t index = 0; index < coarse.bodies.size(); ++index) {
    try {
      append_body(coarse, index, particles);
    } catch (const sim::ShapeError&) {
    }
  }
  return particles;
}

}  // namespace

std::vector<Moment> dry_run(const Scene& scene) {
  const Scene coarse = coarsened(scene);
  const sim::ParticleArrays particles = seed_what_fits(coarse);
  std::vector<Moment> seen;
  if (particles.x.empty()) return seen;
  seen.push_back({0, particles.x});

  sim::Simulation simulation(coarse.solver, coarse.materials, coarse.colliders, particles, 1);
  steps_left = std::lround(work_budget / static_cast<double>(particles.x.size()));
  const double duration = scene.frames / scene.fps;
  for (int k = 1; k <= moments && duration > 0; ++k) {
    simulation.advance_to(duration * k / moments, is_out_of_steps);
    if (simulation.divergence()) break;
    seen.push_back({simulation.time(), simulation.particles().x});
    if (steps_left <= 0) break;
  }
  return seen;
}

}  // namespace neve::app
