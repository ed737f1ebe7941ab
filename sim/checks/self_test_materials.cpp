/// Self-tests of laws that yield: what their surfaces make of a state.

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "sim/checks/self_test_bodies.h"
#include "sim/checks/self_test_tests.h"

namespace neve::sim::checks::self_test {

namespace {

/// Returns materials so soft that a step only makes them yield: F_E has moved by 1e-12 when it
/// does. They are the law as it is, and with every other name that a parameter of it may have.
std::vector<Material> soft_materials(const laws::Law& law) {
  Material m;
  m.model = law.model;
  m.youngs_modulus = 1;
  m.consolidation_pressure = 0.03;
  std::vector<Material> found{m};
  for (const laws::Parameter& p : law.parameters)
    for (std::size_t place = 1; place < p.names.size(); ++place) {
      p.of(m) = static_cast<double>(place);
      found.push_back(m);
      p.of(m) = p.own_default;
    }
  return found;
}

/// Particles of random strains, J_P within 0.05 of a middle, one of them turned inside out.
ParticleArrays strained_particles(unsigned seed, double J_P) {
  Numbers number(seed);
  ParticleArrays p = isolated_particles(48);
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    // Strains reach from hardly any to a tenth.
    const double size = 0.1 * static_cast<double>(q) / static_cast<double>(p.x.size());
    p.F_E[q] = Mat3d::Identity() + size * (number.matrix() + number() * Mat3d::Identity());
    p.J_P[q] = J_P + 0.05 * number();
  }
  p.F_E[1].col(2) *= -1;
  return p;
}

/// Measures the claims of the law, and that |det F_E| J_P stays where J_P is a volume.
void yield(const laws::Law& law, const Material& material, const SelfTestCase& test,
           Measure& measure) {
  constexpr double dt = 1e-6;
  const Simulation simulation(
      settings_of(test), {material}, {},
      strained_particles(51 + static_cast<unsigned>(law.model), law.self_test->J_P), 1);
  const ParticleArrays before = simulation.particles(), after = staged_step(simulation, dt).after;
  std::vector<laws::Claim> claims;
  for (std::size_t q = 0; q < before.x.size(); ++q) {
    const double volume = std::abs(before.F_E[q].determinant()) * before.J_P[q];
    if (laws::counts_volume(material))
      measure.zero("|det F_E| J_P", after.F_E[q].determinant() * after.J_P[q] / volume - 1);
    law.self_test->run(material, {before.F_E[q], before.J_P[q], after.F_E[q], after.J_P[q]},
                       claims);
  }
  for (const laws::Claim& claim : claims) measure.zero(claim.what, claim.value, claim.tolerance);
}

}  // namespace

void yield(const laws::Law& law, const SelfTestCase& test, Measure& measure) {
  for (const Material& material : soft_materials(law)) yield(law, material, test, measure);
}

}  // namespace neve::sim::checks::self_test
