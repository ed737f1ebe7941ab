/// Cam clay: its surface, its hardening, and paths with closed formulas.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <random>

#include "tests/support/clay_sample.h"
#include "tests/support/simd_levels.h"

namespace {

using namespace neve;
using namespace neve::sim;
using namespace neve::test;
namespace cam_clay = laws::cam_clay;

/// States far out, on all sides of the surface.
template <class Real>
void expect_surface(double tolerance) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  const Material m = clay();
  int deviators = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Sample<Real> sample(m, std::exp(0.1 * unit(random)));
    const double before = sample.p0();
    const double size_of_trial = trial % 2 ? 0.03 : 0.2;
    const Mat3d trial_F = std::exp(0.2 * size_of_trial * unit(random)) *
                          (Mat3d::Identity() + size_of_trial * random_entries(random));
    const double r = cam_clay::nearness_to_yield(m, trial_F, sample.J_P());
    sample.set_F(trial_F);
    sample.settle();
    const double volume = trial_F.determinant() / sample.J_E();
    if (r < 1 - 1e-3) {
      EXPECT_LE((sample.F() - trial_F).norm(), 1e-6);
    }
    if (r < 1 + 1e-3) continue;
    // A returned state lies on the ellipse of p0 before the step.
    const double M = laws::critical_slope(m.friction_angle), beta = m.own[cam_clay::cohesion];
    const double p = sample.p(), q = sample.q();
    const double y = (1 + 2 * beta) * q * q + M * M * (p + beta * before) * (p - before);
    const double size = M * (1 + beta) * before;
    EXPECT_LE(std::abs(y), tolerance * size * (size + m.youngs_modulus)) << trial;
    deviators += q > 0.1 * before;
    // The plastic volume has what the elastic one lost.
    const double start = sample.J_P() / volume;
    EXPECT_NEAR(cam_clay::p0(m, start), before, tolerance * m.youngs_modulus);
  }
  EXPECT_GT(deviators, 50);
}

TEST(CamClay, ReturnedStatesLieOnTheSurface) {
  at_every_simd_level([] {
    expect_surface<double>(1e-12);
    expect_surface<float>(3e-6);
  });
}

TEST(CamClay, ReturnIsIdempotentWhereTheSurfaceStays) {
  expect_idempotent_return(clay());
}

/// F keeps the directions that it had: snow that yields does not spin, and its grain stays.
TEST(CamClay, ReturnTurnsNothing) {
  std::mt19937 random(9);
  const Material m = clay();
  for (int trial = 0; trial < 50; ++trial) {
    const Mat3d Q = Eigen::Quaterniond::UnitRandom().toRotationMatrix();
    Sample<double> still(m), turned(m);
    const Mat3d F = Mat3d::Identity() + 0.05 * random_entries(random);
    still.set_F(F), turned.set_F(F * Q);
    still.settle(), turned.settle();
    EXPECT_LE((turned.F() - still.F() * Q).norm(), 1e-12);
    EXPECT_LE((still.F() - F).norm(), 0.2);
  }
}

TEST(CamClay, IsotropicCompressionFollowsTheHardeningLaw) {
  const Material m = clay();
  Sample<double> sample(m);
  double volume = 1;
  for (int k = 0; k < 300; ++k) {
    const double before = sample.p0();
    sample.strain(-1e-3 * Mat3d::Identity());
    volume *= std::pow(1 - 1e-3, 3);
    EXPECT_NEAR(sample.J_E() * sample.J_P(), volume, 1e-12);
    EXPECT_LE(sample.q(), 1e-9 * m.youngs_modulus);
    const double K = bulk_modulus(m);
    EXPECT_NEAR(sample.p(), 0.5 * K * (1 - sample.J_E() * sample.J_E()), 1e-9 * K);
    EXPECT_LE(sample.p(), before * (1 + 1e-12));
  }
  // p0 of what the volume law leaves to F_P, solved for J_P by hand.
  const double K = bulk_modulus(m), alpha0 = cam_clay::alpha0(m);
  double low = volume, high = 1;
  for (int round = 0; round < 60; ++round) {
    const double J_P = 0.5 * (low + high);
    const double p0 =
        K *
        (1e-5 + std::sinh(-m.own[cam_clay::consolidation_hardening] * (alpha0 + std::log(J_P))));
    const bool is_too_loose = J_P * std::sqrt(std::max(1 - 2 * p0 / K, 0.0)) > volume;
    (is_too_loose ? high : low) = J_P;
  }
  // The surface is that of before the step: one step of 0.3 % behind.
  EXPECT_NEAR(sample.J_P(), low, 0.005);
  EXPECT_LT(sample.J_P(), 0.9);
}

