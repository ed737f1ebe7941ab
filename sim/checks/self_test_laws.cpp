/// Self-tests of the laws that one step keeps, as nodes and particles feel them.

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "sim/checks/self_test_bodies.h"
#include "sim/checks/self_test_tests.h"
#include "sim/health/diagnostics.h"

namespace neve::sim::checks::self_test {

/// sum w = 1, sum w (x_i - x_p) = 0, sum w (x_i - x_p)(x_i - x_p)^T = D I, and for the gradients
/// that forces use sum grad_w = 0, sum (x_i - x_p) grad_w^T = I: isolated particles, so that a
/// node's mass is m_p w_ip and its force -V0 tau grad_w_ip with tau a known pressure.
void weights(const SelfTestCase& test, Measure& measure) {
  constexpr double dt = 1e-4;
  const Material material = Material{};
  ParticleArrays p = isolated_particles(12);
  p.F_E.assign(p.x.size(), 0.99 * Mat3d::Identity());
  const Simulation simulation(settings_of(test), {material}, {}, p, 1);
  p = simulation.particles();
  const StagedStep step = staged_step(simulation, dt);
  const std::size_t count = p.x.size();
  std::vector<double> sum(count);
  std::vector<Vec3d> arm(count, Vec3d::Zero()), force(count, Vec3d::Zero());
  std::vector<Mat3d> moment(count, Mat3d::Zero());
  const std::vector<Vec3d> forces = felt_forces(step, dt);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const std::size_t q = owner(step.nodes.node[i]);
    if (q >= count) continue;
    const double w = step.nodes.mass[i] / p.m[q];
    const Vec3d d = place(step.nodes.node[i]) - p.x[q];
    sum[q] += w;
    arm[q] += w * d;
    moment[q] += w * d * d.transpose();
    force[q] += forces[i];
  }
  const std::vector<Mat3d> stress = felt_stress(p, step, dt);
  for (std::size_t q = 0; q < count; ++q) {
    const Mat3d tau = health::first_piola(material, p.F_E[q], p.J_P[q]) * p.F_E[q].transpose();
    const double pressure = tau(0, 0), D = inertia(test.kernel);
    measure.zero("sum of w", sum[q] - 1);
    measure.zero("sum of w (x_i - x_p)", arm[q].norm() / cell_size);
    measure.zero("sum of w (x_i - x_p)(x_i - x_p)^T",
                 largest(moment[q] - D * Mat3d::Identity()) / D);
    measure.zero("sum of grad_w", force[q].norm() * cell_size / (p.V0[q] * pressure));
    measure.zero("sum of (x_i - x_p) grad_w^T", largest(stress[q] / pressure - Mat3d::Identity()));
  }
}

namespace {

/// A particle alone gives its nodes v + C (x_i - x_p), or v. Among others C cancels where they are
/// even, so this is the only test that notices a transposed C.
void affine_velocity_of_nodes(const SelfTestCase& test, Measure& measure) {
  Numbers number(10);
  const SolverSettings settings = settings_of(test);
  ParticleArrays p = isolated_particles(6);
  for (Vec3d& v : p.v) {
    v = number.vector();
    p.C.push_back(0.5 / cell_size * number.matrix());
  }
  const Simulation simulation(settings, {without_stiffness()}, {}, p, 1);
  p = simulation.particles();
  const NodeFields nodes = staged_step(simulation, 1e-4).nodes;
  for (std::size_t i = 0; i < nodes.node.size(); ++i) {
    const std::size_t q = owner(nodes.node[i]);
    if (q >= p.x.size()) continue;
    Vec3d expected = p.v[q];
    if (settings.has_affine_velocity()) expected += p.C[q] * (place(nodes.node[i]) - p.x[q]);
    measure.zero("velocity of a node", (nodes.v_old[i] - expected).norm());
  }
}

}  // namespace

