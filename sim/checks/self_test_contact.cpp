/// Self-tests of contact with colliders: velocities after it, impulses and work.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim/checks/self_test_bodies.h"
#include "sim/checks/self_test_tests.h"
#include "sim/shapes/collider.h"

namespace neve::sim::checks::self_test {

namespace {

using shapes::Contact;

/// Two steps of different length, s: the collider has moved by a part of a cell before the second.
constexpr double first_dt = 0.02, second_dt = 0.01;
/// Places nearer to a surface than this are inside or outside by rounding, m.
constexpr double unsure = 1e-4 * cell_size;

/// Impulses are added as multiples of 2^-30 of a full cell at 1 m/s, those here are about a
/// hundredth of that.
constexpr Tolerance added_impulses{1e-6, 2e-5};

/// Cells, in 60 steps: 3e-4 at most are found, 4e-4 to 2e-3 where every step begins without
/// impulses.
constexpr double max_sunk = 6e-4;

/// Planes through isolated particles: of some blocks only a corner is inside.
shapes::Collider moving_plane(int k, Contact contact) {
  Numbers number(20 + static_cast<unsigned>(k));
  shapes::Collider plane;
  const Vec3d middle = Vec3d::Constant(7 * cell_size);
  const Vec3d point = middle + 2 * cell_size * number.vector();
  plane.shape.form = shapes::Plane{point, number.vector().normalized()};
  plane.contact = contact;
  plane.friction = 0.4;
  plane.velocity = 0.5 * number.vector();
  return plane;
}

/// The paper, section 8, with a velocity along the normal that may be other than 0.
/// @param least  m/s, along the normal and relative to the surface, that is not undercut
Vec3d after_contact(const shapes::Collider& c, const shapes::Surface& surface, const Vec3d& v,
                    double least) {
  if (c.contact == Contact::sticky) return surface.velocity;
  const Vec3d relative = v - surface.velocity;
  const double v_n = relative.dot(surface.normal);
  const Vec3d along = relative - v_n * surface.normal;
  if (c.contact == Contact::slip) return surface.velocity + along;
  if (v_n >= least) return v;
  const double kept = 1 - c.friction * (least - v_n) / along.norm();
  return surface.velocity + least * surface.normal + std::max(0.0, kept) * along;
}

/// Impulses and their moments, of snow and of a collider.
struct Impulses {
  Vec3d sum = Vec3d::Zero(), moment = Vec3d::Zero();
  double size = 0;  ///< N s, of all without sign

