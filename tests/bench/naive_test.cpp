// The naive code of `neve bench` gives the same results as the solver.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "app/bench/bench_case.h"
#include "app/bench/naive.h"
#include "app/bench/timed_run.h"
#include "app/support/errors.h"

namespace neve::app {
namespace {

/// The bench case in small, squeezed so hard that all of it yields, with velocities that no
/// symmetry keeps simple.
app::bench::BenchCase small_case(app::bench::BenchMethod method) {
  app::bench::BenchCase c = app::bench::packed_case(5, method, sim::Precision::real64);
  for (std::size_t q = 0; q < c.particles.x.size(); ++q) {
    const sim::Vec3d x = c.particles.x[q] / 0.05;
    c.particles.v[q] *= 15;
    c.particles.v[q] += sim::Vec3d(std::sin(7 * x.y()), 0.5 * std::cos(5 * x.z()), x.x() * x.y());
  }
  return c;
}

class Naive : public testing::TestWithParam<app::bench::BenchMethod> {};

TEST_P(Naive, NaiveCodeDoesTheSameAsTheSolver) {
  const app::bench::BenchCase c = small_case(GetParam());
  sim::Simulation simulation(c.settings, {c.material}, {}, c.particles, 1);
  app::bench::NaiveSnow naive(c.settings, c.material, c.particles);
  constexpr int steps = 40;
  for (int k = 0; k < steps; ++k) {
    simulation.step(1e-4);
    naive.step(1e-4);
  }
  ASSERT_FALSE(simulation.divergence()) << simulation.divergence()->sentence;
  const sim::ParticleArrays a = simulation.particles(), b = naive.particles();
  // Both are double precision and differ in the order of sums and in how F_E is decomposed: 1e-16 a
  // step in each number. Stress feeds it back with c dt / h = 0.2 to 1 per step, so it grows, but
  // 40 steps leave it under 1e-12; a term that is missing or a wrong coefficient shows at 1e-4.
  constexpr double rounding = 1e-11;
  double min_J_P = 1, max_J_P = 1;
  for (std::size_t q = 0; q < a.x.size(); ++q) {
    ASSERT_LT((a.x[q] - b.x[q]).norm(), rounding * 0.05) << q;
    ASSERT_LT((a.v[q] - b.v[q]).norm(), rounding * 10) << q;
    ASSERT_LT((a.F_E[q] - b.F_E[q]).norm(), rounding * 10) << q;
    ASSERT_LT(std::abs(a.J_P[q] - b.J_P[q]), rounding * 10) << q;
    ASSERT_LT((a.C[q] - b.C[q]).norm(), rounding * 1e4) << q;
    min_J_P = std::min(min_J_P, a.J_P[q]);
    max_J_P = std::max(max_J_P, a.J_P[q]);
  }
  EXPECT_LT(min_J_P, 0.97) << "nothing was packed, so the projection was not compared";
  EXPECT_GT(max_J_P, 1.01) << "nothing was torn";
}

INSTANTIATE_TEST_SUITE_P(Methods, Naive,
                         testing::Values(app::bench::BenchMethod::flip_cubic,
                                         app::bench::BenchMethod::mls_quadratic),
                         [](const auto& tested) {
                           return std::string(app::bench::name(tested.param));
                         });

TEST(NaiveSnow, NaiveSnowRefusesWhatItDoesNotImplement) {
  const app::bench::BenchCase apic =
      app::bench::packed_case(2, app::bench::BenchMethod::apic_cubic, sim::Precision::real64);
  EXPECT_THROW(app::bench::NaiveSnow(apic.settings, apic.material, apic.particles),
               std::invalid_argument);
  app::bench::BenchCase estimated =
      app::bench::packed_case(2, app::bench::BenchMethod::flip_cubic, sim::Precision::real64);
  estimated.particles.V0.clear();
  EXPECT_THROW(app::bench::NaiveSnow(estimated.settings, estimated.material, estimated.particles),
               std::invalid_argument);
}

TEST(TimedRun, ACaseThatDivergesIsAnError) {
  app::bench::BenchCase c =
      app::bench::packed_case(4, app::bench::BenchMethod::flip_cubic, sim::Precision::single);
  c.settings.dt = 5e-3;  // sound crosses ten cells
  try {
    app::bench::time_run(c, 1, "too_long_steps");
    FAIL() << "its time was taken for a figure";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, exit_diverged);
    EXPECT_NE(std::string(error.what()).find("too_long_steps diverged at step"), std::string::npos)
        << error.what();
  }
}

TEST(Statistics, MedianIsTheMiddleOrBetweenTheTwo) {
  EXPECT_EQ(app::bench::statistics_of({3, 1, 2}).median, 2);
  EXPECT_EQ(app::bench::statistics_of({4, 1, 2, 3}).median, 2.5);
  EXPECT_EQ(app::bench::statistics_of({4, 1, 2, 3}).min, 1);
  EXPECT_EQ(app::bench::statistics_of({4, 1, 2, 3}).max, 4);
}

TEST(BenchCase, BenchCaseIsTheCommonCase) {
  const app::bench::BenchCase packed =
      app::bench::packed_case(23, app::bench::BenchMethod::flip_cubic, sim::Precision::single);
  EXPECT_EQ(packed.particles.x.size(), 97336u);
  EXPECT_EQ(app::bench::packed_cells_a_side(97336), 23);
  EXPECT_EQ(app::bench::packed_cells_a_side(0), 1);
  // The stream gains as many particles as it loses.
  const app::bench::BenchCase stream =
      app::bench::stream_case(12, app::bench::BenchMethod::flip_cubic, true);
  sim::Simulation flowing(stream.settings, {stream.material}, {}, stream.particles, 1,
                          sim::Vec3i::Zero(), stream.flow);
  app::bench::run_steps(flowing, app::bench::bench_steps);
  EXPECT_GT(flowing.flow_totals().removed, stream.particles.x.size() / 3);
  EXPECT_NEAR(static_cast<double>(flowing.particle_count()),
              static_cast<double>(stream.particles.x.size()),
              0.1 * static_cast<double>(stream.particles.x.size()));
  const app::bench::BenchCase spray =
      app::bench::spray_case(46, 1, app::bench::SprayPlaces::at_random,
                             app::bench::BenchMethod::flip_cubic, sim::Precision::single);
  EXPECT_EQ(spray.particles.x.size(), packed.particles.x.size());
  sim::Vec3d momentum = sim::Vec3d::Zero();
  for (const sim::Vec3d& v : packed.particles.v) momentum += v;
  EXPECT_LT(momentum.norm(), 1e-9);
}

}  // namespace
}  // namespace neve::app
