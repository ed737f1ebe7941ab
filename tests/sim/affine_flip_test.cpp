/// AFLIP and ASFLIP: against the twin, step by step, and what they conserve.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "sim/staged.h"
#include "tests/support/affine_flip_twin.h"
#include "tests/support/simd_levels.h"
#include "tests/support/snow.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

SolverSettings affine_settings(Transfer transfer, Kernel kernel, double alpha) {
  SolverSettings s;
  s.cell_size = 0.05;
  s.transfer = transfer;
  s.kernel = kernel;
  s.precision = Precision::real64;
  s.flip_ratio = alpha;
  s.flip_reference_dt = 0;
  s.separation_min = 0.2;
  s.separation_max = 0.9;
  s.shock_viscosity = 0;  // the twin has none
  return s;
}

/// Every kind of affine FLIP, in turn.
template <class Body>
void each_affine_flip(const Body& body) {
  for (const Transfer transfer : {Transfer::aflip, Transfer::asflip})
    for (const Kernel kernel : {Kernel::cubic, Kernel::quadratic})
      for (const double alpha : {0.95, 1.0}) {
        SCOPED_TRACE(std::string(transfer == Transfer::aflip ? "aflip" : "asflip") +
                     (kernel == Kernel::cubic ? ", cubic" : ", quadratic") +
                     (alpha < 1 ? ", 0.95" : ", 1"));
        body(affine_settings(transfer, kernel, alpha));
      }
}

TEST(AffineFlip, AffineFlipIsItsTwinStepByStep) {
  constexpr double dt = 1e-4;
  const ParticleArrays p = disturbed_snow();
  at_every_simd_level([&] {
    each_affine_flip([&](const SolverSettings& s) {
      Simulation simulation(s, {Material{}}, {}, p, 1);
      AffineFlipTwin twin(s, Material{}, s.flip_ratio, simulation.particles());
      // Differences of rounding grow with the stress, c dt / h = 0.04 a step. A wrong term shows at
      // 1e-4 of the speed, in the first step.
      constexpr double rounding = 1e-11;
      std::size_t yielded = 0, compressed = 0;
      for (int k = 1; k <= 20; ++k) {
        simulation.step(dt);
        twin.step(dt);
        const ParticleArrays now = simulation.particles();
        for (std::size_t q = 0; q < now.x.size(); ++q) {
          ASSERT_LT((now.x[q] - twin.p.x[q]).norm(), rounding * s.cell_size) << "step " << k;
          ASSERT_LT((now.v[q] - twin.p.v[q]).norm(), 2 * rounding) << "step " << k;
          ASSERT_LT((now.C[q] - twin.p.C[q]).norm(), 2 * rounding / s.cell_size) << "step " << k;
          ASSERT_LT((now.F_E[q] - twin.p.F_E[q]).norm(), rounding) << "step " << k;
          ASSERT_LT(std::abs(now.J_P[q] - twin.p.J_P[q]), rounding) << "step " << k;
          yielded += now.J_P[q] != p.J_P[q];
          compressed += now.F_E[q].determinant() < s.separation_J_E;
        }
      }
      EXPECT_GT(yielded, 0u);
      EXPECT_GT(compressed, p.x.size());
      EXPECT_LT(compressed, 19 * p.x.size());
    });
  });
}

/// Nodes that colliders and the solve have changed: the way back to the particles is the same.
TEST(AffineFlip, AffineFlipReturnsFromTheGridAsItsTwinDoes) {
  const shapes::Collider floor = plane({0, 0.045, 0}, {0.1, 1, 0}, 0.4);
  each_affine_flip([&](SolverSettings s) {
    for (const double beta : {0.0, 1.0})
      for (const ContactAt contact_at : {ContactAt::particles, ContactAt::nodes}) {
        s.beta = beta;
        s.contact_at = contact_at;
        const double dt = beta > 0 ? 1e-3 : 1e-4;
        const Simulation simulation(s, {Material{}}, {floor}, disturbed_snow(), 1);
        const ParticleArrays before = simulation.particles();
        const StagedStep step = staged_step(simulation, dt);
        AffineFlipTwin twin(s, Material{}, s.flip_ratio, before);
        twin.return_from(step.nodes, dt);
        std::size_t free = 0;
        double held = 0;
        for (std::size_t i = 0; i < step.nodes.node.size(); ++i)
          held = std::max(held, (step.nodes.v_new[i] - step.nodes.v_free[i]).norm());
        EXPECT_GT(held, 0.01) << "nothing acts on the nodes";
        for (std::size_t q = 0; q < before.x.size(); ++q) {
          ASSERT_LT((step.after.C[q] - twin.p.C[q]).norm(), 1e-9);
          // The floor takes velocities of their own from particles that come to it, and stops
          // particles in it.
          const double height = Vec3d(0.1, 1, 0).normalized().dot(before.x[q] - Vec3d(0, 0.045, 0));
          const bool may_touch = contact_at == ContactAt::particles && height < 0.25 * s.cell_size;
          if (may_touch) continue;
          ASSERT_LT((step.v_before_collision[q] - twin.p.v[q]).norm(), 1e-11);
          if (height < 0) continue;
          ++free;
          ASSERT_LT((step.after.x[q] - twin.p.x[q]).norm(), 1e-12);
          ASSERT_LT((step.after.v[q] - twin.p.v[q]).norm(), 1e-11);
        }
        EXPECT_GT(free, before.x.size() / 2);
      }
  });
}

