/// The limits of dt against what they stand for: the largest stable step of hardened and of heavy
/// snow, and the strain of a shear flow.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/snow.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

constexpr double step_cell = 1.0 / 16;
constexpr std::size_t acoustic = static_cast<std::size_t>(DtLimit::acoustic);

/// A periodic lattice full of snow that trembles.
ParticleArrays trembling(double J_P, double mass_factor) {
  const Vec3d end = Vec3d::Constant(4 * step_cell);
  ParticleArrays p = box_of_snow(Vec3d::Zero(), end, step_cell / 2);
  // The lattice is the bulk, without light nodes. Jitter would bring stiff pairs into it.
  for (Vec3d& x : p.x)
    x = ((x / (step_cell / 2)).array().floor().matrix() + Vec3d::Constant(0.5)) * (step_cell / 2);
  disturb(p, 0, 1e-6);
  p.J_P.assign(p.x.size(), J_P);
  for (double& m : p.m) m *= mass_factor;
  return p;
}

/// True if the energy of the trembling stays of its order over the steps of dt.
bool is_stable(const ParticleArrays& start, double dt) {
  SolverSettings s;
  s.cell_size = step_cell;
  s.transfer = Transfer::flip;
  s.flip_ratio = 1;  // no damping
  s.precision = Precision::real64;
  s.period = {1, 1, 1};
  s.gravity.setZero();
  s.time_step = TimeStep::fixed;
  s.dt = dt;
  Simulation simulation(s, {Material{}}, {}, start, 1);
  const double before = simulation.summary().kinetic_energy;
  for (int k = 0; k < 150; ++k) {
    simulation.step(dt);
    const double now = simulation.summary().kinetic_energy;
    if (!(now < 100 * before)) return false;
  }
  return true;
}

/// The largest stable dt over the time h / c that sound takes, with the c of the limit. The exact
/// value is 2 / sqrt(the largest eigenvalue of M^-1 H).
double largest_stable_cfl(double J_P, double mass_factor) {
  const ParticleArrays start = trembling(J_P, mass_factor);
  SolverSettings s;
  s.cell_size = step_cell;
  const Simulation simulation(s, {Material{}}, {}, start, 1);
  const double time = step_cell / simulation.step_limits().max_sound_speed;
  EXPECT_NEAR(simulation.step_limits().dt[acoustic], s.acoustic_cfl * time, 1e-6 * time);
  double stable = 0.5, unstable = 6;
  for (int k = 0; k < 8; ++k) {
    const double middle = std::sqrt(stable * unstable);
    (is_stable(start, middle * time) ? stable : unstable) = middle;
  }
  return stable;
}

/// The eigenvalue depends on E e^(xi (1 - J_P)) and m / V0 as the limit says: the same number for
/// all of them. 1 %: the interval after eight halvings of its logarithm. A limit without hardening
/// would be off by e^2.5 at J_P = 0.5, one that takes the material's density by sqrt(3).
TEST(StableStep, TheAcousticLimitFollowsHardeningAndDensity) {
  const double reference = largest_stable_cfl(1, 1);
  EXPECT_GT(reference, 1.0) << "the limit of 0.5 has to be stable";
  for (const double J_P : {0.5, 0.8, 1.2})
    EXPECT_NEAR(largest_stable_cfl(J_P, 1) / reference, 1, 0.02) << "J_P = " << J_P;
  for (const double mass_factor : {0.5, 3.0})
    EXPECT_NEAR(largest_stable_cfl(1, mass_factor) / reference, 1, 0.02) << mass_factor;
  EXPECT_NEAR(largest_stable_cfl(0.6, 2) / reference, 1, 0.02);
}

/// v = (rate y, 0, 0) has nothing on the diagonal of its gradient. At the surface of the block the
/// velocity of the nodes is that of fewer particles: 30 %.
TEST(StableStep, PureShearLimitsTheStrainOfAStep) {
  constexpr double rate = 400;
  for (const Transfer transfer : {Transfer::flip, Transfer::mls}) {
    SolverSettings s;
    s.transfer = transfer;
    s.kernel = transfer == Transfer::mls ? Kernel::quadratic : Kernel::cubic;
    s.gravity.setZero();
    ParticleArrays p = box_of_snow({0, 0, 0}, {0.2, 0.2, 0.2}, 0.01);
    for (std::size_t q = 0; q < p.x.size(); ++q) p.v[q] = {rate * (p.x[q].y() - 0.1), 0, 0};
    Simulation simulation(s, {Material{}}, {}, p, 1);
    const auto expect_rate = [&](const char* when) {
      const StepLimits limits = simulation.step_limits();
      EXPECT_NEAR(limits.max_strain_rate, rate, 0.3 * rate) << when;
      EXPECT_NEAR(limits.dt[static_cast<std::size_t>(DtLimit::strain)],
                  s.strain_limit / limits.max_strain_rate, 1e-6 / rate)
          << when;
    };
    expect_rate("at the start");
    simulation.step(1e-6);
    expect_rate("after a step");
  }
}

}  // namespace
