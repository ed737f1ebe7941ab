/// The change of stress with strain: against differences of the stress, symmetric, and the same in
/// every lane.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <random>
#include <vector>

#include "sim/laws/differential.h"
#include "sim/laws/law.h"
#include "sim/laws/list.h"
#include "tests/support/stress_change.h"

namespace {

using namespace neve;
using namespace neve::sim;
using namespace neve::test;

std::mt19937 random_numbers(5);

Mat3d random_matrix() {
  std::uniform_real_distribution<double> unit(-1, 1);
  return Mat3d::NullaryExpr([&] { return unit(random_numbers); });
}

Material material_of(Model model) {
  Material material;
  material.model = model;
  material.hardening = 5;
  return material;
}

/// Near rest, where V is a series; further away, by eigenvalues; and what only F itself can tell.
std::vector<Mat3d> deformations(Model model) {
  std::vector<Mat3d> out{Mat3d::Identity()};
  for (int k = 0; k < 20; ++k) {
    out.push_back(Mat3d::Identity() + 0.02 * random_matrix());
    out.push_back(Mat3d::Identity() + 0.3 * random_matrix());
    const Mat3d Q = Eigen::Quaterniond::UnitRandom().toRotationMatrix();
    out.push_back(Q * Vec3d(1.3, 0.9, 0.7).asDiagonal() *
                  (Mat3d::Identity() + 0.1 * random_matrix()));
    out.push_back(Q * Vec3d(3, 1, 0.2).asDiagonal());
    if (model != laws::model::snow && model != laws::model::corotated) continue;
    out.push_back(Q * Vec3d(1.2, 0.9, -0.4).asDiagonal());  // inverted
    out.push_back(Q * Vec3d(1.2, 0.9, 1e-9).asDiagonal());  // flat
  }
  return out;
}

std::vector<Model> differentiated_models() {
  std::vector<Model> models;
  for (const laws::Law& law : laws::every())
    if (law.has_derivative) models.push_back(law.model);
  return models;
}

TEST(StressChange, StressChangeIsTheDerivativeOfTheStress) {
  for (const Model model : differentiated_models()) {
    const Material material = material_of(model);
    for (const Mat3d& F_E : deformations(model)) {
      const Mat3d G = random_matrix();
      // Fourth order: (8 (f(e) - f(-e)) - (f(2e) - f(-2e))) / 12e, 1e-11 of the moduli here.
      constexpr double e = 1e-3;
      const auto P = [&](double by) {
        return health::first_piola(material, (Mat3d::Identity() + by * G) * F_E, 0.97);
      };
      const Mat3d dP = (8 * (P(e) - P(-e)) - (P(2 * e) - P(-2 * e))) / (12 * e);
      const Mat3d expected = dP * F_E.transpose();
      const Mat3d found = stress_change_of<double>(material, F_E, 0.97, G);
      const double scale = material.youngs_modulus + expected.norm();
      EXPECT_LE((found - expected).norm() / scale, 2e-8) << static_cast<int>(model) << "\n" << F_E;
      // Error of V, J and ln J in float: some units of 6e-8, more where stretches cancel.
      const Mat3d in_float = stress_change_of<float>(material, F_E, 0.97, G);
      EXPECT_LE((in_float - found).norm() / scale, 2e-5) << static_cast<int>(model) << "\n" << F_E;
    }
  }
}

/// e^(10 * 0.7) is beyond the bound, e^(10 * -5) below the least factor.
TEST(StressChange, StressChangeIsTheDerivativeAtTheBoundsOfHardening) {
  Material material = material_of(laws::model::snow);
  material.hardening = 10;
  material.max_hardening = 50;
  for (const double J_P : {0.3, 6.0})
    for (const Mat3d& F_E : deformations(laws::model::snow)) {
      const Mat3d G = random_matrix();
      constexpr double e = 1e-3;
      const auto P = [&](double by) {
        return health::first_piola(material, (Mat3d::Identity() + by * G) * F_E, J_P);
      };
      const Mat3d dP = (8 * (P(e) - P(-e)) - (P(2 * e) - P(-2 * e))) / (12 * e);
      const Mat3d expected = dP * F_E.transpose();
      const double factor = J_P < 1 ? 50 : laws::min_hardening;
      const double scale = factor * material.youngs_modulus + expected.norm();
      EXPECT_LE((stress_change_of<double>(material, F_E, J_P, G) - expected).norm() / scale, 2e-8);
      EXPECT_LE((stress_change_of<float>(material, F_E, J_P, G) - expected).norm() / scale, 2e-5);
    }
}

TEST(StressChange, StressChangeIsSymmetric) {
  for (const Model model : differentiated_models()) {
    const Material material = material_of(model);
    for (const Mat3d& F_E : deformations(model)) {
      const Mat3d A = random_matrix(), B = random_matrix();
      const Mat3d DA = stress_change_of<double>(material, F_E, 1.02, A);
      const Mat3d DB = stress_change_of<double>(material, F_E, 1.02, B);
      EXPECT_NEAR(DA.cwiseProduct(B).sum(), DB.cwiseProduct(A).sum(),
                  1e-12 * (DA.norm() + DB.norm() + material.youngs_modulus));
    }
  }
}

TEST(StressChange, StressChangeOfABodyAtRestIsHookesLaw) {
  for (const Model model : differentiated_models()) {
    const Material material = material_of(model);
    const Lame l = lame(material.youngs_modulus, material.poisson_ratio);
    const Mat3d G = random_matrix();
    const Mat3d expected = l.mu * (G + G.transpose()) + l.lambda * G.trace() * Mat3d::Identity();
    const Mat3d found = stress_change_of<double>(material, Mat3d::Identity(), 1, G);
    EXPECT_LE((found - expected).norm(), 1e-13 * material.youngs_modulus);
  }
}

/// Laws without a derivative of their own take this one.
TEST(StressChange, SmallStrainIsHookesLawWhateverTheStrain) {
  using V = Quad<double>;
  const Material material = material_of(laws::model::snow);
  const Lame l = lame(material.youngs_modulus, material.poisson_ratio);
  const kernels::MaterialConstants<double> table[] = {engine::constants_of<double>(material)};
  const Mat3d F_E = Mat3d::Identity() + 0.3 * random_matrix(), G = random_matrix();
  kernels::Record<V, Lanes<std::int64_t, 4>> p{};
  V in_lanes[9], D[9];
  for (int q = 0; q < 9; ++q) {
    p.F_E[q] = all<V>(F_E(q / 3, q % 3));
    in_lanes[q] = all<V>(G(q / 3, q % 3));
  }
  p.V0 = all<V>(3), p.stiffness = all<V>(2), p.J_P = all<V>(1);
  laws::small_strain_change(laws::small_strain(p, table), in_lanes, D);
  const Mat3d expected =
      6 * (l.mu * (G + G.transpose()) + l.lambda * G.trace() * Mat3d::Identity());
  for (int q = 0; q < 9; ++q) EXPECT_NEAR(D[q][0], expected(q / 3, q % 3), 1e-12 * expected.norm());
}

TEST(StressChange, StressChangeIsFiniteForAnyFiniteDeformation) {
  // The corotated stress has no derivative if two stretches cancel.
  for (const Model model : differentiated_models())
    for (const Vec3d& s : {Vec3d(1, 0, 0), Vec3d(0, 0, 0), Vec3d(1, 0.5, -0.5), Vec3d(2, 2, -2),
                           Vec3d(1e-12, 1e-12, 1e-12), Vec3d(100, 1, 1e-4)}) {
      const Mat3d F_E = s.asDiagonal();
      EXPECT_TRUE(stress_change_of<double>(material_of(model), F_E, 1, random_matrix()).allFinite())
          << s.transpose();
      EXPECT_TRUE(stress_change_of<float>(material_of(model), F_E, 1, random_matrix()).allFinite())
          << s.transpose();
    }
}

}  // namespace