/// Node velocities A x with A not symmetric: grad v must be A, F_E must become (I + dt A) F_E, and
/// particles must get A x back. The only test that notices a transposed grad v.
void affine_field(const SelfTestCase& test, Measure& measure) {
  constexpr double dt = 0.05;
  Mat3d A;
  A << 0.1, 0.9, -0.4, -0.3, 0.2, 0.5, 0.7, -0.6, -0.2;
  Numbers number(3);
  ParticleArrays p = even_lattice();
  for (const Vec3d& x : p.x) {
    p.F_E.push_back(Mat3d::Identity() + 0.1 * number.matrix());
    p.C.push_back(A);
    p.v[p.F_E.size() - 1] = A * x;
  }
  const Simulation simulation(settings_of(test), {without_stiffness()}, {}, p, 1);
  p = simulation.particles();
  const StagedStep step = staged_step(simulation, dt);
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    if (!is_deep_inside(p.x[q])) continue;
    const Mat3d expected = (Mat3d::Identity() + dt * A) * p.F_E[q];
    measure.zero("grad v", largest(step.grad_v[q] - A));
    measure.zero("(I + dt A) F_E", largest(step.F_E_trial[q] - expected));
    measure.zero("the particle's velocity", (step.after.v[q] - A * p.x[q]).norm());
    measure.zero("the particle's displacement",
                 (step.after.x[q] - p.x[q] - dt * A * p.x[q]).norm() / cell_size);
  }
  affine_velocity_of_nodes(test, measure);
}

/// A rotation leaves no stress, tau(Q F) = Q tau(F) Q^T, and tau is symmetric; as nodes feel it.
void stress(const SelfTestCase& test, Measure& measure) {
  constexpr double dt = 1e-4;
  const Mat3d Q = rotation_from_vector({0.5, -0.8, 0.3});
  for (const Material& material : one_of_each_law()) {
    Numbers number(4);
    ParticleArrays p = isolated_particles(13);
    p.F_E[0] = Q;
    for (std::size_t q = 1; q < p.x.size(); q += 2) {
      p.F_E[q] = Mat3d::Identity() + 0.1 * number.matrix();
      p.F_E[q + 1] = Q * p.F_E[q];
    }
    const Simulation simulation(settings_of(test), {material}, {}, p, 1);
    p = simulation.particles();
    const std::vector<Mat3d> tau = felt_stress(p, staged_step(simulation, dt), dt);
    const double unit = 0.1 * material.youngs_modulus;
    measure.zero("stress of a rotation", largest(tau[0]) / unit);
    for (std::size_t q = 1; q < tau.size(); q += 2) {
      measure.zero("stress of a rotated body",
                   largest(tau[q + 1] - Q * tau[q] * Q.transpose()) / unit);
      measure.zero("symmetry of the stress", largest(tau[q] - tau[q].transpose()) / unit);
    }
  }
}

/// f . u = -dE/du for any displacement u of the nodes: sign, volumes, J, powers of h, hardening.
void force(const SelfTestCase& test, Measure& measure) {
  constexpr double dt = 1e-5, epsilon = 1e-5;
  Numbers number(5);
  const std::vector<Material> materials = one_of_each_law();
  ParticleArrays p = small_ball();
  p.x.resize(60), p.v.resize(60), p.m.resize(60), p.V0.resize(60);
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    p.F_E.push_back(Mat3d::Identity() + 0.1 * number.matrix());
    p.J_P.push_back(1 + 0.05 * number());
    p.material.push_back(static_cast<int>(q % materials.size()));
  }
  const Simulation simulation(settings_of(test), materials, {}, p, 1);
  p = simulation.particles();
  const StagedStep step = staged_step(simulation, dt);
  const std::vector<Vec3d> forces = felt_forces(step, dt);
  std::vector<Mat3d> strain(p.x.size(), Mat3d::Zero());
  double work = 0, size = 0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const Vec3d u = cell_size * number.vector();
    work += forces[i].dot(u);
    size += std::abs(forces[i].dot(u));
    for (std::size_t q = 0; q < p.x.size(); ++q) {
      const Vec3d d = place(step.nodes.node[i]) - p.x[q];
      if (d.cwiseAbs().maxCoeff() < 2 * cell_size)
        strain[q] += u * weight_gradient(test.kernel, test.transfer, d).transpose();
    }
  }
  const auto energy = [&](double by) {
    double sum = 0;
    for (std::size_t q = 0; q < p.x.size(); ++q)
      sum += p.V0[q] * health::energy_density(materials[q % materials.size()],
                                              (Mat3d::Identity() + by * strain[q]) * p.F_E[q],
                                              p.J_P[q]);
    return sum;
  };
  const double slope = (energy(epsilon) - energy(-epsilon)) / (2 * epsilon);
  measure.zero("f . u + dE/du", (work + slope) / size, differences);
}

