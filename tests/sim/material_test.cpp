/// Energy, stress, projection and the arithmetic below them.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "sim/health/diagnostics.h"
#include "sim/laws/law.h"
#include "sim/laws/list.h"
#include "sim/state/method.h"
#include "tests/support/one_particle.h"
#include "tests/support/simd_levels.h"

namespace {

using namespace neve;
using namespace neve::sim;
using namespace neve::test;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()() { return unit_(engine_); }
  Mat3d matrix() {
    return Mat3d::NullaryExpr([this] { return unit_(engine_); });
  }
  Mat3d rotation() {
    return Eigen::Quaterniond(
               Eigen::Vector4d(matrix()(0), matrix()(1), matrix()(2), matrix()(3)).normalized())
        .toRotationMatrix();
  }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<double> unit_{-1, 1};
};

template <class Real>
kernels::Particle<Real> particle(const Mat3d& F_E, double J_P, Model model) {
  kernels::Particle<Real> p{};
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) p.F_E[3 * a + b] = static_cast<Real>(F_E(a, b));
  p.J_P = static_cast<Real>(J_P);
  p.m = p.V0 = p.stiffness = p.threshold = 1;
  p.kind = kernels::kind_of<Real>(0, model, 0);
  return p;
}

template <class Real>
Mat3d F_of(const kernels::Particle<Real>& p) {
  Mat3d F;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) F(a, b) = static_cast<double>(p.F_E[3 * a + b]);
  return F;
}

template <class Real>
Mat3d tau_of(const kernels::Particle<Real>& p) {
  const Real* t = p.tau;
  Mat3d tau;
  tau << t[0], t[3], t[4], t[3], t[1], t[5], t[4], t[5], t[2];
  return tau;
}

template <class Real>
kernels::MaterialConstants<Real> constants(const Material& m) {
  return engine::constants_of<Real>(m);
}

TEST(Energy, StressIsItsDerivative) {
  Random random(1);
  for (const laws::Law& law : laws::every()) {
    const Model model = law.model;
    Material m;
    m.model = model;
    for (int trial = 0; trial < 50; ++trial) {
      const Mat3d F = random.rotation() * (Mat3d::Identity() + 0.2 * random.matrix());
      if (F.determinant() < 0.2) continue;
      const double J_P = 1 + 0.1 * random();
      const Mat3d P = health::first_piola(m, F, J_P), dF = random.matrix();
      // Central differences: the error is the third derivative (about mu) times epsilon^2 = 1e-10,
      // and rounding of psi (1e-16 mu) over epsilon, 1e-11: 1e-7 of mu leaves room for both.
      const double epsilon = 1e-5;
      const double slope = (health::energy_density(m, F + epsilon * dF, J_P) -
                            health::energy_density(m, F - epsilon * dF, J_P)) /
                           (2 * epsilon);
      const double scale = m.youngs_modulus * std::exp(m.hardening * (1 - J_P));
      EXPECT_NEAR(P.cwiseProduct(dF).sum(), slope, 1e-7 * scale);
    }
  }
}

TEST(Stress, StressOfKernelsIsFirstPiolaTimesTransposedF) {
  Random random(2);
  for (const laws::Law& law : laws::every()) {
    const Model model = law.model;
    if (model == laws::model::sand) continue;  // yields to any tension: see Sand
    Material m;
    m.model = model;
    // Thresholds wide open: nothing is projected, so F_E stays what it was.
    m.critical_compression = 0.95;
    m.critical_stretch = 3;
    m.consolidation_pressure = 100 * m.youngs_modulus;
    for (const double strain : {1e-6, 1e-3, 0.02, 0.15, 0.3}) {
      const Mat3d F = random.rotation() * (Mat3d::Identity() + strain * random.matrix());
      const double J_P = 1 + 0.05 * random();
      const Mat3d expected = health::first_piola(m, F, J_P) * F.transpose();
      const double scale = 2 * m.youngs_modulus;
      auto p = particle<double>(F, J_P, model);
      update_material(p, constants<double>(m));
      // Double: F - R cancels, 1e-13 of the moduli. Float: F itself is rounded to 6e-8.
      EXPECT_LE((tau_of(p) - expected).cwiseAbs().maxCoeff(), 1e-12 * scale) << strain;
      auto q = particle<float>(F, J_P, model);
      update_material(q, constants<float>(m));
      EXPECT_LE((tau_of(q) - expected).cwiseAbs().maxCoeff(), 2e-6 * scale) << strain;
    }
  }
}