  void add(const Vec3d& impulse, const Vec3d& arm) {
    sum += impulse;
    moment += arm.cross(impulse);
    size += impulse.norm();
  }
};

/// The impulse that the step took from the snow is the one that it gives to the collider.
void check_load(const ParticleArrays& before, const StagedStep& step, const shapes::Collider& c,
                double time, Measure& measure) {
  const Vec3d point = shapes::pose_at(c, time).point;
  Impulses snow;
  for (std::size_t i = 0; i < step.nodes.mass.size(); ++i)
    snow.add(step.nodes.mass[i] * (step.nodes.v_new[i] - step.nodes.v_free[i]),
             place(step.nodes.node[i]) - point);
  for (std::size_t q = 0; q < before.x.size(); ++q)
    snow.add(before.m[q] * (step.after.v[q] - step.v_before_collision[q]), before.x[q] - point);
  measure.zero("impulse on the collider", (snow.sum + step.loads[0].impulse).norm() / snow.size,
               added_impulses);
  measure.zero("moment of the impulse",
               (snow.moment + step.loads[0].angular_impulse).norm() / (snow.size * 10 * cell_size),
               added_impulses);
}

/// Takes a step. The energy that it explains, without gravity, is the work of the collider: of one
/// that moves away from snow that sticks to it as well.
void check_load_and_work(Simulation& simulation, const shapes::Collider& c, double dt,
                         Measure& measure) {
  const StagedStep step = staged_step(simulation, dt);
  check_load(simulation.particles(), step, c, simulation.time(), measure);
  const EnergyAccount before = energy_account(simulation);
  simulation.step(dt);
  const double work = energy_account(simulation).explained - before.explained;
  measure.zero("work of the collider",
               (work + step.loads[0].impulse.dot(c.velocity)) / before.found, added_impulses);
}

ParticleArrays moving_particles(int seed) {
  Numbers number(30 + static_cast<unsigned>(seed));
  ParticleArrays p = isolated_particles(18);
  for (Vec3d& v : p.v) v = number.vector();
  return p;
}

SolverSettings settings_with(const SelfTestCase& test, ContactAt contact_at) {
  SolverSettings settings = settings_of(test);
  settings.contact_at = contact_at;
  return settings;
}

/// Nodes inside get the velocity of the law, others keep theirs.
void contact_at_nodes(const SelfTestCase& test, Measure& measure) {
  for (int k = 0; k < 3; ++k) {
    const shapes::Collider plane = moving_plane(k, static_cast<Contact>(k % 3));
    Simulation simulation(settings_with(test, ContactAt::nodes), {without_stiffness()}, {plane},
                          moving_particles(k), 1);
    check_load_and_work(simulation, plane, first_dt, measure);
    const NodeFields nodes = staged_step(simulation, second_dt).nodes;
    for (std::size_t i = 0; i < nodes.mass.size(); ++i) {
      const shapes::Surface surface =
          shapes::surface_at(plane, simulation.time(), place(nodes.node[i]));
      if (std::abs(surface.distance) < unsure) continue;
      const Vec3d expected = surface.distance < 0
                                 ? after_contact(plane, surface, nodes.v_free[i], 0)
                                 : nodes.v_free[i];
      measure.zero("velocity of a node after contact", (nodes.v_star[i] - expected).norm());
    }
  }
}

/// Particles alone that come to touch a plane. Nearer ones would be moved away from it.
ParticleArrays particles_above(const shapes::Collider& plane, int seed) {
  constexpr double apart = 8 * cell_size;
  Numbers number(30 + static_cast<unsigned>(seed));
  const auto& [point, normal] = std::get<shapes::Plane>(plane.shape.form);
  const Vec3d along = normal.unitOrthogonal(), across = normal.cross(along);
  ParticleArrays p = isolated_particles(9);
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    const double k = static_cast<double>(q % 3), l = static_cast<double>(q / 3);
    p.x[q] = point + apart * (k * along + l * across) + (0.3 + 0.1 * number()) * cell_size * normal;
    p.v[q] = plane.velocity + number.vector() - normal;
  }
  return p;
}

/// A particle alone that would come nearer than three eighths of its spacing ends the step there,
/// and friction slows it.
void contact_at_particles(const SelfTestCase& test, Measure& measure) {
  for (int k = 0; k < 2; ++k) {
    const shapes::Collider plane = moving_plane(k, Contact::separate);
    Simulation simulation(settings_with(test, ContactAt::particles), {without_stiffness()}, {plane},
                          particles_above(plane, k), 1);
    const ParticleArrays before = simulation.particles();
    const StagedStep step = staged_step(simulation, second_dt);
    const double spacing = std::cbrt(before.m[0] / Material{}.density);
    for (std::size_t q = 0; q < before.x.size(); ++q) {
      const shapes::Surface surface = shapes::surface_at(plane, simulation.time(), before.x[q]);
      const double gap = surface.distance - 0.375 * spacing;
      const Vec3d expected = after_contact(plane, surface, before.v[q], -gap / second_dt);
      measure.zero("velocity of a particle after contact", (step.after.v[q] - expected).norm());
    }
    check_load_and_work(simulation, plane, second_dt, measure);
  }
}

/// The solve leaves the directions alone that contact holds: a node inside that came to rest along
/// the normal stays so, one that sticks keeps the velocity of the surface.
void contact_in_the_solve(const SelfTestCase& test, Measure& measure) {
  Numbers number(40);
  SolverSettings settings = settings_with(test, ContactAt::nodes);
  settings.beta = 1;
  ParticleArrays p = small_ball();
  for (Vec3d& v : p.v) v = number.vector();
  for (const Contact contact : {Contact::separate, Contact::sticky}) {
    shapes::Collider plane = moving_plane(0, contact);
    std::get<shapes::Plane>(plane.shape.form).point.setZero();
    const Simulation simulation(settings, {Material{}}, {plane}, p, 1);
    const StagedStep step = staged_step(simulation, 1e-3);
    for (std::size_t i = 0; i < step.nodes.mass.size(); ++i) {
      const shapes::Surface surface = shapes::surface_at(plane, 0, place(step.nodes.node[i]));
      const Vec3d v = step.nodes.v_new[i] - surface.velocity;
      const double came = (step.nodes.v_free[i] - surface.velocity).dot(surface.normal);
      if (surface.distance > -unsure) continue;
      if (contact == Contact::sticky)
        measure.zero("velocity of a node that sticks, after the solve", v.norm());
      else if (came < 0)
        measure.zero("velocity of a node along the normal, after the solve", v.dot(surface.normal));
    }
  }
}

/// A block of particles that stands on a floor, as chance has them; the lowest layer touches it.
ParticleArrays standing_block(double height) {
  constexpr int side = 5, layers = 4;
  constexpr double spacing = 0.5 * cell_size;
  Numbers number(60);
  ParticleArrays p;
  for (int k = 0; k < side * side * layers; ++k) {
    const int layer = k / (side * side);
    Vec3d jitter = 0.3 * spacing * number.vector();
    if (layer == 0) jitter[1] = 0;
    p.x.push_back(spacing * Vec3d(k % side, layer + 0.375, k / side % side) + jitter);
    p.x.back()[1] += height;
    p.m.push_back(density * spacing * spacing * spacing);
    p.V0.push_back(spacing * spacing * spacing);
    p.v.emplace_back(0, 0, 0);
  }
  return p;
}

/// Impulses last from step to step, so contact that answers in few passes holds a weight whole: the
/// block does not sink into the touching distance, three eighths of a spacing.
void contact_that_lasts(const SelfTestCase& test, Measure& measure) {
  constexpr double dt = 1e-3, height = 0.3 * cell_size;
  constexpr int steps = 60;
  SolverSettings settings = settings_with(test, ContactAt::particles);
  settings.gravity = {0, -9.81, 0};
  Material elastic = elastic_material();
  elastic.youngs_modulus = 1e5;
  shapes::Collider floor;
  floor.shape.form = shapes::Plane{{0, height, 0}, {0, 1, 0}};
  const ParticleArrays start = standing_block(height);
  Simulation simulation(settings, {elastic}, {floor}, start, 1);
  for (int k = 0; k < steps; ++k) simulation.step(dt);
  double lowest = start.x[0][1];
  for (const Vec3d& x : simulation.particles().x) lowest = std::min(lowest, x[1]);
  measure.between("cells that a block sinks into a floor", (start.x[0][1] - lowest) / cell_size, 0,
                  max_sunk);
}

/// A solve that stops early leaves a rest, which is in the snow's velocities and in no spring:
/// the collider gets it, too.
void contact_after_a_loose_solve(const SelfTestCase& test, Measure& measure) {
  constexpr double dt = 4e-3, height = -1.6 * cell_size;
  SolverSettings settings = settings_with(test, ContactAt::particles);
  settings.beta = 1;
  settings.solve_tolerance = 0.3;
  ParticleArrays p = small_ball();
  for (Vec3d& v : p.v) v = {0.3, -1, 0};
  shapes::Collider floor;
  floor.shape.form = shapes::Plane{{0, height, 0}, {0, 1, 0}};
  const Simulation simulation(settings, {Material{}}, {floor}, p, 1);
  p = simulation.particles();
  const StagedStep step = staged_step(simulation, dt);
  Vec3d taken = step.loads[0].impulse;
  double size = taken.norm();
  for (std::size_t q = 0; q < p.x.size(); ++q) taken += p.m[q] * (step.after.v[q] - p.v[q]);
  measure.zero("momentum of snow and collider in a loose solve", taken.norm() / size,
               added_impulses);
}

}  // namespace

void contact(const SelfTestCase& test, Measure& measure) {
  contact_at_nodes(test, measure);
  contact_at_particles(test, measure);
  contact_that_lasts(test, measure);
  contact_in_the_solve(test, measure);
  contact_after_a_loose_solve(test, measure);
}

}  // namespace neve::sim::checks::self_test
