/// Weights, conservation in the transfers, and force as the derivative of energy.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <map>
#include <random>

#include "sim/health/diagnostics.h"
#include "sim/staged.h"
#include "tests/support/one_particle.h"
#include "tests/support/snow.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

template <class Real, int K>
void check_weights(double tolerance) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 1000; ++trial) {
    kernels::Particle<Real> p{};
    for (int a = 0; a < 3; ++a) {
      p.cell[a] = trial * (a - 1);
      p.offset[a] = static_cast<Real>(trial == 0 ? 0 : unit(random));
    }
    const Weights<Real, K> s = weights_of<K>(p);
    for (int a = 0; a < 3; ++a) {
      double sum = 0, slope = 0, arm = 0, inertia = 0, moment = 0;
      for (int k = 0; k < K; ++k) {
        const double x =
            static_cast<double>(p.cell[a]) + static_cast<double>(p.offset[a]) - (s.base[a] + k);
        EXPECT_GE(s.w[a][k], 0);
        sum += static_cast<double>(s.w[a][k]);
        slope += static_cast<double>(s.dw[a][k]);
        arm += static_cast<double>(s.arm[a][k]);
        moment -= static_cast<double>(s.dw[a][k]) * x;
        inertia += static_cast<double>(s.w[a][k]) * x * x;
      }
      EXPECT_NEAR(sum, 1, tolerance);
      EXPECT_NEAR(slope, 0, tolerance);
      EXPECT_NEAR(arm, 0, tolerance);                             // sum w (x_i - x_p) = 0
      EXPECT_NEAR(moment, 1, tolerance);                          // sum x_i grad_w = 1
      EXPECT_NEAR(inertia, kernels::apic_inertia<K>, tolerance);  // D / h^2
    }
  }
}

TEST(Stencil, WeightsSumToOneAndGradientsToZero) {
  check_weights<double, kernels::cubic_nodes>(1e-14);
  check_weights<double, kernels::quadratic_nodes>(1e-14);
  check_weights<float, kernels::cubic_nodes>(1e-6);
  check_weights<float, kernels::quadratic_nodes>(1e-6);
}

struct TransferCase {
  Kernel kernel;
  Transfer transfer;
};
constexpr TransferCase cases[] = {
    {Kernel::cubic, Transfer::flip},     {Kernel::cubic, Transfer::apic},
    {Kernel::cubic, Transfer::mls},      {Kernel::quadratic, Transfer::flip},
    {Kernel::quadratic, Transfer::apic}, {Kernel::quadratic, Transfer::mls},
    {Kernel::cubic, Transfer::aflip},    {Kernel::quadratic, Transfer::asflip}};

SolverSettings settings_of(const TransferCase& c) {
  SolverSettings s;
  s.cell_size = 0.05;
  s.kernel = c.kernel;
  s.transfer = c.transfer;
  s.precision = Precision::real64;
  s.gravity.setZero();
  s.flip_reference_dt = 0;
  return s;
}

TEST(Transfer, TransferConservesMassAndMomentumBothWays) {
  for (const TransferCase& c : cases) {
    const ParticleArrays before = disturbed_snow();
    Simulation simulation(settings_of(c), {Material{}}, {}, before, 1);
    const Summary start = simulation.summary();
    const StagedStep staged = staged_step(simulation, 1e-4);
    double mass = 0;
    Vec3d momentum(0, 0, 0), force(0, 0, 0), magnitude(0, 0, 0);
    for (std::size_t i = 0; i < staged.nodes.mass.size(); ++i) {
      mass += staged.nodes.mass[i];
      momentum += staged.nodes.momentum[i];
      force += staged.nodes.force[i];
      magnitude += staged.nodes.force[i].cwiseAbs();
    }
    // Sums of a few thousand terms in double.
    EXPECT_NEAR(mass, start.mass, 1e-13 * start.mass);
    EXPECT_LE((momentum - start.momentum).norm(), 1e-13 * start.mass * 2);
    EXPECT_LE(force.norm(), 1e-12 * magnitude.norm()) << "internal forces must cancel";
    simulation.step(1e-4);
    EXPECT_LE((simulation.summary().momentum - start.momentum).norm(), 1e-13 * start.mass * 2);
  }
}

TEST(Transfer, ApicAndMlsConserveAngularMomentum) {
  for (const TransferCase& c : cases) {
    if (c.transfer != Transfer::apic && c.transfer != Transfer::mls) continue;
    Simulation simulation(settings_of(c), {Material{}}, {}, disturbed_snow(), 1);
    const Summary start = simulation.summary();
    for (int step = 0; step < 10; ++step) simulation.step(1e-4);
    const Summary end = simulation.summary();
    EXPECT_LE((end.angular_momentum - start.angular_momentum).norm(),
              1e-12 * start.mass * 2 * end.centre_of_mass.norm());
  }
}

