/// Convergence to the manufactured solution; the longer table is in analytic_long.

#include "tests/support/manufactured.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

TEST(ManufacturedSolution, ManufacturedSolutionIsApproachedAtSecondOrder) {
  // Strains of 31 %. Splines and splitting are of order 2, so 1.8 for FLIP; the errors of APIC and
  // MLS fall faster on the way there. Errors are the reference's within 3 in the last digit given.
  struct Gate {
    Transfer transfer;
    double order, error_at_32;
  };
  for (const Gate gate : {Gate{Transfer::flip, 1.8, 0.0094}, {Transfer::mls, 2, 0.0030}}) {
    ManufacturedCase c;
    c.transfer = gate.transfer;
    c.advect = Advect::pic;
    const double error[] = {manufactured_error(c, 8), manufactured_error(c, 16),
                            manufactured_error(c, 32)};
    verify_at_least({"manufactured", c.label(), "order, h = 1/8 to 1/16"}, gate.order,
                    order(error[0], error[1]));
    verify_at_least({"manufactured", c.label(), "order, h = 1/16 to 1/32"}, gate.order,
                    order(error[1], error[2]));
    verify_ratio({"manufactured", c.label(), "rms error / A at h = 1/32"}, gate.error_at_32,
                 error[2], 0.03);
  }
}

TEST(ManufacturedSolution, ManufacturedSolutionInFloatStaysAsNear) {
  // Rounding of float, 1e-7 of a state rebuilt every step, is far below the error of h = 1/16.
  ManufacturedCase c;
  c.transfer = Transfer::mls;
  const double exact = manufactured_error(c, 16);
  c.precision = Precision::single;
  verify_ratio({"manufactured", c.label() + ", float", "rms error / A at h = 1/16"}, exact,
               manufactured_error(c, 16), 0.01);
}

TEST(ManufacturedSolution, ManufacturedSolutionNeedsNoContinuousRun) {
  // Rebuilding the simulation each step, as the body force needs, changes nothing but rounding.
  SolverSettings s;
  s.cell_size = 1.0 / 8;
  s.transfer = Transfer::apic;
  s.precision = Precision::real64;
  s.gravity.setZero();
  const Material m = elastic(1e4, 0.3, 1000);
  ParticleArrays p = lattice({0, 0, 0}, {1, 0.5, 0.5}, {16, 8, 8}, 1000);
  for (std::size_t q = 0; q < p.x.size(); ++q) p.v[q][0] = std::sin(6 * p.x[q][0]);
  Simulation continuous(s, {m}, {}, p, 1);
  for (int n = 0; n < 50; ++n) {
    continuous.step(1e-3);
    Simulation rebuilt(s, {m}, {}, p, 1);
    rebuilt.step(1e-3);
    p = rebuilt.particles();
  }
  const ParticleArrays expected = continuous.particles();
  double worst = 0;
  for (std::size_t q = 0; q < p.x.size(); ++q)
    worst = std::max(worst, (p.x[q] - expected.x[q]).norm());
  EXPECT_LE(worst, 1e-12);  // 50 roundings of places of the order of 1 m
}

}  // namespace