TEST(Stress, StressVanishesInRotationAndTurnsWithIt) {
  Random random(3);
  for (const laws::Law& law : laws::every()) {
    const Model model = law.model;
    Material m;
    m.model = model;
    const Mat3d Q = random.rotation(), F = Mat3d::Identity() + 0.004 * random.matrix();
    auto turned = particle<double>(Q, 1, model), at_rest = particle<double>(F, 1, model),
         both = particle<double>(Q * F, 1, model);
    for (auto* p : {&turned, &at_rest, &both}) update_material(*p, constants<double>(m));
    EXPECT_LE(tau_of(turned).cwiseAbs().maxCoeff(), 1e-13 * m.youngs_modulus);
    EXPECT_LE((tau_of(both) - Q * tau_of(at_rest) * Q.transpose()).cwiseAbs().maxCoeff(),
              1e-12 * m.youngs_modulus);
  }
}

/// A stretch along x next to the border between two ways to compute stress, on either side.
void expect_no_step_at(double border) {
  Material m;
  m.model = laws::model::corotated;
  const auto stress_at = [&](double stretch) {
    auto p = particle<double>(Vec3d(stretch, 1, 1).asDiagonal(), 1, laws::model::corotated);
    update_material(p, constants<double>(m));
    return tau_of(p);
  };
  // 2e-9 apart in stretch: about 1e-8 of the modulus, were both exact.
  EXPECT_LE((stress_at(border + 1e-9) - stress_at(border - 1e-9)).cwiseAbs().maxCoeff(),
            2e-8 * m.youngs_modulus)
      << border;
}

TEST(Stress, StressOfTwoPathsMeetsAtTheirBorders) {
  at_every_simd_level([] {
    for (const double squared :
         {1 - kernels::series_radius, 1 + kernels::series_radius, laws::eigen_lo, laws::eigen_hi})
      expect_no_step_at(std::sqrt(squared));
  });
}

TEST(Snow, ProjectionClampsStretchesAndKeepsTheProduct) {
  Random random(4);
  const Material m;
  for (int trial = 0; trial < 200; ++trial) {
    const Mat3d F = random.rotation() * (Mat3d::Identity() + 0.1 * random.matrix());
    const double J_P = 1 + 0.1 * random();
    auto p = particle<double>(F, J_P, laws::model::snow);
    update_material(p, constants<double>(m));
    const Vec3d s = F_of(p).jacobiSvd().singularValues();
    EXPECT_GE(s.minCoeff(), 1 - m.critical_compression - 1e-12);
    EXPECT_LE(s.maxCoeff(), 1 + m.critical_stretch + 1e-12);
    EXPECT_NEAR(F_of(p).determinant() * p.J_P, F.determinant() * J_P, 1e-12);
  }
}

TEST(Snow, InsideTheThresholdsNothingChangesABit) {
  Random random(5);
  const Material m;
  for (int trial = 0; trial < 200; ++trial) {
    const Mat3d F = random.rotation() * (Mat3d::Identity() + 0.002 * random.matrix());
    auto p = particle<float>(F, 0.97, laws::model::snow);
    const auto before = p;
    update_material(p, constants<float>(m));
    EXPECT_EQ(0, std::memcmp(p.F_E, before.F_E, sizeof p.F_E));
    EXPECT_EQ(p.J_P, before.J_P);
  }
}

TEST(Snow, HardeningGrowsUnderCompressionOnly) {
  const Material m;
  auto pressed = particle<double>(Vec3d(1, 0.9, 1).asDiagonal(), 1, laws::model::snow);
  auto pulled = particle<double>(Vec3d(1, 1.1, 1).asDiagonal(), 1, laws::model::snow);
  update_material(pressed, constants<double>(m));
  update_material(pulled, constants<double>(m));
  EXPECT_NEAR(pressed.J_P, 0.9 / 0.975, 1e-12);
  EXPECT_NEAR(pulled.J_P, 1.1 / 1.0075, 1e-12);
}

