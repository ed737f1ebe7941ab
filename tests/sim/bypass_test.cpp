/// Stages can be skipped one by one; what they would have changed stays as it was.

#include <gtest/gtest.h>

#include "tests/support/snow.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

SolverSettings skipping(std::vector<Stage> stages) {
  SolverSettings s;
  s.cell_size = 0.03;
  s.bypass = std::move(stages);
  return s;
}

struct BypassCase {
  ParticleArrays particles = ball_of_snow({0, 0.13, 0}, 0.12, 0.015, {0, -3, 0});
  std::vector<shapes::Collider> colliders{plane({0, 0.043, 0}, {0, 1, 0}, 0.5)};

  Simulation run(const SolverSettings& s, double until = 0.02) const {
    Simulation simulation(s, {Material{}}, colliders, particles, 1);
    simulation.advance_to(until);
    return simulation;
  }
};

TEST(Bypass, ACollidersStageOfRestingCollidersChangesNothing) {
  const BypassCase c;
  const Simulation whole = c.run(skipping({})), skipped = c.run(skipping({Stage::colliders}));
  // FLIP: the staged driver, which takes over, agrees with the fused one in every bit.
  EXPECT_EQ(whole.state_hash(), skipped.state_hash());
}

TEST(Bypass, SkippedAdvectionMovesNothing) {
  const BypassCase c;
  const ParticleArrays after = c.run(skipping({Stage::advection})).particles();
  for (std::size_t p = 0; p < after.x.size(); ++p)
    // The places of the records: a float offset in cells of 3 cm.
    EXPECT_LT((after.x[p] - c.particles.x[p]).norm(), 1e-8);
}

TEST(Bypass, SkippedDeformationTurnsSnowIntoDust) {
  const BypassCase c;
  const Simulation simulation = c.run(skipping({Stage::deformation}));
  for (const Mat3d& F : simulation.particles().F_E) EXPECT_EQ(F, Mat3d(Mat3d::Identity()));
  EXPECT_EQ(simulation.summary().elastic_energy, 0);
  EXPECT_FALSE(simulation.divergence());
}

/// Nodes that nothing was written to have no velocity to do work with.
TEST(Bypass, AStateOfStepsWithoutNodesCanBeRestored) {
  BypassCase c;
  c.colliders.push_back(plane({0, 0.02, 0}, {0.5, 1, 0.3}, 1.5));
  c.colliders.back().velocity = {0, 0.5, 0};
  const SolverSettings s =
      skipping({Stage::colliders, Stage::rasterize, Stage::grid_velocities, Stage::advection});
  const Simulation simulation = c.run(s);
  Simulation again(s, {Material{}}, c.colliders, c.particles, 1);
  ASSERT_NO_THROW(again.restore_healthy(simulation.save()));
  EXPECT_EQ(again.state_hash(), simulation.state_hash());
}

TEST(Bypass, SkippedForcesLetSnowFallAndStrainGrow) {
  BypassCase c;
  c.colliders.clear();
  const Simulation simulation = c.run(skipping({Stage::elastic_forces}));
  const Summary s = simulation.summary();
  // Free fall by symplectic Euler, with at most one step's difference from g t.
  EXPECT_NEAR(s.momentum.y() / s.mass, -3 - 9.81 * 0.02, 1e-4);
}

TEST(Bypass, SkippedGridVelocitiesRemoveGravity) {
  BypassCase c;
  c.colliders.clear();
  const Summary s = c.run(skipping({Stage::grid_velocities})).summary();
  EXPECT_NEAR(s.momentum.y() / s.mass, -3, 1e-5);
}

TEST(Bypass, SkippedParticleVelocitiesStayTheSame) {
  BypassCase c;
  c.colliders.clear();
  const ParticleArrays after = c.run(skipping({Stage::particle_velocities})).particles();
  for (const Vec3d& v : after.v) EXPECT_EQ(v, Vec3d(0, -3, 0));
}

TEST(Bypass, SkippedCollisionsLetSnowFallThroughTheFloor) {
  const BypassCase c;
  const Summary with = c.run(skipping({}), 0.1).summary();
  const Summary without =
      c.run(skipping({Stage::grid_collisions, Stage::particle_collisions}), 0.1).summary();
  EXPECT_GT(with.centre_of_mass.y(), 0.05);
  EXPECT_LT(without.centre_of_mass.y(), -0.15);
  // Either alone holds it up.
  EXPECT_GT(c.run(skipping({Stage::particle_collisions}), 0.1).summary().centre_of_mass.y(), 0.03);
}

TEST(Bypass, SkippedRasterizingLeavesTheGridEmpty) {
  BypassCase c;
  c.colliders.clear();
  SolverSettings s = skipping({Stage::rasterize});
  s.transfer = Transfer::flip;
  s.flip_ratio = 1;
  const Simulation simulation = c.run(s);
  // An empty grid has no velocity to hand on; FLIP adds its change, which is nothing.
  for (const Vec3d& v : simulation.particles().v) EXPECT_EQ(v, Vec3d(0, -3, 0));
  EXPECT_EQ(simulation.summary().elastic_energy, 0);
}

TEST(Bypass, SkippedVolumesRemoveStress) {
  BypassCase c;
  c.particles.V0.clear();
  const Simulation simulation = c.run(skipping({Stage::volumes}));
  for (const double V0 : simulation.particles().V0) EXPECT_EQ(V0, 0);
  EXPECT_FALSE(simulation.divergence());
}

}  // namespace
