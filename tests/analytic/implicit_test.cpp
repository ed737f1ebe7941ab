/// Semi-implicit steps and waves: the eigenvalues of the scheme, the remaining energy, and where
/// they are stable.

#include <numbers>
#include <random>

#include "tests/support/plane_wave.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

TEST(ImplicitWave, ImplicitWaveHasTheEigenvaluesOfItsScheme) {
  // Exact for small waves, as that of explicit steps; c dt/h up to 2, four times what these hold.
  for (const Transfer transfer : {Transfer::flip, Transfer::apic, Transfer::mls})
    for (const double beta : {0.25, 0.5, 1.0})
      for (const double cfl : {0.2, 2.0}) {
        if (beta < 0.5 && cfl > 1) continue;  // above its limit
        WaveCase wave;
        wave.transfer = transfer;
        wave.cells = 16;
        wave.per_cell = 2;
        wave.cfl = cfl;
        wave.beta = beta;
        const Oscillation expected = predicted_wave(wave), o = measured_wave(wave);
        const double ck = wave.c() * wave.k();
        const std::string line =
            wave.label() + ", beta = " + in_digits(beta) + ", c dt/h = " + in_digits(cfl);
        verify_near({"implicit_wave", line, "ω / (c k)"}, expected.omega / ck, o.omega / ck, 2e-5);
        verify_near({"implicit_wave", line, "decay / (c k)"}, expected.decay / ck, o.decay / ck,
                    2e-5);
      }
}

TEST(ImplicitWave, ImplicitWaveLosesEnergyInProportionToBetaAndDt) {
  // 16 cells, c dt/h = 0.2: an independent reference has 0.97, 0.57 and 0.34 of all energy left
  // after 2.3 periods of c k; here it is that of the wave alone.
  WaveCase wave;
  wave.cells = 16;
  wave.per_cell = 2;
  wave.cfl = 0.2;
  const double time = 2.3 * 2 * std::numbers::pi / (wave.c() * wave.k());
  const auto left = [&](double beta) {
    wave.beta = beta;
    return std::exp(-2 * measured_wave(wave).decay * time);
  };
  const Quantity energy{"implicit_damping", "", "energy left after 2.3 periods"};
  const auto line = [&](double beta) {
    Quantity q = energy;
    q.line = "beta = " + in_digits(beta);
    return q;
  };
  verify_near(line(0), 0.97, left(0), 0.03);
  verify_near(line(0.5), 0.57, left(0.5), 0.03);
  verify_near(line(1), 0.34, left(1), 0.03);
}

/// Largest speed after 100 steps of noise in a periodic box, over that at the start.
double growth(double beta, double cfl) {
  SolverSettings s;
  s.cell_size = 0.05;
  s.period = {1, 1, 1};
  s.time_step = TimeStep::fixed;
  s.gravity.setZero();
  s.transfer = Transfer::flip;
  s.flip_ratio = 1;
  s.flip_reference_dt = 0;
  s.advect = Advect::pic;
  s.precision = Precision::real64;
  s.beta = beta;
  s.solve_tolerance = 1e-10;
  s.solve_iterations = 100;
  const Material material = elastic(1e5, 0.25, 400);
  ParticleArrays p = lattice(Vec3d::Zero(), {0.2, 0.2, 0.2}, {8, 8, 8}, 400);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1e-4, 1e-4);
  for (Vec3d& v : p.v) v = Vec3d::NullaryExpr([&] { return unit(random); });
  Simulation simulation(s, {material}, {}, p, 1);
  const double dt = cfl * s.cell_size / sound_speed(material);
  const double start = simulation.summary().max_speed;
  for (int step = 0; step < 100 && !simulation.divergence(); ++step) simulation.step(dt);
  return simulation.summary().max_speed / start;
}

TEST(ImplicitStability, LimitGrowsAsTheSchemeSays) {
  // Explicit steps on a lattice hold up to a c dt/h between 1 and 2; beta = 0.375 doubles that
  // (1/sqrt(1 - 2 beta)), beta = 1/2 and more have no limit.
  EXPECT_LT(growth(0, 1.0), 2);
  EXPECT_GT(growth(0, 2.2), 100);
  EXPECT_LT(growth(0.375, 2.0), 2);
  EXPECT_GT(growth(0.375, 4.4), 100);
  EXPECT_LT(growth(0.5, 10), 2);
  EXPECT_LT(growth(1, 10), 2);
}

}  // namespace