/// A stretch of -0.5 is projected to 1 - theta_c, and J_P takes |-0.5| / (1 - theta_c).
template <class Real>
void expect_inverted_is_repaired() {
  const Material m;
  auto p = particle<Real>(Vec3d(1, 1, -0.5).asDiagonal(), 8, laws::model::snow);
  update_material(p, constants<Real>(m));
  EXPECT_NEAR(static_cast<double>(p.J_P), 8 * 0.5 / 0.975, 1e-5);
  EXPECT_NEAR(std::abs(F_of(p).determinant()), 0.975, 1e-5);
  EXPECT_TRUE(tau_of(p).allFinite());
}

TEST(Snow, JOfAnInvertedParticleStaysPositive) {
  at_every_simd_level([] {
    expect_inverted_is_repaired<float>();
    expect_inverted_is_repaired<double>();
  });
}

/// The range holds J_P alone: F_E is the same with and without it.
TEST(Snow, PlasticVolumeStaysInItsRange) {
  Material narrow;
  narrow.min_J_P = 0.5, narrow.max_J_P = 2;
  Random random(9);
  at_every_simd_level([&] {
    for (const double size : {0.1, 0.3, 3.0, 20.0})
      for (const double J_P : {0.5, 0.7, 1.0, 2.0}) {
        const Mat3d F = size * random.rotation() * (Mat3d::Identity() + 0.1 * random.matrix());
        auto held = particle<double>(F, J_P, laws::model::snow), free = held;
        update_material(held, constants<double>(narrow));
        update_material(free, kernels::MaterialConstants<double>{1, 1, 1, 0.025, 0.0075});
        EXPECT_EQ(held.J_P, std::clamp(free.J_P, 0.5, 2.0)) << size << " " << J_P;
        EXPECT_EQ(0, std::memcmp(held.F_E, free.F_E, sizeof held.F_E));
      }
  });
}

TEST(Snow, PlasticVolumeThatIsNoNumberStaysNone) {
  for (const double s : {0.99, 0.9, -0.5}) {
    auto p = particle<float>(Vec3d(1, s, 1).asDiagonal(), std::numeric_limits<double>::quiet_NaN(),
                             laws::model::snow);
    update_material(p, constants<float>(Material{}));
    EXPECT_TRUE(std::isnan(p.J_P)) << s;
  }
}

template <class Real>
double stress_at(const Material& m, double J_P) {
  auto p = particle<Real>(Vec3d(1, 0.99, 1).asDiagonal(), J_P, laws::model::snow);
  update_material(p, constants<Real>(m));
  return tau_of(p).norm();
}

template <class Real>
void expect_bounded_hardening() {
  Material m;
  m.hardening = 100;  // e^90 is more than float holds
  m.max_hardening = 50;
  const double at_rest = stress_at<Real>(m, 1);
  EXPECT_NEAR(stress_at<Real>(m, 0.1) / at_rest, 50, 1e-4);
  EXPECT_NEAR(stress_at<Real>(m, 0.99) / at_rest, std::exp(1), 1e-4);
  EXPECT_NEAR(stress_at<Real>(m, 9) / at_rest / laws::min_hardening, 1, 1e-4);
  m.max_hardening = 1e12;
  EXPECT_TRUE(std::isfinite(stress_at<Real>(m, 0.1)));
  EXPECT_NEAR(health::hardening_factor(m, 9), laws::min_hardening, 0);
}

TEST(Snow, HardeningEndsAtItsBounds) {
  at_every_simd_level([] {
    expect_bounded_hardening<float>();
    expect_bounded_hardening<double>();
  });
}

