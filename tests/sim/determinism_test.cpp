/// Same bits at any number of threads, anywhere on the lattice, and whether or not anybody looks.

#include <gtest/gtest.h>

#include <cmath>

#include "sim/staged.h"
#include "tests/support/snow.h"

namespace {

using namespace neve;
using namespace neve::sim;
using namespace neve::test;

/// A ball that hits the floor: 50 000 particles, so that each of three threads has work.
ParticleArrays large_ball() {
  return ball_of_snow({0.01, 0.17, -0.02}, 0.15, 0.0064, {0.3, -4, 0.1});
}

SolverSettings fine() {
  SolverSettings s;
  s.cell_size = 0.0128;
  return s;
}

std::uint64_t hash_after(const SolverSettings& s, const ParticleArrays& p, int threads, int steps) {
  Simulation simulation(s, {Material{}}, {plane({0, 0.013, 0}, {0, 1, 0}, 0.5)}, p, threads);
  for (int k = 0; k < steps; ++k) simulation.step(simulation.choose_dt(1).dt);
  return simulation.state_hash();
}

TEST(Determinism, SameBitsAtAnyNumberOfThreads) {
  const ParticleArrays p = large_ball();
  ASSERT_GE(p.x.size(), 50000u);
  // 40 steps pass the sorting of storage at step 32.
  const std::uint64_t one = hash_after(fine(), p, 1, 40);
  EXPECT_EQ(hash_after(fine(), p, 2, 40), one);
  EXPECT_EQ(hash_after(fine(), p, 3, 40), one);
  EXPECT_EQ(hash_after(fine(), p, 7, 40), one);
}

TEST(Determinism, HashSeesASingleBit) {
  ParticleArrays p = large_ball();
  const std::uint64_t before = hash_after(fine(), p, 1, 0);
  p.v[1234][1] = std::nextafter(static_cast<float>(p.v[1234][1]), 0.0f);
  EXPECT_NE(hash_after(fine(), p, 1, 0), before);
}

TEST(Determinism, SameBitsWithTheLatticeOriginOneKilometreAway) {
  SolverSettings s = fine();
  for (const Precision precision : {Precision::single, Precision::real64}) {
    s.precision = precision;
    const ParticleArrays p = ball_of_snow({0.01, 0.17, -0.02}, 0.15, 0.016, {0.3, -4, 0.1});
    // Blocks of 4 cells: 19531 of them are 999.99 m.
    const neve::sim::Vec3i far_away(19531, -19531, 19531);
    shapes::Collider ball;
    ball.name = "ball";
    ball.shape.form = shapes::Sphere{{0.05, 0.02, 0.03}, 0.06};
    ball.angular_velocity = {0, 3, 1};
    ball.velocity = {0.1, 0, 0};
    const std::vector<shapes::Collider> colliders{plane({0, 0.013, 0}, {0.1, 1, 0}, 0.5), ball};
    Simulation here(s, {Material{}}, colliders, p, 2),
        there(s, {Material{}}, colliders, p, 2, far_away);
    here.advance_to(0.012);
    there.advance_to(0.012);
    EXPECT_EQ(here.steps(), there.steps());
    EXPECT_EQ(here.state_hash(), there.state_hash());
    const auto a = here.cells(), b = there.cells();
    for (std::size_t q = 0; q < a.size(); ++q) ASSERT_EQ(b[q] - a[q], 4 * far_away);
  }
}

TEST(Determinism, DyadicSceneMovedByWholeBlocksGivesTheSameBits) {
  SolverSettings s;
  s.cell_size = 0.03125;
  const auto run = [&](const Vec3d& shift) {
    ParticleArrays p = box_of_snow({0, 0.0625, 0}, {0.25, 0.3125, 0.25}, 0.015625);
    for (Vec3d& x : p.x) {
      for (int a = 0; a < 3; ++a) x[a] = std::round(x[a] * 4096) / 4096;
      x += shift;
    }
    for (Vec3d& v : p.v) v = {0.5, -3, 0.25};
    Simulation simulation(s, {Material{}}, {plane(Vec3d(0, 0.03, 0) + shift, {0, 1, 0}, 0.5)}, p,
                          2);
    simulation.advance_to(0.02);
    ParticleArrays end = simulation.particles();
    for (Vec3d& x : end.x) x -= shift;
    return end;
  };
  const ParticleArrays here = run({0, 0, 0}), there = run({1024, -2048, 512});
  for (std::size_t q = 0; q < here.x.size(); ++q) {
    ASSERT_EQ(here.x[q], there.x[q]);
    ASSERT_EQ(here.v[q], there.v[q]);
    ASSERT_EQ(here.F_E[q], there.F_E[q]);
  }
}

/// Largest differences of two states.
struct Difference {
  double x = 0, v = 0, F_E = 0;
};
Difference difference(const ParticleArrays& a, const ParticleArrays& b) {
  Difference d;
  for (std::size_t q = 0; q < a.x.size(); ++q) {
    d.x = std::max(d.x, (a.x[q] - b.x[q]).cwiseAbs().maxCoeff());
    d.v = std::max(d.v, (a.v[q] - b.v[q]).cwiseAbs().maxCoeff());
    d.F_E = std::max(d.F_E, (a.F_E[q] - b.F_E[q]).cwiseAbs().maxCoeff());
  }
  return d;
}

TEST(StagedDriver, StagedDriverAgreesWithTheFusedOneAlongARun) {
  for (const Transfer transfer :
       {Transfer::flip, Transfer::apic, Transfer::mls, Transfer::aflip, Transfer::asflip}) {
    for (const Precision precision : {Precision::single, Precision::real64}) {
      SolverSettings s;
      s.cell_size = 0.04;
      s.transfer = transfer;
      s.precision = precision;
      const ParticleArrays p = ball_of_snow({0, 0.17, 0}, 0.12, 0.02, {0, -5, 0});
      Simulation simulation(s, {Material{}}, {plane({0, 0.01, 0}, {0, 1, 0}, 0.5)}, p, 2);
      for (int k = 0; k < 70; ++k) {
        const double dt = simulation.choose_dt(1).dt;
        const bool looks = k % 10 == 3;
        const StagedStep staged = looks ? staged_step(simulation, dt) : StagedStep{};
        simulation.step(dt);
        if (!looks) continue;
        if (transfer != Transfer::apic && transfer != Transfer::mls) {
          ASSERT_EQ(simulation.state_hash(), staged.state_hash) << "step " << k;
          continue;
        }
        // The fused driver adds dt f to the momentum of a node before it divides by the mass, the
        // staged one divides both: rounding of speeds of 5 m/s, through one step.
        const double epsilon = precision == Precision::single ? 6e-8 : 1.1e-16;
        const Difference d = difference(simulation.particles(), staged.after);
        EXPECT_LE(d.v, 200 * 5 * epsilon) << "step " << k;
        EXPECT_LE(d.x, 200 * 0.2 * epsilon) << "step " << k;
        EXPECT_LE(d.F_E, 200 * epsilon) << "step " << k;
      }
    }
  }
}

}  // namespace
