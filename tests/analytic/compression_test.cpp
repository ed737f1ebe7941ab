/// Uniaxial compression of the paper's snow against its stress-strain curve.

#include "tests/support/compression.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

TEST(UniaxialCompression, UniaxialCompressionFollowsTheTable) {
  // The reference's table; it is printed to the pascal, J_P and hardening to three digits.
  struct Entry {
    double s, J_P, hardening, sigma;
  };
  constexpr Entry table[] = {{0.95, 0.974, 1.29, -5158},   {0.90, 0.923, 2.16, -9092},
                             {0.80, 0.821, 6.02, -28526},  {0.70, 0.718, 16.8, -90921},
                             {0.60, 0.615, 46.8, -295830}, {0.50, 0.513, 131, -990042}};
  for (const Entry& e : table) {
    const UniaxialState formula = uniaxial_formula(Material{}, e.s);
    EXPECT_NEAR(formula.J_P, e.J_P, 0.0006);
    EXPECT_NEAR(formula.hardening, e.hardening, 0.006 * e.hardening);
    EXPECT_NEAR(formula.sigma, e.sigma, 0.6);
  }
}

TEST(UniaxialCompression, UniaxialCompressionOfTheMaterialFollowsTheFormula) {
  // Steps of 0.5 %. Double: rounding of 140 products, times e^(xi (1 - J_P)) and its exponent.
  // Float: 1e-7 a step in J_P, raised by xi = 10 and by s_E - 1 = 0.025 being a difference: 1e-3.
  for (const Precision precision : {Precision::real64, Precision::single}) {
    Curve curve("uniaxial_" + name(precision), "stretch, J_P, axial Cauchy stress (Pa), formula");
    Press press(Material{}, precision);
    const double targets[] = {0.99, 0.975, 0.95, 0.9, 0.8, 0.7, 0.6, 0.5};
    for (const double target : targets) {
      while (press.stretch() > target * (1 + 1e-12)) {
        press.compress(std::max(0.995, target / press.stretch()));
        const UniaxialState now = press.state();
        curve.add({press.stretch(), now.J_P, now.sigma,
                   uniaxial_formula(Material{}, press.stretch()).sigma});
      }
      const UniaxialState expected = uniaxial_formula(Material{}, target), now = press.state();
      const std::string line = "material, " + name(precision) + ", s = " + in_digits(target);
      verify_ratio({"uniaxial", line, "axial stress, Pa"}, expected.sigma, now.sigma,
                   precision == Precision::real64 ? 1e-10 : 2e-3);
      verify_ratio({"uniaxial", line, "J_P"}, expected.J_P, now.J_P,
                   precision == Precision::real64 ? 1e-12 : 1e-4);
    }
  }
}

}  // namespace
