/// Self-tests of bodies that snow moves: momentum, light bodies, bodies that something holds up.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim/checks/self_test_bodies.h"
#include "sim/checks/self_test_tests.h"
#include "sim/rigid/rigid_bodies.h"
#include "sim/simulation.h"

namespace neve::sim::checks::self_test {

namespace {

constexpr double dt = 1e-3, seconds = 0.012;
/// Depth in cells to which snow may sink into a lid; contact that takes the lid for a free body
/// lets it sink a hundredth and more.
constexpr double deepest_in_lid = 0.005;

/// Impulses are whole numbers of 2^-30 of a full cell at 1 m/s; the light body got a few 1e-3 of
/// that.
constexpr Tolerance given_impulses{1e-5, 3e-3};

struct Momentum {
  Vec3d linear, angular;  ///< kg m/s; kg m2/s about the centre of mass
};
Momentum momentum_of(const shapes::Collider& body, double time) {
  const rigid::MassProperties mass = rigid::mass_properties(body);
  const rigid::Motion motion = rigid::motion_at(body, time);
  return {mass.mass * motion.velocity,
          motion.rotation * mass.inertia * motion.rotation.transpose() * motion.spin};
}

double lowest_of(const ParticleArrays& p) {
  double lowest = p.x[0][1];
  for (const Vec3d& x : p.x) lowest = std::min(lowest, x[1]);
  return lowest;
}

/// A block of snow falls on a cone that floats, beside its axis: the base of the cone is up.
shapes::Collider floating_cone(double density, double lowest) {
  shapes::Collider cone;
  const double height = 4 * cell_size, top = lowest - 0.3 * cell_size;
  cone.shape.form = shapes::Cone{{0.6 * cell_size, top - 0.5 * height, 0}, 9 * cell_size, height};
  cone.shape.rotation = {180, 0, 0};
  cone.body.density = density;
  return cone;
}

/// The body gets the momentum that snow loses, at its arm, and a light one does not fly away.
void snow_on_a_floating_body(const SelfTestCase& test, double density, Measure& measure) {
  ParticleArrays p = even_lattice();
  for (Vec3d& v : p.v) v = {0, -1, 0};
  const shapes::Collider start = floating_cone(density, lowest_of(p));
  Simulation simulation(settings_of(test), {Material{}}, {start}, p, 1);
  const Vec3d before = simulation.summary().momentum;
  Vec3d moment = Vec3d::Zero();
  double size = 0;
  double fastest = 0;
  while (simulation.time() < seconds && !simulation.divergence()) {
    const AdvanceReport report = simulation.advance_to(seconds, {}, simulation.steps() + 1);
    const shapes::Collider body = simulation.colliders()[0];
    const shapes::Pose pose = shapes::pose_at(body, simulation.time());
    fastest = std::max(fastest, -pose.velocity.y());
    const Vec3d arm = pose.rotation * rigid::mass_properties(start).centre;
    // Loads are about the point of the collider.
    moment += report.loads[0].angular_impulse - arm.cross(report.loads[0].impulse);
    size += report.loads[0].impulse.norm();
  }
  if (simulation.divergence()) return measure.failure(simulation.divergence()->sentence);
  const Momentum given = momentum_of(simulation.colliders()[0], simulation.time());
  const Vec3d change = simulation.summary().momentum + given.linear - before;
  measure.zero("momentum of snow and body", change.norm() / size, given_impulses);
  // Its arm turns a little in a step.
  measure.between("moment that turned the body, over that of the snow",
                  given.angular.norm() / moment.norm(), 0.97, 1.03);
  // A thousandth of the snow's mass: it is carried along.
  if (density < 1)
    measure.between("speed of a light body in any step over that of the snow", fastest, 0.98, 1.02);
}

/// A light plate on a floor carries the snow that falls on it: it stays, and nothing goes through.
void snow_on_a_lid(const SelfTestCase& test, Measure& measure) {
  SolverSettings settings = settings_of(test);
  settings.gravity = {0, -9.81, 0};
  ParticleArrays p = small_ball();
  const double lowest = lowest_of(p);
  for (Vec3d& v : p.v) v = {0, -1, 0};
  shapes::Collider lid, floor;
  const double thickness = cell_size, top = lowest - 0.2 * cell_size;
  lid.shape.form =
      shapes::Box{{0, top - 0.5 * thickness, 0}, {12 * cell_size, thickness, 12 * cell_size}};
  lid.body.density = 4;
  floor.shape.form = shapes::Plane{{0, top - thickness, 0}, {0, 1, 0}};
  Simulation simulation(settings, {Material{}}, {floor, lid}, p, 1);
  double moved = 0;
  for (int k = 0; k < 25; ++k) {
    simulation.step(dt);
    const shapes::Pose pose = shapes::pose_at(simulation.colliders()[1], simulation.time());
    moved = std::max(moved, std::abs(pose.point.y() - (top - 0.5 * thickness)));
  }
  measure.between("cells that a lid on the floor moves under snow", moved / cell_size, -0.05, 0.05);
  double deepest = 0;
  for (const Vec3d& x : simulation.particles().x) deepest = std::max(deepest, top - x[1]);
  measure.between("cells that snow sinks into the lid", deepest / cell_size, -deepest_in_lid,
                  deepest_in_lid);
}

}  // namespace

void bodies(const SelfTestCase& test, Measure& measure) {
  for (const double density : {0.4, 400.0}) snow_on_a_floating_body(test, density, measure);
  snow_on_a_lid(test, measure);
}

}  // namespace neve::sim::checks::self_test
