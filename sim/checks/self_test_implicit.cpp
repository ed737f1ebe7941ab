/// Self-test of the semi-implicit solve.

#include <algorithm>

#include "sim/checks/self_test_bodies.h"
#include "sim/checks/self_test_tests.h"
#include "sim/health/diagnostics.h"
#include "sim/laws/law.h"

namespace neve::sim::checks::self_test {

/// M (v_new - v_star) = -beta dt^2 H v_new (the paper, equation 9), with H v_new taken from
/// differences of the stress while F_E follows grad v_new.
void solve(const SelfTestCase& test, Measure& measure) {
  constexpr double dt = 4e-3, beta = 0.75, epsilon = 1e-5;
  Numbers number(10);
  std::vector<Material> materials = one_of_each_law();
  std::erase_if(materials, [](const Material& m) { return !laws::of(m).has_derivative; });
  ParticleArrays p = small_ball();
  p.x.resize(60), p.v.resize(60), p.m.resize(60), p.V0.resize(60);
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    p.v[q] = number.vector();
    p.F_E.push_back(Mat3d::Identity() + 0.05 * number.matrix());
    p.J_P.push_back(1 + 0.05 * number());
    p.material.push_back(static_cast<int>(q % materials.size()));
  }
  SolverSettings settings = settings_of(test);
  settings.beta = beta;
  settings.solve_tolerance = 1e-12;
  settings.solve_iterations = 500;
  const Simulation simulation(settings, materials, {}, p, 1);
  p = simulation.particles();
  const StagedStep step = staged_step(simulation, dt);
  std::vector<Mat3d> stress(p.x.size());
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    const auto P = [&](double by) {
      return health::first_piola(materials[q % materials.size()],
                                 (Mat3d::Identity() + by * step.grad_v[q]) * p.F_E[q], p.J_P[q]);
    };
    stress[q] = p.V0[q] / (2 * epsilon) * (P(epsilon) - P(-epsilon)) * p.F_E[q].transpose();
  }
  double worst = 0, size = 0;
  for (std::size_t i = 0; i < step.nodes.mass.size(); ++i) {
    Vec3d left = step.nodes.mass[i] * (step.nodes.v_new[i] - step.nodes.v_star[i]);
    size = std::max(size, left.norm());
    for (std::size_t q = 0; q < p.x.size(); ++q) {
      const Vec3d d = place(step.nodes.node[i]) - p.x[q];
      if (d.cwiseAbs().maxCoeff() < 2 * cell_size)
        left += beta * dt * dt * stress[q] * weight_gradient(test.kernel, test.transfer, d);
    }
    worst = std::max(worst, left.norm());
  }
  measure.zero("M (v_new - v_star) + beta dt^2 H v_new", worst / size, differences);
}

}  // namespace neve::sim::checks::self_test