/// In a confined press plastic flow is axial in sum, so q is 3/2 the axial deviator, and at the
/// end the ratio of the sideways stress to the axial one is that of associated flow of the radial
/// rule: dJ along the line to the centre.
TEST(CamClay, OedometerKeepsItsAxisAndItsVolume) {
  const Material m = clay();
  Sample<double> sample(m);
  const Mat3d press = Vec3d(0, -5e-4, 0).asDiagonal();
  double volume = 1;
  for (int k = 0; k < 1000; ++k) {
    sample.strain(press);
    volume *= 1 - 5e-4;
  }
  const Mat3d tau = sample.tau();
  EXPECT_NEAR(sample.J_E() * sample.J_P(), volume, 1e-11);
  EXPECT_LE(std::abs(tau(0, 1)) + std::abs(tau(0, 2)) + std::abs(tau(1, 2)), 1e-9 * -tau(1, 1));
  EXPECT_NEAR(tau(0, 0), tau(2, 2), 1e-9 * -tau(1, 1));
  // Real snow has 0.3 to 0.5 of the axial stress sideways.
  const double sideways = tau(0, 0) / tau(1, 1);
  EXPECT_GT(sideways, 0.3);
  EXPECT_LT(sideways, 1.0);
  // The state lies on the surface, but for the growth of a step.
  EXPECT_NEAR(cam_clay::nearness_to_yield(m, sample.F(), sample.J_P()), 1, 0.02);
}

/// Sheared at constant volume, the state ends where it neither packs nor opens: p at the centre of
/// the ellipse and q at its top.
TEST(CamClay, ShearAtConstantVolumeEndsInTheCriticalState) {
  Material m = clay();
  m.own[cam_clay::consolidation_hardening] = 5;
  for (const double J_P : {1.0, 0.95}) {
    Sample<double> sample(m, J_P);
    Mat3d shear = Mat3d::Zero();
    shear(0, 1) = 5e-4;
    for (int k = 0; k < 60000; ++k) sample.strain(shear);
    const double p0 = sample.p0(), beta = m.own[cam_clay::cohesion];
    const double M = laws::critical_slope(m.friction_angle);
    EXPECT_NEAR(sample.p(), 0.5 * (1 - beta) * p0, 0.01 * p0);
    EXPECT_NEAR(sample.q(), 0.5 * M * (1 + beta) / std::sqrt(1 + 2 * beta) * p0, 0.01 * p0);
    const double J_P_then = sample.J_P();
    for (int k = 0; k < 1000; ++k) sample.strain(shear);
    EXPECT_NEAR(sample.J_P() / J_P_then, 1, 1e-4);
  }
}

/// The most that the return adds to the energy of a state on the surface that is sheared on by a
/// hundredth of its shear, over all pressures; J/m3 over that of the centre.
double energy_gained(const Material& m) {
  const double top = cam_clay::p0(m, 1), beta = m.own[cam_clay::cohesion];
  const double K = bulk_modulus(m), M = laws::critical_slope(m.friction_angle);
  const double centre = 0.5 * (1 - beta) * top;
  double most = -1;
  for (int k = -9; k < 20; ++k) {
    const double p = centre * k / 20;
    if (p <= -0.95 * beta * top) continue;
    const double q = M * std::sqrt((p + beta * top) * (top - p) / (1 + 2 * beta));
    const double shear = q / std::sqrt(3.0) / cam_clay::shear_modulus(m);
    Mat3d F = std::pow(1 - 2 * p / K, 1.0 / 6) * Mat3d::Identity();
    F(0, 1) = 1.01 * shear * F(0, 0);
    Sample<double> sample(m);
    sample.set_F(F);
    sample.settle();
    most = std::max(most, cam_clay::energy_density(m, sample.F()) - cam_clay::energy_density(m, F));
  }
  return most / (0.5 * centre * centre / K);
}

/// Flow makes energy only below the angle that `neve check` names, at any stiffness and cohesion.
TEST(CamClay, FlowMakesNoEnergyFromTheLeastFrictionAngle) {
  for (const double nu : {0.05, 0.2, 0.4})
    for (const double cohesion : {0.05, 0.4, 0.8}) {
      Material m = clay();
      m.poisson_ratio = nu;
      m.own[cam_clay::cohesion] = cohesion;
      const double least = laws::friction_angle(cam_clay::min_slope(m));
      m.friction_angle = 1.05 * least;
      EXPECT_LE(energy_gained(m), 0) << nu << " " << cohesion << " " << least;
      m.friction_angle = 0.8 * least;
      EXPECT_GT(energy_gained(m), 1e-4) << nu << " " << cohesion << " " << least;
      std::vector<laws::Concern> found;
      laws::of(m).concerns(m, found);
      ASSERT_EQ(found.size(), 1u);
      EXPECT_EQ(found[0].key, std::string("friction_angle"));
    }
}

