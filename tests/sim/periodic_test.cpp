/// The periodic lattice that waves and manufactured solutions are verified on.

#include <gtest/gtest.h>

#include "sim/staged.h"
#include "tests/support/snow.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

constexpr double dyadic_cell = 1.0 / 16;  // dyadic: moving by whole cells is exact

SolverSettings periodic(Transfer transfer, Kernel kernel, const neve::sim::Vec3i& blocks) {
  SolverSettings s;
  s.cell_size = dyadic_cell;
  s.transfer = transfer;
  s.kernel = kernel;
  s.precision = Precision::real64;
  s.period = blocks;
  s.gravity.setZero();
  return s;
}

/// Fills the given number of blocks per axis, 8 particles per cell, all moving at random.
ParticleArrays filled(const neve::sim::Vec3i& blocks) {
  ParticleArrays p =
      box_of_snow(Vec3d::Zero(), 4 * dyadic_cell * blocks.cast<double>(), dyadic_cell / 2);
  disturb(p, 0.004, 2.0);
  return p;
}

template <class Body>
void each_scheme(const Body& body) {
  for (const Transfer transfer : {Transfer::flip, Transfer::apic, Transfer::mls})
    for (const Kernel kernel : {Kernel::cubic, Kernel::quadratic}) body(transfer, kernel);
}

/// Largest differences of two states, particles of b being those of a moved by `offset`.
void expect_same(const ParticleArrays& a, const ParticleArrays& b, const Vec3d& offset,
                 double tolerance) {
  double x = 0, v = 0, F = 0;
  for (std::size_t q = 0; q < a.x.size(); ++q) {
    x = std::max(x, (b.x[q] - a.x[q] - offset).cwiseAbs().maxCoeff());
    v = std::max(v, (b.v[q] - a.v[q]).cwiseAbs().maxCoeff());
    F = std::max(F, (b.F_E[q] - a.F_E[q]).cwiseAbs().maxCoeff());
  }
  EXPECT_LE(x, tolerance);
  EXPECT_LE(v, tolerance);
  EXPECT_LE(F, tolerance);
}

TEST(PeriodicLattice, PeriodicLatticeConservesMassAndMomentumAcrossTheSeam) {
  each_scheme([](Transfer transfer, Kernel kernel) {
    Simulation simulation(periodic(transfer, kernel, {2, 1, 3}), {Material{}}, {},
                          filled({2, 1, 3}), 1);
    const Summary start = simulation.summary();
    const StagedStep staged = staged_step(simulation, 1e-4);
    EXPECT_EQ(staged.nodes.mass.size(), 64u * 2 * 1 * 3);  // no node outside the period
    double mass = 0;
    Vec3d force(0, 0, 0), magnitude(0, 0, 0);
    for (std::size_t i = 0; i < staged.nodes.mass.size(); ++i) {
      mass += staged.nodes.mass[i];
      force += staged.nodes.force[i];
      magnitude += staged.nodes.force[i].cwiseAbs();
    }
    // Sums of a few thousand terms in double.
    EXPECT_NEAR(mass, start.mass, 1e-13 * start.mass);
    EXPECT_LE(force.norm(), 1e-12 * magnitude.norm());
    for (int step = 0; step < 20; ++step) simulation.step(1e-4);
    EXPECT_FALSE(simulation.divergence());
    EXPECT_LE((simulation.summary().momentum - start.momentum).norm(), 1e-12 * start.mass * 2);
  });
}

TEST(PeriodicLattice, PeriodicLatticeLooksTheSameFromEveryCell) {
  // Sums are taken in another order, so rounding differs: 1e-16 a step, amplified by stiffness.
  each_scheme([](Transfer transfer, Kernel kernel) {
    const SolverSettings s = periodic(transfer, kernel, {2, 3, 1});
    const ParticleArrays here = filled({2, 3, 1});
    const Vec3d offset = dyadic_cell * Vec3d(3, -5, 14);
    ParticleArrays there = here;
    for (Vec3d& x : there.x) x += offset;
    Simulation a(s, {Material{}}, {}, here, 1), b(s, {Material{}}, {}, there, 1);
    for (int step = 0; step < 15; ++step) a.step(1e-4), b.step(1e-4);
    expect_same(a.particles(), b.particles(), offset, 1e-11);
  });
}

TEST(PeriodicLattice, PeriodicLatticeIsAnEndlessRowOfCopies) {
  // One block, the smallest period, against 3 x 3 x 3 open copies of it: for one step the middle
  // one cannot know where they end.
  each_scheme([](Transfer transfer, Kernel kernel) {
    const ParticleArrays one = filled({1, 1, 1});
    ParticleArrays many;
    for (const int i : {0, -1, 1})
      for (const int j : {0, -1, 1})
        for (const int k : {0, -1, 1})
          for (std::size_t q = 0; q < one.x.size(); ++q) {
            many.x.push_back(one.x[q] + 4 * dyadic_cell * Vec3d(i, j, k));
            many.v.push_back(one.v[q]);
            many.m.push_back(one.m[q]);
            many.V0.push_back(one.V0[q]);
            many.F_E.push_back(one.F_E[q]);
            many.J_P.push_back(one.J_P[q]);
            many.C.push_back(one.C[q]);
          }
    Simulation a(periodic(transfer, kernel, {1, 1, 1}), {Material{}}, {}, one, 1);
    Simulation b(periodic(transfer, kernel, {0, 0, 0}), {Material{}}, {}, many, 1);
    a.step(1e-4), b.step(1e-4);
    expect_same(a.particles(), b.particles(), Vec3d::Zero(), 1e-13);  // rounding of one step
  });
}

TEST(PeriodicLattice, PeriodicLatticeOfNegativeLengthIsRefused) {
  EXPECT_THROW(Simulation(periodic(Transfer::flip, Kernel::cubic, {-1, 0, 0}), {Material{}}, {},
                          filled({1, 1, 1}), 1),
               std::invalid_argument);
}

}  // namespace
