/// Snow that carries load between colliders: semi-implicit steps carry it as explicit ones do, at
/// nodes as at particles.

#include "tests/support/elastic.h"
#include "tests/support/snow.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

constexpr double load_cell = 0.02;

std::string name_of(ContactAt contact_at) {
  return contact_at == ContactAt::nodes ? "nodes" : "particles";
}

/// An elastic block of 6 x 5 x 6 cells that stands on a slippery floor.
constexpr double height = 5 * load_cell, width = 6 * load_cell;

ParticleArrays block() {
  const Vec3d low{0.5 * load_cell, 0, 0.5 * load_cell};
  return lattice(low, low + Vec3d(width, height, width), {12, 10, 12}, 400);
}

SolverSettings load_settings(double beta, ContactAt contact_at) {
  SolverSettings s;
  s.cell_size = load_cell;
  s.transfer = Transfer::apic;
  s.beta = beta;
  s.contact_at = contact_at;
  s.solve_iterations = 200;
  s.time_step = beta > 0 ? TimeStep::fixed : TimeStep::adaptive;
  s.dt = 1e-3;
  return s;
}

/// A floor half a particle's spacing below the particles, where contact at particles lets them
/// rest; nodes there are held as well.
shapes::Collider floor_below() {
  return plane({0, 1e-4, 0}, {0, 1, 0}, 0);
}

/// Returns the energy of a block pressed by 10 % of its height within 40 ms, and held there, J.
double pressed_energy(double beta, ContactAt contact_at, double youngs_modulus) {
  SolverSettings s = load_settings(beta, contact_at);
  s.gravity.setZero();
  const Vec3d above{width / 2, height + 2.5 * load_cell, width / 2};
  const Vec3d down = above - Vec3d(0, 0.1 * height, 0);
  shapes::Collider plate;
  plate.shape.form = shapes::Box{above, {3 * width, 5 * load_cell, 3 * width}};
  plate.keyframes = {{0, above, std::nullopt}, {0.04, down, std::nullopt}, {1, down, std::nullopt}};
  Simulation simulation(s, {elastic(youngs_modulus, 0.2, 400)}, {floor_below(), plate}, block(), 1);
  simulation.advance_to(0.15);
  EXPECT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
  EXPECT_EQ(simulation.warnings().solves_given_up, 0u);
  return simulation.summary().elastic_energy;
}

/// dt is 0.8 and 2.6 of the time that sound takes through a cell. A reference whose solve leaves
/// contact out has a sixth of the force at the second, and energy in proportion to its square.
TEST(Load, APressStoresInSemiImplicitStepsTheEnergyOfExplicitOnes) {
  for (const ContactAt contact_at : {ContactAt::nodes, ContactAt::particles})
    for (const double youngs_modulus : {1e5, 1e6}) {
      const std::string line = (contact_at == ContactAt::nodes ? "contact at nodes, E = "
                                                               : "contact at particles, E = ") +
                               in_digits(youngs_modulus);
      verify_ratio({"load", line, "energy of the pressed block, J"},
                   pressed_energy(0, contact_at, youngs_modulus),
                   pressed_energy(1, contact_at, youngs_modulus), 0.05);
    }
}

/// @return m, height of the centre of mass after 1.5 s
double rest_of_column(double beta, ContactAt contact_at, double youngs_modulus) {
  const SolverSettings s = load_settings(beta, contact_at);
  Simulation simulation(s, {elastic(youngs_modulus, 0, 400)}, {floor_below()}, block(), 1);
  simulation.advance_to(1.5);
  EXPECT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
  return simulation.summary().centre_of_mass[1];
}

/// The centre of mass of a column of height H sags by rho g H^2 / (3 E). Measured from where a
/// stiffer one rests, in steps of the same kind, so that the place of contact is no part of it. The
/// lowest cell is softer by what its nodes have in the floor, and springs of contacts give way:
/// 0.04 cells in 0.16.
TEST(Load, AColumnSagsInSemiImplicitStepsByItsWeight) {
  const double E = 4e3, expected = 400 * 9.81 * height * height / (3 * E) * (1 - 1.0 / 20);
  for (const ContactAt contact_at : {ContactAt::nodes, ContactAt::particles})
    for (const double beta : {0.0, 1.0}) {
      const double sag =
          rest_of_column(beta, contact_at, 20 * E) - rest_of_column(beta, contact_at, E);
      const std::string where = contact_at == ContactAt::nodes ? "nodes" : "particles";
      verify_near(
          {"load", "contact at " + where + ", beta = " + in_digits(beta), "sag of a column, cells"},
          expected / load_cell, sag / load_cell, 0.04);
    }
}

/// A piston presses the block by 5 % and lets go: its work is the energy of the block on the way
/// in, and it takes the work back on the way out. A tenth of the most: elastic snow loses the waves
/// of the start and the end.
TEST(Load, APistonTakesBackTheWorkThatItDid) {
  for (const ContactAt contact_at : {ContactAt::nodes, ContactAt::particles}) {
    SolverSettings s = load_settings(0, contact_at);
    s.gravity.setZero();
    s.precision = Precision::real64;
    const Vec3d above{width / 2, height + 2.5 * load_cell, width / 2};
    const Vec3d down = above - Vec3d(0, 0.05 * height, 0);
    shapes::Collider plate;
    plate.shape.form = shapes::Box{above, {3 * width, 5 * load_cell, 3 * width}};
    plate.keyframes = {
        {0, above, std::nullopt}, {0.2, down, std::nullopt}, {0.4, above, std::nullopt}};
    Simulation simulation(s, {elastic(1e5, 0.2, 400)}, {floor_below(), plate}, block(), 1);
    simulation.advance_to(0.195);
    const AdvanceReport report = simulation.advance_to(0.2);
    const EnergyAccount pressed = energy_account(simulation);
    // The largest pressure is more than the force over the area: it is at the edges of the block,
    // and at nodes, which press on a layer up to a cell thick.
    for (const std::size_t k : {std::size_t(0), std::size_t(1)}) {
      const double mean = report.loads[k].impulse.norm() / report.seconds / (width * width);
      EXPECT_GT(simulation.summary().max_pressure[k], mean) << k;
      EXPECT_LT(simulation.summary().max_pressure[k], 1.8 * mean) << k;
    }
    simulation.advance_to(0.4);
    const EnergyAccount released = energy_account(simulation);
    ASSERT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
    const std::string where = name_of(contact_at);
    verify_ratio({"load", "contact at " + where, "work of a piston on the way in, J"},
                 pressed.found, pressed.explained, 0.1);
    // Nothing made energy, to the error of the steps, and little of the work is still there.
    EXPECT_GE(released.explained, released.found - 0.01 * pressed.explained) << where;
    EXPECT_LT(released.explained, 0.15 * pressed.explained) << where;
  }
}

}  // namespace