TEST(CamClay, SnowTornByTensionLosesItsStrengthForGood) {
  const Material m = clay();
  Sample<double> sample(m);
  sample.strain(0.2 * Mat3d::Identity());
  // The state is at the tip: -beta p0 of the start.
  EXPECT_NEAR(sample.p(), -m.own[cam_clay::cohesion] * m.consolidation_pressure,
              1e-8 * m.youngs_modulus);
  EXPECT_LE(sample.q(), 1e-9 * m.youngs_modulus);
  EXPECT_GT(sample.J_P(), 1.3);
  // Its alpha is positive now: hardly any strength is left.
  EXPECT_LE(sample.p0(), 1.01e-5 * bulk_modulus(m));
  sample.strain(0.01 * Mat3d::Identity());
  EXPECT_LE(std::abs(sample.p()), 1.01e-5 * bulk_modulus(m));
}

TEST(CamClay, FactorsOfAParticleScaleItsStrength) {
  const Material m = clay();
  Sample<double> weak(m);
  weak.record().threshold = 0.5;
  weak.strain(-0.1 * Mat3d::Identity());
  EXPECT_NEAR(weak.p(), 0.5 * m.consolidation_pressure, 1e-8 * m.youngs_modulus);
  const Material half = scaled(m, 2, 0.5);
  EXPECT_NEAR(cam_clay::p0(half, 1), m.consolidation_pressure, 1e-9 * m.consolidation_pressure);
  EXPECT_NEAR(cam_clay::alpha0(half), cam_clay::alpha0(m), 1e-12);
}

TEST(CamClay, StrengthIsGivenInPascalWhateverTheStiffness) {
  for (const double E : {2e4, 1.4e5, 3e6}) {
    Material m = clay();
    m.youngs_modulus = E;
    EXPECT_NEAR(cam_clay::p0(m, 1), m.consolidation_pressure, 1e-9 * m.consolidation_pressure);
  }
  EXPECT_NEAR(laws::critical_slope(laws::friction_angle(1.6)), 1.6, 1e-14);
}

/// The kernels bound b'_min from below, so their sound is never slower than the exact one.
TEST(CamClay, SoundIsThatOfTheStiffestDirection) {
  std::mt19937 random(10);
  Material m = clay();
  m.consolidation_pressure = 10 * m.youngs_modulus;
  for (int trial = 0; trial < 100; ++trial) {
    const Mat3d F = Mat3d::Identity() + 0.1 * random_entries(random);
    kernels::Record<Quad<double>, Lanes<std::int64_t, 4>> p{};
    for (int k = 0; k < 9; ++k) p.F_E[k] = all<Quad<double>>(F(k / 3, k % 3));
    p.J_P = p.stiffness = p.threshold = all<Quad<double>>(1);
    const kernels::MaterialConstants<double> table[] = {engine::constants_of<double>(m)};
    Quad<double> modulus;
    cam_clay::InLanes::step(p, table, true, modulus);
    const double exact = cam_clay::wave_modulus(m, F);
    EXPECT_GE(modulus[0], exact * (1 - 1e-12));
    EXPECT_LE(modulus[0], exact * 1.05);
  }
}

TEST(CamClay, ReturnIsFiniteForAnyFiniteDeformation) {
  for (const double size : {1e-12, 1e-6, 1e-3, 1.0, 1e3})
    for (const Vec3d& s : {Vec3d(1, 1, 1), Vec3d(1, 0, 0), Vec3d(0, 0, 0), Vec3d(1, 1, -1),
                           Vec3d(1, 1e-9, 1), Vec3d(2, 0.5, -1e-4)}) {
      Sample<float> single(clay());
      Sample<double> real(clay());
      const Mat3d F = size * s.asDiagonal().toDenseMatrix();
      single.set_F(F), real.set_F(F);
      single.settle(), real.settle();
      EXPECT_TRUE(single.tau().allFinite() && single.F().allFinite()) << s.transpose() << size;
      EXPECT_TRUE(real.tau().allFinite() && real.F().allFinite()) << s.transpose() << size;
      EXPECT_GT(real.J_E(), 0);
    }
}

}  // namespace
