/// Properties of every combination of transfer, kernel, advection and precision at every SIMD
/// level: bits that do not depend on threads or place, and conservation.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <set>

#include "sim/laws/cam_clay.h"
#include "sim/laws/list.h"
#include "tests/support/combinations.h"
#include "tests/support/simd_levels.h"
#include "tests/support/snow.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

std::vector<Material> all_materials() {
  std::vector<Material> m(6);
  m[1].model = laws::model::corotated;
  m[1].youngs_modulus = 3e4;
  m[2].model = laws::model::neo_hookean;
  m[2].youngs_modulus = 5e4;
  m[2].hardening = 0;
  m[3].model = laws::model::cam_clay;
  m[4].model = laws::model::sand;
  m[5].model = laws::model::cam_clay;
  m[5].own[laws::cam_clay::flow] = laws::cam_clay::isochoric;
  return m;
}

/// Materials that change from particle to particle.
void mix_materials(ParticleArrays& p) {
  std::mt19937 random(5);
  for (std::size_t q = 0; q < p.x.size(); ++q) p.material.push_back(static_cast<int>(random() % 6));
}

/// A ball of 7000 particles, enough for seven threads, in the middle of hitting everything.
ParticleArrays disturbed_ball() {
  ParticleArrays p = ball_of_snow({0.01, 0.16, -0.02}, 0.12, 0.01, {0, 0, 0}, 7);
  disturb(p, 0.02, 1.0);
  for (Vec3d& v : p.v) v += Vec3d(0.3, -4, 0.1);
  mix_materials(p);
  return p;
}

std::vector<shapes::Collider> three_colliders() {
  shapes::Collider ball;
  ball.name = "ball";
  ball.shape.form = shapes::Sphere{{0.05, 0.08, 0.03}, 0.06};
  ball.contact = shapes::Contact::sticky;
  ball.velocity = {0.1, 0, 0};
  ball.angular_velocity = {0, 3, 1};
  shapes::Collider box;
  box.name = "box";
  box.shape.form = shapes::Box{{-0.1, 0.12, 0}, {0.1, 0.06, 0.2}};
  box.shape.rotation = {10, 20, 30};
  box.contact = shapes::Contact::slip;
  box.angular_velocity = {2, 0, -1};
  return {plane({0, 0.03, 0}, {0.1, 1, 0}, 0.4), ball, box};
}

TEST(EveryCombination, EveryCombinationGivesTheSameBitsAnywhere) {
  const ParticleArrays p = disturbed_ball();
  ASSERT_GE(p.x.size(), 7000u);
  const neve::sim::Vec3i far_away(-19531, 19531, 19531);  // of 4 cells: a kilometre and a half
  at_every_simd_level([&] {
    std::set<std::uint64_t> hashes;
    for (const Combination& combination : all_combinations()) {
      SCOPED_TRACE(combination.name());
      SolverSettings s;
      s.cell_size = 0.02;
      combination.apply_to(s);
      const auto run = [&](int threads, const neve::sim::Vec3i& origin) {
        Simulation simulation(s, all_materials(), three_colliders(), p, threads, origin);
        for (int k = 0; k < 4; ++k) simulation.step(simulation.choose_dt(1).dt);
        return simulation.state_hash();
      };
      const std::uint64_t one = run(1, neve::sim::Vec3i::Zero());
      for (const int threads : {2, 3, 7})
        EXPECT_EQ(run(threads, neve::sim::Vec3i::Zero()), one) << threads;
      EXPECT_EQ(run(2, far_away), one) << "far away";
      hashes.insert(one);
    }
    // No setting is without effect.
    EXPECT_EQ(hashes.size(), all_combinations().size());
  });
}

/// 1.0 of rounding error of the combination's numbers.
double epsilon_of(const Combination& c) {
  return c.precision == Precision::single ? 6e-8 : 1.1e-16;
}

TEST(EveryCombination, EveryCombinationConservesMassMomentumAndApicAndMlsAngularMomentum) {
  ParticleArrays p = box_of_snow({-0.11, 0.02, 0.33}, {0.14, 0.21, 0.52}, 0.025);
  disturb(p, 0.02, 2.0);
  mix_materials(p);
  at_every_simd_level([&] {
    for (const Combination& combination : all_combinations()) {
      SCOPED_TRACE(combination.name());
      SolverSettings s;
      s.cell_size = 0.05;
      combination.apply_to(s);
      Simulation simulation(s, all_materials(), {}, p, 1);
      const Summary start = simulation.summary();
      constexpr int steps = 10;
      constexpr double dt = 1e-4;
      for (int k = 0; k < steps; ++k) simulation.step(dt);
      const Summary end = simulation.summary();
      // 600 particles of up to 2 m/s and forces of as much per step; every rounding error of a
      // particle counts once per step, and they do not all point the same way.
      const double scale = start.mass * 2, most = 10 * epsilon_of(combination);
      EXPECT_EQ(end.mass, start.mass);
      const Vec3d impulse = start.mass * steps * dt * s.gravity;
      EXPECT_LE((end.momentum - start.momentum - impulse).norm(), most * scale);
      if (combination.transfer != Transfer::apic && combination.transfer != Transfer::mls) continue;
      // Gravity turns everything about the origin: by the lever arm of the centre of mass, which
      // each step starts from.
      Vec3d turned(0, 0, 0);
      for (int k = 0; k < steps; ++k) {
        const Vec3d centre = start.centre_of_mass + k * dt * start.momentum / start.mass +
                             0.5 * k * (k + 1) * dt * dt * s.gravity;
        turned += start.mass * dt * centre.cross(s.gravity);
      }
      EXPECT_LE((end.angular_momentum - start.angular_momentum - turned).norm(), most * scale);
    }
  });
}

TEST(EveryCombination, EveryCombinationFallsFreelyWithoutStrain) {
  ParticleArrays p = box_of_snow({0, 0, 0}, {0.2, 0.2, 0.2}, 0.025);
  for (Vec3d& v : p.v) v = {1.5, 2, -0.5};
  mix_materials(p);
  at_every_simd_level([&] {
    for (const Combination& combination : all_combinations()) {
      SCOPED_TRACE(combination.name());
      SolverSettings s;
      s.cell_size = 0.05;
      combination.apply_to(s);
      Simulation simulation(s, all_materials(), {}, p, 1);
      constexpr int steps = 40;  // past a sorting of storage
      constexpr double dt = 1e-3;
      for (int k = 0; k < steps; ++k) simulation.step(dt);
      const ParticleArrays end = simulation.particles();
      const Vec3d v = p.v[0] + steps * dt * s.gravity;
      const Vec3d way = steps * dt * p.v[0] + 0.5 * steps * (steps + 1) * dt * dt * s.gravity;
      // Each step rounds the speed of 2.5 m/s once on the nodes and once on the particle, and the
      // differences between nodes, times dt/h, strain; stress answers, which keeps them small.
      const double epsilon = epsilon_of(combination);
      for (std::size_t q = 0; q < p.x.size(); ++q) {
        ASSERT_LE((end.v[q] - v).norm(), 4 * steps * 2.5 * epsilon);
        ASSERT_LE((end.x[q] - p.x[q] - way).norm(), steps * 0.2 * epsilon);
        ASSERT_LE((end.F_E[q] - Mat3d::Identity()).norm(), 4 * steps * epsilon);
      }
    }
  });
}

}  // namespace
