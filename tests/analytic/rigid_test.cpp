/// Snow and bodies that it moves, against closed formulas: a ball that sinks, a plate that hangs, a
/// block on a slope of snow, a lid under snow, a body as heavy as the earth.

#include <Eigen/Geometry>

#include "tests/support/bodies.h"
#include "tests/support/rest.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

/// Mean force of the snow on a collider over the next seconds, N.
Vec3d mean_force(Simulation& simulation, std::size_t collider, double seconds) {
  const AdvanceReport report = simulation.advance_to(simulation.time() + seconds);
  return report.loads.at(collider).impulse / report.seconds;
}

shapes::Collider floor_at(double y, double friction = 0.5) {
  return plane({0, y, 0}, {0, 1, 0}, friction);
}

/// It sinks until the snow carries it.
TEST(RigidProof, ABallSinksUntilTheSnowCarriesIt) {
  SolverSettings s;
  s.cell_size = 0.02;
  shapes::Collider ball = ball_of(900, {0, 0.2, 0}, 0.08);
  Simulation simulation(s, {Material{}}, {floor_at(0), ball},
                        box_of_snow({-0.2, 0, -0.2}, {0.2, 0.12, 0.2}, 0.01), 2);
  simulation.advance_to(0.8);
  const auto height = [&] {
    return shapes::pose_at(simulation.colliders()[1], simulation.time()).point.y();
  };
  const double depth = height();
  const Vec3d force = mean_force(simulation, 1, 0.2);
  const double weight = rigid::mass_properties(ball).mass * 9.81;
  verify_ratio({"rigid", "a ball on snow", "force of the snow over its weight"}, 1,
               force.y() / weight, 0.01);
  // Elastic snow rings below it, by a fifth of a millimetre.
  verify_near({"rigid", "a ball on snow", "how far it sank in the last 0.2 s, mm"}, 0,
              1e3 * (depth - height()), 0.3);
  EXPECT_LT(depth, 0.2);
  EXPECT_GT(depth, 0.1);
}

/// A light plate lies on the floor, under snow: neither goes through the other.
TEST(RigidProof, SnowOnALightLidIsCarried) {
  for (const double density : {1.0, 100.0, 5000.0}) {
    SolverSettings s;
    s.cell_size = 0.02;
    const shapes::Collider lid = box_of(density, {0, 0.02, 0}, {0.24, 0.04, 0.24});
    const ParticleArrays snow = box_of_snow({-0.1, 0.05, -0.1}, {0.1, 0.2, 0.1}, 0.01);
    Simulation simulation(s, {Material{}}, {floor_at(0), lid}, snow, 1);
    double lowest = 1, highest = -1;
    while (simulation.time() < 0.4) {
      simulation.step(simulation.choose_dt(1).dt);
      const double y = shapes::pose_at(simulation.colliders()[1], simulation.time()).point.y();
      lowest = std::min(lowest, y);
      highest = std::max(highest, y);
    }
    const Vec3d force = mean_force(simulation, 1, 0.1);
    const double weight = simulation.summary().mass * 9.81;
    const std::string line = "a lid of " + in_digits(density) + " kg/m3 under snow";
    verify_ratio({"rigid", line, "force on it over the weight of the snow"}, 1, -force.y() / weight,
                 0.02);
    verify_near({"rigid", line, "how far it was ever pushed down, mm"}, 0, 1e3 * (0.02 - lowest),
                0.5);
    verify_near({"rigid", line, "how far it ever sprang up, mm"}, 0, 1e3 * (highest - 0.02), 0.5);
    double lowest_snow = 1;
    for (const Vec3d& x : simulation.particles().x) lowest_snow = std::min(lowest_snow, x[1]);
    verify_at_least({"rigid", line, "the lowest snow, mm"}, 40, 1e3 * lowest_snow);
  }
}