TEST(Transfer, NodeForceIsMinusTheDerivativeOfEnergy) {
  for (const TransferCase& c : cases) {
    const SolverSettings settings = settings_of(c);
    const ParticleArrays p = disturbed_snow();
    const Simulation simulation(settings, {Material{}}, {}, p, 1);
    const StagedStep staged = staged_step(simulation, 1e-4);
    // Displace every node at random and see how the energy of the particles answers: the strain of
    // a particle is what the staged driver would gather as grad v from those displacements.
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::map<std::array<int, 3>, Vec3d> u;
    double work = 0;
    for (std::size_t i = 0; i < staged.nodes.node.size(); ++i) {
      const neve::sim::Vec3i n = staged.nodes.node[i];
      const Vec3d here = Vec3d::NullaryExpr([&] { return unit(random); });
      u[{n[0], n[1], n[2]}] = here;
      work += staged.nodes.force[i].dot(here);
    }
    const double h = settings.cell_size;
    const auto energy = [&](double epsilon) {
      double sum = 0;
      for (std::size_t q = 0; q < p.x.size(); ++q) {
        Mat3d grad = Mat3d::Zero();
        const auto add = [&]<int K>(const Weights<double, K>& s) {
          for (int i = 0; i < K; ++i)
            for (int j = 0; j < K; ++j)
              for (int k = 0; k < K; ++k) {
                Vec3d g(s.dw[0][i] * s.w[1][j] * s.w[2][k], s.w[0][i] * s.dw[1][j] * s.w[2][k],
                        s.w[0][i] * s.w[1][j] * s.dw[2][k]);
                if (settings.transfer == Transfer::mls)
                  g = Vec3d(s.arm[0][i] * s.w[1][j] * s.w[2][k],
                            s.w[0][i] * s.arm[1][j] * s.w[2][k],
                            s.w[0][i] * s.w[1][j] * s.arm[2][k]) /
                      kernels::apic_inertia<K>;
                grad += u.at({s.base[0] + i, s.base[1] + j, s.base[2] + k}) * (g / h).transpose();
              }
        };
        kernels::Particle<double> record{};
        for (int a = 0; a < 3; ++a) {
          record.cell[a] = static_cast<int>(std::floor(p.x[q][a] / h));
          record.offset[a] = p.x[q][a] / h - static_cast<double>(record.cell[a]);
        }
        if (settings.kernel == Kernel::cubic)
          add(weights_of<kernels::cubic_nodes>(record));
        else
          add(weights_of<kernels::quadratic_nodes>(record));
        sum += p.V0[q] * health::energy_density(
                             Material{}, (Mat3d::Identity() + epsilon * grad) * p.F_E[q], p.J_P[q]);
      }
      return sum;
    };
    // Central difference: relative error about (epsilon |grad|)^2 with |grad| of 1/h = 20 per
    // metre.
    const double epsilon = 1e-7;
    const double slope = (energy(epsilon) - energy(-epsilon)) / (2 * epsilon);
    EXPECT_NEAR(work, -slope, 1e-6 * std::abs(slope));
  }
}

TEST(Transfer, AffineVelocityArrivesAsItsGradient) {
  // The only test that notices a transposed grad v: the field is linear, its matrix is not
  // symmetric.
  Mat3d A;
  A << 0.3, -1.1, 0.2, 0.7, -0.4, 0.5, -0.6, 0.1, 0.8;
  for (const TransferCase& c : cases) {
    if (c.transfer == Transfer::flip) continue;  // FLIP smears the field before it is gathered
    ParticleArrays p = box_of_snow({0, 0, 0}, {0.4, 0.4, 0.4}, 0.025);
    p.C.assign(p.x.size(), A);
    for (std::size_t q = 0; q < p.x.size(); ++q) p.v[q] = A * p.x[q];
    const Simulation simulation(settings_of(c), {Material{}}, {}, p, 1);
    const StagedStep staged = staged_step(simulation, 1e-9);
    for (std::size_t q = 0; q < p.x.size(); ++q)
      ASSERT_LE((staged.grad_v[q] - A).cwiseAbs().maxCoeff(), 1e-11);
  }
}

TEST(Volumes, VolumesOfPackedSnowAreMassOverDensity) {
  ParticleArrays p = box_of_snow({0, 0, 0}, {0.6, 0.6, 0.6}, 0.025);
  const std::vector<double> true_volume = p.V0;
  p.V0.clear();
  SolverSettings s = settings_of(cases[0]);
  const Simulation simulation(s, {Material{}}, {}, p, 1);
  const ParticleArrays after = simulation.particles();
  double inside = 0;
  int count = 0;
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    const Vec3d from_middle = (p.x[q] - Vec3d::Constant(0.3)).cwiseAbs();
    if (from_middle.maxCoeff() > 0.15) continue;
    inside += after.V0[q] / true_volume[q];
    ++count;
  }
  ASSERT_GT(count, 100);
  // Jitter makes the local density vary; its mean is right to a per cent.
  EXPECT_NEAR(inside / count, 1, 0.02);
}

}  // namespace
