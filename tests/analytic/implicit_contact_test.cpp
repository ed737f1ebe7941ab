/// Contact in semi-implicit steps: forces that are what changed the snow, nothing gained, nothing
/// given up where there is nothing to solve.

#include "tests/support/elastic.h"
#include "tests/support/snow.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

SolverSettings semi_implicit(double max_dt) {
  SolverSettings s;
  s.cell_size = 0.02;
  s.beta = 1;
  s.max_dt = max_dt;
  return s;
}

std::string place_of(ContactAt contact_at) {
  return contact_at == ContactAt::nodes ? "nodes" : "particles";
}

/// A slab of 5 x 10 x 5 cells on a floor, or a little above it.
ParticleArrays slab(const Vec3d& velocity) {
  ParticleArrays p = lattice({-0.05, 0.005, -0.05}, {0.05, 0.205, 0.05}, {10, 20, 10}, 400);
  p.v.assign(p.x.size(), velocity);
  return p;
}

shapes::Collider floor_of_slab() {
  return plane({0, 0.005, 0}, {0, 1, 0}, 0.5);
}

/// The worst of some frames: what snow lost and colliders did not get, over the weight.
double worst_closure(SolverSettings s, double youngs_modulus, std::size_t& cut_short) {
  Material material;
  material.youngs_modulus = youngs_modulus;
  Simulation simulation(s, {material}, {floor_of_slab()}, slab({0.3, -0.5, 0}), 1);
  const double frame = 0.05;
  Summary before = simulation.summary();
  double worst = 0;
  for (int k = 1; k <= 4; ++k) {
    const AdvanceReport report = simulation.advance_to(frame * k);
    EXPECT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
    const Summary now = simulation.summary();
    const Vec3d weight = now.mass * frame * s.gravity;
    const Vec3d lost = before.momentum + weight - now.momentum;
    worst = std::max(worst, (report.loads.at(0).impulse - lost).norm() / weight.norm());
    before = now;
  }
  cut_short = simulation.warnings().solves_cut_short;
  return worst;
}

/// A solve may leave something undone: forces are sums of momenta, right to the rounding of float.
TEST(SemiImplicitContact, MomentumClosesInEveryFrame) {
  for (const ContactAt contact_at : {ContactAt::particles, ContactAt::nodes})
    for (const double youngs_modulus : {1e5, 1e6, 1e7}) {
      SolverSettings s = semi_implicit(4e-3);
      s.contact_at = contact_at;
      std::size_t cut_short = 0;
      const std::string line =
          "contact at " + place_of(contact_at) + ", E = " + in_digits(youngs_modulus);
      verify_at_most({"semi-implicit contact", line, "momentum that nothing explains / weight"},
                     1e-5, worst_closure(s, youngs_modulus, cut_short));
    }
  SolverSettings s = semi_implicit(4e-3);
  s.solve_iterations = 12;
  std::size_t cut_short = 0;
  verify_at_most({"semi-implicit contact", "contact at particles, solves cut short",
                  "momentum that nothing explains / weight"},
                 1e-5, worst_closure(s, 1e6, cut_short));
  EXPECT_GT(cut_short, 0u);
}

/// Nothing moves, so no residual is small beside what moves; it is beside what gravity would do in
/// a step, and that is enough.
TEST(SemiImplicitContact, SolvesAtRestAreNotGivenUp) {
  for (const ContactAt contact_at : {ContactAt::particles, ContactAt::nodes})
    for (const double youngs_modulus : {1e6, 1e7}) {
      SolverSettings s = semi_implicit(4e-3);
      s.contact_at = contact_at;
      Simulation simulation(s, {elastic(youngs_modulus, 0.2, 400)}, {floor_of_slab()},
                            slab(Vec3d::Zero()), 1);
      simulation.advance_to(0.2);
      EXPECT_EQ(simulation.warnings().solves_given_up, 0u) << youngs_modulus;
      EXPECT_EQ(simulation.steps(), 50u) << youngs_modulus;
    }
}

/// A block lands on a floor that holds on to it, and comes to rest or slides on. @return J
double energy_at_rest(Transfer transfer, shapes::Contact contact, double beta) {
  SolverSettings s = semi_implicit(1e-3);
  s.beta = beta;
  s.transfer = transfer;
  if (transfer == Transfer::mls) s.kernel = Kernel::quadratic;
  // The snow is further away than what is held where it was seeded: it arrives.
  ParticleArrays p = box_of_snow({-0.05, 0.008, -0.03}, {0.05, 0.088, 0.03}, 0.01);
  p.V0.assign(p.x.size(), 0.0);
  p.v.assign(p.x.size(), Vec3d(1, -1, 0));
  Simulation simulation(s, {elastic(1e6, 0.2, 400)}, {plane({0, 0, 0}, {0, 1, 0}, 0, contact)}, p,
                        1);
  simulation.advance_to(0.2);
  EXPECT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
  return simulation.summary().elastic_energy;
}

/// Its particles are held where they arrived, at different strains of up to v/c: that much stays.
/// 0.096 J of falling motion were all that it had to give.
TEST(SemiImplicitContact, SlipAndStickyFloorsGiveNoEnergy) {
  for (const Transfer transfer :
       {Transfer::flip, Transfer::apic, Transfer::mls, Transfer::aflip, Transfer::asflip})
    for (const auto contact : {shapes::Contact::slip, shapes::Contact::sticky})
      for (const double beta : {0.0, 0.5, 1.0}) {
        const std::string line = name(transfer) + ", beta = " + in_digits(beta) +
                                 (contact == shapes::Contact::slip ? ", slip" : ", sticky");
        verify_at_most({"semi-implicit contact", line, "elastic energy of a block at rest, J"},
                       0.05, energy_at_rest(transfer, contact, beta));
      }
}

/// A plate rests on the slab and is lifted: a surface that snow leaves freely never pulls.
TEST(SemiImplicitContact, APlateThatIsLiftedDoesNotPull) {
  for (const double beta : {0.0, 1.0}) {
    SolverSettings s = semi_implicit(1e-3);
    s.beta = beta;
    shapes::Collider plate;
    plate.shape.form = shapes::Box{{0, 0.255, 0}, {0.3, 0.1, 0.3}};
    plate.keyframes = {{0, Vec3d(0, 0.255, 0), std::nullopt},
                       {0.1, Vec3d(0, 0.245, 0), std::nullopt},
                       {0.15, Vec3d(0, 0.275, 0), std::nullopt}};
    Simulation simulation(s, {elastic(1e6, 0.2, 400)}, {floor_of_slab(), plate},
                          slab(Vec3d::Zero()), 1);
    double pressed = 0, pulled = 0;
    for (int k = 1; k <= 75; ++k) {
      const double up = simulation.advance_to(2e-3 * k).loads.at(1).impulse[1] / 2e-3;
      pressed = std::max(pressed, up);
      pulled = std::max(pulled, -up);
    }
    EXPECT_GT(pressed, 100) << beta;
    // One step of glue, of a few particles, is what springs may leave.
    EXPECT_LT(pulled, 0.01 * pressed) << beta;
  }
}

}  // namespace