/// A snowball hits a plate that hangs from a hinge: what turns is the moment that it brought.
TEST(RigidProof, ASnowballTurnsAPlateThatHangs) {
  SolverSettings s;
  s.cell_size = 0.02;
  s.gravity = Vec3d::Zero();
  shapes::Collider plate = box_of(400, {0, -0.2, 0}, {0.04, 0.4, 0.3});
  plate.body.joint = shapes::Joint::hinge;
  plate.body.joint_axis = {0, 0, 1};
  plate.contact = shapes::Contact::sticky;
  const ParticleArrays ball = ball_of_snow({-0.1, -0.25, 0}, 0.06, 0.008, {3, 0, 0});
  Simulation simulation(s, {Material{}}, {plate}, ball, 1);
  const auto moment = [&] {
    const ParticleArrays p = simulation.particles();
    double sum = 0;
    for (std::size_t q = 0; q < p.x.size(); ++q) sum += p.x[q].cross(p.m[q] * p.v[q]).z();
    return sum;
  };
  const double before = moment();
  const double energy_before = simulation.summary().kinetic_energy;
  simulation.advance_to(0.06);
  const BodyMomentum got = momentum_of(simulation.colliders()[0], simulation.time());
  // C carries moment, too: FLIP has none. The rest is the order of the staggering, dt.
  verify_ratio(
      {"rigid", "a snowball on a hanging plate", "moment about the hinge, after over before"}, 1,
      (moment() + got.angular.z()) / before, 0.02);
  const double energy = simulation.summary().kinetic_energy + simulation.summary().elastic_energy;
  verify_at_most({"rigid", "a snowball on a hanging plate", "energy, after over before"}, 1.001,
                 (energy + got.kinetic) / energy_before);
  EXPECT_GT(got.kinetic, 0.05 * energy_before);
}

/// The snow is held by its bed; the block is heavier than the snow below it, which packs.
TEST(RigidProof, ABlockOnASlopeOfSnowSlidesBeyondTheFrictionAngle) {
  for (const double degrees : {12.0, 24.0}) {
    const double a = degrees * std::numbers::pi / 180, mu = std::tan(18 * std::numbers::pi / 180);
    SolverSettings s;
    s.cell_size = 0.02;
    s.gravity = 9.81 * Vec3d(std::sin(a), -std::cos(a), 0);
    shapes::Collider block = box_of(300, {0, 0.135, 0}, {0.12, 0.06, 0.12});
    block.friction = mu;
    Material packed;
    packed.youngs_modulus = 1e6;
    packed.critical_compression = 0.1;
    packed.critical_stretch = 0.05;
    Simulation simulation(s, {packed},
                          {plane({0, 0, 0}, {0, 1, 0}, 0, shapes::Contact::sticky), block},
                          box_of_snow({-0.2, 0, -0.1}, {0.4, 0.1, 0.1}, 0.01), 2);
    simulation.advance_to(0.1);
    const double start = motion_of(simulation, 1).velocity.x();
    simulation.advance_to(0.3);
    const double gained = (motion_of(simulation, 1).velocity.x() - start) / 0.2;
    const double exact = std::max(0.0, 9.81 * (std::sin(a) - mu * std::cos(a)));
    verify_near({"rigid", "a block on snow at " + in_digits(degrees) + " degrees, friction of 18",
                 "acceleration, m/s2"},
                exact, gained, 0.15);
  }
}

/// Nothing moves it, and snow does what it does at a collider of the scene.
TEST(RigidProof, ABodyAsHeavyAsTheEarthIsACollider) {
  SolverSettings s;
  s.cell_size = 0.02;
  shapes::Collider heavy = box_of(0, {0, -0.1, 0}, {0.6, 0.2, 0.6});
  heavy.friction = 0.5;
  const ParticleArrays ball = ball_of_snow({0, 0.09, 0}, 0.08, 0.008, {0.5, -4, 0});
  Simulation fixed(s, {Material{}}, {heavy}, ball, 1);
  heavy.body.mass = 5.972e24;
  heavy.body.hold = {shapes::HeldAxis::y};
  Simulation body(s, {Material{}}, {heavy}, ball, 1);
  fixed.advance_to(0.1);
  body.advance_to(0.1);
  // Contact is solved by more passes.
  verify_ratio(
      {"rigid", "a body as heavy as the earth", "height of the snow, of that at a collider"}, 1,
      body.summary().centre_of_mass[1] / fixed.summary().centre_of_mass[1], 0.02);
  EXPECT_LE((body.summary().momentum - fixed.summary().momentum).norm(),
            0.02 * body.summary().mass * 4);
}

}  // namespace
