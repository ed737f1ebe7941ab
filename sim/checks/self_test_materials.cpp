/// Self-tests of the laws beside the paper's snow: what their surfaces of yield make of a state.

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "sim/checks/self_test_bodies.h"
#include "sim/checks/self_test_tests.h"
#include "sim/health/cam_clay.h"
#include "sim/health/sand.h"

namespace neve::sim::checks::self_test {

namespace {

constexpr double dt = 1e-6;
/// Surfaces lie a few per cent of the stiffness away from no stress at all, so a share of them is
/// good to a hundredth of the digits.
constexpr self_test::Tolerance of_surfaces{1e-8, 5e-3};

/// So soft that a step only makes it yield: F_E has moved by 1e-12 when it does.
Material soft(Model model) {
  Material m;
  m.model = model;
  m.youngs_modulus = 1;
  m.consolidation_pressure = 0.03;
  return m;
}

/// Particles of random strains, J_P within 0.05 of a middle, one of them turned inside out.
ParticleArrays strained_particles(unsigned seed, double J_P) {
  self_test::Numbers number(seed);
  ParticleArrays p = self_test::isolated_particles(48);
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    // From hardly any strain to a tenth.
    const double size = 0.1 * static_cast<double>(q) / static_cast<double>(p.x.size());
    p.F_E[q] = Mat3d::Identity() + size * (number.matrix() + number() * Mat3d::Identity());
    p.J_P[q] = J_P + 0.05 * number();
  }
  p.F_E[1].col(2) *= -1;
  return p;
}

Mat3d deviator(const Mat3d& b) {
  return b - b.trace() / 3 * Mat3d::Identity();
}
/// What b has beside the direction of a, or against it.
double aside(const Mat3d& a, const Mat3d& b) {
  const double along = a.squaredNorm() > 0 ? a.cwiseProduct(b).sum() / a.squaredNorm() : 0;
  return (b - std::max(along, 0.0) * a).norm();
}

struct Step {
  ParticleArrays before, after;
};
Step step_of(const SelfTestCase& test, const Material& material, const ParticleArrays& p) {
  const Simulation simulation(self_test::settings_of(test), {material}, {}, p, 1);
  return {simulation.particles(), staged_step(simulation, dt).after};
}

void keeps_volume(const Step& step, std::size_t q, self_test::Measure& measure) {
  const double before = std::abs(step.before.F_E[q].determinant()) * step.before.J_P[q];
  measure.zero("|det F_E| J_P", step.after.F_E[q].determinant() * step.after.J_P[q] / before - 1,
               self_test::rounding);
}

}  // namespace

/// A trial state inside of the surface stays; one outside ends on it, and keeps its volume and the
/// directions of its strain.
void cam_clay(const SelfTestCase& test, self_test::Measure& measure) {
  const Material material = soft(Model::cam_clay);
  const Step step = step_of(test, material, strained_particles(54, 0.95));
  for (std::size_t q = 0; q < step.before.x.size(); ++q) {
    const Mat3d& F = step.before.F_E[q];
    const Mat3d& found = step.after.F_E[q];
    const double J_P = step.before.J_P[q];
    const auto nearness = [&](const Mat3d& F_E) {
      return health::cam_clay::nearness_to_yield(material, F_E, J_P);
    };
    keeps_volume(step, q, measure);
    measure.zero("strain in other directions",
                 aside(deviator(F * F.transpose()), deviator(found * found.transpose())),
                 self_test::rounding);
    if (F.determinant() > 0 && nearness(F) < 0.99)
      measure.zero("F_E within the surface", self_test::largest(found - F), self_test::rounding);
    else if (nearness(F) > 1.01)
      measure.zero("distance to the surface", nearness(found) - 1, of_surfaces);
  }
}

/// Grains that are apart bear nothing, those that slide are on the cone, and the volume that they
/// gained is kept until it is given back.
void sand(const SelfTestCase& test, self_test::Measure& measure) {
  const Material material = soft(Model::sand);
  const Step step = step_of(test, material, strained_particles(55, 1.05));
  for (std::size_t q = 0; q < step.before.x.size(); ++q) {
    const Mat3d& F = step.before.F_E[q];
    const Mat3d& found = step.after.F_E[q];
    const Mat3d b = found * found.transpose();
    keeps_volume(step, q, measure);
    if (std::abs(F.determinant()) * step.before.J_P[q] >= 1) {
      measure.zero("strain of grains that are apart", self_test::largest(b - Mat3d::Identity()),
                   self_test::rounding);
      continue;
    }
    measure.zero("volume gained by grains that press", step.after.J_P[q] - 1, self_test::rounding);
    const double nearness = health::sand::nearness_to_yield(material, found);
    measure.between("share of the friction", nearness, 0, 1 + of_surfaces.single);
    if (F.determinant() > 0 && health::sand::nearness_to_yield(material, F) > 1.5)
      measure.zero("distance to the cone", nearness - 1, of_surfaces);
  }
}

}  // namespace neve::sim::checks::self_test