/// Projection keeps F_E = I, |det F_E| times J_P, and the axes; it clamps the stretches. Hardening
/// is 1 at J_P = 1 and e^(xi (1 - J_P)) elsewhere.
void projection(const SelfTestCase& test, Measure& measure) {
  constexpr double dt = 1e-5;
  const Material soft = without_stiffness();
  Numbers number(6);
  ParticleArrays p = isolated_particles(24);
  for (std::size_t q = 1; q < p.x.size(); ++q) {
    p.F_E[q] = Mat3d::Identity() + 0.05 * number.matrix();
    p.J_P[q] = 1 + 0.1 * number();
  }
  p.F_E[1].col(2) *= -0.5;  // turned inside out
  const Simulation simulation(settings_of(test), {soft}, {}, p, 1);
  p = simulation.particles();
  const ParticleArrays after = staged_step(simulation, dt).after;
  measure.zero("the identity, projected", largest(after.F_E[0] - Mat3d::Identity()));
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    // F = U s V^T without U: F V s'/s V^T is U s' V^T.
    const Eigen::SelfAdjointEigenSolver<Mat3d> eigen(p.F_E[q].transpose() * p.F_E[q]);
    const Mat3d& V = eigen.eigenvectors();
    Vec3d factor;
    for (int a = 0; a < 3; ++a) {
      // The smallest stretch has the sign of det F_E.
      const double sign = a == 0 && p.F_E[q].determinant() < 0 ? -1 : 1;
      const double s = sign * std::sqrt(eigen.eigenvalues()[a]);
      factor[a] = std::clamp(s, 1 - soft.critical_compression, 1 + soft.critical_stretch) / s;
    }
    measure.zero("F_E, clamped",
                 largest(after.F_E[q] - p.F_E[q] * V * factor.asDiagonal() * V.transpose()));
    measure.zero("|det F_E| J_P", after.F_E[q].determinant() * after.J_P[q] -
                                      std::abs(p.F_E[q].determinant()) * p.J_P[q]);
  }
}

void hardening(const SelfTestCase& test, Measure& measure) {
  constexpr double dt = 1e-5;
  std::vector<Material> materials(2, Material{});
  materials[1].hardening = 0;
  ParticleArrays p = isolated_particles(3);
  p.F_E.assign(3, Vec3d(0.99, 0.98, 1.005).asDiagonal());
  p.J_P[2] = 0.9;
  p.material = {1, 0, 0};
  const Simulation simulation(settings_of(test), materials, {}, p, 1);
  p = simulation.particles();
  const std::vector<Mat3d> tau = felt_stress(p, staged_step(simulation, dt), dt);
  const double plain = tau[0].norm(), grown = std::exp(materials[0].hardening * (1 - p.J_P[2]));
  measure.zero("hardening at J_P = 1", tau[1].norm() / plain - 1);
  measure.zero("hardening at J_P = 0.9", tau[2].norm() / plain / grown - 1);
}
}  // namespace neve::sim::checks::self_test