TEST(AffineFlip, AffineFlipMovesByTheGridAndAShareOfItsOwnVelocity) {
  // One step of snow of which half is compressed: the shares are those of the settings.
  constexpr double dt = 1e-4;
  SolverSettings s = affine_settings(Transfer::asflip, Kernel::cubic, 1);
  s.separation_min = 0.25;
  s.separation_max = 0.75;
  const Simulation simulation(s, {Material{}}, {}, disturbed_snow(), 1);
  const ParticleArrays before = simulation.particles();
  SolverSettings by_grid = s;
  by_grid.transfer = Transfer::aflip;
  const ParticleArrays moved = staged_step(simulation, dt).after;
  const ParticleArrays carried =
      staged_step(Simulation(by_grid, {Material{}}, {}, before, 1), dt).after;
  std::size_t compressed = 0;
  for (std::size_t q = 0; q < before.x.size(); ++q) {
    ASSERT_EQ(moved.v[q], carried.v[q]);
    const Vec3d grid = (carried.x[q] - before.x[q]) / dt, own = moved.v[q] - grid;
    const bool is_compressed = before.F_E[q].determinant() < s.separation_J_E;
    compressed += is_compressed;
    const Vec3d expected = carried.x[q] + dt * (is_compressed ? 0.25 : 0.75) * own;
    ASSERT_LT((moved.x[q] - expected).norm(), 1e-13);
  }
  EXPECT_GT(compressed, before.x.size() / 10);
  EXPECT_LT(compressed, before.x.size() * 9 / 10);
}

/// The angular momentum of a step of nothing but transfers changes by alpha times what the grid
/// cannot hold of the affine velocities; that of rigid rotation it can, and nothing changes.
TEST(AffineFlip, AffineFlipChangesAngularMomentumByTheAffinePartThatTheGridCannotHold) {
  constexpr double dt = 1e-9;
  Material soft;
  soft.youngs_modulus = 1e-3;
  each_affine_flip([&](SolverSettings s) {
    s.gravity.setZero();
    Simulation simulation(s, {soft}, {}, disturbed_snow(), 1);
    const ParticleArrays before = simulation.particles();
    AffineFlipTwin twin(s, soft, s.flip_ratio, before);
    twin.rasterize();
    const Vec3d expected =
        s.flip_ratio * (twin.spin(twin.affine_velocity_before()) - twin.spin(before.C));
    const Summary start = simulation.summary();
    simulation.step(dt);
    const Vec3d change = simulation.summary().angular_momentum - start.angular_momentum;
    EXPECT_GT(expected.norm(), 1e-4 * start.mass);
    EXPECT_LT((change - expected).norm(), 1e-6 * expected.norm());
  });
}

TEST(AffineFlip, AffineFlipTurnsARigidBodyForEver) {
  const Vec3d spin(0.5, -1, 2);
  each_affine_flip([&](SolverSettings s) {
    s.gravity.setZero();
    ParticleArrays p = ball_of_snow({0.2, 0.1, -0.3}, 0.15, 0.025, {0, 0, 0});
    Mat3d C;
    C << 0, -spin[2], spin[1], spin[2], 0, -spin[0], -spin[1], spin[0], 0;
    p.C.assign(p.x.size(), C);
    for (std::size_t q = 0; q < p.x.size(); ++q) p.v[q] = Vec3d(1, 2, 3) + spin.cross(p.x[q]);
    Material soft;
    soft.youngs_modulus = 1e-3;
    Simulation simulation(s, {soft}, {}, p, 1);
    const Summary start = simulation.summary();
    simulation.step(1e-9);
    const Summary end = simulation.summary();
    EXPECT_LT((end.angular_momentum - start.angular_momentum).norm(),
              1e-12 * start.angular_momentum.norm());
    EXPECT_NEAR(end.kinetic_energy / start.kinetic_energy, 1, 1e-12);
  });
}

/// A body that comes without affine velocities gets those of its motion, or it would gain energy in
/// its first steps; FLIP has none.
TEST(AffineFlip, AffineFlipFitsAffineVelocitiesToABodyThatHasNone) {
  SolverSettings s = affine_settings(Transfer::aflip, Kernel::cubic, 1);
  s.gravity.setZero();
  ParticleArrays p = ball_of_snow({0.2, 0.1, -0.3}, 0.15, 0.025, {0, 0, 0});
  for (std::size_t q = 0; q < p.x.size(); ++q) p.v[q] = Vec3d(0, 0, 3).cross(p.x[q]);
  Simulation simulation(s, {Material{}}, {}, p, 1);
  double worst = 0;
  for (const Mat3d& C : simulation.particles().C)
    worst = std::max({worst, std::abs(C(1, 0) - 3), std::abs(C(0, 1) + 3)});
  // At the surface the fit has not quite arrived.
  EXPECT_LT(worst, 0.45);
  const Summary start = simulation.summary();
  for (int k = 0; k < 20; ++k) simulation.step(1e-4);
  EXPECT_NEAR(simulation.summary().kinetic_energy / start.kinetic_energy, 1, 3e-3);
  EXPECT_NEAR(simulation.summary().angular_momentum[2] / start.angular_momentum[2], 1, 3e-3);
  s.transfer = Transfer::flip;
  for (const Mat3d& C : Simulation(s, {Material{}}, {}, p, 1).particles().C)
    EXPECT_TRUE(C.isZero());
}

}  // namespace
