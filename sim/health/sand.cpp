#include "sim/health/sand.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "sim/health/cam_clay.h"
#include "sim/kernels/sand.h"

namespace neve::sim::health::sand {

namespace {

/// Logarithms of the stretches, axes, and the principal Kirchhoff stress.
struct Hencky {
  Vec3d e, tau;
  Mat3d U;

  Hencky(const Material& m, const Mat3d& F_E) {
    const Eigen::SelfAdjointEigenSolver<Mat3d> eigen(F_E * F_E.transpose());
    U = eigen.eigenvectors();
    e = 0.5 * eigen.eigenvalues().array().max(kernels::min_stretch_squared).log();
    const Lame l = lame(m.youngs_modulus, m.poisson_ratio);
    tau = 2 * l.mu * e + l.lambda * e.sum() * Vec3d::Ones();
  }
};

}  // namespace

double energy_density(const Material& m, const Mat3d& F_E) {
  const Lame l = lame(m.youngs_modulus, m.poisson_ratio);
  const Vec3d e = Hencky(m, F_E).e;
  return l.mu * e.squaredNorm() + 0.5 * l.lambda * e.sum() * e.sum();
}

Mat3d first_piola(const Material& m, const Mat3d& F_E) {
  const Hencky h(m, F_E);
  return h.U * h.tau.asDiagonal() * h.U.transpose() * F_E.inverse().transpose();
}

double wave_modulus(const Material& m, const Mat3d& F_E) {
  const Lame l = lame(m.youngs_modulus, m.poisson_ratio);
  return l.lambda + 2 * l.mu + std::max(0.0, -Hencky(m, F_E).tau.minCoeff());
}

double nearness_to_yield(const Material& m, const Mat3d& F_E) {
  const Vec3d tau = Hencky(m, F_E).tau;
  const double p = -tau.mean(), q = std::sqrt(1.5) * (tau.array() + p).matrix().norm();
  const double slope = m.strength * cam_clay::critical_slope(m.friction_angle);
  return p > 0 ? q / (slope * p) : 1;
}

}  // namespace neve::sim::health::sand
