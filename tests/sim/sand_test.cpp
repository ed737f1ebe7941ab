/// Sand: its cone, the volume that it gives back, and slopes that slide beyond the friction angle.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <random>

#include "sim/health/diagnostics.h"
#include "sim/laws/cam_clay.h"
#include "sim/laws/list.h"
#include "sim/simulation.h"
#include "sim/state/method.h"
#include "sim/state/records.h"
#include "tests/support/one_particle.h"
#include "tests/support/sand.h"
#include "tests/support/simd_levels.h"

namespace {

using namespace neve;
using namespace neve::sim;
using namespace neve::test;

constexpr double pi = 3.14159265358979323846;

template <class Real>
kernels::Particle<Real> grain(const Mat3d& F_E, double J_P) {
  kernels::Particle<Real> p{};
  engine::store_matrix(F_E, p.F_E);
  p.J_P = static_cast<Real>(J_P);
  p.m = p.V0 = p.stiffness = p.threshold = 1;
  p.kind = kernels::kind_of<Real>(0, laws::model::sand, 0);
  return p;
}

/// q <= M p in any state after the return, and the volume is that of before.
template <class Real>
void expect_cone(double tolerance) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  const Material m = dry_sand(30);
  for (int trial = 0; trial < 300; ++trial) {
    const Mat3d F = std::exp(0.05 * unit(random)) *
                    (Mat3d::Identity() + 0.1 * Mat3d::NullaryExpr([&] { return unit(random); }));
    const double J_P = trial % 3 ? 1 + 0.05 * (1 + unit(random)) : 1;
    kernels::Particle<Real> p = grain<Real>(F, J_P);
    update_material(p, engine::constants_of<Real>(m));
    const Mat3d F_new = engine::matrix(p.F_E);
    const double J_P_new = static_cast<double>(p.J_P);
    EXPECT_NEAR(F_new.determinant() * J_P_new, F.determinant() * J_P, tolerance);
    EXPECT_GE(J_P_new, 1 - tolerance);
    const Mat3d tau = health::first_piola(m, F_new, 1) * F_new.transpose();
    const double pressure = -tau.trace() / 3;
    const double q = std::sqrt(1.5) * (tau + pressure * Mat3d::Identity()).norm();
    const double M = laws::critical_slope(m.friction_angle);
    EXPECT_LE(q, M * pressure + 3 * tolerance * m.youngs_modulus);
  }
}

TEST(Sand, SandStaysOnItsConeAndKeepsItsVolume) {
  at_every_simd_level([] {
    expect_cone<double>(1e-12);
    expect_cone<float>(3e-6);
  });
}

/// Sand that is thrown apart and pressed together again bears pressure where it did before.
TEST(Sand, SandGivesBackTheVolumeThatItGained) {
  const Material m = dry_sand(30);
  kernels::Particle<double> p = grain<double>(Mat3d::Identity(), 1);
  const auto strain = [&](double factor) {
    engine::store_matrix(Mat3d(factor * engine::matrix(p.F_E)), p.F_E);
    update_material(p, engine::constants_of<double>(m));
  };
  for (int k = 0; k < 20; ++k) strain(1.01);
  EXPECT_NEAR(p.J_P, std::pow(1.01, 60), 1e-12);
  for (int k = 0; k < 19; ++k) strain(1 / 1.01);
  EXPECT_EQ(p.tau[0], 0);
  strain(1 / 1.01);
  EXPECT_NEAR(p.tau[0], 0, 1e-9 * m.youngs_modulus);
  strain(0.999);
  EXPECT_LT(p.tau[0], 0);
  EXPECT_NEAR(p.J_P, 1, 1e-12);
}

/// Packed snow becomes sand where its material changes during a run, and points may bring a J_P
/// below 1: a pressure from that would be energy out of nothing.
TEST(Sand, SandThatWasPackedBearsNoPressureByItself) {
  at_every_simd_level([] {
    const Material m = dry_sand(30);
    for (const double J_P : {0.1, 0.8, 0.999}) {
      kernels::Particle<double> p = grain<double>(Mat3d::Identity(), J_P);
      update_material(p, engine::constants_of<double>(m));
      for (const double tau : p.tau) EXPECT_EQ(tau, 0) << J_P;
      engine::store_matrix(Mat3d(1.01 * engine::matrix(p.F_E)), p.F_E);
      update_material(p, engine::constants_of<double>(m));
      EXPECT_NEAR(p.J_P, std::pow(1.01, 3), 1e-12) << "the volume that it gains from there on";
    }
  });
}

/// Acceleration of the upper half of an endless layer on a rough floor, m/s2.
double acceleration_on_a_slope(double degrees) {
  constexpr double h = 0.02;
  constexpr int side = 4, height = 8;
  SolverSettings s;
  s.cell_size = h;
  s.kernel = Kernel::quadratic;
  s.transfer = Transfer::apic;
  s.contact_at = ContactAt::nodes;
  s.precision = Precision::real64;
  s.period = {1, 0, 1};
  s.shock_viscosity = 0;
  const double angle = degrees * pi / 180;
  s.gravity = 9.81 * Vec3d(std::sin(angle), -std::cos(angle), 0);
  ParticleArrays p;
  const Material m = dry_sand(30);
  for (int i = 0; i < 2 * side; ++i)
    for (int j = 0; j < 2 * height; ++j)
      for (int k = 0; k < 2 * side; ++k) {
        p.x.push_back(0.5 * h * Vec3d(i + 0.5, j + 0.5, k + 0.5));
        p.v.push_back(Vec3d::Zero());
        p.V0.push_back(h * h * h / 8);
        p.m.push_back(m.density * h * h * h / 8);
      }
  shapes::Collider floor;
  floor.name = "floor";
  floor.shape.form = shapes::Plane{{0, 0, 0}, {0, 1, 0}};
  floor.contact = shapes::Contact::sticky;
  Simulation simulation(s, {m}, {floor}, p, 1);
  const auto speed = [&] {
    const ParticleArrays now = simulation.particles();
    double sum = 0;
    int count = 0;
    for (std::size_t q = 0; q < now.x.size(); ++q)
      if (p.x[q][1] > 0.5 * height * h) sum += now.v[q][0], ++count;
    return sum / count;
  };
  // The ringing of the start is gone by then.
  constexpr double from = 0.5, to = 0.8;
  simulation.advance_to(from);
  const double before = speed();
  simulation.advance_to(to);
  return (speed() - before) / (to - from);
}

/// Sheared on a plane, sand slides beyond tan = M/sqrt(3): 34.7 degrees here.
TEST(Sand, SlopesSlideBeyondTheFrictionAngleAndAsFastAsFrictionAllows) {
  const double slope = laws::critical_slope(30) / std::sqrt(3.0);
  const double critical = std::atan(slope) * 180 / pi;
  EXPECT_NEAR(critical, 34.7, 0.05);
  // Below the angle, sand that the fall onto the floor at the start set in motion comes to rest;
  // beyond, the layer of 8 cells that it loosened slides with up to a sixth more friction.
  EXPECT_LE(acceleration_on_a_slope(critical - 1), 0.01);
  for (const double more : {2.0, 4.0}) {
    const double angle = (critical + more) * pi / 180;
    const double exact = 9.81 * (std::sin(angle) - slope * std::cos(angle));
    const double found = acceleration_on_a_slope(critical + more);
    EXPECT_GE(found, 0.85 * exact);
    EXPECT_LE(found, 1.05 * exact);
  }
}

}  // namespace
