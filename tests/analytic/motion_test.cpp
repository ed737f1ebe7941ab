/// Free flight, rotation and being carried: motions with a known answer.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "sim/laws/list.h"
#include "tests/support/elastic.h"
#include "tests/support/snow.h"
#include "tests/support/verification.h"

namespace {

using namespace neve::sim;
using namespace neve::test;

/// Largest distance of a falling ball's particles from where they belong after 200 steps, m.
double error_of_fall(Transfer transfer, Kernel kernel, Precision precision) {
  // Symplectic Euler is exact up to its own sum: x = x0 + n dt v0 + g dt^2 n (n + 1) / 2.
  const double dt = 1e-3;
  const int n = 200;
  SolverSettings s;
  s.cell_size = 0.05;
  s.transfer = transfer;
  s.kernel = kernel;
  s.precision = precision;
  const Vec3d v0(1.5, 2, -0.7);
  const ParticleArrays start = ball_of_snow({0, 1, 0}, 0.12, 0.025, v0);
  Simulation simulation(s, {Material{}}, {}, start, 1);
  for (int k = 0; k < n; ++k) simulation.step(dt);
  const ParticleArrays end = simulation.particles();
  const Vec3d moved = n * dt * v0 + 0.5 * n * (n + 1) * dt * dt * s.gravity;
  double worst = 0;
  for (std::size_t p = 0; p < start.x.size(); ++p)
    worst = std::max(worst, (end.x[p] - start.x[p] - moved).norm());
  return worst;
}

TEST(FreeFall, FreeFallFollowsParabola) {
  for (const Transfer transfer : {Transfer::flip, Transfer::apic, Transfer::mls})
    for (const Kernel kernel : {Kernel::cubic, Kernel::quadratic}) {
      const std::string line = "free fall, " + name(transfer) + " " + name(kernel);
      // Rounding of 200 steps; the reference reaches 1e-12.
      verify_at_most({"motion", line + ", double", "largest error of x after 0.2 s, m"}, 1e-11,
                     error_of_fall(transfer, kernel, Precision::real64));
      // 200 velocities of 3 m/s rounded to 2e-7 m/s, 0.2 s long.
      verify_at_most({"motion", line + ", float", "largest error of x after 0.2 s, m"}, 1e-5,
                     error_of_fall(transfer, kernel, Precision::single));
    }
}

TEST(RigidRotation, RigidRotationKeepsShapeAndSpin) {
  SolverSettings s;
  s.cell_size = 0.04;
  s.transfer = Transfer::apic;
  s.precision = Precision::real64;
  s.gravity.setZero();
  Material m;
  m.model = laws::model::corotated;
  const double spin = 8, time = 0.8;  // one turn
  ParticleArrays p = box_of_snow({-0.12, -0.12, -0.12}, {0.12, 0.12, 0.12}, 0.02);
  const std::vector<Vec3d> X = p.x;
  for (std::size_t q = 0; q < X.size(); ++q) p.v[q] = Vec3d(0, spin, 0).cross(X[q]);
  p.C.assign(X.size(), Mat3d{{0, 0, spin}, {0, 0, 0}, {-spin, 0, 0}});
  Simulation simulation(s, {m}, {}, p, 1);
  const Summary start = simulation.summary();
  simulation.advance_to(time);
  const Summary end = simulation.summary();
  const std::string line = "cube, one turn, APIC cubic, double";
  verify_at_most({"motion", line, "change of angular momentum / angular momentum"}, 1e-11,
                 std::abs(end.angular_momentum[1] / start.angular_momentum[1] - 1));
  // Energy differs only by what the centrifugal stretch stores and its ringing loses: rho (spin
  // L)^2 / E = 3e-3. Swapped rows or columns in F or P lose the cube within a third of a turn.
  const double energy = (end.kinetic_energy + end.elastic_energy) / start.kinetic_energy;
  verify_near({"motion", line, "energy / start"}, 1, energy, 0.01);
  // The turn is behind by what the stretch adds to the moment of inertia.
  const std::vector<Vec3d> x = simulation.particles().x;
  const Vec3d centre = end.centre_of_mass, first = start.centre_of_mass;
  double sine = 0, cosine = 0, stretch = 0;
  for (std::size_t q = 0; q < X.size(); ++q) {
    const Vec3d a = X[q] - first, b = x[q] - centre;
    sine += a[2] * b[0] - a[0] * b[2], cosine += a[0] * b[0] + a[2] * b[2];
    stretch = std::max(stretch, std::abs(b.norm() / a.norm() - 1));
  }
  const double turn = std::atan2(sine, cosine) + 2 * std::numbers::pi;
  verify_ratio({"motion", line, "angle, rad"}, spin * time, turn, 0.01);
  verify_at_most({"motion", line, "largest change of a radius / radius"}, 0.02, stretch);
}

TEST(TwoBalls, BallsCollideWithZeroMomentumAndLoseEnergy) {
  SolverSettings s;
  s.cell_size = 0.05;
  s.precision = Precision::real64;
  s.gravity.setZero();
  ParticleArrays p = ball_of_snow({-0.22, 0, 0}, 0.2, 0.025, {2, 0, 0});
  const std::size_t half = p.x.size();
  for (std::size_t q = 0; q < half; ++q) {  // the mirror image: momentum is zero exactly
    p.x.push_back(Vec3d(-p.x[q][0], p.x[q][1], p.x[q][2]));
    p.v.push_back(-p.v[q]);
    p.m.push_back(p.m[q]);
    p.V0.push_back(p.V0[q]);
  }
  Simulation simulation(s, {Material{}}, {}, p, 1);
  const double start = simulation.summary().kinetic_energy;
  simulation.advance_to(0.04);
  const Summary end = simulation.summary();
  const std::string line = "two snowballs at 4 m/s";
  verify_at_most({"motion", line, "|momentum| / mass, m/s"}, 1e-12, end.momentum.norm() / end.mass);
  // They lose nearly all of it (the reference: 98.9 % of another pair, after 0.04 s).
  verify_at_most({"motion", line, "kinetic energy / start after 0.04 s"}, 0.1,
                 end.kinetic_energy / start);
  EXPECT_LT(end.min_J_P, 0.97);
}

TEST(MovingCollider, MovingColliderCarriesSnowAtItsOwnVelocity) {
  SolverSettings s;
  s.cell_size = 0.04;
  shapes::Collider sled;
  sled.name = "sled";
  sled.shape.form = shapes::Box{{0, -0.097, 0}, {0.6, 0.2, 0.6}};
  sled.contact = shapes::Contact::sticky;
  sled.velocity = {0.5, 0, 0};
  Simulation simulation(s, {Material{}}, {sled},
                        box_of_snow({-0.1, 0, -0.1}, {0.1, 0.1, 0.1}, 0.02), 1);
  simulation.advance_to(1);
  const Summary end = simulation.summary();
  EXPECT_FALSE(simulation.divergence());
  verify_near({"motion", "snow on a sled", "velocity after 1 s, m/s"}, 0.5,
              end.momentum[0] / end.mass, 0.01);
  // It was picked up from rest.
  verify_near({"motion", "snow on a sled", "distance after 1 s, m"}, 0.5, end.centre_of_mass[0],
              0.03);
}

}  // namespace