TEST(Decomposition, DecompositionRebuildsAnyMatrixInFloatAndDouble) {
  Random random(6);
  double worst_float = 0, worst_double = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    Mat3d F = random.matrix() * std::pow(10.0, 4 * random());
    if (trial % 4 == 1) F = random.rotation() * (Mat3d::Identity() + 1e-4 * random.matrix());
    if (trial % 4 == 2) F.col(2) = F.col(0) + 1e-6 * F.col(1);
    if (trial % 16 == 3) F = F.col(0) * F.row(1);
    if (trial % 64 == 7) F.setZero();
    const double scale = std::max(F.cwiseAbs().maxCoeff(), 1e-300);
    const auto check = [&](auto real, double& worst) {
      using Real = decltype(real);
      const auto p = particle<Real>(F, 1, laws::model::snow);
      const kernels::SignedSvd<Real> svd = kernels::signed_svd(p.F_E);
      Mat3d U, V;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          U(a, b) = static_cast<double>(svd.U[3 * a + b]);
          V(a, b) = static_cast<double>(svd.V[3 * a + b]);
        }
      const Vec3d s(svd.s[0], svd.s[1], svd.s[2]);
      const double error =
          std::max({(U * s.asDiagonal() * V.transpose() - F_of(p)).cwiseAbs().maxCoeff() / scale,
                    (U.transpose() * U - Mat3d::Identity()).cwiseAbs().maxCoeff(),
                    (V.transpose() * V - Mat3d::Identity()).cwiseAbs().maxCoeff(),
                    std::abs(U.determinant() - 1), std::abs(V.determinant() - 1)});
      worst = std::max(worst, error);
    };
    check(0.0f, worst_float);
    check(0.0, worst_double);
  }
  // A few rotations of rounding error each: some tens of units in the last place. V of a nearly
  // singular F inherits the orthogonality that the sweeps stop at.
  EXPECT_LE(worst_float, 1e-5);
  EXPECT_LE(worst_double, 1e-14);
}

template <class Real>
Real exponential_of(Real x) {
  return exponential_lanes(all<Quad<Real>>(x))[2];
}

template <class Real>
Real logarithm_of(Real x) {
  return logarithm_lanes(all<Quad<Real>>(x))[1];
}

TEST(Arithmetic, ExponentialAndLogarithmMatchTheLibrary) {
  for (double x = -30; x < 30; x += 0.0137) {
    EXPECT_NEAR(exponential_of(x) / std::exp(x), 1, 1e-15 * 4) << x;
    const float y = static_cast<float>(x);
    EXPECT_NEAR(static_cast<double>(exponential_of(y)) / std::exp(static_cast<double>(y)), 1, 3e-7)
        << x;
    EXPECT_NEAR(logarithm_of(std::exp(x)), x, 1e-15 * (4 + std::abs(x))) << x;
  }
  EXPECT_EQ(exponential_of(0.0f), 1.0f);
  EXPECT_EQ(exponential_of(0.0), 1.0);
}

/// The energy along a plane wave a (k.x) gives the speed by its second derivative, a = k in the
/// direction of the largest stretch: dF = s a k^T. Differences of 1e-4 leave 1e-6 of it.
TEST(WaveSpeed, ElasticLawsHaveThatOfTheirEnergy) {
  for (const Model model : {laws::model::corotated, laws::model::neo_hookean})
    for (const double stretch : {0.5, 0.8, 1.0, 1.25}) {
      Material m;
      m.model = model;
      const Mat3d F = stretch * Mat3d::Identity();
      const auto energy = [&](double amount) {
        Mat3d moved = F;
        moved(0, 0) *= 1 + amount;
        return health::energy_density(m, moved, 1);
      };
      constexpr double d = 1e-4;
      const double modulus = (energy(d) - 2 * energy(0) + energy(-d)) / (d * d);
      const double c = health::wave_speed(m, F, 1, m.density);
      EXPECT_NEAR(m.density * c * c / modulus, 1, 1e-5) << static_cast<int>(model) << stretch;
    }
}

TEST(WaveSpeed, PaperSnowAtRestHasItsWaveSpeed) {
  // mu 58333.3, lambda 38888.9 Pa, rho 400: sqrt(155555.6 / 400) = 19.72 m/s.
  EXPECT_NEAR(sound_speed(Material{}), 19.7203, 1e-4);
  EXPECT_NEAR(health::wave_speed(Material{}, Mat3d::Identity(), 1, 400), 19.7203, 1e-4);
  EXPECT_NEAR(health::wave_speed(Material{}, Mat3d::Identity(), 0.8, 400), 19.7203 * std::exp(1.0),
              1e-3);
}

}  // namespace
