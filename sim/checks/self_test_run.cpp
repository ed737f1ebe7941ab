/// Self-tests of what a run does around its steps: length of steps, sums, births.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim/checks/self_test_bodies.h"
#include "sim/checks/self_test_tests.h"
#include "sim/health/diagnostics.h"
#include "sim/types/time_step.h"

namespace neve::sim::checks::self_test {

namespace {

double allowed(const StepLimits& limits, DtLimit limit) {
  return limits.dt[static_cast<std::size_t>(limit)];
}

/// c^2 = (lambda + 2 mu) e^(xi (1 - J_P)) V0 / m of undeformed particles: each has another J_P and
/// another density than its material.
void sound_of_hardened_snow(const SelfTestCase& test, Measure& measure) {
  Numbers number(50);
  ParticleArrays p = isolated_particles(12);
  const Material material;
  const Lame rest = lame(material.youngs_modulus, material.poisson_ratio);
  double c_squared = 0, speed = 0;
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    p.J_P[q] = 0.95 + 0.1 * number();
    p.m[q] *= 2 + number();
    p.v[q] = number.vector();
    c_squared =
        std::max(c_squared, (rest.lambda + 2 * rest.mu) *
                                std::exp(material.hardening * (1 - p.J_P[q])) * p.V0[q] / p.m[q]);
    speed = std::max(speed, p.v[q].norm());
  }
  SolverSettings settings = settings_of(test);
  settings.max_dt = 1;
  const Simulation simulation(settings, {material}, {}, p, 1);
  const StepLimits limits = simulation.step_limits();
  measure.zero("sound speed", limits.max_sound_speed / std::sqrt(c_squared) - 1);
  measure.zero("dt by the speed of particles",
               allowed(limits, DtLimit::cfl) * speed / (settings.cfl * cell_size) - 1);
  const double crossed = simulation.choose_dt(1).dt * std::sqrt(c_squared) / cell_size;
  measure.between("cells that sound crosses in a step", crossed, 0, 1.001 * settings.acoustic_cfl);
}

/// Snow that a fast collider strikes hardens within the step: dt leaves sound less than a cell even
/// then, and takes no more than the rounds of its search have to (0.8 each).
void look_ahead_of_colliders(const SelfTestCase& test, Measure& measure) {
  constexpr double c = 10, xi = 10;
  SolverSettings settings = settings_of(test);
  settings.max_dt = settings.cfl = 1e3;
  StateLimits limits;
  limits.max_sound_speed = c;
  limits.max_hardened_speed = 1e3 * c;
  limits.max_xi = xi;
  limits.max_collider_speed = c;
  const double crossed = choose_dt(settings, limits, 1e3, 1).dt / cell_size;
  measure.between("cells that sound crosses in snow that a collider strikes",
                  c * crossed * std::exp(0.5 * xi * c * crossed), 0.3, 1);
}

/// The strain of a shear flow, at the start and after a step; at the surface of the body the grid
/// sees less of it, or little more.
void strain_of_shear(const SelfTestCase& test, Measure& measure) {
  constexpr double rate = 0.8;
  ParticleArrays p = even_lattice();
  Mat3d A = Mat3d::Zero();
  A(0, 1) = rate;
  p.C.assign(p.x.size(), A);
  for (std::size_t q = 0; q < p.x.size(); ++q) p.v[q] = A * p.x[q];
  const Material material = without_stiffness();
  Simulation simulation(settings_of(test), {material}, {}, p, 1);
  for (int step = 0; step < 2; ++step) {
    measure.between("strain rate of a shear flow over its rate",
                    simulation.step_limits().max_strain_rate / rate, 0.999, 1.5);
    simulation.step(1e-4);
  }
}

/// v_p = alpha (v_p - sum w v_old) + sum w v_new with the alpha of this step's own length.
void damping_of_the_step(const SelfTestCase& test, Measure& measure) {
  if (test.transfer != Transfer::flip) return;
  constexpr double dt = 1.7e-3;
  Numbers number(52);
  SolverSettings settings = settings_of(test);
  settings.flip_reference_dt = 5e-4;
  ParticleArrays p = small_ball();
  for (Vec3d& v : p.v) v = number.vector();
  const Material material = without_stiffness();
  const Simulation simulation(settings, {material}, {}, p, 1);
  p = simulation.particles();
  const StagedStep step = staged_step(simulation, dt);
  const double alpha = std::pow(settings.flip_ratio, dt / settings.flip_reference_dt);
  for (std::size_t q = 0; q < p.x.size(); q += 16) {
    const Vec3d expected =
        alpha * p.v[q] + (1 - alpha) * grid_velocity(test.kernel, step.nodes, p.x[q]);
    measure.zero("velocity of FLIP", (step.after.v[q] - expected).norm());
  }
}

}  // namespace

