/// A spinning, vibrating cube in free flight: what each transfer keeps of energy and spin.

#include "tests/support/spin.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

TEST(SpinningCube, SpinningCubeKeepsItsAngularMomentumWithApicAndMls) {
  for (const Precision precision : {Precision::real64, Precision::single})
    for (const Transfer transfer : {Transfer::apic, Transfer::mls})
      for (const Kernel kernel : {Kernel::cubic, Kernel::quadratic}) {
        SpinCase c;
        c.transfer = transfer;
        c.kernel = kernel;
        c.precision = precision;
        c.cfl = 0.4;
        // Rounding of 205 steps; of 1e-7 of C and v in each, should it always go one way.
        verify_at_most({"spin", c.label(), "largest change of L / L"},
                       precision == Precision::real64 ? 1e-11 : 2e-4, spin_cube(c).momentum_error);
      }
}

TEST(SpinningCube, SpinningCubeLosesEnergyAtARateThatDoesNotDependOnTheStepWithApicAndMls) {
  // The vibration is damped away, the spin stays: about three quarters of the energy is in it. The
  // reference's change between these steps is 1 %.
  for (const Transfer transfer : {Transfer::apic, Transfer::mls}) {
    std::vector<double> kept;
    for (const double cfl : {0.4, 0.1}) {
      SpinCase c;
      c.transfer = transfer;
      c.kernel = transfer == Transfer::apic ? Kernel::cubic : Kernel::quadratic;
      c.cfl = cfl;
      const SpinResult r = spin_cube(c);
      kept.push_back(r.energy);
      const std::string line = c.label() + ", c dt/h = " + in_digits(cfl);
      // A split step meets kinetic and elastic energy half a step apart: an error of order dt.
      verify_at_most({"spin", line, "largest energy / start"}, 1 + 0.05 * cfl + 0.01,
                     r.largest_energy);
      verify_near({"spin", line, "energy / start after 0.5 s"}, kept.front(), r.energy, 0.02);
    }
  }
}

TEST(SpinningCube, SpinningCubeLosesWithFlipWhatTheReferenceLoses) {
  // An alpha below 1 per step damps spin as well, faster the smaller the step; alpha = 1 keeps most
  // of it. Three digits of the reference.
  struct Expected {
    double flip_ratio, cfl, energy;
  };
  for (const Expected& e :
       {Expected{0.95, 0.4, 0.0063}, {0.95, 0.2, 0.0021}, {1, 0.4, 0.51}, {1, 0.2, 0.57}}) {
    SpinCase c;
    c.flip_ratio = e.flip_ratio;
    c.cfl = e.cfl;
    const SpinResult r = spin_cube(c);
    const std::string line = c.label() + ", c dt/h = " + in_digits(e.cfl);
    verify_near({"spin", line, "energy / start after 0.5 s"}, e.energy, r.energy,
                e.flip_ratio == 1 ? 0.01 : 0.0002);
    keep_number({"spin", line, "L / start after 0.5 s"}, r.momentum);
  }
}

TEST(SpinningCube, SpinningCubeKeepsItsAngularMomentumNearlyWithAflipAndAsflip) {
  for (const Transfer transfer : {Transfer::aflip, Transfer::asflip})
    for (const Kernel kernel : {Kernel::cubic, Kernel::quadratic})
      for (const double flip_ratio : {0.95, 1.0}) {
        SpinCase c;
        c.transfer = transfer;
        c.kernel = kernel;
        c.flip_ratio = flip_ratio;
        const SpinResult r = spin_cube(c);
        verify_near({"spin", c.label(), "L / start after 0.5 s"}, 1, r.momentum, 0.01);
        verify_at_most({"spin", c.label(), "largest energy / start"}, 1.02, r.largest_energy);
        keep_number({"spin", c.label(), "energy / start after 0.5 s"}, r.energy);
      }
}

/// A piece of snow in the air keeps its spin for half a second; with FLIP it may lose some.
TEST(SpinningBall, SpinningBallKeepsItsSpinWithAnyTransferButFlip) {
  for (const Transfer transfer :
       {Transfer::flip, Transfer::apic, Transfer::mls, Transfer::aflip, Transfer::asflip})
    for (const Kernel kernel : {Kernel::cubic, Kernel::quadratic})
      for (const double radius : {3.0, 5.0, 8.0}) {
        const BallSpin r = spin_ball(transfer, kernel, radius);
        const Quantity q{
            "rotation",
            name(transfer) + (transfer == Transfer::flip ? " 0.95, " : ", ") + name(kernel),
            "radius of " + in_digits(radius) + " cells"};
        if (transfer == Transfer::flip)
          keep_number(q, r.momentum);
        else
          verify_at_least(q, 0.99, r.momentum);
        EXPECT_LE(r.largest_energy, 1.01) << q.line << ", " << q.name;
      }
}

}  // namespace
