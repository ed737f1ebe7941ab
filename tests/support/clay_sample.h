#pragma once
/// Single particles of cam clay that are strained, for tests of its rules.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "sim/laws/cam_clay.h"
#include "sim/laws/list.h"
#include "sim/state/method.h"
#include "sim/state/records.h"
#include "tests/support/one_particle.h"

namespace neve::test {

using sim::Mat3d;
using sim::Material;
using sim::Vec3d;

inline Material clay() {
  Material m;
  m.model = sim::laws::model::cam_clay;
  return m;
}

/// One particle of a material, strained step by step.
template <class Real>
class Sample {
 public:
  explicit Sample(const Material& m, double J_P = 1) : material_(m) {
    sim::engine::store_matrix(Mat3d(Mat3d::Identity()), p_.F_E);
    p_.J_P = static_cast<Real>(J_P);
    p_.m = p_.V0 = p_.stiffness = p_.threshold = 1;
    p_.kind = sim::kernels::kind_of<Real>(0, sim::laws::model::cam_clay, 0);
  }
  void set_F(const Mat3d& F_E) { sim::engine::store_matrix(F_E, p_.F_E); }
  /// F_E = (I + L) F_E, and the return.
  void strain(const Mat3d& L) {
    set_F((Mat3d::Identity() + L) * F());
    settle();
  }
  void settle() { update_material(p_, sim::engine::constants_of<Real>(material_)); }

  Mat3d F() const { return sim::engine::matrix(p_.F_E); }
  Mat3d b() const { return F() * F().transpose(); }
  double J_P() const { return static_cast<double>(p_.J_P); }
  double J_E() const { return F().determinant(); }
  double p0() const { return sim::laws::cam_clay::p0(material_, J_P()); }
  Mat3d tau() const {
    const Vec3d on = sim::engine::vector(p_.tau), off = sim::engine::vector(p_.tau + 3);
    Mat3d tau;
    tau << on[0], off[0], off[1], off[0], on[1], off[2], off[1], off[2], on[2];
    return tau;
  }
  double p() const { return -tau().trace() / 3; }
  double q() const { return std::sqrt(1.5) * (tau() + p() * Mat3d::Identity()).norm(); }
  sim::kernels::Particle<Real>& record() { return p_; }

 private:
  Material material_;
  sim::kernels::Particle<Real> p_{};
};

inline Mat3d random_entries(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  return Mat3d::NullaryExpr([&] { return unit(random); });
}

/// Returned once more to the surface that it was returned to, a state stays.
inline void expect_idempotent_return(const Material& m) {
  std::mt19937 random(8);
  for (int trial = 0; trial < 200; ++trial) {
    Sample<double> sample(m);
    sample.set_F(Mat3d::Identity() + 0.1 * random_entries(random));
    sample.settle();
    const Mat3d b = sample.b();
    const double J_P = sample.J_P();
    sample.record().J_P = 1;  // its surface, as before the return
    sample.settle();
    EXPECT_LE((sample.b() - b).norm(), 1e-12);
    EXPECT_NEAR(sample.J_P(), 1, 1e-12);
    EXPECT_GT(J_P, 0);
  }
}

}  // namespace neve::test