void time_step(const SelfTestCase& test, Measure& measure) {
  sound_of_hardened_snow(test, measure);
  look_ahead_of_colliders(test, measure);
  strain_of_shear(test, measure);
  damping_of_the_step(test, measure);
}

/// Mass, momenta and energies of a summary against the sums of their definitions.
void sums(const SelfTestCase& test, Measure& measure) {
  Numbers number(51);
  ParticleArrays p = small_ball();
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    p.v[q] = number.vector();
    p.F_E.push_back(Mat3d::Identity() + 0.05 * number.matrix());
    p.C.push_back(1 / cell_size * number.matrix());
    p.stiffness.push_back(1 + 0.5 * number());
  }
  const SolverSettings settings = settings_of(test);
  const Simulation simulation(settings, {Material{}}, {}, p, 1);
  p = simulation.particles();
  const double D = settings.has_affine_velocity() ? inertia(test.kernel) : 0;
  double mass = 0, kinetic = 0, elastic = 0;
  Vec3d momentum = Vec3d::Zero(), moment = Vec3d::Zero(), angular = Vec3d::Zero();
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    const Mat3d& C = p.C[q];
    mass += p.m[q];
    momentum += p.m[q] * p.v[q];
    moment += p.m[q] * p.x[q];
    const Vec3d turning(C(2, 1) - C(1, 2), C(0, 2) - C(2, 0), C(1, 0) - C(0, 1));
    angular += p.m[q] * (p.x[q].cross(p.v[q]) + D * turning);
    kinetic += 0.5 * p.m[q] * (p.v[q].squaredNorm() + D * C.squaredNorm());
    elastic += p.V0[q] * p.stiffness[q] * health::energy_density(Material{}, p.F_E[q], p.J_P[q]);
  }
  const Summary found = simulation.summary();
  const double radius = 2 * cell_size;
  measure.zero("mass", found.mass / mass - 1);
  measure.zero("momentum", (found.momentum - momentum).norm() / mass);
  measure.zero("centre of mass", (found.centre_of_mass - moment / mass).norm() / radius);
  measure.zero("angular momentum", (found.angular_momentum - angular).norm() / (mass * radius));
  measure.zero("kinetic energy", found.kinetic_energy / kinetic - 1);
  measure.zero("elastic energy", found.elastic_energy / elastic - 1);
}

/// An emitter inside of a body has no room, elsewhere it has all births that are due.
void births(const SelfTestCase& test, Measure& measure) {
  constexpr Tolerance counted{0.5, 0.5};
  constexpr double dt = 1e-3;
  constexpr int steps = 4;
  seeding::Emitter emitter;
  emitter.material = Material{}.name;
  emitter.rate = 10;
  emitter.particles_per_cell = 2;  // as the lattice
  const Material material = without_stiffness();
  for (const double aside : {0.0, 40.0}) {
    emitter.shape.form = shapes::Sphere{{aside * cell_size, 0, 0}, 1.5 * cell_size};
    Simulation simulation(settings_of(test), {material}, {}, even_lattice(), 1, Vec3i::Zero(),
                          {{emitter}, {}, 1});
    for (int k = 0; k < steps; ++k) simulation.step(dt);
    const double due =
        static_cast<double>(seeding::count_emitted(emitter, material, cell_size, steps * dt));
    const seeding::FlowTotals totals = simulation.flow_totals();
    const double born = static_cast<double>(totals.emitted);
    const double waiting = static_cast<double>(totals.withheld);
    measure.zero("births that are due", born + waiting - due, counted);
    measure.zero(aside > 0 ? "births that wait in empty space" : "births inside of a body",
                 aside > 0 ? waiting : born, counted);
  }
}

}  // namespace neve::sim::checks::self_test
